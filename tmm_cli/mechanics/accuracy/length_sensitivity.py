"""Sensitivity of results to single lengths of a linkage, and conversion of linkages to double-doubles."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from tmm_cli.mechanics.analysis import Results
from tmm_cli.mechanics.groups import LinkStates, link_states
from tmm_cli.mechanics.kinematics import DriverRange, PressureAngle, Strokes, output_coordinate, pressure_at
from tmm_cli.mechanics.linkage import Linkage
from tmm_cli.mechanics.numerics import NO_COORDINATE, ROUNDOFF, Real, Record, map_record, to_double_double


@dataclass(frozen=True)
class LengthCoordinate:
    """A coordinate of points of a link that is treated as one of its lengths; it is not zero.

    Directions of guides are treated in the same way, with `along` = 1.0.

    Attributes:
        link: the link.
        along: axis of the coordinate: 1 for x, i for y.
        value: the coordinate, m.
        paths: paths in the linkage to all vectors that contain this coordinate, as in `map_record`. They change
            together.
    """

    link: str
    along: complex | float
    value: float
    paths: frozenset[str]


def list_lengths(linkage: Linkage) -> tuple[LengthCoordinate, ...]:
    """List the nonzero coordinates of all links. Equal coordinates on one link count as one length."""
    paths_by_length: dict[tuple[str, complex, float], list[str]] = {}
    vectors = list(_link_vectors(linkage))
    least = NO_COORDINATE * max((abs(complex(value)) for _, _, value in vectors), default=0.0)
    for link, path, value in vectors:
        for along, coordinate in ((1 + 0j, float(value.real)), (1j, float(value.imag))):
            if abs(coordinate) > least:
                paths_by_length.setdefault((link, along, coordinate), []).append(path)
    return tuple(
        LengthCoordinate(link, along, value, frozenset(paths))
        for (link, along, value), paths in paths_by_length.items()
    )


def largest_on_link(data: Sequence[LengthCoordinate]) -> Real:
    """Return, for each length, the largest of all lengths of the same link (m), shape (lengths,)."""
    return np.array([max(abs(other.value) for other in data if other.link == length.link) for length in data])


def change_length(linkage: Linkage, length: LengthCoordinate, by: Any) -> Linkage:
    """Return the linkage with one length increased by `by` (m), in the precision of its numbers."""
    return change_lengths(linkage, [(length, by)])


def change_lengths(linkage: Linkage, changes: Iterable[tuple[LengthCoordinate, Any]]) -> Linkage:
    """Return the linkage with several lengths increased, each by its own amount (m)."""
    increments: dict[str, Any] = {}
    for length, by in changes:
        for path in length.paths:
            increments[path] = increments.get(path, 0.0) + length.along * by
    return map_record(lambda path, value: value + increments[path] if path in increments else value, linkage)


def _link_vectors(linkage: Linkage) -> Iterator[tuple[str, str, Any]]:
    """Yield every vector that is given in the axes of a link.

    Yields:
        Name of the link, path of the vector in the linkage, and the vector.
    """
    for name, link in linkage.links.items():
        for point, value in link.points.items():
            yield name, f"links.{name}.points.{point}", value
        if np.any(link.mass != 0):
            yield name, f"links.{name}.centre", link.centre
    for k, slide in enumerate(linkage.slides):
        yield slide.carrier, f"slides[{k}].through", slide.through
        yield slide.runner, f"slides[{k}].at", slide.at
    for k, load in enumerate(linkage.loads):
        if load.force != 0:
            yield load.link, f"loads[{k}].at", load.at
    for k, element in enumerate(linkage.elements):
        for end in element.ends:
            yield end.link, f"elements[{k}].{end.field}", end.at


def as_double_doubles(record: Record) -> Record:
    """Convert every float and complex number of a record to double-double, without changing its value."""

    def wide(path: str, value: Any) -> Any:
        return to_double_double(value) if isinstance(value, float | complex) else value

    return map_record(wide, record)


# Derivatives of searched numbers with respect to each length.


Function = Callable[[LinkStates], Real]  # (..., positions)

EXTREME_STEP = 1e-4  # rad, or fraction of a slider range: distance of samples from an extreme
LENGTH_STEP = 1e-6  # of a length, at an extreme
END_DISTANCES = 1e-4 * np.array(
    [1, 4, 16]
)  # of the range: distances from an end at which groups are examined; they vary as the square root
DRIVER_STEP_AT_END = 1e-3  # driver step, as a fraction of the distance to the end
LENGTH_STEP_AT_END = 1e-6  # length step, likewise
AT_END = 2e-9  # of the range: a largest pressure angle closer to an end lies at the end
FLAT_EXTREME = 64 * ROUNDOFF  # of the value: the position of an extreme with less curvature is not determined
LEAST_SYMMETRY = 0.9  # least ratio of the curvatures on both sides; below it the extreme is the edge of a dwell


def search_sensitivities(results: Results, data: tuple[LengthCoordinate, ...]) -> Mapping[str, Real]:
    """Compute the derivatives, with respect to each length, of all numbers that were found by a search.

    The search is not repeated: the derivatives follow from the function f near the solution. At an extreme (f' = 0), a
    length p moves the argument by -(df'/dp) / f'' per unit of p, and the extreme value changes by df/dp. At an end of
    the driver range, the group that stops the driver has reached its limit. This end moves as the driver would move if
    that group were held in place.

    Args:
        results: results with a motion.
        data: the lengths.

    Returns:
        Derivatives per metre, (lengths,), by path in `results`; 0 if the number is not determined (flat function, or a
        length that redundant constraints fix).
    """
    assert results.driver_range is not None
    beside = _LocalRates(results, results.driver_range, data)
    rates = {
        path: _extrapolate_to_end(beside.ends[k])
        for k, paths in enumerate(range_end_paths(results.driver_range))
        for path in paths
    }
    for path, strokes in stroke_paths(results).items():
        starts, lows = beside.extremes(np.array([s.start for s in strokes.strokes]), _output_function(strokes.link))
        ways = results.linkage.driver.sense * (np.roll(starts, -1, axis=0) - starts)
        parts = {"start": starts, "length": ways, "low": lows, "run": np.roll(lows, -1, axis=0) - lows}
        rates |= {f"{path}.strokes[{k}].{name}": row for name, rows in parts.items() for k, row in enumerate(rows)}
    for k, travel in enumerate(results.travels):
        rows = beside.travel(np.array([travel.low_at, travel.high_at]), _output_function(travel.link))
        paths = [f"travels[{k}].{name}" for name in ("low_at", "high_at", "low", "high")]
        rates |= zip(paths, np.concatenate(rows), strict=True)
    for k, dead in enumerate(results.dead):
        rates[f"dead[{k}].place"] = beside.extremes(np.array([dead.place]), _margin_function(dead.group))[0][0]
    for k, pressure in enumerate(results.pressure):
        place, largest = beside.pressure(pressure)
        rates |= {f"pressure[{k}].place": place, f"pressure[{k}].largest": largest}
        if np.isfinite(pressure.other):
            place, other = beside.pressure(replace(pressure, place=pressure.other_place, largest=pressure.other))
            rates |= {f"pressure[{k}].other_place": place, f"pressure[{k}].other": other}
    return {path: np.where(np.isfinite(rate), rate, 0.0) for path, rate in rates.items()}


def range_end_paths(driver_range: DriverRange) -> tuple[list[str], list[str]]:
    """Return the paths of all numbers in results that equal the start of the driver range, and those that equal its
    end.
    """
    limits = [(f"driver_range.limits[{k}].place", limit.place) for k, limit in enumerate(driver_range.limits)]
    named = (("start", driver_range.start), ("end", driver_range.end))
    start, end = ([f"driver_range.{name}", *(path for path, at in limits if at == place)] for name, place in named)
    return start, end


def stroke_paths(results: Results) -> dict[str, Strokes]:
    """Return the strokes of every output link that has strokes.

    The keys are paths in `results`: "strokes" for the main output link, "further[0]", ... for the others.
    """
    outputs = {"strokes": results.strokes} | {f"further[{k}]": strokes for k, strokes in enumerate(results.further)}
    return {path: strokes for path, strokes in outputs.items() if strokes is not None and strokes.strokes}


@dataclass(frozen=True)
class _LocalRates:
    """Computes functions of the link positions near given driver coordinates, and their derivatives.

    The derivatives are taken with respect to the lengths of the linkage.
    """

    results: Results
    driver_range: DriverRange
    data: tuple[LengthCoordinate, ...]

    def values(self, coordinates: Real, aside: Real | float, function: Function, change: float) -> tuple[Real, Real]:
        """Evaluate a function before, at and after each driver coordinate.

        Args:
            coordinates: driver coordinates.
            aside: distance before and after them.
            function: function of the link positions.
            change: step of each length, relative to the largest length of its link.

        Returns:
            Values (..., 3, coordinates) and derivatives per metre (..., 3, coordinates, lengths).
        """
        q = coordinates + aside * np.array([[-1], [0], [1]])
        by = change * largest_on_link(self.data)
        number = np.repeat(np.arange(len(by) + 1), q.size)
        changes = [(length, np.where(number == k, by[k - 1], 0.0)) for k, length in enumerate(self.data, 1)]
        linkage = change_lengths(self.results.linkage, changes)
        kernels = tuple(kernel.rebind(linkage) for kernel in self.results.kernels)
        sampled = function(link_states(linkage, kernels, np.tile(q.ravel(), len(by) + 1), 0))
        sampled = np.moveaxis(sampled.reshape(*np.shape(sampled)[:-1], -1, *q.shape), -3, -1)
        return sampled[..., 0], (sampled[..., 1:] - sampled[..., :1]) / by

    def extremes(self, coordinates: Real, function: Function) -> tuple[Real, Real]:
        """Compute how the extremes of a function shift with the lengths.

        Returns:
            Derivatives of the driver coordinates of the extremes, and of the extreme values, both (extremes,
            lengths).
        """
        slider = self.results.linkage.driver.kind == "slide"
        aside = EXTREME_STEP * (self.driver_range.end - self.driver_range.start if slider else 1.0)
        values, rates = self.values(coordinates, aside, function, LENGTH_STEP)
        before, after = values[0] - values[1], values[2] - values[1]
        bends = np.minimum(before / after, after / before) > LEAST_SYMMETRY
        bends = bends & (np.abs(before) > FLAT_EXTREME * np.abs(values[1]))
        moved = -(rates[2] - rates[0]) / 2 * (aside / (before + after))[:, None]
        return np.where(bends[:, None], moved, 0.0), rates[1]

    def by_end(self, k: int, function: Function) -> tuple[Real, Real]:
        """Differentiate a function near an end of the driver range, at three distances from it.

        k: 0 for the start of the range, 1 for its end.

        Returns:
            Derivatives with respect to the driver coordinate, (..., 3), and to the lengths, (..., 3, lengths).
        """
        span = self.driver_range.end - self.driver_range.start
        left = END_DISTANCES * span
        coordinates = self.driver_range.end - left if k else self.driver_range.start + left
        values, rates = self.values(
            coordinates, DRIVER_STEP_AT_END * left, function, LENGTH_STEP_AT_END * END_DISTANCES[0] * min(span, 1.0)
        )
        return (values[..., 2, :] - values[..., 0, :]) / (2 * DRIVER_STEP_AT_END * left), rates[..., 1, :, :]

    @cached_property
    def ends(self) -> tuple[Real, Real]:
        """Derivatives of the start and of the end of the driver range with respect to the lengths, each (3, lengths).

        They are computed at three distances from that end, as the motion of the driver if the group that limits it were
        held in place.
        """
        return self._end(0, self.driver_range.start), self._end(1, self.driver_range.end)

    def _end(self, k: int, place: float) -> Real:
        group = next((kernel.group for kernel in self.results.kernels if kernel.group.title in self.stops(place)), None)
        if self.driver_range.full or group is None:
            return np.zeros((3, len(self.data)))
        slopes, rates = self.by_end(k, lambda states: _link_coordinates(states, group.links))
        best = int(np.nanargmax(np.abs(slopes[:, 0])))
        moved: Real = -rates[best] / slopes[best, :, None]
        return moved

    def stops(self, place: float) -> set[str]:
        """Return the titles of the groups that stop the driver at `place`, an end of its range."""
        return {limit.group for limit in self.driver_range.limits if limit.place == place}

    def travel(self, coordinates: Real, function: Function) -> tuple[Real, Real]:
        """Compute the derivatives of extremes, some of which may lie at the first or the last requested position.

        Returns:
            Derivatives of the driver coordinates of the extremes, and of the extreme values, both (extremes,
            lengths).
        """
        requested, driver_range = self.results.asked, self.driver_range
        moved, rates = self.extremes(coordinates, function)
        start, end = map(_extrapolate_to_end, self.ends)
        share = (coordinates[:, None] - driver_range.start) / (driver_range.end - driver_range.start)
        edges = (start + share * (end - start)) * (not self.results.inputs.request.places)
        inner = (np.min(requested) < coordinates) & (coordinates < np.max(requested))
        return np.where(inner[:, None], moved, edges), rates

    def pressure(self, pressure: PressureAngle) -> tuple[Real, Real]:
        """Compute how a largest pressure angle shifts with the lengths.

        If it is 90 degrees, at a limit position of the driver, it remains so whatever the lengths.

        Returns:
            Derivatives of its driver coordinate and of the angle, each (lengths,).
        """
        driver_range = self.driver_range
        function, close = _pressure_function(pressure), AT_END * (driver_range.end - driver_range.start)
        for k, end in () if driver_range.full else enumerate((driver_range.start, driver_range.end)):
            if abs(pressure.place - end) <= close:
                moved = _extrapolate_to_end(self.ends[k])
                if pressure.largest == np.pi / 2:
                    return moved, np.zeros(len(self.data))
                slopes, rates = self.by_end(k, function)
                return moved, _extrapolate_to_end(rates + slopes[:, None] * moved)
        coordinates, largest = self.extremes(np.array([pressure.place]), function)
        return coordinates[0], largest[0]


def _extrapolate_to_end(rates: Real) -> Real:
    """Extrapolate derivatives (3, lengths) to the end of the driver range.

    They are taken as polynomials in the square root of the distance, which is 1, 2 and 4 units at the three
    samples.
    """
    limit: Real = (8 * rates[0] - 6 * rates[1] + rates[2]) / 3
    return limit


def _link_coordinates(states: LinkStates, links: tuple[str, ...]) -> Real:
    """Stack, for some links, the coordinates of their origins and the components of their directions.

    The shape is (coordinates, positions).
    """
    poses = [states.poses[link] for link in links]
    vectors = [component for pose in poses for component in (pose.x, pose.z)]
    return np.stack([component for vector in vectors for component in (vector.real, vector.imag)])


def _output_function(link: str) -> Function:
    return lambda states: output_coordinate(states, link)


def _pressure_function(pressure: PressureAngle) -> Function:
    return lambda states: pressure_at(states, pressure.group, pressure.link)


def _margin_function(group: str) -> Function:
    """Return a function that computes the squared margin of a group to its dead positions.

    The square is smooth through a dead position, where the margin is zero.
    """

    def of(states: LinkStates) -> Real:
        titles = [kernel.group.title for kernel in states.kernels]
        return states.placements[titles.index(group)].margin ** 2

    return of
