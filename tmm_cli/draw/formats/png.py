"""Pictures of a drawing: PNG."""

from __future__ import annotations

import io
from typing import Any

from matplotlib.backends import backend_agg
from PIL import Image

from tmm_cli.draw.drawing import Drawing
from tmm_cli.draw.formats.on_renderer import draw

DPI = 110
AGG: Any = backend_agg  # matplotlib does not say its types


def png(drawing: Drawing) -> bytes:
    """Packed less than it could be: a seventh longer, a third quicker."""
    width, height = (round(side / 25.4 * DPI) for side in drawing.paper)
    renderer = AGG.RendererAgg(width, height, DPI)
    draw(drawing, renderer, DPI)
    stream = io.BytesIO()
    picture = Image.frombuffer("RGBA", (width, height), renderer.buffer_rgba(), "raw", "RGBA", 0, 1)
    white = Image.new("RGB", picture.size, "white")
    white.paste(picture, mask=picture.getchannel("A"))
    white.save(stream, format="png", compress_level=3, dpi=(DPI, DPI))
    return stream.getvalue()
