"""Small systems of linear equations, one a position: solved all at once, of double-doubles too, never an exception."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from tmm_cli.double_double import exactly, rounded
from tmm_cli.tolerances import TRUNCATED
from tmm_cli.vectors import Real

ROUNDS = 5  # each gives as many digits more as float64 has beyond those that the matrix loses


def solve(matrix: Real, right: Real) -> Real:
    """x of matrix x = right for matrices (..., m, n) and right sides (..., m); nan where a matrix is singular.

    With more equations than unknowns, or fewer, the least squares solution of least size.
    """
    if not (isinstance(matrix, np.ndarray) and isinstance(right, np.ndarray)):
        return _refined(matrix, right)
    rows, columns = matrix.shape[-2:]
    if rows != columns:
        return _least_squares(matrix, right)
    try:
        return np.linalg.solve(matrix, right[..., None])[..., 0]
    except np.linalg.LinAlgError:
        singular = np.linalg.det(matrix) == 0
        sound = np.where(singular[..., None, None], np.eye(rows), matrix)
        return np.where(singular[..., None], np.nan, np.linalg.solve(sound, right[..., None])[..., 0])


def _refined(matrix: Real, right: Real) -> Real:
    """Of double-doubles: what the solution in float64 leaves is solved for, again and again."""
    near = rounded(matrix)
    found: Real = exactly(solve(near, rounded(right)))
    for _ in range(ROUNDS):
        rest = right - np.sum(matrix * found[..., None, :], axis=-1)
        found = found + solve(near, rounded(rest))
    return found


def _least_squares(matrix: Real, right: Real) -> Real:
    sound = np.all(np.isfinite(matrix), axis=(-1, -2))
    clean = np.where(sound[..., None, None], matrix, 0.0)
    inverse = np.linalg.pinv(clean, rcond=TRUNCATED)
    found = np.einsum("...ij,...j->...i", inverse, right)
    rest = right - np.einsum("...ij,...j->...i", clean, found)
    found = found + np.einsum("...ij,...j->...i", inverse, rest)  # an inverse rounds more than a solution does
    return np.where(sound[..., None], found, np.nan)


def least_over_largest(matrix: Real) -> Real:
    """Least singular value over the largest, nan where the matrix is not finite."""
    sound = np.all(np.isfinite(matrix), axis=(-1, -2))
    clean = np.where(sound[..., None, None], rounded(matrix), 0.0)
    values = np.linalg.svd(clean, compute_uv=False)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(sound, values[..., -1] / values[..., 0], np.nan)


def signed_determinant(matrix: Real) -> Real:
    """Sign of the determinant; 1 where there are more equations than unknowns."""
    if matrix.shape[-1] != matrix.shape[-2]:
        return np.ones(matrix.shape[:-2])
    sign: Real = np.linalg.slogdet(rounded(matrix))[0]
    return sign


def margin_of(rows: Sequence[Mapping[int, Any]], lengths: Sequence[bool], size: Any) -> Any:
    """Least singular value over the largest of as many rows {unknown: coefficient} as there are unknowns.

    Without dimension: lengths tells which rows are in metres; of three unknowns two are. On a tape it is one operation.
    """
    scale = [1 / size if length else 1.0 for length in lengths]
    columns = [1.0 if k % 3 == 2 else size for k in range(len(rows))]
    entries = [
        row[k] * (down * across) if k in row else 0.0
        for row, down in zip(rows, scale, strict=True) for k, across in enumerate(columns)
    ]  # fmt: skip
    stand = next((entry for entry in entries if hasattr(entry, "called")), None)
    return _margin(*entries) if stand is None else stand.called(_margin, *entries)


def _margin(*entries: Any) -> Real:
    many = math.isqrt(len(entries))
    together = np.stack(np.broadcast_arrays(*entries), axis=-1)
    return least_over_largest(together.reshape(*together.shape[:-1], many, many))
