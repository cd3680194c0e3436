"""Formats of drawings: a new one is a function in a file here and an entry below."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterable

from matplotlib.figure import Figure

DPI = 110
Drawn = Iterable[tuple[str, Figure]]


def png(figure: Figure) -> bytes:
    """Packed less than it could be: a seventh longer, a third quicker."""
    stream = io.BytesIO()
    figure.savefig(stream, format="png", dpi=DPI, metadata={"Software": None}, pil_kwargs={"compress_level": 3})
    return stream.getvalue()


def svg(figure: Figure) -> bytes:
    """Without a date: the same figure gives the same bytes."""
    stream = io.BytesIO()
    figure.savefig(stream, format="svg", dpi=DPI, metadata={"Date": None, "Creator": None})
    return stream.getvalue()


FORMATS: dict[str, Callable[[Figure], bytes]] = {"png": png, "svg": svg}


def files(drawn: Drawn) -> Iterable[tuple[str, bytes]]:
    """Every sheet in every format, by the name of its file."""
    for stem, figure in drawn:
        for kind, write in FORMATS.items():
            yield f"{stem}.{kind}", write(figure)
