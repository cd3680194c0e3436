"""Springs and friction of a problem file."""

from __future__ import annotations

import math
from typing import Any

from tmm_cli.errors import _
from tmm_cli.linkage import Friction, Linkage, Spring
from tmm_cli.problem import schema
from tmm_cli.problem.errors import ProblemError
from tmm_cli.problem.tree import Path
from tmm_cli.problem.values import ValueReader, check_name
from tmm_cli.quantities import ANGLE, DAMPING, FORCE, LENGTH, MOMENT, NUMBER, STIFFNESS, TORSION, TORSION_DAMPING
from tmm_cli.structure.assur import analyse


def build_springs(linkage: Linkage, shape: schema.File, values: ValueReader) -> tuple[Spring, ...]:
    """The springs, in the order of the file."""
    found = []
    for name, given in shape.springs.items():
        path: Path = ("springs", name)
        check_name(name, path, "load", shape.loads)
        i, j = (values.known(n, linkage.links, (*path, "between", k), "link") for k, n in enumerate(given.between))
        values.different((i, j), (*path, "between"))
        stiffness = values.one_of(given, ("rate", "torsion"), path)
        twists = stiffness == "torsion"
        if twists and given.at is not None:
            raise ProblemError(_("a torsion spring has no ends"), path=(*path, "at"), key=True)
        ends = [next(iter(linkage.links[n].points.values()), 0j) for n in (i, j)]
        if given.at is not None:
            ends = [
                values.place(place, linkage.links[n].points, (*path, "at", k), n)
                for k, (n, place) in enumerate(zip((i, j), given.at, strict=True))
            ]
            _not_in_one_hinge(name, given.at, (i, j), linkage, (*path, "at"))
        elif not twists and any(len(linkage.links[n].points) > 1 for n in (i, j)):
            raise ProblemError(
                _("where are the ends of the spring?"), path=(*path, "at"),
                allowed=_("at: [point of one, point of the other]"),
            )  # fmt: skip
        want = TORSION if twists else STIFFNESS
        rate = values.positive(getattr(given, stiffness), want, (*path, stiffness), zero=True)
        if given.free is None and rate > 0:
            raise ProblemError(
                _("the free length or angle of the spring is missing"), path=(*path, "free"),
                allowed=str(ANGLE if twists else LENGTH),
            )  # fmt: skip
        free = 0.0
        if given.free is not None and twists:
            free = values.number(given.free, ANGLE, (*path, "free"))
            if abs(free) > math.pi:
                raise ProblemError(
                    _("a free angle lies within half a turn; what a spring is wound up beyond that is its preload"),
                    path=(*path, "free"), found=str(given.free),
                )  # fmt: skip
        elif given.free is not None:
            free = values.positive(given.free, LENGTH, (*path, "free"), zero=True)
        preload = values.number(given.preload, MOMENT if twists else FORCE, (*path, "preload"))
        damping = values.positive(
            given.damping, TORSION_DAMPING if twists else DAMPING, (*path, "damping"), zero=True
        )  # fmt: skip
        found.append(Spring(name, i, j, ends[0], ends[1], twists, rate, free, preload, damping))
    return tuple(found)


def _not_in_one_hinge(name: str, at: list[Any], links: tuple[str, str], linkage: Linkage, path: Path) -> None:
    """Refuse a spring whose ends are one and the same hinge: it has no length and no direction."""
    for hinge in linkage.hinges:
        if set(links) <= set(hinge.links) and at[0] == at[1] == hinge.point:
            raise ProblemError(
                _("both ends of spring {name} are in hinge {point}: it has no length").format(
                    name=name, point=hinge.point
                ), path=path,
            )  # fmt: skip


def build_friction(linkage: Linkage, shape: schema.File, values: ValueReader) -> tuple[Friction, ...]:
    """Friction pair by pair; none without its block."""
    given = shape.friction
    if given is None:
        return ()
    pairs = {p.name: p for p in analyse(linkage).pairs if p.lower}
    common = values.positive(given.coefficient, NUMBER, ("friction", "coefficient"), zero=True)
    radius = values.positive(given.radius, LENGTH, ("friction", "radius"), zero=True)
    for name, own in given.pairs.items():
        path: Path = ("friction", "pairs", name)
        values.known(name, pairs, path, "turning or sliding pair", key=True)
        if pairs[name].kind == "P" and own.radius is not None:
            raise ProblemError(_("a sliding pair has no journal"), path=(*path, "radius"), key=True)
    found = []
    for name, pair in pairs.items():
        own = given.pairs.get(name) or schema.PairFriction()
        path = ("friction", "pairs", name)
        coefficient, journal = common, radius
        if own.coefficient is not None:
            coefficient = values.positive(own.coefficient, NUMBER, (*path, "coefficient"), zero=True)
        if own.radius is not None:
            journal = values.positive(own.radius, LENGTH, (*path, "radius"), zero=True)
        if coefficient and (pair.kind == "P" or journal):
            found.append(Friction(name, coefficient, journal if pair.kind == "R" else 0.0))
    return tuple(found)
