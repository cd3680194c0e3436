"""Solver of a telescope with an arm: a group of three links with a driver between two of them.

These two links, the outer part m and the inner part n, slide in each other; the arm is paired with n. When the driver
coordinate is given, m and n are one body. The group is therefore solved as a dyad of the arm and m, in which the pin
that joins n to the arm is displaced in the axes of m. For velocities and accelerations the motion of n along the guide
is added to the motion of the link that supports m, so they follow from the dyad too. Reactions follow as if m and n
were one body.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import reduce
from typing import Any, Self

import numpy as np

from tmm_cli.mechanics.groups.dyads import DYAD_SOLVERS, AnyDyad
from tmm_cli.mechanics.groups.group_solver import ClosedFormSolver, HingeEnd, SliderEnd, link_extent, pair_end
from tmm_cli.mechanics.groups.state import (
    Accel,
    Accels,
    DriverState,
    DriverStates,
    GroupReactions,
    PairReaction,
    Placement,
    Pose,
    Poses,
    Rate,
    Rates,
    Wrench,
)
from tmm_cli.mechanics.linkage import Driver, Linkage, Slide
from tmm_cli.mechanics.numerics import Real, Vector, cross, dot, unit
from tmm_cli.mechanics.structure import Group, Pair

UNDER = "\0under m"  # the link to which m is attached, as seen from n; no link of a file can have this name


@dataclass(frozen=True)
class TelescopeParts:
    """Links of a telescope, and the dyad that they form when the driver is fixed.

    Attributes:
        arm: the arm, paired with n.
        n: inner part of the telescope.
        m: outer part of the telescope.
        slide: prismatic pair of m and n.
        dyad: dyad of arm and m. Its links are in the order of their external pairs, revolute pairs first; its internal
            pair is the pair of n and the arm.
    """

    arm: str
    n: str
    m: str
    slide: Slide
    dyad: Group

    @classmethod
    def of(cls, group: Group) -> TelescopeParts | None:
        """Return the links of a telescope group and their dyad; None if the group is not a telescope."""
        if (len(group.links), len(group.inner), len(group.outer), len(group.drivers)) != (3, 2, 2, 1):
            return None
        driven = [pair for pair in group.inner if pair.slide and pair.name == group.drivers[0].joint]
        if not driven or not all(pair.lower for pair in (*group.inner, *group.outer)):
            return None
        (joint,) = (pair for pair in group.inner if pair is not driven[0])
        common = {joint.i, joint.j} & {driven[0].i, driven[0].j}
        external_pair = {group.own(pair): pair for pair in group.outer}
        n = common.pop()
        m, arm = driven[0].other(n), joint.other(n)
        if common or set(external_pair) != {m, arm}:
            return None
        links = sorted((link for link in group.links if link != n), key=lambda link: external_pair[link].kind == "P")
        outer = tuple(external_pair[link] for link in links)
        slide = driven[0].slide
        assert slide is not None
        return cls(
            arm, n, m, slide, Group(tuple(links), (joint,), outer, 2, outer[0].kind + joint.kind + outer[1].kind)
        )

    @property
    def joint(self) -> Pair:
        """Pair of n and the arm."""
        return self.dyad.inner[0]


@dataclass(frozen=True)
class Telescope(ClosedFormSolver):
    """Solver of a telescope.

    Attributes:
        chain: links of the telescope.
        dyad: solver of its dyad, with the pair of n and the arm in the axes of n.
        hung: link to which m is attached.
        pin: hinge of n and the arm in the axes of n (m).
    """

    chain: TelescopeParts
    dyad: AnyDyad
    hung: str
    pin: complex

    @classmethod
    def fits(cls, group: Group) -> bool:
        chain = TelescopeParts.of(group)
        return chain is not None and chain.dyad.type in DYAD_SOLVERS

    @classmethod
    def of(cls, group: Group, linkage: Linkage) -> Self:
        chain = TelescopeParts.of(group)
        assert chain is not None
        kind, (a, b), outer = DYAD_SOLVERS[chain.dyad.type], chain.dyad.links, chain.dyad.outer
        first, last = pair_end(outer[0], a, linkage), pair_end(outer[1], b, linkage)
        size = reduce(np.maximum, [link_extent(linkage, link) for link in (*group.links, first.known, last.known)])
        inner = pair_end(chain.joint, b if b == chain.arm else chain.n, linkage)
        hung = (first if a == chain.m else last).known
        ends = (replace(first, known=UNDER), last) if a == chain.m else (first, replace(last, known=UNDER))
        pin = linkage.local(chain.n, chain.joint.point) if chain.joint.slide is None else 0j
        return cls(group, size, chain, kind(chain.dyad, size, ends, inner), hung, pin)

    @property
    def assemblies(self) -> int:
        return self.dyad.assemblies

    @property
    def outer_pairs(self) -> tuple[tuple[Pair, HingeEnd | SliderEnd], ...]:
        return tuple(
            (pair, replace(end, known=self.hung) if end.known == UNDER else end) for pair, end in self.dyad.outer_pairs
        )

    @property
    def driver(self) -> Driver:
        """The driver of the telescope."""
        return self.group.drivers[0]

    @property
    def _along(self) -> Vector:
        """Direction in which n moves along m when the driver coordinate increases, in the axes of m."""
        slide = self.chain.slide
        direction: Vector = (
            unit(slide.direction) if slide.carrier == self.chain.m else -unit(slide.direction - slide.turned)
        )
        return direction

    def _inner_part_axes(self, run: Real) -> tuple[Vector, float]:
        """Return the origin (m) and the angle (rad) of n in the axes of m, for the driver coordinate `run` (m)."""
        slide = self.chain.slide
        if slide.carrier == self.chain.m:
            return slide.through + run * unit(slide.direction) - slide.at * unit(slide.turned), slide.turned
        guide_point = slide.through + run * unit(slide.direction)
        return slide.at - guide_point * unit(-slide.turned), -slide.turned

    def _fix_driver(self, run: Real) -> AnyDyad:
        """Return the solver of the dyad with the driver fixed at the coordinate `run` (m)."""
        origin, angle = self._inner_part_axes(run)
        of_m, inner = self.chain.m == self.dyad.group.links[0], self.dyad.inner
        other_link = self.chain.m if of_m else self.chain.arm
        turned = unit(angle)
        on_other = origin + inner.there * turned if of_m else inner.there
        on_own = inner.here if of_m else origin + inner.here * turned
        moved = replace(inner, known=other_link, there=on_other, here=on_own)
        if isinstance(moved, SliderEnd):  # angles of a guide are now relative to m
            moved = replace(
                moved, direction=moved.direction + angle * of_m, turned=moved.turned + (angle if of_m else -angle)
            )
        return replace(self.dyad, inner=moved, sign=self.sign)

    def _dyad_placement(self, at: Placement) -> Placement:
        """Return the placement of the dyad: that of the telescope without its inner part n."""
        pose_of = dict(zip(self.group.links, at.poses, strict=True))
        return replace(at, poses=tuple(pose_of[link] for link in self.chain.dyad.links))

    def _poses(self, poses: Poses) -> dict[str, Pose]:
        return {**poses, UNDER: poses[self.hung]}

    def _in_group_order(self, arm: Any, n: Any, m: Any) -> Any:
        """Arrange values of the three links in the order of the links of the group."""
        value_of = {self.chain.arm: arm, self.chain.n: n, self.chain.m: m}
        return tuple(value_of[link] for link in self.group.links)

    def _drive(self, drives: DriverStates) -> DriverState:
        return drives[self.driver.link]

    def closed(self, poses: Poses, drives: DriverStates) -> Placement:
        run = self._drive(drives).value
        at = self._fix_driver(run).closed(self._poses(poses), drives)
        pose_of = dict(zip(self.chain.dyad.links, at.poses, strict=True))
        origin, angle = self._inner_part_axes(run)
        m = pose_of[self.chain.m]
        return replace(
            at, poses=self._in_group_order(pose_of[self.chain.arm], Pose(m.at(origin), m.z * unit(angle)), m)
        )

    def residual_rate(self, at: Placement, poses: Poses, rates: Rates, drives: DriverStates) -> Real:
        drive, known = self._drive(drives), self._poses(poses)
        dyad = self._fix_driver(drive.value)
        # the residual is measured with the two links as in a dead position
        flat = replace(dyad, sign=0).closed(known, drives)
        z = flat.poses[self.chain.dyad.links.index(self.chain.m)].z
        slid = drive.first * self._along * z / np.abs(z)
        return dyad.residual_rate(flat, known, self._rates(rates, slid), drives)

    def _rates(self, rates: Rates, slid: Vector) -> dict[str, Rate]:
        """Add the velocity of an imaginary link to the velocities of the links on which the group depends.

        The imaginary link moves like the link that supports m, and in addition with the velocity of n along the guide.
        The dyad is attached to it.

        slid: velocity of n relative to m along the guide.
        """
        hung = rates[self.hung]
        return {**rates, UNDER: Rate(hung.v + slid, hung.w)}

    def rates(self, at: Placement, poses: Poses, rates: Rates, drives: DriverStates) -> tuple[Rate, ...]:
        drive = self._drive(drives)
        m, off = self._outer_part_pose(at)
        slid = drive.first * self._along * m.z
        dyad_rates = self._fix_driver(drive.value).rates(
            self._dyad_placement(at), self._poses(poses), self._rates(rates, slid), drives
        )
        rate_of = dict(zip(self.chain.dyad.links, dyad_rates, strict=True))
        body = rate_of[self.chain.m]  # velocity of n at the origin of m
        ordered: tuple[Rate, ...] = self._in_group_order(
            rate_of[self.chain.arm], Rate(body.at(off), body.w), Rate(body.v - slid, body.w)
        )
        return ordered

    def _outer_part_pose(self, at: Placement) -> tuple[Pose, Vector]:
        """Return the pose of m, and the vector from the origin of m to that of n."""
        pose_of = dict(zip(self.group.links, at.poses, strict=True))
        m = pose_of[self.chain.m]
        return m, pose_of[self.chain.n].x - m.x

    def accelerations(
        self, at: Placement, poses: Poses, rates: Rates, accels: Accels, drives: DriverStates
    ) -> tuple[Accel, ...]:
        drive = self._drive(drives)
        m, off = self._outer_part_pose(at)
        of_m, hung = rates[self.chain.m], accels[self.hung]
        u = self._along * m.z
        slid = drive.first * u
        more = drive.second * u + 2j * of_m.w * slid  # Coriolis
        moving = {**self._rates(rates, slid), self.chain.m: Rate(of_m.v + slid, of_m.w)}
        dyad_accels = self._fix_driver(drive.value).accelerations(
            self._dyad_placement(at),
            self._poses(poses),
            moving,
            {**accels, UNDER: Accel(hung.a + more, hung.e)},
            drives,
        )
        accel_of = dict(zip(self.chain.dyad.links, dyad_accels, strict=True))
        body = accel_of[self.chain.m]
        ordered: tuple[Accel, ...] = self._in_group_order(
            accel_of[self.chain.arm], Accel(body.at(off, of_m.w), body.e), Accel(body.a - more, body.e)
        )
        return ordered

    def reactions(self, at: Placement, poses: Poses, applied: tuple[Wrench, ...]) -> GroupReactions:
        """Compute the reactions of the dyad, then those of the guide and the driver from the equilibrium of n."""
        chain, slide = self.chain, self.chain.slide
        pose = dict(zip(self.group.links, at.poses, strict=True))
        borne = dict(zip(self.group.links, applied, strict=True))
        m, n = pose[chain.m], pose[chain.n]
        on_n = borne[chain.n]
        whole = borne[chain.m] + Wrench(on_n.force, on_n.moment + cross(n.x - m.x, on_n.force))
        carrier, runner = pose[slide.carrier], pose[slide.runner]
        u, point = carrier.z * unit(slide.direction), runner.at(slide.at)
        run = dot(u, point - carrier.at(slide.through))
        two = {chain.arm: borne[chain.arm], chain.m: whole}
        reaction = self._fix_driver(run).reactions(
            self._dyad_placement(at), self._poses(poses), tuple(two[link] for link in chain.dyad.links)
        )
        outer = {
            pair.name: PairReaction(pair_reaction.force, pair_reaction.couple)
            for pair, pair_reaction in zip(chain.dyad.outer, reaction.outer, strict=True)
        }
        joint = reaction.inner[0]  # on the dyad's second link
        on_arm = joint if chain.dyad.links[1] == chain.arm else joint.opposite
        back = on_arm.opposite
        force = on_n.force + back.force
        guide = chain.joint.slide
        joint_at = n.at(self.pin) if guide is None else pose[guide.runner].at(guide.at)
        moment = on_n.about(point - n.x) + cross(joint_at - point, back.force)
        moment = moment if back.couple is None else moment + back.couple
        sense = -1.0 if slide.runner == chain.n else 1.0  # sign of the force that supports n, as a force on the runner
        push, across = sense * dot(u, force), sense * dot(1j * u, force)
        inner = {
            slide.name: PairReaction(1j * u * across, sense * moment),
            chain.joint.name: on_arm if chain.joint.j == chain.arm else back,
        }
        return GroupReactions(
            tuple(outer[pair.name] for pair in self.group.outer),
            tuple(inner[pair.name] for pair in self.group.inner),
            {self.driver.link: push},
        )
