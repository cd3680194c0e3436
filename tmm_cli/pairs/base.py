"""What a pair asks of its links, as equations: the common form in which groups of any class are solved.

A pair has rows; each is a scalar equation residual = 0 in metres or radians. A small motion of a link, its origin by
dx and its angle by dt, changes a row by c . dx + m dt: (c, m) is the link's part of that row of the Jacobian. The same
parts give velocities, accelerations and, transposed, the forces: a multiplier n on the row pushes the link with n c at
its origin and n m.
Source: J. Garcia de Jalon, E. Bayo, Kinematic and Dynamic Simulation of Multibody Systems, ch. 2 and 3.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from tmm_cli.groups.state import Drives, PairReaction, Poses, Rates
from tmm_cli.linkage import Linkage, Mesh
from tmm_cli.vectors import Real, Vector, cross

JacobianRow = tuple[Any, Any]  # c (complex: x and y) and m (real)


@dataclass(frozen=True)
class Constraint(ABC):
    """One pair (or one driver) of a group."""

    name: str

    kind: ClassVar[str]

    @property
    @abstractmethod
    def links(self) -> tuple[str, ...]:
        """The links in its rows."""

    @property
    @abstractmethod
    def lengths(self) -> tuple[bool, ...]:
        """For each row, whether it is in metres (else in radians)."""

    @abstractmethod
    def residuals(self, poses: Poses, drives: Drives) -> Sequence[Real]:
        """What each row is short of zero."""

    @abstractmethod
    def jacobian_rows(self, poses: Poses) -> Mapping[str, Sequence[JacobianRow]]:
        """For each link its parts of the Jacobian, row by row."""

    @abstractmethod
    def velocity_terms(self, poses: Poses, rates: Rates) -> Sequence[Real]:
        """Second derivative of each row when no link accelerates."""

    def turned(self, link: str, angles: Mapping[str, Any], drives: Drives) -> Any | None:
        """The angle of one of its links (rad) that its first row asks for, from those of the others; None for most."""
        return None

    def asked(self, drives: Drives, order: int) -> Sequence[Real | float]:
        """First or second derivative that each row must have; zero but for drivers."""
        return [0.0] * len(self.lengths)

    def pushes(self, poses: Poses) -> Mapping[str, Sequence[JacobianRow]]:
        """Parts of the rows for the forces, where they are not those of the motion."""
        return self.jacobian_rows(poses)

    @abstractmethod
    def reaction(self, poses: Poses, multipliers: Sequence[Real]) -> PairReaction:
        """The reaction on the pair's second link."""

    def apart(self, poses: Poses, multipliers: Sequence[Real]) -> tuple[Vector, Vector] | None:
        """Point and force (N, on the second link) that follow from the multipliers and do no work; None for most."""
        return None


@dataclass(frozen=True)
class HigherPair(Constraint):
    """One row for links that touch, i and j of the mesh; their carrier gets nothing but through its hinges."""

    mesh: Mesh

    @property
    def links(self) -> tuple[str, ...]:
        return self.mesh.i, self.mesh.j, self.mesh.carrier

    @abstractmethod
    def contact(self, poses: Poses) -> tuple[Vector, Vector]:
        """The point (m) at which i pushes j, and the direction in which a multiplier above zero does."""

    def pushes(self, poses: Poses) -> Mapping[str, Sequence[JacobianRow]]:
        point, along = self.contact(poses)
        i, j = self.mesh.i, self.mesh.j
        return {
            i: ((-along, -cross(point - poses[i].x, along)),),
            j: ((along, cross(point - poses[j].x, along)),),
        }

    def reaction(self, poses: Poses, multipliers: Sequence[Real]) -> PairReaction:
        point, along = self.contact(poses)
        push, apart = along * multipliers[0], self.apart(poses, multipliers)
        return PairReaction(push if apart is None else push + apart[1], at=point)


@dataclass(frozen=True)
class Teeth(HigherPair):
    """They touch in the pitch point, where both links have one velocity, and push j away from the axis of i besides."""

    away: ClassVar[complex]  # where that is from the direction of contact, at a ratio above zero

    def apart(self, poses: Poses, multipliers: Sequence[Real]) -> tuple[Vector, Vector]:
        point, along = self.contact(poses)
        away = self.away * along * np.sign(self.mesh.ratio)
        return point, away * np.abs(multipliers[0]) * np.tan(self.mesh.pressure)


def axis(linkage: Linkage, wheel: str, carrier: str) -> complex:
    """Where a wheel or cam is hinged to its carrier, in the carrier's axes (m)."""
    point = linkage.shared(carrier, wheel)
    assert point is not None
    return linkage.local(carrier, point)
