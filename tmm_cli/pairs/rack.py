"""A toothed wheel that rolls on a rack; both are held by a common carrier."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from tmm_cli.groups.state import Drives, Poses, Rates
from tmm_cli.linkage import Linkage, Slide
from tmm_cli.pairs.base import JacobianRow, Teeth, axis
from tmm_cli.pairs.sliding import Guided
from tmm_cli.structure.assur import Pair
from tmm_cli.vectors import Real, Vector, dot


@dataclass(frozen=True)
class Rack(Teeth):
    """Row: run of the rack on the carrier less offset and ratio (m a radian) times the angle of the wheel from it.

    The slide may have the rack as its runner or as its carrier. The teeth push at the pitch point, where wheel and rack
    have one velocity: the wheel's radius |ratio| away from its axis, square to the guide.
    """

    slide: Slide
    axis: complex  # of the wheel, on the carrier, m

    kind = "K"
    away = -1j

    @classmethod
    def of(cls, pair: Pair, linkage: Linkage) -> Rack:
        mesh = pair.mesh
        assert mesh is not None
        return cls(pair.name, mesh, linkage.slide(mesh.slide), axis(linkage, mesh.i, mesh.carrier))

    @property
    def lengths(self) -> tuple[bool, ...]:
        return (True,)

    def residuals(self, poses: Poses, drives: Drives) -> Sequence[Real]:
        here = Guided.at(self.slide, poses)
        turned = poses[self.mesh.i].turned - poses[self.mesh.carrier].turned
        return (dot(here.u, here.off) - self.mesh.ratio * turned - self.mesh.offset,)

    def jacobian_rows(self, poses: Poses) -> Mapping[str, Sequence[JacobianRow]]:
        here = Guided.at(self.slide, poses)
        rows = {name: [row] for name, row in here.jacobian_rows(self.slide, here.u).items()}
        c, m = rows[self.mesh.carrier][0]
        rows[self.mesh.carrier] = [(c, m + self.mesh.ratio)]
        return rows | {self.mesh.i: [(0j, -self.mesh.ratio)]}

    def velocity_terms(self, poses: Poses, rates: Rates) -> Sequence[Real]:
        here = Guided.at(self.slide, poses)
        return (dot(here.u, here.bend(self.slide, rates)),)

    def contact(self, poses: Poses) -> tuple[Vector, Vector]:
        """The pitch point, and the direction in which the rack's run grows."""
        here = Guided.at(self.slide, poses)
        forward = here.u if self.slide.runner == self.mesh.j else -here.u
        return poses[self.mesh.carrier].at(self.axis) - 1j * self.mesh.ratio * forward, forward
