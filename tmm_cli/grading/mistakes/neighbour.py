"""A neighbouring position."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Self

import numpy as np

from tmm_cli.analysis.quantities.base import Quantity
from tmm_cli.grading.mistakes.base import Mistake
from tmm_cli.grading.solution import Solution
from tmm_cli.language import N_
from tmm_cli.variants.family import Family
from tmm_cli.vectors import Real


@dataclass(frozen=True)
class Neighbour(Mistake):
    """The value of the position before or after."""

    step: int = 1

    name = N_("neighbouring position")
    sentence = N_("This is the value of a neighbouring position.")
    solves = False

    @classmethod
    def cases(cls, family: Family) -> Iterable[Self]:
        yield from (cls(1), cls(-1))

    def value(self, quantity: Quantity, values: Real, solution: Solution) -> Real:
        return np.roll(values, self.step, axis=1)
