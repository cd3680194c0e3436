"""A cam and its follower, given by the follower's law of motion instead of the shape of the cam."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from tmm_cli.groups.state import Drives, PairReaction, Poses, Rates
from tmm_cli.linkage import Linkage, Slide
from tmm_cli.pairs.base import HigherPair, JacobianRow, axis
from tmm_cli.pairs.sliding import Guided
from tmm_cli.structure.assur import Pair
from tmm_cli.vectors import Real, Vector, dot, unit


@dataclass(frozen=True)
class Cam(HigherPair):
    """Row: run (or angle) of the follower on the carrier less offset and the law of the cam's angle from the carrier.

    The carrier is the frame, or a moving link with the guide of the follower: then the cam changes a length of it. The
    law does not say where cam and follower touch. A sliding follower is taken as flat-faced: it touches the cam
    ds/da from the cam's axis and the force is along its guide (I. I. Artobolevsky, ch. 26). A swinging one is loaded by
    a couple and the cam by the couple of the same power.
    """

    slide: Slide | None
    axis: complex  # of the cam, on the carrier, m

    kind = "C"

    @classmethod
    def of(cls, pair: Pair, linkage: Linkage) -> Cam:
        mesh = pair.mesh
        assert mesh is not None
        slide = linkage.slide(mesh.slide) if mesh.slide else None
        return cls(pair.name, mesh, slide, axis(linkage, mesh.i, mesh.carrier))

    @property
    def lengths(self) -> tuple[bool, ...]:
        return (self.slide is not None,)

    def _law(self, poses: Poses) -> tuple[Real, Real, Real]:
        assert self.mesh.law is not None
        return self.mesh.law(poses[self.mesh.i].turned - poses[self.mesh.carrier].turned)

    def residuals(self, poses: Poses, drives: Drives) -> Sequence[Real]:
        want = self._law(poses)[0] + self.mesh.offset
        if self.slide is None:
            residual = poses[self.mesh.j].z * np.conj(unit(want))
            return (np.arctan2(residual.imag, residual.real),)
        here = Guided.at(self.slide, poses)
        return (dot(here.u, here.off) - want,)

    def jacobian_rows(self, poses: Poses) -> Mapping[str, Sequence[JacobianRow]]:
        slope = self._law(poses)[1]
        rows: dict[str, JacobianRow] = {self.mesh.i: (0j, -slope), self.mesh.carrier: (0j, slope)}
        if self.slide is None:
            own: Mapping[str, JacobianRow] = {self.mesh.j: (0j, 1.0)}
        else:
            here = Guided.at(self.slide, poses)
            own = here.jacobian_rows(self.slide, here.u)
        for name, (place, angle) in own.items():
            other = rows.get(name, (0j, 0.0))
            rows[name] = (place + other[0], angle + other[1])
        return {name: (row,) for name, row in rows.items()}

    def velocity_terms(self, poses: Poses, rates: Rates) -> Sequence[Real]:
        bend = -self._law(poses)[2] * (rates[self.mesh.i].w - rates[self.mesh.carrier].w) ** 2
        if self.slide is None:
            return (bend,)
        here = Guided.at(self.slide, poses)
        return (dot(here.u, here.bend(self.slide, rates)) + bend,)

    def contact(self, poses: Poses) -> tuple[Vector, Vector]:
        """Where a flat-faced follower touches, and the direction in which its run grows."""
        assert self.slide is not None
        here = Guided.at(self.slide, poses)
        forward = here.u if self.slide.runner == self.mesh.j else -here.u
        return poses[self.mesh.carrier].at(self.axis) - 1j * self._law(poses)[1] * forward, forward

    def pushes(self, poses: Poses) -> Mapping[str, Sequence[JacobianRow]]:
        return self.jacobian_rows(poses) if self.slide is None else super().pushes(poses)

    def reaction(self, poses: Poses, multipliers: Sequence[Real]) -> PairReaction:
        if self.slide is not None:
            return super().reaction(poses, multipliers)
        n = multipliers[0]
        return PairReaction(n * 0j, couple=n, at=poses[self.mesh.j].x, back=-n * self._law(poses)[1])
