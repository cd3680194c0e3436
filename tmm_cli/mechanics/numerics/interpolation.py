"""A function by a table: linear between its rows, in steps, or a cubic spline; constant beyond the first and the last.

The spline's slopes follow from continuous second derivatives; at its ends these are zero, or it closes on itself. C. de
Boor, A Practical Guide to Splines (2001), ch. 4. Numbers may be of any precision, or arrays (variants, 1).

Two rows with the same argument are a jump: the value of the first holds up to it, that of the second from it on.
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
SAMPLES_BETWEEN = 17  # places between two rows


@dataclass(frozen=True)
class InterpolationTable:
    """Rows by growing arguments. step: each row's value holds up to the next row; smooth: a cubic spline.

    closed: the spline goes on from its last row to its first, which has the same value. With jumps it does not: the
    rows between two of them have a spline of their own.
    """

    arguments: tuple[Any, ...]
    values: tuple[Any, ...]
    between: Between = "linear"
    closed: bool = False

    def __call__(self, argument: Real) -> Real:
        found: Real
        argument = self._as_precise(argument)
        if self.between == "linear" and self._plain and not self.jumps:
            found = np.interp(argument, self.arguments, self.values)
            return found
        from_row, pieces = self._from_row(argument)
        found = pieces[0] + from_row * (pieces[1] + from_row * (pieces[2] + from_row * pieces[3]))
        return found

    def slope(self, argument: Real) -> Real:
        """Its derivative; in a row where it jumps, that after it, and none of a jump itself."""
        from_row, (_, first, second, third) = self._from_row(self._as_precise(argument))
        found: Real = first + from_row * (2 * second + 3 * from_row * third)
        return found

    @property
    def overshoot(self) -> tuple[int, float]:
        """After which row (from 0) a smooth curve goes farthest beyond the values of all rows, and by what share of
        their range."""
        if self.between != "smooth":
            return 0, 0.0
        rows, low, span = np.array(self.arguments, float), min(self.values), np.ptp(np.array(self.values, float))
        places = rows[:-1, None] + np.diff(rows)[:, None] * np.linspace(0, 1, SAMPLES_BETWEEN)
        found = self(places)
        beyond = np.max(np.maximum(low - found, found - low - span), axis=1)
        row = int(np.argmax(beyond))
        return row, float(beyond[row] / span) if span > 0 else 0.0

    @cached_property
    def jumps(self) -> tuple[int, ...]:
        """Rows (from 0) with the argument of the row before them."""
        return tuple(k + 1 for k, (a, b) in enumerate(pairwise(self.arguments)) if np.all(a == b))

    def _as_precise(self, argument: Real) -> Real:
        """The argument in the precision of the rows: NumPy finds no double-doubles in a list of them."""
        first = self.arguments[0]
        return argument if isinstance(first, int | float | np.ndarray) else argument + 0 * first

    @property
    def _plain(self) -> bool:
        return not any(isinstance(x, np.ndarray) and x.ndim for x in (*self.arguments, *self.values))

    def _from_row(self, argument: Real) -> tuple[Real, tuple[Real, ...]]:
        """How far each argument is from the row before it, and the coefficients of its piece by powers of that."""
        within = np.minimum(np.maximum(argument, self.arguments[0]), self.arguments[-1])
        # rounding does not take an argument in a row to the piece before it
        at = argument + SEAM * (1 + np.abs(argument))
        ends = self.between == "step" or len(self.arguments) - 1 in self.jumps  # the last value begins in its row
        starts = self.arguments if ends else self.arguments[:-1]
        row, *pieces = (self._held(at, starts, held) for held in (starts, *zip(*self._pieces, strict=True)))
        return within - row, tuple(pieces)

    def _held(self, at: Real, starts: Sequence[Any], values: Sequence[Any]) -> Real:
        """The value of the last start before each place."""
        found: Real
        if self._plain:
            twice = [start for start in starts for _ in range(2)][1:]
            found = np.interp(at, twice, [value for value in values for _ in range(2)][:-1])
            return found
        found = values[0] + 0 * at
        for start, (before, after) in zip(starts[1:], pairwise(values), strict=True):
            found = found + np.where(at >= start, after - before, 0.0)
        return found

    @cached_property
    def _pieces(self) -> list[tuple[Any, ...]]:
        """Coefficients of each piece by powers of the way from its row."""
        if self.between == "step":
            return [(value, 0.0, 0.0, 0.0) for value in self.values]
        borders = [0, *self.jumps, len(self.arguments)]
        found: list[tuple[Any, ...]] = []
        for first, last in pairwise(borders):
            found += self._smooth_or_linear(self.arguments[first:last], self.values[first:last])
            found.append((self.values[last - 1], 0.0, 0.0, 0.0))  # up to the jump, over no distance
        return found if len(self.arguments) - 1 in self.jumps else found[:-1]

    def _smooth_or_linear(self, arguments: Sequence[Any], values: Sequence[Any]) -> list[tuple[Any, ...]]:
        """Coefficients of the pieces between rows without a jump; none of one row."""
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
    """Change over a step, for each variant; none where a variant has a jump there."""
    if not np.any(step == 0):
        return change / step
    return np.where(step == 0, 0.0, change) / np.where(step == 0, 1.0, step)


def _natural_spline_slopes(steps: list[Any], rises: list[Any]) -> list[Any]:
    """Slopes in the rows of a spline whose second derivative is zero at both ends."""
    lower, middle, upper, right = _inner_equations(steps, rises)
    return _solve_tridiagonal([*lower, 1.0], [2.0, *middle, 2.0], [1.0, *upper], [3 * rises[0], *right, 3 * rises[-1]])


def _periodic_spline_slopes(steps: list[Any], rises: list[Any]) -> list[Any]:
    """Slopes in the rows of a spline that goes on from its last row to its first.

    The slope m of that row is what fits: all others follow from it, linearly.
    """
    lower, middle, upper, right = _inner_equations(steps, rises)
    fixed = _solve_tridiagonal(lower[1:], middle, upper[:-1], right)
    nothing = [0.0] * (len(right) - 2)
    by_last = _solve_tridiagonal(lower[1:], middle, upper[:-1], [-lower[0], *nothing, -upper[-1]])
    first, last = steps[0], steps[-1]
    wanted = 3 * (rises[-1] / last + rises[0] / first) - fixed[0] / first - fixed[-1] / last
    m = wanted / (2 / first + 2 / last + by_last[0] / first + by_last[-1] / last)
    return [m, *(one + m * other for one, other in zip(fixed, by_last, strict=True)), m]


def _inner_equations(steps: list[Any], rises: list[Any]) -> tuple[list[Any], list[Any], list[Any], list[Any]]:
    """Rows of the equations for slopes between the ends: factors of the slope before, of the own and of the next."""
    both = list(zip(pairwise(steps), pairwise(rises), strict=True))
    return (
        [1 / a for (a, __), __ in both],
        [2 / a + 2 / b for (a, b), __ in both],
        [1 / b for (__, b), __ in both],
        [3 * (c / a + d / b) for (a, b), (c, d) in both],
    )


def _solve_tridiagonal(lower: list[Any], middle: list[Any], upper: list[Any], right: list[Any]) -> list[Any]:
    """A system of three diagonals, of which the middle one is the largest."""
    kept = [(middle[0], right[0])]
    for below, own, above, value in zip(lower, middle[1:], upper, right[1:], strict=True):
        pivot, before = kept[-1]
        kept.append((own - below / pivot * above, value - below / pivot * before))
    found = [kept[-1][1] / kept[-1][0]]
    for above, (pivot, value) in zip(reversed(upper), reversed(kept[:-1]), strict=True):
        found.append((value - above * found[-1]) / pivot)
    return found[::-1]
