"""The tangential part of a link's acceleration left out."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Self

from tmm_cli.grading.mistakes.base import Mistake
from tmm_cli.groups.base import Kernel
from tmm_cli.groups.state import Accel, Accels, Drives, Placement, Poses, Rates
from tmm_cli.groups.wrapped import Wrapped
from tmm_cli.language import N_
from tmm_cli.variants.family import Family


@dataclass(frozen=True)
class Tangential(Mistake):
    """Of a link that turns about an outer hinge of its group."""

    link: str = ""

    name = N_("tangential part left out")
    sentence = N_("The tangential part epsilon r of the acceleration of link {link} was left out.")

    @classmethod
    def cases(cls, family: Family) -> Iterable[Self]:
        for kernel in family.kernels:
            for pair in kernel.group.outer:
                if pair.kind == "R":
                    yield cls(kernel.group.own(pair))

    def kernel(self, kernel: Kernel, family: Family) -> Kernel:
        if self.link not in kernel.group.links:
            return kernel
        pair = next(p for p in kernel.group.outer if p.kind == "R" and kernel.group.own(p) == self.link)
        linkage, other = family.linkage, pair.other(self.link)
        there, here = linkage.local(other, pair.point), linkage.local(self.link, pair.point)
        return NotTurningFaster.around(kernel, self.link, other, there, here)


@dataclass(frozen=True)
class NotTurningFaster(Wrapped):
    """A group one of whose links has no angular acceleration."""

    link: str
    known: str
    there: complex
    here: complex

    def accelerations(
        self, at: Placement, poses: Poses, rates: Rates, accels: Accels, drives: Drives
    ) -> tuple[Accel, ...]:
        found = dict(zip(self.group.links, self.inner.accelerations(at, poses, rates, accels, drives), strict=True))
        hinge = accels[self.known].at(self.there * poses[self.known].z, rates[self.known].w)
        w, arm = rates[self.link].w, self.here * poses[self.link].z
        found[self.link] = Accel.through(hinge, w * 0, w, arm)
        return tuple(found.values())
