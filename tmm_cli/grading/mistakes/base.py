"""Base class of typical mistakes, and the solution of variants in which mistakes are made."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Literal, Self

import numpy as np

from tmm_cli.batch import VariantFamily
from tmm_cli.language import _
from tmm_cli.mechanics.analysis import NamedQuantity
from tmm_cli.mechanics.forces import AppliedLoad, Reactions, collect_loads, solve_friction, solve_reactions
from tmm_cli.mechanics.groups import DriverMotion, GroupSolver
from tmm_cli.mechanics.kinematics import Motion, Strokes, compute_motion
from tmm_cli.mechanics.linkage import Linkage
from tmm_cli.mechanics.numerics import Real


@dataclass(frozen=True, eq=False)
class Solution:
    """Motion and forces of all variants of a family at all positions, (variants, positions)."""

    family: VariantFamily
    motion: Motion
    reactions: Reactions

    @property
    def linkage(self) -> Linkage:
        return self.family.linkage

    @property
    def strokes(self) -> Strokes | None:
        return self.family.strokes


def solve_with_mistakes(family: VariantFamily, mistakes: Sequence[Mistake] = ()) -> Solution:
    """Solve the variants of a family as a student who makes these mistakes would.

    Each mistake changes the stage of the solution that it concerns; several mistakes act in the given order.
    """
    for mistake in mistakes:
        family = mistake.change_family(family)
    lead = family.linkage.driver
    at: Any = family.linkage.sketch.at if family.linkage.others else family.q[:, :1]
    law = DriverMotion(at, lead.rate, lead.acceleration, lead.sense)
    kernels = family.kernels
    for mistake in mistakes:
        kernels = tuple(mistake.change_solver(kernel, family) for kernel in kernels)
    motion = compute_motion(family.linkage, kernels, family.q, law)
    for mistake in mistakes:
        motion = mistake.change_motion(motion)
    with np.errstate(all="ignore"):
        loads = collect_loads(motion, family.strokes)
        for mistake in mistakes:
            loads = tuple(mistake.change_load(load, motion, family) for load in loads)
        reactions = solve_reactions(motion, family.structure, loads)
        if family.linkage.friction:
            reactions = solve_friction(motion, family.structure, loads, reactions).reactions
    return Solution(family, motion, reactions)


Scope = Literal["sheet", "position", "answer"]


@dataclass(frozen=True)
class Mistake:
    """A typical mistake, e.g. that the normal acceleration of link 3 is left out.

    A subclass overrides one or more of the methods below, each of which changes one stage of the solution.

    Attributes:
        name: text for tables and statistics; it may contain fields of the mistake in braces.
        sentence: text for the student; it may contain fields of the mistake in braces.
        solves: True if the mechanism must be solved again with this mistake; False if it changes only the written
            values.
        scope: what the mistake concerns: the whole sheet, a position, or a single answer (e.g. its unit).
        price: number added to the misfit of a mistake that has many cases, since one of them may fit by chance. The
            misfit is the sum of squared errors, in standard errors of a drawing.
    """

    code: ClassVar[str]
    name: ClassVar[str]
    sentence: ClassVar[str]
    solves: ClassVar[bool] = True  # whether the stages must run again; else it changes what is written down alone
    scope: ClassVar[Scope] = "sheet"
    price: ClassVar[float] = 0.0  # squares of standard errors that it must explain more than others, as it fits so much

    @classmethod
    def cases(cls, family: VariantFamily) -> Iterable[Self]:
        """Yield the mistakes of this kind that are possible for the variants of a family, e.g. one for each link."""
        yield cls()

    @property
    def description(self) -> str:
        """Sentence about this mistake for the student."""
        return _(self.sentence).format(**vars(self))

    @property
    def identifier(self) -> str:
        """Stable name of this mistake for scripts, with the link that it concerns, e.g. normal-left-out:3."""
        link = getattr(self, "link", "")
        return f"{self.code}:{link}" if link else self.code

    @property
    def label(self) -> str:
        """Name of this mistake for tables and statistics."""
        return _(self.name).format(**vars(self))

    def change_family(self, family: VariantFamily) -> VariantFamily:
        """Return the variants as a student who makes this mistake would have them; by default unchanged."""
        return family

    def change_solver(self, kernel: GroupSolver, family: VariantFamily) -> GroupSolver:
        """Return the solver of an Assur group changed so that it makes this mistake; by default unchanged."""
        return kernel

    def change_motion(self, motion: Motion) -> Motion:
        """Return the motion as a student who makes this mistake would compute it; by default unchanged."""
        return motion

    def change_load(self, load: AppliedLoad, motion: Motion, family: VariantFamily) -> AppliedLoad:
        """Return a load as a student who makes this mistake would apply it; by default unchanged."""
        return load

    def change_values(self, quantity: NamedQuantity, values: Real, solution: Solution) -> Real:
        """Return values (variants, positions) as a student who makes this mistake would write them; by default
        unchanged.
        """
        return values
