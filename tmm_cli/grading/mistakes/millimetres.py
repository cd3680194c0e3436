"""Millimetres taken for metres, or metres for millimetres."""

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


@dataclass(frozen=True)
class Millimetres(Mistake):
    """Whatever a length is a factor of."""

    factor: float = 1.0

    name = N_("mm for m")
    sentence = N_("This is 1000 times the right value, or a thousandth of it: millimetres and metres were mixed up.")
    solves = False

    @classmethod
    def cases(cls, family: Family) -> Iterable[Self]:
        yield from (cls(1000.0), cls(0.001))

    def value(self, quantity: Quantity, values: Real, solution: Solution) -> Real:
        return values * self.factor if quantity.dimension.length else values
