"""What is asked of balancing: numbers alone, as a problem file gives them; and the shaft with masses in planes.

I. I. Artobolevsky, Theory of Mechanisms and Machines (1988), ch. 13.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tmm_cli.vectors import Real, Vector


@dataclass(frozen=True)
class Place:
    """Where a counterweight sits: on a link, `radius` from a point of it (its axes, m); 0: the radius is not told."""

    link: str
    about: complex
    radius: float = 0.0


@dataclass(frozen=True)
class Plane:
    """A plane across a shaft `at` a place along it, with a mass at a radius (m; 0: its size alone counts)."""

    at: float
    radius: float = 0.0


@dataclass(frozen=True)
class Rotor:
    """Masses on a shaft: mass times radius at an angle (complex, kg m), where along it (m); planes for two others."""

    sizes: Vector
    at: Real
    planes: tuple[Plane, ...]

    def corrections(self) -> Vector:
        """In one plane what leaves no force, in two planes what leaves no couple either (kg m, complex)."""
        force, (first, *more) = -np.sum(self.sizes), self.planes
        if not more:
            return np.array([force])
        second = -np.sum(self.sizes * (self.at - first.at)) / (more[0].at - first.at)
        return np.array([force - second, second])

    def unbalance(self, added: Vector | None = None) -> tuple[complex, complex]:
        """Sum of mass times radius (kg m), and of its moments about the first plane (kg m2): times the square of the
        speed force and couple on the bearings. added: corrections.
        """
        sizes, at = self.sizes, self.at
        if added is not None:
            sizes, at = np.append(sizes, added), np.append(at, [plane.at for plane in self.planes])
        return complex(np.sum(sizes)), complex(np.sum(sizes * (at - self.planes[0].at)))


@dataclass(frozen=True)
class BalancingTask:
    """Counterweights that are sought, and a shaft.

    share: how much the force along the direction `along` counts, the rest of one across it. Of a crank-slider it is the
    share of the reciprocating masses that a counterweight on the crank balances.
    """

    counterweights: tuple[Place, ...] = ()
    share: float = 0.5
    along: complex = 1 + 0j
    rotor: Rotor | None = None
