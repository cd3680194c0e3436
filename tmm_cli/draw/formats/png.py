"""Pictures of a drawing: PNG."""

from __future__ import annotations

import struct
import zlib
from typing import Any

import numpy as np
from matplotlib.backend_bases import GraphicsContextBase, RendererBase
from matplotlib.backends import backend_agg
from matplotlib.colors import to_rgb
from matplotlib.path import Path
from matplotlib.transforms import Affine2D
from numpy.typing import NDArray

from tmm_cli.draw.drawing import Drawing, Text
from tmm_cli.draw.fonts import outline
from tmm_cli.draw.formats.on_renderer import draw, foot

DPI = 110
PACKED = 3  # of 9: drawings get hardly smaller beyond
UP = 2  # PNG's filter: a line is told by how it differs from that above it
AGG: Any = backend_agg  # matplotlib does not say its types


def png(drawing: Drawing) -> bytes:
    """On white paper."""
    width, height = (round(side / 25.4 * DPI) for side in drawing.paper)
    renderer = AGG.RendererAgg(width, height, DPI)
    pixels = np.asarray(renderer.buffer_rgba())
    pixels[:] = 255
    draw(drawing, renderer, DPI, _write)
    return _packed(pixels[:, :, :3])


def _write(renderer: RendererBase, context: GraphicsContextBase, mark: Text, to_pixels: Affine2D) -> None:
    """A text is filled outlines: its letters stand where their widths say, whatever the pixels are."""
    start, along = foot(mark)
    places, codes = outline(mark.text, bold=mark.bold, italic=mark.italic)
    places = start + mark.size * along * places
    context.set_linewidth(0.0)
    context.set_snap(False)  # else letters of upright and level lines (l, E, F) may lose them between pixels
    path = Path(np.column_stack([places.real, places.imag]), codes)
    renderer.draw_path(context, path, to_pixels, to_rgb(mark.colour))


def _packed(pixels: NDArray[Any]) -> bytes:
    """The file of a picture; with the packing of drawings in mind a third of the time that libraries take."""
    height, width, __ = pixels.shape
    lines = pixels.reshape(height, -1)
    told = np.empty((height, 1 + 3 * width), np.uint8)
    told[:, 0], told[0, 1:], told[1:, 1:] = UP, lines[0], lines[1:] - lines[:-1]
    per_metre = round(DPI / 0.0254)
    return b"".join((
        b"\x89PNG\r\n\x1a\n",
        _chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)),
        _chunk(b"pHYs", struct.pack(">IIB", per_metre, per_metre, 1)),
        _chunk(b"IDAT", zlib.compress(told.tobytes(), PACKED)),
        _chunk(b"IEND", b""),
    ))  # fmt: skip


def _chunk(name: bytes, content: bytes) -> bytes:
    return struct.pack(">I", len(content)) + name + content + struct.pack(">I", zlib.crc32(name + content))
