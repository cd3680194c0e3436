"""Differential evolution with constraints: a global search over a box.

R. Storn, K. Price, Differential Evolution, Journal of Global Optimization 11 (1997); current-to-pbest after J. Zhang,
A. C. Sanderson, JADE, IEEE Trans. Evol. Comp. 13 (2009); constraints by the rules of K. Deb, Comput. Methods Appl.
Mech. Engrg. 186 (2000), with a tolerance that shrinks to zero (T. Takahama, S. Sakai, 2006), for equalities.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from tmm_cli.vectors import Real

Evaluate = Callable[[Real], tuple[Real, Real]]  # (variants, n) in 0..1 -> objective, violation (0: none)
SIDES, FEWEST = 2, 8  # populations beside each other; candidates in each at least
BEST = 0.15  # share of the population that draws the others
PATIENCE, SLOW = 60, 1e-4  # generations in which the best must improve by such a share, or the population has gathered
FINE = 1e-6  # a violation that the polish takes away


@dataclass(frozen=True)
class Evolved:
    """population (variants, n), best first, with objective and violation; history: of the best, by generation.

    stopped: by hand, before its end. every: nothing evolved, all were tried, and history is of each of them.
    """

    population: Real
    objective: Real
    violation: Real
    history: Real
    stopped: bool
    every: bool = False


def better(f: Real, v: Real, than_f: Real, than_v: Real, tolerance: float) -> Real:
    """Deb's rules: less violation, or both allowed (or alike) and a smaller objective."""
    a, b = np.where(v <= tolerance, 0.0, v), np.where(than_v <= tolerance, 0.0, than_v)
    found: Real = (a < b) | ((a == b) & (f <= than_f))
    return found


def evolve(
    evaluate: Evaluate, size: int, *, population: int, generations: int, seed: int, shrinking: int = 0,
    progress: Callable[[int, int], None] = lambda at, of: None, known: Real | None = None,
) -> Evolved:  # fmt: skip
    """Search 0..1 in `size` dimensions; the same seed gives the same answer.

    SIDES populations go on beside each other, for they are evaluated quicker together; one that gets no better makes
    room for a new one. population: of all; shrinking: generations in which the tolerance of a population goes to zero;
    without equalities none is wanted, and the search is better without. known: candidates that it begins with.
    """
    each = max(FEWEST, population // SIDES)
    sides = [_Population(each, size, shrinking, chance) for chance in np.random.default_rng(seed).spawn(SIDES)]
    trials = [side.spread() for side in sides]
    if known is not None:
        trials[0][: len(known)] = known[:each]
    earlier: list[tuple[Real, Real, Real]] = []  # the best of populations that have made room
    history: list[tuple[float, float]] = []
    stopped = False
    try:
        for generation in range(generations):
            progress(generation, generations)
            f, v = evaluate(np.concatenate(trials))
            for k, side in enumerate(sides):
                side.take(trials[k], f[k * each : (k + 1) * each], v[k * each : (k + 1) * each])
            history.append(min((side.history[-1] for side in sides), key=lambda best: (best[1], best[0])))
            earlier += [side.best for side in sides if side.settled]
            trials = [side.spread() if side.settled else side.trial() for side in sides]
    except KeyboardInterrupt:
        stopped = True
    finally:
        progress(generations, generations)
    there = [(side.x, side.f, side.v) for side in sides if side.history]
    if not there and not earlier:
        raise KeyboardInterrupt
    x, f, v = (np.concatenate(parts) for parts in zip(*earlier, *there, strict=True))
    order = np.lexsort((np.where(np.isfinite(f), f, np.inf), v))
    return Evolved(x[order], f[order], v[order], np.array(history), stopped)


class _Population:
    """One population; history: its best by generation, objective and violation."""

    def __init__(self, population: int, size: int, shrinking: int, chance: np.random.Generator) -> None:
        self.population, self.size, self.shrinking, self.chance = population, size, shrinking, chance
        self.rows = np.arange(population)
        self.x = self.f = self.v = np.empty(0)
        self.history: list[tuple[float, float]] = []
        self.start = self.tolerance = 0.0
        self.order = self.rows

    def spread(self) -> Real:
        """Candidates anew: a Latin square, in which every coordinate is spread evenly."""
        self.history = []
        square = self.chance.permuted(np.tile(self.rows, (self.size, 1)), axis=1).T
        found: Real = (square + self.chance.random(square.shape)) / self.population
        return found

    def take(self, trial: Real, f: Real, v: Real) -> None:
        """Candidates that were evaluated take the places of worse ones."""
        if not self.history:
            self.x, self.f, self.v = trial, f, v
            self.start = float(np.quantile(np.where(v < 10, v, 10.0), 0.2)) if self.shrinking else 0.0
        else:
            won = better(f, v, self.f, self.v, self.tolerance)
            self.x, self.f = np.where(won[:, None], trial, self.x), np.where(won, f, self.f)
            self.v = np.where(won, v, self.v)
        age = len(self.history)
        self.tolerance = self.start * max(0.0, 1 - age / self.shrinking) ** 4 if self.shrinking else 0.0
        allowed = np.where(self.v <= self.tolerance, 0.0, self.v)
        self.order = np.lexsort((np.where(np.isfinite(self.f), self.f, np.inf), allowed))
        best = self.order[0]
        self.history.append((float(self.f[best]), float(self.v[best])))

    @property
    def best(self) -> tuple[Real, Real, Real]:
        first = self.order[:1]
        return self.x[first], self.f[first], self.v[first]

    @property
    def settled(self) -> bool:
        """Whether the best has hardly changed: neither its objective nor what it violates, if that is anything."""
        if len(self.history) <= self.shrinking + PATIENCE:
            return False
        (f0, v0), (f, v) = self.history[-1 - PATIENCE], self.history[-1]
        return abs(f0 - f) <= SLOW * abs(f) and (v0 <= FINE or v0 - v <= SLOW * v0)

    def trial(self) -> Real:
        """Candidates to be evaluated."""
        x, rows, chance, count = self.x, self.rows, self.chance, self.population
        best = x[self.order[chance.integers(0, max(2, int(BEST * count)), count)]]
        a, b = (rows + chance.integers(1, count, count)) % count, chance.permutation(count)
        scale = np.clip(chance.normal(0.6, 0.2, (count, 1)), 0.1, 1.0)
        drawn = chance.random((count, 1)) < 0.7
        base = np.where(drawn, x + scale * (best - x), x[chance.permutation(count)])
        trial = base + scale * (x[a] - x[b])
        keep = chance.random(x.shape) < np.where(chance.random((count, 1)) < 0.5, 0.9, 0.5)
        keep[rows, chance.integers(0, self.size, count)] = True
        trial = np.where(keep, trial, x)
        trial = np.where(trial < 0, x * chance.random(x.shape), trial)
        return np.where(trial > 1, 1 - (1 - x) * chance.random(x.shape), trial)
