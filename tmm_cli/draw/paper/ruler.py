"""A scale with numbers of positions beside the way of an output, straight or about a pivot."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from tmm_cli.draw.paper.boxes import about
from tmm_cli.draw.paper.labels import extent
from tmm_cli.draw.paper.labels import gathered as in_place
from tmm_cli.draw.paper.sheet import DARK, GREY_TEXT, THIN, Sheet
from tmm_cli.vectors import Real, Vector, dot

SIZE = 8.0  # points
TICK = 1.6  # mm
GAP = 0.7  # mm between a tick and its number, and between numbers
CLEAR = 5.6  # mm on both sides of the way, for boxes and rails
FARTHER = (0.0, 5.0, 10.0, 15.0)  # mm
ARC = 1.0  # mm between points of a drawn arc


@dataclass(frozen=True)
class Ruler:
    """Along a line, `along`, through a place `base` (mm); or on a circle about it, from the middle that `along` shows.

    off: how far it is off the way, to the left of a line or outside a circle, mm.
    """

    base: complex
    along: complex
    off: float
    radius: float = 0.0

    def at(self, run: float, out: float = 0.0) -> complex:
        """The place at a run along it (mm), and so far out from it."""
        if self.radius == 0:
            return self.base + run * self.along + (self.off + out * self.side) * 1j * self.along
        return self.base + (self.radius + self.off + out * self.side) * self.along * cmath.rect(1, run / self.radius)

    @property
    def side(self) -> float:
        return float(np.sign(self.off))

    def way(self, run: float) -> complex:
        """The place on the way itself."""
        return replace(self, off=0.0).at(run)

    def away(self, places: Vector) -> Vector:
        """How far places are from the way, on the side of the ruler, mm."""
        off = places - self.base
        if self.radius == 0:
            return self.side * np.asarray(dot(1j * self.along, off))
        return self.side * np.asarray(abs(off) - self.radius)

    def run(self, places: Vector | complex) -> Real:
        """How far along it places on the way are, mm."""
        off = places - self.base
        if self.radius == 0:
            return np.asarray(dot(self.along, off))
        return self.radius * np.asarray(np.angle(off / self.along))

    def out(self, run: float) -> complex:
        """The direction away from the way."""
        step = self.at(run, 1.0) - self.at(run)
        return step / abs(step)


@dataclass(frozen=True)
class Number:
    """The mark of a position at a run along a ruler; outer: on the side away from the way."""

    run: float
    text: str
    outer: bool = True
    strong: bool = False


def ruler_of(way: Sequence[complex], line: complex, pivot: complex | None) -> Ruler:
    """For places of a way (mm) along a line, or about a pivot."""
    found = [place for place in way if np.isfinite(place)]
    if pivot is None:
        middle = sum(found) / len(found)
        return Ruler(found[0] + line * float(dot(line, middle - found[0])), line, 1.0)
    angles = np.unwrap([cmath.phase(place - pivot) for place in found])
    return Ruler(pivot, cmath.rect(1, float(angles.max() + angles.min()) / 2), 1.0, abs(found[0] - pivot))


def height(ruler: Ruler, numbers: Sequence[Number]) -> float:
    """How much room numbers take across a ruler, mm."""
    return max((across(ruler, number) for number in numbers), default=0.0)


def across(ruler: Ruler, number: Number) -> float:
    """Of one number."""
    out, (wide, high) = ruler.out(number.run), extent(number.text, SIZE)
    return abs(out.real) * wide + abs(out.imag) * high


def along(ruler: Ruler, number: Number) -> float:
    """How much room a number takes along a ruler, mm."""
    out, (wide, high) = ruler.out(number.run), extent(number.text, SIZE)
    return min(wide / max(abs(out.imag), 1e-9), high / max(abs(out.real), 1e-9)) + GAP


def roomiest(ruler: Ruler, numbers: Sequence[Number], lines: Vector) -> Ruler:
    """The ruler on either side of the way, at least as far off as its inner numbers need, where least is drawn (mm)."""
    inner = height(ruler, [number for number in numbers if not number.outer])
    least = CLEAR + (inner + TICK + 2 * GAP if inner else 0.0)
    choices = [replace(ruler, off=side * (least + more)) for more in FARTHER for side in (-1.0, 1.0)]
    return min(choices, key=lambda one: crowded(one, numbers, lines) + abs(one.off) / 3)


def reach(ruler: Ruler, numbers: Sequence[Number]) -> float:
    """How far from the ruler its outer numbers end, mm."""
    return TICK + GAP + height(ruler, [number for number in numbers if number.outer])


def crowded(ruler: Ruler, numbers: Sequence[Number], lines: Vector) -> float:
    """How much of what is drawn (points, mm) is where the ruler would be; more than all where it has no room."""
    if ruler.radius and ruler.radius + ruler.off < reach(ruler, numbers) + CLEAR:
        return math.inf
    runs, own, far = [number.run for number in numbers], ruler.run(lines), ruler.away(lines)
    inside = (own > min(runs) - CLEAR) & (own < max(runs) + CLEAR)
    inner = height(ruler, [number for number in numbers if not number.outer])
    inside &= (far > abs(ruler.off) - inner - TICK - GAP) & (far < abs(ruler.off) + reach(ruler, numbers))
    return float(np.count_nonzero(inside))


def gathered(numbers: Sequence[Number]) -> list[Number]:
    """Numbers that coincide on paper stand together, with an end of the way at its place."""
    found = []
    for __, here in in_place((complex(number.run, number.outer), number) for number in numbers):
        place = next((number for number in here if number.strong), here[0])
        found.append(replace(place, text=", ".join(number.text for number in here)))
    return found


def draw_ruler(sheet: Sheet, ruler: Ruler, numbers: Sequence[Number]) -> None:
    """The scale with a tick and a number for each position; numbers that would touch one another stand apart."""
    runs = [number.run for number in numbers]
    steps = max(2, int((max(runs) - min(runs)) / ARC)) if ruler.radius else 2
    sheet.line([ruler.at(float(run)) for run in np.linspace(min(runs), max(runs), steps)], THIN, 0.7, z=2.6)
    for outer in (True, False):
        row = sorted((n for n in numbers if n.outer == outer), key=lambda n: n.run)
        sign = 1.0 if outer else -1.0
        wide = [along(ruler, number) for number in row]
        for number, run in zip(row, spread([n.run for n in row], wide), strict=True):
            colour = DARK if number.strong else THIN
            foot, tip = ruler.at(number.run), ruler.at(number.run, sign * TICK)
            sheet.line([foot, tip], colour, 1.1 if number.strong else 0.7, z=2.6)
            middle = ruler.at(run, sign * (TICK + GAP + across(ruler, number) / 2))
            if abs(run - number.run) > 1.0:
                sheet.line([tip, ruler.at(run, sign * (TICK + GAP))], THIN, 0.4, z=2.6)
            colour = DARK if number.strong else GREY_TEXT
            if sheet.ground.free(about(middle, *extent(number.text, SIZE))):
                sheet.text(middle, number.text, SIZE, colour=colour, ha="center")
            else:
                sheet.label(number.text, tip, SIZE, colour)


def spread(wanted: Sequence[float], sizes: Sequence[float]) -> list[float]:
    """Middles of intervals of these sizes, in order, as near as can be to where they are wanted without touching."""
    heaps: list[tuple[float, list[int]]] = []  # where each heap of touching intervals begins
    for k in range(len(wanted)):
        heap = [k]
        while True:
            ends = np.cumsum([0.0, *(sizes[n] for n in heap)])
            start = float(np.mean([wanted[n] - sizes[n] / 2 - end for n, end in zip(heap, ends, strict=False)]))
            if not heaps or heaps[-1][0] + sum(sizes[n] for n in heaps[-1][1]) <= start + 1e-9:
                break
            heap = [*heaps.pop()[1], *heap]
        heaps.append((start, heap))
    found = []
    for start, heap in heaps:
        for n in heap:
            found.append(start + sizes[n] / 2)
            start += sizes[n]
    return found
