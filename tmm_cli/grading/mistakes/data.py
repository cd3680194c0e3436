"""Mistakes in input data and units: degrees, millimetres, rpm, zero position, sense of rotation, scale factor."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from tmm_cli.batch import VariantFamily
from tmm_cli.grading.mistakes.base import Mistake, Solution
from tmm_cli.grading.mistakes.motion import SolverWithCrankPin, SolverWithTerms
from tmm_cli.language import N_, _, numeral
from tmm_cli.mechanics.analysis import NamedQuantity
from tmm_cli.mechanics.forces import AppliedLoad
from tmm_cli.mechanics.groups import GroupReactions, GroupSolver, Placement, Poses, WrappedSolver, Wrench
from tmm_cli.mechanics.kinematics import Motion
from tmm_cli.mechanics.numerics import Real


@dataclass(frozen=True)
class Degrees(Mistake):
    """Mistake: an angle, angular velocity or angular acceleration is in degrees instead of radians, or the reverse."""

    factor: float = 1.0

    code = "degrees-for-radians"
    name = N_("degrees instead of radians")
    sentence = N_("This is the right value in another unit of angle: degrees were taken for radians, or the reverse.")
    solves = False
    scope = "answer"

    @classmethod
    def cases(cls, family: VariantFamily) -> Iterable[Self]:
        yield from (cls(180 / np.pi), cls(np.pi / 180))

    def change_values(self, quantity: NamedQuantity, values: Real, solution: Solution) -> Real:
        return values * self.factor if quantity.dimension.angle and quantity.against != "angle" else values


# Millimetres taken for metres, or metres for millimetres.


@dataclass(frozen=True)
class Millimetres(Mistake):
    """Mistake: a quantity with a length in its dimension is in millimetres instead of metres, or the reverse."""

    factor: float = 1.0

    code = "mm-for-m"
    name = N_("mm instead of m")
    sentence = N_("This is 1000 times the right value, or a thousandth of it: millimetres and metres were mixed up.")
    solves = False
    scope = "answer"

    @classmethod
    def cases(cls, family: VariantFamily) -> Iterable[Self]:
        yield from (cls(1000.0), cls(0.001))

    def change_values(self, quantity: NamedQuantity, values: Real, solution: Solution) -> Real:
        return values * self.factor if quantity.dimension.length else values


# Revolutions a minute taken for radians a second.


@dataclass(frozen=True)
class Rpm(Mistake):
    """Mistake: the crank speed is wrong by a factor: rpm used as rad/s, 2 pi or 60 left out, or 2 pi used twice."""

    factor: float = 30 / np.pi

    code = "crank-speed"
    name = N_("rpm instead of rad/s")
    sentence = N_("The speed of the crank was substituted in revolutions per minute; use omega = pi n / 30 in rad/s.")

    @classmethod
    def cases(cls, family: VariantFamily) -> Iterable[Self]:
        if family.linkage.driver.kind == "turn":
            yield from (cls(factor) for factor in (30 / np.pi, 1 / (2 * np.pi), 60.0, 2 * np.pi))

    @property
    def label(self) -> str:
        return super().label if self == Rpm() else _("crank speed wrong by a factor")

    @property
    def description(self) -> str:
        if self == Rpm():
            return super().description
        return _("The speed of the crank is {factor} times the right one; use omega = 2 pi n / 60 in rad/s.").format(
            factor=numeral(self.factor, ".3g")
        )

    def change_family(self, family: VariantFamily) -> VariantFamily:
        driver = family.linkage.driver
        return family.changed(replace(family.linkage, driver=replace(driver, rate=driver.rate * self.factor)))


@dataclass(frozen=True)
class DegreesInSine(Mistake):
    """Mistake: the crank angle in degrees is used in sines and cosines that expect radians.

    reduced: True if the angle is reduced to 0 to 360 degrees before.
    """

    reduced: bool = False

    code = "degrees-in-sine"
    name = N_("degrees in sine and cosine")
    sentence = N_("The angle of the crank was used in degrees where sine and cosine expect radians.")

    @classmethod
    def cases(cls, family: VariantFamily) -> Iterable[Self]:
        if family.linkage.driver.kind == "turn":
            yield from (cls(False), cls(True))

    def change_family(self, family: VariantFamily) -> VariantFamily:
        q = np.remainder(family.q, 2 * np.pi) if self.reduced else family.q
        return family.changed(family.linkage, np.degrees(q))


# Positions counted from another zero of the crank.


@dataclass(frozen=True)
class OtherZero(Mistake):
    """Mistake: the positions are numbered from a different position of the crank.

    extreme: True if they are numbered from the other extreme position of the output, False if from the crank along the
    x axis.
    """

    extreme: bool = True

    code = "other-zero"
    name = N_("different zero position of the crank")
    sentence = N_("The positions were counted from a different zero position of the crank than in the task.")

    @property
    def identifier(self) -> str:
        return "other-extreme" if self.extreme else "x-axis-zero"

    @classmethod
    def cases(cls, family: VariantFamily) -> Iterable[Self]:
        if family.strokes is not None and len(family.strokes.strokes) == 2:
            yield cls(True)
        if family.linkage.driver.kind == "turn":
            yield cls(False)

    def change_family(self, family: VariantFamily) -> VariantFamily:
        first: Real = np.zeros(1)
        if self.extreme:
            assert family.strokes is not None
            ends = [stroke.start for stroke in family.strokes.strokes]
            away = [np.abs(np.exp(1j * end) - np.exp(1j * family.q[:, :1])) for end in ends]
            first = np.where(away[0] > away[1], ends[0], ends[1])
        return family.changed(family.linkage, family.q - family.q[:, :1] + first)


# A neighbouring position.


@dataclass(frozen=True)
class Neighbour(Mistake):
    """Mistake: the value belongs to the position before or after the requested one."""

    step: int = 1

    code = "neighbour"
    name = N_("value of a neighbouring position")
    sentence = N_("This is the value of a neighbouring position.")
    solves = False
    scope = "position"

    @classmethod
    def cases(cls, family: VariantFamily) -> Iterable[Self]:
        yield from (cls(1), cls(-1))

    def change_values(self, quantity: NamedQuantity, values: Real, solution: Solution) -> Real:
        return np.roll(values, self.step, axis=1)


# The crank turned the wrong way.


@dataclass(frozen=True)
class Sense(Mistake):
    """Mistake: the crank rotates in the opposite sense.

    counted: True if the positions are also numbered in the opposite sense.
    own_zero: True if they then begin where the slow stroke of this sense begins.
    """

    counted: bool = False
    own_zero: bool = False

    code = "sense"
    name = N_("wrong direction of rotation")
    sentence = N_("This answer is for a crank that rotates in the opposite sense.")

    @property
    def identifier(self) -> str:
        return "sense-own-zero" if self.own_zero else "sense-counted" if self.counted else self.code

    @classmethod
    def cases(cls, family: VariantFamily) -> Iterable[Self]:
        yield from (cls(False), cls(True))
        if family.strokes is not None and len(family.strokes.strokes) == 2:
            yield cls(True, True)

    def change_family(self, family: VariantFamily) -> VariantFamily:
        driver = family.linkage.driver
        linkage = replace(family.linkage, driver=replace(driver, sense=-driver.sense))
        if family.strokes is not None:  # the same ways of the driver, from their other ends
            strokes = family.strokes.changed(
                lambda s: replace(s, start=s.start + driver.sense * s.length, low=s.low + s.run, run=-s.run)
            )
            family = replace(family, strokes=strokes)
        first = family.q[:, :1]
        if self.own_zero and family.strokes is not None:
            begins = [stroke.start for stroke in family.strokes.strokes]
            away = [np.abs(np.exp(1j * start) - np.exp(1j * first)) for start in begins]
            first = np.where(away[0] > away[1], *begins)
        return family.changed(linkage, first - (family.q - family.q[:, :1]) if self.counted else None)


# A length on the plan divided by its scale where it is to be multiplied, or the reverse.


SIZES = tuple(m * 10.0**power for power in (-3, -2, -1, 0, 1, 2) for m in (1, 2, 2.5, 4, 5) if m * 10.0**power != 1)


@dataclass(frozen=True)
class ScaleInverted(Mistake):
    """Mistake: lengths measured on a plan are divided by its scale factor instead of multiplied by it.

    All values from this plan are then wrong by a factor that is the square of the scale factor. The scale factor is
    supposed to be a round number.

    Attributes:
        stage: plan with the mistake: velocities, accelerations or forces.
        scale: scale factor.
    """

    stage: str = ""
    scale: float = 1.0

    code = "scale-inverted"
    name = N_("scale factor inverted")
    sentence = N_(
        "All values from this plan are wrong by the same factor: the lengths were divided by the scale "
        "factor instead of being multiplied by it."
    )
    solves = False
    price = 25.0

    @property
    def identifier(self) -> str:
        return f"{self.code}:{self.stage}"

    @classmethod
    def cases(cls, family: VariantFamily) -> Iterable[Self]:
        yield from (cls(stage, scale) for stage in ("velocities", "accelerations", "forces") for scale in SIZES)

    def change_values(self, quantity: NamedQuantity, values: Real, solution: Solution) -> Real:
        return values * self.scale**2 if quantity.stage == self.stage else values


CARRIED_SIZES = (0.005, 0.01, 0.02, 0.025, 0.04, 0.05, 0.1, 0.2, 0.25, 0.5, 2.0, 5.0, 10.0, 20.0)


@dataclass(frozen=True)
class ScaleCarried(ScaleInverted):
    """Mistake: an inverted scale factor, with the wrong readings carried on into the rest of the work."""

    solves = True
    price = 16.0

    @classmethod
    def cases(cls, family: VariantFamily) -> Iterable[Self]:
        yield from (cls(stage, scale) for stage in ("velocities", "accelerations", "forces") for scale in CARRIED_SIZES)

    def change_solver(self, kernel: GroupSolver, family: VariantFamily) -> GroupSolver:
        factor = np.array(self.scale**2)
        if self.stage == "velocities":
            terms = SolverWithTerms.of(kernel, family.linkage, lambda pair, *states: pair.velocity_terms(*states))
            cranks = frozenset(crank.link for crank in family.linkage.cranks)
            return SolverWithCrankPin.around(terms, factor, cranks)
        return SolverWithScaledReactions.around(kernel, factor) if self.stage == "forces" else kernel

    def change_load(self, load: AppliedLoad, motion: Motion, family: VariantFamily) -> AppliedLoad:
        cranks = [crank.link for crank in family.linkage.cranks]
        if self.stage != "accelerations" or load.kind != "inertia" or load.link in cranks:
            return load
        return replace(load, force=load.force * self.scale**2, moment=load.moment * self.scale**2)

    def change_values(self, quantity: NamedQuantity, values: Real, solution: Solution) -> Real:
        return values * self.scale**2 if quantity.stage == self.stage == "accelerations" else values


@dataclass(frozen=True)
class SolverWithScaledReactions(WrappedSolver):
    """Solver of a group whose reactions are read from the force plan with a wrong scale, and passed on so."""

    factor: Real

    def reactions(self, at: Placement, poses: Poses, applied: tuple[Wrench, ...]) -> GroupReactions:
        found = super().reactions(at, poses, applied)
        outer, inner = (
            tuple(replace(reaction, force=reaction.force * self.factor) for reaction in reactions)
            for reactions in (found.outer, found.inner)
        )
        return replace(found, outer=outer, inner=inner)
