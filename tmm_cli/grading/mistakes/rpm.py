"""Revolutions a minute taken for radians a second."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from tmm_cli.grading.mistakes.base import Mistake
from tmm_cli.language import N_
from tmm_cli.variants.family import Family


@dataclass(frozen=True)
class Rpm(Mistake):
    """Velocities are 9.55 times too large, accelerations and inertia forces 91 times."""

    name = N_("rpm for rad/s")
    sentence = N_("The speed of the crank was put in as revolutions a minute; omega = pi n / 30 is wanted, in rad/s.")

    @classmethod
    def cases(cls, family: Family) -> Iterable[Self]:
        if family.linkage.driver.kind == "turn":
            yield cls()

    def family(self, family: Family) -> Family:
        driver = family.linkage.driver
        return family.changed(replace(family.linkage, driver=replace(driver, rate=driver.rate * (30 / np.pi))))
