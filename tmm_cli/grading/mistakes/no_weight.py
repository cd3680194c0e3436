"""Weights left out, or masses put in for them."""

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
class NoWeight(Mistake):
    """Of one link, or of all. mass: the weight is the number of kilograms."""

    link: str = ""
    mass: bool = False

    name = N_("weight forgotten")
    sentence = N_("A weight G = m g was left out, or the mass was put in for it.")

    @classmethod
    def cases(cls, family: Family) -> Iterable[Self]:
        if np.all(family.linkage.gravity == 0):
            return
        links = family.linkage.links
        own = [name for name in family.linkage.moving if np.any(links[name].mass != 0)]
        yield from (cls(name) for name in own)
        yield from (cls("", mass) for mass in (False, True))

    def load(self, load: Applied, motion: Motion, family: Family) -> Applied:
        if load.kind != "weight" or self.link not in ("", load.link):
            return load
        return replace(load, force=load.force * (1 / np.abs(family.linkage.gravity) if self.mass else 0.0))
