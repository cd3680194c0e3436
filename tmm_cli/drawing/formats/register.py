"""Table of the file formats of drawings. To add one, write a function in a module of its own and add it to FORMATS."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import partial
from typing import Protocol, TypeVar

from tmm_cli.drawing.formats.dxf import write_dxf
from tmm_cli.drawing.formats.emf import write_emf
from tmm_cli.drawing.formats.pdf import write_pdf
from tmm_cli.drawing.formats.png import write_png
from tmm_cli.drawing.formats.svg import write_svg
from tmm_cli.drawing.paper import Drawing, missing_characters
from tmm_cli.language import _

FORMATS: dict[str, Callable[[Drawing], bytes]] = {
    "pdf": write_pdf,
    "dxf": write_dxf,
    "svg": write_svg,
    "png": write_png,
    "emf": write_emf,
}
WITH_PAGES: dict[str, Callable[..., bytes]] = {"pdf": write_pdf}  # formats whose files hold several drawings
RUN_FORMATS = ("png", "svg")
NamedDrawings = Iterable[tuple[str, Drawing]]
FormatFiles = list[tuple[str, bytes]]
JobResult = TypeVar("JobResult")


class JobRunner(Protocol):
    """A function that runs jobs, for example in several processes, and yields the results in the order of the jobs."""

    def __call__(self, jobs: Sequence[Callable[[], JobResult]], /) -> Iterable[JobResult]: ...


def run_in_process(jobs: Sequence[Callable[[], JobResult]], /) -> Iterable[JobResult]:
    """Run the jobs one after another in this process and yield their results."""
    return (job() for job in jobs)


def drawing_files(drawn: NamedDrawings, say: Callable[[str], None] = lambda note: None) -> Iterable[tuple[str, bytes]]:
    """Yield the files of drawings in each of RUN_FORMATS, as (file name, content).

    Args:
        drawn: the drawings, each with its file name without extension.
        say: called at the end with notes that concern all drawings.
    """
    return files_of_parts([lambda: drawn], say)


def files_of_parts(
    parts: Sequence[Callable[[], NamedDrawings]],
    say: Callable[[str], None] = lambda note: None,
    runner: JobRunner = run_in_process,
) -> Iterable[tuple[str, bytes]]:
    """Draw the sheets of a project and yield their files in each of RUN_FORMATS, as (file name, content).

    Args:
        parts: functions that each draw some of the sheets. Each is called in a job of its own, and must be picklable if
            jobs run in other processes.
        say: called at the end with notes that concern all sheets.
        runner: runs the jobs, for example on several cores.
    """
    boxes: set[str] = set()
    for written, lost in runner([partial(_write_part, job) for job in parts]):
        boxes |= lost
        yield from written
    for note in missing_character_notes(boxes):
        say(note)


def _write_part(job: Callable[[], NamedDrawings]) -> tuple[FormatFiles, set[str]]:
    """Draw the sheets that one function draws, and write them in each of RUN_FORMATS.

    Returns:
        Their files, as (file name, content), and the characters of their texts that are missing in the font.
    """
    drawings = list(job())
    lost = missing_characters("".join(text for __, sheet in drawings for text in sheet.texts()))
    return [(f"{stem}.{kind}", FORMATS[kind](sheet)) for stem, sheet in drawings for kind in RUN_FORMATS], lost


def missing_character_notes(texts: Iterable[str]) -> Iterable[str]:
    """Yield a note that lists the characters of the texts that the font lacks, if there are any."""
    boxes = missing_characters("".join(texts))
    if boxes:
        text = _("note: the font of the drawings lacks these characters, which are drawn as boxes: {characters}")
        yield text.format(characters=" ".join(sorted(boxes)))
