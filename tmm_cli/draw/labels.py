"""Where labels go: beside their anchor, where they cover the least of what is drawn."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

STEP = 1.2  # mm between the points that stand for a line
RINGS = (1.2, 3.0, 5.5, 9.0)  # mm from the anchor to the label's near side
DIRECTIONS = 16


@dataclass(frozen=True)
class Label:
    """A text asked for at an anchor (mm on paper), `size` points high."""

    text: str
    anchor: complex
    size: float
    colour: str
    style: str = "normal"


@dataclass
class Ground:
    """What is drawn already, as points on paper (mm), and the labels put down so far as boxes."""

    low: complex
    high: complex
    points: list[NDArray[Any]] = field(default_factory=list)
    boxes: list[tuple[float, float, float, float]] = field(default_factory=list)

    def line(self, start: complex, end: complex) -> None:
        """A line is in the way."""
        number = max(2, int(abs(end - start) / STEP))
        if math.isfinite(abs(end - start)) and number < 5000:
            self.points.append(start + (end - start) * np.linspace(0, 1, number))

    def spot(self, place: complex, radius: float = 1.0) -> None:
        """A small figure is in the way."""
        self.points.append(place + radius * np.exp(1j * np.linspace(0, 2 * np.pi, 9)))

    def place(self, label: Label) -> complex:
        """The middle of the label where it covers the least; the label is then in the way of others."""
        width, height = extent(label)
        crowd = np.concatenate(self.points) if self.points else np.zeros(0, dtype=complex)
        near = crowd[np.abs(crowd - label.anchor) < RINGS[-1] + 2 * width + 5]
        best, best_cost = label.anchor, math.inf
        for ring, reach in enumerate(RINGS):
            for step in range(DIRECTIONS):
                angle = 2 * math.pi * (step + 0.5 * (ring % 2)) / DIRECTIONS + math.pi / 4
                along = complex(math.cos(angle), math.sin(angle))
                # the box touches a circle about the anchor
                middle = label.anchor + reach * along + complex(along.real * width / 2, along.imag * height / 2)
                cost = self._cost(middle, width, height, near) + 0.35 * reach
                if cost < best_cost:
                    best, best_cost = middle, cost
            if best_cost < 0.35 * reach + 0.2:
                break
        self.boxes.append(
            (best.real - width / 2, best.real + width / 2, best.imag - height / 2, best.imag + height / 2)
        )
        return best

    def _cost(self, middle: complex, width: float, height: float, near: NDArray[Any]) -> float:
        left, right = middle.real - width / 2 - 0.4, middle.real + width / 2 + 0.4
        low, high = middle.imag - height / 2 - 0.3, middle.imag + height / 2 + 0.3
        inside = (near.real > left) & (near.real < right) & (near.imag > low) & (near.imag < high)
        cost = float(np.count_nonzero(inside))
        for a, b, c, d in self.boxes:
            across, up = min(right, b) - max(left, a), min(high, d) - max(low, c)
            if across > 0 and up > 0:
                cost += 20 + across * up
        if left < self.low.real or right > self.high.real or low < self.low.imag or high > self.high.imag:
            cost += 50
        return cost


def extent(label: Label) -> tuple[float, float]:
    """Width and height of a text on paper, mm (a measure good enough to keep labels apart)."""
    point = 25.4 / 72
    narrow = sum(0.35 if c in "ᵗⁿ₀₁₂₃₄₅₆₇₈₉.,'il1|() " else 0.62 for c in label.text)
    return max(narrow, 0.6) * label.size * point + 0.6, label.size * point
