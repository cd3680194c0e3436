"""A driver between two moving links, as one more row of their group: a cylinder, or a drive in a hinge."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tmm_cli.groups.state import Drives, PairReaction, Poses, Rates
from tmm_cli.linkage import Driver, Linkage, Slide
from tmm_cli.pairs.base import Constraint, JacobianRow
from tmm_cli.pairs.sliding import Guided
from tmm_cli.vectors import Real, dot, unit


@dataclass(frozen=True)
class Driven(Constraint):
    """Row: angle of the driven link from its base, or run in their sliding pair, less the driver's place."""

    driver: Driver
    slide: Slide | None

    kind = "D"

    @classmethod
    def of(cls, driver: Driver, linkage: Linkage) -> Driven:
        """The row of a driver."""
        return cls(driver.link, driver, linkage.slide(driver.joint) if driver.kind == "slide" else None)

    @property
    def links(self) -> tuple[str, ...]:
        return (self.driver.base, self.driver.link) if self.slide is None else (self.slide.carrier, self.slide.runner)

    @property
    def lengths(self) -> tuple[bool, ...]:
        return (self.slide is not None,)

    def residuals(self, poses: Poses, drives: Drives) -> Sequence[Real]:
        want = drives[self.driver.link].value
        if self.slide is None:
            turned = poses[self.driver.link].z * np.conj(poses[self.driver.base].z)
            residual = turned * unit(-want)
            return (np.arctan2(residual.imag, residual.real),)
        here = Guided.at(self.slide, poses)
        return (dot(here.u, here.off) - want,)

    def jacobian_rows(self, poses: Poses) -> Mapping[str, Sequence[JacobianRow]]:
        if self.slide is None:
            return {self.driver.base: ((0j, -1.0),), self.driver.link: ((0j, 1.0),)}
        here = Guided.at(self.slide, poses)
        return {name: (row,) for name, row in here.jacobian_rows(self.slide, here.u).items()}

    def turned(self, link: str, angles: Mapping[str, Any], drives: Drives) -> Any | None:
        if self.slide is not None:
            return None
        place = drives[self.driver.link].value
        return angles[self.driver.base] + place if link == self.driver.link else angles[self.driver.link] - place

    def velocity_terms(self, poses: Poses, rates: Rates) -> Sequence[Real]:
        if self.slide is None:
            return (np.zeros(np.shape(rates[self.driver.link].w)),)
        here = Guided.at(self.slide, poses)
        return (dot(here.u, here.bend(self.slide, rates)),)

    def asked(self, drives: Drives, order: int) -> Sequence[Real | float]:
        drive = drives[self.driver.link]
        return (drive.first if order == 1 else drive.second,)

    def reaction(self, poses: Poses, multipliers: Sequence[Real]) -> PairReaction:
        n = multipliers[0]
        if self.slide is None:
            return PairReaction(n * 0j, couple=n)
        return PairReaction(Guided.at(self.slide, poses).u * n, at=poses[self.slide.runner].at(self.slide.at))
