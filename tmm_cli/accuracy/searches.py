"""Bounds of what is searched for: ends of strokes, limits, dead positions, largest pressure angles.

A root is known as well as its function's sign: in longdouble the nearest places on both sides of it where the sign is
sure. What follows from several such numbers is shifted by the bound of each of them, one after the other.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

import numpy as np

from tmm_cli.accuracy.data import Length, changed, lengths
from tmm_cli.accuracy.digits import PAPER, SHARE, STEP, U, exact
from tmm_cli.accuracy.places import Changed
from tmm_cli.extended import WIDER
from tmm_cli.groups.base import Closed
from tmm_cli.linkage import Linkage
from tmm_cli.motion import Law, Motion, move
from tmm_cli.pipeline import CYCLE, Results, cycle_losses, given
from tmm_cli.pressure import NOTHING, angle, followers
from tmm_cli.strokes import RESTS, Strokes, Travel, output_run
from tmm_cli.vectors import Real

Cells = Mapping[Hashable, Real]
Shift = tuple[Results, float]  # results with one number shifted, and by how many of its bounds

FARTHEST = 46  # doublings of a bound that are tried: from the last bit to far beyond any use
SMOOTH = 1e-9  # of the step with which a top is looked at: what the slope's five places leave of its fifth derivative
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


def searched(results: Results, of: Callable[[Results], Cells], mu: float) -> Searched:
    """Judge what `of` reads out of results that belongs to no position. mu: scale of the drawing (m a mm)."""
    values, found = of(results), Searched()
    shifts = list(_shifts(results, found))
    for key, value in values.items():
        found.bound[key] = 2 * U * np.abs(np.asarray(value, float))
        found.lengths[key], found.paper[key] = np.zeros((2, *np.shape(value)))
    with np.errstate(invalid="ignore"):
        for shifted, times in shifts:
            moved = of(shifted)
            for key, value in values.items():
                found.bound[key] = found.bound[key] + np.where(np.isnan(value), 0.0, _gap(moved, key, value)) / times
        for changed_ones, by, length in _responses(results):
            moved = of(changed_ones)
            for key, value in values.items():
                rate = _gap(moved, key, value) / by
                found.lengths[key] = found.lengths[key] + rate * SHARE * abs(length.value)
                found.paper[key] = found.paper[key] + rate * PAPER * mu
    return found


def _gap(moved: Cells, key: Hashable, value: Real) -> Real:
    """How far a number has moved; a full turn is no way, and what is not there any more has not moved."""
    if key not in moved or np.shape(moved[key]) != np.shape(value):
        return np.zeros(np.shape(value))
    gap: Real = np.abs(np.asarray(moved[key], float) - np.asarray(value, float))
    return np.where(np.abs(gap - 2 * np.pi) < 1e-3, np.abs(gap - 2 * np.pi), gap)


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
        yield _shifted(bound, partial(_with_way, results, name))
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
                yield _shifted(float(by), partial(_with_stroke, results, number, k, part))
    if results.losses is not None:  # a sum over half as many places has a larger error than theirs
        yield given(results, losses=cycle_losses(results, CYCLE // 2)), 1.0
    for k, travel in enumerate(results.travels):
        for part, by in wide.travel(travel).items():
            yield _shifted(by, partial(_with, results, "travels", k, part))
    for k, dead in enumerate(results.dead):
        yield _shifted(wide.dead(dead.place, dead.group, span), partial(_with, results, "dead", k, "place"))
        yield _shifted(dead.margin + 4 * U, partial(_with, results, "dead", k, "margin"))
    for k, pressure in enumerate(results.pressure):
        largest, there = wide.pressure(pressure.group, pressure.link, pressure.place, pressure.largest, span)
        yield _shifted(largest, partial(_with, results, "pressure", k, "largest"), -1.0)
        yield _shifted(there, partial(_with, results, "pressure", k, "place"))


def _responses(results: Results) -> Iterator[tuple[Results, float, Length]]:
    """The results with what was searched for as it is when one length is changed, by how much, and which one.

    At an extreme the place does not matter to first order, so values there are taken where they were found. Places that
    are no roots of anything known have no such answer: nan.
    """
    way, linkage = results.way, results.linkage
    if way is None:
        return
    span = way.end - way.start if linkage.driver.kind == "slide" else 1.0
    data = lengths(linkage)
    for length in data:
        by = STEP * max(abs(other.value) for other in data if other.link == length.link)
        moved = changed(linkage, length, by)
        both = (results.kernels, tuple(kernel.again(moved) for kernel in results.kernels))

        def motions(places: Any, both: Any = both, moved: Linkage = moved) -> tuple[Motion, Motion]:
            q = np.atleast_1d(np.array(places, dtype=float))
            law = Law(0.0, 1.0, 0.0, 1)
            return move(linkage, both[0], q, law), move(moved, both[1], q, law)

        after = Changed(motions, both, span)
        ends = {"start": way.start, "end": way.end}
        moved_ends: dict[str, Any] = {name: at + after.limit(at, _limit(results, at)) for name, at in ends.items()}
        further = tuple(_strokes_after(strokes, motions) for strokes in results.further)
        travels = []
        for travel in results.travels:
            runs = [output_run(m, travel.link)[0] for m in motions([travel.low_at, travel.high_at])]
            low, high = np.remainder(runs[1] - runs[0] + np.pi, 2 * np.pi) - np.pi
            at = [
                _inner(results, place) * after.extreme(place, travel.link) for place in (travel.low_at, travel.high_at)
            ]
            travels.append(
                replace(travel, low=travel.low + low, high=travel.high + high, low_at=travel.low_at + at[0],
                        high_at=travel.high_at + at[1])
            )  # fmt: skip
        pressure = []
        for p in results.pressure:
            one, other = (_largest(m, p.group, p.link) for m in motions(p.place))
            there = p.place + after.pressure(p.place, p.group, p.link)
            pressure.append(replace(p, largest=p.largest + other - one, place=there))
        dead = tuple(replace(d, place=d.place + after.dead(d.place, d.group)) for d in results.dead)
        strokes = results.strokes and _strokes_after(results.strokes, motions)
        yield (
            given(
                results,
                way=way if way.full else replace(way, **moved_ends),
                dead=dead,
                strokes=strokes,
                further=further,
                travels=tuple(travels),
                pressure=tuple(pressure),
            ),
            by,
            length,
        )


def _end(results: Results) -> float:
    """How far an end of what is asked for moves: not at all where the file names it."""
    return 0.0 if results.problem.request.places else float("nan")


def _inner(results: Results, place: float) -> bool:
    """Whether a place lies between those asked for."""
    return bool(np.min(results.asked) < place < np.max(results.asked))


def _strokes_after(strokes: Strokes, motions: Callable[[Any], tuple[Motion, Motion]]) -> Strokes:
    """Strokes after a small change of the linkage: by the rate at which the output's speed passes zero."""
    if not strokes.strokes:
        return strokes
    before, after = (output_run(m, strokes.link) for m in motions([s.start for s in strokes.strokes]))
    with np.errstate(divide="ignore", invalid="ignore"):
        moved = -(after[1] - before[1]) / np.where(
            np.abs(before[2]) > RESTS * np.max(np.abs(before[2])), before[2], np.nan
        )
    low = np.remainder(after[0] - before[0] + np.pi, 2 * np.pi) - np.pi
    sense = np.sign(strokes.strokes[1].start - strokes.strokes[0].start)
    ahead = np.mod(
        strokes.strokes[0].length * sense - (strokes.strokes[1].start - strokes.strokes[0].start), strokes.cycle
    )
    sense = sense if min(ahead, strokes.cycle - ahead) < 1e-6 else -sense
    return replace(
        strokes,
        strokes=tuple(
            replace(s, start=s.start + moved[k], length=s.length + sense * (np.roll(moved, -1) - moved)[k],
                    low=s.low + low[k], run=s.run + (np.roll(low, -1) - low)[k])
            for k, s in enumerate(strokes.strokes)
        ),
    )  # fmt: skip


def _largest(motion: Motion, group: str, link: str) -> float:
    """The pressure angle of a link at the one place of a motion."""
    for kernel, there in zip(motion.kernels, motion.placements, strict=True):
        for lead in followers(kernel.group):
            if (kernel.group.title, lead[0]) == (group, link):
                with np.errstate(all="ignore"):
                    return float(angle(motion, kernel, there, lead)[0])
    return float("nan")


def _shifted(bound: float, by: Callable[[float], Results], sense: float = 1.0) -> Shift:
    times = max(1.0, min(LARGE, 1e-6 / bound if bound else LARGE))
    return by(sense * bound * times), times


def _with_way(results: Results, name: str, by: float) -> Results:
    way: Any = results.way
    return given(results, way=replace(way, **{name: getattr(way, name) + by}))


def _with(results: Results, part: str, k: int, name: str, by: float) -> Results:
    records: list[Any] = list(getattr(results, part))
    records[k] = replace(records[k], **{name: getattr(records[k], name) + by})
    changes: dict[str, Any] = {part: tuple(records)}
    return given(results, **changes)


def _with_stroke(results: Results, number: int, k: int, part: str, by: float) -> Results:
    strokes = results.strokes if number == 0 else results.further[number - 1]
    assert strokes is not None
    own = list(strokes.strokes)
    own[k] = replace(own[k], **{part: getattr(own[k], part) + by})
    moved = replace(strokes, strokes=tuple(own))
    if number == 0:
        return given(results, strokes=moved)
    further = list(results.further)
    further[number - 1] = moved
    return given(results, further=tuple(further))


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
        self.kind: Any = np.longdouble if WIDER else np.float64
        self.unit = float(np.finfo(self.kind).eps) / 2

    def at(self, q: Real) -> Motion:
        """Kinematics there, per unit of the driver's motion."""
        return move(self.linkage, self.kernels, np.asarray(q, self.kind), Law(0.0, 1.0, 0.0, 1))

    def steps(self, place: float) -> Real:
        """Growing distances from a place, the last bit first."""
        steps: Real = 2.0 ** np.arange(FARTHEST) * np.spacing(max(abs(place), 1e-3)) / 2
        return steps

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
        if not isinstance(kernel, Closed):
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
        if not isinstance(kernel, Closed):
            return GUESS * span

        def closing(motion: Motion) -> Real:
            return kernel.closing(kernel.closed(motion.poses, motion.drives), motion.poses, motion.first, motion.drives)

        return min(self.bracket(place, closing, kernel.size), GUESS * span)

    def pressure(self, group: str, link: str, place: float, largest: float, span: float) -> tuple[float, float]:
        """Of a largest pressure angle, and of the driver's place there: where it is flat, half the digits only."""
        if largest < NOTHING:
            return largest + 4 * U, span
        step = 1e-3 * (span if self.results.linkage.driver.kind == "slide" else 1.0)
        motion = self.at(self.kind(place) + step * np.arange(-2, 3).astype(self.kind))
        for kernel, there in zip(motion.kernels, motion.placements, strict=True):
            for lead in followers(kernel.group):
                if (kernel.group.title, lead[0]) == (group, link):
                    with np.errstate(all="ignore"):
                        b2, b1, here, a1, a2 = angle(motion, kernel, there, lead)
                        error = 2 * abs(float(here) - largest) + 32 * U
                        bend = float(2 * here - b1 - a1) / step**2
                        slope = float(8 * (a1 - b1) - (a2 - b2)) / (12 * step)
                        off = abs(slope / bend) if bend > 0 else span  # where the slope of a smooth top is nothing
                        flat = 4 * float(np.sqrt(error / bend)) + 1e-7 * step if bend > 0 else span
                    smooth = off < 1e-3 * step
                    return error, min(4 * off + SMOOTH * step + 4 * U * abs(place) if smooth else flat, span)
        return largest, span
