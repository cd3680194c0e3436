"""Pages of a drawing: PDF, with vectors and the fonts in it."""

from __future__ import annotations

import io
from typing import Any

import matplotlib as mpl
from matplotlib.backends import backend_pdf

from tmm_cli.draw.drawing import Drawing
from tmm_cli.draw.formats.on_renderer import draw

DPI = 72  # PDF counts in points
PDF: Any = backend_pdf  # matplotlib does not say its types


def pdf(*drawings: Drawing) -> bytes:
    """A page for each drawing, without a date: the same drawings give the same bytes."""
    stream = io.BytesIO()
    with mpl.rc_context({"pdf.fonttype": 42}):
        file = PDF.PdfFile(stream, metadata={"CreationDate": None, "Producer": None, "Creator": None})
        for drawing in drawings:
            width, height = (side / 25.4 for side in drawing.paper)
            file.newPage(width, height)
            renderer = PDF.RendererPdf(file, DPI, height, width)
            draw(drawing, renderer, DPI)
            renderer.finalize()
        file.finalize()
        file.close()
    return stream.getvalue()
