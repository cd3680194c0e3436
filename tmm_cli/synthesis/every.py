"""All candidates of an optimal synthesis whose parameters have few values."""

from __future__ import annotations

from itertools import product
from math import prod

import numpy as np

from tmm_cli.synthesis.candidates import Search
from tmm_cli.synthesis.evolution import Evolved
from tmm_cli.vectors import Real

MOST = 50_000  # candidates
BLOCK = 500  # between two reports of progress
CLOSELY = 400  # that are looked at closely, at most
SLACK = 0.02  # of the best objective: by so much a coarse one may be too large
MISSED = 1e-7  # by less of its scale a constraint is kept


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
    return Evolved(x[order], f[order], v[order], np.stack([f, v], axis=1), stopped, each=True)


def shortlist(search: Search, evolved: Evolved, most: int) -> list[Real]:
    """The best of them when they are looked at closely: all whose objective at the positions of the search is not
    larger than the best one found so, which from a few positions is told too small, or little too large.
    """
    found: list[tuple[float, float, int]] = []
    best = np.inf
    for n in range(min(CLOSELY, len(evolved.population))):
        if evolved.objective[n] > best + SLACK * abs(best):
            break
        values = search.exactly(evolved.population[n])
        missed = float(sum(limit.missed(y) for limit, y in zip(search.limits, values[1:], strict=True)))
        wanted = float(search.wanted(np.array(values[0])))
        if np.isnan(missed + wanted):
            continue
        found.append((missed if missed > MISSED else 0.0, wanted, n))
        if found[-1][0] == 0.0:
            best = min(best, wanted)
    return [evolved.population[n] for *_, n in sorted(found)[:most]]
