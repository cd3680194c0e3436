"""Friction in a problem file: its keys, and the friction of each pair."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pydantic import Field

from tmm_cli.language import _
from tmm_cli.mechanics.linkage import Friction as FrictionRecord, Linkage
from tmm_cli.mechanics.quantities import LENGTH, NUMBER
from tmm_cli.mechanics.structure import analyse_structure
from tmm_cli.problem.schema_types import Name, Strict, Value
from tmm_cli.problem.values import FileSection, ValueReader

if TYPE_CHECKING:
    from tmm_cli.problem import schema


class PairFrictionKeys(Strict):
    """Friction in one pair."""

    coefficient: Value | None = None
    radius: Value | None = Field(default=None, description="radius of the journal of this hinge")


class FrictionKeys(Strict):
    """Coulomb friction in pairs. Without this block friction is not computed."""

    coefficient: Value = Field(default=0, description="coefficient of friction in every pair not listed in `pairs`")
    radius: Value = Field(default=0, description="radius of the journal of every hinge not listed in `pairs`")
    pairs: dict[Name, PairFrictionKeys] = Field(default_factory=dict, max_length=300)


# Building of friction.


def build_friction(linkage: Linkage, shape: schema.File, values: ValueReader) -> tuple[FrictionRecord, ...]:
    """Build the friction of each pair; empty if the file has no block `friction`. Raises ProblemError."""
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
