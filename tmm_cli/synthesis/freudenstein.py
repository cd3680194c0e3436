"""Freudenstein's equation for pairs of angles phi (input AB) and psi (output DC), both from the frame AD.

    p cos(psi) - q cos(phi) + s = cos(phi - psi),   p = l4/l1, q = l4/l3, s = (l1^2 + l3^2 + l4^2 - l2^2)/(2 l1 l3)
(F. Freudenstein, An analytical approach to the design of four-link mechanisms, Trans. ASME 76 (1954)). A negative p or
q is a link drawn the other way: its zero angle is then half a turn more. With phi = phi0 + given angle, psi = psi0 +
given angle, 4 pairs leave one of the zero angles to be found: the determinant of the four equations is a quadratic form
in its cosine and sine; 5 pairs leave both: with delta = phi0 - psi0 a cubic form in cos(delta) and sin(delta).
Arrays: tasks on the first axis, pairs on the last.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from tmm_cli.vectors import PI

EXACT: Final = np.longdouble
POLISHES: Final = 4
SINGULAR: Final = 1e-18  # determinants of numbers about 1; those of near positions are small and still good


@dataclass(frozen=True)
class Bars:
    """Lengths over l4 (positive) and zero angles (rad), arrays of one shape: a four-bar each."""

    l1: Any
    l2: Any
    l3: Any
    phi0: Any
    psi0: Any

    def __getitem__(self, at: Any) -> Bars:
        return Bars(*(np.asarray(value)[at] for value in vars(self).values()))

    def pins(self, phi: Any, psi: Any) -> tuple[Any, Any]:
        """Pins B and C for given angles (without the zero angles), over l4; A is 0, D is 1."""
        return self.l1 * _unit(self.phi0 + phi), 1 + self.l3 * _unit(self.psi0 + psi)


def solve_linear(rows: Any, right: Any) -> Any:
    """Linear systems (..., n, n), (..., n), refined in extended precision; nan where they are singular."""
    near = np.asarray(rows, dtype=float)
    finite = np.isfinite(near).all((-1, -2))[..., None, None]
    sound = (np.abs(np.linalg.det(np.where(finite, near, 0.0))) > SINGULAR) & finite[..., 0, 0]
    near = np.where(sound[..., None, None], near, np.eye(near.shape[-1]))
    found = np.zeros(np.shape(right), dtype=EXACT)
    for _ in range(3):
        rest = right - (rows * found[..., None, :]).sum(-1)
        found = found + np.linalg.solve(near, np.asarray(rest, dtype=float)[..., None])[..., 0]
    return np.where(sound[..., None], found, np.nan)


def three(phi: Any, psi: Any) -> Any:
    """p, q, s (tasks, 3) of three pairs with their zero angles in them."""
    return solve_linear(_rows(phi, psi), np.cos(phi - psi))


def two(phi: Any, psi: Any, known: Any, value: Any) -> Any:
    """p, q, s (tasks, 3) of two pairs and a linear condition known . (p, q, s) = value."""
    rows = np.concatenate([_rows(phi, psi), np.asarray(known, dtype=EXACT)[..., None, :]], axis=-2)
    right = np.concatenate([np.cos(phi - psi), np.asarray(value, dtype=EXACT)[..., None]], axis=-1)
    return solve_linear(rows, right)


def four(phi: Any, psi: Any, free: str) -> tuple[Any, Any]:
    """Both zero angles (tasks, 2), nan where not real; phi and psi of four pairs, of which `free` still lacks its own.

    Angles half a turn away are the same four-bars.
    """

    def form(angle: float) -> Any:
        one, other = (phi + angle, psi) if free == "phi0" else (phi, psi + angle)
        return np.linalg.det(np.asarray(np.concatenate(
            [_rows(one, other), np.cos(one - other)[..., None]], axis=-1), dtype=float))  # fmt: skip

    a, c = form(0.0), form(np.pi / 2)
    b = 2 * form(np.pi / 4) - a - c
    with np.errstate(all="ignore"):
        root = np.sqrt(b * b - 4 * a * c)
        big = -(b + np.where(b < 0, -root, root)) / 2
        angles = np.stack([np.arctan2(big, c), np.arctan2(a, big)], axis=-1)  # of a cos^2 + b cos sin + c sin^2
    zero = np.zeros_like(angles)
    return (angles, zero) if free == "phi0" else (zero, angles)


def five(phi: Any, psi: Any) -> tuple[Any, Any]:
    """Both zero angles (tasks, 3), nan where not real, of five pairs."""
    ones = np.ones_like(phi)
    rows = np.stack([np.cos(psi), np.sin(psi), np.cos(phi), np.sin(phi), ones], axis=-1)
    of_cos, of_sin = solve_linear(rows, np.cos(phi - psi)), solve_linear(rows, -np.sin(phi - psi))
    a = [np.asarray(x[:, 0] + 1j * x[:, 1], complex) for x in (of_cos, of_sin)]  # p e^(-i psi0) over cos, sin of delta
    b = [np.asarray(x[:, 2] + 1j * x[:, 3], complex) for x in (of_cos, of_sin)]  # -q e^(-i phi0)
    x, z = b[0] * a[0].conj(), b[1] * a[1].conj()
    y = b[0] * a[1].conj() + b[1] * a[0].conj()
    cubic = np.stack([z.real, y.real + z.imag, x.real + y.imag, x.imag], axis=-1)  # of tan(delta)
    phi0, psi0 = np.full((len(x), 3), np.nan), np.full((len(x), 3), np.nan)
    for k, row in enumerate(cubic):
        if not np.all(np.isfinite(row)) or not np.any(row):
            continue
        tangents = np.roots(row)
        deltas = [float(np.arctan(t.real)) for t in tangents if abs(t.imag) < 1e-7 * (1 + abs(t))]
        if abs(row[0]) <= SINGULAR * np.max(np.abs(row)):
            deltas.append(np.pi / 2)
        for j, delta in enumerate(deltas[:3]):
            cosine, sine = np.cos(delta), np.sin(delta)
            psi0[k, j] = -np.angle(a[0][k] * cosine + a[1][k] * sine)
            phi0[k, j] = psi0[k, j] + delta
    return phi0, psi0


def polished(values: Any, phi: Any, psi: Any, free: tuple[str, ...]) -> Any:
    """p, q, s, phi0, psi0 (tasks, 5) by Newton's method with residuals in extended precision."""
    columns = [0, 1, 2, *(["phi0", "psi0"].index(name) + 3 for name in free)]
    values = np.asarray(values, dtype=EXACT)
    for _ in range(POLISHES):
        p, q, s, phi0, psi0 = (values[:, k, None] for k in range(5))
        one, other = phi + phi0, psi + psi0
        rest = p * np.cos(other) - q * np.cos(one) + s - np.cos(one - other)
        turn = np.sin(one - other)
        slopes = np.stack(
            [np.cos(other), -np.cos(one), np.ones_like(one), q * np.sin(one) + turn, -p * np.sin(other) - turn], -1
        )[..., columns]
        step = solve_newton(slopes, rest)
        values = values.copy()
        values[:, columns] -= step
    return values


def solve_newton(slopes: Any, rest: Any) -> Any:
    """A step of Newton's method; zero where the slopes are singular (a double root)."""
    near = np.asarray(slopes, dtype=float)
    sound = np.isfinite(near).all((-1, -2)) & np.isfinite(np.asarray(rest, float)).all(-1)
    near = np.where(sound[:, None, None], near, np.eye(near.shape[-1]))
    sound &= np.abs(np.linalg.det(near)) > 1e-300
    near = np.where(sound[:, None, None], near, np.eye(near.shape[-1]))
    return np.where(sound[:, None], np.linalg.solve(near, np.asarray(rest, float)[..., None])[..., 0], 0.0)


def bars(values: Any, phi: Any, psi: Any) -> Bars:
    """Positive lengths from p, q, s, phi0, psi0 (tasks, 5); the coupler is measured at the first pair."""
    p, q, _, phi0, psi0 = (values[..., k] for k in range(5))
    half = EXACT(PI)
    with np.errstate(all="ignore"):
        l1, l3 = 1 / np.abs(p), 1 / np.abs(q)
        phi0, psi0 = _wrapped(phi0 + half * (p < 0)), _wrapped(psi0 + half * (q < 0))
        b, c = Bars(l1, l1, l3, phi0, psi0).pins(phi[..., 0], psi[..., 0])
        return Bars(l1, np.abs(c - b), l3, phi0, psi0)


def solutions(phi: Any, psi: Any, phi0: float | None = 0.0, psi0: float | None = 0.0) -> Bars:
    """All real four-bars (tasks, roots) through 3, 4 or 5 pairs (tasks, pairs); nan where there is no more root.

    A zero angle of None is to be found: none for 3 pairs, one for 4, both for 5.
    """
    phi, psi = np.atleast_2d(np.asarray(phi, EXACT)), np.atleast_2d(np.asarray(psi, EXACT))
    free = tuple(name for name, value in (("phi0", phi0), ("psi0", psi0)) if value is None)
    given_phi, given_psi = phi0 or 0.0, psi0 or 0.0
    if not free:
        one, other = np.zeros((len(phi), 1)), np.zeros((len(phi), 1))
    elif len(free) == 1:
        one, other = four(phi + given_phi, psi + given_psi, free[0])
    else:
        one, other = five(phi, psi)
    found = []
    for k in range(one.shape[1]):
        a, b = one[:, k] + EXACT(given_phi), other[:, k] + EXACT(given_psi)
        linear = three((phi + a[:, None])[:, :3], (psi + b[:, None])[:, :3])
        values = np.concatenate([linear, a[:, None], b[:, None]], axis=-1)
        values = polished(values, phi, psi, free) if free else values
        found.append(bars(values, phi, psi))
    return Bars(*(np.stack([getattr(one, name) for one in found], axis=1) for name in vars(found[0])))


def _rows(phi: Any, psi: Any) -> Any:
    return np.stack([np.cos(psi), -np.cos(phi), np.ones_like(np.asarray(phi, dtype=EXACT))], axis=-1)


def _unit(angle: Any) -> Any:
    return np.cos(angle) + 1j * np.sin(angle)


def _wrapped(angle: Any) -> Any:
    """Within half a turn, in the angle's precision."""
    full = 2 * EXACT(PI)
    return angle - full * np.round(np.asarray(angle / full, dtype=float))
