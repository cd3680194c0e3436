"""Mistakes in the motion: wrong assembly; normal, tangential or Coriolis acceleration left out."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, fields, replace
from typing import Any, Self

from tmm_cli.batch import VariantFamily
from tmm_cli.grading.mistakes.base import Mistake
from tmm_cli.language import N_
from tmm_cli.mechanics.groups import (
    Accel,
    Accels,
    ClosedFormSolver,
    DriverStates,
    GroupSolver,
    GuideGeometry,
    NewtonSolver,
    PairConstraint,
    Placement,
    Poses,
    Rate,
    Rates,
    SlideConstraint,
    WrappedSolver,
)
from tmm_cli.mechanics.kinematics import Motion, PointMotion
from tmm_cli.mechanics.linkage import FRAME, Linkage
from tmm_cli.mechanics.numerics import Real, cross


@dataclass(frozen=True)
class Mirror(Mistake):
    """Mistake: an Assur group is drawn in its other (mirror-image) assembly; links: names of its links."""

    links: str = ""

    code = "mirror"
    name = N_("mirror-image assembly")
    sentence = N_("This answer is for another assembly: links {links} were drawn on the other side.")

    @property
    def identifier(self) -> str:
        return f"{self.code}:{self.links}"

    @classmethod
    def cases(cls, family: VariantFamily) -> Iterable[Self]:
        for kernel in family.kernels:
            if isinstance(kernel, ClosedFormSolver) and kernel.assemblies == 2:
                yield cls(", ".join(kernel.group.links))

    def change_solver(self, kernel: GroupSolver, family: VariantFamily) -> GroupSolver:
        if isinstance(kernel, ClosedFormSolver) and ", ".join(kernel.group.links) == self.links:
            return replace(kernel, sign=-kernel.sign)
        return kernel


# Groups whose accelerations follow from other velocity terms; places, velocities and reactions are right.


Terms = Callable[[PairConstraint, Poses, Rates], Any]  # the velocity terms of a pair as the student has them


@dataclass(frozen=True)
class EquationsWithTerms(NewtonSolver):
    """Solver of a group by a system of equations whose velocity terms are changed.

    Velocity terms are the terms of the acceleration equations that depend on velocities only. `terms` computes the
    changed ones for each pair.
    """

    terms: Terms = field(kw_only=True)

    def velocity_terms(self, poses: Poses, rates: Rates) -> list[Real]:
        return [term for constraint in self.constraints for term in self.terms(constraint, poses, rates)]


@dataclass(frozen=True)
class SolverWithTerms(WrappedSolver):
    """Solver of a group that computes accelerations with changed velocity terms, and everything else correctly."""

    equations: EquationsWithTerms

    @classmethod
    def of(cls, right: GroupSolver, linkage: Linkage, terms: Terms) -> SolverWithTerms:
        """Build the solver from the correct one; `terms` computes the changed velocity terms of each pair."""
        plain = NewtonSolver.of(right.group.rebind(linkage), linkage)
        own = {f.name: getattr(plain, f.name) for f in fields(plain)}
        return cls.around(right, EquationsWithTerms(**own, terms=terms))

    def accelerations(
        self, at: Placement, poses: Poses, rates: Rates, accels: Accels, drives: DriverStates
    ) -> tuple[Accel, ...]:
        return self.equations.accelerations(at, poses, rates, accels, drives)


# The normal part of a link's acceleration left out.


@dataclass(frozen=True)
class Normal(Mistake):
    """Mistake: the normal acceleration of one link is left out."""

    link: str = ""

    code = "normal-left-out"
    name = N_("normal component left out")
    sentence = N_("The normal component omega^2 r of the acceleration of link {link} was left out.")

    @classmethod
    def cases(cls, family: VariantFamily) -> Iterable[Self]:
        linkage = family.linkage
        yield from (cls(link) for link in linkage.moving if not linkage.slides_on_frame(link))

    def change_solver(self, kernel: GroupSolver, family: VariantFamily) -> GroupSolver:
        if self.link in kernel.group.links:
            return SolverWithTerms.of(kernel, family.linkage, self._change_terms)
        slides = [pair.slide for pair in kernel.group.inner if pair.slide is not None]
        if slides and self.link in kernel.group.known:  # the velocity along the guide stays right
            return SolverWithTerms.of(kernel, family.linkage, self._change_terms)
        return WithoutNormal.around(kernel, self.link)

    def _change_terms(self, pair: PairConstraint, poses: Poses, rates: Rates) -> Any:
        still = stop_rotation(rates, self.link)
        if not isinstance(pair, SlideConstraint):
            return pair.velocity_terms(poses, still)
        here, (turned, across) = GuideGeometry.at(pair.slide, poses), pair.velocity_terms(poses, rates)
        return turned, across + cross(here.u, here.bend(pair.slide, still) - here.bend(pair.slide, rates))

    def change_motion(self, motion: Motion) -> Motion:
        return MotionWithoutNormal(**vars(motion), link_without=self.link)


def stop_rotation(rates: Rates, link: str) -> Rates:
    """Return the velocities of the links with the rotation of one link set to zero."""
    return {**rates, link: replace(rates[link], w=rates[link].w * 0)}


@dataclass(frozen=True)
class WithoutNormal(WrappedSolver):
    """Solver of a group that is attached to `link` and leaves out the normal acceleration of this link."""

    link: str

    def accelerations(
        self, at: Placement, poses: Poses, rates: Rates, accels: Accels, drives: DriverStates
    ) -> tuple[Accel, ...]:
        known = stop_rotation(rates, self.link) if self.link in self.group.known and self.link in rates else rates
        return self.inner.accelerations(at, poses, known, accels, drives)


@dataclass(frozen=True, kw_only=True)
class MotionWithoutNormal(Motion):
    """Motion of the mechanism in which the points of one link have no normal acceleration about its origin."""

    link_without: str

    def _point(self, link: str, local: complex) -> PointMotion:
        found = super()._point(link, local)
        if link != self.link_without:
            return found
        extra = self.first[link].w ** 2 * local * self.poses[link].z
        second = found.second + extra
        return replace(found, second=second, a=found.a + extra * self.rate**2)


# The tangential part of a link's acceleration left out.


@dataclass(frozen=True)
class Tangential(Mistake):
    """Mistake: the tangential acceleration of a link is left out; the link has a hinge with a link outside its Assur
    group.
    """

    link: str = ""

    code = "tangential-left-out"
    name = N_("tangential component left out")
    sentence = N_("The tangential component epsilon r of the acceleration of link {link} was left out.")

    @classmethod
    def cases(cls, family: VariantFamily) -> Iterable[Self]:
        for kernel in family.kernels:
            for pair in kernel.group.outer:
                if pair.kind == "R":
                    yield cls(kernel.group.own(pair))

    def change_solver(self, kernel: GroupSolver, family: VariantFamily) -> GroupSolver:
        if self.link not in kernel.group.links:
            return kernel
        pair = next(p for p in kernel.group.outer if p.kind == "R" and kernel.group.own(p) == self.link)
        linkage, other = family.linkage, pair.other(self.link)
        there, here = linkage.local(other, pair.point), linkage.local(self.link, pair.point)
        return WithoutAngularAcceleration.around(kernel, self.link, other, there, here)


@dataclass(frozen=True)
class WithoutAngularAcceleration(WrappedSolver):
    """Solver of a group in which the angular acceleration of one link is set to zero.

    Attributes:
        link: the link without angular acceleration.
        known: link outside the group to which it is hinged.
        there, here: coordinates of this hinge in the axes of `known` and of `link` (complex, m).
    """

    link: str
    known: str
    there: complex
    here: complex

    def accelerations(
        self, at: Placement, poses: Poses, rates: Rates, accels: Accels, drives: DriverStates
    ) -> tuple[Accel, ...]:
        found = dict(zip(self.group.links, self.inner.accelerations(at, poses, rates, accels, drives), strict=True))
        hinge = accels[self.known].at(self.there * poses[self.known].z, rates[self.known].w)
        w, arm = rates[self.link].w, self.here * poses[self.link].z
        found[self.link] = Accel.through(hinge, w * 0, w, arm)
        return tuple(found.values())


# The Coriolis acceleration left out or reversed.


@dataclass(frozen=True)
class Coriolis(Mistake):
    """Mistake: the Coriolis acceleration of a link on a moving guide is left out or reversed.

    Attributes:
        runner: the sliding link.
        carrier: the link that carries the guide.
        sense: factor of the Coriolis acceleration: 0 if left out, -1 if reversed.
    """

    runner: str = ""
    carrier: str = ""
    sense: int = 0

    code = "coriolis-left-out"
    name = N_("wrong Coriolis acceleration")
    sentence = N_(
        "The Coriolis acceleration of link {runner} on link {carrier} was left out or has the opposite direction."
    )

    @property
    def identifier(self) -> str:
        return "coriolis-reversed" if self.sense else self.code

    @classmethod
    def cases(cls, family: VariantFamily) -> Iterable[Self]:
        for slide in family.linkage.slides:
            if FRAME not in (slide.carrier, slide.runner):
                yield from (cls(slide.runner, slide.carrier, sense) for sense in (0, -1))

    def change_solver(self, kernel: GroupSolver, family: VariantFamily) -> GroupSolver:
        slides = [pair.slide for pair in (*kernel.group.inner, *kernel.group.outer) if pair.slide is not None]
        if all(slide.runner != self.runner for slide in slides):
            return kernel
        return SolverWithTerms.of(kernel, family.linkage, self._change_terms)

    def _change_terms(self, pair: PairConstraint, poses: Poses, rates: Rates) -> Any:
        found = pair.velocity_terms(poses, rates)
        if not (isinstance(pair, SlideConstraint) and pair.links == (self.carrier, self.runner)):
            return found
        turned, across = found
        coriolis = 2 * rates[self.carrier].w * GuideGeometry.at(pair.slide, poses).sliding(pair.slide, rates)
        return turned, across + (1 - self.sense) * coriolis


@dataclass(frozen=True)
class SolverWithCrankPin(WrappedSolver):
    """Solver of an Assur group attached to a crank, for which the velocities of the crank are multiplied by a factor.

    The accelerations of the crank are not changed.
    """

    factor: Real
    cranks: frozenset[str]

    def rates(self, at: Placement, poses: Poses, rates: Rates, drives: DriverStates) -> tuple[Rate, ...]:
        crank = {name: rates[name] for name in self.group.known if name in self.cranks and name in rates}
        scaled = {name: Rate(rate.v * self.factor, rate.w * self.factor) for name, rate in crank.items()}
        return super().rates(at, poses, {**rates, **scaled}, drives)
