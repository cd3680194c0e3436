"""Bounds of what is searched for: ends of strokes, limits, dead positions, largest pressure angles.

A root is known as well as its function's sign: in longdouble the nearest places on both sides of it where the sign is
sure. What follows from several such numbers is shifted by the bound of each of them, one after the other.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from tmm_cli.accuracy.digits import U, exact
from tmm_cli.extended import WIDER
from tmm_cli.groups.base import Dyad
from tmm_cli.motion import Law, Motion, move
from tmm_cli.pipeline import Results
from tmm_cli.pressure import NOTHING, angle, followers
from tmm_cli.strokes import Strokes, Travel, output_run
from tmm_cli.vectors import Real

Cells = Mapping[Hashable, Real]
Shift = tuple[Results, float]  # results with one number shifted, and by how many of its bounds

FARTHEST = 46  # doublings of a bound that are tried: from the last bit to far beyond any use
NOISE = 64  # roundings of a function's largest value: its sign is sure beyond
LARGE = 2.0**20  # bounds in a shift, so that it is no rounding itself
LEAST = 1e-12  # of the way: ends of groups that were followed there
GUESS = 1e-9  # of the way: dead positions where a margin is least


@dataclass
class Searched:
    """Bounds and sensitivities of the numbers of searches by key; blur: of the place of position 0, rad or m."""

    bound: dict[Hashable, Real] = field(default_factory=dict)
    lengths: dict[Hashable, Real] = field(default_factory=dict)
    paper: dict[Hashable, Real] = field(default_factory=dict)
    blur: float = 0.0


def searched(results: Results, of: Callable[[Results], Cells]) -> Searched:
    """Judge what `of` reads out of results that belongs to no position."""
    values, found = of(results), Searched()
    shifts = list(_shifts(results, found))
    for key, value in values.items():
        found.bound[key] = 2 * U * np.abs(np.asarray(value, float))
        found.lengths[key] = found.paper[key] = np.full(np.shape(value), np.nan)
    with np.errstate(invalid="ignore"):
        for shifted, times in shifts:
            moved = of(shifted)
            for key, value in values.items():
                if key in moved and np.shape(moved[key]) == np.shape(value):
                    gap = np.abs(np.asarray(moved[key], float) - np.asarray(value, float))
                    gap = np.minimum(gap, np.abs(gap - 2 * np.pi)) if times > 1 else gap
                    found.bound[key] = found.bound[key] + np.where(np.isnan(value), 0.0, gap) / times
    return found


def _shifts(results: Results, found: Searched) -> Iterator[Shift]:
    """The results with each searched number shifted by its bound."""
    way, problem = results.way, results.problem
    if way is None:
        return
    wide = _Wide(results)
    span = way.end - way.start
    for name, towards in (("start", -1), ("end", 1)):
        place, limit = getattr(way, name), None if way.full else _limit(results, getattr(way, name))
        bound = 2 * U * abs(place) if limit is None else wide.end(place, towards, limit, span)
        found.blur = max(found.blur, 0.0 if way.full else bound)
        yield _shifted(
            bound, lambda by, name=name: replace(results, way=replace(way, **{name: getattr(way, name) + by}))
        )
    for number, strokes in enumerate((results.strokes, *results.further)):
        if strokes is None or not strokes.strokes:
            continue
        places = np.array([s.start for s in strokes.strokes])
        bounds = wide.turns(places, strokes.link)
        if number == 0 and problem.request.start == "working stroke" and not problem.request.places:
            found.blur = float(bounds[0])
        lows = wide.lows(places, bounds, strokes)
        after, high = np.roll(bounds, -1), np.roll(lows, -1)
        for k, bound in enumerate(bounds):
            own = {"start": bound, "length": bound + after[k], "low": lows[k], "run": lows[k] + high[k]}
            for part, by in own.items():
                yield _shifted(float(by), lambda by, n=number, k=k, p=part: _with_stroke(results, n, k, p, by))
    for k, travel in enumerate(results.travels):
        for part, by in wide.travel(travel).items():
            yield _shifted(by, lambda by, k=k, p=part: _with(results, "travels", k, p, by))
    for k, dead in enumerate(results.dead):
        yield _shifted(wide.dead(dead.place, dead.group, span), lambda by, k=k: _with(results, "dead", k, "place", by))
        yield _shifted(1e-6, lambda by, k=k: _with(results, "dead", k, "margin", by))
    for k, pressure in enumerate(results.pressure):
        largest, there = wide.pressure(pressure.group, pressure.link, pressure.place, pressure.largest, span)
        yield _shifted(largest, lambda by, k=k: _with(results, "pressure", k, "largest", -by))
        yield _shifted(there, lambda by, k=k: _with(results, "pressure", k, "place", by))


def _shifted(bound: float, by: Callable[[float], Results]) -> Shift:
    times = max(1.0, min(LARGE, 1e-6 / bound if bound else LARGE))
    return by(bound * times), times


def _with(results: Results, part: str, k: int, name: str, by: float) -> Results:
    records: list[Any] = list(getattr(results, part))
    records[k] = replace(records[k], **{name: getattr(records[k], name) + by})
    return replace(results, **{part: tuple(records)})


def _with_stroke(results: Results, number: int, k: int, part: str, by: float) -> Results:
    strokes = results.strokes if number == 0 else results.further[number - 1]
    assert strokes is not None
    own = list(strokes.strokes)
    own[k] = replace(own[k], **{part: getattr(own[k], part) + by})
    moved = replace(strokes, strokes=tuple(own))
    if number == 0:
        return replace(results, strokes=moved)
    further = list(results.further)
    further[number - 1] = moved
    return replace(results, further=tuple(further))


def _limit(results: Results, place: float) -> str | None:
    """The group that stops the driver at a place."""
    assert results.way is not None
    return next((limit.group for limit in results.way.limits if limit.place == place), None)


class _Wide:
    """The linkage in longdouble, where the machine has it, moved to any places."""

    def __init__(self, results: Results) -> None:
        self.results = results
        self.linkage = exact(results) if WIDER else results.linkage
        self.kernels = tuple(kernel.again(self.linkage) for kernel in results.kernels)
        self.kind = np.longdouble if WIDER else np.float64
        self.unit = float(np.finfo(self.kind).eps) / 2

    def at(self, q: Real) -> Motion:
        return move(self.linkage, self.kernels, np.asarray(q, self.kind), Law(0.0, 1.0, 0.0, 1))

    def steps(self, place: float) -> Real:
        """Growing distances from a place, the last bit first."""
        return 2.0 ** np.arange(FARTHEST) * np.spacing(max(abs(place), 1e-3)) / 2

    def bracket(self, place: float, of: Callable[[Motion], Real], size: float) -> float:
        """The least distance at which a function has different signs on both sides for sure; inf if there is none."""
        steps = self.steps(place).astype(self.kind)
        with np.errstate(all="ignore"):
            value = of(self.at(np.concatenate([self.kind(place) - steps, self.kind(place) + steps])))
        value = np.where(np.abs(value) > NOISE * self.unit * size, np.sign(value), 0)
        below, above = value[: len(steps)], value[len(steps) :]
        sure = np.flatnonzero((below != above) & (np.abs(below) + np.abs(above) > 0))
        return float(steps[sure[0]]) if sure.size else float("inf")

    def turns(self, places: Real, link: str) -> Real:
        """Of the ends of strokes."""
        q = np.linspace(0, 2 * np.pi, 65)
        size = float(np.nanmax(np.abs(output_run(self.at(q), link)[1])))
        return np.array([self.bracket(float(p), lambda m: output_run(m, link)[1], size) for p in places])

    def lows(self, places: Real, bounds: Real, strokes: Strokes) -> Real:
        """Of where the output turns back, given the bounds of the driver's places there."""
        runs = [output_run(self.at(p), strokes.link)[0] for p in (places, places - bounds, places + bounds)]
        told = np.array([s.low for s in strokes.strokes])
        gaps = [np.abs(np.asarray(run - told, float)) for run in runs]
        if strokes.kind == "swing":
            gaps = [np.minimum(gap, np.abs(gap - 2 * np.pi)) for gap in gaps]
        found: Real = 2 * np.max(gaps, axis=0) + U * np.abs(told)
        return found

    def travel(self, travel: Travel) -> dict[str, float]:
        """Of the extremes of an output and the driver's places there."""
        found = {}
        asked = self.results.asked
        for name in ("low", "high"):
            place = getattr(travel, f"{name}_at")
            inner = np.min(asked) < place < np.max(asked)
            bound = self.bracket(place, lambda m: output_run(m, travel.link)[1], 0.0) if inner else 2 * U * abs(place)
            runs = output_run(self.at(place + bound * np.array([0.0, -1.0, 1.0])), travel.link)[0]
            told = getattr(travel, name)
            gaps = np.abs(np.asarray(runs - told, float))
            if travel.kind == "swing":
                gaps = np.abs(np.remainder(gaps + np.pi, 2 * np.pi) - np.pi)
            found[f"{name}_at"] = bound
            found[name] = 2 * float(np.max(gaps[np.isfinite(gaps)], initial=0.0)) + 4 * U * abs(told)
        return found

    def end(self, place: float, towards: int, group: str, span: float) -> float:
        """Of an end of the driver's way: inside of it the group can be placed, outside it cannot."""
        kernel = next((k for k in self.kernels if k.group.title == group), None)
        if not isinstance(kernel, Dyad):
            return LEAST * span + 4 * U * abs(place)
        steps = self.steps(place).astype(self.kind)
        inside = self.at(self.kind(place) - towards * steps).placed
        outside = self.at(self.kind(place) + towards * steps).placed
        sure = np.flatnonzero(inside & ~outside)
        return float(steps[sure[0]]) if sure.size else LEAST * span

    def dead(self, place: float, group: str, span: float) -> float:
        """Of a dead position inside the way: there the gap of the group stops growing."""
        number = next(k for k, kernel in enumerate(self.kernels) if kernel.group.title == group)
        kernel = self.kernels[number]
        if not isinstance(kernel, Dyad):
            return GUESS * span

        def closing(motion: Motion) -> Real:
            return kernel.closing(kernel.closed(motion.poses), motion.poses, motion.first)

        return min(self.bracket(place, closing, kernel.size), GUESS * span)

    def pressure(self, group: str, link: str, place: float, largest: float, span: float) -> tuple[float, float]:
        """Of a largest pressure angle, and of the driver's place there: where it is flat, half the digits only."""
        if largest < NOTHING:
            return largest + 4 * U, span
        step = 1e-4 * (span if self.results.linkage.driver.kind == "slide" else 1.0)
        motion = self.at(np.array([place, place - step, place + step]))
        for kernel, there in zip(motion.kernels, motion.placements, strict=True):
            for lead in followers(kernel.group):
                if (kernel.group.title, lead[0]) == (group, link):
                    with np.errstate(all="ignore"):
                        here, before, after = (float(v) for v in angle(motion, kernel, there, lead))
                    error = 2 * abs(here - largest) + 32 * U
                    bend = (2 * here - before - after) / step**2
                    flat = 4 * float(np.sqrt(error / bend)) + 1e-11 * step / 1e-4 if bend > 0 else span
                    return error, min(flat, span)
        return largest, span
