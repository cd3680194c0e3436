"""Records of group solvers: poses and motions of links, forces on them, and results.

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
    """Pose of a link: origin x (m) and direction z = e^(i angle) of its x axis.

    unwrapped: the angle accumulated through full turns (rad), where something depends on it (gears).
    """

    x: Vector
    z: Vector
    unwrapped: Real | None = None

    @property
    def turned(self) -> Real:
        """Angle (rad): accumulated where available, otherwise in -pi..pi."""
        return np.arctan2(self.z.imag, self.z.real) if self.unwrapped is None else self.unwrapped

    def spread(self, shape: tuple[int, ...]) -> Pose:
        """Return the pose broadcast to many positions."""
        unwrapped = None if self.unwrapped is None else np.broadcast_to(self.unwrapped, shape)
        return Pose(np.broadcast_to(self.x, shape), np.broadcast_to(self.z, shape), unwrapped)

    def at(self, local: Any) -> Vector:
        """Return a point of the link, given in its own axes, in the axes of the drawing, m."""
        place: Vector = self.x + local * self.z
        return place


@dataclass(frozen=True)
class Rate:
    """Velocity of a link: v of its origin (m/s), and angular velocity w (rad/s)."""

    v: Vector
    w: Real

    @classmethod
    def through(cls, v: Vector, w: Real, arm: Vector) -> Rate:
        """Return the velocity of a link with angular velocity w whose point at `arm` from the origin has the velocity
        v.
        """
        return cls(v - 1j * w * arm, w)

    def at(self, arm: Vector) -> Vector:
        """Return the velocity of the point at `arm` from the origin (axes of the drawing), m/s."""
        return self.v + 1j * self.w * arm


@dataclass(frozen=True)
class Accel:
    """Acceleration of a link: a of its origin (m/s2), and angular acceleration e (rad/s2)."""

    a: Vector
    e: Real

    @classmethod
    def through(cls, a: Vector, e: Real, w: Real, arm: Vector) -> Accel:
        """Return the acceleration of a link with angular rates w and e whose point at `arm` from the origin has
        acceleration a.
        """
        return cls(a - (1j * e - w * w) * arm, e)

    def at(self, arm: Vector, w: Real) -> Vector:
        """Return the acceleration of the point at `arm` from the origin of a link with angular velocity w, m/s2."""
        acceleration: Vector = self.a + (1j * self.e - w * w) * arm
        return acceleration


Poses = Mapping[str, Pose]
Rates = Mapping[str, Rate]
Accels = Mapping[str, Accel]


@dataclass(frozen=True)
class Wrench:
    """Forces on a link reduced to its origin: force (N) and moment about the origin (N m)."""

    force: Vector
    moment: Real

    def __add__(self, other: Wrench) -> Wrench:
        return Wrench(self.force + other.force, self.moment + other.moment)

    def about(self, arm: Vector) -> Real:
        """Return the moment of the same forces about the point at `arm` from the origin, N m."""
        moment: Real = self.moment - cross(arm, self.force)
        return moment


@dataclass(frozen=True)
class Placement:
    """Poses of the links of a group, in its order, and its distance from a dead position.

    Attributes:
        det: determinant (or root) by which velocities, accelerations and reactions are divided.
        margin: its dimensionless magnitude, 1 at best and 0 in a dead position (the sine of the transmission angle
            where there is one).
        residual: negative by the distance (m; dimensionless for two guides) to the loss of the assembly, positive by
            the distance by which the group fails to assemble.
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
    """Reaction on one link at one point: force (N), and for a prismatic pair a couple (N m).

    Attributes:
        tangential, normal: components of the reaction of an external hinge across and along its link, in the order in
            which the force plan determines them.
        at: point of action (m), if the pair has none of its own (teeth).
        back: couple on the other link (N m), if it is not the opposite of this one (a cam defined by its law of
            motion).
    """

    force: Vector
    couple: Real | None = None
    tangential: Vector | None = None
    normal: Vector | None = None
    at: Vector | None = None
    back: Real | None = None

    @property
    def opposite(self) -> PairReaction:
        """Reaction on the other link of the pair."""
        if self.back is not None:
            return PairReaction(-self.force, self.back, at=self.at, back=self.couple)
        return PairReaction(-self.force, None if self.couple is None else -self.couple, at=self.at)


@dataclass(frozen=True)
class GroupReactions:
    """Reactions of a group: of external pairs on its own links, of internal pairs on their second links (in a dyad: b).

    Both are in the order of the pairs of the group. The couple of a prismatic pair is taken about its sliding point.
    drives: force (N) or moment (N m) of each driver between links of the group, by the driven link.
    """

    outer: tuple[PairReaction, ...]
    inner: tuple[PairReaction, ...]
    drives: Mapping[str, Real] = field(default_factory=dict)


@dataclass(frozen=True)
class DriverState:
    """Coordinate of a driver (rad or m), with its first and second derivatives with respect to the parameter of the
    motion.
    """

    value: Real
    first: Real
    second: Real


DriverStates = Mapping[str, DriverState]


@dataclass(frozen=True)
class GroupState:
    """Origins (m) and accumulated angles (rad) of the links of a group, on the last axis."""

    x: Vector
    unwrapped: Real

    def moved(self, step: Real, size: Real | float) -> GroupState:
        """Return the state after a step (..., 3 links) of x, y and angle of each link; lengths of the step in units of
        `size` (m).
        """
        parts = step.reshape(*np.shape(step)[:-1], np.shape(step)[-1] // 3, 3)
        return GroupState(self.x + size * (parts[..., 0] + 1j * parts[..., 1]), self.unwrapped + parts[..., 2])

    def part(self, chosen: slice) -> GroupState:
        """Return a slice of many states."""
        return GroupState(self.x[chosen], self.unwrapped[chosen])
