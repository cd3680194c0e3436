"""A crank's speed by a table of a problem file."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np

from tmm_cli.double_double import rounded
from tmm_cli.interpolation import Table
from tmm_cli.language import _
from tmm_cli.linkage import SpeedTable
from tmm_cli.problem import schema
from tmm_cli.problem.errors import ProblemError, quote
from tmm_cli.problem.values import Part
from tmm_cli.quantities import ANGLE, ANGULAR_ACCELERATION, ANGULAR_SPEED, Dimension
from tmm_cli.tolerances import SAME_PLACE, SAME_RATIO

NO_SPEED = 1e-12  # of the square of the largest: less is rounding of a rest


def build_speeds(part: Part, turns: int) -> SpeedTable:
    """Squares of speeds by the crank's angle, and accelerations if they are given; turns: of the crank in a cycle."""
    given: schema.Driver = part.given
    angles, speeds = _columns(part, "speed", ANGULAR_SPEED)
    path = (*part.path, "speed", "table")
    for k, speed in enumerate(speeds):
        if speed < 0:
            raise ProblemError(
                _("a speed is counted in the driver's sense, which is one alone"), path=(*path, k, 1),
                found=quote(given.speed.table[k][1]), allowed=_("zero or more; turns: cw for the other sense"),
            )  # fmt: skip
    if not any(speeds):
        raise ProblemError(_("the driver stands still in all rows"), path=path, key=True)
    closed = _closes(part, "speed", angles, speeds, turns)
    squares = Table(angles, tuple(speed * speed for speed in speeds), given.speed.between, closed)
    row, least = _least(squares)
    if least < -NO_SPEED * float(rounded(max(speeds))) ** 2:
        below = _("between this row and the next the smooth curve of squares of speeds goes below zero")
        found, allowed = quote(given.speed.table[row][0]), _("between: linear, or more rows there")
        raise ProblemError(below, path=(*path, row, 0), found=found, allowed=allowed)
    if not isinstance(given.acceleration, schema.Speeds):
        return SpeedTable(squares)
    angles, gains = _columns(part, "acceleration", ANGULAR_ACCELERATION)
    closed_too = _closes(part, "acceleration", angles, gains, turns)
    if closed_too != closed or angles[0] > squares.arguments[0] or angles[-1] < squares.arguments[-1]:
        raise part.refusal("acceleration", _("accelerations are given over the same angles as speeds"), at_key=True)
    return SpeedTable(squares, Table(angles, gains, given.acceleration.between, closed_too))


def mean(part: Part) -> float:
    """Of the speeds of all rows, rad/s."""
    speeds = _columns(part, "speed", ANGULAR_SPEED)[1]
    whole: float = sum(speeds) / len(speeds)
    return whole


def _columns(part: Part, key: str, want: Dimension) -> tuple[tuple[Any, ...], tuple[Any, ...]]:
    own = Part(getattr(part.given, key), (*part.path, key), part.values)
    return own.columns("table", ANGLE, want, jumps=key == "acceleration")


def _closes(part: Part, key: str, angles: tuple[Any, ...], values: tuple[Any, ...], turns: int) -> bool:
    """Whether a table goes all round the cycle; then it ends as it begins."""
    table, path, units = getattr(part.given, key).table, (*part.path, key, "table"), part.values.units
    cycle = math.tau * turns
    end = units.told(float(angles[0]) + cycle, ANGLE)
    beyond: Iterable[int] = (k for k, angle in enumerate(angles) if angle - angles[0] > cycle + SAME_PLACE)
    if (row := next(iter(beyond), None)) is not None:
        longer = _("at most {end}; a longer cycle is told by cycle: {turns} turns").format(end=end, turns=turns + 1)
        never = _("this row is never reached: it is more than a cycle after the first one")
        raise ProblemError(never, path=(*path, row, 0), found=quote(table[row][0]), allowed=longer)
    if angles[-1] - angles[0] < cycle - SAME_PLACE:
        return False
    if abs(values[-1] - values[0]) > SAME_RATIO * max(abs(value) for value in values):
        raise ProblemError(
            _("the table does not close: its cycle ends otherwise than it begins"), path=(*path, len(table) - 1, 1),
            found=quote(table[-1][1]), allowed=_("{first}, as in the first row").format(first=table[0][1]),
        )  # fmt: skip
    return True


def _least(table: Table) -> tuple[int, float]:
    """After which row a table is least between rows, and how little it is there."""
    rows = np.array([float(rounded(row)) for row in table.arguments])
    found = rounded(table(rows[:-1, None] + np.diff(rows)[:, None] * np.linspace(0, 1, 33)))
    row = int(np.argmin(np.min(found, axis=1)))
    return row, float(np.min(found))
