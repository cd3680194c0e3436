"""Formats of drawings: a new one is a function in a file here and an entry below."""

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
WITH_PAGES: dict[str, Callable[..., bytes]] = {"pdf": write_pdf}  # those in which a file holds several drawings
RUN_FORMATS = ("png", "svg")
NamedDrawings = Iterable[tuple[str, Drawing]]
FormatFiles = list[tuple[str, bytes]]
JobResult = TypeVar("JobResult")


class JobRunner(Protocol):
    """Who does jobs, which may be pickled: what they give, in their order."""

    def __call__(self, jobs: Sequence[Callable[[], JobResult]], /) -> Iterable[JobResult]: ...


def run_in_process(jobs: Sequence[Callable[[], JobResult]], /) -> Iterable[JobResult]:
    """One after the other, in this process."""
    return (job() for job in jobs)


def drawing_files(drawn: NamedDrawings, say: Callable[[str], None] = lambda note: None) -> Iterable[tuple[str, bytes]]:
    """Every sheet in the formats of a run, by the name of its file; at last what there is to say of them all."""
    return files_of_parts([lambda: drawn], say)


def files_of_parts(
    parts: Sequence[Callable[[], NamedDrawings]],
    say: Callable[[str], None] = lambda note: None,
    way: JobRunner = run_in_process,
) -> Iterable[tuple[str, bytes]]:
    """The same of sheets that come in parts, each of which is a job; way: who does the jobs."""
    boxes: set[str] = set()
    for written, lost in way([partial(_write_part, part) for part in parts]):
        boxes |= lost
        yield from written
    for note in missing_character_notes(boxes):
        say(note)


def _write_part(part: Callable[[], NamedDrawings]) -> tuple[FormatFiles, set[str]]:
    """Files by name, and characters that the font lacks."""
    every = list(part())
    lost = missing_characters("".join(text for __, sheet in every for text in sheet.texts()))
    return [(f"{stem}.{kind}", FORMATS[kind](sheet)) for stem, sheet in every for kind in RUN_FORMATS], lost


def missing_character_notes(texts: Iterable[str]) -> Iterable[str]:
    """What there is to say of characters that no drawing can show."""
    boxes = missing_characters("".join(texts))
    if boxes:
        text = _("note: the font of the drawings lacks these characters, boxes stand for them: {characters}")
        yield text.format(characters=" ".join(sorted(boxes)))
