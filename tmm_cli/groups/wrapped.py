"""A group that does as another one does: what it does otherwise a subclass says."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Self, TypeVar

from tmm_cli.groups.base import Kernel
from tmm_cli.groups.state import Accel, Accels, Drives, GroupReactions, Placement, Poses, Rate, Rates, Wrench
from tmm_cli.linkage import Linkage
from tmm_cli.structure.assur import Pair
from tmm_cli.vectors import Real

Step = TypeVar("Step")


@dataclass(frozen=True)
class Wrapped(Kernel):
    """A subclass overrides one of the steps, or `passed`, through which all of them go."""

    inner: Kernel

    @classmethod
    def around(cls, inner: Kernel, *own: Any) -> Self:
        """A kernel about another one; own: the fields of the subclass."""
        return cls(inner.group, inner.size, inner, *own)

    def passed(self, work: Callable[..., Step], *given: Any) -> Step:
        """One step of the inner kernel."""
        return work(*given)

    def rebind(self, linkage: Linkage) -> Self:
        return replace(self, inner=self.inner.rebind(linkage))

    def place(self, poses: Poses, q: Real, drives: Drives) -> Placement:
        return self.passed(self.inner.place, poses, q, drives)

    def rates(self, at: Placement, poses: Poses, rates: Rates, drives: Drives) -> tuple[Rate, ...]:
        return self.passed(self.inner.rates, at, poses, rates, drives)

    def accelerations(
        self, at: Placement, poses: Poses, rates: Rates, accels: Accels, drives: Drives
    ) -> tuple[Accel, ...]:
        return self.passed(self.inner.accelerations, at, poses, rates, accels, drives)

    def reactions(self, at: Placement, poses: Poses, applied: tuple[Wrench, ...]) -> GroupReactions:
        return self.passed(self.inner.reactions, at, poses, applied)

    def inner_on(self, pair: Pair) -> str:
        return self.inner.inner_on(pair)
