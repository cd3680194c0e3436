"""Optimal synthesis: what is asked."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tmm_cli.synthesis.optimal.quantities.base import Goal
from tmm_cli.variants.variant import Make
from tmm_cli.vectors import Real

Keys = tuple[str | int, ...]  # of the block, down to what stands there


@dataclass(frozen=True)
class Constraint:
    """least <= quantity <= most (SI); equal where they are the same. at: its place among those asked for."""

    quantity: Goal
    least: float | None = None
    most: float | None = None
    at: Keys = ()

    @property
    def equal(self) -> bool:
        return self.least is not None and self.least == self.most

    @property
    def scale(self) -> float:
        """What a miss is measured against."""
        if self.quantity.lowest:
            return 1.0
        return max(abs(self.least or 0.0), abs(self.most or 0.0)) or 1.0

    def missed(self, value: Any) -> Any:
        """By how much, in shares of the scale; 0 where it is kept, inf where there is no such quantity."""
        low = 0.0 if self.least is None else self.least - value
        high = 0.0 if self.most is None else value - self.most
        missed = np.maximum(np.maximum(low, high), 0.0) / self.scale
        return np.where(np.isnan(missed), np.inf, missed)

    def passed(self, value: float) -> float:
        """The bound that a value beyond one of them lies beyond."""
        bound = self.least if self.least is not None and value < self.least else self.most
        assert bound is not None
        return bound

    def key(self, bound: float) -> Keys:
        """Where a bound of it stands."""
        both = not self.equal and self.least is not None and self.most is not None
        return (*self.at[:-1], "least" if bound == self.least else "most") if both else self.at


@dataclass(frozen=True)
class Task:
    """low, high: bounds of what varies, by name (SI); kinds: their dimensions; make: the linkage for numbers in that
    order, with its driver range. target: the objective is to come near to this. positions: round the cycle, in the
    search. accepts: whether the file takes such numbers. population, generations: 0 for as many as the number of
    parameters wants. values: of those that have some only.
    """

    low: dict[str, float]
    high: dict[str, float]
    kinds: dict[str, str]
    make: Make = field(compare=False)
    objective: Goal
    constraints: tuple[Constraint, ...] = ()
    target: float | None = None
    positions: int = 72
    population: int = 0
    generations: int = 0
    seed: int = 1
    accepts: Callable[[Sequence[float]], bool] = field(default=lambda numbers: True, compare=False)
    progress: Callable[[int, int], None] = field(default=lambda at, of: None, compare=False)
    values: Mapping[str, tuple[float, ...]] = field(default_factory=dict)

    def near(self, numbers: Any) -> Real:
        """The nearest numbers that the parameters may have, (..., n)."""
        return near(numbers, self.values, list(self.low))

    def one_sense(self, first: Sequence[float]) -> bool:
        """Whether no driver goes forth in some candidates and back in others."""
        senses = set()
        for k, name in enumerate(self.low):
            for end in (self.low[name], self.high[name]):
                numbers = [*first[:k], end, *first[k + 1 :]]
                if self.accepts(numbers):
                    linkage = self.make(numbers).linkage
                    senses.add(tuple(driver.sense for driver in (linkage.driver, *linkage.others)))
        return len(senses) <= 1

    @property
    def free(self) -> list[int]:
        """Which of them may have all values within their bounds."""
        return [k for k, name in enumerate(self.low) if name not in self.values]


def near(numbers: Any, values: Mapping[str, tuple[float, ...]], names: Sequence[str]) -> Real:
    """The nearest numbers (..., n) of parameters, some of which may have certain values only."""
    found = np.array(numbers, dtype=float)
    for k, name in enumerate(names):
        if name in values:
            own = np.array(values[name])
            found[..., k] = own[np.searchsorted((own[1:] + own[:-1]) / 2, found[..., k])]
    return found
