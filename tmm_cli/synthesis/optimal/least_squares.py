"""Levenberg-Marquardt from many starts at once, within bounds and constraints.

Each step has the least squares of the linearised residuals (K. Levenberg 1944, D. Marquardt 1963), tried with how they
bend along it too (M. Transtrum, J. Sethna 2012), as minima lie at the ends of long bent valleys. Constraints and bounds
that a step would break are residuals beside the others, with a weight. Slopes are differences: a start and its
neighbours are variants of one evaluation.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from tmm_cli.vectors import Real

STEP = 1e-6  # of a difference, in shares of the ranges
WEIGHT = 1e3  # of what is broken beside the residuals
PASSES = 6  # until the broken ones are known
DAMPINGS = (0.03, 1.0, 30.0)  # times the last one, tried at once
FIRST, LEAST, LARGEST = 1e-3, 1e-12, 1e8  # damping
AHEAD = 0.1  # of a step: where it is seen how residuals bend
GAIN = 1e-14  # of the sum of squares: what a step must bring


@dataclass(frozen=True)
class Rows:
    """Of variants: residuals (v, n), and what is to stay above zero (v, m)."""

    off: Real
    least: Real

    def cost(self) -> Real:
        """Sum of squares, (v,); inf where something cannot be assembled."""
        total = np.sum(self.off**2, axis=1) + WEIGHT**2 * np.sum(np.minimum(self.least, 0) ** 2, axis=1)
        return np.where(np.isfinite(total), total, np.inf)


Evaluate = Callable[[Real, int], Rows]  # variants (v, n) in 0..1, in sets of so many: the first leads


def descend(evaluate: Evaluate, x: Real, steps: int) -> tuple[Real, Real]:
    """Places (starts, n) to which starts lead, and their sums of squares."""
    n = x.shape[1]
    x, damping = x.copy(), np.full(len(x), FIRST)
    cost = evaluate(x, 1).cost()
    going = np.flatnonzero(np.isfinite(cost))
    for _ in range(steps):
        if not len(going):
            break
        at = x[going]
        rows, slopes = _differences(evaluate, at)
        tried = np.clip(damping[going, None] * np.array(DAMPINGS), LEAST, LARGEST)
        ends = np.stack(_ends(evaluate, rows, slopes, at, tried), axis=1)
        costs = evaluate(ends.reshape(-1, n), 1).cost().reshape(len(going), -1)
        each, best = np.arange(len(going)), np.argmin(costs, axis=1)
        better = costs[each, best] < cost[going] * (1 - GAIN)
        x[going[better]], cost[going[better]] = ends[each, best][better], costs[each, best][better]
        damping[going] = np.where(better, tried[each, best % len(DAMPINGS)], tried[:, -1])
        going = going[better | (damping[going] < LARGEST)]
    return x, cost


def _ends(evaluate: Evaluate, rows: Rows, slopes: Rows, x: Real, dampings: Real) -> list[Real]:
    """Where steps lead, one of each damping, and then the same with what residuals bend along it."""
    straight, bent = [], []
    for damping in dampings.T:
        step = step_of(rows, slopes, x, damping)
        ahead = evaluate(x + AHEAD * step, 1).off
        bend = ((ahead - rows.off) / AHEAD - np.einsum("srn,sn->sr", slopes.off, step)) / AHEAD
        known = np.all(np.isfinite(bend), axis=1, keepdims=True)
        off = rows.off + np.where(known, bend, 0.0)
        straight.append(np.clip(x + step, 0, 1))
        bent.append(np.clip(x + step_of(Rows(off, rows.least), slopes, x, damping), 0, 1))
    return [*straight, *bent]


def _differences(evaluate: Evaluate, x: Real) -> tuple[Rows, Rows]:
    """Rows at places (s, n), and their slopes: (s, rows, n). A slope that is not known counts as none."""
    s, n = x.shape
    run = np.where(x > 0.5, -STEP, STEP)
    ends = np.repeat(x[:, None], n + 1, axis=1)
    ends[:, 1:] += run[:, None] * np.eye(n)
    found = evaluate(ends.reshape(-1, n), n + 1)
    values, slopes = [], []
    for y in (found.off, found.least):
        y = y.reshape(s, n + 1, -1)
        slope = (y[:, 1:] - y[:, :1]) / run[:, :, None]
        values.append(y[:, 0])
        slopes.append(np.where(np.isfinite(slope), slope, 0.0).transpose(0, 2, 1))
    return Rows(*values), Rows(*slopes)


def step_of(rows: Rows, slopes: Rows, x: Real, damping: Any) -> Real:
    """The step of each start, (s, n), within bounds 0..1."""
    s, n = x.shape
    square = slopes.off.transpose(0, 2, 1) @ slopes.off
    steep = np.einsum("sii->si", square)
    square = (
        square
        + np.eye(n) * (np.reshape(damping, (-1, 1)) * (steep + 1e-6 * np.sum(steep, axis=1, keepdims=True)))[:, None]
        + 1e-30 * np.eye(n)
    )
    down = -np.einsum("srn,sr->sn", slopes.off, rows.off)
    one = np.broadcast_to(np.eye(n), (s, n, n))
    kept = np.concatenate([slopes.least, one, -one], axis=1)  # kept @ step >= least
    least = np.hstack([-rows.least, -x, x - 1])
    weight = WEIGHT**2 * np.maximum(1.0, np.max(steep, axis=1))
    step = np.zeros((s, n))
    for k in range(PASSES):
        broken = (np.einsum("srn,sn->sr", kept, step) < least) * weight[:, None] if k else np.zeros(least.shape)
        pulled = kept * broken[:, :, None]
        new = np.linalg.solve(
            square + pulled.transpose(0, 2, 1) @ kept, (down + np.einsum("srn,sr->sn", pulled, least))[..., None]
        )[..., 0]
        if np.array_equal(new, step):
            break
        step = new
    return step
