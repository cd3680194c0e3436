"""Groups whose accelerations follow from other velocity terms; places, velocities and reactions are right."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, fields
from typing import Any

from tmm_cli.groups.base import Kernel
from tmm_cli.groups.newton import Newton
from tmm_cli.groups.state import Accel, Accels, Drives, Placement, Poses, Rates
from tmm_cli.groups.wrapped import Wrapped
from tmm_cli.linkage import Linkage
from tmm_cli.pairs.base import Constraint
from tmm_cli.vectors import Real

Terms = Callable[[Constraint, Poses, Rates], Any]  # the velocity terms of a pair as the student has them


@dataclass(frozen=True)
class Equations(Newton):
    """A group as equations, one a row of a pair, with other velocity terms."""

    terms: Terms = field(kw_only=True)

    def velocity_terms(self, poses: Poses, rates: Rates) -> list[Real]:
        return [term for constraint in self.constraints for term in self.terms(constraint, poses, rates)]


@dataclass(frozen=True)
class OtherTerms(Wrapped):
    """Accelerations from equations with other velocity terms."""

    equations: Equations

    @classmethod
    def of(cls, right: Kernel, linkage: Linkage, terms: Terms) -> OtherTerms:
        """The group with its numbers."""
        plain = Newton.of(right.group.rebind(linkage), linkage)
        own = {f.name: getattr(plain, f.name) for f in fields(plain)}
        return cls.around(right, Equations(**own, terms=terms))

    def accelerations(
        self, at: Placement, poses: Poses, rates: Rates, accels: Accels, drives: Drives
    ) -> tuple[Accel, ...]:
        return self.equations.accelerations(at, poses, rates, accels, drives)
