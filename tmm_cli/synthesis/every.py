"""All candidates of an optimal synthesis whose parameters have few values: what is best among them is sure."""

from __future__ import annotations

from itertools import product
from math import prod

import numpy as np

from tmm_cli.synthesis.candidates import Search
from tmm_cli.synthesis.evolution import Evolved

MOST = 50_000  # candidates
BLOCK = 500  # between two reports of progress


def every(search: Search) -> Evolved | None:
    """Every candidate, best first; None where a parameter may have all values, or there are too many.

    What cannot be told of many at once, as it must be looked at closely, is told of the first ones later.
    """
    asked = search.asked
    choices = [asked.values[name] for name in asked.low if name in asked.values]
    count = prod(len(own) for own in choices)
    if asked.free or count > MOST:
        return None
    x = search.shares(np.array(list(product(*choices))))
    f, v = np.full(count, np.inf), np.full(count, np.inf)
    history: list[tuple[float, float]] = []
    stopped = False
    try:
        for first in range(0, count, BLOCK):
            asked.progress(first, count)
            some = slice(first, first + BLOCK)
            f[some], v[some] = search.evaluate(x[some])
            best = np.lexsort((np.where(np.isfinite(f), f, np.inf), v))[0]
            history.append((float(f[best]), float(v[best])))
    except KeyboardInterrupt:
        if not history:
            raise
        stopped = True
    finally:
        asked.progress(count, count)
    order = np.lexsort((np.where(np.isfinite(f), f, np.inf), v))
    return Evolved(x[order], f[order], v[order], np.array(history), stopped, every=True)
