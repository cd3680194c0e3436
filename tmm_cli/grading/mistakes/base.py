"""A typical mistake, and the solution of a family of variants with mistakes in it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Self

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
    """Motion and forces of all variants at all positions, (variants, positions)."""

    family: VariantFamily
    motion: Motion
    reactions: Reactions

    @property
    def linkage(self) -> Linkage:
        return self.family.linkage

    @property
    def strokes(self) -> Strokes | None:
        return self.family.strokes


def solve(family: VariantFamily, mistakes: Sequence[Mistake] = ()) -> Solution:
    """All stages; each mistake changes what it is a mistake in, the first one first."""
    for mistake in mistakes:
        family = mistake.family(family)
    lead = family.linkage.driver
    at: Any = family.linkage.sketch.at if family.linkage.others else family.q[:, :1]
    law = DriverMotion(at, lead.rate, lead.acceleration, lead.sense)
    kernels = family.kernels
    for mistake in mistakes:
        kernels = tuple(mistake.kernel(kernel, family) for kernel in kernels)
    motion = compute_motion(family.linkage, kernels, family.q, law)
    for mistake in mistakes:
        motion = mistake.motion(motion)
    with np.errstate(all="ignore"):
        loads = collect_loads(motion, family.strokes)
        for mistake in mistakes:
            loads = tuple(mistake.load(load, motion, family) for load in loads)
        reactions = solve_reactions(motion, family.structure, loads)
        if family.linkage.friction:
            reactions = solve_friction(motion, family.structure, loads, reactions).reactions
    return Solution(family, motion, reactions)


@dataclass(frozen=True)
class Mistake:
    """One case of a mistake, e.g. that the normal part of link 3 was left out. It changes one of these, or several.

    name: in tables and statistics; sentence: for the student, whole. Both may have fields of the mistake.
    """

    name: ClassVar[str]
    sentence: ClassVar[str]
    solves: ClassVar[bool] = True  # whether the stages must run again; else it changes what is written down alone
    price: ClassVar[float] = 0.0  # squares of standard errors that it must explain more than others, as it fits so much

    @classmethod
    def cases(cls, family: VariantFamily) -> Iterable[Self]:
        """All of its cases that this task has."""
        yield cls()

    @property
    def told(self) -> str:
        """The sentence with the fields of this case."""
        return _(self.sentence).format(**vars(self))

    @property
    def called(self) -> str:
        """The name with the fields of this case."""
        return _(self.name).format(**vars(self))

    def family(self, family: VariantFamily) -> VariantFamily:
        """The variants as the student took them."""
        return family

    def kernel(self, kernel: GroupSolver, family: VariantFamily) -> GroupSolver:
        """A group as the student solved it."""
        return kernel

    def motion(self, motion: Motion) -> Motion:
        """The motion as the student found it."""
        return motion

    def load(self, load: AppliedLoad, motion: Motion, family: VariantFamily) -> AppliedLoad:
        """What the student let act in the place of a load."""
        return load

    def value(self, quantity: NamedQuantity, values: Real, solution: Solution) -> Real:
        """What the student wrote down of the values (variants, positions) that the stages gave."""
        return values
