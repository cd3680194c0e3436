"""Room for a drawing that stands on a large sheet beside others: how large what is drawn may be there."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass


@dataclass(frozen=True)
class Room:
    """longest: the longest side (mm) of a figure that is to scale, or of the paper of one that is not; None: as on A4."""

    longest: float | None = None


_ROOM: ContextVar[Room | None] = ContextVar("room", default=None)


def room() -> Room | None:
    """The room that what is drawn now has; none where it has a sheet of its own."""
    return _ROOM.get()


@contextmanager
def within(given: Room) -> Iterator[None]:
    """What is drawn meanwhile is drawn into this room."""
    token = _ROOM.set(given)
    try:
        yield
    finally:
        _ROOM.reset(token)
