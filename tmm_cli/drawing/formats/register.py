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
from tmm_cli.drawing.paper import Drawing, lacking
from tmm_cli.language import _

FORMATS: dict[str, Callable[[Drawing], bytes]] = {
    "pdf": write_pdf,
    "dxf": write_dxf,
    "svg": write_svg,
    "png": write_png,
    "emf": write_emf,
}
WITH_PAGES: dict[str, Callable[..., bytes]] = {"pdf": write_pdf}  # those in which a file holds several drawings
OF_A_RUN = ("png", "svg")
Drawn = Iterable[tuple[str, Drawing]]
Written = list[tuple[str, bytes]]
Found = TypeVar("Found")


class Way(Protocol):
    """Who does jobs, which may be pickled: what they give, in their order."""

    def __call__(self, jobs: Sequence[Callable[[], Found]], /) -> Iterable[Found]: ...


def here(jobs: Sequence[Callable[[], Found]], /) -> Iterable[Found]:
    """One after the other, in this process."""
    return (job() for job in jobs)


def files(drawn: Drawn, say: Callable[[str], None] = lambda note: None) -> Iterable[tuple[str, bytes]]:
    """Every sheet in the formats of a run, by the name of its file; at last what there is to say of them all."""
    return in_parts([lambda: drawn], say)


def in_parts(
    parts: Sequence[Callable[[], Drawn]], say: Callable[[str], None] = lambda note: None, way: Way = here
) -> Iterable[tuple[str, bytes]]:
    """The same of sheets that come in parts, each of which is a job; way: who does the jobs."""
    boxes: set[str] = set()
    for written, lost in way([partial(_written, part) for part in parts]):
        boxes |= lost
        yield from written
    for note in lacking_in(boxes):
        say(note)


def _written(part: Callable[[], Drawn]) -> tuple[Written, set[str]]:
    """Files by name, and characters that the font lacks."""
    every = list(part())
    lost = lacking("".join(text for __, sheet in every for text in sheet.texts()))
    return [(f"{stem}.{kind}", FORMATS[kind](sheet)) for stem, sheet in every for kind in OF_A_RUN], lost


def lacking_in(texts: Iterable[str]) -> Iterable[str]:
    """What there is to say of characters that no drawing can show."""
    boxes = lacking("".join(texts))
    if boxes:
        text = _("note: the font of the drawings lacks these characters, boxes stand for them: {characters}")
        yield text.format(characters=" ".join(sorted(boxes)))
