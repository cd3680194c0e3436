"""Freudenstein's equation for pairs of the input angle phi (of AB) and the output angle psi (of DC), measured from
AD.

    p cos(psi) - q cos(phi) + s = cos(phi - psi),   p = l4/l1, q = l4/l3, s = (l1^2 + l3^2 + l4^2 - l2^2)/(2 l1 l3)

Source: F. Freudenstein, An analytical approach to the design of four-link mechanisms, Trans. ASME 76 (1954).

A negative p or q means that the link points in the opposite direction: its zero angle is then greater by 180 degrees.
The given angles may be measured from unknown zero angles phi0 and psi0. Four pairs determine one zero angle: the
determinant of the four equations is a quadratic form in its cosine and sine. Five pairs determine both: with delta =
phi0 - psi0 the condition is a cubic form in cos(delta) and sin(delta). In arrays the first axis counts the tasks and
the last axis the pairs of angles.
"""

from __future__ import annotations

import math
from typing import Any, Final, NamedTuple

import numpy as np

from tmm_cli.mechanics.numerics import PI, DoubleDouble, unit

EXACT: Final = np.longdouble
NEWTON_STEPS: Final = 4
SINGULAR: Final = 1e-15  # relative to the largest singular value: rounding
REFINEMENTS: Final = 6
ENDLESS: Final = 1e-6  # l1/l4 below which a length is rounding
REAL: Final = 5e-7  # rad: a root this close to a real angle is real


class FourBarRatios(NamedTuple):
    """Four-bars with lengths relative to the frame l4; arrays of one shape.

    Attributes:
        l1, l2, l3: lengths divided by l4, positive.
        phi0, psi0: zero angles of the input and the output link, measured from AD (rad).
    """

    l1: Any
    l2: Any
    l3: Any
    phi0: Any
    psi0: Any

    def at(self, index: Any) -> FourBarRatios:
        """Return the four-bars with an index of the arrays."""
        return FourBarRatios(*(np.asarray(value)[index] for value in self))

    @property
    def size(self) -> int:
        """Number of four-bars."""
        return int(np.size(self.l1))

    def pins(self, phi: Any, psi: Any) -> tuple[Any, Any]:
        """Return the hinges B and C (complex, divided by l4) for angles measured from the zero angles; A is 0 and D is
        1.
        """
        return self.l1 * unit(self.phi0 + phi), 1 + self.l3 * unit(self.psi0 + psi)


def pseudo_inverse(rows: Any) -> Any:
    """Return the pseudo-inverses of matrices in double precision, to be used in iterative refinement.

    With more rows than columns they give the least-squares solution, with fewer rows the solution of least norm. Pairs
    of angles that are close together give nearly equal rows. A matrix counts as singular only if the ratio of its
    smallest to its largest singular value is within rounding error.

    Args:
        rows: matrices, shape (..., n, m).

    Returns:
        Pseudo-inverses, shape (..., m, n); nan for singular matrices.
    """
    near = np.asarray(rows, dtype=float)
    finite = np.isfinite(near).all((-1, -2), keepdims=True)
    left, sizes, right = np.linalg.svd(np.where(finite, near, 0.0), full_matrices=False)
    sound = finite[..., 0] & (sizes[..., -1:] > SINGULAR * sizes[..., :1])
    back = np.where(sound, 1 / np.where(sound, sizes, 1.0), np.nan)
    return np.einsum("...ki,...k,...jk->...ij", right, back, left)


def solve_linear(rows: Any, right: Any) -> Any:
    """Solve linear systems with iterative refinement in extended precision.

    Args:
        rows: matrices, shape (..., n, m).
        right: right-hand sides, shape (..., n).

    Returns:
        Solutions, shape (..., m); nan if the matrix is singular.
    """
    back = pseudo_inverse(rows)
    unknowns = np.zeros((*np.shape(rows)[:-2], np.shape(rows)[-1]), dtype=EXACT)
    for _ in range(REFINEMENTS):
        rest = np.asarray(right - (rows * unknowns[..., None, :]).sum(-1), dtype=float)
        unknowns = unknowns + (back * rest[..., None, :]).sum(-1)
    return unknowns


def solve_homogeneous(rows: Any) -> Any:
    """Return two vectors that span the null space of each matrix, computed in extended precision.

    Args:
        rows: matrices, shape (..., m - 2, m).

    Returns:
        Vectors as columns, shape (..., m, 2).
    """
    near, back = np.asarray(rows, dtype=float), pseudo_inverse(rows)
    near = np.where(np.isfinite(near), near, 0.0)
    vectors = np.swapaxes(np.linalg.svd(near)[2][..., -2:, :], -1, -2).astype(EXACT)
    for _ in range(REFINEMENTS):
        rest = np.asarray((rows[..., None] * vectors[..., None, :, :]).sum(-2), dtype=float)
        vectors = vectors - np.matmul(back, rest)
    return vectors


def solve_pqs(phi: Any, psi: Any) -> Any:
    """Return p, q, s of Freudenstein's equation, shape (tasks, 3).

    Args:
        phi, psi: three or more pairs of angles (rad), measured from AD, shape (tasks, pairs).
    """
    return solve_linear(_equation_rows(phi, psi), np.cos(phi - psi))


def solve_two_pairs(phi: Any, psi: Any, coefficients: Any, value: Any) -> Any:
    """Return p, q, s of Freudenstein's equation, shape (tasks, 3), from two pairs of angles and a linear condition.

    Args:
        phi, psi: angles (rad), measured from AD, shape (tasks, 2).
        coefficients, value: condition coefficients . (p, q, s) = value, shapes (tasks, 3) and (tasks,).
    """
    rows = np.concatenate([_equation_rows(phi, psi), np.asarray(coefficients, dtype=EXACT)[..., None, :]], axis=-2)
    right = np.concatenate([np.cos(phi - psi), np.asarray(value, dtype=EXACT)[..., None]], axis=-1)
    return solve_linear(rows, right)


def zero_angles_of_four(phi: Any, psi: Any, free: str) -> tuple[Any, Any]:
    """Return the zero angles phi0 and psi0 that four pairs of angles allow (rad), two solutions per task, shape (tasks,
    2).

    Solutions that differ by 180 degrees are the same four-bar. Complex solutions are nan.

    Args:
        phi, psi: angles (rad), shape (tasks, 4).
        free: the unknown zero angle, "phi0" or "psi0"; the other one is already contained in the angles and returned as
            0.
    """

    turn = phi - psi
    angle, sign = (phi, -1) if free == "phi0" else (psi, 1)
    still = np.cos(psi if free == "phi0" else phi)
    over_cos, over_sin = (
        (np.cos(angle), np.cos(turn)),
        (-np.sin(angle), sign * np.sin(turn)),
    )  # columns that depend on the zero angle

    def form(cosines: Any, sines: Any) -> Any:  # the column of ones reduces the determinant to row differences
        (a, b, c), (d, e, f), (g, h, i) = (np.moveaxis(x[..., 1:] - x[..., :1], -1, 0) for x in (still, cosines, sines))
        return a * (e * i - f * h) + b * (f * g - d * i) + c * (d * h - e * g)

    a, c = form(*over_cos), form(*over_sin)
    b = form(over_cos[0], over_sin[1]) + form(over_sin[0], over_cos[1])
    with np.errstate(all="ignore"):
        root = np.sqrt(b * b - 4 * a * c)
        big = -(b + np.where(b < 0, -root, root)) / 2
        angles = np.stack([np.arctan2(big, c), np.arctan2(a, big)], axis=-1)  # of a cos^2 + b cos sin + c sin^2
    zero = np.zeros_like(angles)
    return (angles, zero) if free == "phi0" else (zero, angles)


def zero_angles_of_five(phi: Any, psi: Any) -> tuple[Any, Any]:
    """Return the zero angles phi0 and psi0 that five pairs of angles allow (rad), three solutions per task, shape
    (tasks, 3).

    The equations are homogeneous in p e^(-i psi0), -q e^(-i phi0), s and e^(i delta), up to a common factor, and two
    vectors span their solutions. The arguments of the three complex numbers must be consistent, which gives a cubic
    form. Complex solutions are nan.

    Args:
        phi, psi: angles (rad), shape (tasks, 5).
    """
    columns = (np.cos(psi), np.sin(psi), np.cos(phi), np.sin(phi), np.ones_like(phi), -np.cos(phi - psi))
    span = solve_homogeneous(np.stack([*columns, np.sin(phi - psi)], axis=-1))
    a, b, turn = (span[:, k] + 1j * span[:, k + 1] for k in (0, 2, 5))  # (tasks, 2) over both vectors
    (b0, b1), (a0, a1), (t0, t1) = b.T, a.conj().T, turn.T
    form = [b1 * a1 * t1, b0 * a1 * t1 + b1 * a0 * t1 + b1 * a1 * t0, b0 * a0 * t1 + b0 * a1 * t0 + b1 * a0 * t0]
    angles = roots_of_cubic_forms(np.stack([*form, b0 * a0 * t0], axis=-1).imag)
    with np.errstate(all="ignore"):
        cosines, sines = np.cos(angles), np.sin(angles)
        side, delta = (x[:, :1] * cosines + x[:, 1:] * sines for x in (a, turn))
        endless = np.abs(delta) <= ENDLESS * np.abs(side)  # l1 vanishes relative to the frame
        psi0 = np.where(endless, np.nan, -np.angle(side))
        return psi0 + np.angle(delta), psi0


def roots_of_cubic_forms(forms: Any) -> Any:
    """Return the angles (rad) at which f0 s^3 + f1 s^2 c + f2 s c^2 + f3 c^3 = 0, where s and c are sine and cosine.

    The form is a cubic polynomial in the tangent. Roots that are close together have only half of the correct digits;
    `refine_by_newton` makes them accurate.

    Args:
        forms: coefficients f0 to f3, shape (tasks, 4).

    Returns:
        Three angles in a range of 180 degrees, shape (tasks, 3); nan for complex roots.
    """
    roots = np.full((len(forms), 3), EXACT(np.nan))
    largest = np.max(np.abs(forms), axis=-1)
    for k in np.flatnonzero(np.isfinite(largest) & (largest > 0)):
        tangents = np.roots(np.asarray(forms[k] / largest[k], dtype=float))
        real = tangents.real[np.abs(tangents.imag) < REAL * (1 + np.abs(tangents) ** 2)]
        angles = np.sort([*np.arctan(real), *[np.pi / 2] * (3 - len(tangents))])  # leading coefficients of zero
        roots[k, : len(angles)] = angles
    return roots


def refine_by_newton(values: Any, phi: Any, psi: Any, free: tuple[str, ...]) -> Any:
    """Refine the unknowns p, q, s, phi0, psi0 by Newton's method.

    The residuals are computed with 31 digits, because about ten digits are lost by cancellation if pairs of angles are
    close together.

    Args:
        values: initial values, shape (tasks, 5).
        phi, psi: angles (rad), shape (tasks, pairs).
        free: zero angles that are unknown.
    """
    columns = [0, 1, 2, *(["phi0", "psi0"].index(name) + 3 for name in free)]
    values, phi, psi = (_to_double_double(numbers) for numbers in (values, phi, psi))
    for _ in range(NEWTON_STEPS):
        p, q, s, phi0, psi0 = (values[:, k, None] for k in range(5))
        input_angles, output = phi + phi0, psi + psi0
        rest = p * np.cos(output) - q * np.cos(input_angles) + s - np.cos(input_angles - output)
        p, q, input_angles, output = (numbers.astype(float) for numbers in (p, q, input_angles, output))
        step = (
            pseudo_inverse(equation_slopes(p, q, input_angles, output)[..., columns]) * rest.astype(float)[..., None, :]
        ).sum(-1)
        step = np.where(np.isfinite(step), step, 0.0)  # derivatives are singular at a double root
        values[:, columns] = values[:, columns] - step
    return values.hi.astype(EXACT) + values.lo


def _to_double_double(numbers: Any) -> DoubleDouble:
    numbers = np.asarray(numbers, dtype=EXACT)
    near = numbers.astype(float)
    return DoubleDouble(near, (numbers - near).astype(float))


def equation_slopes(p: Any, q: Any, phi: Any, psi: Any) -> Any:
    """Return the derivatives of Freudenstein's equation with respect to p, q, s, phi0 and psi0, along the last axis.

    The angles are measured from AD.
    """
    turn = np.sin(phi - psi)
    columns = np.cos(psi), -np.cos(phi), np.ones_like(phi), q * np.sin(phi) + turn, -p * np.sin(psi) - turn
    return np.stack(columns, -1)


def output_angles(four_bar: FourBarRatios, phi: Any, near: Any, side: float, open_: float | None = None) -> Any:
    """Return the output angles (rad), measured from psi0, of a four-bar at given input angles.

    Args:
        four_bar: lengths and zero angles.
        phi: input angles (rad), measured from phi0.
        near: expected output angles (rad). Full turns are added to bring each result closest to them.
        side: assembly, as the sign of the cross product BC x DC.
        open_: value returned where the four-bar cannot be assembled; None for the angle at which it comes closest to
            assembly.
    """
    l1, l2, l3 = (np.asarray(x, dtype=float) for x in (four_bar.l1, four_bar.l2, four_bar.l3))
    diagonal = l1 * np.exp(1j * (float(four_bar.phi0) + phi)) - 1
    cosine = (l3 * l3 + np.abs(diagonal) ** 2 - l2 * l2) / (2 * l3 * np.abs(diagonal))
    psi = np.angle(diagonal) + side * np.arccos(np.clip(cosine, -1, 1))
    gap = psi - float(four_bar.psi0) - near
    nearest = near + gap - 2 * np.pi * np.round(gap / (2 * np.pi))
    return nearest if open_ is None else np.where(np.abs(cosine) <= 1, nearest, open_)


def lengths_from_pqs(values: Any, phi: Any, psi: Any) -> FourBarRatios:
    """Convert solutions p, q, s, phi0, psi0 of Freudenstein's equation to lengths and zero angles of four-bars.

    A negative length of the input or the output link is made positive by adding 180 degrees to its zero angle. The
    length of the coupler is computed at the first pair of angles.

    Args:
        values: solutions, shape (tasks, 5); s is not used.
        phi, psi: pairs of angles (rad), shape (tasks, pairs).
    """
    p, q, _, phi0, psi0 = (values[..., k] for k in range(5))
    half = EXACT(PI)
    with np.errstate(all="ignore"):
        l1, l3 = 1 / np.abs(p), 1 / np.abs(q)
        phi0, psi0 = _wrap_angle(phi0 + half * (p < 0)), _wrap_angle(psi0 + half * (q < 0))
        b, c = FourBarRatios(l1, l1, l3, phi0, psi0).pins(phi[..., 0], psi[..., 0])
        return FourBarRatios(l1, np.abs(c - b), l3, phi0, psi0)


def solve_exact_pairs(phi: Any, psi: Any, phi0: Any = 0.0, psi0: Any = 0.0) -> FourBarRatios:
    """Find all real four-bars that pass through 3, 4 or 5 pairs of angles (F. Freudenstein 1954).

    Args:
        phi, psi: input and output angles (rad), shape (tasks, pairs).
        phi0, psi0: zero angles (rad), one value or one per task; None if unknown. With 3 pairs both are given, with 4
            pairs one is unknown, with 5 pairs both are unknown.

    Returns:
        Four-bars, shape (tasks, roots); nan where a root is complex.
    """
    phi, psi = np.atleast_2d(np.asarray(phi, EXACT)), np.atleast_2d(np.asarray(psi, EXACT))
    free = tuple(name for name, value in (("phi0", phi0), ("psi0", psi0)) if value is None)
    given_phi, given_psi = (np.asarray(0.0 if zero is None else zero, EXACT)[..., None] for zero in (phi0, psi0))
    if not free:
        zero_phi, zero_psi = np.zeros((len(phi), 1)), np.zeros((len(phi), 1))
    elif len(free) == 1:
        zero_phi, zero_psi = zero_angles_of_four(phi + given_phi, psi + given_psi, free[0])
    else:
        zero_phi, zero_psi = zero_angles_of_five(phi, psi)
    shape = zero_phi.shape
    a, b = (zero_phi + given_phi).reshape(-1, 1), (zero_psi + given_psi).reshape(-1, 1)
    phi, psi = (np.repeat(row, shape[1], axis=0) for row in (phi, psi))
    values = np.concatenate([solve_pqs(phi + a, psi + b), a, b], axis=-1)
    values = refine_by_newton(values, phi, psi, free) if free else values
    return FourBarRatios(*(numbers.reshape(shape) for numbers in lengths_from_pqs(values, phi, psi)))


def _equation_rows(phi: Any, psi: Any) -> Any:
    return np.stack([np.cos(psi), -np.cos(phi), np.ones_like(np.asarray(phi, dtype=EXACT))], axis=-1)


def _wrap_angle(angle: Any) -> Any:
    """Return the angle wrapped to -pi..pi, in extended precision."""
    full = 2 * EXACT(PI)
    return angle - full * np.round(np.asarray(angle / full, dtype=float))


# Pairs of equal angles: every parallelogram l1 = l3, l2 = l4 passes through them, and l1/l4 is free.
#
# Freudenstein's equation then has p = q and s = 1 for every p. In a parallelogram the transmission angle is the
# angle of DC from AD, so no choice of l1/l4 is better than another; with both zero angles free, DC is perpendicular
# to AD in the middle of its swing.


SAME: Final = 1e-11  # rad: angles that differ by rounding only
SHARE: Final = 0.5  # l1/l4 of the parallelogram


def find_parallelogram(phi: Any, psi: Any, phi0: Any, psi0: Any) -> FourBarRatios | None:
    """Return the parallelogram linkage for three to five pairs in which the output angle equals the input angle.

    Angles that differ by 180 degrees in all pairs count as equal: one link then points in the opposite direction.

    Args:
        phi, psi: input and output angles (rad), shape (pairs,).
        phi0, psi0: zero angles (rad); None if unknown.

    Returns:
        The parallelogram; None if the angles are not equal in all pairs.
    """
    phi, psi = np.asarray(phi, dtype=float), np.asarray(psi, dtype=float)
    if len(phi) < 3 or np.max(np.abs(np.sin((psi - phi - psi[0] + phi[0]) / 2))) > SAME:
        return None
    if phi0 is None and psi0 is None:
        psi0 = np.pi / 2 - (psi.min() + psi.max()) / 2
    gap = psi[0] - phi[0]
    if phi0 is None:
        phi0 = math.remainder(psi0 + gap, math.tau)
    elif psi0 is None:
        psi0 = math.remainder(phi0 - gap, math.tau)
    elif abs(np.sin(psi0 + gap - phi0)) > SAME:
        return None
    elif np.cos(psi0 + gap - phi0) < 0:
        phi0 = math.remainder(phi0 + np.pi, math.tau)
    return FourBarRatios(SHARE, 1.0, SHARE, phi0, psi0)
