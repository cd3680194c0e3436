"""Pressure angles of the groups over the range of the driver.

The pressure angle is the acute angle between the force that drives a link, without gravity and inertia, and the
velocity of its point of action (I. I. Artobolevsky, Theory of Mechanisms and Machines, ch. 5). The force follows from
statics: a moment (or a force along its guide) resists the motion of the link, and the other links of its group are not
loaded. The reactions of the group then show where the link is driven and in what direction. The method therefore holds
for groups of any class, without special formulas.

A link that is driven in several pairs at once (an external link of a class IV contour) has a force and a velocity in
each of them. The cosine of its pressure angle is the power of these forces divided by the power that they would have if
they acted along the velocities. For one pair this is the angle defined above, and it is 90 deg in dead positions only.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from tmm_cli.mechanics.groups import GroupSolver, LinkStates, Placement, Wrench, link_states, solvers_towards
from tmm_cli.mechanics.kinematics.driver_range import SCAN, DriverRange
from tmm_cli.mechanics.linkage import FRAME, Linkage
from tmm_cli.mechanics.numerics import (
    ALIKE_ANGLES,
    DEAD,
    LOST_IN_ROUNDING,
    NO_PRESSURE,
    RIGHT_ANGLE,
    ROUNDINGS,
    ROUNDOFF,
    Real,
    cross,
    dot,
    find_minima,
    locate_extreme,
    unit,
)
from tmm_cli.mechanics.structure import Group, Pair


@dataclass(frozen=True)
class PressureAngle:
    """Largest pressure angle of a driven link.

    Attributes:
        group: title of the group of the link.
        link: name of the link.
        pair: name of the pair in which the link is driven; several names are separated by commas.
        slides: True if the link slides on the frame, False if it rotates.
        largest: largest pressure angle (rad).
        place: driver coordinate at which it occurs (rad or m).
        allowed: allowed pressure angle (rad).
        angles: pressure angles at the positions of a motion (rad).
        other: largest pressure angle (rad) of all positions in which the force lies on the other side of the velocity
            than at `place`. In a four-bar the crank lies on the line of the frame at both extremes. It is nan for a
            link that is driven in several pairs or at a constant angle.
        other_place: driver coordinate at which `other` occurs.
    """

    group: str
    link: str
    pair: str
    slides: bool
    largest: float
    place: float
    allowed: float
    angles: Real = field(default_factory=lambda: np.zeros(0))
    other: float = float("nan")
    other_place: float = float("nan")

    @property
    def transmission(self) -> float:
        """Smallest transmission angle, rad."""
        return np.pi / 2 - self.largest

    @property
    def gain(self) -> float:
        """Force amplification 1/cos(pressure angle) at the largest pressure angle; infinite in a dead position."""
        return float(1 / np.cos(self.largest)) if self.largest < np.pi / 2 - DEAD else float("inf")

    @property
    def holds(self) -> bool:
        """True if the pressure angle never exceeds the allowed one."""
        return self.largest <= self.allowed + ALIKE_ANGLES


FLAT = 3  # samples: at a curved maximum at most two are equal

DrivenLink = tuple[
    str, Pair, tuple[Pair, ...]
]  # a driven link, the pair that supports it, the pairs in which it is driven


def driving_pair_names(lead: DrivenLink) -> str:
    """Return the names of the pairs in which a link is driven, separated by commas."""
    return ", ".join(pair.name for pair in lead[2])


def driven_links(group: Group) -> Iterable[DrivenLink]:
    """Return the driven links of a group, each with its supporting pair and the pairs in which it is driven.

    Driven links are those supported by the frame. If the frame supports none, the last link with an external pair is
    taken.
    """
    leads = []
    for outer in group.outer:
        link = group.own(outer)
        inner = tuple(p for p in group.inner if link in (p.i, p.j))
        held = [p for p in group.outer if link in (p.i, p.j)]
        if outer.lower and inner and len(held) == 1 and all(p.lower for p in inner):
            leads.append((link, outer, inner))
    on_frame = [lead for lead in leads if FRAME in (lead[1].i, lead[1].j)]
    return on_frame or leads[-1:]


def pressure_angle(motion: LinkStates, kernel: GroupSolver, at: Placement, lead: DrivenLink) -> Real:
    """Return the pressure angle of a driven link at every position, rad; nan where it is undefined.

    Args:
        motion: states of all links.
        kernel: solver of the group of the link.
        at: placement of the group.
        lead: the driven link, from `driven_links`.
    """
    angles: Real = np.arctan2(*pressure_sine_and_cosine(motion, kernel, at, lead))
    return np.where(angles < NO_PRESSURE, 0.0, angles)


def signed_pressure_angle(motion: LinkStates, kernel: GroupSolver, at: Placement, lead: DrivenLink) -> Real:
    """Return the pressure angle of a link driven in one pair (rad), with a sign.

    The sign shows on which side of the velocity the force lies.
    """
    across, along = _single_pair_components(motion, kernel, at, lead)
    angles: Real = np.arctan2(across * np.sign(along), np.abs(along))
    return angles


def pressure_sine_and_cosine(
    motion: LinkStates, kernel: GroupSolver, at: Placement, lead: DrivenLink
) -> tuple[Real, Real]:
    """Return two numbers, not negative, that are proportional to the sine and the cosine of the pressure angle."""
    parts = list(_force_components(motion, kernel, at, lead))
    if len(parts) == 1:
        ((power, aside),) = parts
        return np.abs(aside), np.abs(power)
    along, lost, loose = (np.zeros(np.shape(motion.q)) for _ in range(3))
    for power, aside in parts:
        most = np.hypot(power, aside)
        along, loose = along + power, loose + most
        lost = lost + np.where(power > 0, aside * aside / np.where(most > 0, most + power, 1.0), most - power)
    lost = np.where(lost > LOST_IN_ROUNDING * loose, lost, 0.0)
    return np.sqrt(lost * (loose + along)), np.abs(along)


def _single_pair_components(
    motion: LinkStates, kernel: GroupSolver, at: Placement, lead: DrivenLink
) -> tuple[Real, Real]:
    """Return the components of the driving force across and along the velocity of its point of action.

    This is for a link that is driven in one pair.
    """
    ((power, aside),) = _force_components(motion, kernel, at, lead)
    return aside, power


def _force_components(
    motion: LinkStates, kernel: GroupSolver, at: Placement, lead: DrivenLink
) -> Iterable[tuple[Real, Real]]:
    """Yield the components of the driving force along and across the velocity of its point, for each driving pair.

    A unit moment, or a unit force along its guide, resists the motion of the link. The components along the velocity
    have the same sign in all pairs, opposite to the resistance. Those across are positive to the left of the velocity.
    """
    link, outer, pairs = lead
    group, poses = kernel.group, motion.poses
    pose = poses[link]
    still = np.zeros(np.shape(motion.q))
    if outer.slide is None:
        pivot = pose.at(motion.linkage.local(link, outer.point))
        resistance = Wrench(still + 0j, still + 1.0)
    else:
        u = poses[outer.slide.carrier].z * unit(outer.slide.direction)
        resistance = Wrench(u, cross(poses[outer.slide.runner].at(outer.slide.at) - pose.x, u))
    applied = tuple(resistance if name == link else Wrench(still + 0j, still) for name in group.links)
    reactions = kernel.reactions(at, poses, applied).inner
    inner = [pair.name for pair in group.inner]
    for pair in pairs:
        reaction = reactions[inner.index(pair.name)]
        force = reaction.force if kernel.inner_on(pair) == link else -reaction.force
        if pair.slide is None:
            point = poses[pair.i].at(motion.linkage.local(pair.i, pair.point))
        else:
            point = poses[pair.slide.runner].at(pair.slide.at)
            guide = poses[pair.slide.carrier].z * unit(pair.slide.direction)
            assert reaction.couple is not None
            point = point + guide * reaction.couple / dot(reaction.force, 1j * guide)
        velocity = u if outer.slide is not None else 1j * (point - pivot)
        yield -dot(force, velocity), -cross(force, velocity)


def find_pressure(
    linkage: Linkage, kernels: tuple[GroupSolver, ...], driver_range: DriverRange, allowed: tuple[float, float]
) -> tuple[PressureAngle, ...]:
    """Find the largest pressure angle of every driven link over the range of the driver.

    allowed: allowed pressure angles (rad) of sliding and of rotating links.
    """
    ends = (driver_range.end - driver_range.start) * 1e-9 * (not (driver_range.full or driver_range.inclusive))
    q = np.linspace(driver_range.start + ends, driver_range.end - ends, SCAN * driver_range.turns + 1)
    scan = link_states(linkage, kernels, q, 0)  # statics needs no velocities
    pressure_angles = []
    with np.errstate(all="ignore"):
        for number, kernel in enumerate(kernels):
            upto = solvers_towards(kernels, kernel.group.links)
            for lead in driven_links(kernel.group):
                angles = pressure_angle(scan, kernel, scan.placements[number], lead)
                if not np.any(np.isfinite(angles)):
                    continue
                k = int(np.argmax(angles >= np.nanmax(angles) - ALIKE_ANGLES))  # the first of equal values
                place, value = float(q[k]), float(angles[k])
                right = [
                    end
                    for end, inward in _blocked_ends(driver_range)
                    if _tends_to_right_angle(linkage, upto, lead, end, inward * ends)
                ]
                if right:
                    place, value = right[0], np.pi / 2
                elif value > 0 and not _is_constant(
                    angles[k : k + FLAT]
                ):  # otherwise rounding would determine the position of the maximum
                    low, high = q[max(k - 1, 0)], q[min(k + 1, len(q) - 1)]
                    back = partial(_negative_angle, linkage, upto, lead)
                    place, value = find_minima(back, low, high)
                    place, value = locate_extreme(back, place, min(high - place, place - low)), -value
                    if value - angles[k] < ROUNDINGS * ROUNDOFF:
                        place = float(q[k])
                slides = lead[1].kind == "P"
                limit = allowed[0 if slides else 1]
                largest = PressureAngle(
                    kernel.group.title, lead[0], driving_pair_names(lead), slides, value, place, limit
                )
                other = _other_extreme(linkage, upto, lead, scan, number, place) if value > 0 else None
                if other is not None:
                    largest = replace(largest, other=other[0], other_place=other[1])
                pressure_angles.append(largest)
    return tuple(pressure_angles)


def _other_extreme(
    linkage: Linkage, kernels: tuple[GroupSolver, ...], lead: DrivenLink, scan: LinkStates, number: int, place: float
) -> tuple[float, float] | None:
    """Find the largest pressure angle in positions where the force lies on the other side of the velocity than at
    `place`.

    Returns:
        The angle (rad) and the driver coordinate; None if the link is driven in several pairs or at a constant angle.
    """
    if len(lead[2]) > 1:
        return None
    q = scan.q
    angles = signed_pressure_angle(scan, scan.kernels[number], scan.placements[number], lead)
    defined = np.isfinite(angles)  # undefined at a change point
    side = np.sign(angles[int(np.argmin(np.where(defined, np.abs(q - place), np.inf)))])
    if not side or not np.ptp(angles[defined]) > ALIKE_ANGLES:
        return None

    def leaning(at: Real) -> Real:
        motion = link_states(linkage, kernels, at, 0)
        angles: Real = side * signed_pressure_angle(motion, kernels[-1], motion.placements[-1], lead)
        return angles

    k = int(np.nanargmin(side * angles))
    low, high = q[max(k - 1, 0)], q[min(k + 1, len(q) - 1)]
    end, value = find_minima(leaning, low, high)
    end = locate_extreme(leaning, end, min(high - end, end - low))
    return abs(float(value)), float(end)


def pressure_at(motion: LinkStates, group: str, link: str) -> Real:
    """Return the pressure angle of a driven link at every position, rad; nan where it is undefined.

    Args:
        motion: states of all links.
        group: title of the group of the link.
        link: name of the link.
    """
    for kernel, at in zip(motion.kernels, motion.placements, strict=True):
        for lead in driven_links(kernel.group) if kernel.group.title == group else ():
            if lead[0] == link:
                with np.errstate(all="ignore"):
                    return pressure_angle(motion, kernel, at, lead)
    return np.full(np.shape(motion.q), np.nan)


def _is_constant(angles: Real) -> bool:
    """Return True if the pressure angle is the same in these samples, within rounding."""
    return len(angles) == FLAT and bool(np.ptp(angles) < ALIKE_ANGLES)


def _blocked_ends(driver_range: DriverRange) -> tuple[tuple[float, int], ...]:
    """Return the ends of the driver range at which a group stops the driver.

    Each is returned with the direction from this end into the range, +1 or -1.
    """
    stops = {limit.place for limit in driver_range.limits}
    return tuple(end for end in ((driver_range.start, 1), (driver_range.end, -1)) if end[0] in stops)


def _tends_to_right_angle(
    linkage: Linkage, kernels: tuple[GroupSolver, ...], lead: DrivenLink, end: float, inward: float
) -> bool:
    """Return True if the pressure angle of the last group tends to 90 deg at an end of the range.

    It is extrapolated as a polynomial in the square root of the distance from the end, from points one, four and
    sixteen steps inside the range.
    """
    near = -_negative_angle(linkage, kernels, lead, end + inward * np.array([1, 4, 16]))
    return bool(abs(np.array([8, -6, 1]) @ near / 3 - np.pi / 2) < RIGHT_ANGLE)


def _negative_angle(linkage: Linkage, kernels: tuple[GroupSolver, ...], lead: DrivenLink, q: Real) -> Real:
    """Return the pressure angle of the last group with a minus sign, so that a search of minima finds its maxima.

    It is -90 deg where the group is in a dead position.
    """
    motion = link_states(linkage, kernels, q, 0)
    at = motion.placements[-1]
    return np.where(at.dead, -np.pi / 2, -pressure_angle(motion, kernels[-1], at, lead))
