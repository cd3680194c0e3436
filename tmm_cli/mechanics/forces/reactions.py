"""Reactions in all pairs. Assur groups are solved from the last to the first.

The known forces on a group are its loads and the reactions of the groups that were solved before it. Kinetostatics by
d'Alembert's principle: V. A. Chufistov, L. S. Shuvalova, Force analysis of lever mechanisms, MATI 2006, section 2.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property, reduce

import numpy as np

from tmm_cli.mechanics.forces.loads import AppliedLoad
from tmm_cli.mechanics.groups import PairReaction, Wrench
from tmm_cli.mechanics.kinematics import DrivenLink, Motion, driven_links
from tmm_cli.mechanics.linkage import FRAME, Driver, Linkage
from tmm_cli.mechanics.numerics import INFINITELY_FAR, NO_FORCE, Real, Vector, cross, dot, unit
from tmm_cli.mechanics.structure import Group, Pair, Structure


@dataclass(frozen=True)
class Reaction:
    """Force of link `by` on link `on` in a pair at every position, and the couple if the pair transmits one.

    Attributes:
        pair: the pair.
        at: point of application, m.
        force: force on link `on`, N.
        couple: couple on link `on`, N m; None in a hinge.
        tangential, normal: components of an external hinge reaction, N; None if it is not resolved.
        signed: guide reaction (N) with its sign, positive to the left of the guide.
        arm: distance along the guide from the sliding point to the line of action, m; infinite for a pure
            couple.
        back: couple on link `by`, N m, if it is not the opposite of `couple` (oscillating cam follower given by
            its law of motion).
        angle: direction of the force, rad; None except in `Reactions.directed`.
    """

    pair: Pair
    on: str
    by: str
    at: Vector
    force: Vector
    couple: Real | None = None
    tangential: Vector | None = None
    normal: Vector | None = None
    signed: Real | None = None
    arm: Real | None = None
    back: Real | None = None
    angle: Real | None = None

    def onto(self, link: str) -> Vector:
        """Return the force on one of the two links, N."""
        return self.force if link == self.on else -self.force


@dataclass(frozen=True)
class PinForce:
    """Force (N) that the pin of a compound hinge exerts on one of its links.

    It does not depend on how the hinge is divided into pairs.
    """

    point: str
    link: str
    pairs: tuple[str, ...]
    force: Vector


@dataclass(frozen=True)
class GroupForces:
    """Reactions in the external and internal pairs of a group.

    borne: reactions that later groups exert on its links; they are already known when this group is solved.
    """

    group: Group
    outer: tuple[Reaction, ...]
    inner: tuple[Reaction, ...]
    borne: tuple[Reaction, ...]


@dataclass(frozen=True)
class Balance:
    """Balancing moment or force of a driver, on the driven link; its opposite acts on the base of the driver.

    For a crank both the moment and the force = moment / arm are given; the reaction of the frame is computed
    with the one that the file requests.

    Attributes:
        kind: "moment" or "force", as requested.
        moment: balancing moment of a crank, N m; None for a cylinder.
        force: balancing force, N: perpendicular to the crank at its end, or along the cylinder.
        vector, at: the force as a vector (N) and its point of application (m).
        arm: length of the crank, m; 1 for a cylinder; nan for an angle driven between two moving links, which
            has no force.
    """

    driver: Driver
    kind: str
    moment: Real | None
    force: Real
    vector: Vector
    at: Vector
    arm: float

    @property
    def generalized(self) -> Real:
        return self.force if self.moment is None else self.moment


@dataclass(frozen=True)
class Reactions:
    """Reactions and balancing moments or forces of the whole mechanism.

    Attributes:
        applied: the loads.
        groups: reactions of each Assur group, in solution order of the motion.
        frames: reactions of the frame on the links driven from it.
        balances: balancing moment or force of each driver.
        borne: for each link, the reactions that later groups exert on it.
    """

    applied: tuple[AppliedLoad, ...]
    groups: tuple[GroupForces, ...]
    frames: tuple[Reaction, ...]
    balances: tuple[Balance, ...]
    borne: Mapping[str, tuple[Reaction, ...]]

    @property
    def balance(self) -> Balance:
        """Balancing moment or force of the first driver."""
        return self.balances[0]

    @property
    def loaded(self) -> bool:
        """True if any load acts; otherwise all reactions and balancing moments are zero."""
        return any(load.has_force or load.has_moment for load in self.applied)

    @property
    def all(self) -> tuple[Reaction, ...]:
        """Reactions in all pairs: those of the frame on driving links first, then those of the groups."""
        return (*self.frames, *(r for g in self.groups for r in (*g.outer, *g.inner)))

    @cached_property
    def directed(self) -> tuple[Reaction, ...]:
        """All reactions with the angles of their forces.

        Where a force is zero within rounding, its angle and arm are nan.
        """
        sizes = [np.abs(r.force) for r in self.all]
        least, directed = NO_FORCE * reduce(np.maximum, sizes), []
        for r, magnitude in zip(self.all, sizes, strict=True):
            arm = None if r.arm is None else np.where(magnitude > least, r.arm, np.nan)
            directed.append(replace(r, angle=np.where(magnitude > least, np.angle(r.force), np.nan), arm=arm))
        return tuple(directed)

    def of(self, name: str) -> Reaction:
        """Return the reaction in the pair with this name."""
        return next(r for r in self.all if r.pair.name == name)

    def pins(self, linkage: Linkage) -> tuple[PinForce, ...]:
        """Return the force that the pin of each compound hinge exerts on each of its links.

        The forces of one pin add up to zero.
        """
        return tuple(
            PinForce(
                hinge.point,
                link,
                tuple(r.pair.name for r in self._at_pin(hinge.point, link)),
                self.pin_force(hinge.point, link),
            )
            for hinge in linkage.hinges
            if len(hinge.links) > 2
            for link in hinge.links
        )

    def pin_force(self, point: str, link: str) -> Vector:
        """Return the force (N) of the pin of a compound hinge on one of its links, (positions,)."""
        return reduce(np.add, [reaction.onto(link) for reaction in self._at_pin(point, link)])

    def _at_pin(self, point: str, link: str) -> list[Reaction]:
        return [r for r in self.all if r.pair.kind == "R" and r.pair.point == point and link in (r.on, r.by)]


def solve_reactions(motion: Motion, structure: Structure, loads: tuple[AppliedLoad, ...]) -> Reactions:
    """Solve the reactions in all pairs and the balancing moments or forces of the drivers at every position.

    Args:
        motion: solved motion; its groups are solved from the last to the first.
        structure: structure of the linkage.
        loads: all loads on the moving links.
    """
    linkage = motion.linkage
    applied = {
        name: Wrench(np.zeros(np.shape(motion.q), complex), np.zeros(np.shape(motion.q))) for name in linkage.links
    }
    for acting in _loads_by_point(loads):
        link, arm = acting[0].link, acting[0].at * motion.poses[acting[0].link].z
        force = reduce(np.add, [load.force for load in acting])
        applied[link] += Wrench(force, cross(arm, force) + reduce(np.add, [load.moment for load in acting]))
    borne: dict[str, list[Reaction]] = {name: [] for name in linkage.links}
    groups: list[GroupForces] = []
    frames: list[Reaction] = []
    balances: dict[str, Balance] = {}
    with np.errstate(invalid="ignore", divide="ignore"):
        for kernel, at in zip(reversed(motion.kernels), reversed(motion.placements), strict=True):
            group = kernel.group
            solution = kernel.reactions(at, motion.poses, tuple(applied[link] for link in group.links))
            parts = zip(group.outer, solution.outer, strict=True)
            outer = tuple(_reaction(motion, pair, group.own(pair), pair_force) for pair, pair_force in parts)
            parts = zip(group.inner, solution.inner, strict=True)
            inner = tuple(_reaction(motion, pair, kernel.inner_on(pair), pair_force) for pair, pair_force in parts)
            groups.append(GroupForces(group, outer, inner, tuple(r for link in group.links for r in borne[link])))
            for reaction in outer:
                applied[reaction.by] += _opposite_wrench(reaction, motion)
                borne[reaction.by].append(reaction)
            for driver in group.drivers:
                balance = balances[driver.link] = _moving_driver_balance(motion, driver, solution.drives[driver.link])
                for link, sense in ((driver.base, -1), (driver.link, 1)):
                    if link not in group.links:
                        applied[link] += _driver_wrench(motion, balance, link, sense)
        for driver in linkage.cranks:
            frame, balances[driver.link] = _frame_driver(motion, structure, driver, applied[driver.link])
            frames.append(frame)
    return Reactions(
        loads,
        tuple(reversed(groups)),
        tuple(frames),
        tuple(balances[d.link] for d in linkage.drivers),
        {name: tuple(reactions) for name, reactions in borne.items()},
    )


def _loads_by_point(loads: tuple[AppliedLoad, ...]) -> list[list[AppliedLoad]]:
    """Collect in one list the loads that act at the same point of a link, such as weight and inertia force."""
    by_point: dict[tuple[str, int], list[AppliedLoad]] = {}
    for load in loads:
        by_point.setdefault((load.link, id(load.at)), []).append(load)
    return list(by_point.values())


def reduced_driving_moment(motion: Motion, reactions: Reactions) -> Real:
    """Return the power of all drivers divided by the speed of the first one (N m or N).

    With one driver it is the balancing moment or force.
    """
    total = np.zeros(np.shape(motion.q))
    for balance in reactions.balances:
        total = total + balance.generalized * motion.drives[balance.driver.link].first
    return total


def _reaction(motion: Motion, pair: Pair, link: str, solution: PairReaction) -> Reaction:
    other = pair.other(link)
    if pair.mesh is not None:
        assert solution.at is not None
        return Reaction(pair, link, other, solution.at, solution.force, solution.couple, back=solution.back)
    if pair.slide is None:
        at = motion.poses[link].at(motion.linkage.local(link, pair.point))
        return Reaction(pair, link, other, at, solution.force, None, solution.tangential, solution.normal)
    assert solution.couple is not None
    slide = pair.slide
    at = motion.poses[slide.runner].at(slide.at)
    u = motion.poses[slide.carrier].z * unit(slide.direction)
    signed = dot(1j * u, solution.force)
    # on the carrier both force and couple change sign, so the arm is the same
    arm = _guide_reaction_arm(motion, solution.couple, signed)
    return Reaction(pair, link, other, at, solution.force, solution.couple, signed=signed, arm=arm)


def _guide_reaction_arm(motion: Motion, couple: Real, signed: Real) -> Real:
    """Compute the arm of a guide reaction (m).

    It is infinite if the reaction is a pure couple, whose force is zero except for rounding.
    """
    far = INFINITELY_FAR * reduce(np.maximum, [kernel.size for kernel in motion.kernels] or [1.0])
    arm = couple / signed
    return np.where(np.abs(arm) > far, np.sign(arm) * np.inf, arm)


def _opposite_wrench(reaction: Reaction, motion: Motion) -> Wrench:
    """Return the force and couple of a reaction on its other link `by`, reduced to the origin of that link."""
    by, pair = motion.poses[reaction.by], reaction.pair
    hinged = pair.slide is None and pair.mesh is None
    arm = motion.linkage.local(reaction.by, pair.point) * by.z if hinged else reaction.at - by.x
    moment = cross(arm, -reaction.force)
    if reaction.back is not None:
        moment = moment + reaction.back
    elif reaction.couple is not None:
        moment = moment - reaction.couple
    return Wrench(-reaction.force, moment)


def _moving_driver_balance(motion: Motion, driver: Driver, magnitude: Real) -> Balance:
    """Return the balancing moment or force of a driver between two moving links.

    magnitude: the moment or force, as found with the reactions of the group of these links.
    """
    linkage = motion.linkage
    if driver.kind == "turn":
        at = motion.poses[driver.link].at(linkage.local(driver.link, driver.joint))
        return Balance(driver, "moment", magnitude, magnitude * np.nan, magnitude * 0j, at, float("nan"))
    u, at = _cylinder_axis(motion, driver)
    return Balance(driver, "force", None, magnitude, magnitude * u, at, 1.0)


def _cylinder_axis(motion: Motion, driver: Driver) -> tuple[Vector, Vector]:
    """Return the direction in which a cylinder drives its link, and the point of application of its force (m)."""
    slide = motion.linkage.slide(driver.joint)
    u = motion.poses[slide.carrier].z * unit(slide.direction) * (1 if slide.runner == driver.link else -1)
    return u, motion.poses[slide.runner].at(slide.at)


def _driver_wrench(motion: Motion, balance: Balance, link: str, sense: int) -> Wrench:
    """Return the force and couple that a driver exerts on a link, reduced to the origin of the link.

    sense: 1 for the driven link, -1 for the base of the driver.
    """
    if balance.moment is not None:
        return Wrench(balance.moment * 0j, sense * balance.moment)
    force = sense * balance.vector
    return Wrench(force, cross(balance.at - motion.poses[link].x, force))


def _frame_driver(motion: Motion, structure: Structure, driver: Driver, total: Wrench) -> tuple[Reaction, Balance]:
    """Compute the frame reaction and the balancing moment or force of a link driven from the frame.

    total: resultant force and couple of all loads and reactions on the link.
    """
    linkage = motion.linkage
    pair = structure.driving_pair(driver)
    pose = motion.poses[driver.link]
    if driver.kind == "turn":
        pivot = pose.at(linkage.local(driver.link, driver.joint))
        moment = -total.about(pivot - pose.x)
        end = _crank_end(linkage, driver)
        radius = pose.at(end) - pivot
        arm = np.abs(end - linkage.local(driver.link, driver.joint))
        magnitude = moment / arm
        vector = 1j * radius * (moment / (arm * arm))
        force = -total.force - (vector if driver.balance == "force" else 0)
        return (
            Reaction(pair, driver.link, FRAME, pivot, force),
            Balance(driver, driver.balance, moment, magnitude, vector, pivot + radius, arm),
        )
    u, at = _cylinder_axis(motion, driver)
    magnitude = -dot(total.force, u)
    guide = -1j * u * dot(total.force, 1j * u)
    # the balancing force passes through the sliding point, so the moments about it give the couple of the guide
    couple = -total.about(at - pose.x)
    signed = dot(1j * u, guide)
    return (
        Reaction(
            pair, driver.link, FRAME, at, guide, couple, signed=signed, arm=_guide_reaction_arm(motion, couple, signed)
        ),
        Balance(driver, "force", None, magnitude, magnitude * u, at, 1.0),
    )


def _crank_end(linkage: Linkage, driver: Driver) -> complex:
    """Return the point of application of the balancing force, in the axes of the crank.

    It is the end named in the file, or the first point that differs from the pivot.
    """
    points = linkage.links[driver.link].points
    if driver.end:
        return points[driver.end]
    pivot = points[driver.joint]
    return next((p for name, p in points.items() if name != driver.joint and np.any(p != pivot)), pivot + 1.0)


# Component of the driving force that moves a driven link: Q = P cos(pressure angle).


@dataclass(frozen=True)
class TransmittedForce:
    """Reaction that drives a link, and its component along the velocity of the point of application.

    Attributes:
        group, link, pair: names of the group, the driven link and the pair.
        driving: magnitude P of the reaction, N, (positions,).
        useful: magnitude of its component Q along the velocity, N, (positions,). Without weights, inertia and
            friction Q = P cos(pressure angle).
    """

    group: str
    link: str
    pair: str
    driving: Real
    useful: Real


def find_transmitted_forces(motion: Motion, reactions: Reactions) -> tuple[TransmittedForce, ...]:
    """Compute the driving reaction P and its component Q along the velocity, for every link driven in one pair only.

    The direction of the velocity follows from the pivot or the guide of the link, so it is defined at rest too.
    """
    leads = [(kernel.group, lead) for kernel in motion.kernels for lead in driven_links(kernel.group)]
    return tuple(_transmitted(motion, reactions, group.title, lead) for group, lead in leads if len(lead[2]) == 1)


def _transmitted(motion: Motion, reactions: Reactions, group: str, lead: DrivenLink) -> TransmittedForce:
    link, outer, (pair,) = lead
    reaction = reactions.of(pair.name)
    force = reaction.onto(link)
    if outer.slide is not None:
        along = motion.poses[outer.slide.carrier].z * unit(outer.slide.direction)
        work = dot(force, along)
    else:
        radius = reaction.at - motion.poses[link].at(motion.linkage.local(link, outer.point))
        couple = 0.0 if reaction.couple is None else reaction.couple * (1 if reaction.on == link else -1)
        with np.errstate(all="ignore"):  # a pair at the pivot has no radius and drives by its couple alone
            work = (dot(force, 1j * radius) + couple) / np.abs(radius)
    return TransmittedForce(group, link, pair.name, np.abs(force), np.abs(work))
