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

from tmm_cli.mechanics.groups.state import DriverStates, PairReaction, Poses, Rates
from tmm_cli.mechanics.linkage import Driver, Linkage, Mesh, Slide
from tmm_cli.mechanics.numerics import Real, Vector, cross, dot, unit
from tmm_cli.mechanics.structure import Pair

JacobianRow = tuple[Any, Any]  # c (complex: x and y) and m (real)


@dataclass(frozen=True)
class PairConstraint(ABC):
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
    def residuals(self, poses: Poses, drives: DriverStates) -> Sequence[Real]:
        """What each row is short of zero."""

    @abstractmethod
    def jacobian_rows(self, poses: Poses) -> Mapping[str, Sequence[JacobianRow]]:
        """For each link its parts of the Jacobian, row by row."""

    @abstractmethod
    def velocity_terms(self, poses: Poses, rates: Rates) -> Sequence[Real]:
        """Second derivative of each row when no link accelerates."""

    def turned(self, link: str, angles: Mapping[str, Any], drives: DriverStates) -> Any | None:
        """The angle of one of its links (rad) that its first row asks for, from those of the others; None for most."""
        return None

    def asked(self, drives: DriverStates, order: int) -> Sequence[Real | float]:
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
class HigherPairConstraint(PairConstraint):
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
class ToothConstraint(HigherPairConstraint):
    """They touch in the pitch point, where both links have one velocity, and push j away from the axis of i besides."""

    away: ClassVar[complex]  # where that is from the direction of contact, at a ratio above zero

    def apart(self, poses: Poses, multipliers: Sequence[Real]) -> tuple[Vector, Vector]:
        point, along = self.contact(poses)
        away = self.away * along * np.sign(self.mesh.ratio)
        return point, away * np.abs(multipliers[0]) * np.tan(self.mesh.pressure)


def carrier_axis(linkage: Linkage, wheel: str, carrier: str) -> complex:
    """Where a wheel or cam is hinged to its carrier, in the carrier's axes (m)."""
    point = linkage.shared(carrier, wheel)
    assert point is not None
    return linkage.local(carrier, point)


# A hinge: a point of one link stays on a point of another.


@dataclass(frozen=True)
class HingeConstraint(PairConstraint):
    """Rows: x and y of the point of j less that of i."""

    i: str
    j: str
    at_i: complex
    at_j: complex

    kind = "R"

    @classmethod
    def of(cls, pair: Pair, linkage: Linkage) -> HingeConstraint:
        return cls(pair.name, pair.i, pair.j, linkage.local(pair.i, pair.point), linkage.local(pair.j, pair.point))

    @property
    def links(self) -> tuple[str, ...]:
        return self.i, self.j

    @property
    def lengths(self) -> tuple[bool, ...]:
        return True, True

    def _arms(self, poses: Poses) -> tuple[Vector, Vector]:
        return self.at_i * poses[self.i].z, self.at_j * poses[self.j].z

    def residuals(self, poses: Poses, drives: DriverStates) -> Sequence[Real]:
        arm_i, arm_j = self._arms(poses)
        residual = (poses[self.j].x - poses[self.i].x) + (arm_j - arm_i)
        return residual.real, residual.imag

    def jacobian_rows(self, poses: Poses) -> Mapping[str, Sequence[JacobianRow]]:
        arm_i, arm_j = self._arms(poses)
        return {
            self.i: ((-1.0 + 0j, arm_i.imag), (-1j, -arm_i.real)),
            self.j: ((1.0 + 0j, -arm_j.imag), (1j, arm_j.real)),
        }

    def velocity_terms(self, poses: Poses, rates: Rates) -> Sequence[Real]:
        arm_i, arm_j = self._arms(poses)
        bend = arm_i * rates[self.i].w ** 2 - arm_j * rates[self.j].w ** 2
        return bend.real, bend.imag

    def reaction(self, poses: Poses, multipliers: Sequence[Real]) -> PairReaction:
        return PairReaction(multipliers[0] + 1j * multipliers[1])


# A sliding pair: a point of the runner stays on a guide of the carrier, and their axes keep one angle.


@dataclass(frozen=True)
class GuideGeometry:
    """The geometry of a sliding pair at some poses: the guide's direction u and the running point from both origins."""

    u: Vector
    off: Vector  # from the guide's `through` point to the running point
    on_carrier: Vector  # running point from the carrier's origin
    on_runner: Vector

    @classmethod
    def at(cls, slide: Slide, poses: Poses) -> GuideGeometry:
        carrier, runner = poses[slide.carrier], poses[slide.runner]
        on_runner = slide.at * runner.z
        on_carrier = (runner.x - carrier.x) + on_runner
        return cls(carrier.z * unit(slide.direction), on_carrier - slide.through * carrier.z, on_carrier, on_runner)

    def jacobian_rows(self, slide: Slide, along: Vector) -> Mapping[str, JacobianRow]:
        """Of the running point's motion against the carrier, counted along a direction that the carrier carries."""
        return {
            slide.carrier: (-along, -cross(self.on_carrier, along)),
            slide.runner: (along, cross(self.on_runner, along)),
        }

    def bend(self, slide: Slide, rates: Rates) -> Vector:
        """Acceleration of the running point against the carrier when no link accelerates, without Coriolis."""
        bend: Vector = self.on_carrier * rates[slide.carrier].w ** 2 - self.on_runner * rates[slide.runner].w ** 2
        return bend

    def sliding(self, slide: Slide, rates: Rates) -> Real:
        """Speed of the running point along the guide."""
        speed: Real = dot(self.u, rates[slide.runner].at(self.on_runner) - rates[slide.carrier].at(self.on_carrier))
        return speed


@dataclass(frozen=True)
class SlideConstraint(PairConstraint):
    """Rows: angle of the runner from the carrier, distance of the running point from the guide."""

    slide: Slide

    kind = "P"

    @classmethod
    def of(cls, pair: Pair, linkage: Linkage) -> SlideConstraint:
        assert pair.slide is not None
        return cls(pair.name, pair.slide)

    @property
    def links(self) -> tuple[str, ...]:
        return self.slide.carrier, self.slide.runner

    @property
    def lengths(self) -> tuple[bool, ...]:
        return False, True

    def residuals(self, poses: Poses, drives: DriverStates) -> Sequence[Real]:
        here = GuideGeometry.at(self.slide, poses)
        turned = poses[self.slide.runner].z * np.conj(poses[self.slide.carrier].z * unit(self.slide.turned))
        return np.arctan2(turned.imag, turned.real), cross(here.u, here.off)

    def jacobian_rows(self, poses: Poses) -> Mapping[str, Sequence[JacobianRow]]:
        here = GuideGeometry.at(self.slide, poses)
        across = here.jacobian_rows(self.slide, 1j * here.u)
        return {
            self.slide.carrier: ((0j, -1.0), across[self.slide.carrier]),
            self.slide.runner: ((0j, 1.0), across[self.slide.runner]),
        }

    def turned(self, link: str, angles: Mapping[str, Any], drives: DriverStates) -> Any:
        if link == self.slide.runner:
            return angles[self.slide.carrier] + self.slide.turned
        return angles[self.slide.runner] - self.slide.turned

    def velocity_terms(self, poses: Poses, rates: Rates) -> Sequence[Real]:
        here = GuideGeometry.at(self.slide, poses)
        coriolis = 2 * rates[self.slide.carrier].w * here.sliding(self.slide, rates)
        return np.zeros(np.shape(coriolis)), cross(here.u, here.bend(self.slide, rates)) - coriolis

    def reaction(self, poses: Poses, multipliers: Sequence[Real]) -> PairReaction:
        here = GuideGeometry.at(self.slide, poses)
        return PairReaction(1j * here.u * multipliers[1], multipliers[0])


# A driver between two moving links, as one more row of their group: a cylinder, or a drive in a hinge.


@dataclass(frozen=True)
class DriverConstraint(PairConstraint):
    """Row: angle of the driven link from its base, or run in their sliding pair, less the driver's place."""

    driver: Driver
    slide: Slide | None

    kind = "D"

    @classmethod
    def of(cls, driver: Driver, linkage: Linkage) -> DriverConstraint:
        """The row of a driver."""
        return cls(driver.link, driver, linkage.slide(driver.joint) if driver.kind == "slide" else None)

    @property
    def links(self) -> tuple[str, ...]:
        return (self.driver.base, self.driver.link) if self.slide is None else (self.slide.carrier, self.slide.runner)

    @property
    def lengths(self) -> tuple[bool, ...]:
        return (self.slide is not None,)

    def residuals(self, poses: Poses, drives: DriverStates) -> Sequence[Real]:
        want = drives[self.driver.link].value
        if self.slide is None:
            turned = poses[self.driver.link].z * np.conj(poses[self.driver.base].z)
            residual = turned * unit(-want)
            return (np.arctan2(residual.imag, residual.real),)
        here = GuideGeometry.at(self.slide, poses)
        return (dot(here.u, here.off) - want,)

    def jacobian_rows(self, poses: Poses) -> Mapping[str, Sequence[JacobianRow]]:
        if self.slide is None:
            return {self.driver.base: ((0j, -1.0),), self.driver.link: ((0j, 1.0),)}
        here = GuideGeometry.at(self.slide, poses)
        return {name: (row,) for name, row in here.jacobian_rows(self.slide, here.u).items()}

    def turned(self, link: str, angles: Mapping[str, Any], drives: DriverStates) -> Any | None:
        if self.slide is not None:
            return None
        place = drives[self.driver.link].value
        return angles[self.driver.base] + place if link == self.driver.link else angles[self.driver.link] - place

    def velocity_terms(self, poses: Poses, rates: Rates) -> Sequence[Real]:
        if self.slide is None:
            return (np.zeros(np.shape(rates[self.driver.link].w)),)
        here = GuideGeometry.at(self.slide, poses)
        return (dot(here.u, here.bend(self.slide, rates)),)

    def asked(self, drives: DriverStates, order: int) -> Sequence[Real | float]:
        drive = drives[self.driver.link]
        return (drive.first if order == 1 else drive.second,)

    def reaction(self, poses: Poses, multipliers: Sequence[Real]) -> PairReaction:
        n = multipliers[0]
        if self.slide is None:
            return PairReaction(n * 0j, couple=n)
        return PairReaction(GuideGeometry.at(self.slide, poses).u * n, at=poses[self.slide.runner].at(self.slide.at))
