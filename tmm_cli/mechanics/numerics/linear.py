"""Small linear systems, one for each position, solved together, also in double-doubles. Singular systems give nan."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tmm_cli.mechanics.numerics.double_double import to_double_double, to_float
from tmm_cli.mechanics.numerics.dual import Dual, split_dual
from tmm_cli.mechanics.numerics.tolerances import TRUNCATED
from tmm_cli.mechanics.numerics.vectors import Real

REFINEMENTS = 5  # each adds the digits of float64 less those that the matrix loses


def solve(matrix: Real, right: Real) -> Real:
    """Solve the linear systems matrix x = right; nan where a square matrix is singular. Never raises an exception.

    Args:
        matrix: shape (..., m, n). If m != n, the least-squares solution of smallest norm is returned.
        right: right-hand sides, shape (..., m).

    Returns:
        The solutions x, shape (..., n).
    """
    if isinstance(matrix, Dual) or isinstance(right, Dual):
        (values, slopes), (right_values, right_slopes) = split_dual(matrix), split_dual(right)
        solution = solve(values, right_values)
        return Dual(solution, solve(values, right_slopes - np.sum(slopes * solution[..., None, :], axis=-1)))
    if not (isinstance(matrix, np.ndarray) and isinstance(right, np.ndarray)):
        return _solve_refined(matrix, right)
    rows, columns = matrix.shape[-2:]
    if rows != columns:
        return _least_squares(matrix, right)
    try:
        return np.linalg.solve(matrix, right[..., None])[..., 0]
    except np.linalg.LinAlgError:
        singular = np.linalg.det(matrix) == 0
        sound = np.where(singular[..., None, None], np.eye(rows), matrix)
        return np.where(singular[..., None], np.nan, np.linalg.solve(sound, right[..., None])[..., 0])


def _solve_refined(matrix: Real, right: Real) -> Real:
    """Solve in double-doubles, by iterative refinement of the float64 solution."""
    near = to_float(matrix)
    solution: Real = to_double_double(solve(near, to_float(right)))
    for _ in range(REFINEMENTS):
        rest = right - np.sum(matrix * solution[..., None, :], axis=-1)
        solution = solution + solve(near, to_float(rest))
    return solution


def _least_squares(matrix: Real, right: Real) -> Real:
    sound = np.all(np.isfinite(matrix), axis=(-1, -2))
    clean = np.where(sound[..., None, None], matrix, 0.0)
    inverse = np.linalg.pinv(clean, rcond=TRUNCATED)
    solution = np.einsum("...ij,...j->...i", inverse, right)
    rest = right - np.einsum("...ij,...j->...i", clean, solution)
    solution = solution + np.einsum(
        "...ij,...j->...i", inverse, rest
    )  # one refinement, as an inverse is less accurate than a solution
    return np.where(sound[..., None], solution, np.nan)


def singular_value_ratio(matrix: Real) -> Real:
    """Return the smallest singular value divided by the largest; nan where the matrix is not finite."""
    sound = np.all(np.isfinite(matrix), axis=(-1, -2))
    clean = np.where(sound[..., None, None], to_float(matrix), 0.0)
    values = np.linalg.svd(clean, compute_uv=False)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(sound, values[..., -1] / values[..., 0], np.nan)


def determinant_sign(matrix: Real) -> Real:
    """Return the sign of the determinant of each matrix; 1 for matrices that are not square."""
    if matrix.shape[-1] != matrix.shape[-2]:
        return np.ones(matrix.shape[:-2])
    sign: Real = np.linalg.slogdet(to_float(matrix))[0]
    return sign


def singular_margin(rows: Sequence[Mapping[int, Any]], lengths: Sequence[bool], size: Any) -> Any:
    """Return the ratio of the smallest to the largest singular value of a square system in dimensionless form.

    If operations are being traced, the whole calculation is recorded as one operation.

    Args:
        rows: coefficients {unknown: coefficient}, as many rows as unknowns; the unknowns are x, y and angle of each
            link.
        lengths: for each row, True if the equation is in metres.
        size: length (m) by which lengths are divided.
    """
    scale = [1 / size if length else 1.0 for length in lengths]
    columns = [1.0 if k % 3 == 2 else size for k in range(len(rows))]
    entries = [
        row[k] * (down * across) if k in row else 0.0
        for row, down in zip(rows, scale, strict=True)
        for k, across in enumerate(columns)
    ]
    stand = next((entry for entry in entries if hasattr(entry, "called")), None)
    return _margin(*entries) if stand is None else stand.called(_margin, *entries)


def _margin(*entries: Any) -> Real:
    many = math.isqrt(len(entries))
    together = np.stack(np.broadcast_arrays(*entries), axis=-1)
    return singular_value_ratio(together.reshape(*together.shape[:-1], many, many))


# Linear equations whose coefficients are separate arrays, eliminated in an order chosen beforehand.
#
# A matrix is a list of rows, {column: coefficient}; missing coefficients are zero. Some unknowns are explicit: in turn,
# each follows from a row of its own, with a constant coefficient, from the explicit ones before it and from the free
# ones. The remaining equations of the free unknowns are made triangular by rotations of two rows at a time (W. Givens,
# 1958), which need no search for pivots, are few where columns are sparse, and are stable wherever the equations are
# regular.


EquationRow = Mapping[int, Any]


@dataclass(frozen=True)
class EliminationOrder:
    """Order in which the unknowns of a linear system are eliminated.

    Attributes:
        explicit: pairs (row, column), in turn: the row gives this unknown explicitly.
        closing: the remaining rows.
        free: the remaining columns; their unknowns are solved for simultaneously from the closing rows.
    """

    explicit: tuple[tuple[int, int], ...]
    closing: tuple[int, ...]
    free: tuple[int, ...]


class EliminatedSystem:
    """A linear system reduced to triangular form, to be solved for several right-hand sides.

    It can be solved with its matrix or with the transposed matrix.

    Attributes:
        scales: factors of the rows, and units of the columns. None unless the free unknowns include both lengths and
            angles.
    """

    def __init__(
        self, rows: Sequence[EquationRow], order: EliminationOrder, scales: tuple[Sequence[Any], Sequence[Any]] | None
    ) -> None:
        self.rows, self.order, self.scales = rows, order, scales
        self.following: dict[
            int, dict[int, Any]
        ] = {}  # derivatives of each explicit unknown with respect to the free ones
        for row, column in order.explicit:
            self.following[column] = {
                k: -value / rows[row][column] for k, value in self._express_by_free(row, skip=column).items()
            }
        self._make_triangular([self._express_by_free(row) for row in order.closing])

    def _express_by_free(self, row: int, skip: int = -1) -> dict[int, Any]:
        """Return the coefficients of a row after its explicit unknowns have been expressed by the free ones."""
        coefficients: dict[int, Any] = {}
        for column, value in self.rows[row].items():
            if column in self.following:
                for k, by in self.following[column].items():
                    coefficients[k] = coefficients[k] + value * by if k in coefficients else value * by
            elif column != skip:
                coefficients[column] = coefficients[column] + value if column in coefficients else value
        return coefficients

    def _make_triangular(self, left: list[dict[int, Any]]) -> None:
        if self.scales is not None:
            down, across = self.scales
            left = [
                {k: value * (down[row] * across[k]) for k, value in row_left.items()}
                for row, row_left in zip(self.order.closing, left, strict=True)
            ]
        self.left = left
        self.turns: list[tuple[int, int, Any, Any]] = []  # two rows, and cosine and sine of their rotation
        self.pivots: list[tuple[int, int]] = []
        rows, columns = list(range(len(left))), list(self.order.free)
        while columns:
            column = min(columns, key=lambda k: sum(k in left[row] for row in rows))
            top, *others = [row for row in rows if column in left[row]]
            for row in others:
                a, b = left[top][column], left[row][column]
                length = np.sqrt(a * a + b * b)
                c, s = a / length, b / length
                self.turns.append((top, row, c, s))
                row_left, other = left[top], left[row]
                both = list(dict.fromkeys([*row_left, *other]))
                left[top] = {k: _combine(c, row_left.get(k), s, other.get(k)) for k in both} | {column: length}
                left[row] = {k: _combine(-s, row_left.get(k), c, other.get(k)) for k in both if k != column}
            self.pivots.append((top, column))
            rows.remove(top)
            columns.remove(column)

    @property
    def diagonal(self) -> list[Any]:
        """Diagonal of the triangular matrix. The product of its elements is the determinant up to a constant factor."""
        return [self.left[row][column] for row, column in self.pivots]

    def solve(self, right: Sequence[Any]) -> list[Any]:
        """Solve matrix x = right for x."""
        solution: dict[int, Any] = {}
        for row, column in self.order.explicit:
            solution[column] = self._subtract_solved(row, right[row], solution, column) / self.rows[row][column]
        free = self.free([self._subtract_solved(row, right[row], solution) for row in self.order.closing])
        for _, column in self.order.explicit:
            solution[column] = sum((by * free[k] for k, by in self.following[column].items()), solution[column])
        solution |= free
        return [solution[k] for k in range(len(solution))]

    def _subtract_solved(self, row: int, right: Any, solved: Mapping[int, Any], skip: int = -1) -> Any:
        for column, value in self.rows[row].items():
            if column in solved and column != skip:
                right = right - value * solved[column]
        return right

    def free(self, right: Sequence[Any]) -> dict[int, Any]:
        """Solve the closing rows for the free unknowns, with zero right-hand sides in the explicit rows.

        Args:
            right: right-hand sides of the closing rows.
        """
        down, across = self.scales or ((), ())
        turned = list(right)
        if self.scales is not None:
            turned = [value * down[row] for row, value in zip(self.order.closing, turned, strict=True)]
        for top, row, c, s in self.turns:
            a, b = turned[top], turned[row]
            turned[top], turned[row] = c * a + s * b, c * b - s * a
        solution: dict[int, Any] = {}
        for row, column in reversed(self.pivots):
            value = turned[row]
            for k, coefficient in self.left[row].items():
                if k != column:
                    value = value - coefficient * solution[k]
            solution[column] = value / self.left[row][column]
        return solution if self.scales is None else {k: value * across[k] for k, value in solution.items()}

    def transposed(self, right: Sequence[Any]) -> list[Any]:
        """Solve y matrix = right for y."""
        down, across = self.scales or ((), ())
        whole = {k: right[k] for k in self.order.free}
        for _, column in self.order.explicit:
            for k, by in self.following[column].items():
                whole[k] = whole[k] + by * right[column]
        if self.scales is not None:
            whole = {k: value * across[k] for k, value in whole.items()}
        turned: list[Any] = [0.0] * len(self.left)
        for row, column in self.pivots:
            turned[row] = whole[column] / self.left[row][column]
            for k, coefficient in self.left[row].items():
                if k != column:
                    whole[k] = whole[k] - coefficient * turned[row]
        for top, row, c, s in reversed(self.turns):
            a, b = turned[top], turned[row]
            turned[top], turned[row] = c * a - s * b, s * a + c * b
        multipliers = dict(zip(self.order.closing, turned, strict=True))
        if self.scales is not None:
            multipliers = {row: value * down[row] for row, value in multipliers.items()}
        for row, column in reversed(self.order.explicit):
            value = right[column]
            for other, multiplier in multipliers.items():
                if column in self.rows[other]:
                    value = value - self.rows[other][column] * multiplier
            multipliers[row] = value / self.rows[row][column]
        return [multipliers[k] for k in range(len(multipliers))]


def _combine(c: Any, a: Any, s: Any, b: Any) -> Any:
    """Return c a + s b, where None stands for zero."""
    if a is None:
        return s * b
    return c * a if b is None else c * a + s * b
