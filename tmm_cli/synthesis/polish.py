"""Local polish: sequential quadratic programming with numeric derivatives, all variants of a step at once.

The largest of several pieces is minimised as a bound t above all of them, so that minimax has a smooth form. The
quadratic problem is one of least distance, solved by nonnegative least squares: C. L. Lawson, R. J. Hanson, Solving
Least Squares Problems, 1974, ch. 23; D. Kraft, A software package for sequential quadratic programming, 1988.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from tmm_cli.vectors import Real

STEP = 2e-6  # of a derivative, in shares of the range
REACH = 0.1  # farthest in one iteration
HALVES = 0.5 ** np.arange(20)


@dataclass(frozen=True)
class Local:
    """What a problem gives for variants: pieces of the objective (v, p), inequalities >= 0, equalities (v, e)."""

    pieces: Real
    least: Real
    equal: Real

    def merit(self, weight: float) -> Real:
        """Objective and what is violated."""
        lost = np.maximum(-self.least, 0).sum(axis=1) + np.abs(self.equal).sum(axis=1)
        found: Real = np.max(self.pieces, axis=1) + weight * lost
        return np.where(np.isfinite(found), found, np.inf)


def nonnegative(matrix: Real, right: Real) -> Real:
    """u >= 0 with the least |matrix u - right|."""
    count = matrix.shape[1]
    u, passive = np.zeros(count), np.zeros(count, dtype=bool)
    for _ in range(5 * count):
        gain = matrix.T @ (right - matrix @ u)
        gain[passive] = -np.inf
        if passive.all() or gain.max() <= 1e-13 * np.abs(matrix).max():
            break
        passive[int(np.argmax(gain))] = True
        while True:
            s = np.zeros(count)
            s[passive] = np.linalg.lstsq(matrix[:, passive], right, rcond=None)[0]
            if not passive.any() or s[passive].min() > 0:
                u = s
                break
            low = passive & (s <= 0)
            share = float(np.min(u[low] / np.where(u[low] - s[low] > 0, u[low] - s[low], 1.0)))
            u = u + share * (s - u)
            passive &= u > 1e-15
            u[~passive] = 0.0
    return u


def quadratic(hessian: Real, gradient: Real, rows: Real, bound: Real) -> tuple[Real, Real] | None:
    """d with the least gradient d + d hessian d/2 and rows d >= bound, and the multipliers; None: there is none."""
    root = np.linalg.cholesky(hessian)
    start = np.linalg.solve(root, gradient)
    turned = np.linalg.solve(root, rows.T).T
    size = np.maximum(np.linalg.norm(turned, axis=1), 1e-12)
    turned, high = turned / size[:, None], (bound + turned @ start) / size
    system = np.vstack([turned.T, high])
    aim = np.zeros(len(system))
    aim[-1] = 1.0
    u = nonnegative(system, aim)
    rest = system @ u - aim
    if -rest[-1] < 1e-11:
        return None
    y = rest[:-1] / -rest[-1]
    return np.linalg.solve(root.T, y - start), u / -rest[-1] / size


def polish(evaluate: Callable[[Real], Local], x: Real, iterations: int = 60) -> Real:
    """The nearest best place in 0..1 from x (n,)."""
    n = len(x)
    hessian, weight = np.eye(n), 10.0
    last: tuple[Real, Real, Real, Real, Real] | None = None
    idle = 0
    for _ in range(iterations):
        ends = np.clip(x + np.vstack([np.zeros(n), STEP * np.eye(n), -STEP * np.eye(n)]), 0, 1)
        found = evaluate(ends)
        run = np.diag(ends[1 : n + 1] - ends[n + 1 :])[:, None]

        def slope(y: Real, run: Real = run) -> Real:
            return ((y[1 : n + 1] - y[n + 1 :]) / run).T  # (values, n)

        g, rows_c, rows_e = slope(found.pieces), slope(found.least), slope(found.equal)
        f, c, e = found.pieces[0], found.least[0], found.equal[0]
        top = float(np.max(f))
        if last is not None:  # damped BFGS on the Lagrangian
            x0, lam_f, lam_c, lam_e, old = last
            hessian = _updated(hessian, x - x0, lam_f @ g - lam_c @ rows_c - lam_e @ rows_e - old)
        slopes = np.vstack([-g, rows_c, rows_e, -rows_e, np.eye(n), -np.eye(n)])
        rows = np.hstack([slopes, np.zeros((len(slopes), 1))])
        rows[: len(f), -1] = 1.0
        bound = np.concatenate([f - top, -c, -e, e, np.maximum(-x, -REACH), np.maximum(x - 1, -REACH)])
        whole = np.block([[hessian, np.zeros((n, 1))], [np.zeros((1, n)), np.full((1, 1), 1e-8)]])
        solved = None
        for share in (1.0, 0.5, 0.1, 0.0):  # where the linear constraints contradict each other, towards them
            at = bound.copy()
            at[len(f) : len(f) + len(c) + 2 * len(e)] *= share
            solved = quadratic(whole, np.append(np.zeros(n), 1.0), rows, at)
            if solved is not None:
                break
        if solved is None or not np.all(np.isfinite(solved[0])):
            break
        d, lam = solved[0][:n], solved[1]
        a, b, z = len(f), len(f) + len(c), len(f) + len(c) + len(e)
        lam_f, lam_c, lam_e = lam[:a], lam[a:b], lam[b:z] - lam[z : z + len(e)]
        weight = max(weight, 2 * float(np.max(np.abs(np.concatenate([lam_c, lam_e, [0.0]])))))
        tried = np.clip(x + HALVES[:, None] * d, 0, 1)
        merit = evaluate(np.vstack([tried, x])).merit(weight)
        k = int(np.argmin(merit[:-1]))
        if np.max(np.abs(d)) < 1e-13 or not merit[k] < merit[-1]:
            idle += 1
            if idle > 1:
                break
            hessian, last = np.eye(n), None
            continue
        last = (x, lam_f, lam_c, lam_e, lam_f @ g - lam_c @ rows_c - lam_e @ rows_e)
        x = tried[k]
    return x


def _updated(hessian: Real, s: Real, y: Real) -> Real:
    bs = hessian @ s
    sbs = float(s @ bs)
    if sbs < 1e-30:
        return hessian
    sy = float(s @ y)
    share = 1.0 if sy >= 0.2 * sbs else 0.8 * sbs / (sbs - sy)
    y = share * y + (1 - share) * bs
    new: Real = hessian - np.outer(bs, bs) / sbs + np.outer(y, y) / float(s @ y)
    return new if np.all(np.isfinite(new)) and np.linalg.eigvalsh(new)[0] > 1e-10 else np.eye(len(s))
