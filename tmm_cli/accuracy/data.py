"""The lengths that a linkage is given by, each of them changed alone; and a linkage with its numbers in longdouble."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import Any, TypeVar

import numpy as np

from tmm_cli.linkage import Linkage
from tmm_cli.vectors import Real

Record = TypeVar("Record")
Place = tuple[str, str, str]  # what it is of (links, slides, loads, springs), its name, and the field or point
NOTHING = 1e-12  # of the linkage's size: a coordinate below that is zero but for rounding


@dataclass(frozen=True)
class Length:
    """A coordinate that is not zero (m) in the axes of one link: what has it moves with it when it is changed.

    along: its axis, 1 or i. Angles of guides (rad) are changed in the same way; their axis is 1.0.
    """

    link: str
    along: complex | float
    value: float
    places: tuple[Place, ...]


def lengths(linkage: Linkage) -> tuple[Length, ...]:
    """Every coordinate of every link that is not zero. The same number on the same link is one length."""
    found: dict[tuple[str, complex, float], list[Place]] = {}
    vectors = list(_vectors(linkage))
    least = NOTHING * max((abs(complex(value)) for _, _, value in vectors), default=0.0)
    for link, place, value in vectors:
        for along, part in ((1 + 0j, float(value.real)), (1j, float(value.imag))):
            if abs(part) > least:
                found.setdefault((link, along, part), []).append(place)
    return tuple(Length(link, along, value, tuple(places)) for (link, along, value), places in found.items())


def angles(linkage: Linkage) -> tuple[Length, ...]:
    """The angles of guides and between links that slide on each other, as lengths are given."""
    return tuple(
        Length(slide.carrier, 1.0, float(getattr(slide, part)), (("slides", slide.name, part),))
        for slide in linkage.slides for part in ("direction", "turned")
    )  # fmt: skip


def changed(linkage: Linkage, length: Length, by: Any) -> Linkage:
    """The same linkage with one of its lengths longer by so much (m), in the precision of its numbers."""
    links, slides = dict(linkage.links), {s.name: s for s in linkage.slides}
    loads, springs = {x.name: x for x in linkage.loads}, {x.name: x for x in linkage.springs}
    more = length.along * by
    for kind, name, part in length.places:
        if kind == "points":
            link = links[name]
            links[name] = replace(link, points={**link.points, part: link.points[part] + more})
        else:
            record: Any = {"links": links, "slides": slides, "loads": loads, "springs": springs}[kind]
            record[name] = replace(record[name], **{part: getattr(record[name], part) + more})
    linkage = replace(linkage, links=links, slides=tuple(slides.values()))
    return replace(linkage, loads=tuple(loads.values()), springs=tuple(springs.values()))


def _vectors(linkage: Linkage) -> Any:
    """Every vector in axes of a link: that link, where it stands, its value."""
    for name, link in linkage.links.items():
        for point, value in link.points.items():
            yield name, ("points", name, point), value
        if np.any(link.mass != 0):
            yield name, ("links", name, "centre"), link.centre
    for slide in linkage.slides:
        yield slide.carrier, ("slides", slide.name, "through"), slide.through
        yield slide.runner, ("slides", slide.name, "at"), slide.at
    for load in linkage.loads:
        if load.force != 0:
            yield load.link, ("loads", load.name, "at"), load.at
    for spring in linkage.springs:
        if not spring.turns:
            yield spring.i, ("springs", spring.name, "at_i"), spring.at_i
            yield spring.j, ("springs", spring.name, "at_j"), spring.at_j


def shaken(linkage: Linkage, q: Real, trial: int) -> tuple[Linkage, Real]:
    """The linkage and places of its driver with every number up or down by a unit of its last place, at random."""
    random = np.random.default_rng(trial)
    for length in (*lengths(linkage), *angles(linkage)):
        linkage = changed(linkage, length, float(random.choice((-1, 1)) * np.spacing(abs(length.value))))
    return linkage, q + random.choice((-1, 1), np.shape(q)) * np.spacing(np.abs(q))


def widened(record: Record) -> Record:
    """The same record with every float and complex number in longdouble, as exactly as it stands."""
    found: Any = record
    if isinstance(record, bool | int | str) or record is None:
        return record
    if isinstance(record, float):
        found = np.longdouble(record)
    elif isinstance(record, complex):
        found = np.clongdouble(record)
    elif is_dataclass(record) and not isinstance(record, type):
        found = replace(record, **{f.name: widened(getattr(record, f.name)) for f in fields(record) if f.init})
    elif isinstance(record, Mapping):
        found = {key: widened(value) for key, value in record.items()}
    elif isinstance(record, tuple):
        found = tuple(widened(value) for value in record)
    wide: Record = found
    return wide
