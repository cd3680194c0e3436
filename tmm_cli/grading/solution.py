"""A family of variants solved at its positions, as it is or with a mistake in."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_cli.batch import Family
from tmm_cli.mechanics.forces import Reactions, applied, react, solve_friction
from tmm_cli.mechanics.groups import DriverMotion
from tmm_cli.mechanics.kinematics import Motion, Strokes, move
from tmm_cli.mechanics.linkage import Linkage

if TYPE_CHECKING:
    from tmm_cli.grading.mistakes.base import Mistake


@dataclass(frozen=True, eq=False)
class Solution:
    """Motion and forces of all variants at all positions, (variants, positions)."""

    family: Family
    motion: Motion
    reactions: Reactions

    @property
    def linkage(self) -> Linkage:
        return self.family.linkage

    @property
    def strokes(self) -> Strokes | None:
        return self.family.strokes


def solve(family: Family, mistakes: Sequence[Mistake] = ()) -> Solution:
    """All stages; each mistake changes what it is a mistake in, the first one first."""
    for mistake in mistakes:
        family = mistake.family(family)
    lead = family.linkage.driver
    at: Any = family.linkage.sketch.at if family.linkage.others else family.q[:, :1]
    law = DriverMotion(at, lead.rate, lead.acceleration, lead.sense)
    kernels = family.kernels
    for mistake in mistakes:
        kernels = tuple(mistake.kernel(kernel, family) for kernel in kernels)
    motion = move(family.linkage, kernels, family.q, law)
    for mistake in mistakes:
        motion = mistake.motion(motion)
    with np.errstate(all="ignore"):
        loads = applied(motion, family.strokes)
        for mistake in mistakes:
            loads = tuple(mistake.load(load, motion, family) for load in loads)
        reactions = react(motion, family.structure, loads)
        if family.linkage.friction:
            reactions = solve_friction(motion, family.structure, loads, reactions).reactions
    return Solution(family, motion, reactions)
