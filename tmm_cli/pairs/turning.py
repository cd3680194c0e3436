"""A hinge: a point of one link stays on a point of another."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from tmm_cli.groups.state import Drives, PairReaction, Poses, Rates
from tmm_cli.linkage import Linkage
from tmm_cli.pairs.base import Constraint, JacobianRow
from tmm_cli.structure.assur import Pair
from tmm_cli.vectors import Real, Vector


@dataclass(frozen=True)
class Turning(Constraint):
    """Rows: x and y of the point of j less that of i."""

    i: str
    j: str
    at_i: complex
    at_j: complex

    kind = "R"

    @classmethod
    def of(cls, pair: Pair, linkage: Linkage) -> Turning:
        return cls(pair.name, pair.i, pair.j, linkage.local(pair.i, pair.point), linkage.local(pair.j, pair.point))

    @property
    def links(self) -> tuple[str, ...]:
        return self.i, self.j

    @property
    def lengths(self) -> tuple[bool, ...]:
        return True, True

    def _arms(self, poses: Poses) -> tuple[Vector, Vector]:
        return self.at_i * poses[self.i].z, self.at_j * poses[self.j].z

    def residuals(self, poses: Poses, drives: Drives) -> Sequence[Real]:
        arm_i, arm_j = self._arms(poses)
        residual = (poses[self.j].x - poses[self.i].x) + (arm_j - arm_i)
        return residual.real, residual.imag

    def jacobian_rows(self, poses: Poses) -> Mapping[str, Sequence[JacobianRow]]:
        arm_i, arm_j = self._arms(poses)
        return {
            self.i: ((-1.0 + 0j, arm_i.imag), (-1j, -arm_i.real)),
            self.j: ((1.0 + 0j, -arm_j.imag), (1j, arm_j.real)),
        }

    def velocity_terms(self, poses: Poses, rates: Rates) -> Sequence[Real]:
        arm_i, arm_j = self._arms(poses)
        bend = arm_i * rates[self.i].w ** 2 - arm_j * rates[self.j].w ** 2
        return bend.real, bend.imag

    def reaction(self, poses: Poses, multipliers: Sequence[Real]) -> PairReaction:
        return PairReaction(multipliers[0] + 1j * multipliers[1])
