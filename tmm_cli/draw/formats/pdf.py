"""Pages of a drawing: PDF, with vectors and the fonts in it."""

from __future__ import annotations

import io
from collections.abc import Sequence
from typing import Any

import matplotlib as mpl
from matplotlib.backend_bases import GraphicsContextBase, RendererBase
from matplotlib.font_manager import FontProperties
from matplotlib.transforms import Affine2D

from tmm_cli.draw.formats.on_renderer import draw, foot
from tmm_cli.draw.paper.drawing import POINT, Drawing, Text
from tmm_cli.draw.paper.fonts import FAMILY, drawable

DPI = 72  # PDF counts in points


def pdf(*drawings: Drawing) -> bytes:
    """A page for each drawing, without a date: the same drawings give the same bytes."""
    from matplotlib.backends import backend_pdf  # slow to load, and a run writes no PDF

    backend: Any = backend_pdf  # matplotlib does not say its types
    stream = io.BytesIO()
    with mpl.rc_context({"pdf.fonttype": 42, "text.hinting": "no_hinting"}):
        file = backend.PdfFile(stream, metadata={"CreationDate": None, "Producer": None, "Creator": None})
        for drawing in drawings:
            width, height = (side / 25.4 for side in drawing.paper)
            file.newPage(width, height)
            renderer = backend.RendererPdf(file, DPI, height, width)
            draw(drawing, renderer, DPI, _write)
            renderer.finalize()
        file.finalize()
        file.close()
    return stream.getvalue()


def _write(
    renderer: RendererBase, context: GraphicsContextBase, marks: Sequence[Text], to_points: Affine2D
) -> None:  # fmt: skip
    """Texts stay texts."""
    for mark in marks:
        start, __ = foot(mark)
        x, y = to_points.transform((start.real, start.imag))
        renderer.draw_text(context, x, y, drawable(mark.text), _font(mark), mark.turn)


def _font(mark: Text) -> Any:
    return FontProperties(
        family=FAMILY,
        size=mark.size / POINT,
        weight="bold" if mark.bold else "normal",
        style="italic" if mark.italic else "normal",
    )
