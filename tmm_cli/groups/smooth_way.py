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
        if self.cycle is None:
            found = self.places
        else:
            turns = np.arange(np.floor((low - self.start) / self.cycle), np.ceil((high - self.start) / self.cycle) + 1)
            found = np.sort((self.places[:, None] + self.cycle * turns).ravel())
        return found[(found >= low) & (found < high)]

    def _passed(self, q: Real) -> Real:
        """How many there are from the start to places q."""
        within = rounded(q)
        whole = np.zeros(np.shape(q)) if self.cycle is None else np.floor((within - self.start) / self.cycle)
        inside = within - whole * (self.cycle or 0.0)
        passed: Real = whole * len(self.places) + np.searchsorted(self.places, inside)
        return passed
