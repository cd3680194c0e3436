"""The weight put in where the mass is wanted."""

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
class WeightForMass(Mistake):
    """Inertia forces are g times too large."""

    name = N_("weight for mass")
    sentence = N_(
        "The weight G was put in where the mass m = G/g is wanted: the inertia force is 9.81 times too large."
    )

    @classmethod
    def cases(cls, family: Family) -> Iterable[Self]:
        if np.any(family.linkage.gravity != 0):
            yield cls()

    def load(self, load: Applied, motion: Motion, family: Family) -> Applied:
        return replace(load, force=load.force * np.abs(family.linkage.gravity)) if load.kind == "inertia" else load
