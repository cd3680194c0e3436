"""Tabulated functions: linear, stepwise, or a cubic spline; constant before the first and after the last row.

The slopes of the spline follow from continuous second derivatives, which are zero at the ends unless the spline is
periodic (C. de Boor, A Practical Guide to Splines, 2001, ch. 4). The numbers of a table may be float64, longdouble or
double-double, or arrays (variants, 1). Two rows with the same argument are a jump: up to this argument the value of the
first row holds, from the argument on that of the second.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any, Literal

import numpy as np

from tmm_cli.mechanics.numerics.tolerances import SEAM
from tmm_cli.mechanics.numerics.vectors import Real

Between = Literal["linear", "step", "smooth"]
SAMPLES_BETWEEN = 17  # samples between two rows


@dataclass(frozen=True)
class InterpolationTable:
    """A function given by a table, e.g. of a load against the driver angle. Call it with an argument to interpolate.

    Attributes:
        arguments: arguments of the rows, in increasing order; a repeated argument is a jump.
        values: value of each row.
        between: "linear"; "step" (each value holds up to the next row); or "smooth" (cubic spline).
        closed: True if the spline is periodic; its first and last rows then have the same value. If the table has
            jumps,
            the rows between two jumps have a separate spline, and `closed` has no effect.
    """

    arguments: tuple[Any, ...]
    values: tuple[Any, ...]
    between: Between = "linear"
    closed: bool = False

    def __call__(self, argument: Real) -> Real:
        interpolated: Real
        argument = self._as_precise(argument)
        if self.between == "linear" and self._plain and not self.jumps:
            interpolated = np.interp(argument, self.arguments, self.values)
            return interpolated
        from_row, pieces = self._locate_argument(argument)
        interpolated = pieces[0] + from_row * (pieces[1] + from_row * (pieces[2] + from_row * pieces[3]))
        return interpolated

    def slope(self, argument: Real) -> Real:
        """Return the derivative with respect to the argument; at a jump, the derivative after it."""
        from_row, (_, first, second, third) = self._locate_argument(self._as_precise(argument))
        derivative: Real = first + from_row * (2 * second + 3 * from_row * third)
        return derivative

    @property
    def overshoot(self) -> tuple[int, float]:
        """Row (from 0) after which the spline leaves the range of the tabulated values farthest, and by how much it
        does.

        The overshoot is given as a fraction of that range. The result is (0, 0.0) if the table is not a spline.
        """
        if self.between != "smooth":
            return 0, 0.0
        rows, low, span = np.array(self.arguments, float), min(self.values), np.ptp(np.array(self.values, float))
        samples = rows[:-1, None] + np.diff(rows)[:, None] * np.linspace(0, 1, SAMPLES_BETWEEN)
        interpolated = self(samples)
        beyond = np.max(np.maximum(low - interpolated, interpolated - low - span), axis=1)
        row = int(np.argmax(beyond))
        return row, float(beyond[row] / span) if span > 0 else 0.0

    @cached_property
    def jumps(self) -> tuple[int, ...]:
        """Indices (from 0) of the rows that have the same argument as the row before."""
        return tuple(k + 1 for k, (a, b) in enumerate(pairwise(self.arguments)) if np.all(a == b))

    def _as_precise(self, argument: Real) -> Real:
        """Convert the argument to double-doubles if the table contains them.

        This is necessary because NumPy does not recognise double-doubles in a list.
        """
        first = self.arguments[0]
        return argument if isinstance(first, int | float | np.ndarray) else argument + 0 * first

    @property
    def _plain(self) -> bool:
        return not any(isinstance(x, np.ndarray) and x.ndim for x in (*self.arguments, *self.values))

    def _locate_argument(self, argument: Real) -> tuple[Real, tuple[Real, ...]]:
        """Return the distance of each argument from the row before it, and the cubic coefficients that hold there."""
        within = np.minimum(np.maximum(argument, self.arguments[0]), self.arguments[-1])
        # rounding must not move an argument at a row to the piece before it
        at = argument + SEAM * (1 + np.abs(argument))
        ends = self.between == "step" or len(self.arguments) - 1 in self.jumps  # the last value starts at its row
        starts = self.arguments if ends else self.arguments[:-1]
        row, *pieces = (self._value_at_row(at, starts, held) for held in (starts, *zip(*self._pieces, strict=True)))
        return within - row, tuple(pieces)

    def _value_at_row(self, at: Real, starts: Sequence[Any], values: Sequence[Any]) -> Real:
        """Return the tabulated value in the last row at or before each argument. starts: arguments of the rows."""
        latest: Real
        if self._plain:
            twice = [start for start in starts for _ in range(2)][1:]
            latest = np.interp(at, twice, [value for value in values for _ in range(2)][:-1])
            return latest
        latest = values[0] + 0 * at
        for start, (before, after) in zip(starts[1:], pairwise(values), strict=True):
            latest = latest + np.where(at >= start, after - before, 0.0)
        return latest

    @cached_property
    def _pieces(self) -> list[tuple[Any, ...]]:
        """Cubic coefficients of each piece between two rows, in powers of the distance from its first row."""
        if self.between == "step":
            return [(value, 0.0, 0.0, 0.0) for value in self.values]
        borders = [0, *self.jumps, len(self.arguments)]
        pieces: list[tuple[Any, ...]] = []
        for first, last in pairwise(borders):
            pieces += self._make_pieces(self.arguments[first:last], self.values[first:last])
            pieces.append((self.values[last - 1], 0.0, 0.0, 0.0))  # piece of zero length up to the jump
        return pieces if len(self.arguments) - 1 in self.jumps else pieces[:-1]

    def _make_pieces(self, arguments: Sequence[Any], values: Sequence[Any]) -> list[tuple[Any, ...]]:
        """Return the cubic coefficients of the pieces between rows without a jump; empty for a single row."""
        if len(arguments) < 2:
            return []
        steps = [end - start for start, end in pairwise(arguments)]
        rises = [_slope_of_step(end - start, step) for (start, end), step in zip(pairwise(values), steps, strict=True)]
        if self.between == "linear":
            return [(value, rise, 0.0, 0.0) for value, rise in zip(values, rises, strict=False)]
        round_and_round = self.closed and not self.jumps and len(steps) > 2
        slopes = _periodic_spline_slopes(steps, rises) if round_and_round else _natural_spline_slopes(steps, rises)
        return [
            (value, m, (3 * rise - 2 * m - n) / step, (m + n - 2 * rise) / (step * step))
            for value, rise, step, (m, n) in zip(values, rises, steps, pairwise(slopes), strict=False)
        ]


def _slope_of_step(change: Any, step: Any) -> Any:
    """Return the quotient change / step for each variant; zero where the step is 0, because the table jumps there."""
    if not np.any(step == 0):
        return change / step
    return np.where(step == 0, 0.0, change) / np.where(step == 0, 1.0, step)


def _natural_spline_slopes(steps: list[Any], rises: list[Any]) -> list[Any]:
    """Solve for the slopes at the rows of a natural spline (second derivative zero at both ends)."""
    lower, middle, upper, right = _inner_equations(steps, rises)
    return _solve_tridiagonal([*lower, 1.0], [2.0, *middle, 2.0], [1.0, *upper], [3 * rises[0], *right, 3 * rises[-1]])


def _periodic_spline_slopes(steps: list[Any], rises: list[Any]) -> list[Any]:
    """Solve for the slopes at the rows of a periodic spline.

    The inner slopes are linear functions of the slope m of the first and last rows; m follows from the last equation.
    """
    lower, middle, upper, right = _inner_equations(steps, rises)
    fixed = _solve_tridiagonal(lower[1:], middle, upper[:-1], right)
    nothing = [0.0] * (len(right) - 2)
    by_last = _solve_tridiagonal(lower[1:], middle, upper[:-1], [-lower[0], *nothing, -upper[-1]])
    first, last = steps[0], steps[-1]
    right_side = 3 * (rises[-1] / last + rises[0] / first) - fixed[0] / first - fixed[-1] / last
    m = right_side / (2 / first + 2 / last + by_last[0] / first + by_last[-1] / last)
    return [m, *(constant + m * factor for constant, factor in zip(fixed, by_last, strict=True)), m]


def _inner_equations(steps: list[Any], rises: list[Any]) -> tuple[list[Any], list[Any], list[Any], list[Any]]:
    """Return the equations of continuous second derivatives at the inner rows of a spline.

    Returns:
        Coefficients of the slopes at the previous, the same and the next row, and the right-hand sides.
    """
    both = list(zip(pairwise(steps), pairwise(rises), strict=True))
    return (
        [1 / a for (a, __), __ in both],
        [2 / a + 2 / b for (a, b), __ in both],
        [1 / b for (__, b), __ in both],
        [3 * (c / a + d / b) for (a, b), (c, d) in both],
    )


def _solve_tridiagonal(lower: list[Any], middle: list[Any], upper: list[Any], right: list[Any]) -> list[Any]:
    """Solve a diagonally dominant tridiagonal system."""
    kept = [(middle[0], right[0])]
    for below, diagonal, above, value in zip(lower, middle[1:], upper, right[1:], strict=True):
        pivot, before = kept[-1]
        kept.append((diagonal - below / pivot * above, value - below / pivot * before))
    solution = [kept[-1][1] / kept[-1][0]]
    for above, (pivot, value) in zip(reversed(upper), reversed(kept[:-1]), strict=True):
        solution.append((value - above * solution[-1]) / pivot)
    return solution[::-1]
