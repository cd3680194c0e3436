"""Local polish: sequential quadratic programming with numeric derivatives, all variants of a step at once.

The largest of several pieces is minimised as a bound t above all of them, so that minimax has a smooth form. J.
Nocedal, S. J. Wright, Numerical Optimization, 2006, ch. 16 and 18.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from tmm_cli.vectors import Real

STEP = 2e-6  # of a derivative, in shares of the range
REACH = 0.1  # farthest in one iteration
INTERIOR, DONE, TINY = 50, 1e-12, 1e-18  # of the quadratic problem: iterations, tolerance, least of what is positive
FLAT = 0.1  # bend of the bound t: it only steadies the steps, and is not felt where they end
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


def quadratic(
    hessian: Real, gradient: Real, equal: Real, value: Real, rows: Real, bound: Real
) -> tuple[Real, Real, Real] | None:
    """d with the least gradient d + d hessian d/2 where equal d = value and rows d >= bound.

    And the multipliers of both; None where there is none. By the steps of S. Mehrotra, SIAM J. Optim. 2
    (1992).
    """
    n, e = len(gradient), len(equal)
    d, nu = np.zeros(n), np.zeros(e)
    slack, lam = np.maximum(rows @ d - bound, 1.0), np.ones(len(bound))
    for _ in range(INTERIOR):
        dual = hessian @ d + gradient - equal.T @ nu - rows.T @ lam
        off, apart = equal @ d - value, rows @ d - bound - slack
        gap = float(slack @ lam) / len(bound)
        lost = max(float(np.max(np.abs(part), initial=0.0)) for part in (off, apart))
        if lost < DONE and gap < DONE and float(np.max(np.abs(dual))) < DONE * (1 + float(np.max(lam))):
            return d, nu, lam
        matrix = np.block([[hessian + (rows.T * (lam / slack)) @ rows, -equal.T], [equal, np.zeros((e, e))]])
        if not (np.all(np.isfinite(matrix)) and np.all(np.isfinite(dual))):
            return None
        size = 1 / np.sqrt(np.diag(matrix)[:n])  # near a bound entries differ by more digits than numbers have
        across = np.linalg.norm(equal * size, axis=1)
        size = np.append(size, 1 / np.where(across > 0, across, 1.0))
        aim = -slack * lam
        for corrected in (False, True):
            right = np.concatenate([-dual + rows.T @ ((aim - lam * apart) / slack), -off])
            both = size * np.linalg.lstsq(size[:, None] * matrix * size, size * right, rcond=None)[0]
            ds = rows @ both[:n] + apart
            dl = (aim - lam * ds) / slack
            longest = min(float(np.min(-x[dx < 0] / dx[dx < 0], initial=1.0)) for x, dx in ((slack, ds), (lam, dl)))
            if not corrected:
                after = float((slack + longest * ds) @ (lam + longest * dl)) / len(bound)
                aim = (after / gap) ** 3 * gap - slack * lam - ds * dl
        share = 1.0 if longest == 1.0 else 0.995 * longest
        d, nu = d + share * both[:n], nu + share * both[n:]
        slack, lam = np.maximum(slack + share * ds, TINY), np.maximum(lam + share * dl, TINY)
        if not np.all(np.isfinite(d)):
            break
    return (d, nu, lam) if lost < 1e3 * DONE and gap < 1e3 * DONE else None


def polish(evaluate: Callable[[Real], Local], x: Real, iterations: int = 60) -> Real:
    """The nearest best place in 0..1 from x (n,)."""
    n = len(x)
    hessian, weight = np.eye(n), 10.0
    last: tuple[Real, Real, Real, Real, Real] | None = None
    idle = 0
    for _ in range(iterations):
        ends = np.clip(x + np.vstack([np.zeros(n), STEP * np.eye(n), -STEP * np.eye(n)]), 0, 1)
        found = evaluate(ends)
        if not all(np.all(np.isfinite(part)) for part in (found.pieces, found.least, found.equal)):
            break  # at the edge of what can be assembled there are no derivatives
        run = np.diag(ends[1 : n + 1] - ends[n + 1 :])[:, None]

        def slope(y: Real, run: Real = run) -> Real:
            return ((y[1 : n + 1] - y[n + 1 :]) / run).T  # (values, n)

        g, rows_c, rows_e = slope(found.pieces), slope(found.least), slope(found.equal)
        f, c, e = found.pieces[0], found.least[0], found.equal[0]
        top = float(np.max(f))
        if not all(np.all(np.isfinite(part)) for part in (f, c, e, g, rows_c, rows_e)):
            break  # at the edge of what can be assembled
        if last is not None:  # damped BFGS on the Lagrangian
            x0, lam_f, lam_c, lam_e, old = last
            hessian = _updated(hessian, x - x0, lam_f @ g - lam_c @ rows_c - lam_e @ rows_e - old)
        slopes = np.vstack([-g, rows_c, np.eye(n), -np.eye(n)])
        rows = np.hstack([slopes, np.zeros((len(slopes), 1))])
        rows[: len(f), -1] = 1.0
        bound = np.concatenate([f - top, -c, np.maximum(-x, -REACH), np.maximum(x - 1, -REACH)])
        whole = np.block([[hessian, np.zeros((n, 1))], [np.zeros((1, n)), np.full((1, 1), FLAT)]])
        even = np.hstack([rows_e, np.zeros((len(e), 1))])
        solved = None
        for share in (1.0, 0.5, 0.1, 0.0):  # where the linear constraints contradict each other, towards them
            at = bound.copy()
            at[len(f) : len(f) + len(c)] = np.minimum(at[len(f) : len(f) + len(c)], share * np.maximum(-c, 0))
            solved = quadratic(whole, np.append(np.zeros(n), 1.0), even, -share * e, rows, at)
            if solved is not None:
                break
        if solved is None:
            break
        d, lam_e, lam = solved[0][:n], solved[1], solved[2]
        lam_f, lam_c = lam[: len(f)], lam[len(f) : len(f) + len(c)]
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
