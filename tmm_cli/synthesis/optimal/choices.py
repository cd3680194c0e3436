"""Parameters that have some values only: all candidates tried, or the best of each choice kept for the polish."""

from __future__ import annotations

from dataclasses import replace
from itertools import product
from math import prod

import numpy as np

from tmm_cli.synthesis.optimal.evolution import Evolved
from tmm_cli.synthesis.optimal.search import Search
from tmm_cli.vectors import Real

MOST, MOST_ONE_BY_ONE = 50_000, 3000  # candidates of which all are tried
BLOCK = 500  # between two reports of progress
LEVELS = ((0, 2e-2, 400), (720, 5e-4, 30))  # positions round the cycle, the errors that they leave, how many go on
POLISHED, FEW = 24, 6  # choices that are polished: where candidates move by their tape, and where they are slower
NEAR = 0.3  # a violation that the polish may take away


def every(search: Search) -> Evolved | None:
    """Every candidate, best first; None where a parameter may have all values, or there are too many."""
    task = search.task
    choices = [task.values[name] for name in task.low if name in task.values]
    count = prod(len(own) for own in choices)
    if task.free or count > (MOST if search.taped else MOST_ONE_BY_ONE):
        return None
    x = search.shares(np.array(list(product(*choices))))
    f, v = np.zeros(0), np.zeros(0)
    stopped = False
    try:
        for first in range(0, count, BLOCK):
            task.progress(first, count)
            more = search.evaluate(x[first : first + BLOCK])
            f, v = np.append(f, more[0]), np.append(v, more[1])
    except KeyboardInterrupt:
        if not len(f):
            raise
        stopped = True
    finally:
        task.progress(count, count)
    order = np.lexsort((np.where(np.isfinite(f), f, np.inf), v))
    return Evolved(x[order], f[order], v[order], np.stack([f, v], axis=1), stopped, every=True)


def foremost(search: Search, found: Evolved) -> Real:
    """Candidates (variants, n) among which the best one is: those that places of the search cannot tell from it.

    Between the places peaks are higher, so that what keeps a constraint there may miss it, and the other way round.
    """
    x, f, v = found.population, found.objective, found.violation
    for positions, error, most in LEVELS:
        if positions:
            closer = replace(search.task, positions=max(positions, search.task.positions))
            f, v = Search(closer, search.first).evaluate(x)
        sure = f[(v == 0) & np.isfinite(f)]
        scale = 1.0 if search.task.target is not None else abs(float(np.min(sure, initial=np.inf)))
        near = f <= np.min(sure) + 2 * error * scale if sure.size else np.ones(len(f), dtype=bool)
        likely = np.flatnonzero(near & (v <= error))
        likely = likely[np.argsort(f[likely])][:most]
        first = np.lexsort((np.where(np.isfinite(f), f, np.inf), v))[: most if not sure.size else 3]
        x = x[np.unique(np.append(likely, first))]
    return x


class Choices:
    """Called as search.evaluate is; keeps the best candidate of each choice that it has seen.

    Evolution gathers about one choice early, and another may lead farther once the others' numbers are polished.
    """

    def __init__(self, search: Search) -> None:
        self.search = search
        self.chosen = [k for k in range(len(search.low)) if k not in search.task.free]
        self.best: dict[tuple[float, ...], tuple[float, float, Real]] = {}

    def __call__(self, x: Real) -> tuple[Real, Real]:
        f, v = self.search.evaluate(x)
        keys = self.search.numbers(x)[:, self.chosen]
        for key, own, violation, objective in zip(keys.tolist(), x, v.tolist(), f.tolist(), strict=True):
            before = self.best.get(tuple(key))
            if before is None or (violation, objective) < before[:2]:
                self.best[tuple(key)] = violation, objective, own.copy()
        return f, v

    def starts(self) -> list[Real]:
        """Of the choices that are nearest to keep all constraints, and of those with the least objectives beside."""
        half = (POLISHED if self.search.taped else FEW) // 2
        found = sorted(self.best.values(), key=lambda one: one[:2])
        least = sorted((one for one in found[half:] if one[0] < NEAR), key=lambda one: one[1])
        some = [*found[:half], *least[:half]]
        return [self.search.shares(self.search.numbers(x)) for _, objective, x in some if np.isfinite(objective)]
