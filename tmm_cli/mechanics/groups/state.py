"""States that groups work on: places and motions of links, forces on them, and what a group finds.

Arrays are (variants, positions) by broadcasting.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tmm_cli.mechanics.numerics import Real, Vector, cross


@dataclass(frozen=True)
class Pose:
    """Place of a link: its origin x (m) and e^(i angle) of its x axis, z.

    unwrapped: the angle itself (rad), followed through full turns, where something depends on it (toothed wheels).
    """

    x: Vector
    z: Vector
    unwrapped: Real | None = None

    @property
    def turned(self) -> Real:
        """The angle (rad): followed through where it was, else within -pi..pi."""
        return np.arctan2(self.z.imag, self.z.real) if self.unwrapped is None else self.unwrapped

    def spread(self, shape: tuple[int, ...]) -> Pose:
        """The same pose at many positions."""
        unwrapped = None if self.unwrapped is None else np.broadcast_to(self.unwrapped, shape)
        return Pose(np.broadcast_to(self.x, shape), np.broadcast_to(self.z, shape), unwrapped)

    def at(self, local: Any) -> Vector:
        """A point of the link in the drawing's axes, m."""
        place: Vector = self.x + local * self.z
        return place


@dataclass(frozen=True)
class Rate:
    """Velocity of a link: of its origin v (m/s), and w (rad/s)."""

    v: Vector
    w: Real

    @classmethod
    def through(cls, v: Vector, w: Real, arm: Vector) -> Rate:
        """Of a link that turns with w while its point `arm` from the origin has the velocity v."""
        return cls(v - 1j * w * arm, w)

    def at(self, arm: Vector) -> Vector:
        """Velocity of the point of the link that lies `arm` (drawing's axes) from its origin, m/s."""
        return self.v + 1j * self.w * arm


@dataclass(frozen=True)
class Accel:
    """Acceleration of a link: of its origin a (m/s2), and e (rad/s2)."""

    a: Vector
    e: Real

    @classmethod
    def through(cls, a: Vector, e: Real, w: Real, arm: Vector) -> Accel:
        """Of a link that turns with w and e while its point `arm` from the origin has the acceleration a."""
        return cls(a - (1j * e - w * w) * arm, e)

    def at(self, arm: Vector, w: Real) -> Vector:
        """Acceleration of the point that lies `arm` from the origin when the link turns with w, m/s2."""
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
        """Moment of the same forces about the point that lies `arm` from the link's origin, N m."""
        moment: Real = self.moment - cross(arm, self.force)
        return moment


@dataclass(frozen=True)
class Placement:
    """Places of a group's links, in its order, and how far it is from losing them.

    det is the determinant (or root) that velocities, accelerations and reactions are divided by; margin its size
    without dimension, 1 at best and 0 in a dead position (the sine of the transmission angle where there is one);
    residual (m, or a pure number for two guides) is negative by as much as the group can still give way, positive by as
    much as it falls short of assembling, and cannot be told from zero within slack.
    """

    poses: tuple[Pose, ...]
    det: Real
    margin: Real
    residual: Real
    slack: Real

    @property
    def a(self) -> Pose:
        """Place of the first link."""
        return self.poses[0]

    @property
    def b(self) -> Pose:
        """Place of the second link."""
        return self.poses[1]

    @property
    def assembled(self) -> Any:
        return self.residual <= self.slack

    @property
    def dead(self) -> Any:
        return np.abs(self.residual) <= self.slack


@dataclass(frozen=True)
class PairReaction:
    """A reaction on one link at one point: force (N), couple (N m, sliding pairs only).

    tangential and normal are the two components of an outer hinge's reaction, across its link and along it, that the
    force plan finds one after the other. at: its point (m), where the pair has none of its own (teeth). back: couple on
    the other link (N m), where it is not the opposite of this one (a cam given by its law).
    """

    force: Vector
    couple: Real | None = None
    tangential: Vector | None = None
    normal: Vector | None = None
    at: Vector | None = None
    back: Real | None = None

    @property
    def opposite(self) -> PairReaction:
        """The reaction on the pair's other link."""
        if self.back is not None:
            return PairReaction(-self.force, self.back, at=self.at, back=self.couple)
        return PairReaction(-self.force, None if self.couple is None else -self.couple, at=self.at)


@dataclass(frozen=True)
class GroupReactions:
    """Reactions of a group: of the outer pairs on its own links, of the inner pairs on their second links.

    Both in the order of the group's pairs; of a dyad the inner one acts on link b. A couple belongs to the running
    point of its sliding pair. drives: the force (N) or moment (N m) of each driver between links of the group, by its
    link.
    """

    outer: tuple[PairReaction, ...]
    inner: tuple[PairReaction, ...]
    drives: Mapping[str, Real] = field(default_factory=dict)


@dataclass(frozen=True)
class DriverState:
    """Where a driver is: its place (rad or m) and its first and second derivatives by the parameter of the motion."""

    value: Real
    first: Real
    second: Real


DriverStates = Mapping[str, DriverState]


@dataclass(frozen=True)
class GroupState:
    """Origins (m) and angles (rad, through full turns) of a group's links on the last axis."""

    x: Vector
    unwrapped: Real

    def moved(self, step: Real, size: Real | float) -> GroupState:
        """The state after a step (..., 3 links) of x, y and angle of each link; lengths of the step in sizes (m)."""
        parts = step.reshape(*np.shape(step)[:-1], np.shape(step)[-1] // 3, 3)
        return GroupState(self.x + size * (parts[..., 0] + 1j * parts[..., 1]), self.unwrapped + parts[..., 2])

    def part(self, chosen: slice) -> GroupState:
        """Some of many states."""
        return GroupState(self.x[chosen], self.unwrapped[chosen])
