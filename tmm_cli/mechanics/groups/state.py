"""Records of group solvers: poses and motions of links, forces on links, and results.

Arrays broadcast against (variants, positions).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tmm_cli.mechanics.numerics import Real, Vector, cross


@dataclass(frozen=True)
class Pose:
    """Pose of a link.

    Attributes:
        x: position of its origin (m).
        z: unit vector along its x axis, e^(i angle).
        unwrapped: angle accumulated through full turns (rad); None unless other links (gears) depend on the full turns.
    """

    x: Vector
    z: Vector
    unwrapped: Real | None = None

    @property
    def turned(self) -> Real:
        """Angle of the link (rad): accumulated through full turns if available, otherwise in -pi..pi."""
        return np.arctan2(self.z.imag, self.z.real) if self.unwrapped is None else self.unwrapped

    def spread(self, shape: tuple[int, ...]) -> Pose:
        """Broadcast the pose to arrays of this shape."""
        unwrapped = None if self.unwrapped is None else np.broadcast_to(self.unwrapped, shape)
        return Pose(np.broadcast_to(self.x, shape), np.broadcast_to(self.z, shape), unwrapped)

    def at(self, local: Any) -> Vector:
        """Convert a point from the axes of the link to the axes of the drawing, m."""
        place: Vector = self.x + local * self.z
        return place


@dataclass(frozen=True)
class Rate:
    """Velocity of a link.

    Attributes:
        v: velocity of its origin (m/s).
        w: angular velocity (rad/s).
    """

    v: Vector
    w: Real

    @classmethod
    def through(cls, v: Vector, w: Real, arm: Vector) -> Rate:
        """Make the velocity of a link from its angular velocity w and the velocity v of one of its points.

        arm: vector from the origin of the link to this point.
        """
        return cls(v - 1j * w * arm, w)

    def at(self, arm: Vector) -> Vector:
        """Return the velocity of a point of the link, m/s; arm: vector from the origin of the link to the point."""
        return self.v + 1j * self.w * arm


@dataclass(frozen=True)
class Accel:
    """Acceleration of a link.

    Attributes:
        a: acceleration of its origin (m/s2).
        e: angular acceleration (rad/s2).
    """

    a: Vector
    e: Real

    @classmethod
    def through(cls, a: Vector, e: Real, w: Real, arm: Vector) -> Accel:
        """Make the acceleration of a link from its angular acceleration e and the acceleration a of one of its points.

        w: angular velocity. arm: vector from the origin of the link to the point.
        """
        return cls(a - (1j * e - w * w) * arm, e)

    def at(self, arm: Vector, w: Real) -> Vector:
        """Return the acceleration of a point of the link, m/s2.

        arm: vector from the origin of the link to the point. w: angular velocity.
        """
        acceleration: Vector = self.a + (1j * self.e - w * w) * arm
        return acceleration


Poses = Mapping[str, Pose]
Rates = Mapping[str, Rate]
Accels = Mapping[str, Accel]


@dataclass(frozen=True)
class Wrench:
    """Forces on a link, reduced to its origin.

    Attributes:
        force: resultant force (N).
        moment: resultant moment about the origin (N m).
    """

    force: Vector
    moment: Real

    def __add__(self, other: Wrench) -> Wrench:
        return Wrench(self.force + other.force, self.moment + other.moment)

    def about(self, arm: Vector) -> Real:
        """Return the moment of these forces about another point, N m; arm: vector from the origin to the point."""
        moment: Real = self.moment - cross(arm, self.force)
        return moment


@dataclass(frozen=True)
class Placement:
    """Positions of the links of a group, and how near the group is to a dead position.

    Attributes:
        poses: pose of each link, in the order of the group.
        det: determinant (or root) by which velocities, accelerations and reactions are divided.
        margin: dimensionless magnitude of det, 1 at best and 0 in a dead position. It is the sine of the transmission
            angle where there is one.
        residual: distance by which the group fails to assemble (m; dimensionless for two guides). If negative, the
            group is assembled, with this distance to spare.
        slack: rounding error of the residual.
    """

    poses: tuple[Pose, ...]
    det: Real
    margin: Real
    residual: Real
    slack: Real

    @property
    def a(self) -> Pose:
        """Pose of the first link."""
        return self.poses[0]

    @property
    def b(self) -> Pose:
        """Pose of the second link."""
        return self.poses[1]

    @property
    def assembled(self) -> Any:
        return self.residual <= self.slack

    @property
    def dead(self) -> Any:
        return np.abs(self.residual) <= self.slack


@dataclass(frozen=True)
class PairReaction:
    """Reaction in a pair on one of its links.

    Attributes:
        force: force (N).
        couple: couple in a prismatic pair (N m), otherwise None.
        tangential, normal: components of the reaction of an external hinge, perpendicular to its link and along it, as
            the force plan determines them; otherwise None.
        at: point of action (m); None if it is the point of the pair. Teeth have no such point.
        back: couple on the other link (N m); None if it is the opposite of `couple`. It differs for a cam that is
            defined by its law of motion.
    """

    force: Vector
    couple: Real | None = None
    tangential: Vector | None = None
    normal: Vector | None = None
    at: Vector | None = None
    back: Real | None = None

    @property
    def opposite(self) -> PairReaction:
        """The reaction on the other link of the pair."""
        if self.back is not None:
            return PairReaction(-self.force, self.back, at=self.at, back=self.couple)
        return PairReaction(-self.force, None if self.couple is None else -self.couple, at=self.at)


@dataclass(frozen=True)
class GroupReactions:
    """Reactions in the pairs of a group. Couples of prismatic pairs are taken about their sliding points.

    Attributes:
        outer: reactions of the external pairs on the links of the group, in the order of the pairs.
        inner: reactions of the internal pairs on the second link of each pair (in a dyad: on b), in the order of the
            pairs.
        drives: force (N) or moment (N m) of each driver between links of the group, by name of the driven link.
    """

    outer: tuple[PairReaction, ...]
    inner: tuple[PairReaction, ...]
    drives: Mapping[str, Real] = field(default_factory=dict)


@dataclass(frozen=True)
class DriverState:
    """Coordinate of a driver, and its derivatives with respect to the first driver's coordinate or to time.

    Attributes:
        value: coordinate (rad or m).
        first, second: first and second derivatives.
    """

    value: Real
    first: Real
    second: Real


DriverStates = Mapping[str, DriverState]


@dataclass(frozen=True)
class GroupState:
    """State of a group. The last axis of the arrays is the link.

    Attributes:
        x: positions of the origins (m).
        unwrapped: angles accumulated through full turns (rad).
    """

    x: Vector
    unwrapped: Real

    def moved(self, step: Real, size: Real | float) -> GroupState:
        """Return the state after a step.

        Args:
            step: changes of x, y and angle of each link, shape (..., 3 links); lengths are in units of `size`.
            size: unit of these lengths (m).
        """
        parts = step.reshape(*np.shape(step)[:-1], np.shape(step)[-1] // 3, 3)
        return GroupState(self.x + size * (parts[..., 0] + 1j * parts[..., 1]), self.unwrapped + parts[..., 2])

    def part(self, chosen: slice) -> GroupState:
        """Select some of many states (a slice of the first axis)."""
        return GroupState(self.x[chosen], self.unwrapped[chosen])
