"""Stage: the force plan. Groups are walked backward, each under its loads and the reactions found before it.

Kinetostatics by d'Alembert: V. A. Chufistov, L. S. Shuvalova, Force analysis of lever mechanisms, MATI 2006,
section 2.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from tmm_cli.forces.loads import Applied
from tmm_cli.groups.base import Held, Wrench
from tmm_cli.linkage import FRAME, Linkage
from tmm_cli.motion import Motion
from tmm_cli.structure.assur import Group, Pair, Structure
from tmm_cli.vectors import Real, Vector, cross, dot, unit


@dataclass(frozen=True)
class Reaction:
    """What link `by` does to link `on` in a pair: force (N) at the place `at` (m), and couple (N m) if it slides.

    arm: where a guide's force really acts, along the guide from the running point (m; infinite for a pure couple).
    signed: a guide's force, positive to the left of the guide. tangential, normal: parts of an outer hinge's force.
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

    def onto(self, link: str) -> Vector:
        """The force on one of the two links, N."""
        return self.force if link == self.on else -self.force


@dataclass(frozen=True)
class GroupForces:
    """The force plan of a group: its reactions; loads and the reactions of later groups that it bears are inputs."""

    group: Group
    outer: tuple[Reaction, Reaction]
    inner: Reaction
    borne: tuple[Reaction, ...]


@dataclass(frozen=True)
class Balance:
    """The driving link: balancing moment (N m) or force (N, on the crank's end across it, or along the cylinder).

    For a crank both are given, `force` being moment / arm; the frame's reaction belongs to the one asked for.
    """

    kind: str
    moment: Real | None
    force: Real
    vector: Vector
    at: Vector
    arm: float


@dataclass(frozen=True)
class Reactions:
    """The whole force plan."""

    applied: tuple[Applied, ...]
    groups: tuple[GroupForces, ...]
    frame: Reaction
    balance: Balance
    borne: tuple[Reaction, ...]

    @property
    def all(self) -> tuple[Reaction, ...]:
        """Every pair's reaction, the driver's first, then groups in solving order."""
        return (self.frame, *(r for g in self.groups for r in (*g.outer, g.inner)))

    def of(self, name: str) -> Reaction:
        """The reaction in a pair, by the pair's name."""
        return next(r for r in self.all if r.pair.name == name)


def react(motion: Motion, structure: Structure, loads: tuple[Applied, ...]) -> Reactions:
    """Reactions in all pairs and what balances the driver, at every position of the motion."""
    linkage = motion.linkage
    on = {name: Wrench(np.zeros(np.shape(motion.q), complex), np.zeros(np.shape(motion.q))) for name in linkage.links}
    for load in loads:
        arm = load.at * motion.poses[load.link].z
        on[load.link] += Wrench(load.force, cross(arm, load.force) + load.moment)
    borne: dict[str, list[Reaction]] = {name: [] for name in linkage.links}
    groups = []
    with np.errstate(invalid="ignore", divide="ignore"):
        for dyad, at in zip(reversed(motion.dyads), reversed(motion.placements), strict=True):
            a, b = dyad.group.links
            held = dyad.reactions(at, motion.poses, on[a], on[b])
            outer = tuple(
                _reaction(motion, pair, own, part)
                for pair, own, part in zip(dyad.group.outer, (a, b), (held.a, held.b), strict=True)
            )
            inner = _reaction(motion, dyad.group.inner[0], b, held.inner)
            groups.append(GroupForces(dyad.group, (outer[0], outer[1]), inner, (*borne[a], *borne[b])))
            for reaction in outer:
                on[reaction.by] += _opposite(reaction, motion)
                borne[reaction.by].append(reaction)
        frame, balance = _drive(motion, structure, on)
    return Reactions(loads, tuple(reversed(groups)), frame, balance, tuple(borne[linkage.driver.link]))


def _reaction(motion: Motion, pair: Pair, own: str, held: Held) -> Reaction:
    if pair.slide is None:
        at = motion.poses[own].at(motion.linkage.local(own, pair.point))
        return Reaction(pair, own, pair.other(own), at, held.force, None, held.tangential, held.normal)
    assert held.couple is not None
    slide = pair.slide
    at = motion.poses[slide.runner].at(slide.at)
    u = motion.poses[slide.carrier].z * unit(slide.direction)
    signed = dot(1j * u, held.force)
    # on the carrier both force and couple change sign, and the arm stays
    return Reaction(pair, own, pair.other(own), at, held.force, held.couple, signed=signed, arm=held.couple / signed)


def _opposite(reaction: Reaction, motion: Motion) -> Wrench:
    """The same reaction on the other link, reduced to that link's origin."""
    arm = reaction.at - motion.poses[reaction.by].x
    moment = cross(arm, -reaction.force)
    return Wrench(-reaction.force, moment if reaction.couple is None else moment - reaction.couple)


def _drive(motion: Motion, structure: Structure, on: Mapping[str, Wrench]) -> tuple[Reaction, Balance]:
    linkage: Linkage = motion.linkage
    driver = linkage.driver
    pair = structure.driving_pair
    assert pair is not None
    pose, total = motion.poses[driver.link], on[driver.link]
    if driver.kind == "turn":
        pivot = pose.at(linkage.local(driver.link, driver.joint))
        moment = -total.about(pivot - pose.x)
        end = _end(linkage)
        radius = pose.at(end) - pivot
        arm = float(np.abs(end - linkage.local(driver.link, driver.joint)))
        size = moment / arm
        vector = 1j * radius * (moment / (arm * arm))
        force = -total.force - (vector if driver.balance == "force" else 0)
        return (
            Reaction(pair, driver.link, FRAME, pivot, force),
            Balance(driver.balance, moment, size, vector, pivot + radius, arm),
        )
    slide = pair.slide
    assert slide is not None
    u = motion.poses[slide.carrier].z * unit(slide.direction) * (1 if slide.runner == driver.link else -1)
    at = motion.poses[slide.runner].at(slide.at)
    size = -dot(total.force, u)
    guide = -1j * u * dot(total.force, 1j * u)
    # the balancing force acts in the line of the running point, so moments about it leave the guide's couple
    couple = -total.about(at - pose.x)
    signed = dot(1j * u, guide)
    return (
        Reaction(pair, driver.link, FRAME, at, guide, couple, signed=signed, arm=couple / signed),
        Balance("force", None, size, size * u, at, 1.0),
    )


def _end(linkage: Linkage) -> complex:
    """The crank's end in its axes: the point named for it, or the first that is not its pivot."""
    driver = linkage.driver
    points = linkage.links[driver.link].points
    if driver.end:
        return points[driver.end]
    pivot = points[driver.joint]
    return next((p for name, p in points.items() if name != driver.joint and p != pivot), pivot + 1.0)
