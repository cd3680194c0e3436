"""Optimal synthesis: what is asked."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from tmm_cli.synthesis.goals import LEAST, Goal
from tmm_cli.variants.way import Make
from tmm_cli.vectors import Real

Path = tuple[str | int, ...]


@dataclass(frozen=True)
class Limit:
    """A constraint: least <= goal <= most (SI); equal where they are the same. at: its place among those asked for."""

    goal: Goal
    least: float | None = None
    most: float | None = None
    at: Path = ()

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

    def passed(self, value: float) -> float:
        """The bound that a value beyond one of them lies beyond."""
        bound = self.least if self.least is not None and value < self.least else self.most
        assert bound is not None
        return bound

    def key(self, bound: float | None) -> Path:
        """Where a bound of it stands."""
        both = not self.equal and self.least is not None and self.most is not None
        return (*self.at[:-1], "least" if bound == self.least else "most") if both else self.at

    def widened(self, value: float) -> Limit:
        """The same with bounds just so wide that such a value keeps it."""
        if self.equal:
            return replace(self, least=value, most=value)
        least, most = self.least, self.most
        return replace(
            self, least=least if least is None else min(least, value), most=most if most is None else max(most, value)
        )

    def margin(self, value: float) -> float:
        """How far the value is from its nearer limit, in its unit."""
        above = np.inf if self.least is None else value - self.least
        return float(min(above, np.inf if self.most is None else self.most - value))


@dataclass(frozen=True)
class Asked:
    """low, high: bounds of what varies, by name (SI); kinds: their dimensions; make: the linkage for numbers in that
    order, with its way. target: the objective is to come near to this. positions: round the cycle, in the search.
    accepts: whether the file takes such numbers. population, generations: 0 for as many as the number of parameters
    wants. values: of those that have some only; at: the keys of the bounds in the file.
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
    values: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    at: Mapping[str, tuple[Path, Path]] = field(default_factory=dict)

    def near(self, numbers: Any) -> Real:
        """The nearest numbers that the parameters may have, (..., n)."""
        return near(numbers, self.values, self.low)

    def beside(self, name: str, number: float) -> float:
        """Another of the values that a parameter may have; nan where it may have all within its bounds."""
        return next((value for value in self.values.get(name, ()) if value != number), np.nan)

    def reverses(self, first: Sequence[float]) -> bool:
        """Whether a driver goes forth in some candidates and back in others: its sense is no number of arrays."""
        senses = set()
        for k, name in enumerate(self.low):
            for end in (self.low[name], self.high[name]):
                numbers = [*first[:k], end, *first[k + 1 :]]
                if self.accepts(numbers):
                    linkage = self.make(numbers).linkage
                    senses.add(tuple(driver.sense for driver in (linkage.driver, *linkage.others)))
        return len(senses) > 1

    @property
    def free(self) -> list[int]:
        """Which of them may have all values within their bounds."""
        return [k for k, name in enumerate(self.low) if name not in self.values]

    def bound(self, name: str, above: bool) -> Path:
        """Where a bound stands in what is asked."""
        return self.at[name][above] if name in self.at else ("vary", name, int(above))


def near(numbers: Any, values: Mapping[str, tuple[float, ...]], names: Iterable[str]) -> Real:
    """The nearest numbers (..., n) of parameters, some of which may have certain values only."""
    found = np.array(numbers, dtype=float)
    for k, name in enumerate(names):
        if name in values:
            own = np.array(values[name])
            found[..., k] = own[np.searchsorted((own[1:] + own[:-1]) / 2, found[..., k])]
    return found
