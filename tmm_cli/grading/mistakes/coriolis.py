"""The Coriolis acceleration left out or reversed."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Self

from tmm_cli.grading.mistakes.accelerations import OtherTerms
from tmm_cli.grading.mistakes.base import Mistake
from tmm_cli.groups.base import Kernel
from tmm_cli.groups.state import Poses, Rates
from tmm_cli.language import N_
from tmm_cli.linkage import FRAME
from tmm_cli.pairs.base import Constraint
from tmm_cli.pairs.sliding import Guided, Sliding
from tmm_cli.variants.family import Family


@dataclass(frozen=True)
class Coriolis(Mistake):
    """Of one link that slides on a moving one. sense: 0 left out, -1 reversed."""

    runner: str = ""
    carrier: str = ""
    sense: int = 0

    name = N_("Coriolis acceleration")
    sentence = N_("The Coriolis acceleration of link {runner} on link {carrier} was left out, or points the other way.")

    @classmethod
    def cases(cls, family: Family) -> Iterable[Self]:
        for slide in family.linkage.slides:
            if FRAME not in (slide.carrier, slide.runner):
                yield from (cls(slide.runner, slide.carrier, sense) for sense in (0, -1))

    def kernel(self, kernel: Kernel, family: Family) -> Kernel:
        slides = [pair.slide for pair in (*kernel.group.inner, *kernel.group.outer) if pair.slide is not None]
        if all(slide.runner != self.runner for slide in slides):
            return kernel
        return OtherTerms.of(kernel, family.linkage, self._terms)

    def _terms(self, pair: Constraint, poses: Poses, rates: Rates) -> Any:
        found = pair.velocity_terms(poses, rates)
        if not (isinstance(pair, Sliding) and pair.links == (self.carrier, self.runner)):
            return found
        turned, across = found
        coriolis = 2 * rates[self.carrier].w * Guided.at(pair.slide, poses).sliding(pair.slide, rates)
        return turned, across + (1 - self.sense) * coriolis
