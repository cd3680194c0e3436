"""The normal part of a link's acceleration left out."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any, Self

from tmm_cli.grading.mistakes.accelerations import OtherTerms
from tmm_cli.grading.mistakes.base import Mistake
from tmm_cli.groups.base import Kernel
from tmm_cli.groups.state import Accel, Accels, Drives, Placement, Poses, Rates
from tmm_cli.groups.wrapped import Wrapped
from tmm_cli.kinematics.motion import Motion, Point
from tmm_cli.language import N_
from tmm_cli.pairs.base import Constraint
from tmm_cli.pairs.sliding import Guided, Sliding
from tmm_cli.variants.family import Family
from tmm_cli.vectors import cross


@dataclass(frozen=True)
class Normal(Mistake):
    """Of one link: its points accelerate as if it did not turn."""

    link: str = ""

    name = N_("normal part left out")
    sentence = N_("The normal part omega^2 r of the acceleration of link {link} was left out.")

    @classmethod
    def cases(cls, family: Family) -> Iterable[Self]:
        linkage = family.linkage
        yield from (cls(link) for link in linkage.moving if not linkage.slides_on_frame(link))

    def kernel(self, kernel: Kernel, family: Family) -> Kernel:
        if self.link in kernel.group.links:
            return OtherTerms.of(kernel, family.linkage, self._terms)
        return Unturned.around(kernel, self.link)

    def _terms(self, pair: Constraint, poses: Poses, rates: Rates) -> Any:
        still = without(rates, self.link)
        if not isinstance(pair, Sliding):
            return pair.velocity_terms(poses, still)
        here, (turned, across) = Guided.at(pair.slide, poses), pair.velocity_terms(poses, rates)
        return turned, across + cross(here.u, here.bend(pair.slide, still) - here.bend(pair.slide, rates))

    def motion(self, motion: Motion) -> Motion:
        return UnturnedMotion(**vars(motion), link_without=self.link)


def without(rates: Rates, link: str) -> Rates:
    """Velocities in which a link does not turn."""
    return {**rates, link: replace(rates[link], w=rates[link].w * 0)}


@dataclass(frozen=True)
class Unturned(Wrapped):
    """A group that hangs on the link."""

    link: str

    def accelerations(
        self, at: Placement, poses: Poses, rates: Rates, accels: Accels, drives: Drives
    ) -> tuple[Accel, ...]:
        known = without(rates, self.link) if self.link in self.group.known and self.link in rates else rates
        return self.inner.accelerations(at, poses, known, accels, drives)


@dataclass(frozen=True, kw_only=True)
class UnturnedMotion(Motion):
    """A motion in which the points of the link accelerate so."""

    link_without: str

    def _point(self, link: str, local: complex) -> Point:
        found = super()._point(link, local)
        if link != self.link_without:
            return found
        extra = self.first[link].w ** 2 * local * self.poses[link].z
        second = found.second + extra
        return replace(found, second=second, a=found.a + extra * self.rate**2)
