"""Roots and extremes: how far from where they were found the signs of their functions are sure.

In double-doubles, or coarsely in float64.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

from tmm_cli.accuracy.digits import exact
from tmm_cli.accuracy.margins import growth, slenderness
from tmm_cli.analysis.pipeline import Results
from tmm_cli.double_double import EPS, DoubleDouble, rounded
from tmm_cli.groups.base import Closed
from tmm_cli.groups.sequence import LinkStates, link_states, towards
from tmm_cli.kinematics.output import Travel, output_place, output_slope
from tmm_cli.kinematics.pressure import pressure_at
from tmm_cli.kinematics.strokes import Strokes
from tmm_cli.tolerances import NO_PRESSURE, ROUNDOFF
from tmm_cli.vectors import Real

FARTHEST = 46  # doublings of a bound that are tried: from the last bit to far beyond any use
AROUND = 65  # places over the driver's way that tell how large a function is
SMOOTH = 1e-9  # of the step with which a top is looked at: what the slope's five places leave of its fifth derivative
NOISE = 64  # roundings of a function's largest value: its sign is sure beyond
FINE = 1e-10  # of the largest value: more noise in float64, near a dead position, would blur all that was found
LEAST = 1e-12  # of the way: ends of groups that were followed there
GUESS = 1e-9  # of the way: dead positions where a margin is least


class Wide:
    """The linkage of results at any places of its driver, with the decimals of its file.

    growth: how much rounding of the data may grow; then the linkage is as it is, in float64.
    """

    def __init__(self, results: Results, growth: float | None = None) -> None:
        self.results = results
        self.linkage = exact(results) if growth is None else results.linkage
        self.kernels = tuple(kernel.rebind(self.linkage) for kernel in results.kernels)
        self.kind: Any = DoubleDouble if growth is None else np.asarray
        self.noise = NOISE * (EPS if growth is None else ROUNDOFF * growth)
        self.known: dict[str, tuple[Real, Real]] = {}  # of strokes, by the output

    def at(self, q: Real, links: Iterable[str], order: int = 0) -> LinkStates:
        """Some links there, and those they hang on."""
        kernels = towards(self.kernels, links)
        return link_states(self.linkage, kernels, q if isinstance(q, DoubleDouble) else self.kind(q), order)

    def sides(self, places: Real) -> tuple[Real, Real]:
        """Growing distances from each place, the last bit first, and the places on both sides at them."""
        steps = 2.0 ** np.arange(FARTHEST) * np.spacing(np.maximum(np.abs(places), 1e-3))[:, None] / 2
        there = self.kind(places)[:, None]
        return steps, np.stack([there - steps, there + steps])

    def brackets(
        self, places: Real, of: Callable[[LinkStates], Real], links: Iterable[str], size: float | None = None
    ) -> tuple[Real, LinkStates, Real]:
        """The least distance from each place at which a function has different signs on both sides for sure, or inf.

        With the links, at these places first, and how large the function may be there. links: those it is about. size:
        its largest value; when left out that over the driver's way.
        """
        steps, both = self.sides(places)
        driver_range = self.results.mechanism.driver_range
        way = np.linspace(driver_range.start, driver_range.end, AROUND)
        with np.errstate(all="ignore"):
            states = self.at(np.concatenate([self.kind(places), both.ravel(), way]), links, 1)
            there, values, along = np.split(rounded(of(states)), [len(places), len(places) + both.size])
        size = float(np.nanmax(np.abs(along))) if size is None else size
        below, above = np.where(np.abs(values) > self.noise * size, np.sign(values), 0).reshape(both.shape)
        distance = _first((below != above) & (np.abs(below) + np.abs(above) > 0), steps)
        return distance, states, np.abs(there) + self.noise * size

    def turns(self, places: Real, runs: Real, link: str, inner: Real | bool = True) -> tuple[Real, Real]:
        """Of places where an output turns back, and of where it is told to be then.

        inner: which of them are such; the others were asked for.
        """
        carrier = self.linkage.output_carrier(link)
        bounds, states, slope = self.brackets(places, lambda states: output_slope(states, link), [carrier])
        bounds = np.where(inner, bounds, 2 * ROUNDOFF * np.abs(places))
        off = np.abs(rounded(output_place(states, link)[: len(places)] - runs))
        if self.linkage.output_swings(link):
            off = np.abs(np.remainder(off + np.pi, 2 * np.pi) - np.pi)
        off = np.nan_to_num(off) + np.where(np.isfinite(bounds), bounds, 0.0) * np.nan_to_num(slope)
        return bounds, 2 * off + 4 * (ROUNDOFF + self.noise) * np.abs(runs)

    def strokes(self, strokes: Strokes) -> tuple[Real, Real]:
        """Of the driver's places at the ends of strokes, and of where the output is then."""
        if strokes.link not in self.known:
            places, lows = (np.array([getattr(s, name) for s in strokes.strokes]) for name in ("start", "low"))
            self.known[strokes.link] = self.turns(places, lows, strokes.link)
        return self.known[strokes.link]

    def travel(self, travel: Travel) -> tuple[Real, Real]:
        """Of the driver's places at the least and the largest run of an output, and of these runs."""
        places, asked = np.array([travel.low_at, travel.high_at]), self.results.asked
        inner = (np.min(asked) < places) & (places < np.max(asked))
        return self.turns(places, np.array([travel.low, travel.high]), travel.link, inner)

    def end(self, place: float, towards: int, group: str, span: float) -> float:
        """Of an end of the driver's way: inside of it the group can be placed, outside it cannot."""
        kernel = next((k for k in self.kernels if k.group.title == group), None)
        if not isinstance(kernel, Closed):
            return LEAST * span + 4 * ROUNDOFF * abs(place)
        steps, both = self.sides(np.array([place]))
        inside, outside = self.at(both.ravel(), kernel.group.links).placed.reshape(both.shape)[::towards]
        sure = float(_first(inside & ~outside, steps)[0])
        return (sure if np.isfinite(sure) else LEAST * span) + self.noise * span

    def dead(self, place: float, group: str, span: float) -> float:
        """Of a dead position inside the way: there the gap of the group stops growing."""
        kernel = next(kernel for kernel in self.kernels if kernel.group.title == group)
        if not isinstance(kernel, Closed):
            return GUESS * span

        def closing(states: LinkStates) -> Real:
            at = kernel.closed(states.poses, states.drives)
            return kernel.residual_rate(at, states.poses, states.first, states.drives)

        distance = self.brackets(np.array([place]), closing, kernel.group.links, float(kernel.size))[0]
        return min(float(distance[0]), GUESS * span)

    def pressure(self, group: str, link: str, place: float, largest: float, span: float) -> tuple[float, float]:
        """Of an extreme pressure angle, and of the driver's place there: where it is flat, half the digits only.

        At an end of the way it is where the end is; where it is the same all the way, no place is known (infinity).
        """
        if largest < NO_PRESSURE:
            return largest + 4 * ROUNDOFF, np.inf
        step = 1e-3 * (span if self.results.linkage.driver.kind == "slide" else 1.0)
        driver_range = self.results.mechanism.driver_range
        limit = next((limit for limit in driver_range.limits if limit.place == place), None)
        if largest == np.pi / 2 and limit is None:  # where the group is dead inside the way
            return 2 * ROUNDOFF, self.dead(place, group, span)
        if largest == np.pi / 2 and limit is not None:
            return 2 * ROUNDOFF, self.end(place, -1 if place == driver_range.start else 1, limit.group, span)
        states = self.at(self.kind(place) + step * np.arange(-2, 3), [link])
        b2, b1, here, a1, a2 = pressure_at(states, group, link)
        error = 2 * abs(float(here) - largest) + 32 * ROUNDOFF + 4 * self.noise / max(float(np.cos(largest)), ROUNDOFF)
        edge = 2 * GUESS * span
        for end, inside in ((driver_range.start, a1), (driver_range.end, b1)):
            if not driver_range.full and abs(place - end) <= edge and float(here - inside) > error:
                return error, edge + 4 * ROUNDOFF * abs(place)
        bend = abs(float(2 * here - b1 - a1)) / step**2  # of an extreme of either kind
        if not bend * step**2 > error:  # no bend that could be told from rounding
            return error, np.inf
        slope = float(8 * (a1 - b1) - (a2 - b2)) / (12 * step)
        off = abs(slope / bend)  # where the slope of a smooth top is nothing
        flat = 4 * float(np.sqrt(error / bend)) + 1e-7 * step
        there = 4 * off + SMOOTH * step + 4 * ROUNDOFF * abs(place) if off < 1e-3 * step else flat
        return error, there if there < span else np.inf


def coarsely(results: Results) -> Wide:
    """In float64, with the rounding of the data as it may grow on its way through the groups, if that tells enough."""
    grown = growth(results)
    most = slenderness(results) * float(np.max(grown, where=np.isfinite(grown), initial=1.0))
    return Wide(results, most if NOISE * ROUNDOFF * most < FINE else None)


def _first(sure: Real, steps: Real) -> Real:
    """The first of its steps at which each place is sure, or inf."""
    return np.where(sure.any(axis=1), steps[np.arange(len(steps)), sure.argmax(axis=1)], np.inf)
