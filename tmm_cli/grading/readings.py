"""What an answer may mean: its number in the unit written beside it, or in each that people write without saying so."""

from __future__ import annotations

from functools import cache

import numpy as np

from tmm_cli.errors import _
from tmm_cli.grading.quantities.base import Quantity
from tmm_cli.grading.record import Given
from tmm_cli.problem.errors import quote
from tmm_cli.problem.units import UnitError, UnitSystem, parse_unit
from tmm_cli.quantities import (
    ACCELERATION,
    ANGLE,
    ANGULAR_SPEED,
    FORCE,
    LENGTH,
    MOMENT,
    SPEED,
    Dimension,
)

UNSAID: dict[Dimension, tuple[str, ...]] = {
    LENGTH: ("mm", "m", "cm"),
    ANGLE: ("deg", "rad"),
    SPEED: ("m/s", "mm/s"),
    ACCELERATION: ("m/s^2", "mm/s^2"),
    ANGULAR_SPEED: ("rad/s", "rpm"),
    FORCE: ("N", "kN"),
    MOMENT: ("N*m", "N*mm"),
}


def readings(given: Given, quantity: Quantity, units: UnitSystem) -> dict[str, complex]:
    """Values in SI by the unit that they were read in; the file's own unit first. Raises ProblemError."""
    named = (units.symbol(quantity.dimension), *UNSAID.get(quantity.dimension, ()))
    return {name: _value(given, factor(name, quantity.dimension)) for name in ((given.unit,) if given.unit else named)}


@cache
def factor(name: str, dimension: Dimension) -> float:
    """A unit in SI. Raises UnitError where it measures something else."""
    if not name:
        return 1.0
    unit = parse_unit(name)
    if not unit.dimension.fits(dimension):
        raise UnitError(_("{want} is wanted here").format(want=dimension), found=quote(name), allowed=dimension.example)
    return unit.si(1.0)


def _value(given: Given, unit: float) -> complex:
    if given.form == "polar":
        return complex(given.first * unit * np.exp(1j * given.second * factor(given.turn_unit or "deg", ANGLE)))
    if given.form == "components":
        return complex(given.first, given.second) * unit
    return complex(given.first * unit)
