"""Interface of group solvers, and what is common to the solvers of dyads (Assur groups of two links).

A group solver takes the states of the links on which the group depends and returns the states of its own links: first
positions, then velocities, then accelerations. Afterwards, from the last group to the first, it returns reactions.
Arrays broadcast against (variants, positions). The formulas of each dyad, with links a and b, are in its own module.
They follow from the loop closure in complex numbers: scalar and vector products eliminate all unknowns but one.
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
    """An external hinge of a group.

    Attributes:
        known: the link outside the group, whose motion is known.
        there: position of the hinge on this link, in its axes (m).
        here: position of the hinge on the link of the group, in its axes (m).
    """

    known: str
    there: complex
    here: complex

    def place(self, poses: Poses) -> Vector:
        """Return the position of the hinge, m."""
        return poses[self.known].at(self.there)

    def velocity(self, poses: Poses, rates: Rates) -> Vector:
        """Return the velocity of the hinge, m/s."""
        return rates[self.known].at(self.there * poses[self.known].z)

    def acceleration(self, poses: Poses, rates: Rates, accels: Accels) -> Vector:
        """Return the acceleration of the hinge, m/s2."""
        return accels[self.known].at(self.there * poses[self.known].z, rates[self.known].w)


@dataclass(frozen=True)
class SliderEnd:
    """A prismatic pair as seen from one of its links: the point `here` stays on a line through the point `there`.

    The form is the same whichever link carries the guide.

    Attributes:
        known: the other link.
        there: a point of the line, in the axes of the other link (m).
        here: the point on the line, in the axes of the first link (m).
        direction: direction of the line, in the axes of the other link (rad).
        turned: angle of the first link relative to the other link, constant (rad).
        runs_here: True if `here` is the sliding point; False if `there` is.
    """

    known: str
    there: complex
    here: complex
    direction: float
    turned: float
    runs_here: bool

    def runner_arm(self, own_pose: Pose, poses: Poses) -> Vector:
        """Return the vector (m) from the origin of the first link to the sliding point; couples are taken about it."""
        return self.here * own_pose.z if self.runs_here else poses[self.known].at(self.there) - own_pose.x


def slider_end(pair: Pair, link: str) -> SliderEnd:
    """Describe a prismatic pair as seen from one of its links."""
    slide = pair.slide
    assert slide is not None
    if link == slide.runner:
        return SliderEnd(slide.carrier, slide.through, slide.at, slide.direction, slide.turned, True)
    return SliderEnd(slide.runner, slide.at, slide.through, slide.direction - slide.turned, -slide.turned, False)


def pair_end(pair: Pair, link: str, linkage: Linkage) -> HingeEnd | SliderEnd:
    """Describe a lower pair as seen from one of its links."""
    if pair.kind == "P":
        return slider_end(pair, link)
    known = pair.other(link)
    return HingeEnd(known, linkage.local(known, pair.point), linkage.local(link, pair.point))


@dataclass(frozen=True)
class GroupSolver(ABC):
    """Solver of an Assur group in one assembly.

    Attributes:
        group: the group.
        size: greatest extent of its links and of the links to which it is attached (m); the unit of distances.
        near: margin below which a position is reported as near a dead position.
    """

    group: Group
    size: float  # m, greatest extent of its links and known links: the unit of distances

    @property
    def followed(self) -> BranchTrace | None:
        """States of the group traced along the range of the driver; None if the group needs no trace."""
        return None

    @abstractmethod
    def rebind(self, linkage: Linkage) -> GroupSolver:
        """Return the solver of the same assembly for another linkage, with other dimensions or another precision."""

    def side(self, q: Real) -> Real:
        """Return the sign of the determinant relative to the sketch at driver coordinates q.

        It is -1 where the group has passed an odd number of change points on the way from the sketch.
        """
        return np.ones(np.shape(q))

    near: ClassVar[float] = NEAR_DEAD  # a margin below this is reported as near a dead position

    @property
    def blurred(self) -> float:
        """Margin below which float64 is not accurate enough, so that the group must be solved in double-doubles."""
        return self.near

    @abstractmethod
    def place(self, poses: Poses, q: Real, drives: DriverStates) -> Placement:
        """Compute the positions of the links of the group.

        Where the group cannot be assembled, the positions are those in which its links come closest (see
        `Placement.residual`).

        Args:
            poses: poses of the links on which the group depends.
            q: coordinates of the first driver (rad or m).
            drives: coordinates of all drivers, by name of the driven link.
        """

    @abstractmethod
    def rates(self, at: Placement, poses: Poses, rates: Rates, drives: DriverStates) -> tuple[Rate, ...]:
        """Compute the velocities of the links of the group, in their order.

        rates: velocities of the links on which the group depends.
        """

    @abstractmethod
    def accelerations(
        self, at: Placement, poses: Poses, rates: Rates, accels: Accels, drives: DriverStates
    ) -> tuple[Accel, ...]:
        """Compute the accelerations of the links of the group, in their order.

        Args:
            at: placement of the group.
            poses: poses of the links on which the group depends.
            rates: velocities of these links and of the links of the group.
            accels: accelerations of the links on which the group depends.
            drives: coordinates of all drivers with their derivatives, by name of the driven link.
        """

    @abstractmethod
    def reactions(self, at: Placement, poses: Poses, applied: tuple[Wrench, ...]) -> GroupReactions:
        """Compute the reactions in the pairs of the group.

        applied: forces on each link of the group, in their order, reduced to the origin of the link.
        """

    def inner_on(self, pair: Pair) -> str:
        """Return the name of the link on which `reactions` gives the reaction of an internal pair."""
        return pair.j


@dataclass(frozen=True)
class ClosedFormSolver(GroupSolver):
    """Solver of a group whose positions have a closed form.

    Attributes:
        sign: +1 or -1, selects one of the two assemblies.
        winding: accumulated angles of links whose full turns matter to other links (gears), or None.
        way: change points that the group passes smoothly and where `sign` changes, or None.
    """

    sign: Any = field(default=1, kw_only=True)
    winding: AccumulatedAngles | None = field(default=None, kw_only=True)
    way: ChangePoints | None = field(default=None, kw_only=True)

    def side(self, q: Real) -> Real:
        return super().side(q) if self.way is None else self.way.side(q)

    @classmethod
    @abstractmethod
    def fits(cls, group: Group) -> bool:
        """Return True if the group is of the type that this class solves."""

    @classmethod
    @abstractmethod
    def of(cls, group: Group, linkage: Linkage) -> Self:
        """Make the solver of a group of this linkage, in the first of its assemblies."""

    def rebind(self, linkage: Linkage) -> Self:
        new = type(self).of(self.group.rebind(linkage), linkage)
        return replace(new, sign=self.sign, winding=self.winding, way=self.way)

    @property
    def plain(self) -> bool:
        """True if the same formulas hold at every driver coordinate: no change points, no accumulated angles."""
        return self.winding is None and self.way is None

    @property
    @abstractmethod
    def assemblies(self) -> int:
        """Largest possible number of assemblies, 1 or 2."""

    @property
    @abstractmethod
    def outer_pairs(self) -> tuple[tuple[Pair, HingeEnd | SliderEnd], ...]:
        """External pairs, each with its geometry as seen from the link of the group."""

    def place(self, poses: Poses, q: Real, drives: DriverStates) -> Placement:
        at = (self if self.way is None else replace(self, sign=self.sign * self.way.side(q))).closed(poses, drives)
        return at if self.winding is None else replace(at, poses=self.winding.followed(self.group.links, at.poses, q))

    @abstractmethod
    def closed(self, poses: Poses, drives: DriverStates) -> Placement:
        """Compute the positions of the links of the group in the assembly selected by `sign`, by the formulas of its
        type.
        """

    @abstractmethod
    def residual_rate(self, at: Placement, poses: Poses, rates: Rates, drives: DriverStates) -> Real:
        """Return the derivative of the placement residual, computed from the motion of the known links and the drivers
        alone.
        """


EndA = TypeVar("EndA", bound=HingeEnd | SliderEnd)
EndB = TypeVar("EndB", bound=HingeEnd | SliderEnd)
Inner = TypeVar("Inner", bound=HingeEnd | SliderEnd)


@dataclass(frozen=True)
class Dyad(ClosedFormSolver, Generic[EndA, EndB, Inner]):
    """Solver of an Assur group of class II: two links a and b, one internal and two external pairs.

    Attributes:
        ends: external pairs as seen from a and from b.
        inner: internal pair as seen from b.
        type: type of the dyad, e.g. RRP.
    """

    ends: tuple[EndA, EndB]
    inner: Inner

    type: ClassVar[str]
    assemblies = 2

    @classmethod
    def fits(cls, group: Group) -> bool:
        return group.type == cls.type and not group.drivers

    @classmethod
    def of(cls, group: Group, linkage: Linkage) -> Self:
        """Make the solver of a dyad of this linkage, in the first of its assemblies."""
        a, b = group.links
        ends: Any = (pair_end(group.outer[0], a, linkage), pair_end(group.outer[1], b, linkage))
        size = reduce(np.maximum, [link_extent(linkage, link) for link in (a, b, *(end.known for end in ends))])
        inner: Any = pair_end(group.inner[0], b, linkage)
        return cls(group, size, ends, inner)

    @property
    def parts(self) -> tuple[EndA, EndB, Inner]:
        """The three pairs of the dyad: external pair of a, external pair of b, internal pair."""
        return *self.ends, self.inner

    @property
    def outer_pairs(self) -> tuple[tuple[Pair, HingeEnd | SliderEnd], ...]:
        return tuple(zip(self.group.outer, self.ends, strict=True))

    def inner_on(self, pair: Pair) -> str:
        return self.group.links[1]


def link_extent(linkage: Linkage, link: str) -> Any:
    """Return the greatest distance of a point of the link from its first point, m."""
    points = list(linkage.links[link].points.values()) or [0j]
    return reduce(np.maximum, [np.abs(point - points[0]) for point in points])


def slider_search_range(linkage: Linkage) -> float:
    """Return the distance (m), to either side of the sketch, over which the motion of a sliding driver is examined.

    It is four times the extent of the largest link.
    """
    return 4 * (max(link_extent(linkage, link) for link in linkage.links) or 1.0)


def guide_line(run: SliderEnd, poses: Poses) -> tuple[Vector, Vector]:
    """Return a point of the guide (m) and the unit vector along it, in the axes of the drawing."""
    pose = poses[run.known]
    return pose.at(run.there), pose.z * unit(run.direction)


# Intersection of two guides of known links, shared by PRP and RPP.


def intersect_lines(P: Vector, u: Vector, Q: Vector, v: Vector) -> tuple[Vector, Real]:
    """Intersect the line through P along u with the line through Q along v.

    Returns:
        The intersection, and u x v, which is zero for parallel lines.
    """
    det = cross(u, v)
    with np.errstate(divide="ignore", invalid="ignore"):
        return P + u * (cross(Q - P, v) / det), det


def parallel_residual(det: Real) -> tuple[Real, Real]:
    """Return residual and slack (see Placement) of a dyad with two guides.

    Its positions are at the intersection of the guides, so it cannot be assembled where the guides are parallel within
    rounding. det: u x v, the sine of the angle between their unit vectors.
    """
    return -np.abs(det), np.full(np.shape(det), ROUNDINGS * roundoff(det))


def parallel_residual_rate(u: Vector, v: Vector, wu: Real, wv: Real) -> Real:
    """Return the derivative of the residual -|u x v| of a dyad with two guides.

    wu, wv: angular velocities of the unit vectors u and v along the guides.
    """
    rate: Real = -np.sign(cross(u, v)) * (wv - wu) * dot(u, v)
    return rate


def common_point_rate(v1: Vector, u1: Vector, v2: Vector, u2: Vector, det: Real) -> Vector:
    """Return the velocity of the intersection of two moving guides.

    The same formula gives its acceleration from accelerations.

    Args:
        v1, v2: velocity of the point of each guide that is at the intersection.
        u1, u2: unit vectors along the guides.
        det: u1 x u2.
    """
    velocity: Vector = v1 + u1 * (cross(v2 - v1, u2) / det)
    return velocity


def guide_acceleration(point: Vector, vP: Vector, guide: tuple[Vector, Vector, Rate, Accel]) -> Vector:
    """Return the acceleration of a point that slides on a moving guide, without its unknown component along the guide.

    Args:
        point: position of the point.
        vP: velocity of the point.
        guide: origin of the link with the guide, direction of the guide, velocity and acceleration of the link.
    """
    origin, u, rate, accel = guide
    arm = point - origin
    sliding = dot(u, vP - rate.at(arm))
    acceleration: Vector = accel.at(arm, rate.w) + 2j * rate.w * sliding * u
    return acceleration


def split_across_guides(rest: Vector, u1: Vector, u2: Vector, det: Real) -> tuple[Vector, Vector]:
    """Return two guide reactions that balance the force `rest`.

    One is perpendicular to the unit vector u1 and the other to u2. det: u1 x u2.
    """
    return 1j * u1 * (-dot(rest, u2) / det), 1j * u2 * (dot(rest, u1) / det)


# Solvers that modify another solver.


Step = TypeVar("Step")


@dataclass(frozen=True)
class WrappedSolver(GroupSolver):
    """A solver that uses another solver, `inner`, and changes some of its results.

    Subclasses override one of its methods. To change all results of the solution (positions, velocities, accelerations
    and reactions) in the same way, they override `passed`.
    """

    inner: GroupSolver

    @classmethod
    def around(cls, inner: GroupSolver, *own: Any) -> Self:
        """Make a solver of this class that wraps another one. own: values of the fields that the subclass adds."""
        return cls(inner.group, inner.size, inner, *own)

    def passed(self, work: Callable[..., Step], *arguments: Any) -> Step:
        """Call one method of the inner solver with these arguments."""
        return work(*arguments)

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
