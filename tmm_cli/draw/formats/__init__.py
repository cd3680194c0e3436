"""Formats of drawings: a new one is a function in a file here and an entry below."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from tmm_cli.draw.drawing import Drawing
from tmm_cli.draw.fonts import lacking
from tmm_cli.draw.formats.dxf import dxf
from tmm_cli.draw.formats.pdf import pdf
from tmm_cli.draw.formats.png import png
from tmm_cli.draw.formats.svg import svg
from tmm_cli.errors import _

FORMATS: dict[str, Callable[[Drawing], bytes]] = {"png": png, "svg": svg, "pdf": pdf, "dxf": dxf}
OF_A_RUN = ("png", "svg")
Drawn = Iterable[tuple[str, Drawing]]


def files(drawn: Drawn, say: Callable[[str], None] = lambda note: None) -> Iterable[tuple[str, bytes]]:
    """Every sheet in the formats of a run, by the name of its file; at last what there is to say of them all."""
    texts: set[str] = set()
    for stem, sheet in drawn:
        texts.update(sheet.texts())
        for kind in OF_A_RUN:
            yield f"{stem}.{kind}", FORMATS[kind](sheet)
    for note in lacking_in(texts):
        say(note)


def lacking_in(texts: Iterable[str]) -> Iterable[str]:
    """What there is to say of characters that no drawing can show."""
    boxes = lacking("".join(texts))
    if boxes:
        text = _("note: the font of the drawings lacks these characters, boxes stand for them: {characters}")
        yield text.format(characters=" ".join(sorted(boxes)))
