"""A sliding pair: a point of the runner stays on a guide of the carrier, and their axes keep one angle."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tmm_cli.groups.state import Drives, PairReaction, Poses, Rates
from tmm_cli.linkage import Linkage, Slide
from tmm_cli.pairs.base import Constraint, JacobianRow
from tmm_cli.structure.assur import Pair
from tmm_cli.vectors import Real, Vector, cross, dot, unit


@dataclass(frozen=True)
class Guided:
    """The geometry of a sliding pair at some poses: the guide's direction u and the running point from both origins."""

    u: Vector
    off: Vector  # from the guide's `through` point to the running point
    on_carrier: Vector  # running point from the carrier's origin
    on_runner: Vector

    @classmethod
    def at(cls, slide: Slide, poses: Poses) -> Guided:
        carrier, runner = poses[slide.carrier], poses[slide.runner]
        on_runner = slide.at * runner.z
        on_carrier = (runner.x - carrier.x) + on_runner
        return cls(carrier.z * unit(slide.direction), on_carrier - slide.through * carrier.z, on_carrier, on_runner)

    def jacobian_rows(self, slide: Slide, along: Vector) -> Mapping[str, JacobianRow]:
        """Of the running point's motion against the carrier, counted along a direction that the carrier carries."""
        return {
            slide.carrier: (-along, -cross(self.on_carrier, along)),
            slide.runner: (along, cross(self.on_runner, along)),
        }

    def bend(self, slide: Slide, rates: Rates) -> Vector:
        """Acceleration of the running point against the carrier when no link accelerates, without Coriolis."""
        bend: Vector = self.on_carrier * rates[slide.carrier].w ** 2 - self.on_runner * rates[slide.runner].w ** 2
        return bend

    def sliding(self, slide: Slide, rates: Rates) -> Real:
        """Speed of the running point along the guide."""
        speed: Real = dot(self.u, rates[slide.runner].at(self.on_runner) - rates[slide.carrier].at(self.on_carrier))
        return speed


@dataclass(frozen=True)
class Sliding(Constraint):
    """Rows: angle of the runner from the carrier, distance of the running point from the guide."""

    slide: Slide

    kind = "P"

    @classmethod
    def of(cls, pair: Pair, linkage: Linkage) -> Sliding:
        assert pair.slide is not None
        return cls(pair.name, pair.slide)

    @property
    def links(self) -> tuple[str, ...]:
        return self.slide.carrier, self.slide.runner

    @property
    def lengths(self) -> tuple[bool, ...]:
        return False, True

    def residuals(self, poses: Poses, drives: Drives) -> Sequence[Real]:
        here = Guided.at(self.slide, poses)
        turned = poses[self.slide.runner].z * np.conj(poses[self.slide.carrier].z * unit(self.slide.turned))
        return np.arctan2(turned.imag, turned.real), cross(here.u, here.off)

    def jacobian_rows(self, poses: Poses) -> Mapping[str, Sequence[JacobianRow]]:
        here = Guided.at(self.slide, poses)
        across = here.jacobian_rows(self.slide, 1j * here.u)
        return {
            self.slide.carrier: ((0j, -1.0), across[self.slide.carrier]),
            self.slide.runner: ((0j, 1.0), across[self.slide.runner]),
        }

    def turned(self, link: str, angles: Mapping[str, Any], drives: Drives) -> Any:
        if link == self.slide.runner:
            return angles[self.slide.carrier] + self.slide.turned
        return angles[self.slide.runner] - self.slide.turned

    def velocity_terms(self, poses: Poses, rates: Rates) -> Sequence[Real]:
        here = Guided.at(self.slide, poses)
        coriolis = 2 * rates[self.slide.carrier].w * here.sliding(self.slide, rates)
        return np.zeros(np.shape(coriolis)), cross(here.u, here.bend(self.slide, rates)) - coriolis

    def reaction(self, poses: Poses, multipliers: Sequence[Real]) -> PairReaction:
        here = Guided.at(self.slide, poses)
        return PairReaction(1j * here.u * multipliers[1], multipliers[0])
