"""Differential evolution with constraints, a global search over the unit cube by scipy.

Parameters with discrete values are also handled here.

Sources: R. Storn, K. Price, Differential Evolution, Journal of Global Optimization 11 (1997); constraints by the rules
of K. Deb, Comput. Methods Appl. Mech. Engrg. 186 (2000); equalities with a decreasing tolerance (T. Takahama, S. Sakai,
2006).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import product
from math import prod

import numpy as np

from tmm_cli.mechanics.numerics import Real
from tmm_cli.synthesis.optimal.candidates import Candidates

Evaluate = Callable[[Real], tuple[Real, Real]]  # (variants, n) in 0..1 -> objective, violation (0: none)
GATHERED = 1e-5  # relative spread of objectives at which a population is replaced
TOLERANCES = (
    1.0,
    0.3,
    0.1,
    0.03,
    0.01,
)  # successive tolerances of equalities, relative to the violation of the first candidates
FORBIDDEN = 1e30  # times a violation: above every objective


@dataclass(frozen=True)
class EvolutionResult:
    """Result of an evolution.

    Attributes:
        population: candidates of the first generation and the best one of each later generation, best first, shape
            (variants, n).
        objective, violation: objective and constraint violation of each, shape (variants,).
        history: objective and violation of the leading candidate in each generation, shape (generations, 2).
        stopped: True if the user stopped the search.
        every: True if all candidates were evaluated without evolution; `history` then has a row for each candidate.
    """

    population: Real
    objective: Real
    violation: Real
    history: Real
    stopped: bool
    every: bool = False


class _Generations:
    """Callable object that evaluates a generation for scipy; candidates are the columns of an array (n, variants).

    It records the candidates of the first generation and the best one of each later generation.
    """

    def __init__(self, evaluate: Evaluate, generations: int, progress: Callable[[int, int], None]) -> None:
        self.evaluate, self.generations, self.progress = evaluate, generations, progress
        self.kept: list[tuple[Real, Real, Real]] = []
        self.history: list[tuple[float, float]] = []
        self.tolerance = 0.0
        self.leading = np.inf  # of the current population

    @property
    def left(self) -> int:
        return self.generations - len(self.history)

    def compute_merits(self, f: Real, v: Real) -> Real:
        """Return a number that ranks candidates by the rules of K. Deb; the smallest is best.

        A smaller violation is better; of feasible candidates the one with the smaller objective is better.
        """
        return np.where(v > self.tolerance, FORBIDDEN * v, np.where(np.isfinite(f), f, np.inf))

    def __call__(self, columns: Real) -> Real:
        self.progress(len(self.history), self.generations)
        x = columns.T
        f, v = self.evaluate(x)
        merits = self.compute_merits(f, v)
        first = np.argsort(merits)[:1]
        if merits[first[0]] < self.leading or not self.history:
            self.leading = float(merits[first[0]])
            self.history.append((float(f[first[0]]), float(v[first[0]])))
        else:
            self.history.append(self.history[-1])
        self.kept.append((x[first], f[first], v[first]) if self.kept else (x.copy(), f, v))
        return merits


def evolve(
    evaluate: Evaluate,
    size: int,
    *,
    population: int,
    generations: int,
    seed: int,
    equalities: bool = False,
    progress: Callable[[int, int], None] = lambda at, of: None,
) -> EvolutionResult:
    """Search the unit cube by differential evolution. The same seed always gives the same result.

    A population that converges early is replaced by a new one.

    Args:
        evaluate: function that returns objective and violation of candidates in 0..1, shape (variants, n).
        size: number of dimensions n.
        population: number of candidates in a generation.
        generations: number of generations of all populations together.
        seed: seed of the random numbers.
        equalities: True if there are equality constraints; their tolerance then decreases step by step.
        progress: function that is called with the current generation and the number of generations.

    Raises:
        KeyboardInterrupt: the user stopped the search before the end of the first generation. Later the result so far
            is returned.
    """
    from scipy.optimize import differential_evolution

    chance = np.random.default_rng(seed)
    watched = _Generations(evaluate, generations, progress)
    stopped = False
    start = 0.0
    try:
        while watched.left > 0:
            square = chance.permuted(np.tile(np.arange(population), (size, 1)), axis=1).T
            x = (
                square + chance.random(square.shape)
            ) / population  # Latin hypercube: every coordinate is evenly spread
            for share in TOLERANCES if equalities else (0.0,):
                if watched.left <= 0:
                    break
                watched.tolerance, watched.leading = share * start, np.inf
                last = share == TOLERANCES[-1] or not equalities
                count = watched.left if last else min(watched.left, max(1, generations // len(TOLERANCES) // 2))
                evolved = differential_evolution(
                    watched,
                    [(0.0, 1.0)] * size,
                    init=x,
                    maxiter=count - 1,
                    strategy="currenttobest1bin",
                    mutation=(0.5, 1.0),
                    recombination=0.9,
                    tol=GATHERED,
                    atol=0.0,
                    polish=False,
                    updating="deferred",
                    vectorized=True,
                    rng=chance,
                )
                x = evolved.population
                if equalities and not start:
                    start = float(np.quantile(np.minimum(watched.kept[0][2], 10.0), 0.2))
    except KeyboardInterrupt:
        stopped = True
    finally:
        progress(generations, generations)
    if not watched.kept:
        raise KeyboardInterrupt
    x, f, v = (np.concatenate(parts) for parts in zip(*watched.kept, strict=True))
    order = np.argsort(watched.compute_merits(f, v), kind="stable")
    return EvolutionResult(x[order], f[order], v[order], np.array(watched.history), stopped)


# Discrete parameters: the best candidate of each combination is kept; few combinations are all evaluated.


MOST, MOST_ONE_BY_ONE = 50_000, 3000  # number of candidates up to which all are evaluated
CLOSER = 720  # positions in the cycle then, and their error
ERROR = 5e-4
BLOCK = 500  # candidates between two progress reports
POLISHED, FEW = 24, 6  # combinations that are refined: with traced evaluation, and without
NEAR = 0.3  # violation that refinement may remove


class DiscreteChoices:
    """Wrapper of `Candidates.evaluate` that keeps the best candidate of each combination of discrete values.

    The evolution soon concentrates on one combination. Another one may be better after its continuous parameters have
    been refined, so the best candidate of each is kept.
    """

    def __init__(self, candidates: Candidates) -> None:
        task = candidates.task
        self.candidates, self.free = candidates, bool(task.free)
        self.chosen = [k for k in range(len(candidates.low)) if k not in task.free]
        self.best: dict[tuple[float, ...], tuple[float, float, Real]] = {}
        self.count = prod(len(task.parameters[k].values) for k in self.chosen)
        self.few = not self.free and self.count <= (MOST if candidates.traced else MOST_ONE_BY_ONE)
        if self.few and candidates.traced:
            self.candidates = Candidates(replace(task, positions=max(CLOSER, task.positions)))

    def __call__(self, x: Real) -> tuple[Real, Real]:
        f, v = self.candidates.evaluate(x)
        keys = self.candidates.numbers(x)[:, self.chosen]
        for key, point, violation, objective in zip(keys.tolist(), x, v.tolist(), f.tolist(), strict=True):
            before = self.best.get(tuple(key))
            if before is None or (violation, objective) < before[:2]:
                self.best[tuple(key)] = violation, objective, point.copy()
        return f, v

    def evaluate_all(self) -> EvolutionResult:
        """Evaluate all combinations of discrete values, without evolution."""
        task = self.candidates.task
        x = self.candidates.shares(np.array(list(product(*(p.values for p in task.parameters)))))
        evaluated, stopped = np.zeros((2, 0)), False
        try:
            for first in range(0, self.count, BLOCK):
                task.progress(first, self.count)
                evaluated = np.hstack([evaluated, self(x[first : first + BLOCK])])
        except KeyboardInterrupt:
            if not self.best:
                raise
            stopped = True
        finally:
            task.progress(self.count, self.count)
        order = np.lexsort(evaluated)
        f, v = evaluated[:, order]
        return EvolutionResult(x[order], f, v, evaluated.T, stopped, every=True)

    def find_starts(self) -> list[Real]:
        """Return starting points for the refinement in 0..1.

        These are the combinations closest to feasibility, and of the others those with the smallest objective.
        """
        half = (POLISHED if self.candidates.traced else FEW) // 2
        ranked = sorted(self.best.values(), key=lambda combination: combination[:2])
        near = NEAR if self.free else ERROR
        least = sorted(
            (combination for combination in ranked[half:] if combination[0] < near),
            key=lambda combination: combination[1],
        )
        some = [*ranked[:half], *least[:half]]
        return [self.candidates.shares(self.candidates.numbers(x)) for _, f, x in some if np.isfinite(f)]
