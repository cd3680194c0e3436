"""A group whose work is done by another kernel, and changed on its way in or out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from tmm_cli.groups.base import Kernel
from tmm_cli.groups.state import Accel, GroupReactions, Placement, Rate
from tmm_cli.linkage import Linkage
from tmm_cli.structure.assur import Pair


@dataclass(frozen=True)
class Wrapped(Kernel):
    """The inner kernel as it is; what changes it overrides `passed`, or one of its steps."""

    inner: Kernel

    def passed(self, work: Callable[..., Any], *given: Any) -> Any:
        """One step of the inner kernel."""
        return work(*given)

    def rebind(self, linkage: Linkage) -> Kernel:
        return replace(self, inner=self.inner.rebind(linkage))

    def place(self, *given: Any) -> Placement:
        at: Placement = self.passed(self.inner.place, *given)
        return at

    def rates(self, *given: Any) -> tuple[Rate, ...]:
        found: tuple[Rate, ...] = self.passed(self.inner.rates, *given)
        return found

    def accelerations(self, *given: Any) -> tuple[Accel, ...]:
        found: tuple[Accel, ...] = self.passed(self.inner.accelerations, *given)
        return found

    def reactions(self, *given: Any) -> GroupReactions:
        found: GroupReactions = self.passed(self.inner.reactions, *given)
        return found

    def inner_on(self, pair: Pair) -> str:
        return self.inner.inner_on(pair)
