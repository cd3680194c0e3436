"""Optimal synthesis: what is asked."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tmm_cli.synthesis.optimal.quantities.base import Goal
from tmm_cli.variants.variant import Make
from tmm_cli.vectors import Real

Keys = tuple[str | int, ...]  # of the block, down to what stands there


@dataclass(frozen=True)
class Parameter:
    """What varies (SI), and its dimension; values: all that it may have, rising, where these are some only."""

    name: str
    low: float
    high: float
    kind: str
    values: tuple[float, ...] = ()


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

    def rows(self, low: Any, high: Any) -> tuple[list[Any], list[Any]]:
        """What must not be below zero, and what must be zero, in shares of the scale; low, high: what its bounds are
        compared with.
        """
        if self.equal:
            return [], [(low - self.least) / self.scale]
        least = [] if self.least is None else [(low - self.least) / self.scale]
        return [*least, *([] if self.most is None else [(self.most - high) / self.scale])], []

    def broken(self, value: float) -> tuple[float, Keys]:
        """The bound that a value lies beyond, and where it stands."""
        low = self.least is not None and value < self.least
        bound = self.least if low else self.most
        assert bound is not None
        both = not self.equal and self.least is not None and self.most is not None
        return bound, (*self.at[:-1], "least" if low else "most") if both else self.at


@dataclass(frozen=True)
class Task:
    """make: the linkage for numbers of the parameters (SI), with its driver range. target: the objective is to come
    near to this. positions: round the cycle, in the search. accepts: whether the file takes such numbers. population,
    generations: 0 for as many as the number of parameters wants.
    """

    parameters: tuple[Parameter, ...]
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

    @property
    def free(self) -> list[int]:
        """Which parameters may have all values within their bounds."""
        return [k for k, parameter in enumerate(self.parameters) if not parameter.values]

    def with_one(self, first: Sequence[float], k: int, numbers: Sequence[float]) -> list[list[float]]:
        """First numbers with others for parameter k, those that the file takes."""
        tried = ([*first[:k], float(number), *first[k + 1 :]] for number in numbers)
        return [one for one in tried if self.accepts(one)]


def near(numbers: Any, parameters: Sequence[Parameter]) -> Real:
    """The nearest numbers (..., n) that parameters may have."""
    found = np.array(numbers, dtype=float)
    for k, parameter in enumerate(parameters):
        if parameter.values:
            own = np.array(parameter.values)
            found[..., k] = own[np.searchsorted((own[1:] + own[:-1]) / 2, found[..., k])]
    return found
