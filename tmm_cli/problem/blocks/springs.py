"""Springs and friction in a problem file: their keys, and how they are added to a linkage."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

from pydantic import Field

from tmm_cli.language import _
from tmm_cli.mechanics.linkage import Friction as FrictionRecord, Linkage, Spring as SpringRecord
from tmm_cli.mechanics.quantities import (
    ANGLE,
    DAMPING,
    FORCE,
    LENGTH,
    MOMENT,
    NUMBER,
    STIFFNESS,
    TORSION,
    TORSION_DAMPING,
)
from tmm_cli.mechanics.structure import analyse_structure
from tmm_cli.problem.schema_types import Name, Place, Strict, Value
from tmm_cli.problem.values import FileSection, ValueReader, check_name

if TYPE_CHECKING:
    from tmm_cli.problem import schema


class SpringKeys(Strict):
    """A spring between two links, or a cylinder with a constant force. A torsion spring has `torsion` instead of
    `rate`.
    """

    between: list[Name] = Field(min_length=2, max_length=2, description="the two links; one of them may be the frame")
    at: list[Place] | None = Field(
        default=None,
        min_length=2,
        max_length=2,
        description="ends of the spring, one on each link; default: the first points of the links",
    )
    rate: Value | None = Field(default=None, description="stiffness, N/m; 0 for a constant force")
    torsion: Value | None = Field(default=None, description="stiffness of a torsion spring, N*m/rad")
    free: Value | None = Field(default=None, description="length (or angle) at which the spring exerts only `preload`")
    preload: Value = Field(
        default=0, description="tension at the free length (compression if negative); moment of a torsion spring"
    )
    damping: Value = Field(default=0, description="damping coefficient, N*s/m or N*m*s/rad")


class PairFrictionKeys(Strict):
    """Friction in one pair."""

    coefficient: Value | None = None
    radius: Value | None = Field(default=None, description="radius of the journal of this hinge")


class FrictionKeys(Strict):
    """Coulomb friction in pairs. Without this block friction is not computed."""

    coefficient: Value = Field(default=0, description="coefficient of friction in every pair not listed in `pairs`")
    radius: Value = Field(default=0, description="radius of the journal of every hinge not listed in `pairs`")
    pairs: dict[Name, PairFrictionKeys] = Field(default_factory=dict, max_length=300)


# Building of springs and friction.


def add_springs(linkage: Linkage, shape: schema.File, values: ValueReader) -> Linkage:
    """Add springs and friction to a linkage. Raises ProblemError."""
    springs, friction = _build_springs(linkage, shape, values), _build_friction(linkage, shape, values)
    return replace(linkage, springs=springs, friction=friction)


def _build_springs(linkage: Linkage, shape: schema.File, values: ValueReader) -> tuple[SpringRecord, ...]:
    springs = []
    for name, keys in shape.springs.items():
        check_name(name, ("springs", name), "load", shape.loads)
        springs.append(_build_spring(name, keys, linkage, FileSection(keys, ("springs", name), values)))
    return tuple(springs)


def _build_spring(name: str, keys: SpringKeys, linkage: Linkage, section: FileSection) -> SpringRecord:
    i, j = section.two_links(linkage.links)
    twists = section.one_of("rate", "torsion") == "torsion"
    if twists and keys.at is not None:
        raise section.refusal("at", _("a torsion spring has no ends"), at_key=True)
    ends = [next(iter(linkage.links[n].points.values()), 0j) for n in (i, j)]
    if keys.at is not None:
        ends = [
            section.values.place(place, linkage.links[n].points, (*section.path, "at", k), n)
            for k, (n, place) in enumerate(zip((i, j), keys.at, strict=True))
        ]
        if any({i, j} <= set(h.links) and keys.at[0] == keys.at[1] == h.point for h in linkage.hinges):
            raise section.refusal(
                "at",
                _("both ends of spring {name} are at hinge {point}, so its length is zero").format(
                    name=name, point=keys.at[0]
                ),
            )
    elif not twists and any(len(linkage.links[n].points) > 1 for n in (i, j)):
        allowed = _("at: [point of the first link, point of the second link]")
        raise section.refusal("at", _("the ends of the spring are not given"), allowed=allowed)
    rate = section.positive("torsion", TORSION, zero=True) if twists else section.positive("rate", STIFFNESS, zero=True)
    free = 0.0
    if keys.free is None and rate > 0:
        allowed = str(ANGLE if twists else LENGTH)
        raise section.refusal("free", _("the free length or angle of the spring is missing"), allowed=allowed)
    if keys.free is not None:
        free = section.number("free", ANGLE) if twists else section.positive("free", LENGTH, zero=True)
    if twists and abs(free) > math.pi:
        raise section.refusal(
            "free",
            _("the free angle must not exceed half a turn; enter any further winding as `preload`"),
            found=str(keys.free),
        )
    preload = section.number("preload", MOMENT if twists else FORCE)
    damping = section.positive("damping", TORSION_DAMPING if twists else DAMPING, zero=True)
    return SpringRecord(name, i, j, ends[0], ends[1], twists, rate, free, preload, damping)


def _build_friction(linkage: Linkage, shape: schema.File, values: ValueReader) -> tuple[FrictionRecord, ...]:
    """Build the friction of each pair; empty if the file has no block `friction`."""
    keys = shape.friction
    if keys is None:
        return ()
    common = FileSection(keys, ("friction",), values)
    coefficient, radius = (
        common.positive("coefficient", NUMBER, zero=True),
        common.positive("radius", LENGTH, zero=True),
    )
    pairs = {p.name: p for p in analyse_structure(linkage).pairs if p.lower}
    sections = {
        name: FileSection(pair_keys, ("friction", "pairs", name), values) for name, pair_keys in keys.pairs.items()
    }
    for name, section in sections.items():
        values.known_name(name, pairs, section.path, "turning or sliding pair", key=True)
        if pairs[name].kind == "P" and section.keys.radius is not None:
            raise section.refusal("radius", _("a prismatic pair has no journal, so it has no `radius`"), at_key=True)
    frictions = []
    for name, pair in pairs.items():
        rubs, journal = coefficient, radius
        if name in sections and sections[name].keys.coefficient is not None:
            rubs = sections[name].positive("coefficient", NUMBER, zero=True)
        if name in sections and sections[name].keys.radius is not None:
            journal = sections[name].positive("radius", LENGTH, zero=True)
        if rubs and (pair.kind == "P" or journal):
            frictions.append(FrictionRecord(name, rubs, journal if pair.kind == "R" else 0.0))
    return tuple(frictions)
