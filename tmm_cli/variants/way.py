"""The way of the driver in many variants: a cycle of turns, or from one end to the other that each has."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tmm_cli.linkage import Linkage, Request
from tmm_cli.vectors import Real


@dataclass(frozen=True)
class Variant:
    """A linkage, the positions that its file asks for, and where its driver goes.

    ends: from and to (rad or m); None: it turns on and on, and all comes round again.
    """

    linkage: Linkage
    request: Request = field(default_factory=Request)
    ends: tuple[Any, Any] | None = None

    @property
    def accelerated(self) -> bool:
        """Whether its speed depends on where it started."""
        return bool(self.linkage.driver.acceleration) and not self.linkage.others

    @property
    def begins(self) -> bool:
        """Whether position 0 is the start of the working stroke; the file may say a number that varies instead."""
        return isinstance(self.request.start, str) and not self.request.places


Make = Callable[[Sequence[Any]], Variant]


@dataclass(frozen=True)
class Places:
    """Where variants are wanted: at shares of their ways, then at places of the driver (rad or m), the same for all."""

    shares: Real
    driver: Real

    @property
    def count(self) -> int:
        return len(self.shares) + len(self.driver)


@dataclass(frozen=True)
class Way:
    """From low by span, of each variant (variants, 1); closed: the driver turns on, and all comes round again."""

    low: Real
    span: Real
    closed: bool

    @classmethod
    def of(cls, variant: Variant, variants: int, turns: int, start: Any = None) -> Way:
        """turns: of a driver that turns on and on; start: where its law begins, if that counts."""
        ones = np.ones((variants, 1))
        if variant.ends is None:
            sketch, span = variant.linkage.sketch.at, 2 * np.pi * turns
            low = sketch if start is None else start if variant.linkage.driver.sense > 0 else start - span
            return cls(np.reshape(low, (-1, 1)) * ones, span * ones, True)
        low, high = (np.reshape(end, (-1, 1)) * ones for end in variant.ends)
        return cls(low, high - low, False)

    def with_sketch(self, at: float) -> Way:
        """From the sketch round, or between the ends and the sketch: where variants are walked along."""
        if self.closed:
            return Way(np.full_like(self.low, at), self.span, True)
        low, high = np.minimum(self.low, at), np.maximum(self.low + self.span, at)
        return Way(low, high - low, False)

    def at(self, places: Places) -> Real:
        """Places of the driver, (variants, places)."""
        fixed = np.broadcast_to(places.driver, (len(self.low), len(places.driver)))
        return np.concatenate([self.low + places.shares * self.span, fixed], axis=1)
