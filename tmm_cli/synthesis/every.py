"""All candidates of an optimal synthesis whose parameters have few values: coarsely, then the foremost closely."""

from __future__ import annotations

from dataclasses import replace
from itertools import product
from math import prod

import numpy as np

from tmm_cli.synthesis.candidates import Search
from tmm_cli.synthesis.evolution import Evolved
from tmm_cli.vectors import Real

MOST = 50_000  # candidates
BLOCK = 500  # between two reports of progress
LEVELS = ((0, 2e-2, 400), (720, 5e-4, 30))  # positions round the cycle, the errors that they leave, how many go on


def every(search: Search) -> Evolved | None:
    """Every candidate, best first; None where a parameter may have all values, or there are too many."""
    asked = search.asked
    choices = [asked.values[name] for name in asked.low if name in asked.values]
    count = prod(len(own) for own in choices)
    if asked.free or count > MOST:
        return None
    x = search.shares(np.array(list(product(*choices))))
    f, v = np.zeros(0), np.zeros(0)
    stopped = False
    try:
        for first in range(0, count, BLOCK):
            asked.progress(first, count)
            more = search.evaluate(x[first : first + BLOCK])
            f, v = np.append(f, more[0]), np.append(v, more[1])
    except KeyboardInterrupt:
        if not len(f):
            raise
        stopped = True
    finally:
        asked.progress(count, count)
    order = np.lexsort((np.where(np.isfinite(f), f, np.inf), v))
    return Evolved(x[order], f[order], v[order], np.stack([f, v], axis=1), stopped, every=True)


def foremost(search: Search, found: Evolved) -> Real:
    """Candidates (variants, n) among which the best one is: those that places of the search cannot tell from it.

    Between the places peaks are higher, so that what keeps a constraint there may miss it, and the other way round.
    """
    x, f, v = found.population, found.objective, found.violation
    for positions, error, most in LEVELS:
        if positions:
            closer = replace(search.asked, positions=max(positions, search.asked.positions))
            f, v = Search(closer, search.first).evaluate(x)
        sure = f[(v == 0) & np.isfinite(f)]
        scale = 1.0 if search.asked.target is not None else abs(float(np.min(sure, initial=np.inf)))
        near = f <= np.min(sure) + 2 * error * scale if sure.size else np.ones(len(f), dtype=bool)
        likely = np.flatnonzero(near & (v <= error))
        likely = likely[np.argsort(f[likely])][:most]
        first = np.lexsort((np.where(np.isfinite(f), f, np.inf), v))[: most if not sure.size else 3]
        x = x[np.unique(np.append(likely, first))]
    return x
