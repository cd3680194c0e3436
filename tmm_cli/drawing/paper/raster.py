"""What is drawn, counted on small squares of paper: how much of it is in a box is then found by four look-ups."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tmm_cli.drawing.paper.boxes import Boxes, widen
from tmm_cli.drawing.paper.ground import (
    FAINT_PRICE_PER_MM,
    LINE_PRICE,
    LINE_PRICE_PER_MM,
    OUTSIDE_PRICE,
    TEXT_PRICE,
    TEXT_PRICE_PER_MM2,
    OccupiedArea,
)

SQUARE_SIDE, MOST_SQUARES = 0.5, 2000  # mm: a square's side; squares on the diagonal of a field, at most
RASTER_STEP = 0.4  # mm between the points that are counted on a line
RASTER_AIR = 0.35  # mm about a text that are free, besides what the squares at its edge take
SOLID_UNIT, TEXT_UNIT = 1 << 20, 1 << 40  # in one count: points on faint lines, on solid ones, squares in texts


class PriceRaster:
    """Sums of what is drawn in all boxes that begin at the lower left corner of a field."""

    def __init__(self, ground: OccupiedArea) -> None:
        self.low, self.high = ground.low, ground.high
        size = self.high - self.low
        self.cell = max(SQUARE_SIDE, abs(size) / MOST_SQUARES)
        across, up = (max(1, int(np.ceil(length / self.cell))) for length in (size.real, size.imag))
        self.shape = across, up
        count = np.zeros(across * up, np.int64)
        for pieces, weight in ((ground.faint, 1), (ground.solid, SOLID_UNIT)):
            x, y = self._squares(pieces.points(RASTER_STEP))
            inside = (x >= 0) & (x < across) & (y >= 0) & (y < up)
            count += weight * np.bincount(x[inside] * up + y[inside], minlength=across * up)
        squares = count.reshape(across, up)
        for left, right, low, high in self._edges(np.reshape(np.array(ground.boxes), (-1, 4))).tolist():
            squares[left:right, low:high] += TEXT_UNIT
        self.sums = np.zeros((across + 1, up + 1), np.int64)
        np.cumsum(np.cumsum(squares, axis=1, out=squares), axis=0, out=self.sums[1:, 1:])

    def _squares(self, places: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
        off = (places - self.low) / self.cell
        return np.floor(off.real).astype(int), np.floor(off.imag).astype(int)

    def _edges(self, boxes: Boxes) -> NDArray[Any]:
        """Numbers of the first square and of the one after the last, across and up."""
        x, y = self.low.real, self.low.imag
        off = (boxes - np.array([x, x, y, y])) / self.cell
        off[:, ::2], off[:, 1::2] = np.floor(off[:, ::2]), np.ceil(off[:, 1::2])
        across, up = self.shape
        found: NDArray[Any] = np.clip(off, 0, np.array([across, across, up, up])).astype(int)
        return found

    def price(self, boxes: Boxes) -> NDArray[Any]:
        """The price of what texts in these boxes cover: of lines, of texts, of the edge."""
        left, right, low, high = self._edges(widen(boxes, RASTER_AIR)).T
        sums = self.sums
        found = sums[right, high] - sums[left, high] - sums[right, low] + sums[left, low]
        lines, texts, faint = found % TEXT_UNIT // SOLID_UNIT, found // TEXT_UNIT, found % SOLID_UNIT
        price: NDArray[Any] = LINE_PRICE * (lines > 0) + RASTER_STEP * (
            LINE_PRICE_PER_MM * lines + FAINT_PRICE_PER_MM * faint
        )
        price += TEXT_PRICE * (texts > 0) + TEXT_PRICE_PER_MM2 * self.cell**2 * texts
        left, right, low, high = boxes.T
        beyond = (left < self.low.real) | (right > self.high.real) | (low < self.low.imag) | (high > self.high.imag)
        price += OUTSIDE_PRICE * beyond
        return price
