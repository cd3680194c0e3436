"""Bounds of what is searched for: ends of strokes, limits, dead positions, largest pressure angles.

A root is known as well as its function's sign: in double-doubles the nearest places beside it where the sign is
sure. What follows from several such numbers is shifted by the bound of each of them, one after the other.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator, Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from tmm_cli.accuracy.data import Length, changed, lengths
from tmm_cli.accuracy.digits import PAPER, SHARE, Digits
from tmm_cli.accuracy.wide import Wide
from tmm_cli.analysis.mechanism import Mechanism
from tmm_cli.analysis.pipeline import CYCLE, Results, cycle_losses
from tmm_cli.kinematics.driver_range import DriverRange
from tmm_cli.tolerances import ROUNDOFF
from tmm_cli.vectors import Real, mapped

Cells = Mapping[Hashable, Real]

LARGE = 2.0**20  # bounds in a shift, so that it is no rounding itself
SHIFT = 1e-6  # rad or m: no shift is larger, so that it stays one to first order
SHARE_ANEW = 1e-5  # of a length: the change with which everything is searched for anew


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
        told.bound[key] = 2 * ROUNDOFF * np.abs(np.asarray(value, float))
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
        yield found(f"dead[{k}].margin", dead.margin + 4 * ROUNDOFF)
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
        yield name, 2 * ROUNDOFF * abs(place) if limit is None else wide.end(place, towards, limit, span)


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
    """The results with everything searched for anew when one length is changed, by how much, and which one.

    A full turn stays one, and free of dead positions if it is. A length that passive constraints do not leave free
    tells nothing.
    """
    driver_range, data = results.driver_range, lengths(results.linkage)
    if driver_range is None:
        return
    for length in data:
        by = SHARE_ANEW * max(abs(other.value) for other in data if other.link == length.link)
        moved = changed(results.linkage, length, by)
        inputs, structure = replace(results.inputs, linkage=moved), results.structure.rebind(moved)
        mechanism = Mechanism(inputs, structure)
        if driver_range.full:
            kernels = tuple(kernel.rebind(moved) for kernel in results.kernels)
            dead = {} if results.dead else {"dead": ()}
            mechanism = mechanism.known(kernels=kernels, driver_range=driver_range, **dead)
        if mechanism.assembles:
            yield replace(results, inputs=inputs, structure=structure, mechanism=mechanism), by, length


def _shifted(results: Results, path: str, by: float) -> Results:
    """The results with one number of the mechanism shifted; path: travels[0].low, as in vectors.mapped."""
    part = path.partition(".")[0].partition("[")[0]
    moved = mapped(lambda at, value: value + by if at == path else value, getattr(results, part), path=part)
    return replace(results, mechanism=results.mechanism.changed(**{part: moved}))


def _limit(results: Results, place: float) -> str | None:
    """The group that stops the driver at a place."""
    assert results.driver_range is not None
    return next((limit.group for limit in results.driver_range.limits if limit.place == place), None)
