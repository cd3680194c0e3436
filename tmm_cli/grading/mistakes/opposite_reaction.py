"""R_ik written down for R_ki."""

from __future__ import annotations

from dataclasses import dataclass

from tmm_cli.analysis.quantities.base import Quantity
from tmm_cli.grading.mistakes.base import Mistake
from tmm_cli.grading.solution import Solution
from tmm_cli.language import N_
from tmm_cli.vectors import Real


@dataclass(frozen=True)
class OppositeReaction(Mistake):
    """Reactions with the opposite direction."""

    name = N_("R_ik for R_ki")
    sentence = N_("This is the opposite of the reaction that was asked: R_ik acts from link i on link k.")
    solves = False

    def value(self, quantity: Quantity, values: Real, solution: Solution) -> Real:
        return -values if quantity.name.startswith("R_") else values
