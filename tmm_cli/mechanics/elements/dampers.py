"""Dampers: their force or moment opposes the relative motion of two points or of two links."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from tmm_cli.mechanics.elements.element import LoadElement, Stretch
from tmm_cli.mechanics.numerics import Real


@dataclass(frozen=True)
class Damper(LoadElement):
    """A damper between two links: its pull is linear v + quadratic v |v|, where v is the rate of change of its length.

    A torsional one has the angular velocity of link j relative to link i instead of v.

    Attributes:
        linear: damping coefficient (N s/m, or N m s/rad).
        quadratic: coefficient of the square of the speed (N s2/m2, or N m s2/rad2).
    """

    block: ClassVar[str] = "dampers"
    dissipates: ClassVar[bool] = True

    linear: float = 0.0
    quadratic: float = 0.0

    @property
    def speed_key(self) -> str | None:
        """The damper itself depends on speed; see LoadElement."""
        return ""

    def pull(self, stretch: Stretch) -> Real:
        """Return the force (N) or moment (N m) of the damper; see LoadElement."""
        pull: Real = self.linear * stretch.rate + self.quadratic * stretch.rate * np.abs(stretch.rate)
        return pull
