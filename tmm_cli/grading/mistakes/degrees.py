"""Degrees taken for radians, or radians for degrees."""

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
class Degrees(Mistake):
    """Angles, angular speeds and accelerations."""

    factor: float = 1.0

    name = N_("degrees for radians")
    sentence = N_(
        "This is the right value in the other unit of angles: degrees were taken for radians, or the reverse."
    )
    solves = False

    @classmethod
    def cases(cls, family: Family) -> Iterable[Self]:
        yield from (cls(180 / np.pi), cls(np.pi / 180))

    def value(self, quantity: Quantity, values: Real, solution: Solution) -> Real:
        return values * self.factor if quantity.dimension.angle and quantity.against != "angle" else values
