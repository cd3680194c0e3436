"""The law of motion of a crank by a table of its speeds: between rows the square of the speed is interpolated.

The acceleration is half the slope of the square by the angle, so it is finite at rest too; linear squares are a
constant acceleration from row to row.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tmm_cli.double_double import rounded
from tmm_cli.dynamics.curves import Curve, fitted
from tmm_cli.linkage import SpeedTable
from tmm_cli.tolerances import SEAM
from tmm_cli.vectors import Real

STANDS = 1e-9  # of the largest square of the speed: with less somewhere the time of a way is not told


@dataclass(frozen=True)
class LawByTable:
    """Of a crank in its sense; start: its angle at t = 0 (rad); cycle: after which all comes again (rad)."""

    table: SpeedTable
    start: float
    sense: int
    cycle: float

    def speed(self, q: Real) -> Real:
        """rad/s, with its sign; nan where the table does not reach."""
        return self.sense * np.sqrt(np.maximum(self._within(self.table.squares(self._angle(q)), q), 0.0))

    def accelerated(self, q: Real) -> Real:
        """rad/s2, with its sign."""
        given = self.table.accelerations
        if given is not None:
            return self.sense * self._within(given(self._angle(q)), q)
        # in a row where it jumps, that after it
        after = q if self.sense > 0 else q - 4 * SEAM * (1 + np.abs(q))
        return self._within(self.table.squares.slope(self._angle(after)) / 2, q)

    def time(self, q: Real) -> Real:
        """s, since the start; nan where the table has a rest, or does not reach."""
        (laps, inner), (first, begun) = self._passed(rounded(q)), self._passed(rounded(self.start) + np.zeros(1))
        period = float(self._times(np.array([self._length]))[0]) if self.table.squares.closed else float("nan")
        return inner - begun + np.where(laps == first, 0.0, (laps - first) * period)

    def _angle(self, q: Real) -> Real:
        """Within the cycle that begins with the table."""
        first, seam = self.table.squares.arguments[0], SEAM * (1 + np.abs(q))
        found: Real = first + np.maximum(np.mod(q - first + seam, self.cycle) - seam, 0.0)
        return found

    def _within(self, values: Real, q: Real) -> Real:
        """Values where the table reaches."""
        last = self.table.squares.arguments[-1]
        return np.where(self._angle(q) <= last + SEAM * (1 + np.abs(last)), values, np.nan)

    @cached_property
    def _first(self) -> float:
        """The end of the table that the driver comes to first."""
        return float(rounded(self.table.squares.arguments[0 if self.sense > 0 else -1]))

    @cached_property
    def _length(self) -> float:
        arguments = self.table.squares.arguments
        return float(rounded(arguments[-1] - arguments[0]))

    @cached_property
    def _times(self) -> Curve:
        """Time by the way from the first end of the table on, s."""
        squares = self.table.squares
        edges = [self.sense * (float(rounded(row)) - self._first) for row in squares.arguments]

        def pace(x: Real) -> tuple[Real]:
            return (1 / np.sqrt(rounded(squares(self._first + self.sense * x))),)

        rows = np.array([float(rounded(value)) for value in squares.values])
        if np.min(rows) <= STANDS * np.max(rows):
            return Curve(np.array([0.0, self._length]), np.full((1, 1), np.nan))
        return fitted(pace, edges)[0].summed()

    def _passed(self, q: Real) -> tuple[Real, Real]:
        """Whole cycles since the first end of the table, and the time in the one that is under way, s."""
        way = self.sense * (q - self._first)
        laps = np.floor((way + SEAM * (1 + np.abs(way))) / self.cycle)
        rest = way - laps * self.cycle
        inner = np.where(rest <= self._length + SEAM, self._times(np.clip(rest, 0.0, self._length)), np.nan)
        return laps, inner
