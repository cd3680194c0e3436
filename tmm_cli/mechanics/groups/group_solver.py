"""A group seen from outside, and what all Assur groups of two links share.

A group knows the states of the links it hangs on and gives those of its own links: first places, then rates, then
accelerations; and backward the reactions. Arrays are (variants, positions) by broadcasting. The formulas of each type
of two links, a and b, stand in its own file; they follow from writing the closure of the group as complex numbers and
taking dot and cross products until one unknown is left.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import reduce
from typing import Any, ClassVar, Generic, Self, TypeVar

import numpy as np

from tmm_cli.mechanics.groups.branch_trace import AccumulatedAngles, BranchTrace, ChangePoints
from tmm_cli.mechanics.groups.state import (
    Accel,
    Accels,
    DriverStates,
    GroupReactions,
    Placement,
    Pose,
    Poses,
    Rate,
    Rates,
    Wrench,
)
from tmm_cli.mechanics.linkage import Linkage
from tmm_cli.mechanics.numerics import NEAR_DEAD, ROUNDINGS, Real, Vector, cross, dot, roundoff, unit
from tmm_cli.mechanics.structure import Group, Pair

__all__ = ["Accels", "ClosedFormSolver", "Dyad", "GroupSolver", "Poses", "Rates"]


@dataclass(frozen=True)
class HingeEnd:
    """An outer hinge: its place on the link that is known and on the group's own."""

    known: str
    there: complex
    here: complex

    def place(self, poses: Poses) -> Vector:
        """Where the hinge is, m."""
        return poses[self.known].at(self.there)

    def velocity(self, poses: Poses, rates: Rates) -> Vector:
        """Velocity of the hinge, m/s."""
        return rates[self.known].at(self.there * poses[self.known].z)

    def acceleration(self, poses: Poses, rates: Rates, accels: Accels) -> Vector:
        """Acceleration of the hinge, m/s2."""
        return accels[self.known].at(self.there * poses[self.known].z, rates[self.known].w)


@dataclass(frozen=True)
class SliderEnd:
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

    def runner_arm(self, own: Pose, poses: Poses) -> Vector:
        """The running point, to which the couple is reduced, from the own link's origin (drawing's axes, m)."""
        return self.here * own.z if self.runs_here else poses[self.known].at(self.there) - own.x


def slider_end(pair: Pair, own: str) -> SliderEnd:
    """A sliding pair as its link `own` sees it."""
    slide = pair.slide
    assert slide is not None
    if own == slide.runner:
        return SliderEnd(slide.carrier, slide.through, slide.at, slide.direction, slide.turned, True)
    return SliderEnd(slide.runner, slide.at, slide.through, slide.direction - slide.turned, -slide.turned, False)


def pair_end(pair: Pair, own: str, linkage: Linkage) -> HingeEnd | SliderEnd:
    """A lower pair as its link `own` sees it."""
    if pair.kind == "P":
        return slider_end(pair, own)
    known = pair.other(own)
    return HingeEnd(known, linkage.local(known, pair.point), linkage.local(own, pair.point))


@dataclass(frozen=True)
class GroupSolver(ABC):
    """An Assur group that can be solved."""

    group: Group
    size: float  # m, the farthest two points on one of the links concerned: what distances are measured against

    @property
    def followed(self) -> BranchTrace | None:
        """Where its links are along the driver's range, if it had to be followed there."""
        return None

    @abstractmethod
    def rebind(self, linkage: Linkage) -> GroupSolver:
        """The same group in the same assembly, with the numbers of another linkage (of another precision)."""

    def side(self, q: Real) -> Real:
        """1, or -1 where the sign of its determinant has changed since the sketch, in change points that it passes."""
        return np.ones(np.shape(q))

    near: ClassVar[float] = NEAR_DEAD  # a margin below this is said to be near a dead position

    @property
    def blurred(self) -> float:
        """A margin below this calls for double-doubles."""
        return self.near

    @abstractmethod
    def place(self, poses: Poses, q: Real, drives: DriverStates) -> Placement:
        """Places of its links at the driver's places q, or the nearest it comes to being assembled (see residual)."""

    @abstractmethod
    def rates(self, at: Placement, poses: Poses, rates: Rates, drives: DriverStates) -> tuple[Rate, ...]:
        """Velocities of its links."""

    @abstractmethod
    def accelerations(
        self, at: Placement, poses: Poses, rates: Rates, accels: Accels, drives: DriverStates
    ) -> tuple[Accel, ...]:
        """Accelerations of its links; rates holds those of its own links too."""

    @abstractmethod
    def reactions(self, at: Placement, poses: Poses, applied: tuple[Wrench, ...]) -> GroupReactions:
        """Reactions of its pairs that hold its links, in their order, under the given forces."""

    def inner_on(self, pair: Pair) -> str:
        """The link on which an inner pair's reaction is given."""
        return pair.j


@dataclass(frozen=True)
class ClosedFormSolver(GroupSolver):
    """A group whose places are found in closed form. sign tells its two assemblies apart.

    winding: how often its links have gone round, where something depends on that. way: where it goes smoothly through
    change points, beyond which it has the other sign.
    """

    sign: Any = field(default=1, kw_only=True)
    winding: AccumulatedAngles | None = field(default=None, kw_only=True)
    way: ChangePoints | None = field(default=None, kw_only=True)

    def side(self, q: Real) -> Real:
        return super().side(q) if self.way is None else self.way.side(q)

    @classmethod
    @abstractmethod
    def fits(cls, group: Group) -> bool:
        """Whether a group is of this type."""

    @classmethod
    @abstractmethod
    def of(cls, group: Group, linkage: Linkage) -> Self:
        """A group with its numbers, in its first assembly."""

    def rebind(self, linkage: Linkage) -> Self:
        new = type(self).of(self.group.rebind(linkage), linkage)
        return replace(new, sign=self.sign, winding=self.winding, way=self.way)

    @property
    def plain(self) -> bool:
        """Whether it is the same formulas at every place of the driver."""
        return self.winding is None and self.way is None

    @property
    @abstractmethod
    def assemblies(self) -> int:
        """How many there are at most, 1 or 2."""

    @property
    @abstractmethod
    def outer_pairs(self) -> tuple[tuple[Pair, HingeEnd | SliderEnd], ...]:
        """Its outer pairs, each as its own link sees it."""

    def place(self, poses: Poses, q: Real, drives: DriverStates) -> Placement:
        at = (self if self.way is None else replace(self, sign=self.sign * self.way.side(q))).closed(poses, drives)
        return at if self.winding is None else replace(at, poses=self.winding.followed(self.group.links, at.poses, q))

    @abstractmethod
    def closed(self, poses: Poses, drives: DriverStates) -> Placement:
        """Places of its links in the group's own assembly."""

    @abstractmethod
    def residual_rate(self, at: Placement, poses: Poses, rates: Rates, drives: DriverStates) -> Real:
        """The rate at which its residual grows, from the motion of the links it hangs on and of its drivers alone."""


EndA = TypeVar("EndA", bound=HingeEnd | SliderEnd)
EndB = TypeVar("EndB", bound=HingeEnd | SliderEnd)
Inner = TypeVar("Inner", bound=HingeEnd | SliderEnd)


@dataclass(frozen=True)
class Dyad(ClosedFormSolver, Generic[EndA, EndB, Inner]):
    """An Assur group of class II: two links, one inner pair, two outer pairs."""

    ends: tuple[EndA, EndB]
    inner: Inner

    type: ClassVar[str]
    assemblies = 2

    @classmethod
    def fits(cls, group: Group) -> bool:
        return group.type == cls.type and not group.drivers

    @classmethod
    def of(cls, group: Group, linkage: Linkage) -> Self:
        """The inner pair is seen from link b."""
        a, b = group.links
        ends: Any = (pair_end(group.outer[0], a, linkage), pair_end(group.outer[1], b, linkage))
        size = reduce(np.maximum, [link_extent(linkage, link) for link in (a, b, *(end.known for end in ends))])
        inner: Any = pair_end(group.inner[0], b, linkage)
        return cls(group, size, ends, inner)

    @property
    def parts(self) -> tuple[EndA, EndB, Inner]:
        """Outer pairs of a and of b, and the inner pair."""
        return *self.ends, self.inner

    @property
    def outer_pairs(self) -> tuple[tuple[Pair, HingeEnd | SliderEnd], ...]:
        return tuple(zip(self.group.outer, self.ends, strict=True))

    def inner_on(self, pair: Pair) -> str:
        return self.group.links[1]


def link_extent(linkage: Linkage, link: str) -> Any:
    """The farthest that a point of a link is from its first one, m."""
    points = list(linkage.links[link].points.values()) or [0j]
    return reduce(np.maximum, [np.abs(point - points[0]) for point in points])


def slider_search_range(linkage: Linkage) -> float:
    """How far (m) to both sides of the sketch a sliding driver is looked at: nothing is as long as that."""
    return 4 * (max(link_extent(linkage, link) for link in linkage.links) or 1.0)


def guide_line(run: SliderEnd, poses: Poses) -> tuple[Vector, Vector]:
    """A point of the guide and its direction, in the drawing's axes."""
    pose = poses[run.known]
    return pose.at(run.there), pose.z * unit(run.direction)


# A link held by two guides: where two straight lines of known links meet. Shared by PRP and RPP.


def intersect_lines(P: Vector, u: Vector, Q: Vector, v: Vector) -> tuple[Vector, Real]:
    """The common point of the lines through P along u and through Q along v, and u x v (0 when parallel)."""
    det = cross(u, v)
    with np.errstate(divide="ignore", invalid="ignore"):
        return P + u * (cross(Q - P, v) / det), det


def parallel_residual(det: Real) -> tuple[Real, Real]:
    """Residual and slack of two guides: they are parallel within rounding, or not."""
    return -np.abs(det), np.full(np.shape(det), ROUNDINGS * roundoff(det))


def parallel_residual_rate(u: Vector, v: Vector, wu: Real, wv: Real) -> Real:
    """Rate of the residual -|u x v| when the two guides turn."""
    rate: Real = -np.sign(cross(u, v)) * (wv - wu) * dot(u, v)
    return rate


def common_point_rate(v1: Vector, u1: Vector, v2: Vector, u2: Vector, det: Real) -> Vector:
    """Velocity of the common point when the two guides carry it with v1 and v2 and it runs along u1 and u2."""
    velocity: Vector = v1 + u1 * (cross(v2 - v1, u2) / det)
    return velocity


def guide_acceleration(point: Vector, vP: Vector, guide: tuple[Vector, Vector, Rate, Accel]) -> Vector:
    """Acceleration that a guide gives a point running on it, without the unknown part along the guide (Coriolis in)."""
    origin, u, rate, accel = guide
    arm = point - origin
    sliding = dot(u, vP - rate.at(arm))
    acceleration: Vector = accel.at(arm, rate.w) + 2j * rate.w * sliding * u
    return acceleration


def split_across_guides(rest: Vector, u1: Vector, u2: Vector, det: Real) -> tuple[Vector, Vector]:
    """The two forces across u1 and across u2 that balance `rest`."""
    return 1j * u1 * (-dot(rest, u2) / det), 1j * u2 * (dot(rest, u1) / det)


# A group that does as another one does: what it does otherwise a subclass says.


Step = TypeVar("Step")


@dataclass(frozen=True)
class WrappedSolver(GroupSolver):
    """A subclass overrides one of the steps, or `passed`, through which all of them go."""

    inner: GroupSolver

    @classmethod
    def around(cls, inner: GroupSolver, *own: Any) -> Self:
        """A kernel about another one; own: the fields of the subclass."""
        return cls(inner.group, inner.size, inner, *own)

    def passed(self, work: Callable[..., Step], *given: Any) -> Step:
        """One step of the inner kernel."""
        return work(*given)

    def rebind(self, linkage: Linkage) -> Self:
        return replace(self, inner=self.inner.rebind(linkage))

    def place(self, poses: Poses, q: Real, drives: DriverStates) -> Placement:
        return self.passed(self.inner.place, poses, q, drives)

    def rates(self, at: Placement, poses: Poses, rates: Rates, drives: DriverStates) -> tuple[Rate, ...]:
        return self.passed(self.inner.rates, at, poses, rates, drives)

    def accelerations(
        self, at: Placement, poses: Poses, rates: Rates, accels: Accels, drives: DriverStates
    ) -> tuple[Accel, ...]:
        return self.passed(self.inner.accelerations, at, poses, rates, accels, drives)

    def reactions(self, at: Placement, poses: Poses, applied: tuple[Wrench, ...]) -> GroupReactions:
        return self.passed(self.inner.reactions, at, poses, applied)

    def inner_on(self, pair: Pair) -> str:
        return self.inner.inner_on(pair)
