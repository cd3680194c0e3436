"""Ranges of an optimal synthesis: bounds of the varied parameters, and the range of the driver."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import reduce
from typing import Any

import numpy as np

from tmm_cli.batch import MOST_VALUES, STEP_TOLERANCE, Chosen, Range, Variant, bounds_text
from tmm_cli.language import _
from tmm_cli.mechanics.linkage import Driver
from tmm_cli.mechanics.quantities import ANGLE, DIMENSIONS, LENGTH, Dimension
from tmm_cli.problem import (
    Path,
    PhysicalValue,
    Problem,
    ProblemError,
    UnitError,
    UnitSystem,
    ValueReader,
    evaluate_quantity,
    quote,
)
from tmm_cli.synthesis.blocks import TriedFileError
from tmm_cli.synthesis.optimal.task import Parameter

FileWith = Callable[[dict[str, PhysicalValue], UnitSystem], Problem]


def read_ranges(
    vary: Mapping[str, Range], reader: ValueReader, names: Mapping[str, str], file_with: FileWith
) -> tuple[Parameter, ...]:
    """Read the ranges of the varied parameters.

    Args:
        vary: ranges by name of the parameter.
        reader: reader of numbers with units.
        names: names of the parameters in the file, where they differ.
        file_with: function that builds the problem with given parameter values and units.

    Raises:
        ProblemError: a range is invalid.
    """
    kinds = _find_kinds({name: _list_range_values(bounds) for name, bounds in vary.items()}, reader, names, file_with)
    return tuple(_read_parameter(name, bounds, kinds[name], reader) for name, bounds in vary.items())


def _list_range_values(bounds: Range) -> list[Any]:
    """Return all numbers in the range of a parameter (bounds, step or discrete values) as the file gives them."""
    return (bounds.among or [bounds.from_, bounds.to, bounds.step]) if isinstance(bounds, Chosen) else bounds


def _read_parameter(name: str, bounds: Range, kind: str, reader: ValueReader) -> Parameter:
    at: Path = ("vary", name)
    dimension = DIMENSIONS[kind].dimension

    def si(value: Any, *inside: str | int) -> float:
        return float(reader.number(value, dimension, (*at, *inside)))

    if isinstance(bounds, Chosen) and bounds.among:
        values = sorted({si(value, "among", n) for n, value in enumerate(bounds.among)})
        if len(values) < 2:
            raise ProblemError(
                _("with a single value the parameter does not vary"),
                path=(*at, "among"),
                found=quote(bounds.among[0]),
                allowed=_("two or more values"),
            )
        return Parameter(name, values[0], values[-1], kind, tuple(values))
    ends = {"from": bounds.from_, "to": bounds.to} if isinstance(bounds, Chosen) else dict(enumerate(bounds))
    low, high = (si(value, key) for key, value in ends.items())
    if not low < high:
        raise ProblemError(
            _("the first bound must be smaller than the second"),
            path=at,
            found=bounds_text(*ends.values()),
            allowed=_("[low, high]"),
        )
    if not isinstance(bounds, Chosen):
        return Parameter(name, low, high, kind)
    step = float(reader.positive(bounds.step, dimension, (*at, "step")))
    count = (high - low) / step + STEP_TOLERANCE
    if not 1 <= count < MOST_VALUES:
        raise ProblemError(
            _("the number of steps between the bounds must be from 1 to {most}").format(most=MOST_VALUES - 1),
            path=(*at, "step"),
            found=quote(bounds.step),
            allowed=_("give another step, or bounds without a step: [low, high]"),
        )
    values = [float(f"{low + step * k:.15g}") for k in range(int(count) + 1)]  # without rounding errors of the sum
    return Parameter(name, values[0], values[-1], kind, tuple(values))


def _find_kinds(
    raw_values: Mapping[str, list[Any]], reader: ValueReader, names: Mapping[str, str], file_with: FileWith
) -> dict[str, str]:
    """Return the dimension of each parameter.

    If the values of a parameter have a unit, it determines the dimension. Otherwise the dimension is the first one with
    which the file is valid; length is tried first. If the file is valid both with a length and with a plain number, the
    parameter is a plain number, e.g. a fraction of a distance. If the file is invalid with every dimension, the first
    one is taken that does not itself cause the error.
    """
    dimensions = {
        name: next((k for v in raw if (k := _find_dimension(v, reader))), "") for name, raw in raw_values.items()
    }

    def value(name: str, kind: str) -> PhysicalValue:
        if not kind:  # as a bare number
            return evaluate_quantity(raw_values[name][0], reader.parameters, reader.units)
        dimension = DIMENSIONS[kind].dimension
        return PhysicalValue(float(reader.number(raw_values[name][0], dimension, ())), dimension)

    def minded(kinds: Mapping[str, str]) -> int:
        """Return 0 if the file is valid with these dimensions of the parameters.

        Return 2 if it is invalid because of these dimensions, and 1 if it is invalid for another reason.
        """
        try:
            file_with({names.get(name, name): value(name, kind) for name, kind in kinds.items()}, reader.units)
        except TriedFileError as error:
            return 2 if isinstance(error.error, UnitError) else 1
        except ProblemError:
            return 2  # reported when its bounds are read
        return 0

    def is_share(name: str, kinds: Mapping[str, str]) -> bool:
        """Return True if the parameter is a plain number: the file is valid with a number, but not with an angle.

        With a parameter that the file does not use it is valid with both.
        """
        return not minded({**kinds, name: "number"}) and bool(minded({**kinds, name: "angle"}))

    lengths = {name: kind or "length" for name, kind in dimensions.items()}
    if lengths == dimensions:
        return lengths
    if not minded(lengths):
        return lengths | {name: "number" for name, kind in dimensions.items() if not kind and is_share(name, lengths)}
    plain = dict(dimensions)
    for name in (name for name, kind in plain.items() if not kind):
        dimensions[name] = min(("length", *DIMENSIONS), key=lambda kind: minded(plain | {name: kind}))
    return dimensions


def _find_dimension(source: Any, reader: ValueReader) -> str | None:
    try:
        dimension = evaluate_quantity(source, reader.parameters, reader.units).dimension
    except ProblemError:
        return None  # reported when it is evaluated
    return None if dimension is None else dimension.name


# Range of the driver in an optimal synthesis: a cycle, its stroke, the positions of the file, or from one coordinate
# to another.


Ends = tuple[Any, Any] | None
RangeChoice = str | tuple[float, float]


def read_over(over: Any, driver: Driver, reader: ValueReader) -> RangeChoice:
    """Read the key `over`, the range of the driver over which quantities are evaluated.

    Args:
        over: value of the key; None for the default.
        driver: driver of the linkage.
        reader: reader of numbers with units.

    Returns:
        `cycle`, `stroke`, `positions`, or two driver coordinates (rad or m).

    Raises:
        ProblemError: the driver has no such range.
    """
    turns, stroked = driver.kind == "turn", driver.stroke is not None
    available = {"cycle": turns and not stroked, "stroke": stroked, "positions": True}
    possible = [choice for choice, has in available.items() if has]
    if over is None:
        return possible[0]
    if isinstance(over, str):
        if over not in possible:
            raise ProblemError(
                _("the range {over} is not defined for this driver").format(over=over),
                path=("over",),
                found=quote(over),
                allowed=", ".join([*possible, "[from, to]"]),
            )
        return over
    dimension = _get_driver_dimension(driver)
    low, high = (float(reader.number(value, dimension, ("over", n))) for n, value in enumerate(over))
    if not low < high or (turns and high - low > 2 * np.pi * (1 + 1e-12)):
        raise ProblemError(
            _("the first value must be smaller than the second, and the difference at most one revolution"),
            path=("over",),
            found=bounds_text(*over),
            allowed="[from, to]",
        )
    return low, high


def with_driver_range(problem: Problem, over: RangeChoice) -> Variant:
    """Return the linkage of a problem together with the range of its driver. Raises ProblemError."""
    ends, stroke = _find_driver_ends(problem, over), problem.linkage.driver.stroke
    if ends is not None and stroke is not None and not (stroke[0] <= ends[0] and ends[1] <= stroke[1]):
        raise _make_range_error(("over",), over, problem.linkage.driver, stroke, problem.units)
    return Variant(problem.linkage, problem.request, ends)


def _find_driver_ends(problem: Problem, over: RangeChoice) -> Ends:
    driver, coordinates = problem.linkage.driver, problem.request.places
    if over == "cycle":
        return None
    if over == "stroke" or (over == "positions" and driver.stroke is not None and not coordinates):
        return driver.stroke
    if over == "positions":
        over = (reduce(np.minimum, coordinates), reduce(np.maximum, coordinates)) if coordinates else (0.0, 0.0)
        if not over[0] < over[1]:
            raise ProblemError(
                _("the range of the driver is missing"),
                path=("over",),
                allowed=_("over: [from, to]; or positions: {at: [...]}, or driver: {stroke: [from, to]}"),
            )
    assert not isinstance(over, str)
    if driver.kind != "turn" or driver.stroke is not None or (driver.acceleration and coordinates):
        return over  # an accelerated crank has another speed one revolution later
    turns = round(float(problem.linkage.sketch.at - (over[0] + over[1]) / 2) / (2 * np.pi))
    return over[0] + 2 * np.pi * turns, over[1] + 2 * np.pi * turns  # around the sketch, whose assembly it has


def read_position(value: Any, variant: Variant, reader: ValueReader, path: Path) -> Any:
    """Read a driver coordinate (rad or m). Raises ProblemError if it is out of range.

    Full turns are added to an angle if this brings it into the range.
    """
    driver = variant.linkage.driver
    place: Any = reader.number(value, _get_driver_dimension(driver), path)
    if variant.ends is None:
        return place
    low, high = (float(end) for end in variant.ends)
    slack = 1e-9 * (high - low)
    if driver.kind == "turn" and not low - slack <= place <= high + slack:
        place = place + 2 * np.pi * np.ceil(float(low - slack - place) / (2 * np.pi))
    if not low - slack <= place <= high + slack:
        raise _make_range_error(path, value, driver, (low, high), reader.units)
    return place


def _get_driver_dimension(driver: Driver) -> Dimension:
    return ANGLE if driver.kind == "turn" else LENGTH


def _make_range_error(
    path: Path, given_value: Any, driver: Driver, ends: tuple[Any, Any], units: UnitSystem
) -> ProblemError:
    dimension = _get_driver_dimension(driver)
    low, high = (f"{units.from_si(float(end), dimension):.6g}" for end in ends)
    return ProblemError(
        _("the driver does not reach this position"),
        path=path,
        found=quote(given_value) if isinstance(given_value, str) else None,
        allowed=_("positions from {low} to {high} {unit}").format(low=low, high=high, unit=units.symbol(dimension)),
    )
