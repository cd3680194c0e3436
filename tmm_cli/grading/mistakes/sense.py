"""The crank turned the wrong way."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Self

from tmm_cli.grading.mistakes.base import Mistake
from tmm_cli.language import N_
from tmm_cli.variants.family import Family


@dataclass(frozen=True)
class Sense(Mistake):
    """In the same positions, or with the positions counted the wrong way too."""

    counted: bool = False

    name = N_("sense of rotation")
    sentence = N_("This belongs to a crank that turns the other way.")

    @classmethod
    def cases(cls, family: Family) -> Iterable[Self]:
        yield from (cls(False), cls(True))

    def family(self, family: Family) -> Family:
        driver = family.linkage.driver
        linkage = replace(family.linkage, driver=replace(driver, sense=-driver.sense))
        if family.strokes is not None:  # the same ways of the driver, from their other ends
            strokes = family.strokes.changed(
                lambda s: replace(s, start=s.start + driver.sense * s.length, low=s.low + s.run, run=-s.run)
            )
            family = replace(family, strokes=strokes)
        return family.changed(linkage, 2 * family.q[:, :1] - family.q if self.counted else None)
