"""Which sign the determinant of a group of two assemblies has, where it goes smoothly through exact change points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tmm_cli.double_double import rounded
from tmm_cli.vectors import Real


@dataclass(frozen=True)
class SmoothWay:
    """Growing places of the driver at which the sign of a group's determinant changes, within a `cycle` that begins at
    `start` and is repeated (None: it is not); at the place `at` the sign is that of the sketch.
    """

    places: Real
    start: float
    at: float
    cycle: float | None

    def side(self, q: Real) -> Real:
        """1, or -1 where the group has passed an odd number of them from the sketch on."""
        return 1.0 - 2.0 * ((self._passed(q) - self._passed(np.array(self.at))) % 2)

    def within(self, low: float, high: float) -> Real:
        """Those from one place to another, in growing order."""
        return again(self.places, self.start, self.cycle, low, high)

    def _passed(self, q: Real) -> Real:
        """How many there are from the start to places q."""
        within = rounded(q)
        whole = np.zeros(np.shape(q)) if self.cycle is None else np.floor((within - self.start) / self.cycle)
        inside = within - whole * (self.cycle or 0.0)
        passed: Real = whole * len(self.places) + np.searchsorted(self.places, inside)
        return passed


def again(places: Real, start: float, cycle: float | None, low: float, high: float) -> Real:
    """Places of a cycle that begins at `start`, as often as they come between two others; None: they come once."""
    turns = np.zeros(1)
    if cycle is not None:
        turns = np.arange(np.floor((low - start) / cycle) - 1, np.ceil((high - start) / cycle) + 1)
    found = np.sort((places[:, None] + (cycle or 0.0) * turns).ravel())
    return found[(found >= low) & (found < high)]
