"""Bounds of what is searched for: ends of strokes, limits, dead positions, largest pressure angles.

A root is known as well as its function's sign: in longdouble the nearest places on both sides of it where the sign is
sure. What follows from several such numbers is shifted by the bound of each of them, one after the other.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator, Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from tmm_cli.accuracy.data import Length, changed, lengths
from tmm_cli.accuracy.digits import PAPER, SHARE, STEP, Digits, U
from tmm_cli.accuracy.places import Changed
from tmm_cli.accuracy.wide import Wide
from tmm_cli.analysis.pipeline import CYCLE, Results, cycle_losses
from tmm_cli.groups.sequence import DriverMotion
from tmm_cli.kinematics.driver_range import DriverRange
from tmm_cli.kinematics.motion import Motion, move
from tmm_cli.kinematics.pressure import pressure_at
from tmm_cli.kinematics.strokes import Strokes, output_run
from tmm_cli.linkage import Linkage
from tmm_cli.tolerances import RESTS
from tmm_cli.vectors import Real, mapped

Cells = Mapping[Hashable, Real]

LARGE = 2.0**20  # bounds in a shift, so that it is no rounding itself
SHIFT = 1e-6  # rad or m: no shift is larger, so that it stays one to first order


class Found(NamedTuple):
    """A number of the mechanism that was searched for: its bound, and the results with it shifted by so much."""

    bound: float
    shifted: Callable[[float], Results]


def searched(results: Results, of: Callable[[Results], Cells], wide: Wide, mu: float = float("nan")) -> Digits:
    """Judge what `of` reads out of results that belongs to no position.

    mu: scale of the drawing (m a mm); nan: no sensitivities are wanted.
    """
    values, told = of(results), Digits(mu=mu)
    for key, value in values.items():
        told.bound[key] = 2 * U * np.abs(np.asarray(value, float))
        told.lengths[key], told.paper[key] = np.zeros((2, *np.shape(value)))
    with np.errstate(all="ignore"):
        for found in found_in(results, wide):
            by = min(SHIFT, LARGE * found.bound)
            moved = of(found.shifted(by)) if by else values
            for key, value in values.items():
                gap = _gap(moved, key, value)
                told.bound[key] = told.bound[key] + np.where(gap > 0, gap * (found.bound / by if by else 0.0), 0.0)
        for changed_ones, by, length in () if np.isnan(mu) else _responses(results):
            moved = of(changed_ones)
            for key, value in values.items():
                rate = _gap(moved, key, value) / by
                told.lengths[key] = told.lengths[key] + rate * SHARE * abs(length.value)
                told.paper[key] = told.paper[key] + rate * PAPER * mu
    return told


def _gap(moved: Cells, key: Hashable, value: Real) -> Real:
    """How far a number has moved; a full turn is no way, and what is not there any more has not moved."""
    if key not in moved or np.shape(moved[key]) != np.shape(value):
        return np.zeros(np.shape(value))
    residual: Real = np.abs(np.asarray(moved[key], float) - np.asarray(value, float))
    return np.where(np.abs(residual - 2 * np.pi) < 1e-3, np.abs(residual - 2 * np.pi), residual)


def found_in(results: Results, wide: Wide) -> Iterator[Found]:
    """Everything that was searched for."""
    driver_range = results.driver_range
    if driver_range is None:
        return
    span = driver_range.end - driver_range.start

    def found(path: str, bound: float, sense: int = 1) -> Found:
        return Found(float(bound), lambda by: _shifted(results, path, sense * by))

    for name, bound in _ends(results, driver_range, wide):
        yield found(f"driver_range.{name}", bound)
    outputs = {"strokes": results.strokes} | {f"further[{k}]": strokes for k, strokes in enumerate(results.further)}
    for output, strokes in outputs.items():
        if strokes is None or not strokes.strokes:
            continue
        starts, lows = wide.strokes(strokes)
        parts = {"start": starts, "length": starts + np.roll(starts, -1), "low": lows, "run": lows + np.roll(lows, -1)}
        for k in range(len(starts)):
            for part, bounds in parts.items():
                yield found(f"{output}.strokes[{k}].{part}", bounds[k])
    for k, travel in enumerate(results.travels):
        for part, bound_at, bound in zip(("low", "high"), *wide.travel(travel), strict=True):
            yield found(f"travels[{k}].{part}_at", bound_at)
            yield found(f"travels[{k}].{part}", bound)
    for k, dead in enumerate(results.dead):
        yield found(f"dead[{k}].place", wide.dead(dead.place, dead.group, span))
        yield found(f"dead[{k}].margin", dead.margin + 4 * U)
    for k, pressure in enumerate(results.pressure):
        largest, there = wide.pressure(pressure.group, pressure.link, pressure.place, pressure.largest, span)
        yield found(f"pressure[{k}].largest", largest, -1)
        yield found(f"pressure[{k}].place", there)
    if results.losses is not None:  # a sum over half as many places has a larger error than theirs
        rough = cycle_losses(results, CYCLE // 2)

        def towards(by: float) -> Results:
            losses = mapped(lambda __, fine, half: fine + by * (half - fine), results.losses, rough, skip=("locked",))
            return replace(results, losses=losses)

        yield Found(1.0, towards)


def _ends(results: Results, driver_range: DriverRange, wide: Wide) -> Iterator[tuple[str, float]]:
    """Bounds of both ends of the driver's way."""
    span = driver_range.end - driver_range.start
    for name, towards, place in (("start", -1, driver_range.start), ("end", 1, driver_range.end)):
        limit = None if driver_range.full else _limit(results, place)
        yield name, 2 * U * abs(place) if limit is None else wide.end(place, towards, limit, span)


def blur(results: Results, wide: Wide) -> float:
    """How far position 0 may be from where it was asked for, rad or m."""
    request, driver_range = results.inputs.request, results.driver_range
    if driver_range is None or request.places:
        return 0.0
    if not driver_range.full:
        return max(bound for _, bound in _ends(results, driver_range, wide))
    if request.start != "working stroke" or results.strokes is None or not results.strokes.strokes:
        return 0.0
    return float(wide.strokes(results.strokes)[0][0])


def _responses(results: Results) -> Iterator[tuple[Results, float, Length]]:
    """The results with what was searched for as it is when one length is changed, by how much, and which one.

    At an extreme the place does not matter to first order, so values there are taken where they were found. Places that
    are no roots of anything known have no such answer: nan.
    """
    driver_range, linkage = results.driver_range, results.linkage
    if driver_range is None:
        return
    span = driver_range.end - driver_range.start if linkage.driver.kind == "slide" else 1.0
    data = lengths(linkage)
    for length in data:
        by = STEP * max(abs(other.value) for other in data if other.link == length.link)
        moved = changed(linkage, length, by)
        both = (results.kernels, tuple(kernel.rebind(moved) for kernel in results.kernels))

        def motions(places: Any, both: Any = both, moved: Linkage = moved) -> tuple[Motion, Motion]:
            q = np.atleast_1d(np.array(places, dtype=float))
            law = DriverMotion(0.0, 1.0, 0.0, 1)
            return move(linkage, both[0], q, law), move(moved, both[1], q, law)

        after = Changed(motions, both, span)
        ends = {"start": driver_range.start, "end": driver_range.end}
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
            one, other = (float(pressure_at(m, p.group, p.link)[0]) for m in motions(p.place))
            there = p.place + after.pressure(p.place, p.group, p.link)
            pressure.append(replace(p, largest=p.largest + other - one, place=there))
        dead = tuple(replace(d, place=d.place + after.dead(d.place, d.group)) for d in results.dead)
        strokes = results.strokes and _strokes_after(results.strokes, motions)
        yield (
            _changed(
                results,
                driver_range=driver_range if driver_range.full else replace(driver_range, **moved_ends),
                dead=dead,
                strokes=strokes,
                further=further,
                travels=tuple(travels),
                pressure=tuple(pressure),
            ),
            by,
            length,
        )


def _changed(results: Results, **parts: Any) -> Results:
    """The results with other parts of the mechanism."""
    return replace(results, mechanism=results.mechanism.changed(**parts))


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


def _shifted(results: Results, path: str, by: float) -> Results:
    """The results with one number of the mechanism shifted; path: travels[0].low, as in vectors.mapped."""
    part = path.partition(".")[0].partition("[")[0]
    moved = mapped(lambda at, value: value + by if at == path else value, getattr(results, part), path=part)
    return _changed(results, **{part: moved})


def _limit(results: Results, place: float) -> str | None:
    """The group that stops the driver at a place."""
    assert results.driver_range is not None
    return next((limit.group for limit in results.driver_range.limits if limit.place == place), None)
