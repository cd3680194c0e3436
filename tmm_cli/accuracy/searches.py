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
from tmm_cli.accuracy.digits import PAPER, SHARE, STEP, U
from tmm_cli.accuracy.places import Changed
from tmm_cli.accuracy.wide import Wide
from tmm_cli.linkage import Linkage
from tmm_cli.motion import Law, Motion, move
from tmm_cli.pipeline import CYCLE, Results, cycle_losses, given
from tmm_cli.pressure import angle, followers
from tmm_cli.strokes import RESTS, Strokes, output_run
from tmm_cli.vectors import Real

Cells = Mapping[Hashable, Real]
Shift = tuple[Results, float]  # results with one number shifted, and by how many of its bounds

LARGE = 2.0**20  # bounds in a shift, so that it is no rounding itself


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
    wide = Wide(results)
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
