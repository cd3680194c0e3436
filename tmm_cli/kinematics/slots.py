"""Stage: whether each stone stays on the segment of its guide, over all places of the driver, not the positions alone.

A guide along two points of a moving link ends in them. The extremes between the places of a scan are found too; a
cylinder that is driven has its stroke instead.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tmm_cli.groups.base import Kernel
from tmm_cli.groups.sequence import link_states, towards
from tmm_cli.kinematics.driver_range import SCAN, DriverRange
from tmm_cli.linkage import Linkage, Slide
from tmm_cli.roots import least, roots
from tmm_cli.tolerances import END_OF_SLOT
from tmm_cli.vectors import Real


@dataclass(frozen=True)
class Excess:
    """How a stone comes nearest to an end of its segment, or goes beyond it.

    point: the end. far: how far beyond it at most (m; negative: what is left before it), with the driver at `place`.
    ways: the driver's places (rad or m) from which to which it is beyond; empty when it never is.
    """

    slide: Slide
    point: str
    length: float
    far: float
    place: float
    ways: tuple[tuple[float, float], ...]


def find_slots(
    linkage: Linkage, kernels: tuple[Kernel, ...], driver_range: DriverRange, asked: Sequence[float]
) -> tuple[Excess, ...]:
    """Both ends of every segment, over the driver's range. asked: its places that were given one by one; where the
    driver does not turn fully, it goes from the first to the last of them only.
    """
    driven = {driver.joint for driver in linkage.drivers if driver.kind == "slide"}
    slides = [slide for slide in linkage.slides if slide.ends is not None and slide.name not in driven]
    if not slides:
        return ()
    start, end = driver_range.start, driver_range.end
    if len(asked) and not driver_range.full:
        start, end = max(start, float(np.min(asked))), min(end, float(np.max(asked)))
    q = np.linspace(start, end, SCAN * driver_range.turns + 1)
    scan = link_states(linkage, kernels, q, 0)
    found = []
    for slide in slides:
        upto = towards(kernels, (slide.carrier, slide.runner))
        run, there = scan.run(slide)[scan.placed], q[scan.placed]
        for point, forward in zip(slide.ends or (), (-1.0, 1.0), strict=True):
            if there.size > 1:
                found.append(_Segment(linkage, upto, slide, point, forward).excess(there, run, driver_range.full))
    return tuple(found)


@dataclass(frozen=True)
class _Segment:
    """One end of a segment. forward: +1 at its last point, -1 at its first."""

    linkage: Linkage
    kernels: tuple[Kernel, ...]
    slide: Slide
    point: str
    forward: float

    @property
    def length(self) -> float:
        first, last = (self.linkage.local(self.slide.carrier, name) for name in self.slide.ends or ())
        return abs(last - first)

    def beyond(self, run: Real) -> Real:
        """How far beyond the end a run along the guide is, m."""
        return run - self.length if self.forward > 0 else -run

    def at(self, q: Real) -> Real:
        return self.beyond(link_states(self.linkage, self.kernels, q, 0).run(self.slide))

    def excess(self, q: Real, run: Real, full: bool) -> Excess:
        """Over the places q, which are the whole cycle when `full`."""
        far = self.beyond(run)
        k = int(np.argmax(far))
        low, high = q[max(k - 1, 0)], q[min(k + 1, len(q) - 1)]
        place, short = least(lambda places: -self.at(places), low, high)
        most = 0.0 if abs(short) <= END_OF_SLOT * self.length else -short
        ways = (self.ways(q, far, full) or ((place, place),)) if most > 0 else ()
        return Excess(self.slide, self.point, self.length, most, place, ways)

    def ways(self, q: Real, far: Real, full: bool) -> tuple[tuple[float, float], ...]:
        """From where to where it is beyond; of a cycle the last way may go on through its end."""
        out = far > 0
        change = np.flatnonzero(out[:-1] != out[1:])
        places = roots(self.at, q[change], q[change + 1]) if change.size else np.zeros(0)
        leaves, returns = list(places[~out[change]]), list(places[out[change]])
        if out[0] and full and leaves:
            returns = [*returns[1:], returns[0] + q[-1] - q[0]]
        elif out[0]:
            leaves = [q[0], *leaves]
        if len(leaves) > len(returns):
            returns.append(q[-1])
        return tuple((float(a), float(b)) for a, b in zip(leaves, returns, strict=True))
