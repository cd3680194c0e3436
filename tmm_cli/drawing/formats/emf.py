"""EMF files (Enhanced Metafile) for word processors, with vector graphics. Texts are written as outlines.

The records are those of Microsoft's [MS-EMF]; a logical unit is a hundredth of a millimetre.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from matplotlib.colors import to_rgb
from matplotlib.path import Path
from matplotlib.transforms import Affine2D
from numpy.typing import NDArray

from tmm_cli.drawing.paper import AreaMark, CircleMark, Drawing, LineMark, Mark, TextMark, baseline, glyph_outline
from tmm_cli.mechanics.numerics import Vector

UNITS_PER_MM = 100  # logical units per mm
DEVICE_PIXELS = 30000  # width and height of the reference device
NO_PEN, NO_BRUSH = 0x80000008, 0x80000005  # stock objects
HEADER_RECORD, END_RECORD, BACKGROUND_MODE, FILL_MODE = 1, 14, 18, 19
SELECT_OBJECT, CREATE_BRUSH, DRAW_ELLIPSE = 37, 39, 42
DRAW_POLYGON, DRAW_POLYLINE, DRAW_POLYGONS, CREATE_PEN = 86, 87, 91, 95
TRANSPARENT, WINDING_FILL, GEOMETRIC_PEN = 1, 2, 0x10000


def write_emf(drawing: Drawing) -> bytes:
    """Write a drawing as an Enhanced Metafile; coordinates are rounded to 0.01 mm."""
    pen = _RecordWriter(drawing.paper[1])
    body = [_record(BACKGROUND_MODE, "I", TRANSPARENT), _record(FILL_MODE, "I", WINDING_FILL)]
    for mark in drawing.marks:
        body += pen.mark(mark)
    records = [*body, _record(END_RECORD, "3I", 0, 16, 20)]
    width, height = (round(side * UNITS_PER_MM) for side in drawing.paper)
    size = 108 + sum(map(len, records))
    box = (0, 0, width, height)
    header = _record(
        HEADER_RECORD,
        "8i4I2H3I4i3I2I",
        *box,
        *box,
        0x464D4520,
        0x10000,
        size,
        len(records) + 1,
        len(pen.handles) + 1,
        0,
        0,
        0,
        0,
        DEVICE_PIXELS,
        DEVICE_PIXELS,
        DEVICE_PIXELS // UNITS_PER_MM,
        DEVICE_PIXELS // UNITS_PER_MM,
        0,
        0,
        0,
        *[1000 * DEVICE_PIXELS // UNITS_PER_MM] * 2,
    )
    return b"".join((header, *records))


class _RecordWriter:
    """Writer of EMF records for the marks of a drawing. Each pen and brush is created only once.

    height: height of the paper, mm.
    """

    def __init__(self, height: float) -> None:
        self.height = height
        self.handles: dict[tuple[str, float], int] = {}
        self.selected: dict[bool, int] = {}

    def mark(self, mark: Mark) -> Iterable[bytes]:
        match mark:
            case LineMark():
                yield from self._pen(mark.colour, mark.width)
                yield from self._polylines(_dash_polyline(np.array(mark.places), mark.dashes))
            case AreaMark():
                yield from self._brush(mark.face)
                yield from self._pen(mark.edge, mark.width)
                yield _points_record(DRAW_POLYGON, self._places(np.array(mark.corners)))
            case CircleMark():
                yield from self._brush(mark.face)
                yield from self._pen(mark.edge, mark.width)
                corner = mark.radius * (1 + 1j)
                (x0, y1), (x1, y0) = self._places(np.array([mark.centre - corner, mark.centre + corner])).tolist()
                yield _record(DRAW_ELLIPSE, "4i", x0, y0, x1, y1)
            case TextMark():
                yield from self._brush(mark.colour)
                yield from self._pen(None, 0.0)
                yield from self._letters(mark)

    def _places(self, points: Vector) -> NDArray[np.int16]:
        return _rounded(np.column_stack([points.real, self.height - points.imag]) * UNITS_PER_MM)

    def _polylines(self, lines: Iterable[Vector]) -> Iterable[bytes]:
        return (_points_record(DRAW_POLYLINE, self._places(line)) for line in lines)

    def _letters(self, mark: TextMark) -> Iterable[bytes]:
        outline, codes = glyph_outline(mark.text, bold=mark.bold, italic=mark.italic)
        if not len(outline):
            return
        start, along = baseline(mark)
        placed = start + mark.size * along * outline
        path = Path(np.column_stack([placed.real, placed.imag]), codes)
        turned = Affine2D().scale(UNITS_PER_MM, -UNITS_PER_MM).translate(0, UNITS_PER_MM * self.height)
        polygons = [np.asarray(polygon) for polygon in path.to_polygons(turned)]
        if polygons:
            counts = [len(p) for p in polygons]
            points = _rounded(np.concatenate(polygons))
            yield _record(
                DRAW_POLYGONS,
                f"4iII{len(counts)}I",
                *_bounding_box(points),
                len(counts),
                len(points),
                *counts,
                data=points.tobytes(),
            )

    def _pen(self, colour: str | None, width: float) -> Iterable[bytes]:
        if colour is None:
            yield from self._select(True, NO_PEN)
            return
        key = (colour, max(width, 0.01))
        if key not in self.handles:
            self.handles[key] = len(self.handles) + 1
            style = (GEOMETRIC_PEN, round(key[1] * UNITS_PER_MM), 0, _colour_number(colour), 0, 0)
            yield _record(CREATE_PEN, "5I6I", self.handles[key], 0, 0, 0, 0, *style)
        yield from self._select(True, self.handles[key])

    def _brush(self, colour: str) -> Iterable[bytes]:
        key = (colour, 0.0)
        if key not in self.handles:
            self.handles[key] = len(self.handles) + 1
            yield _record(CREATE_BRUSH, "4I", self.handles[key], 0, _colour_number(colour), 0)
        yield from self._select(False, self.handles[key])

    def _select(self, pen: bool, handle: int) -> Iterable[bytes]:
        if self.selected.get(pen) != handle:
            self.selected[pen] = handle
            yield _record(SELECT_OBJECT, "I", handle)


def _dash_polyline(points: Vector, dashes: Sequence[float]) -> Iterable[Vector]:
    """Split a polyline into dashes.

    dashes: lengths (mm) of dashes and gaps in turn; if there are none, the whole polyline is returned.
    """
    if not dashes or len(points) < 2:
        yield points
        return
    lengths = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(points)))])
    turns = int(np.ceil(lengths[-1] / sum(dashes)))
    ends = np.concatenate([[0.0], np.cumsum(np.tile(dashes, turns))])
    for start, end in zip(ends[:-1:2], ends[1::2], strict=True):
        if start < lengths[-1]:
            inner = (lengths > start) & (lengths < end)
            at = np.concatenate([[start], lengths[inner], [min(end, lengths[-1])]])
            yield np.interp(at, lengths, points.real) + 1j * np.interp(at, lengths, points.imag)


def _rounded(points: NDArray[Any]) -> NDArray[np.int16]:
    return np.asarray(np.clip(np.rint(points), -32768, 32767), "<i2")


def _colour_number(name: str) -> int:
    red, green, blue = (round(255 * channel) for channel in to_rgb(name))
    return red | green << 8 | blue << 16


def _points_record(kind: int, points: NDArray[np.int16]) -> bytes:
    return _record(kind, "4iI", *_bounding_box(points), len(points), data=points.tobytes())


def _bounding_box(points: NDArray[np.int16]) -> tuple[int, int, int, int]:
    (x0, y0), (x1, y1) = points.min(axis=0).tolist(), points.max(axis=0).tolist()
    return x0, y0, x1, y1


def _record(kind: int, form: str, *values: int, data: bytes = b"") -> bytes:
    content = struct.pack(f"<{form}", *values) + data
    return struct.pack("<II", kind, 8 + len(content)) + content
