"""Small systems of linear equations, one a position: solved all at once, in any precision, never an exception."""

from __future__ import annotations

import numpy as np

from tmm_cli.tolerances import TRUNCATED
from tmm_cli.vectors import Real


def solve(matrix: Real, right: Real) -> Real:
    """x of matrix x = right for matrices (..., m, n) and right sides (..., m); nan where a matrix is singular.

    With more equations than unknowns, or fewer, the least squares solution of least size.
    """
    rows, columns = matrix.shape[-2:]
    if rows != columns:
        return _least_squares(matrix, right)
    kind = np.result_type(matrix, right)
    if kind != np.float64:
        return _eliminate(matrix.astype(kind), right)
    try:
        found: Real = np.linalg.solve(matrix, right[..., None])[..., 0]
        return found
    except np.linalg.LinAlgError:
        singular = np.linalg.det(matrix) == 0
        sound = np.where(singular[..., None, None], np.eye(rows), matrix)
        return np.where(singular[..., None], np.nan, np.linalg.solve(sound, right[..., None])[..., 0])


def _least_squares(matrix: Real, right: Real) -> Real:
    sound = np.all(np.isfinite(matrix), axis=(-1, -2))
    clean = np.where(sound[..., None, None], matrix, 0.0)
    inverse = np.linalg.pinv(clean.astype(np.float64), rcond=TRUNCATED)
    found = np.einsum("...ij,...j->...i", inverse, right)
    rest = right - np.einsum("...ij,...j->...i", clean, found)
    found = found + np.einsum("...ij,...j->...i", inverse, rest)  # an inverse rounds more than a solution does
    return np.where(sound[..., None], found, np.nan)


def _eliminate(matrix: Real, right: Real) -> Real:
    """Gauss with row pivots, over all positions at once: for precisions that LAPACK does not know."""
    n = matrix.shape[-1]
    work = np.concatenate([matrix, right[..., None]], axis=-1)
    flat = work.reshape(-1, n, n + 1)
    each = np.arange(len(flat))
    for k in range(n):
        pivot = k + np.argmax(np.abs(flat[:, k:, k]), axis=1)
        rows = flat[each, pivot].copy()
        flat[each, pivot] = flat[:, k]
        flat[:, k] = rows
        with np.errstate(divide="ignore", invalid="ignore"):
            factor = flat[:, k + 1 :, k] / flat[:, k, k][:, None]
            flat[:, k + 1 :] -= factor[:, :, None] * flat[:, None, k]
    found = np.zeros((len(flat), n), dtype=matrix.dtype)
    for k in range(n - 1, -1, -1):
        rest = flat[:, k, n] - np.sum(flat[:, k, k + 1 : n] * found[:, k + 1 :], axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            found[:, k] = rest / flat[:, k, k]
    found = np.where(np.isfinite(found), found, np.nan)
    return found.reshape(matrix.shape[:-1])


def least_over_largest(matrix: Real) -> Real:
    """Least singular value over the largest, nan where the matrix is not finite."""
    sound = np.all(np.isfinite(matrix), axis=(-1, -2))
    clean = np.where(sound[..., None, None], matrix, 0.0).astype(np.float64)
    values = np.linalg.svd(clean, compute_uv=False)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(sound, values[..., -1] / values[..., 0], np.nan)


def signed_determinant(matrix: Real) -> Real:
    """Sign of the determinant; 1 where there are more equations than unknowns."""
    if matrix.shape[-1] != matrix.shape[-2]:
        return np.ones(matrix.shape[:-2])
    sign: Real = np.linalg.slogdet(matrix.astype(np.float64))[0]
    return sign
