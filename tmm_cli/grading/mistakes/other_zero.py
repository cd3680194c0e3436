"""Positions counted from another zero of the crank."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Self

import numpy as np

from tmm_cli.grading.mistakes.base import Mistake
from tmm_cli.language import N_
from tmm_cli.variants.family import Family
from tmm_cli.vectors import Real


@dataclass(frozen=True)
class OtherZero(Mistake):
    """From the other extreme position, or from the crank along the x axis."""

    extreme: bool = True

    name = N_("other zero of the crank")
    sentence = N_("The positions were counted from another zero of the crank than the task's.")

    @classmethod
    def cases(cls, family: Family) -> Iterable[Self]:
        if family.strokes is not None and len(family.strokes.strokes) == 2:
            yield cls(True)
        if family.linkage.driver.kind == "turn":
            yield cls(False)

    def family(self, family: Family) -> Family:
        first: Real = np.zeros(1)
        if self.extreme:
            assert family.strokes is not None
            ends = [stroke.start for stroke in family.strokes.strokes]
            away = [np.abs(np.exp(1j * end) - np.exp(1j * family.q[:, :1])) for end in ends]
            first = np.where(away[0] > away[1], ends[0], ends[1])
        return family.changed(family.linkage, family.q - family.q[:, :1] + first)
