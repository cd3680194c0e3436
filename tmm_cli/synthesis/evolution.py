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
SHRINKING = 0.6  # of the generations, over which the tolerance goes to zero
BEST = 0.15  # share of the population that draws the others
ALIKE = 1e-7  # the population has gathered


@dataclass(frozen=True)
class Evolved:
    """population (variants, n), best first, with objective and violation; history: of the best, by generation.

    stopped: by hand, before its end.
    """

    population: Real
    objective: Real
    violation: Real
    history: Real
    stopped: bool


def better(f: Real, v: Real, than_f: Real, than_v: Real, tolerance: float) -> Real:
    """Deb's rules: less violation, or both allowed (or alike) and a smaller objective."""
    a, b = np.where(v <= tolerance, 0.0, v), np.where(than_v <= tolerance, 0.0, than_v)
    found: Real = (a < b) | ((a == b) & (f <= than_f))
    return found


def evolve(
    evaluate: Evaluate, size: int, *, population: int, generations: int, seed: int,
    progress: Callable[[int, int], None] = lambda at, of: None,
) -> Evolved:  # fmt: skip
    """Search 0..1 in `size` dimensions; the same seed gives the same answer."""
    chance = np.random.default_rng(seed)
    x = chance.permuted(np.tile(np.arange(population), (size, 1)), axis=1).T + chance.random((population, size))
    x = x / population  # a Latin square: every coordinate is spread evenly
    f, v = evaluate(x)
    tolerance0 = float(np.quantile(np.where(v < 10, v, 10.0), 0.2))
    history, stopped, rows = [], False, np.arange(population)
    try:
        for generation in range(generations):
            progress(generation, generations)
            left = max(0.0, 1 - generation / (SHRINKING * generations))
            tolerance = tolerance0 * left**4
            order = np.lexsort((np.where(np.isfinite(f), f, np.inf), np.where(v <= tolerance, 0.0, v)))
            history.append((f[order[0]], v[order[0]]))
            if v[order[0]] == 0 and left == 0 and np.ptp(x, axis=0).max() < ALIKE:
                break
            best = x[order[chance.integers(0, max(2, int(BEST * population)), population)]]
            a, b = (rows + chance.integers(1, population, population)) % population, chance.permutation(population)
            scale = np.clip(chance.normal(0.6, 0.2, (population, 1)), 0.1, 1.0)
            drawn = chance.random((population, 1)) < 0.7
            base = np.where(drawn, x + scale * (best - x), x[chance.permutation(population)])
            trial = base + scale * (x[a] - x[b])
            keep = chance.random((population, size)) < np.where(chance.random((population, 1)) < 0.5, 0.9, 0.5)
            keep[rows, chance.integers(0, size, population)] = True
            trial = np.where(keep, trial, x)
            trial = np.where(trial < 0, x * chance.random(x.shape), trial)
            trial = np.where(trial > 1, 1 - (1 - x) * chance.random(x.shape), trial)
            new_f, new_v = evaluate(trial)
            won = better(new_f, new_v, f, v, tolerance)
            x, f, v = np.where(won[:, None], trial, x), np.where(won, new_f, f), np.where(won, new_v, v)
    except KeyboardInterrupt:
        stopped = True
    finally:
        progress(generations, generations)
    order = np.lexsort((np.where(np.isfinite(f), f, np.inf), v))
    return Evolved(x[order], f[order], v[order], np.array(history or [(f[order[0]], v[order[0]])]), stopped)
