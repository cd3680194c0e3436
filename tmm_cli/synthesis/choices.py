"""The best candidate of each choice, where some parameters have few values and others all within their bounds.

Evolution gathers about one choice early, and another may lead farther once the others' numbers are polished.
"""

from __future__ import annotations

import numpy as np

from tmm_cli.synthesis.candidates import Search
from tmm_cli.variants.taped import Taped
from tmm_cli.vectors import Real

MOST, FEW = 24, 6  # choices that are polished: where candidates move by their tape, and where they are slower
NEAR = 0.3  # a violation that the polish may take away


class Choices:
    """Called as search.evaluate is; keeps the best candidate of each choice that it has seen."""

    def __init__(self, search: Search) -> None:
        self.search = search
        self.chosen = [k for k in range(len(search.low)) if k not in search.asked.free]
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
        half = (MOST if isinstance(self.search.program, Taped) else FEW) // 2
        found = sorted(self.best.values(), key=lambda one: one[:2])
        least = sorted((one for one in found[half:] if one[0] < NEAR), key=lambda one: one[1])
        some = [*found[:half], *least[:half]]
        return [self.search.shares(self.search.numbers(x)) for _, objective, x in some if np.isfinite(objective)]
