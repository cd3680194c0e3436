"""How large a flywheel is: a disk, or a rim whose spokes and hub are left out. A new form is a class here.

J = m D^2 / 8 of a disk, m D^2 / 4 of a rim of mean diameter D: I. I. Artobolevsky, Theory of Mechanisms and Machines
(1988), ch. 19.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar, Literal


@dataclass(frozen=True)
class Disk:
    """density: kg/m3; width over diameter. height is of rims alone."""

    shape: ClassVar[Literal["disk", "rim"]] = "disk"
    density: float
    width: float
    height: float = 0.0

    def diameter(self, inertia: float) -> float:
        """m, of a disk of this inertia (kg m2)."""
        return float((32 * inertia / (math.pi * self.density * self.width)) ** 0.2)

    def mass(self, diameter: float) -> float:
        """kg."""
        return math.pi / 4 * self.density * self.width * diameter**3


@dataclass(frozen=True)
class Rim:
    """density: kg/m3; width and height of its section over its mean diameter."""

    shape: ClassVar[Literal["disk", "rim"]] = "rim"
    density: float
    width: float
    height: float

    def diameter(self, inertia: float) -> float:
        """Mean diameter, m, of a rim of this inertia (kg m2)."""
        return float((4 * inertia / (math.pi * self.density * self.width * self.height)) ** 0.2)

    def mass(self, diameter: float) -> float:
        """kg."""
        return math.pi * self.density * self.width * self.height * diameter**3


Size = Disk | Rim
