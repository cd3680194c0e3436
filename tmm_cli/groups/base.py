"""What all Assur groups of two links share: the states they work on, and a group seen from outside.

A group knows the states of the links it hangs on and gives those of its own two links, a and b: first places, then
rates, then accelerations; and backward the reactions. Arrays are (variants, positions) by broadcasting. The formulas
of each type stand in its own file; they follow from writing the closure of the group as complex numbers and taking
dot and cross products until one unknown is left.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from tmm_cli.linkage import Linkage
from tmm_cli.structure.assur import Group, Pair
from tmm_cli.vectors import Real, Vector, cross, unit

ROUNDINGS = 8.0  # a distance below so many roundings of its data cannot be told from zero


@dataclass(frozen=True)
class Pose:
    """Place of a link: its origin x (m) and e^(i angle) of its x axis, z."""

    x: Vector
    z: Vector

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
        velocity: Vector = self.v + 1j * self.w * arm
        return velocity


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
    """Places of a group's links and how far it is from losing them.

    det is the determinant (or root) that velocities, accelerations and reactions are divided by; margin its size
    without dimension, 1 at best and 0 in a dead position (the sine of the transmission angle where there is one);
    gap (m, or a pure number for two guides) is negative by as much as the group can still give way, positive by as
    much as it falls short of assembling, and cannot be told from zero within slack.
    """

    a: Pose
    b: Pose
    det: Real
    margin: Real
    gap: Real
    slack: Real

    @property
    def assembled(self) -> Any:
        return self.gap <= self.slack

    @property
    def dead(self) -> Any:
        return np.abs(self.gap) <= self.slack


@dataclass(frozen=True)
class Held:
    """A reaction on one link at one point: force (N), couple (N m, sliding pairs only).

    tangential and normal are the two components of an outer hinge's reaction, across its link and along it, that the
    force plan finds one after the other.
    """

    force: Vector
    couple: Real | None = None
    tangential: Vector | None = None
    normal: Vector | None = None


@dataclass(frozen=True)
class Holding:
    """Reactions of a group: of the outer pairs on links a and b, and of the inner pair on link b from link a.

    A couple belongs to the running point of its sliding pair.
    """

    a: Held
    b: Held
    inner: Held


@dataclass(frozen=True)
class Turn:
    """An outer hinge: its place on the link that is known and on the group's own."""

    known: str
    there: complex
    here: complex

    def place(self, poses: Mapping[str, Pose]) -> Vector:
        """Where the hinge is, m."""
        return poses[self.known].at(self.there)

    def velocity(self, poses: Mapping[str, Pose], rates: Mapping[str, Rate]) -> Vector:
        """Velocity of the hinge, m/s."""
        return rates[self.known].at(self.there * poses[self.known].z)

    def acceleration(self, poses: Mapping[str, Pose], rates: Mapping[str, Rate], accels: Mapping[str, Accel]) -> Vector:
        """Acceleration of the hinge, m/s2."""
        return accels[self.known].at(self.there * poses[self.known].z, rates[self.known].w)


@dataclass(frozen=True)
class Run:
    """A sliding pair seen from one side: `here` (own axes) stays on the line through `there` along e^(i direction).

    there and direction are in the axes of the other link, and own angle - other's angle = turned. It says the same
    whichever link carries the guide. runs_here: `here` is the running point, else `there` is.
    """

    known: str
    there: complex
    here: complex
    direction: float
    turned: float
    runs_here: bool

    def runner_arm(self, own: Pose, poses: Mapping[str, Pose]) -> Vector:
        """The running point, to which the couple is reduced, from the own link's origin (drawing's axes, m)."""
        return self.here * own.z if self.runs_here else poses[self.known].at(self.there) - own.x


def turn_end(pair: Pair, own: str, linkage: Linkage) -> Turn:
    """An outer (or inner) hinge as its link `own` sees it."""
    known = pair.other(own)
    return Turn(known, linkage.local(known, pair.point), linkage.local(own, pair.point))


def run_end(pair: Pair, own: str) -> Run:
    """A sliding pair as its link `own` sees it."""
    slide = pair.slide
    assert slide is not None
    if own == slide.runner:
        return Run(slide.carrier, slide.through, slide.at, slide.direction, slide.turned, True)
    return Run(slide.runner, slide.at, slide.through, slide.direction - slide.turned, -slide.turned, False)


@dataclass(frozen=True)
class Dyad(ABC):
    """An Assur group of class II: two links, one inner pair, two outer pairs. sign tells its two assemblies apart."""

    group: Group
    ends: tuple[Turn | Run, Turn | Run]
    inner: Turn | Run
    size: float  # m, the farthest two points on one of the links concerned: what distances are measured against
    sign: int = 1

    type: ClassVar[str]
    assemblies: ClassVar[int] = 2

    @classmethod
    def of(cls, group: Group, linkage: Linkage, sign: int = 1) -> Dyad:
        """The group with its numbers; the inner pair is seen from link b."""

        def seen(pair: Pair, own: str) -> Turn | Run:
            return turn_end(pair, own, linkage) if pair.kind == "R" else run_end(pair, own)

        a, b = group.links
        ends = (seen(group.outer[0], a), seen(group.outer[1], b))
        size = max(_spread(linkage, link) for link in (a, b, *(end.known for end in ends)))
        return cls(group, ends, seen(group.inner[0], b), size, sign)

    @abstractmethod
    def place(self, poses: Mapping[str, Pose]) -> Placement:
        """Places of both links; where it cannot be assembled the nearest it comes (see gap)."""

    @abstractmethod
    def rates(self, at: Placement, poses: Mapping[str, Pose], rates: Mapping[str, Rate]) -> tuple[Rate, Rate]:
        """Velocities of both links."""

    @abstractmethod
    def accelerations(
        self, at: Placement, poses: Mapping[str, Pose], rates: Mapping[str, Rate], accels: Mapping[str, Accel]
    ) -> tuple[Accel, Accel]:
        """Accelerations of both links; rates holds those of both links too."""

    @abstractmethod
    def reactions(self, at: Placement, poses: Mapping[str, Pose], on_a: Wrench, on_b: Wrench) -> Holding:
        """Reactions of the three pairs that hold both links under the given forces."""


def _spread(linkage: Linkage, link: str) -> float:
    points = np.array(list(linkage.links[link].points.values()) or [0j])
    return float(np.max(np.abs(points - points[..., :1])))


def epsilon(values: Any) -> float:
    """Unit roundoff of an array's own precision."""
    return float(np.finfo(np.asarray(values).real.dtype).eps) / 2


def line(run: Run, poses: Mapping[str, Pose]) -> tuple[Vector, Vector]:
    """A point of the guide and its direction, in the drawing's axes."""
    pose = poses[run.known]
    return pose.at(run.there), pose.z * unit(run.direction)
