"""Parameters that have some values only: the best of each choice is kept; where these are few, all are tried."""

from __future__ import annotations

from dataclasses import replace
from itertools import product
from math import prod

import numpy as np

from tmm_cli.synthesis.optimal.candidates import Candidates
from tmm_cli.synthesis.optimal.evolution import Evolved
from tmm_cli.vectors import Real

MOST, MOST_ONE_BY_ONE = 50_000, 3000  # candidates of which all are tried
CLOSER = 720  # positions round the cycle then, and the errors that they leave
ERROR = 5e-4
BLOCK = 500  # between two reports of progress
POLISHED, FEW = 24, 6  # choices that are looked at closely: where candidates move by their tape, and where slower
NEAR = 0.3  # a violation that the polish may take away


class Choices:
    """Called as candidates.evaluate is; keeps the best candidate of each choice that it has seen.

    Evolution gathers about one choice early, and another may lead farther once the others' numbers are polished.
    """

    def __init__(self, candidates: Candidates) -> None:
        task = candidates.task
        self.candidates, self.free = candidates, bool(task.free)
        self.chosen = [k for k in range(len(candidates.low)) if k not in task.free]
        self.best: dict[tuple[float, ...], tuple[float, float, Real]] = {}
        self.count = prod(len(task.parameters[k].values) for k in self.chosen)
        self.few = not self.free and self.count <= (MOST if candidates.taped else MOST_ONE_BY_ONE)
        if self.few and candidates.taped:
            self.candidates = Candidates(replace(task, positions=max(CLOSER, task.positions)))

    def __call__(self, x: Real) -> tuple[Real, Real]:
        f, v = self.candidates.evaluate(x)
        keys = self.candidates.numbers(x)[:, self.chosen]
        for key, own, violation, objective in zip(keys.tolist(), x, v.tolist(), f.tolist(), strict=True):
            before = self.best.get(tuple(key))
            if before is None or (violation, objective) < before[:2]:
                self.best[tuple(key)] = violation, objective, own.copy()
        return f, v

    def every(self) -> Evolved:
        """Every candidate, best first."""
        task = self.candidates.task
        x = self.candidates.shares(np.array(list(product(*(p.values for p in task.parameters)))))
        found, stopped = np.zeros((2, 0)), False
        try:
            for first in range(0, self.count, BLOCK):
                task.progress(first, self.count)
                found = np.hstack([found, self(x[first : first + BLOCK])])
        except KeyboardInterrupt:
            if not self.best:
                raise
            stopped = True
        finally:
            task.progress(self.count, self.count)
        order = np.lexsort(found)
        f, v = found[:, order]
        return Evolved(x[order], f, v, found.T, stopped, every=True)

    def starts(self) -> list[Real]:
        """Of the choices that are nearest to keep all constraints, and of those with the least objectives beside."""
        half = (POLISHED if self.candidates.taped else FEW) // 2
        found = sorted(self.best.values(), key=lambda one: one[:2])
        near = NEAR if self.free else ERROR
        least = sorted((one for one in found[half:] if one[0] < near), key=lambda one: one[1])
        some = [*found[:half], *least[:half]]
        return [self.candidates.shares(self.candidates.numbers(x)) for _, f, x in some if np.isfinite(f)]
