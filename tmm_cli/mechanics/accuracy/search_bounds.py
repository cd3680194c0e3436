"""Bounds of the errors of roots and extremes that were found by a search.

A root is known to the distance beyond which the sign of the function is certain. The function is evaluated in
double-doubles or, where float64 is accurate enough, in float64.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from tmm_cli.mechanics.accuracy.length_sensitivity import (
    list_lengths,
    range_end_paths,
    search_sensitivities,
    stroke_paths,
)
from tmm_cli.mechanics.accuracy.rounding_bounds import (
    LENGTH_CHANGE,
    PAPER_CHANGE,
    Digits,
    error_growth,
    exact_linkage,
    slenderness,
)
from tmm_cli.mechanics.analysis import CYCLE_SAMPLES, Results, cycle_losses
from tmm_cli.mechanics.groups import ClosedFormSolver, LinkStates, link_states, solvers_towards
from tmm_cli.mechanics.kinematics import (
    DriverRange,
    OutputTravel,
    Strokes,
    output_coordinate,
    output_slope,
    pressure_at,
)
from tmm_cli.mechanics.numerics import EPS, NO_PRESSURE, ROUNDOFF, DoubleDouble, Real, map_record, to_float

DOUBLINGS = 46  # of a bound, from the last bit to far beyond any use
RANGE_SAMPLES = 65  # positions over the driver range at which the largest value of a function is taken
SLOPE_ERROR = 1e-9  # of the sampling step at an extreme: truncation error of the derivative from five points
NOISE = 64  # rounding errors of the largest value: beyond it the sign is certain
MOST_NOISE = 1e-10  # of the largest value: with more noise near a dead position nothing would be certain
FOLLOWED_END_ERROR = 1e-12  # of the range: error of limit positions of groups solved by continuation
DEAD_POSITION_ERROR = 1e-9  # of the range: error of dead positions at a least margin


class PreciseLinkage:
    """A linkage that can be solved accurately at any driver coordinates.

    Its numbers are double-doubles, made from the decimal numbers of its file.

    growth: factor by which rounding errors grow from group to group; if given, float64 is used instead.
    """

    def __init__(self, results: Results, growth: float | None = None) -> None:
        self.results = results
        self.linkage = exact_linkage(results) if growth is None else results.linkage
        self.kernels = tuple(kernel.rebind(self.linkage) for kernel in results.kernels)
        self.kind: Any = DoubleDouble if growth is None else np.asarray
        self.noise = NOISE * (EPS if growth is None else ROUNDOFF * growth)
        self.known: dict[str, tuple[Real, Real]] = {}  # bounds of strokes, by output link

    def at(self, q: Real, links: Iterable[str], order: int = 0) -> LinkStates:
        """Return the states of some links, and of the links on which they depend, at driver coordinates q."""
        kernels = solvers_towards(self.kernels, links)
        return link_states(self.linkage, kernels, q if isinstance(q, DoubleDouble) else self.kind(q), order)

    def sides(self, coordinates: Real) -> tuple[Real, Real]:
        """Return increasing distances from driver coordinates, and the coordinates at these distances on both sides.

        The smallest distance is half the spacing of floating-point numbers.

        Returns:
            Distances, (coordinates, distances), and driver coordinates, (2, coordinates, distances).
        """
        steps = 2.0 ** np.arange(DOUBLINGS) * np.spacing(np.maximum(np.abs(coordinates), 1e-3))[:, None] / 2
        precise = self.kind(coordinates)[:, None]
        return steps, np.stack([precise - steps, precise + steps])

    def brackets(
        self,
        coordinates: Real,
        function: Callable[[LinkStates], Real],
        links: Iterable[str],
        scale: float | None = None,
    ) -> tuple[Real, LinkStates, Real]:
        """Find how far from each driver coordinate one has to go to see a change of sign of a function with certainty.

        Args:
            coordinates: driver coordinates.
            function: function of the link states.
            links: links on which the function depends.
            scale: largest value of the function; None to compute it over the driver range.

        Returns:
            The distances (inf where no change of sign is certain), the link states (those at `coordinates` first), and
            bounds of the function at `coordinates`.
        """
        steps, both = self.sides(coordinates)
        driver_range = self.results.mechanism.driver_range
        samples = np.linspace(driver_range.start, driver_range.end, RANGE_SAMPLES)
        with np.errstate(all="ignore"):
            states = self.at(np.concatenate([self.kind(coordinates), both.ravel(), samples]), links, 1)
            centre_values, values, along = np.split(
                to_float(function(states)), [len(coordinates), len(coordinates) + both.size]
            )
        scale = float(np.nanmax(np.abs(along))) if scale is None else scale
        below, above = np.where(np.abs(values) > self.noise * scale, np.sign(values), 0).reshape(both.shape)
        distance = _first_sure_step((below != above) & (np.abs(below) + np.abs(above) > 0), steps)
        return distance, states, np.abs(centre_values) + self.noise * scale

    def turns(self, coordinates: Real, runs: Real, link: str, inner: Real | bool = True) -> tuple[Real, Real]:
        """Return error bounds of the driver coordinates at which an output reverses, and of its coordinates there.

        inner: mask of the driver coordinates that are reversals; the others are requested positions.
        """
        carrier = self.linkage.output_carrier(link)
        bounds, states, slope = self.brackets(coordinates, lambda states: output_slope(states, link), [carrier])
        bounds = np.where(inner, bounds, 2 * ROUNDOFF * np.abs(coordinates))
        deviation = np.abs(to_float(output_coordinate(states, link)[: len(coordinates)] - runs))
        if self.linkage.output_swings(link):
            deviation = np.abs(np.remainder(deviation + np.pi, 2 * np.pi) - np.pi)
        deviation = np.nan_to_num(deviation) + np.where(np.isfinite(bounds), bounds, 0.0) * np.nan_to_num(slope)
        return bounds, 2 * deviation + 4 * (ROUNDOFF + self.noise) * np.abs(runs)

    def strokes(self, strokes: Strokes) -> tuple[Real, Real]:
        """Return error bounds of the driver coordinates at the ends of strokes, and of the output coordinates there."""
        if strokes.link not in self.known:
            coordinates, lows = (np.array([getattr(s, name) for s in strokes.strokes]) for name in ("start", "low"))
            self.known[strokes.link] = self.turns(coordinates, lows, strokes.link)
        return self.known[strokes.link]

    def travel(self, travel: OutputTravel) -> tuple[Real, Real]:
        """Return error bounds of the least and the largest output coordinate, and of the driver coordinates there."""
        coordinates, requested = np.array([travel.low_at, travel.high_at]), self.results.asked
        inner = (np.min(requested) < coordinates) & (coordinates < np.max(requested))
        return self.turns(coordinates, np.array([travel.low, travel.high]), travel.link, inner)

    def end(self, place: float, towards: int, group: str, span: float) -> float:
        """Return the error bound of an end of the driver range.

        At this distance inside the end the group that limits the driver can certainly be assembled, at this distance
        outside it certainly cannot.
        """
        kernel = next((k for k in self.kernels if k.group.title == group), None)
        if not isinstance(kernel, ClosedFormSolver):
            return FOLLOWED_END_ERROR * span + 4 * ROUNDOFF * abs(place)
        steps, both = self.sides(np.array([place]))
        inside, outside = self.at(both.ravel(), kernel.group.links).placed.reshape(both.shape)[::towards]
        sure = float(_first_sure_step(inside & ~outside, steps)[0])
        return (sure if np.isfinite(sure) else FOLLOWED_END_ERROR * span) + self.noise * span

    def dead(self, place: float, group: str, span: float) -> float:
        """Return the error bound of a dead position inside the driver range, at which the residual of the group is
        stationary.
        """
        kernel = next(kernel for kernel in self.kernels if kernel.group.title == group)
        if not isinstance(kernel, ClosedFormSolver):
            return DEAD_POSITION_ERROR * span

        def closing(states: LinkStates) -> Real:
            at = kernel.closed(states.poses, states.drives)
            return kernel.residual_rate(at, states.poses, states.first, states.drives)

        distance = self.brackets(np.array([place]), closing, kernel.group.links, float(kernel.size))[0]
        return min(float(distance[0]), DEAD_POSITION_ERROR * span)

    def pressure(self, group: str, link: str, place: float, largest: float, span: float) -> tuple[float, float]:
        """Return the error bounds of an extreme pressure angle and of its driver coordinate.

        At a flat extreme only half the digits of the driver coordinate are certain. An extreme at an end of the driver
        range has the error bound of that end. If the angle is constant, the driver coordinate is undetermined and its
        bound infinite.
        """
        if largest < NO_PRESSURE:
            return largest + 4 * ROUNDOFF, np.inf
        step = 1e-3 * (span if self.results.linkage.driver.kind == "slide" else 1.0)
        driver_range = self.results.mechanism.driver_range
        limit = next((limit for limit in driver_range.limits if limit.place == place), None)
        if largest == np.pi / 2 and limit is None:  # a dead position inside the range
            return 2 * ROUNDOFF, self.dead(place, group, span)
        if largest == np.pi / 2 and limit is not None:
            return 2 * ROUNDOFF, self.end(place, -1 if place == driver_range.start else 1, limit.group, span)
        states = self.at(self.kind(place) + step * np.arange(-2, 3), [link])
        b2, b1, peak, a1, a2 = pressure_at(states, group, link)
        error = 2 * abs(float(peak) - largest) + 32 * ROUNDOFF + 4 * self.noise / max(float(np.cos(largest)), ROUNDOFF)
        edge = 2 * DEAD_POSITION_ERROR * span
        for end, inside in ((driver_range.start, a1), (driver_range.end, b1)):
            if not driver_range.full and abs(place - end) <= edge and float(peak - inside) > error:
                return error, edge + 4 * ROUNDOFF * abs(place)
        bend = abs(float(2 * peak - b1 - a1)) / step**2  # a maximum or a minimum
        if not bend * step**2 > error:  # the curvature is within rounding
            return error, np.inf
        slope = float(8 * (a1 - b1) - (a2 - b2)) / (12 * step)
        shift = abs(slope / bend)  # distance to the zero of the derivative
        flat = 4 * float(np.sqrt(error / bend)) + 1e-7 * step
        place_bound = 4 * shift + SLOPE_ERROR * step + 4 * ROUNDOFF * abs(place) if shift < 1e-3 * step else flat
        return error, place_bound if place_bound < span else np.inf


def choose_precision(results: Results) -> PreciseLinkage:
    """Return the linkage in float64 if rounding errors grow little from group to group, else in double-doubles."""
    grown = error_growth(results)
    growth = slenderness(results) * float(np.max(grown, where=np.isfinite(grown), initial=1.0))
    return PreciseLinkage(results, growth if NOISE * ROUNDOFF * growth < MOST_NOISE else None)


def _first_sure_step(sure: Real, steps: Real) -> Real:
    """Return, for each driver coordinate, the first distance at which the sign is certain; inf if there is none."""
    return np.where(sure.any(axis=1), steps[np.arange(len(steps)), sure.argmax(axis=1)], np.inf)


# Bounds of searched numbers: ends of strokes, limits, dead positions, largest pressure angles.


Cells = Mapping[Hashable, Real]

SHIFT_FACTOR = 2.0**20  # bounds per shift, so that the shift is well above rounding
LARGEST_SHIFT = 1e-6  # rad or m: keeps a shift within first order


class SearchedNumber(NamedTuple):
    """Number of the mechanism that was found by a search.

    Attributes:
        path: its path in the results.
        bound: bound of its error.
        shifted: function that returns the results with this number shifted.
        sense: direction of the shift, +1 or -1.
    """

    path: str
    bound: float
    shifted: Callable[[float], Results]
    sense: int = 1


def judge_searched(
    results: Results, read: Callable[[Results], Cells], wide: PreciseLinkage, mu: float = float("nan")
) -> Digits:
    """Compute the accuracy of values that describe the whole mechanism and were found by searches.

    A root is known as accurately as the sign of its function. A value that depends on several searched numbers is
    computed with each of them shifted by its bound in turn.

    Args:
        results: results with a motion.
        read: function that returns the values from results, by key.
        wide: the linkage in higher precision.
        mu: scale of the drawing, m per mm; nan to leave out the sensitivities.
    """
    values, data = read(results), list_lengths(results.linkage)
    row = _value_row(values, values)
    bound = 2 * ROUNDOFF * np.abs(row)
    with np.errstate(all="ignore"):
        rates = {} if np.isnan(mu) or results.driver_range is None else search_sensitivities(results, data)
        responses = np.zeros((len(row), len(data)))  # derivative of each number with respect to each length
        for searched in searched_numbers(results, wide):
            rate = rates.get(searched.path, 0.0)
            by = searched.sense * (
                min(LARGEST_SHIFT, SHIFT_FACTOR * searched.bound) or (LARGEST_SHIFT if np.any(rate) else 0.0)
            )
            if by:
                slope = _value_changes(_value_row(read(searched.shifted(by)), values), row) / by
                bound = bound + np.where(slope != 0, np.abs(slope) * searched.bound, 0.0)
                responses = responses + np.where(rate, slope[:, None] * rate, 0.0)
        sizes = np.array([abs(length.value) for length in data])
        share, paper = LENGTH_CHANGE * np.abs(responses) @ sizes, PAPER_CHANGE * mu * np.abs(responses).sum(axis=1)
    ends_of = np.cumsum([np.size(value) for value in values.values()])[:-1]
    # np.split of an empty array still yields one part
    accuracy = [dict(zip(values, np.split(cells, ends_of), strict=False)) for cells in (bound, share, paper)]
    return Digits(accuracy[0], accuracy[1], accuracy[2], mu)


def _value_row(moved: Cells, values: Cells) -> Real:
    """Join the numbers of all values in one row.

    Numbers that are missing in `moved`, or have another shape there, are taken from `values`.
    """
    kept = (
        moved[key] if key in moved and np.shape(moved[key]) == np.shape(value) else value
        for key, value in values.items()
    )
    return np.concatenate([np.zeros(0), *(np.ravel(value) for value in kept)])


def _value_changes(moved: Real, original: Real) -> Real:
    """Return the differences between two arrays of values.

    A difference of 360 degrees between angles counts as zero, and so does a difference that is nan.
    """
    change: Real = moved - original
    turn = np.copysign(2 * np.pi, change)
    return np.where(np.abs(change - turn) < 1e-3, change - turn, np.where(np.isnan(change), 0.0, change))


def searched_numbers(results: Results, wide: PreciseLinkage) -> Iterator[SearchedNumber]:
    """Yield all numbers of the results that were found by searches."""
    driver_range = results.driver_range
    if driver_range is None:
        return
    span = driver_range.end - driver_range.start

    def found(path: str, bound: float, sense: int = 1, also: Sequence[str] = ()) -> SearchedNumber:
        return SearchedNumber(
            path, float(bound), lambda by: _shifted_results(results, dict.fromkeys((path, *also), by)), sense
        )

    for (end, *also), bound in zip(
        range_end_paths(driver_range), _range_end_bounds(results, driver_range, wide), strict=True
    ):
        yield found(end, bound, also=also)
    for output, strokes in stroke_paths(results).items():
        starts, lows = wide.strokes(strokes)
        parts = {"start": starts, "length": starts + np.roll(starts, -1), "low": lows, "run": lows + np.roll(lows, -1)}
        for k in range(len(starts)):
            for name, bounds in parts.items():
                yield found(f"{output}.strokes[{k}].{name}", bounds[k])
    for k, travel in enumerate(results.travels):
        for name, bound_at, bound in zip(("low", "high"), *wide.travel(travel), strict=True):
            yield found(f"travels[{k}].{name}_at", bound_at)
            yield found(f"travels[{k}].{name}", bound)
    for k, dead in enumerate(results.dead):
        yield found(f"dead[{k}].place", wide.dead(dead.place, dead.group, span))
        yield found(f"dead[{k}].margin", dead.margin + 4 * ROUNDOFF)
    for k, pressure in enumerate(results.pressure):
        largest, place_bound = wide.pressure(pressure.group, pressure.link, pressure.place, pressure.largest, span)
        yield found(f"pressure[{k}].largest", largest, -1)
        yield found(f"pressure[{k}].place", place_bound)
        if np.isfinite(pressure.other):
            other, place_bound = wide.pressure(
                pressure.group, pressure.link, pressure.other_place, pressure.other, span
            )
            yield found(f"pressure[{k}].other", other, -1)
            yield found(f"pressure[{k}].other_place", place_bound)
    if results.losses is not None:  # the difference from a sum over half as many positions bounds the error
        rough = cycle_losses(results, CYCLE_SAMPLES // 2, ranges=False)

        def towards(by: float) -> Results:
            losses = map_record(
                lambda __, fine, half: fine + by * (half - fine), results.losses, rough, skip=("locked", "ranges")
            )
            return replace(results, losses=losses)

        yield SearchedNumber("losses", 1.0, towards)


def _range_end_bounds(results: Results, driver_range: DriverRange, wide: PreciseLinkage) -> Iterator[float]:
    """Yield the bounds of both ends of the driver range."""
    span = driver_range.end - driver_range.start
    for sense, place in ((-1, driver_range.start), (1, driver_range.end)):
        limit = None if driver_range.full else _limiting_group(results, place)
        yield 2 * ROUNDOFF * abs(place) if limit is None else wide.end(place, sense, limit, span)


def start_uncertainty(results: Results, wide: PreciseLinkage) -> float:
    """Return the uncertainty of the driver coordinate of position 0, rad or m."""
    request, driver_range = results.inputs.request, results.driver_range
    if driver_range is None or request.places:
        return 0.0
    if not driver_range.full:
        return max(_range_end_bounds(results, driver_range, wide))
    if request.start != "working stroke" or results.strokes is None or not results.strokes.strokes:
        return 0.0
    return float(wide.strokes(results.strokes)[0][0])


def _shifted_results(results: Results, by: Mapping[str, float]) -> Results:
    """Return the results with some numbers of the mechanism shifted, by path, e.g. travels[0].low.

    Pressure angles at the positions are not found by searches and are kept.
    """

    def moved(field: str) -> Any:
        return map_record(
            lambda path, value: value + by[path] if path in by else value, getattr(results, field), path=field
        )

    parts = {path.partition(".")[0].partition("[")[0] for path in by}
    return replace(
        results, mechanism=results.mechanism.with_changed(**{field: moved(field) for field in parts | {"pressure"}})
    )


def _limiting_group(results: Results, place: float) -> str | None:
    """Return the title of the group that limits the driver at an end of its range, or None."""
    assert results.driver_range is not None
    return next((limit.group for limit in results.driver_range.limits if limit.place == place), None)
