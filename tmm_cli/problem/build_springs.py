"""Springs and friction of a problem file."""

from __future__ import annotations

import math
from dataclasses import replace

from tmm_cli.language import _
from tmm_cli.linkage import Friction, Linkage, Spring
from tmm_cli.problem import schema, schema_springs
from tmm_cli.problem.values import Part, ValueReader, check_name
from tmm_cli.quantities import ANGLE, DAMPING, FORCE, LENGTH, MOMENT, NUMBER, STIFFNESS, TORSION, TORSION_DAMPING
from tmm_cli.structure.assur import analyse


def with_springs(linkage: Linkage, shape: schema.File, values: ValueReader) -> Linkage:
    """The linkage with its springs and friction."""
    springs, friction = _springs(linkage, shape, values), _friction(linkage, shape, values)
    return replace(linkage, springs=springs, friction=friction)


def _springs(linkage: Linkage, shape: schema.File, values: ValueReader) -> tuple[Spring, ...]:
    """In the order of the file."""
    found = []
    for name, given in shape.springs.items():
        check_name(name, ("springs", name), "load", shape.loads)
        found.append(_spring(name, given, linkage, Part(given, ("springs", name), values)))
    return tuple(found)


def _spring(name: str, given: schema_springs.Spring, linkage: Linkage, part: Part) -> Spring:
    i, j = part.two_links(linkage.links)
    twists = part.one_of("rate", "torsion") == "torsion"
    if twists and given.at is not None:
        raise part.refusal("at", _("a torsion spring has no ends"), at_key=True)
    ends = [next(iter(linkage.links[n].points.values()), 0j) for n in (i, j)]
    if given.at is not None:
        ends = [part.values.place(place, linkage.links[n].points, (*part.path, "at", k), n)
                for k, (n, place) in enumerate(zip((i, j), given.at, strict=True))]  # fmt: skip
        if any({i, j} <= set(h.links) and given.at[0] == given.at[1] == h.point for h in linkage.hinges):
            raise part.refusal(
                "at", _("both ends of spring {name} are in hinge {point}: it has no length").format(
                    name=name, point=given.at[0]
                ),
            )  # fmt: skip
    elif not twists and any(len(linkage.links[n].points) > 1 for n in (i, j)):
        allowed = _("at: [point of one, point of the other]")
        raise part.refusal("at", _("where are the ends of the spring?"), allowed=allowed)
    rate = part.positive("torsion", TORSION, zero=True) if twists else part.positive("rate", STIFFNESS, zero=True)
    free = 0.0
    if given.free is None and rate > 0:
        allowed = str(ANGLE if twists else LENGTH)
        raise part.refusal("free", _("the free length or angle of the spring is missing"), allowed=allowed)
    if given.free is not None:
        free = part.number("free", ANGLE) if twists else part.positive("free", LENGTH, zero=True)
    if twists and abs(free) > math.pi:
        raise part.refusal(
            "free", _("a free angle lies within half a turn; what a spring is wound up beyond that is its preload"),
            found=str(given.free),
        )  # fmt: skip
    preload = part.number("preload", MOMENT if twists else FORCE)
    damping = part.positive("damping", TORSION_DAMPING if twists else DAMPING, zero=True)
    return Spring(name, i, j, ends[0], ends[1], twists, rate, free, preload, damping)


def _friction(linkage: Linkage, shape: schema.File, values: ValueReader) -> tuple[Friction, ...]:
    """Pair by pair; none without its block."""
    given = shape.friction
    if given is None:
        return ()
    common = Part(given, ("friction",), values)
    coefficient, radius = (
        common.positive("coefficient", NUMBER, zero=True),
        common.positive("radius", LENGTH, zero=True),
    )
    pairs = {p.name: p for p in analyse(linkage).pairs if p.lower}
    own = {name: Part(one, ("friction", "pairs", name), values) for name, one in given.pairs.items()}
    for name, part in own.items():
        values.known(name, pairs, part.path, "turning or sliding pair", key=True)
        if pairs[name].kind == "P" and part.given.radius is not None:
            raise part.refusal("radius", _("a sliding pair has no journal"), at_key=True)
    found = []
    for name, pair in pairs.items():
        rubs, journal = coefficient, radius
        if name in own and own[name].given.coefficient is not None:
            rubs = own[name].positive("coefficient", NUMBER, zero=True)
        if name in own and own[name].given.radius is not None:
            journal = own[name].positive("radius", LENGTH, zero=True)
        if rubs and (pair.kind == "P" or journal):
            found.append(Friction(name, rubs, journal if pair.kind == "R" else 0.0))
    return tuple(found)
