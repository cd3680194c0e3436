"""The paper, the scale and the place at which a figure is largest and leaves room for a block of notes and tables."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import count

import numpy as np

from tmm_cli.draw.paper.blocks import Block, corners, covered
from tmm_cli.draw.paper.picture import longest_for, on_large_sheet
from tmm_cli.plans.record import LANDSCAPE, PORTRAIT, ROUND, extent, ground_of, round_scale
from tmm_cli.vectors import Vector

ALONG = (0.5, 0.0, 1.0, 0.25, 0.75)  # of what is free beside the figure, across and up: where it is put
SHIFTS = [complex(x, y) for x in ALONG for y in ALONG]
SMALLER = 4.0  # times smaller a figure may become for the sake of a block
SPOTS = 40  # points that stand for a line


@dataclass
class Figure:
    """What goes on a sheet: places (SI), how far (mm) it is off them, and the room (mm) that it needs about it."""

    places: list[Vector] = field(default_factory=list)
    off: list[Vector] = field(default_factory=list)
    about: list[Vector] = field(default_factory=list)

    def spots(self, places: Sequence[complex] | Vector, about: float, off: complex = 0j) -> None:
        """Places (SI), those that are finite."""
        found = np.asarray(places, complex)
        found = found[np.isfinite(found)]
        self.places.append(found)
        self.off.append(np.full(len(found), off))
        self.about.append(np.full(len(found), about))

    def line(self, start: complex, end: complex, about: float, off: complex = 0j) -> None:
        """A straight line between places (SI)."""
        self.spots(start + (end - start) * np.linspace(0, 1, SPOTS), about, off)


@dataclass(frozen=True)
class Room:
    """paper (mm), SI a millimetre, where zero is on the paper (mm).

    figure: width and height of what is to scale there, mm; free: it is there without a scale.
    """

    paper: tuple[float, float]
    mu: float
    origin: complex
    figure: tuple[float, float] = (0.0, 0.0)
    free: bool = False


def room(figure: Figure, block: Block, also: Sequence[float] = ()) -> Room:
    """The largest round scale, or one of `also`, at which the figure fits and the block covers nothing of it."""
    places, off, about = (np.concatenate(part) for part in (figure.places, figure.off, figure.about))
    if on_large_sheet():
        return _tight(places, off, about)
    sizes = [shape.size for shape in block.shapes()]
    alone: Room | None = None
    for mu in scales(extent(places.tolist())[0], also):
        at = places / mu + off
        low = complex((at.real - about).min(), (at.imag - about).min())
        size = complex((at.real + about).max(), (at.imag + about).max()) - low
        for paper in (LANDSCAPE, PORTRAIT) if size.real > size.imag else (PORTRAIT, LANDSCAPE):
            start, end = ground_of(paper)
            free = end - start - size
            if min(free.real, free.imag) < 0:
                continue
            alone = alone or Room(paper, mu, start - low + free / 2)
            for shift in SHIFTS:
                origin = start - low + complex(shift.real * free.real, shift.imag * free.imag)
                for one in sizes:
                    spots = corners(start, end, one)
                    if len(spots) and not covered(at + origin, spots, one, about).all():
                        return Room(paper, mu, origin)
        if alone is not None and mu > SMALLER * alone.mu:
            return alone
    raise AssertionError("some scale is large enough")


def _tight(places: Vector, off: Vector, about: Vector) -> Room:
    """At the scale that a large sheet gives, on a paper no larger than the figure; blocks find their place there."""
    longest = longest_for(max(LANDSCAPE))
    __, across, up, ___ = extent(places.tolist())
    mu = round_scale(across, up, longest, longest)
    at = places / mu + off
    low = complex((at.real - about).min(), (at.imag - about).min())
    size = complex((at.real + about).max(), (at.imag + about).max()) - low
    start, end = ground_of((0.0, 0.0))
    paper = size + start - end
    return Room((paper.real, paper.imag), mu, start - low, (across / mu, up / mu))


def snug(
    places: Sequence[complex], pad: float, least: float, below: Callable[[float], float] = lambda width: 0
) -> Room:
    """For places (SI) that are put on a large sheet without a scale; below: what (mm) is free there at its width."""
    size, across, up, __ = extent(list(places) or [0j])
    factor = longest_for(max(LANDSCAPE)) / (size or 1.0)
    low, high = ground_of((0.0, 0.0))
    figure = max(factor * across, 1.0), max(factor * up, 1.0)  # one without width has a scale too
    paper = complex(max(figure[0] + 2 * pad, least), figure[1] + 2 * pad + below(least)) + low - high
    return Room((paper.real, paper.imag), 1.0, 0j, figure, free=True)


def scales(size: float, also: Sequence[float]) -> Iterator[float]:
    """Round scales (SI a millimetre) for a figure of this size (SI), from one at which it fits on no sheet on."""
    least = size / max(LANDSCAPE)
    power = math.floor(math.log10(least)) if least > 0 and math.isfinite(least) else 0
    for n in count(power):
        decade = 10.0**n
        yield from sorted([f * decade for f in ROUND[:-1]] + [mu for mu in also if decade <= mu < 10 * decade])
