"""The lengths that a linkage is given by, each of them changed alone; and a linkage of double-doubles."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tmm_cli.double_double import exactly
from tmm_cli.linkage import Linkage
from tmm_cli.tolerances import NO_COORDINATE
from tmm_cli.vectors import Real, Record, mapped


@dataclass(frozen=True)
class Length:
    """A coordinate that is not zero (m) in the axes of one link: what has it moves with it when it is changed.

    along: its axis, 1 or i. Angles of guides (rad) are changed in the same way; their axis is 1.0. paths: where it
    stands in the linkage (vectors.mapped).
    """

    link: str
    along: complex | float
    value: float
    paths: frozenset[str]


def lengths(linkage: Linkage) -> tuple[Length, ...]:
    """Every coordinate of every link that is not zero. The same number on the same link is one length."""
    found: dict[tuple[str, complex, float], list[str]] = {}
    vectors = list(_vectors(linkage))
    least = NO_COORDINATE * max((abs(complex(value)) for _, _, value in vectors), default=0.0)
    for link, path, value in vectors:
        for along, part in ((1 + 0j, float(value.real)), (1j, float(value.imag))):
            if abs(part) > least:
                found.setdefault((link, along, part), []).append(path)
    return tuple(Length(link, along, value, frozenset(paths)) for (link, along, value), paths in found.items())


def largest_beside(data: Sequence[Length]) -> Real:
    """The largest length of the same link, of each length (m)."""
    return np.array([max(abs(other.value) for other in data if other.link == length.link) for length in data])


def changed(linkage: Linkage, length: Length, by: Any) -> Linkage:
    """The same linkage with one of its lengths longer by so much (m), in the precision of its numbers."""
    return all_changed(linkage, [(length, by)])


def all_changed(linkage: Linkage, changes: Iterable[tuple[Length, Any]]) -> Linkage:
    """The same with several of its lengths longer, each by so much."""
    more: dict[str, Any] = {}
    for length, by in changes:
        for path in length.paths:
            more[path] = more.get(path, 0.0) + length.along * by
    return mapped(lambda path, value: value + more[path] if path in more else value, linkage)


def _vectors(linkage: Linkage) -> Iterator[tuple[str, str, Any]]:
    """Every vector in axes of a link: that link, where it stands, its value."""
    for name, link in linkage.links.items():
        for point, value in link.points.items():
            yield name, f"links.{name}.points.{point}", value
        if np.any(link.mass != 0):
            yield name, f"links.{name}.centre", link.centre
    for k, slide in enumerate(linkage.slides):
        yield slide.carrier, f"slides[{k}].through", slide.through
        yield slide.runner, f"slides[{k}].at", slide.at
    for k, load in enumerate(linkage.loads):
        if load.force != 0:
            yield load.link, f"loads[{k}].at", load.at
    for k, spring in enumerate(linkage.springs):
        if not spring.turns:
            yield spring.i, f"springs[{k}].at_i", spring.at_i
            yield spring.j, f"springs[{k}].at_j", spring.at_j


def widened(record: Record) -> Record:
    """The same record with every float and complex number as a double-double, as it stands."""

    def wide(path: str, value: Any) -> Any:
        return exactly(value) if isinstance(value, float | complex) else value

    return mapped(wide, record)
