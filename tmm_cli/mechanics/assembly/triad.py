"""All assemblies of a triad as the roots of one polynomial of degree six at most, so that none can be missed.

A triad has a middle link that is connected by three legs to links of known position. If the middle link has the origin
x and the direction z = e^(i phi), every leg is one condition:

- revolute pairs at both ends: a circle, |x + p z - C| = r; - a guide on the known link: the inner hinge stays on a
line, Re(conj(n) x) = e with a constant n; - a guide on the middle link: the outer hinge stays on a line that rotates
with the link, the same with n rotating with z; - guides at both ends: z itself is known.

Subtracting one circle from another gives a line. Two lines determine x, and the third condition is then a trigonometric
polynomial in phi of degree three at most, which is sampled on the unit circle. K. H. Hunt, Structural kinematics of
in-parallel-actuated robot arms, ASME J. Mech. Transm. Autom. Des. 105 (1983); C. Gosselin, J. Sefrioui, M. Richard,
Solutions polynomiales au probleme de la cinematique directe des manipulateurs paralleles plans, Mech. Mach. Theory 27
(1992).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np

from tmm_cli.mechanics.groups import GroupState, Pose, SliderEnd, guide_line, intersect_lines, slider_end
from tmm_cli.mechanics.linkage import Linkage
from tmm_cli.mechanics.numerics import PARALLEL, VANISHED, Real, Vector, cross, dot, unit
from tmm_cli.mechanics.structure import Group, Pair

DEGREE = 3  # of the trigonometric polynomial
SAMPLES = 16  # samples on the unit circle, more than 2 * DEGREE
ANNULUS = 0.5  # roots farther from the unit circle than this factor are not nearly real
NEAR = 0.03  # sizes of the group: largest violation of the third condition before refinement


@dataclass(frozen=True)
class LegJoint:
    """Joint at one end of a leg of a triad.

    Attributes:
        there: position of the hinge on the other link, in its axes (m).
        here: position of the hinge on the leg, in its axes (m).
        run: the prismatic pair as seen from the leg; None if the joint is a hinge.
    """

    there: complex = 0j
    here: complex = 0j
    run: SliderEnd | None = None


@dataclass(frozen=True)
class Leg:
    """A leg of a triad.

    Attributes:
        link: name of the leg.
        known: name of the known link to which it is attached.
        outer: joint with the known link.
        inner: joint with the middle link.
    """

    link: str
    known: str
    outer: LegJoint
    inner: LegJoint


@dataclass(frozen=True)
class Triad:
    """A triad: a group of a middle link and three legs.

    Attributes:
        middle: name of the middle link.
        legs: the legs.
        order: names of the links in the order of the group.
        size: unit of lengths (m).
    """

    middle: str
    legs: tuple[Leg, Leg, Leg]
    order: tuple[str, ...]
    size: float

    @classmethod
    def of(cls, group: Group, linkage: Linkage, size: float) -> Triad | None:
        """Return the middle link and the legs of a group as a Triad; None if the group is not a triad."""
        pairs = (*group.inner, *group.outer)
        if len(group.links) != 4 or len(pairs) != 6 or group.drivers or any(p.kind not in ("R", "P") for p in pairs):
            return None
        for middle in group.links:
            legs = [_make_leg(link, middle, group, linkage) for link in group.links if link != middle]
            a, b, c = legs
            if a and b and c and size > 0:
                return cls(middle, (a, b, c), group.links, size)
        return None


def _make_leg(link: str, middle: str, group: Group, linkage: Linkage) -> Leg | None:
    """Describe a link as a leg of a triad with this middle link; None if it is not a leg."""
    # links of later groups may be attached to a leg too: they do not constrain it
    outer = _find_joint(link, group.known, group.outer, linkage)
    inner = _find_joint(link, (middle,), group.inner, linkage)
    if outer is None or inner is None:
        return None
    both_turn = outer[1].run is None and inner[1].run is None
    if both_turn and outer[1].here == inner[1].here:
        return None
    return Leg(link, outer[0], outer[1], inner[1])


def _find_joint(
    link: str, others: Sequence[str], pairs: Iterable[Pair], linkage: Linkage
) -> tuple[str, LegJoint] | None:
    """Find the only joint of a link with one of `others`; None if there is none, or more than one.

    In a compound hinge any two links are joined.

    Returns:
        The name of the other link, and the joint.
    """
    joints: dict[str, tuple[str, LegJoint]] = {}
    for hinge in linkage.hinges:
        other = next((n for n in hinge.links if n in others), None)
        if link in hinge.links and other is not None:
            joint = LegJoint(linkage.local(other, hinge.point), linkage.local(link, hinge.point))
            joints[hinge.point] = (other, joint)
    for pair in pairs:
        if pair.kind == "P" and link in (pair.i, pair.j) and pair.other(link) in others:
            joints[pair.name] = (pair.other(link), LegJoint(run=slider_end(pair, link)))
    return next(iter(joints.values())) if len(joints) == 1 else None


@dataclass(frozen=True)
class LegCondition:
    """Condition that a leg imposes on the origin x of the middle link, for directions z of the middle link.

    The condition is a line Re(conj(n) x) = e or a circle |x + g| = r. Lengths are divided by the size of the triad.

    Attributes:
        n, e: the line, or None.
        g, r: the circle, or None and 0.
        z: the only direction that the leg allows, if it allows only one; otherwise None.
    """

    n: Vector | None = None
    e: Real | None = None
    g: Vector | None = None
    r: float = 0.0
    z: complex | None = None

    def residual(self, x: Vector) -> Real:
        """Return the distance of the point x from the line or circle of the condition."""
        if self.g is not None:
            distance: Real = np.abs(x + self.g) - self.r
            return distance
        assert self.n is not None
        off: Real = dot(self.n, x) - self.e
        return off


def triad_starts(triad: Triad, poses: Mapping[str, Pose]) -> tuple[GroupState, int] | None:
    """Return initial guesses for all assemblies of a triad, from the roots of its polynomial.

    Roots that are real, and those that are nearly real, are used.

    Returns:
        States (guesses, links), at least one for each assembly, and the largest number of assemblies; None if the
        polynomial is zero everywhere.
    """
    known_poses = {name: Pose(np.ravel(pose.x)[0], np.ravel(pose.z)[0]) for name, pose in poses.items()}
    fixed = next((c.z for c in leg_conditions(triad, known_poses, np.ones(1, complex)) if c.z is not None), None)
    if fixed is not None:
        lines_only = all(leg.outer.run or leg.inner.run for leg in triad.legs)
        directions, most = np.array([fixed]), 1 if lines_only else 2
    else:
        coefficients = triad_polynomial(triad, known_poses)
        magnitudes = np.abs(coefficients)
        if np.max(magnitudes) < VANISHED:
            return None
        most = 2 * max(k for k in range(DEGREE + 1) if magnitudes[DEGREE + k] > VANISHED * np.max(magnitudes))
        roots = np.roots(coefficients[::-1])
        directions = np.array([z / abs(z) for z in roots if ANNULUS < abs(z) < 1 / ANNULUS])
    guesses = [
        (x * triad.size, z)
        for z in directions
        for x in _middle_link_origins(leg_conditions(triad, known_poses, np.array([z])))
    ]
    return _make_state(triad, known_poses, guesses), most


def triad_polynomial(triad: Triad, poses: Mapping[str, Pose]) -> Vector:
    """Return the coefficients of z^-3 ... z^3 of the polynomial whose roots are the assemblies of the triad.

    z is the direction e^(i phi) of the middle link. The polynomial is real for |z| = 1.
    """
    z = unit(2 * np.pi * np.arange(SAMPLES) / SAMPLES)
    values = np.broadcast_to(closing_value(leg_conditions(triad, poses, z)), z.shape)
    spectrum = np.fft.fft(values) / SAMPLES
    return np.array([spectrum[k] for k in range(-DEGREE, DEGREE + 1)])


def closing_value(three: Sequence[LegCondition]) -> Real:
    """Return an expression that is zero where the conditions of all three legs hold at the same x."""
    circles = [c for c in three if c.g is not None]
    lines = [c for c in three if c.g is None]
    if not circles:
        (a, b, c) = lines
        left: Real = a.e * cross(b.n, c.n) + b.e * cross(c.n, a.n) + c.e * cross(a.n, b.n)
        return left
    first = circles[0]
    (n2, e2), (n3, e3) = (_as_line(c, first) for c in (*circles[1:], *lines))
    beyond: Real = np.abs(e3 * n2 - e2 * n3) ** 2 - (first.r * cross(n2, n3)) ** 2
    return beyond


def _as_line(condition: LegCondition, circle: LegCondition) -> tuple[Vector, Real]:
    """Convert the condition of a leg to a line for w = x + g, given that w lies on the circle |w| = r."""
    assert circle.g is not None
    if condition.g is None:
        assert condition.n is not None
        return condition.n, condition.e + dot(condition.n, circle.g)
    h = condition.g - circle.g
    return 2 * h, condition.r**2 - circle.r**2 - np.abs(h) ** 2


def leg_conditions(triad: Triad, poses: Mapping[str, Pose], z: Vector) -> list[LegCondition]:
    """Return the condition of each leg for directions z of the middle link."""
    return [_leg_condition(leg, poses, z, triad.size) for leg in triad.legs]


def _leg_condition(leg: Leg, poses: Mapping[str, Pose], z: Vector, size: float) -> LegCondition:
    outer, inner = leg.outer, leg.inner
    if outer.run is None and inner.run is None:
        centre = poses[leg.known].at(outer.there)
        return LegCondition(g=(inner.there * z - centre) / size, r=abs(inner.here - outer.here) / size)
    if outer.run is not None and inner.run is not None:
        return LegCondition(z=complex(_leg_direction(leg, poses) * np.conj(unit(inner.run.turned))))
    if outer.run is not None:
        through, along = guide_line(outer.run, poses)
        through = through + (inner.here - outer.run.here) * _leg_direction(leg, poses)
        n = np.broadcast_to(1j * along, np.shape(z))
        return LegCondition(n=n, e=dot(n, through - inner.there * z) / size)
    assert inner.run is not None
    centre = poses[leg.known].at(outer.there)
    n = 1j * unit(inner.run.direction) * z
    foot = inner.run.there - (inner.run.here - outer.here) * unit(inner.run.turned)
    return LegCondition(n=n, e=dot(n, centre - foot * z) / size)


def _leg_direction(leg: Leg, poses: Mapping[str, Pose]) -> Any:
    """Return the direction of a leg that slides along a guide of a known link."""
    assert leg.outer.run is not None
    return poses[leg.known].z * unit(leg.outer.run.turned)


def _middle_link_origins(three: Sequence[LegCondition]) -> list[complex]:
    """Return the origins of the middle link at which two conditions hold and the third nearly holds.

    Lengths are in units of the size of the triad.
    """
    binding = [c for c in three if c.z is None]
    origins = []
    for first, second in combinations(binding, 2):
        third = [c for c in binding if c is not first and c is not second]
        for x in _meeting_points(first, second):
            if all(abs(complex(c.residual(x)[0])) < NEAR for c in third):
                origins.append(complex(x[0]))
    return origins


def _meeting_points(first: LegCondition, second: LegCondition) -> list[Vector]:
    """Return the points that satisfy two conditions; if none does but some nearly do, the points nearest to both."""
    if first.g is None:
        first, second = second, first
    if first.g is None:  # two lines
        assert first.n is not None and second.n is not None
        det = cross(first.n, second.n)
        return [] if abs(det[0]) < PARALLEL else [1j * (second.e * first.n - first.e * second.n) / det]
    n, e = _as_line(second, first)
    if abs(n[0]) < PARALLEL:  # concentric circles
        return []
    foot = n * (e / np.abs(n) ** 2)
    half = np.sqrt(np.maximum(first.r**2 - np.abs(foot) ** 2, 0)) * 1j * n / np.abs(n)
    if abs(foot[0]) > first.r + NEAR:
        return []
    return [foot + half - first.g, foot - half - first.g]


def _make_state(triad: Triad, poses: Mapping[str, Pose], starts: Sequence[tuple[complex, complex]]) -> GroupState:
    """Compute the states of all links of a triad from origins x (m) and directions z of its middle link."""
    x, z = (np.array([start[k] for start in starts], complex) for k in (0, 1))
    link_states = {triad.middle: (x, z)}
    for leg in triad.legs:
        outer, inner = leg.outer, leg.inner
        if outer.run is not None:
            along = _leg_direction(leg, poses) * np.ones(np.shape(z))
            if inner.run is None:
                link_states[leg.link] = (x + inner.there * z - inner.here * along, along)
                continue
            (foot, u), v = guide_line(outer.run, poses), z * unit(inner.run.direction)
            with np.errstate(all="ignore"):
                link_states[leg.link] = (
                    intersect_lines(
                        foot - outer.run.here * along, u, x + inner.run.there * z - inner.run.here * along, v
                    )[0],
                    along,
                )
            continue
        centre = poses[leg.known].at(outer.there)
        if inner.run is not None:
            along = z * unit(inner.run.turned)
        else:
            arm = (x + inner.there * z - centre) / (inner.here - outer.here)
            along = arm / np.maximum(np.abs(arm), 1e-300)
        link_states[leg.link] = (centre - outer.here * along, along)
    ordered = [link_states[link] for link in triad.order]
    return GroupState(np.stack([p for p, _ in ordered], -1), np.stack([np.angle(d) for _, d in ordered], -1))
