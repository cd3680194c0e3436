"""Least squares from many starts beside the evolution: rounds of random ones, of which the best go on.

Paths and laws have many local minima at the ends of long narrow valleys. A round is a tournament: many starts, settled
(settling.py), make few steps, and those with the least squares go on. The search ends where several of the last of two
rounds or more ended at the same least; else the best are shaken, as often minima lie side by side.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from tmm_cli.synthesis.optimal.candidates import LOST, Candidates
from tmm_cli.synthesis.optimal.least_squares import WEIGHT, Evaluate, Rows, descend
from tmm_cli.synthesis.optimal.quantities.deviation import Deviation
from tmm_cli.synthesis.optimal.settling import Settling
from tmm_cli.vectors import Real

SAMPLES = 20_000  # of a round, of which the best and those that evolved start
TOURNAMENT = ((400, 6), (160, 15), (24, 40), (8, 60))  # so many of them, and their steps: ranks say little at first
ROUNDS, AGREED = 3, 6  # at most; starts that end at the same least
SHAKEN, DECADES = ((160, 15), (24, 40), (8, 60)), (-2.5, -0.3)  # as TOURNAMENT; sizes of shakes, shares of the ranges
SHAKES, GAIN = 4, 1e-4  # at most, as long as one brings more than such a share
SAME, NEAR = 1e-3, 1e-2  # of an objective: the same least; as good for most uses
ZERO = 1e-7  # of the size of what is wanted: it is met
CLOSER, LAST = 360, 100  # places and steps of the winners
WINNERS = 4
BLOCK = 400  # variants at once


@dataclass(frozen=True)
class Ends:
    """Where independent starts ended: how many, at the least, and within NEAR of it; met: nothing is less than it."""

    count: int
    same: int
    near: int
    met: bool

    @classmethod
    def of(cls, won: Sequence[tuple[float, Real]]) -> Ends:
        costs = np.array([cost for cost, __ in won])
        least = np.min(costs)
        same, near = (int(np.sum(costs <= least * (1 + share) ** 2)) for share in (SAME, NEAR))
        return cls(len(costs), same, near, bool(least < ZERO**2))

    @property
    def agree(self) -> bool:
        """Whether another seed is likely to lead to the same."""
        return self.met or self.same >= AGREED


@dataclass(frozen=True)
class Found:
    """starts: best first; ends: None where nothing was assembled; stopped: by hand."""

    starts: list[Real]
    ends: Ends | None
    stopped: bool


def fits(candidates: Candidates) -> bool:
    """Whether the objective is a sum of squares, and all numbers may have all values."""
    task = candidates.task
    squares = isinstance(task.objective, Deviation) and task.objective.norm == "least squares"
    return squares and task.target is None and candidates.taped and len(task.free) == len(task.parameters)


def from_many(candidates: Candidates, evolved: Sequence[Real]) -> Found:
    """Where the search from many starts ends; evolved: starts of the first round beside the random ones."""
    chance = np.random.default_rng(candidates.task.seed)
    evaluate, settle = residuals(candidates), Settling(candidates)
    won: list[tuple[float, Real]] = []
    near: list[tuple[float, Real]] = []
    stopped, progress = False, candidates.task.progress
    try:
        for k in range(ROUNDS):
            progress(k, ROUNDS)
            x = _drawn(candidates, chance)
            x = np.vstack([*(evolved if k == 0 else ()), x[candidates.evaluate(x)[1] < LOST]])
            won += _round(candidates, evaluate, settle, x)
            ends = Ends.of(won)
            if ends.met or (k and ends.agree):
                break
        else:
            near = _shaken(evaluate, won, chance)
    except KeyboardInterrupt:
        stopped = True
    finally:
        progress(ROUNDS, ROUNDS)
    if not won:
        return Found([], None, stopped)
    won.sort(key=lambda one: one[0])
    best = sorted([*won[:WINNERS], *near], key=lambda one: one[0])[:WINNERS]
    closer = residuals(Candidates(replace(candidates.task, positions=max(CLOSER, candidates.task.positions))))
    last = _sorted(*descend(closer, np.array([x for __, x in best]), LAST))
    return Found([x for __, x in last], Ends.of([*last, *won[WINNERS:]]), stopped)


def _drawn(candidates: Candidates, chance: np.random.Generator) -> Real:
    """Starts at random; every second one by the ratios of its numbers, as bounds far apart leave the size open."""
    x = chance.random((SAMPLES, len(candidates.low)))
    ratio = candidates.low > 0
    low, high = candidates.low[ratio], candidates.high[ratio]
    x[::2, ratio] = (low * (high / low) ** x[::2, ratio] - low) / (high - low)
    return x


def _round(candidates: Candidates, evaluate: Evaluate, settle: Settling, x: Real) -> list[tuple[float, Real]]:
    """The sums of squares to which a tournament leads, and where."""

    def settled(x: Real) -> Real:
        """Those that it makes better: it knows no constraints."""
        ends = settle(x)
        return np.where((evaluate(ends, 1).cost() < evaluate(x, 1).cost())[:, None], ends, x)

    x = settled(x)
    f, violation = candidates.evaluate(x)
    x = x[np.lexsort((f, violation))]
    for count, steps in TOURNAMENT:
        last = _sorted(*descend(evaluate, settled(x[:count]), steps))
        x = np.array([own for __, own in last])
    return last


def _shaken(evaluate: Evaluate, won: list[tuple[float, Real]], chance: np.random.Generator) -> list[tuple[float, Real]]:
    """Where the best end that are shaken, a little or a lot, again and again."""
    (count, __), last = SHAKEN[0], SHAKEN[-1][0]
    found = sorted(won, key=lambda one: one[0])[:last]
    for __ in range(SHAKES):
        x = np.repeat([x for __, x in found], count // last, axis=0)
        x = np.clip(x + 10 ** chance.uniform(*DECADES, (len(x), 1)) * chance.standard_normal(x.shape), 0, 1)
        for some, steps in SHAKEN:
            new = _sorted(*descend(evaluate, x[:some], steps))
            x = np.array([own for __, own in new])
        before, found = found[0][0], sorted([*found, *new], key=lambda one: one[0])[:last]
        if found[0][0] > before * (1 - GAIN):
            break
    return found


def _sorted(x: Real, cost: Real) -> list[tuple[float, Real]]:
    """Best first."""
    return sorted(zip(cost.tolist(), x, strict=True), key=lambda one: one[0])


def residuals(candidates: Candidates) -> Evaluate:
    """What is made least in squares; equalities stand beside it with a weight."""
    objective, constraints = candidates.task.objective, candidates.constraints
    assert isinstance(objective, Deviation)
    unit = objective.spread * np.sqrt(len(objective.wanted))

    def block(x: Real, each: int) -> Rows:
        (__, read, over), *others = candidates.coarsely(x)[1]
        off, least = [objective.residuals(read, over, each) / unit], []
        for constraint, (quantity, read, over) in zip(constraints, others, strict=True):
            value = quantity.coarse(read, over)[:, None]
            above, even = constraint.rows(value, value)
            least += above
            off += [WEIGHT * row for row in even]
        return Rows(np.hstack(off), np.hstack(least))

    def evaluate(x: Real, each: int) -> Rows:
        size = max(1, BLOCK // each) * each
        with np.errstate(all="ignore"):
            rows = [block(x[at : at + size], each) for at in range(0, len(x), size)]
        return Rows(np.concatenate([r.off for r in rows]), np.concatenate([r.least for r in rows]))

    return evaluate
