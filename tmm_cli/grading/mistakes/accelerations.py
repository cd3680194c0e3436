"""Groups whose accelerations are not found as they should be; places, velocities and reactions are."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, fields, replace
from typing import Any, Self

from tmm_cli.groups.base import Kernel
from tmm_cli.groups.newton import Newton
from tmm_cli.groups.state import Accel, Accels, Drives, GroupReactions, Placement, Poses, Rate, Rates, Wrench
from tmm_cli.linkage import Linkage
from tmm_cli.pairs.base import Constraint
from tmm_cli.structure.assur import Pair
from tmm_cli.vectors import Real

Terms = Callable[[Constraint, Poses, Rates], Any]  # the velocity terms of a pair as the student has them


@dataclass(frozen=True)
class Wrapped(Kernel):
    """A group that does all as the right one does."""

    right: Kernel

    def rebind(self, linkage: Linkage) -> Self:
        return replace(self, right=self.right.rebind(linkage))

    def place(self, poses: Poses, q: Real, drives: Drives) -> Placement:
        return self.right.place(poses, q, drives)

    def rates(self, at: Placement, poses: Poses, rates: Rates, drives: Drives) -> tuple[Rate, ...]:
        return self.right.rates(at, poses, rates, drives)

    def accelerations(
        self, at: Placement, poses: Poses, rates: Rates, accels: Accels, drives: Drives
    ) -> tuple[Accel, ...]:
        return self.right.accelerations(at, poses, rates, accels, drives)

    def reactions(self, at: Placement, poses: Poses, applied: tuple[Wrench, ...]) -> GroupReactions:
        return self.right.reactions(at, poses, applied)

    def inner_on(self, pair: Pair) -> str:
        return self.right.inner_on(pair)


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
        return cls(right.group, right.size, right, Equations(**own, terms=terms))

    def accelerations(
        self, at: Placement, poses: Poses, rates: Rates, accels: Accels, drives: Drives
    ) -> tuple[Accel, ...]:
        return self.equations.accelerations(at, poses, rates, accels, drives)
