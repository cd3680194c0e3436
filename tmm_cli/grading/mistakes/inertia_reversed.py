"""Inertia forces drawn along the accelerations."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Self

from tmm_cli.forces.applied import Applied
from tmm_cli.grading.mistakes.base import Mistake
from tmm_cli.kinematics.motion import Motion
from tmm_cli.language import N_
from tmm_cli.variants.family import Family


@dataclass(frozen=True)
class InertiaReversed(Mistake):
    """Forces, couples, or both."""

    parts: tuple[str, ...] = ()

    name = N_("inertia not reversed")
    sentence = N_("Inertia acts against the acceleration: U = -m a_S and M = -J epsilon; here it acts along it.")

    @classmethod
    def cases(cls, family: Family) -> Iterable[Self]:
        yield from (cls(parts) for parts in (("force",), ("moment",), ("force", "moment")))

    def load(self, load: Applied, motion: Motion, family: Family) -> Applied:
        if load.kind != "inertia":
            return load
        return replace(load, **{part: -getattr(load, part) for part in self.parts})
