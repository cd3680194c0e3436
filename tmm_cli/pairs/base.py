"""What a pair asks of its links, as equations: the common form in which groups of any class are solved.

A pair has rows; each is a scalar equation gap = 0 in metres or radians. A small motion of a link, its origin by dx and
its angle by dt, changes a row by c . dx + m dt: (c, m) is the row's grip on that link. The same grips give velocities,
accelerations and, transposed, the forces: a multiplier n on the row pushes the link with n c at its origin and n m.
Source: J. Garcia de Jalon, E. Bayo, Kinematic and Dynamic Simulation of Multibody Systems, ch. 2 and 3.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from tmm_cli.groups.state import Drives, Held, Pose, Rate
from tmm_cli.vectors import Real, Vector

if TYPE_CHECKING:
    from tmm_cli.linkage import Linkage
    from tmm_cli.structure.assur import Pair

Grip = tuple[Any, Any]  # c (complex: x and y) and m (real)
Poses = Mapping[str, Pose]
Rates = Mapping[str, Rate]


@dataclass(frozen=True)
class Constraint(ABC):
    """One pair (or one driver) of a group."""

    name: str

    kind: ClassVar[str]

    @classmethod
    @abstractmethod
    def of(cls, pair: Pair, linkage: Linkage) -> Constraint:
        """The pair with its numbers."""

    @property
    @abstractmethod
    def links(self) -> tuple[str, ...]:
        """The links that it grips."""

    @property
    @abstractmethod
    def lengths(self) -> tuple[bool, ...]:
        """For each row, whether it is in metres (else in radians)."""

    @abstractmethod
    def gaps(self, poses: Poses, drives: Drives) -> Sequence[Real]:
        """What each row is short of zero."""

    @abstractmethod
    def grips(self, poses: Poses) -> Mapping[str, Sequence[Grip]]:
        """For each link its grips, row by row."""

    @abstractmethod
    def bends(self, poses: Poses, rates: Rates) -> Sequence[Real]:
        """Second derivative of each row when no link accelerates."""

    def asked(self, drives: Drives, order: int) -> Sequence[Real | float]:
        """First or second derivative that each row must have; zero but for drivers."""
        return [0.0] * len(self.lengths)

    def pushes(self, poses: Poses) -> Mapping[str, Sequence[Grip]]:
        """Grips of the forces, where they are not those of the motion."""
        return self.grips(poses)

    @abstractmethod
    def held(self, poses: Poses, multipliers: Sequence[Real]) -> Held:
        """The reaction on the pair's second link."""

    def apart(self, poses: Poses, multipliers: Sequence[Real]) -> tuple[Vector, Vector] | None:
        """Point and force (N, on the second link) that follow from the multipliers and do no work; None for most."""
        return None
