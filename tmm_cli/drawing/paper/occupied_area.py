"""Lines and texts that a drawing already contains, and the cost of covering them with a label."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tmm_cli.drawing.paper.boxes import Box, Boxes, lengths_inside, shared_areas, widen
from tmm_cli.drawing.paper.record import ARROWHEAD_HALF_WIDTH

SAMPLE_STEP = 1.2  # mm between sample points of a line
LONGEST_LINE = 5000.0  # mm: longer lines are ignored
CIRCLE_CORNERS = np.exp(1j * np.linspace(0, 2 * np.pi, 9))  # polygon that represents a small circle
TEXT_AIR = 0.35  # mm kept free about a text
LINE_PRICE = 14.0  # of covering any line
LINE_PRICE_PER_MM, FAINT_PRICE_PER_MM = 2.0, 0.3  # of each covered mm of a solid and of a faint line
TEXT_PRICE, TEXT_PRICE_PER_MM2 = 40.0, 2.0  # of covering any text, and of each covered mm²
OUTSIDE_PRICE = 200.0  # of a position beyond the edge of the field


@dataclass
class Segments:
    """Collection of line segments. They are added one by one and evaluated together as arrays."""

    fresh: list[tuple[complex, complex]] = field(default_factory=list)
    found: NDArray[Any] = field(default_factory=lambda: np.zeros((0, 2), complex))
    reach: NDArray[Any] = field(default_factory=lambda: np.zeros((4, 0)))  # left, right, low, high of each

    def path(self, points: Sequence[complex]) -> None:
        """Add the segments of a polyline."""
        self.fresh += [
            (start, end)
            for start, end in pairwise(points)
            if abs(end - start) < LONGEST_LINE  # False for non-finite points too
        ]

    @property
    def all(self) -> NDArray[Any]:
        """Both ends of each segment, (segments, 2), mm."""
        if self.fresh:
            self.found = np.concatenate([self.found, np.array(self.fresh, complex)])
            self.fresh.clear()
            xs, ys = self.found.real, self.found.imag
            self.reach = np.stack([xs.min(axis=1), xs.max(axis=1), ys.min(axis=1), ys.max(axis=1)])
        return self.found

    def near(self, field: Box) -> NDArray[Any]:
        """Return the segments whose bounding boxes overlap a box, (segments, 2), mm."""
        segments, (left, right, low, high) = self.all, field
        first, last, under, over = self.reach
        near: NDArray[Any] = segments[(last >= left) & (first <= right) & (over >= low) & (under <= high)]
        return near

    def points(self, step: float = SAMPLE_STEP) -> NDArray[Any]:
        """Return points along all segments, about `step` mm apart."""
        starts, ends = self.all.T
        counts = np.maximum(2, (np.abs(ends - starts) / step).astype(int))
        whose = np.repeat(np.arange(len(counts)), counts)
        number = np.arange(len(whose)) - np.repeat(np.cumsum(counts) - counts, counts)
        points: NDArray[Any] = starts[whose] + (ends - starts)[whose] * number / (counts[whose] - 1)
        return points


@dataclass
class OccupiedArea:
    """Field of the paper with the lines and texts that it already contains.

    Attributes:
        low, high: lower left and upper right corner of the field, mm.
        boxes: bounding boxes of texts, mm.
        rivals: named points, mm. A label must not be nearer to one of them than to the point that it names.
        lines: named lines, mm. A label must not be nearer to one of them than to the point or line that it names.
        solid: lines that labels must not cover.
        faint: thin lines that are interrupted where labels cover them.
    """

    low: complex
    high: complex
    boxes: list[Box] = field(default_factory=list)
    rivals: list[complex] = field(default_factory=list)
    lines: list[tuple[complex, complex]] = field(default_factory=list)
    solid: Segments = field(default_factory=Segments)
    faint: Segments = field(default_factory=Segments)

    @property
    def line_points(self) -> NDArray[Any]:
        """Closely spaced points along the solid lines, mm."""
        return self.solid.points()

    @property
    def text_points(self) -> NDArray[Any]:
        """Points in the boxes of all texts, mm."""
        left, right, low, high = np.reshape(np.array(self.boxes), (-1, 4)).T
        points: NDArray[Any] = np.linspace(left, right, 5)[:, None] + 1j * np.linspace(low, high, 2)
        return points.ravel()

    def line(self, start: complex, end: complex) -> None:
        """Add a solid line between two points, mm."""
        self.solid.path([start, end])

    def path(self, points: Sequence[complex]) -> None:
        """Add a solid polyline, mm."""
        self.solid.path(points)

    def spot(self, place: complex, radius: float = 1.0) -> None:
        """Add a solid circle about a point, mm."""
        turns = (
            CIRCLE_CORNERS
            if radius < 4 * SAMPLE_STEP
            else np.exp(1j * np.linspace(0, 2 * np.pi, int(6 * radius / SAMPLE_STEP)))
        )
        self.path([complex(corner) for corner in place + radius * turns])

    def free(self, box: Box) -> bool:
        """Return True if a text in this box would not cover anything."""
        return bool(self.price(np.array([box]))[0] < LINE_PRICE)

    def crossing_price(self, lines: Sequence[tuple[complex, complex]]) -> float:
        """Return the cost of the texts that line segments, or arrowheads on them, would cover."""
        if not self.boxes:
            return 0.0
        return TEXT_PRICE * float(
            np.count_nonzero(lengths_inside(widen(np.array(self.boxes), ARROWHEAD_HALF_WIDTH), *np.array(lines).T))
        )

    def price(self, boxes: Boxes) -> NDArray[Any]:
        """Return the cost of a text in each of several boxes, (boxes,).

        It grows with the lines and texts that the text would cover, and with the part of the text outside the field.
        """
        wide = widen(boxes, TEXT_AIR)
        room = wide[:, 0].min(), wide[:, 1].max(), wide[:, 2].min(), wide[:, 3].max()
        solid, faint = self.solid.near(room), self.faint.near(room)
        lengths = lengths_inside(wide, *np.concatenate([solid, faint]).T)
        inside, thin = lengths[:, : len(solid)].sum(axis=1), lengths[:, len(solid) :].sum(axis=1)
        prices: NDArray[Any] = LINE_PRICE * (inside > 0) + LINE_PRICE_PER_MM * inside + FAINT_PRICE_PER_MM * thin
        prices += overlap_price(boxes, np.array(self.boxes))
        left, right, low, high = boxes.T
        beyond = (left < self.low.real) | (right > self.high.real) | (low < self.low.imag) | (high > self.high.imag)
        prices += OUTSIDE_PRICE * beyond
        return prices


def overlap_price(boxes: Boxes, others: Boxes) -> NDArray[Any]:
    """Return the cost of a text in each of several boxes, (boxes,), due to the other texts that it would cover."""
    if not len(others):
        return np.zeros(len(boxes))
    areas = shared_areas(widen(boxes, TEXT_AIR), others)
    prices: NDArray[Any] = (TEXT_PRICE * (areas > 0) + TEXT_PRICE_PER_MM2 * areas).sum(axis=1)
    return prices


SQUARE_SIDE = 0.5  # mm: side of a square of the raster
MOST_SQUARES = 2000  # on the diagonal of a field
RASTER_STEP = 0.4  # mm between the points that are counted on a line
RASTER_AIR = 0.35  # mm kept free about a text, in addition to the squares at its edge
SOLID_UNIT, TEXT_UNIT = 1 << 20, 1 << 40  # one count holds points on faint lines, on solid lines, squares in texts


class PriceRaster:
    """Approximate computation of the cost of a text in a box, from the lines and texts counted in small squares.

    The counts are cumulative (a summed-area table), so four look-ups give the total for any box.
    """

    def __init__(self, canvas: OccupiedArea) -> None:
        self.low, self.high = canvas.low, canvas.high
        size = self.high - self.low
        self.cell = max(SQUARE_SIDE, abs(size) / MOST_SQUARES)
        across, up = (max(1, int(np.ceil(length / self.cell))) for length in (size.real, size.imag))
        self.shape = across, up
        count = np.zeros(across * up, np.int64)
        for pieces, weight in ((canvas.faint, 1), (canvas.solid, SOLID_UNIT)):
            x, y = self._squares(pieces.points(RASTER_STEP))
            inside = (x >= 0) & (x < across) & (y >= 0) & (y < up)
            count += weight * np.bincount(x[inside] * up + y[inside], minlength=across * up)
        squares = count.reshape(across, up)
        for left, right, low, high in self._edges(np.reshape(np.array(canvas.boxes), (-1, 4))).tolist():
            squares[left:right, low:high] += TEXT_UNIT
        self.sums = np.zeros((across + 1, up + 1), np.int64)
        np.cumsum(np.cumsum(squares, axis=1, out=squares), axis=0, out=self.sums[1:, 1:])

    def _squares(self, points: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
        off = (points - self.low) / self.cell
        return np.floor(off.real).astype(int), np.floor(off.imag).astype(int)

    def _edges(self, boxes: Boxes) -> NDArray[Any]:
        """Return the squares that each box covers, (boxes, 4).

        The columns are the first and the last + 1 horizontally, then the first and the last + 1 vertically.
        """
        x, y = self.low.real, self.low.imag
        off = (boxes - np.array([x, x, y, y])) / self.cell
        off[:, ::2], off[:, 1::2] = np.floor(off[:, ::2]), np.ceil(off[:, 1::2])
        across, up = self.shape
        edges: NDArray[Any] = np.clip(off, 0, np.array([across, across, up, up])).astype(int)
        return edges

    def price(self, boxes: Boxes) -> NDArray[Any]:
        """Return the approximate cost of a text in each of several boxes; `OccupiedArea.price` is exact."""
        left, right, low, high = self._edges(widen(boxes, RASTER_AIR)).T
        sums = self.sums
        counts = sums[right, high] - sums[left, high] - sums[right, low] + sums[left, low]
        lines, texts, faint = counts % TEXT_UNIT // SOLID_UNIT, counts // TEXT_UNIT, counts % SOLID_UNIT
        price: NDArray[Any] = LINE_PRICE * (lines > 0) + RASTER_STEP * (
            LINE_PRICE_PER_MM * lines + FAINT_PRICE_PER_MM * faint
        )
        price += TEXT_PRICE * (texts > 0) + TEXT_PRICE_PER_MM2 * self.cell**2 * texts
        left, right, low, high = boxes.T
        beyond = (left < self.low.real) | (right > self.high.real) | (low < self.low.imag) | (high > self.high.imag)
        price += OUTSIDE_PRICE * beyond
        return price
