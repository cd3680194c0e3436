"""Inertia forces left out."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from tmm_cli.forces.applied import Applied
from tmm_cli.grading.mistakes.base import Mistake
from tmm_cli.kinematics.motion import Motion
from tmm_cli.language import N_
from tmm_cli.variants.family import Family


@dataclass(frozen=True)
class NoInertia(Mistake):
    """Of one link, or of all."""

    link: str = ""

    name = N_("inertia force left out")
    sentence = N_("The inertia force m a_S was left out.")
    part, of = "force", "mass"  # what is left out of the load, and what of the link makes it

    @classmethod
    def cases(cls, family: Family) -> Iterable[Self]:
        links = family.linkage.links
        own = [name for name in family.linkage.moving if np.any(getattr(links[name], cls.of) != 0)]
        yield from (cls(name) for name in own)
        if len(own) > 1:
            yield cls()

    def load(self, load: Applied, motion: Motion, family: Family) -> Applied:
        if load.kind != "inertia" or self.link not in ("", load.link):
            return load
        return replace(load, **{self.part: getattr(load, self.part) * 0})
