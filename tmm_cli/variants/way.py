"""The way of the driver in many variants: a cycle of turns, or the stroke that each has."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tmm_cli.linkage import Linkage
from tmm_cli.vectors import Real


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
    def of(cls, linkage: Linkage, variants: int, turns: int) -> Way:
        """turns: of a driver that has no stroke."""
        ones = np.ones((variants, 1))
        stroke = linkage.driver.stroke
        if stroke is None:
            return cls(linkage.sketch.at * ones, 2 * np.pi * turns * ones, True)
        low, high = (np.reshape(end, (-1, 1)) * ones for end in stroke)
        return cls(low, high - low, False)

    def at(self, places: Places) -> Real:
        """Places of the driver, (variants, places)."""
        fixed = np.broadcast_to(places.driver, (len(self.low), len(places.driver)))
        return np.concatenate([self.low + places.shares * self.span, fixed], axis=1)
