"""Constraint equations of lower pairs and drivers, in the form in which groups of any class are solved.

A pair has one or two scalar equations (rows), residual = 0, in metres or radians. A small motion of a link, dx of its
origin and dt of its angle, changes a residual by c . dx + m dt; (c, m) are the coefficients of the link in that row of
the Jacobian. The same coefficients give velocities and accelerations and, transposed, forces: with the Lagrange
multiplier n of the row, the pair acts on the link with the force n c at its origin and the moment n m. Source: J.
Garcia de Jalon, E. Bayo, Kinematic and Dynamic Simulation of Multibody Systems, ch. 2 and 3.
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
    """Constraint equations of a pair, or of a driver between two links of a group."""

    name: str

    kind: ClassVar[str]

    @property
    @abstractmethod
    def links(self) -> tuple[str, ...]:
        """Names of the links whose poses occur in the equations."""

    @property
    @abstractmethod
    def lengths(self) -> tuple[bool, ...]:
        """For each equation, True if it is in metres, False if in radians."""

    @abstractmethod
    def residuals(self, poses: Poses, drives: DriverStates) -> Sequence[Real]:
        """Return the residual of each equation (m or rad)."""

    @abstractmethod
    def jacobian_rows(self, poses: Poses) -> Mapping[str, Sequence[JacobianRow]]:
        """Return the coefficients (c, m) of each link in the Jacobian, for each equation (see the module)."""

    @abstractmethod
    def velocity_terms(self, poses: Poses, rates: Rates) -> Sequence[Real]:
        """Return the terms of the second derivative of each residual that contain velocities only.

        The other terms are linear in the accelerations.
        """

    def turned(self, link: str, angles: Mapping[str, Any], drives: DriverStates) -> Any | None:
        """Compute the angle of a link (rad) from the angles of the other links, by the first equation of the pair.

        Returns:
            The angle; None if this equation does not relate angles, as for most kinds of pairs.
        """
        return None

    def asked(self, drives: DriverStates, order: int) -> Sequence[Real | float]:
        """Return the first or second time derivative that is prescribed for each equation; zero except for drivers."""
        return [0.0] * len(self.lengths)

    def pushes(self, poses: Poses) -> Mapping[str, Sequence[JacobianRow]]:
        """Return the coefficients (c, m) with which the Lagrange multiplier of each equation acts as a force on each
        link.

        For most kinds of pairs they are those of the Jacobian.
        """
        return self.jacobian_rows(poses)

    @abstractmethod
    def reaction(self, poses: Poses, multipliers: Sequence[Real]) -> PairReaction:
        """Convert the Lagrange multipliers of the pair's equations to the reaction on its second link."""

    def apart(self, poses: Poses, multipliers: Sequence[Real]) -> tuple[Vector, Vector] | None:
        """Return the radial (separating) force of gear teeth, which does no work.

        Returns:
            Point of action (m) and force on the second link (N); None for other kinds of pairs.
        """
        return None


@dataclass(frozen=True)
class HigherPairConstraint(PairConstraint):
    """One equation for links i and j in contact, which are joined to a common carrier.

    Contact forces act on i and j only; their carrier is loaded through its hinges.
    """

    mesh: Mesh

    @property
    def links(self) -> tuple[str, ...]:
        return self.mesh.i, self.mesh.j, self.mesh.carrier

    @abstractmethod
    def contact(self, poses: Poses) -> tuple[Vector, Vector]:
        """Return the contact point (m) and the direction of the contact force.

        The direction is that of the force of link i on link j for a positive Lagrange multiplier.
        """

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
    """Gear teeth in contact at the pitch point, where both links have the same velocity.

    Besides the tangential force there is a radial force, which separates the links.
    """

    away: ClassVar[complex]  # direction away from the axis of i relative to the contact direction, for a positive ratio

    def apart(self, poses: Poses, multipliers: Sequence[Real]) -> tuple[Vector, Vector]:
        point, along = self.contact(poses)
        away = self.away * along * np.sign(self.mesh.ratio)
        return point, away * np.abs(multipliers[0]) * np.tan(self.mesh.pressure)


def carrier_axis(linkage: Linkage, wheel: str, carrier: str) -> complex:
    """Return the position of the axis of a gear or cam on its carrier, in the axes of the carrier (m)."""
    point = linkage.shared(carrier, wheel)
    assert point is not None
    return linkage.local(carrier, point)


# Revolute pair: a point of one link coincides with a point of the other.


@dataclass(frozen=True)
class HingeConstraint(PairConstraint):
    """Revolute pair. Its equations: x and y of the hinge point are the same on link i and on link j.

    Attributes:
        i, j: names of the links.
        at_i, at_j: the hinge point in the axes of each link (m).
    """

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


# Prismatic pair: a point of the runner stays on a guide of the carrier, and their relative angle is constant.


@dataclass(frozen=True)
class GuideGeometry:
    """Geometry of a prismatic pair at given poses of its links.

    Attributes:
        u: unit vector along the guide.
        off: vector from the point `through` of the guide to the sliding point (m).
        on_carrier: vector from the origin of the carrier to the sliding point (m).
        on_runner: vector from the origin of the runner to the sliding point (m).
    """

    u: Vector
    off: Vector  # from the `through` point of the guide to the sliding point
    on_carrier: Vector  # from the origin of the carrier to the sliding point
    on_runner: Vector  # from the origin of the runner to the sliding point

    @classmethod
    def at(cls, slide: Slide, poses: Poses) -> GuideGeometry:
        carrier, runner = poses[slide.carrier], poses[slide.runner]
        on_runner = slide.at * runner.z
        on_carrier = (runner.x - carrier.x) + on_runner
        return cls(carrier.z * unit(slide.direction), on_carrier - slide.through * carrier.z, on_carrier, on_runner)

    def jacobian_rows(self, slide: Slide, along: Vector) -> Mapping[str, JacobianRow]:
        """Return the Jacobian coefficients of one component of the sliding point's motion relative to the carrier.

        along: direction of the component, fixed in the carrier.
        """
        return {
            slide.carrier: (-along, -cross(self.on_carrier, along)),
            slide.runner: (along, cross(self.on_runner, along)),
        }

    def bend(self, slide: Slide, rates: Rates) -> Vector:
        """Return the normal acceleration of the sliding point less that of the coincident point of the carrier.

        The former is taken about the origin of the runner, the latter about the origin of the carrier. The Coriolis
        acceleration is not included.
        """
        bend: Vector = self.on_carrier * rates[slide.carrier].w ** 2 - self.on_runner * rates[slide.runner].w ** 2
        return bend

    def sliding(self, slide: Slide, rates: Rates) -> Real:
        """Return the velocity of the sliding point along the guide, m/s."""
        speed: Real = dot(self.u, rates[slide.runner].at(self.on_runner) - rates[slide.carrier].at(self.on_carrier))
        return speed


@dataclass(frozen=True)
class SlideConstraint(PairConstraint):
    """Prismatic pair.

    Its equations: the angle of the runner relative to the carrier is constant, and the sliding point lies on the guide.
    """

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
        guide = GuideGeometry.at(self.slide, poses)
        turned = poses[self.slide.runner].z * np.conj(poses[self.slide.carrier].z * unit(self.slide.turned))
        return np.arctan2(turned.imag, turned.real), cross(guide.u, guide.off)

    def jacobian_rows(self, poses: Poses) -> Mapping[str, Sequence[JacobianRow]]:
        guide = GuideGeometry.at(self.slide, poses)
        across = guide.jacobian_rows(self.slide, 1j * guide.u)
        return {
            self.slide.carrier: ((0j, -1.0), across[self.slide.carrier]),
            self.slide.runner: ((0j, 1.0), across[self.slide.runner]),
        }

    def turned(self, link: str, angles: Mapping[str, Any], drives: DriverStates) -> Any:
        if link == self.slide.runner:
            return angles[self.slide.carrier] + self.slide.turned
        return angles[self.slide.runner] - self.slide.turned

    def velocity_terms(self, poses: Poses, rates: Rates) -> Sequence[Real]:
        guide = GuideGeometry.at(self.slide, poses)
        coriolis = 2 * rates[self.slide.carrier].w * guide.sliding(self.slide, rates)
        return np.zeros(np.shape(coriolis)), cross(guide.u, guide.bend(self.slide, rates)) - coriolis

    def reaction(self, poses: Poses, multipliers: Sequence[Real]) -> PairReaction:
        guide = GuideGeometry.at(self.slide, poses)
        return PairReaction(1j * guide.u * multipliers[1], multipliers[0])


# Driver between two moving links, as an additional row of their group: a cylinder, or a drive in a hinge.


@dataclass(frozen=True)
class DriverConstraint(PairConstraint):
    """Driver between two moving links.

    Its equation: the angle of the link relative to its base, or the displacement in their prismatic pair, is the driver
    coordinate.
    """

    driver: Driver
    slide: Slide | None

    kind = "D"

    @classmethod
    def of(cls, driver: Driver, linkage: Linkage) -> DriverConstraint:
        """Make the constraint of a driver of this linkage."""
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
        guide = GuideGeometry.at(self.slide, poses)
        return (dot(guide.u, guide.off) - want,)

    def jacobian_rows(self, poses: Poses) -> Mapping[str, Sequence[JacobianRow]]:
        if self.slide is None:
            return {self.driver.base: ((0j, -1.0),), self.driver.link: ((0j, 1.0),)}
        guide = GuideGeometry.at(self.slide, poses)
        return {name: (row,) for name, row in guide.jacobian_rows(self.slide, guide.u).items()}

    def turned(self, link: str, angles: Mapping[str, Any], drives: DriverStates) -> Any | None:
        if self.slide is not None:
            return None
        coordinate = drives[self.driver.link].value
        return (
            angles[self.driver.base] + coordinate if link == self.driver.link else angles[self.driver.link] - coordinate
        )

    def velocity_terms(self, poses: Poses, rates: Rates) -> Sequence[Real]:
        if self.slide is None:
            return (np.zeros(np.shape(rates[self.driver.link].w)),)
        guide = GuideGeometry.at(self.slide, poses)
        return (dot(guide.u, guide.bend(self.slide, rates)),)

    def asked(self, drives: DriverStates, order: int) -> Sequence[Real | float]:
        drive = drives[self.driver.link]
        return (drive.first if order == 1 else drive.second,)

    def reaction(self, poses: Poses, multipliers: Sequence[Real]) -> PairReaction:
        n = multipliers[0]
        if self.slide is None:
            return PairReaction(n * 0j, couple=n)
        return PairReaction(GuideGeometry.at(self.slide, poses).u * n, at=poses[self.slide.runner].at(self.slide.at))
