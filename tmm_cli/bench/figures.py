"""Charts that matplotlib draws itself, as PNG and SVG."""

from __future__ import annotations

import io
from collections.abc import Callable

import matplotlib as mpl
from matplotlib.figure import Figure

DPI = 110
mpl.rcParams["svg.hashsalt"] = "tmm"  # the same figure gives the same bytes
mpl.rcParams["svg.fonttype"] = "path"


def png(figure: Figure) -> bytes:
    """At the resolution of all pictures."""
    stream = io.BytesIO()
    figure.savefig(stream, format="png", dpi=DPI, metadata={"Software": None}, pil_kwargs={"compress_level": 3})
    return stream.getvalue()


def svg(figure: Figure) -> bytes:
    """Without a date: the same figure gives the same bytes."""
    stream = io.BytesIO()
    figure.savefig(stream, format="svg", dpi=DPI, metadata={"Date": None, "Creator": None})
    return stream.getvalue()


FIGURES: dict[str, Callable[[Figure], bytes]] = {"png": png, "svg": svg}
