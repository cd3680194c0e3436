"""Formats of drawings: a new one is a function in a file here and an entry below."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from tmm_cli.draw.drawing import Drawing
from tmm_cli.draw.fonts import lacking
from tmm_cli.draw.formats.pdf import pdf
from tmm_cli.draw.formats.png import png
from tmm_cli.draw.formats.svg import svg
from tmm_cli.errors import _

FORMATS: dict[str, Callable[[Drawing], bytes]] = {"png": png, "svg": svg, "pdf": pdf}
OF_A_RUN = ("png", "svg")
Drawn = Iterable[tuple[str, Drawing]]


def files(drawn: Drawn, say: Callable[[str], None] = lambda note: None) -> Iterable[tuple[str, bytes]]:
    """Every sheet in the formats of a run, by the name of its file; at last what there is to say of them all."""
    boxes: set[str] = set()
    for stem, sheet in drawn:
        boxes |= lacking("".join(sheet.texts()))
        for kind in OF_A_RUN:
            yield f"{stem}.{kind}", FORMATS[kind](sheet)
    if boxes:
        text = _("note: the font of the drawings lacks these characters, boxes stand for them: {characters}")
        say(text.format(characters=" ".join(sorted(boxes))))
