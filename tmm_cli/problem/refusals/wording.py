"""The words for each kind of refusal, registered by its class."""

from __future__ import annotations

from functools import singledispatch

from tmm_cli.errors import LinkageError
from tmm_cli.problem.errors import ProblemError
from tmm_cli.problem.record import Problem
from tmm_cli.problem.units import UnitSystem
from tmm_cli.quantities import ANGLE, LENGTH


@singledispatch
def worded(error: LinkageError, problem: Problem) -> ProblemError:
    """A stage's refusal, with the path of the key that it is about."""
    return ProblemError(str(error))


def shown(value: complex | float, units: UnitSystem) -> str:
    """A point (m) or an angle (rad) in the units of the file."""
    if isinstance(value, complex):
        return f"[{units.from_si(value.real, LENGTH):.6g}, {units.from_si(value.imag, LENGTH):.6g}]"
    return units.told(value, ANGLE)
