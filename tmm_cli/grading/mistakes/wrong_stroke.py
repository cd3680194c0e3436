"""The resistance acting in the wrong stroke."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Self

from tmm_cli.grading.mistakes.base import Mistake
from tmm_cli.language import N_
from tmm_cli.variants.family import Family


@dataclass(frozen=True)
class WrongStroke(Mistake):
    """both: it acts always; else in the idle stroke alone."""

    both: bool = False

    name = N_("load in the wrong stroke")
    sentence = N_("The useful resistance acts in the working stroke only; here it acts in the idle one.")

    @classmethod
    def cases(cls, family: Family) -> Iterable[Self]:
        if family.strokes is not None and any(load.working_stroke_only for load in family.linkage.loads):
            yield from (cls(False), cls(True))

    def family(self, family: Family) -> Family:
        assert family.strokes is not None
        strokes = family.strokes.changed(lambda s: replace(s, working=self.both or not s.working))
        return replace(family, strokes=strokes)
