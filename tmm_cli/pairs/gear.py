"""Two toothed wheels on a common carrier, fixed or turning (planetary), in outer or inner mesh."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tmm_cli.groups.state import Drives, Poses, Rates
from tmm_cli.linkage import Linkage
from tmm_cli.pairs.base import JacobianRow, Teeth, axis
from tmm_cli.structure.assur import Pair
from tmm_cli.vectors import Real, Vector


@dataclass(frozen=True)
class Gear(Teeth):
    """Row: angle of j from the carrier less offset and ratio times that of i.

    The teeth push at the pitch point P = (A - ratio B)/(1 - ratio) of the axes A and B of the wheels i and j, where
    both wheels have one velocity; across the line of axes first, the part along it (`pressure`) afterwards. That pushes
    an outer-toothed wheel towards its own axis; in an inner mesh that is the smaller one. So the force on j is from
    axis i to axis j in an outer mesh and the other way in an inner one, whichever is the smaller.
    """

    axis_i: complex  # on the carrier, m
    axis_j: complex

    kind = "G"
    away = 1j

    @classmethod
    def of(cls, pair: Pair, linkage: Linkage) -> Gear:
        mesh = pair.mesh
        assert mesh is not None
        return cls(pair.name, mesh, axis(linkage, mesh.i, mesh.carrier), axis(linkage, mesh.j, mesh.carrier))

    @property
    def lengths(self) -> tuple[bool, ...]:
        return (False,)

    def residuals(self, poses: Poses, drives: Drives) -> Sequence[Real]:
        mesh = self.mesh
        i, j, c = (poses[name].turned for name in (mesh.i, mesh.j, mesh.carrier))
        return ((j - c) - mesh.ratio * (i - c) - mesh.offset,)

    def jacobian_rows(self, poses: Poses) -> Mapping[str, Sequence[JacobianRow]]:
        ratio = self.mesh.ratio
        return {
            self.mesh.i: ((0j, -ratio),), self.mesh.j: ((0j, 1.0),), self.mesh.carrier: ((0j, ratio - 1.0),),
        }  # fmt: skip

    def turned(self, link: str, angles: Mapping[str, Any], drives: Drives) -> Any:
        mesh = self.mesh
        if link == mesh.carrier:
            return (angles[mesh.j] - mesh.ratio * angles[mesh.i] - mesh.offset) / (1 - mesh.ratio)
        carrier = angles[mesh.carrier]
        if link == mesh.j:
            return carrier + mesh.ratio * (angles[mesh.i] - carrier) + mesh.offset
        return carrier + (angles[mesh.j] - carrier - mesh.offset) / mesh.ratio

    def velocity_terms(self, poses: Poses, rates: Rates) -> Sequence[Real]:
        return (np.zeros(np.shape(rates[self.mesh.i].w)),)

    def contact(self, poses: Poses) -> tuple[Vector, Vector]:
        ratio, carrier = self.mesh.ratio, poses[self.mesh.carrier]
        here = (self.axis_i - ratio * self.axis_j) / (1 - ratio)
        line = (self.axis_j - self.axis_i) / abs(self.axis_j - self.axis_i)
        return carrier.at(here), 1j * (line * carrier.z)
