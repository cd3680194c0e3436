"""Common parts of the charts: an A4 page with a title, axes with plain numbers and light grids, the image file."""

from __future__ import annotations

import io
from typing import Any

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullFormatter

from tmm_cli.mechanics.plans import LANDSCAPE

MM = 1 / 25.4  # inches
INK, GREY, RED, BLUE, GREEN, ORANGE = "#1a1a1a", "#8a8a8a", "#b3261e", "#1f4e9c", "#1d7a3a", "#c77700"
DPI = 110
PLAIN = FuncFormatter(lambda value, __: f"{value:g}")


def make_page(title: str, caption: str, share: float = 1.0) -> Figure:
    """Make a landscape A4 page with a title and a caption; `share` reduces its height to this fraction."""
    height = share * LANDSCAPE[1]
    figure = Figure(figsize=(LANDSCAPE[0] * MM, height * MM))
    FigureCanvasAgg(figure)
    figure.text(0.05, 1 - 8 / height, title, fontsize=13, weight="bold")
    figure.text(0.05, 1 - 13.7 / height, caption, fontsize=7.5, color="#404040", parse_math=False)
    return figure


def label_axes(axes: Any, title: str, x: str = "", y: str = "") -> None:
    """Set the title and the axis labels; make the tick labels small and draw a light grid."""
    axes.set_title(title, fontsize=10, loc="left")
    axes.set_xlabel(x, fontsize=9)
    axes.set_ylabel(y, fontsize=9)
    axes.tick_params(labelsize=8)
    axes.grid(True, color="#e2e2e2", lw=0.5)
    axes.set_axisbelow(True)


def set_log_axes(axes: Any) -> None:
    """Make both axes logarithmic, with plain numbers as tick labels."""
    for set_scale, axis in ((axes.set_xscale, axes.xaxis), (axes.set_yscale, axes.yaxis)):
        set_scale("log")
        axis.set_major_formatter(PLAIN)
        axis.set_minor_formatter(NullFormatter())


def set_error_axis(axes: Any, powers: range) -> None:
    """Make the y axis logarithmic, with ticks at the given powers of ten."""
    axes.set_yscale("log")
    axes.set_yticks([10.0**k for k in powers], [f"1e{k}" if k else "1" for k in powers])
    axes.yaxis.set_minor_formatter(NullFormatter())


def png_bytes(figure: Figure) -> bytes:
    """Return the figure as the contents of a PNG file; equal figures give equal bytes."""
    stream = io.BytesIO()
    figure.savefig(stream, format="png", dpi=DPI, metadata={"Software": None}, pil_kwargs={"compress_level": 3})
    return stream.getvalue()
