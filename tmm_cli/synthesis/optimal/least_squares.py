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

from tmm_cli.groups.linear import solve
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
        ends = _ends(evaluate, rows, slopes, at, tried)
        costs = evaluate(ends.reshape(-1, n), 1).cost().reshape(len(going), -1)
        each, best = np.arange(len(going)), np.argmin(costs, axis=1)
        better = costs[each, best] < cost[going] * (1 - GAIN)
        x[going[better]], cost[going[better]] = ends[each, best][better], costs[each, best][better]
        damping[going] = np.where(better, tried[each, best % len(DAMPINGS)], tried[:, -1])
        going = going[better | (damping[going] < LARGEST)]
    return x, cost


def _ends(evaluate: Evaluate, rows: Rows, slopes: Rows, x: Real, dampings: Real) -> Real:
    """Where steps lead, (s, 2 d, n): one of each damping (s, d), and the same with what residuals bend along it."""
    rows, slopes = (Rows(one.off[:, None], one.least[:, None]) for one in (rows, slopes))
    x = x[:, None]
    step = step_of(rows, slopes, x, dampings)
    ahead = evaluate((x + AHEAD * step).reshape(-1, x.shape[-1]), 1).off.reshape(*dampings.shape, -1)
    bend = ((ahead - rows.off) / AHEAD - (slopes.off @ step[..., None])[..., 0]) / AHEAD
    known = np.all(np.isfinite(bend), axis=-1, keepdims=True)
    bent = step_of(Rows(rows.off + np.where(known, bend, 0.0), rows.least), slopes, x, dampings)
    ends: Real = np.clip(x + np.concatenate([step, bent], axis=1), 0, 1)
    return ends


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
    """The step of each start, (..., n), within bounds 0..1."""
    n = x.shape[-1]
    square = slopes.off.mT @ slopes.off
    steep = np.einsum("...ii->...i", square)
    floor = steep + 1e-6 * np.sum(steep, axis=-1, keepdims=True)
    square = square + np.eye(n) * (np.asarray(damping)[..., None] * floor + 1e-30)[..., None]
    down = -slopes.off.mT @ rows.off[..., None]
    weight = WEIGHT**2 * np.maximum(1.0, np.max(steep, axis=-1))[..., None, None]
    broken, beyond = np.zeros((*rows.least.shape, 1), dtype=bool), np.zeros((*x.shape, 1), dtype=bool)
    edge = np.zeros(beyond.shape)
    for __ in range(PASSES):
        pulled, held = (slopes.least * (weight * broken)).mT, weight * beyond
        pull = down - pulled @ rows.least[..., None] + held * edge
        step = solve(square + pulled @ slopes.least + np.eye(n) * held, pull[..., 0])[..., None]
        step = np.where(np.isfinite(step), step, 0.0)  # what is lost beside the weights takes no step here
        before, edge = (broken, beyond), np.clip(step, -x[..., None], 1 - x[..., None])
        broken, beyond = slopes.least @ step < -rows.least[..., None], edge != step
        if all(map(np.array_equal, before, (broken, beyond))):
            break
    return step[..., 0]
