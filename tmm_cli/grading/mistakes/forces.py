"""Mistakes in forces: inertia forces, weights, guide reactions, working stroke."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from tmm_cli.batch import VariantFamily
from tmm_cli.grading.mistakes.base import Mistake, Solution
from tmm_cli.language import N_
from tmm_cli.mechanics.analysis import NamedQuantity
from tmm_cli.mechanics.forces import AppliedLoad
from tmm_cli.mechanics.groups import GroupReactions, GroupSolver, Placement, Poses, WrappedSolver, Wrench
from tmm_cli.mechanics.kinematics import Motion
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.numerics import Real


@dataclass(frozen=True)
class InertiaReversed(Mistake):
    """Mistake: inertia forces, inertia couples or both are directed along the acceleration, not opposite to it."""

    parts: tuple[str, ...] = ()

    code = "inertia-reversed"
    name = N_("inertia forces not reversed")
    sentence = N_(
        "Inertia forces act opposite to the acceleration, U = -m a_S and M = -J epsilon; in this answer "
        "they act along it."
    )

    @property
    def identifier(self) -> str:
        return self.code if len(self.parts) > 1 else f"{self.code}:{self.parts[0]}"

    @classmethod
    def cases(cls, family: VariantFamily) -> Iterable[Self]:
        yield from (cls(parts) for parts in (("force",), ("moment",), ("force", "moment")))

    def change_load(self, load: AppliedLoad, motion: Motion, family: VariantFamily) -> AppliedLoad:
        if load.kind != "inertia":
            return load
        return replace(load, **{part: -getattr(load, part) for part in self.parts})


# The moment of inertia taken about a hinge instead of the centre of mass.


@dataclass(frozen=True)
class HingeInertia(Mistake):
    """Mistake: the moment of inertia is taken about a hinge, so the inertia couple is too large by m s² ε.

    Here s is the distance from the hinge to the centre of mass. link: the link concerned; "" for all links.
    """

    link: str = ""

    code = "hinge-inertia"
    name = N_("moment of inertia about the hinge")
    sentence = N_(
        "The moment of inertia was taken about the hinge; the inertia couple requires the moment of "
        "inertia about the centre of mass."
    )

    @classmethod
    def cases(cls, family: VariantFamily) -> Iterable[Self]:
        links = family.linkage.links
        own = [
            n
            for n in family.linkage.moving
            if np.any(links[n].inertia != 0) and np.any(_hinge_to_centre(family, n) != 0)
        ]
        yield from (cls(name) for name in own)
        if len(own) > 1:
            yield cls()

    def change_load(self, load: AppliedLoad, motion: Motion, family: VariantFamily) -> AppliedLoad:
        if load.kind != "inertia" or self.link not in ("", load.link):
            return load
        extra = family.linkage.links[load.link].mass * np.abs(_hinge_to_centre(family, load.link)) ** 2
        return replace(load, moment=load.moment - extra * motion.link(load.link).epsilon)


def _hinge_to_centre(family: VariantFamily, name: str) -> Real:
    """Return the vector (m) from a link's hinge, preferably one on the frame, to its centre of mass."""
    link = family.linkage.links[name]
    frame = family.linkage.links[FRAME].points
    hinge = next((p for n, p in link.points.items() if n in frame), next(iter(link.points.values()), 0j))
    return np.asarray(link.centre - hinge)


# Inertia forces left out.


@dataclass(frozen=True)
class NoInertia(Mistake):
    """Mistake: the inertia force of one link is left out, or of all links if `link` is empty."""

    link: str = ""

    code = "inertia-left-out"
    name = N_("inertia force left out")
    sentence = N_("The inertia force m a_S was left out.")
    part, of = "force", "mass"  # what is left out of the load, and what of the link makes it

    @classmethod
    def cases(cls, family: VariantFamily) -> Iterable[Self]:
        links = family.linkage.links
        own = [name for name in family.linkage.moving if np.any(getattr(links[name], cls.of) != 0)]
        yield from (cls(name) for name in own)
        if len(own) > 1:
            yield cls()

    def change_load(self, load: AppliedLoad, motion: Motion, family: VariantFamily) -> AppliedLoad:
        if load.kind != "inertia" or self.link not in ("", load.link):
            return load
        return replace(load, **{self.part: getattr(load, self.part) * 0})


# Couples of inertia left out.


@dataclass(frozen=True)
class NoCouple(NoInertia):
    """Mistake: the inertia couple of one link is left out, or of all links if `link` is empty."""

    code = "couple-left-out"
    name = N_("inertia couple left out")
    sentence = N_("The inertia couple J epsilon was left out.")
    part, of = "moment", "inertia"


# Weights left out, or masses put in for them.


@dataclass(frozen=True)
class NoWeight(Mistake):
    """Mistake: the weight of one link is left out, or of all links if `link` is empty.

    mass: True if the mass is used in place of the weight.
    """

    link: str = ""
    mass: bool = False

    code = "weight-left-out"
    name = N_("weight left out")
    sentence = N_("The weight G = m g was left out, or the mass was used in its place.")

    @property
    def identifier(self) -> str:
        return "mass-for-weight" if self.mass else super().identifier

    @classmethod
    def cases(cls, family: VariantFamily) -> Iterable[Self]:
        if np.all(family.linkage.gravity == 0):
            return
        links = family.linkage.links
        own = [name for name in family.linkage.moving if np.any(links[name].mass != 0)]
        yield from (cls(name) for name in own)
        yield from (cls("", mass) for mass in (False, True))

    def change_load(self, load: AppliedLoad, motion: Motion, family: VariantFamily) -> AppliedLoad:
        if load.kind != "weight" or self.link not in ("", load.link):
            return load
        return replace(load, force=load.force * (1 / np.abs(family.linkage.gravity) if self.mass else 0.0))


# The weight put in where the mass is wanted.


@dataclass(frozen=True)
class WeightForMass(Mistake):
    """Mistake: the weight is used in place of the mass, so inertia forces are g times too large."""

    code = "weight-for-mass"
    name = N_("weight instead of mass")
    sentence = N_(
        "The weight G was used where the mass m = G/g is required: the inertia force is 9.81 times too large."
    )

    @classmethod
    def cases(cls, family: VariantFamily) -> Iterable[Self]:
        if np.any(family.linkage.gravity != 0):
            yield cls()

    def change_load(self, load: AppliedLoad, motion: Motion, family: VariantFamily) -> AppliedLoad:
        return replace(load, force=load.force * np.abs(family.linkage.gravity)) if load.kind == "inertia" else load


# The reaction of a guide drawn through the hinge.


@dataclass(frozen=True)
class GuideThroughHinge(Mistake):
    """Mistake: the reaction of a guide is drawn through the hinge of the slider, so its arm about the hinge is zero."""

    code = "guide-through-hinge"
    name = N_("reaction of a guide drawn through the hinge")
    sentence = N_(
        "The reaction of a guide does not pass through the hinge: its point of action follows from the "
        "equation of moments."
    )
    solves = False
    scope = "answer"

    def change_values(self, quantity: NamedQuantity, values: Real, solution: Solution) -> Real:
        return values * 0 if quantity.name.startswith("arm of R_") else values


# R_ik written down for R_ki.


@dataclass(frozen=True)
class OppositeReaction(Mistake):
    """Mistake: the reaction has the opposite direction, R_ik instead of R_ki."""

    code = "opposite-reaction"
    name = N_("R_ik instead of R_ki")
    sentence = N_("This is the opposite of the requested reaction: R_ik acts from link i on link k.")
    solves = False
    scope = "answer"

    def change_values(self, quantity: NamedQuantity, values: Real, solution: Solution) -> Real:
        return -values if quantity.name.startswith("R_") else values


# The resistance acting in the wrong stroke.


@dataclass(frozen=True)
class WrongStroke(Mistake):
    """Mistake: the useful resistance acts in the return stroke instead of the working stroke.

    both: True if it acts in both strokes.
    """

    both: bool = False

    code = "load-wrong-stroke"
    name = N_("load in the wrong stroke")
    sentence = N_("The useful resistance acts in the working stroke only; in this answer it acts in the return stroke.")

    @property
    def identifier(self) -> str:
        return "load-both-strokes" if self.both else self.code

    @classmethod
    def cases(cls, family: VariantFamily) -> Iterable[Self]:
        if family.strokes is not None and any(load.working_stroke_only for load in family.linkage.loads):
            yield from (cls(False), cls(True))

    def change_family(self, family: VariantFamily) -> VariantFamily:
        assert family.strokes is not None
        strokes = family.strokes.changed(lambda s: replace(s, working=self.both or not s.working))
        return replace(family, strokes=strokes)


@dataclass(frozen=True)
class NoLoad(Mistake):
    """Mistake: the loads of the task are left out."""

    code = "load-left-out"
    name = N_("load left out")
    sentence = N_("The load of the task was left out.")
    factor = 0.0

    @classmethod
    def cases(cls, family: VariantFamily) -> Iterable[Self]:
        if family.linkage.loads:
            yield cls()

    def change_load(self, load: AppliedLoad, motion: Motion, family: VariantFamily) -> AppliedLoad:
        if load.kind != "load":
            return load
        return replace(load, force=load.force * self.factor, moment=load.moment * self.factor)


@dataclass(frozen=True)
class LoadReversed(NoLoad):
    """Mistake: the loads of the task act in the opposite direction."""

    code = "load-reversed"
    name = N_("load reversed")
    sentence = N_("The load of the task acts in the opposite direction.")
    factor = -1.0


@dataclass(frozen=True)
class LoadAtHinge(NoLoad):
    """Mistake: the loads are applied at a hinge of their link."""

    code = "load-at-hinge"
    name = N_("load applied at the hinge")
    sentence = N_("The load of the task was applied at the hinge; it acts at another point of the link.")

    def change_load(self, load: AppliedLoad, motion: Motion, family: VariantFamily) -> AppliedLoad:
        hinges = list(family.linkage.links[load.link].points.values())
        return replace(load, at=hinges[0]) if load.kind == "load" and hinges else load


@dataclass(frozen=True)
class CentreAtHinge(Mistake):
    """Mistake: the centre of mass of a link is taken at one of its hinges."""

    link: str = ""
    hinge: str = ""

    code = "centre-at-hinge"
    name = N_("centre of mass at the hinge")
    sentence = N_("The centre of mass of link {link} was taken at hinge {hinge}.")

    @classmethod
    def cases(cls, family: VariantFamily) -> Iterable[Self]:
        for name in family.linkage.moving:
            link = family.linkage.links[name]
            if np.any(link.mass != 0) and not family.linkage.slides_on_frame(name):
                yield from (cls(name, p) for p, at in link.points.items() if np.any(np.abs(link.centre - at) > 0))

    def change_family(self, family: VariantFamily) -> VariantFamily:
        links = family.linkage.links
        moved = replace(links[self.link], centre=links[self.link].points[self.hinge])
        return family.changed(replace(family.linkage, links={**links, self.link: moved}))


@dataclass(frozen=True)
class ReactionUnreversed(Mistake):
    """Mistake: a reaction is taken over to the next link without reversing it, and carried on."""

    pair: str = ""
    link: str = ""

    code = "reaction-unreversed"
    name = N_("reaction taken over unreversed")
    sentence = N_(
        "The reaction on link {link} was taken over to the next link in the same direction; reverse it there."
    )

    @classmethod
    def cases(cls, family: VariantFamily) -> Iterable[Self]:
        for kernel in family.kernels:
            for pair in kernel.group.outer:
                if pair.kind == "R" and FRAME not in (pair.i, pair.j):
                    yield cls(pair.name, kernel.group.own(pair))

    def change_solver(self, kernel: GroupSolver, family: VariantFamily) -> GroupSolver:
        names = [pair.name for pair in kernel.group.outer]
        return SolverWithUnreversedReaction.around(kernel, self.pair) if self.pair in names else kernel

    def change_values(self, quantity: NamedQuantity, values: Real, solution: Solution) -> Real:
        return -values if quantity.on and quantity.thing == self.pair and quantity.vector else values


@dataclass(frozen=True)
class SolverWithUnreversedReaction(WrappedSolver):
    """Solver of a group whose reaction in one external pair is given to the next link in the same direction."""

    pair: str

    def reactions(self, at: Placement, poses: Poses, applied: tuple[Wrench, ...]) -> GroupReactions:
        found = super().reactions(at, poses, applied)
        outer = [
            replace(reaction, force=-reaction.force) if pair.name == self.pair else reaction
            for pair, reaction in zip(self.group.outer, found.outer, strict=True)
        ]
        return replace(found, outer=tuple(outer))
