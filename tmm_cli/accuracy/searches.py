"""Bounds of what is searched for: ends of strokes, limits, dead positions, largest pressure angles.

A root is known as well as its function's sign: in double-doubles the nearest places beside it where the sign is
sure. What follows from several such numbers is shifted by the bound of each of them, one after the other.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from tmm_cli.accuracy.data import lengths
from tmm_cli.accuracy.digits import PAPER, SHARE, Digits
from tmm_cli.accuracy.responses import ends, outputs, responses
from tmm_cli.accuracy.wide import Wide
from tmm_cli.analysis.pipeline import CYCLE, Results, cycle_losses
from tmm_cli.kinematics.driver_range import DriverRange
from tmm_cli.tolerances import ROUNDOFF
from tmm_cli.vectors import Real, mapped

Cells = Mapping[Hashable, Real]

LARGE = 2.0**20  # bounds in a shift, so that it is no rounding itself
SHIFT = 1e-6  # rad or m: no shift is larger, so that it stays one to first order


class Found(NamedTuple):
    """A number of the mechanism that was searched for: where it stands, its bound, the results with it shifted by so
    much; sense: to which side they are.
    """

    path: str
    bound: float
    shifted: Callable[[float], Results]
    sense: int = 1


def searched(results: Results, of: Callable[[Results], Cells], wide: Wide, mu: float = float("nan")) -> Digits:
    """Judge what `of` reads out of results that belongs to no position.

    mu: scale of the drawing (m a mm); nan: no sensitivities are wanted.
    """
    values, data = of(results), lengths(results.linkage)
    here = _row(values, values)
    bound = 2 * ROUNDOFF * np.abs(here)
    with np.errstate(all="ignore"):
        rates = {} if np.isnan(mu) or results.driver_range is None else responses(results, data)
        goes = np.zeros((len(here), len(data)))  # how far each number goes a metre of each length
        for found in found_in(results, wide):
            rate = rates.get(found.path, 0.0)
            by = found.sense * (min(SHIFT, LARGE * found.bound) or (SHIFT if np.any(rate) else 0.0))
            if by:
                slope = _gap(_row(of(found.shifted(by)), values), here) / by
                bound = bound + np.where(slope != 0, np.abs(slope) * found.bound, 0.0)
                goes = goes + np.where(rate, slope[:, None] * rate, 0.0)
        sizes = np.array([abs(length.value) for length in data])
        share, paper = SHARE * np.abs(goes) @ sizes, PAPER * mu * np.abs(goes).sum(axis=1)
    ends_of = np.cumsum([np.size(value) for value in values.values()])[:-1]
    # of nothing an array is still one part
    told = [dict(zip(values, np.split(part, ends_of), strict=False)) for part in (bound, share, paper)]
    return Digits(told[0], told[1], told[2], mu)


def _row(moved: Cells, values: Cells) -> Real:
    """All numbers in a row; what is not there any more has not moved."""
    kept = (
        moved[key] if key in moved and np.shape(moved[key]) == np.shape(value) else value
        for key, value in values.items()
    )
    return np.concatenate([np.zeros(0), *(np.ravel(value) for value in kept)])


def _gap(moved: Real, here: Real) -> Real:
    """How far numbers have moved, and to which side; a full turn is no way, nor is one from or to nowhere."""
    way: Real = moved - here
    turn = np.copysign(2 * np.pi, way)
    return np.where(np.abs(way - turn) < 1e-3, way - turn, np.where(np.isnan(way), 0.0, way))


def found_in(results: Results, wide: Wide) -> Iterator[Found]:
    """Everything that was searched for."""
    driver_range = results.driver_range
    if driver_range is None:
        return
    span = driver_range.end - driver_range.start

    def found(path: str, bound: float, sense: int = 1, also: Sequence[str] = ()) -> Found:
        return Found(path, float(bound), lambda by: _shifted(results, dict.fromkeys((path, *also), by)), sense)

    for (end, *also), bound in zip(ends(driver_range), _ends(results, driver_range, wide), strict=True):
        yield found(end, bound, also=also)
    for output, strokes in outputs(results).items():
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
        yield found(f"dead[{k}].margin", dead.margin + 4 * ROUNDOFF)
    for k, pressure in enumerate(results.pressure):
        largest, there = wide.pressure(pressure.group, pressure.link, pressure.place, pressure.largest, span)
        yield found(f"pressure[{k}].largest", largest, -1)
        yield found(f"pressure[{k}].place", there)
        if np.isfinite(pressure.other):
            other, there = wide.pressure(pressure.group, pressure.link, pressure.other_place, pressure.other, span)
            yield found(f"pressure[{k}].other", other, -1)
            yield found(f"pressure[{k}].other_place", there)
    if results.losses is not None:  # a sum over half as many places has a larger error than theirs
        rough = cycle_losses(results, CYCLE // 2, ranges=False)

        def towards(by: float) -> Results:
            losses = mapped(
                lambda __, fine, half: fine + by * (half - fine), results.losses, rough, skip=("locked", "ranges")
            )
            return replace(results, losses=losses)

        yield Found("losses", 1.0, towards)


def _ends(results: Results, driver_range: DriverRange, wide: Wide) -> Iterator[float]:
    """Bounds of both ends of the driver's way."""
    span = driver_range.end - driver_range.start
    for towards, place in ((-1, driver_range.start), (1, driver_range.end)):
        limit = None if driver_range.full else _limit(results, place)
        yield 2 * ROUNDOFF * abs(place) if limit is None else wide.end(place, towards, limit, span)


def blur(results: Results, wide: Wide) -> float:
    """How far position 0 may be from where it was asked for, rad or m."""
    request, driver_range = results.inputs.request, results.driver_range
    if driver_range is None or request.places:
        return 0.0
    if not driver_range.full:
        return max(_ends(results, driver_range, wide))
    if request.start != "working stroke" or results.strokes is None or not results.strokes.strokes:
        return 0.0
    return float(wide.strokes(results.strokes)[0][0])


def _shifted(results: Results, by: Mapping[str, float]) -> Results:
    """The results with numbers of the mechanism shifted by so much; paths: travels[0].low, as vectors.mapped has them.

    Pressure angles at the positions are no searched ones: they stay.
    """

    def moved(part: str) -> Any:
        return mapped(lambda path, value: value + by[path] if path in by else value, getattr(results, part), path=part)

    parts = {path.partition(".")[0].partition("[")[0] for path in by}
    return replace(results, mechanism=results.mechanism.changed(**{part: moved(part) for part in parts | {"pressure"}}))


def _limit(results: Results, place: float) -> str | None:
    """The group that stops the driver at a place."""
    assert results.driver_range is not None
    return next((limit.group for limit in results.driver_range.limits if limit.place == place), None)
