"""Optimal synthesis: what is asked."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tmm_cli.synthesis.goals import LEAST, Goal
from tmm_cli.variants.way import Make


@dataclass(frozen=True)
class Limit:
    """A constraint: least <= goal <= most (SI); equal where they are the same. at: its place among those asked for."""

    goal: Goal
    least: float | None = None
    most: float | None = None
    at: tuple[str | int, ...] = ()

    @property
    def equal(self) -> bool:
        return self.least is not None and self.least == self.most

    @property
    def scale(self) -> float:
        """What a miss is measured against."""
        if self.goal.of in LEAST:
            return 1.0
        return max(abs(self.least or 0.0), abs(self.most or 0.0)) or 1.0

    def missed(self, value: Any) -> Any:
        """By how much, in shares of the scale; 0 where it is kept, inf where there is no such quantity."""
        low = 0.0 if self.least is None else self.least - value
        high = 0.0 if self.most is None else value - self.most
        missed = np.maximum(np.maximum(low, high), 0.0) / self.scale
        return np.where(np.isnan(missed), np.inf, missed)

    def margin(self, value: float) -> float:
        """How far the value is from its nearer limit, in its unit."""
        above = np.inf if self.least is None else value - self.least
        return float(min(above, np.inf if self.most is None else self.most - value))


@dataclass(frozen=True)
class Asked:
    """low, high: bounds of what varies, by name (SI); kinds: their dimensions; make: the linkage for numbers in that
    order, with its way. target: the objective is to come near to this. positions: round the cycle, in the search.
    accepts: whether the file takes such numbers. population, generations: 0 for as many as the number of parameters
    wants.
    """

    low: dict[str, float]
    high: dict[str, float]
    kinds: dict[str, str]
    make: Make = field(compare=False)
    objective: Goal
    limits: tuple[Limit, ...] = ()
    target: float | None = None
    positions: int = 72
    population: int = 0
    generations: int = 0
    seed: int = 1
    accepts: Callable[[Sequence[float]], bool] = field(default=lambda numbers: True, compare=False)
    progress: Callable[[int, int], None] = field(default=lambda at, of: None, compare=False)
