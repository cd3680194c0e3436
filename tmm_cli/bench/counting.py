"""Counting of group solutions, and undoing of savings; from outside: the calculation itself knows nothing of it.

A solution is a group at one place of the driver, or one round of Newton's method there; its velocities and its
accelerations count as one more each.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np

from tmm_cli.mechanics.analysis import mechanism, pipeline
from tmm_cli.mechanics.assembly import choose, search
from tmm_cli.mechanics.groups import DYADS, Kernel, Newton, sequence
from tmm_cli.mechanics.kinematics import driver_range as quality, motion, pressure, strokes

STAGES = (choose, search, mechanism, motion, pipeline, pressure, quality, strokes)


@dataclass
class Count:
    """How many solutions there were."""

    places: int = 0
    velocities: int = 0
    accelerations: int = 0

    @property
    def all(self) -> int:
        return self.places + self.velocities + self.accelerations


@contextmanager
def counted() -> Iterator[Count]:
    """Count what is solved meanwhile."""
    count = Count()
    put: list[tuple[Any, str, Any]] = []

    def watch(kind: type[Kernel], name: str, of: str, size: Callable[[tuple[Any, ...], Any], int]) -> None:
        given = getattr(kind, name)

        def watched(*arguments: Any, **named: Any) -> Any:
            found = given(*arguments, **named)
            setattr(count, of, getattr(count, of) + size(arguments, found))
            return found

        put.append((kind, name, given))
        setattr(kind, name, watched)

    try:
        for dyad in DYADS.values():
            watch(dyad, "closed", "places", lambda _, at: np.size(at.det))
        watch(Newton, "residuals", "places", lambda _, gaps: np.size(gaps[..., 0]))
        every: tuple[type[Kernel], ...] = (*DYADS.values(), Newton)
        for kind in every:
            watch(kind, "rates", "velocities", lambda _, rates: np.size(rates[0].w))
            watch(kind, "accelerations", "accelerations", lambda _, accels: np.size(accels[0].e))
        yield count
    finally:
        for kind, name, given in reversed(put):
            setattr(kind, name, given)


@contextmanager
def _instead(name: str, other: Any) -> Iterator[None]:
    """Every stage finds something else under a name meanwhile."""
    put = [(stage, getattr(stage, name)) for stage in STAGES if hasattr(stage, name)]
    try:
        for stage, _ in put:
            setattr(stage, name, other)
        yield
    finally:
        for stage, given in put:
            setattr(stage, name, given)


@contextmanager
def all_orders() -> Iterator[None]:
    """Every stage computes accelerations."""
    given = sequence.link_states

    def whole(linkage: Any, kernels: Any, q: Any, order: int = 2, **named: Any) -> Any:
        return given(linkage, kernels, q, 2, **named)

    with _instead("link_states", whole):
        yield


@contextmanager
def no_closed_form() -> Iterator[None]:
    """Every group is solved by Newton's method."""
    with _instead("CLOSED", ()):
        yield
