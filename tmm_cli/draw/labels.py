"""Where labels go: beside their anchor, where they cover the least of what is drawn."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from tmm_cli.draw import script
from tmm_cli.draw.drawing import POINT

STEP = 1.2  # mm between the points that stand for a line
RINGS = (1.2, 3.0, 5.5, 9.0)  # mm from the anchor to the label's near side
FARTHER = (13.0, 18.0, 24.0)
DIRECTIONS = 16
ALONG = (0.5, 0.42, 0.58, 0.34, 0.66, 0.26, 0.74, 0.18, 0.82)  # where a text stands beside a line, shares of its length

Box = tuple[float, float, float, float]  # left, right, low, high
Item = TypeVar("Item")


@dataclass(frozen=True)
class Label:
    """A text asked for at an anchor (mm on paper), `size` points high.

    line: it stands beside this line, wherever along it. far: it may stand farther off, a thin line leads to it then.
    """

    text: script.Words
    anchor: complex
    size: float
    colour: str
    style: str = "normal"
    line: tuple[complex, complex] | None = None
    far: bool = False


@dataclass
class Ground:
    """What is drawn already, as points on paper (mm), and the labels put down so far as boxes.

    rivals: lettered places; no label stands nearer to one of them than to its own; likewise lines that have names.
    """

    low: complex
    high: complex
    points: list[NDArray[Any]] = field(default_factory=list)
    boxes: list[Box] = field(default_factory=list)
    rivals: list[complex] = field(default_factory=list)
    lines: list[tuple[complex, complex]] = field(default_factory=list)

    @property
    def crowd(self) -> NDArray[Any]:
        """All points of what is drawn."""
        return np.concatenate([np.zeros(0, complex), *self.points])

    def line(self, start: complex, end: complex) -> None:
        """A line is in the way."""
        number = max(2, int(abs(end - start) / STEP))
        if math.isfinite(abs(end - start)) and number < 5000:
            self.points.append(start + (end - start) * np.linspace(0, 1, number))

    def curve(self, places: Sequence[complex]) -> None:
        """A line through places is in the way; of a smooth one they stand for it."""
        array = np.array(places)
        if len(array) > 2 and np.abs(np.diff(array)).max() < 2 * STEP:
            self.points.append(array)
        else:
            for start, end in pairwise(places):
                self.line(start, end)

    def spot(self, place: complex, radius: float = 1.0) -> None:
        """A small figure is in the way."""
        self.points.append(place + radius * np.exp(1j * np.linspace(0, 2 * np.pi, 9)))

    def place(self, label: Label) -> complex:
        """The middle of the label where it covers the least; the label is then in the way of others."""
        width, height = extent(label.text, label.size)
        reach = abs(label.line[1] - label.line[0]) / 2 if label.line else (FARTHER if label.far else RINGS)[-1]
        crowd = self.crowd
        near = crowd[np.abs(crowd - label.anchor) < reach + 2 * width + 5]
        best, best_cost, last = label.anchor, math.inf, 0.0
        for middle, price in candidates(label, width, height):
            if price > last + 1e-9 and best_cost < last + 0.2:
                break
            last = max(last, price)
            cost = self.covered(middle, width, height, near) + price + self._mistaken(label, middle, width, height)
            if cost < best_cost:
                best, best_cost = middle, cost
        self.boxes.append(about(best, width, height))
        return best

    def _mistaken(self, label: Label, middle: complex, width: float, height: float) -> float:
        """The price of standing nearer to another lettered place, or to another line, than to one's own."""
        if label.line is not None:
            here = aside(middle, *label.line)
            others = [aside(middle, *line) for line in self.lines if line != label.line]
            return 6.0 if others and min(others) < here + 0.5 else 0.0
        if not self.rivals:
            return 0.0
        box = about(middle, width, height)
        others = [away(box, r) for r in self.rivals if abs(r - label.anchor) > 0.5]
        return 6.0 if others and min(others) < away(box, label.anchor) + 0.8 else 0.0

    def covered(self, middle: complex, width: float, height: float, near: NDArray[Any]) -> float:
        """The price of what a text there covers: of these points, of other labels, of the edge."""
        left, right, low, high = about(middle, width + 0.8, height + 0.6)
        inside = (near.real > left) & (near.real < right) & (near.imag > low) & (near.imag < high)
        cost = float(np.count_nonzero(inside))
        for a, b, c, d in self.boxes:
            across, up = min(right, b) - max(left, a), min(high, d) - max(low, c)
            if across > 0 and up > 0:
                cost += 20 + across * up
        if left < self.low.real or right > self.high.real or low < self.low.imag or high > self.high.imag:
            cost += 50
        return cost


def candidates(label: Label, width: float, height: float) -> Iterator[tuple[complex, float]]:
    """Middles of a label's box and what each costs, cheapest first."""
    if label.line is not None:
        start, end = label.line
        span = (end - start) / (abs(end - start) or 1.0)
        for gap in (1.0, 2.2, 4.0, 7.0, 11.0, 16.0):
            for share in ALONG:
                for side in (1j, -1j):
                    out = side * span if (1j * span).imag >= 0 else -side * span  # above first
                    off = gap + abs(out.real) * width / 2 + abs(out.imag) * height / 2
                    yield start + share * (end - start) + off * out, 1.5 * gap + 3 * abs(share - 0.5)
        return
    for ring, reach in enumerate((*RINGS, *FARTHER) if label.far else RINGS):
        for step in range(DIRECTIONS):
            along = cmath.rect(1, 2 * math.pi * (step + 0.5 * (ring % 2)) / DIRECTIONS + math.pi / 4)
            # the box touches a circle about the anchor
            yield label.anchor + reach * along + complex(along.real * width / 2, along.imag * height / 2), 0.35 * reach


def gathered(placed: Iterable[tuple[complex, Item]]) -> list[tuple[complex, list[Item]]]:
    """Items by their place (mm): those that coincide on paper stand together."""
    found: list[tuple[complex, list[Item]]] = []
    for at, item in placed:
        same = next((items for place, items in found if abs(place - at) < 0.5), None)
        if same is None:
            found.append((at, [item]))
        else:
            same.append(item)
    return found


def aside(place: complex, start: complex, end: complex) -> float:
    """How far a place is from a stretch of a line."""
    span = end - start
    share = ((place - start) * span.conjugate()).real / (abs(span) ** 2 or 1.0)
    return abs(place - start - min(max(share, 0.0), 1.0) * span)


def about(middle: complex, width: float, height: float) -> Box:
    """The box about its middle."""
    return middle.real - width / 2, middle.real + width / 2, middle.imag - height / 2, middle.imag + height / 2


def row(middle: complex, along: complex, width: float, height: float) -> list[complex]:
    """Middles of squares that hold a text along a unit vector, side by side, as large as it is high."""
    reach = max(width - height, 0.0) / 2
    return [middle + share * reach * along for share in np.linspace(-1, 1, max(2, math.ceil(width / height)))]


def nearest(box: Box, place: complex) -> complex:
    """The place of a box that is nearest to another place."""
    return complex(min(max(place.real, box[0]), box[1]), min(max(place.imag, box[2]), box[3]))


def away(box: Box, place: complex) -> float:
    """How far a place is from a box."""
    return abs(nearest(box, place) - place)


def extent(text: script.Words, size: float) -> tuple[float, float]:
    """Width and height of a text on paper, mm, with a little air at its sides; size: points."""
    high = 1.0 if isinstance(text, str) else 1.3  # letters below and above the line
    return script.width(text, size * POINT) + 0.6, high * size * POINT
