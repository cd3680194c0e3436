"""A length on the plan divided by its scale where it is to be multiplied, or the reverse."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Self

from tmm_cli.analysis.quantities.base import Quantity
from tmm_cli.grading.mistakes.base import Mistake
from tmm_cli.grading.solution import Solution
from tmm_cli.language import N_
from tmm_cli.variants.family import Family
from tmm_cli.vectors import Real

SIZES = tuple(m * 10.0**power for power in (-3, -2, -1, 0, 1, 2) for m in (1, 2, 2.5, 4, 5) if m * 10.0**power != 1)


@dataclass(frozen=True)
class ScaleInverted(Mistake):
    """All values off one kind of plan are wrong by the square of its scale factor, a round number in mm."""

    stage: str = ""
    scale: float = 1.0

    name = N_("scale factor inverted")
    sentence = N_(
        "All values of this plan are wrong by one factor: lengths divided by the scale in place of multiplied."
    )
    solves = False
    price = 25.0

    @classmethod
    def cases(cls, family: Family) -> Iterable[Self]:
        yield from (cls(stage, scale) for stage in ("velocities", "accelerations", "forces") for scale in SIZES)

    def value(self, quantity: Quantity, values: Real, solution: Solution) -> Real:
        return values * self.scale**2 if quantity.stage == self.stage else values
