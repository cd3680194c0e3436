"""The moment of inertia taken about a hinge instead of the centre of mass."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from tmm_cli.forces.applied import Applied
from tmm_cli.grading.mistakes.base import Mistake
from tmm_cli.kinematics.motion import Motion
from tmm_cli.language import N_
from tmm_cli.linkage import FRAME
from tmm_cli.variants.family import Family
from tmm_cli.vectors import Real


@dataclass(frozen=True)
class HingeInertia(Mistake):
    """Of one link, or of all: its couple of inertia is too large by m s^2 epsilon."""

    link: str = ""

    name = N_("moment of inertia about the hinge")
    sentence = N_("The moment of inertia was taken about the hinge; the couple wants it about the centre of mass.")

    @classmethod
    def cases(cls, family: Family) -> Iterable[Self]:
        links = family.linkage.links
        own = [n for n in family.linkage.moving if np.any(links[n].inertia != 0) and np.any(_arm(family, n) != 0)]
        yield from (cls(name) for name in own)
        if len(own) > 1:
            yield cls()

    def load(self, load: Applied, motion: Motion, family: Family) -> Applied:
        if load.kind != "inertia" or self.link not in ("", load.link):
            return load
        extra = family.linkage.links[load.link].mass * np.abs(_arm(family, load.link)) ** 2
        return replace(load, moment=load.moment - extra * motion.link(load.link).epsilon)


def _arm(family: Family, name: str) -> Real:
    """From a link's hinge, that on the frame if it has one, to its centre of mass, m."""
    link = family.linkage.links[name]
    frame = family.linkage.links[FRAME].points
    hinge = next((p for n, p in link.points.items() if n in frame), next(iter(link.points.values()), 0j))
    return np.asarray(link.centre - hinge)
