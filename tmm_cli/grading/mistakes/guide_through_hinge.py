"""The reaction of a guide drawn through the hinge."""

from __future__ import annotations

from dataclasses import dataclass

from tmm_cli.analysis.quantities.base import Quantity
from tmm_cli.grading.mistakes.base import Mistake
from tmm_cli.grading.solution import Solution
from tmm_cli.language import N_
from tmm_cli.vectors import Real


@dataclass(frozen=True)
class GuideThroughHinge(Mistake):
    """It acts where moments about the hinge vanish, which is seldom the hinge itself."""

    name = N_("guide's reaction through the hinge")
    sentence = N_("The reaction of a guide does not act through the hinge: its place follows from moments about it.")
    solves = False

    def value(self, quantity: Quantity, values: Real, solution: Solution) -> Real:
        return values * 0 if quantity.name.startswith("arm of R_") else values
