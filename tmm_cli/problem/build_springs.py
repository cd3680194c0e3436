"""Springs and friction of a problem file."""

from __future__ import annotations

import math
from typing import Any

from tmm_cli.linkage import Friction, Linkage, Spring
from tmm_cli.problem import schema
from tmm_cli.problem.dimensions import DAMPING, TORSION, TORSION_DAMPING
from tmm_cli.problem.errors import Path, ProblemError, nearest, quote
from tmm_cli.problem.sense import Sense, check_name
from tmm_cli.problem.units import ANGLE, FORCE, LENGTH, MOMENT, NUMBER, STIFFNESS
from tmm_cli.structure.assur import analyse


def build_springs(linkage: Linkage, shape: schema.File, sense: Sense) -> tuple[Spring, ...]:
    """The springs, in the order of the file."""
    found = []
    for name, given in shape.springs.items():
        path: Path = ("springs", name)
        check_name(name, path, "load")
        if name in shape.loads:
            raise ProblemError(
                "a load has this name", path=path, found=quote(name), allowed="a name that no load has", key=True
            )
        i, j = (sense.known(n, linkage.links, (*path, "between", k), "link") for k, n in enumerate(given.between))
        if i == j:
            raise ProblemError(
                "a spring joins two different links", path=(*path, "between"), found=f"{i}, {j}",
                allowed="two links; the frame, 0, may be one",
            )  # fmt: skip
        twists = given.torsion is not None
        if twists == (given.rate is not None):
            raise ProblemError(
                "rate or torsion is wanted", path=path, found="both" if twists else "neither",
                allowed="rate: 5 N/mm, or torsion: 2 N*m/rad", key=True,
            )  # fmt: skip
        if twists and given.at is not None:
            raise ProblemError(
                "a torsion spring has no ends", path=(*path, "at"), allowed="between, torsion, free, preload, damping",
                key=True,
            )  # fmt: skip
        ends = [next(iter(linkage.links[n].points.values()), 0j) for n in (i, j)]
        if given.at is not None:
            ends = [
                sense.place(place, linkage.links[n].points, (*path, "at", k), n)
                for k, (n, place) in enumerate(zip((i, j), given.at, strict=True))
            ]
            _not_in_one_hinge(name, given.at, (i, j), linkage, (*path, "at"))
        elif not twists and any(len(linkage.links[n].points) > 1 for n in (i, j)):
            raise ProblemError(
                "where are the ends of the spring?",
                path=(*path, "at"),
                allowed="at: [point of one, point of the other]",
            )
        rate = sense.positive(given.torsion if twists else given.rate, TORSION if twists else STIFFNESS,
                              (*path, "torsion" if twists else "rate"), zero=True)  # fmt: skip
        if given.free is None and rate > 0:
            raise ProblemError(
                "the free length of the spring is missing" if not twists else "the free angle is missing",
                path=(*path, "free"), allowed=str(ANGLE if twists else LENGTH),
            )  # fmt: skip
        free = 0.0
        if given.free is not None and twists:
            free = sense.number(given.free, ANGLE, (*path, "free"))
            if abs(free) > math.pi:
                raise ProblemError(
                    "a free angle lies within half a turn: angles of links are counted so", path=(*path, "free"),
                    found=quote(given.free) if isinstance(given.free, str) else str(given.free),
                    allowed="-180 deg to 180 deg; what a spring is wound up beyond that is its preload",
                )  # fmt: skip
        elif given.free is not None:
            free = sense.positive(given.free, LENGTH, (*path, "free"), zero=True)
        preload = sense.number(given.preload, MOMENT if twists else FORCE, (*path, "preload"))
        damping = sense.positive(
            given.damping, TORSION_DAMPING if twists else DAMPING, (*path, "damping"), zero=True
        )  # fmt: skip
        found.append(Spring(name, i, j, ends[0], ends[1], twists, rate, free, preload, damping))
    return tuple(found)


def _not_in_one_hinge(name: str, at: list[Any], links: tuple[str, str], linkage: Linkage, path: Path) -> None:
    """Refuse a spring whose ends are one and the same hinge: it has no length and no direction."""
    for hinge in linkage.hinges:
        if set(links) <= set(hinge.links) and at[0] == at[1] == hinge.point:
            raise ProblemError(
                f"both ends of spring {name} are in hinge {hinge.point}: it has no length", path=path,
                found=f"{at[0]}, {at[1]}", allowed="two points, one of each link; torsion for a spring in a hinge",
            )  # fmt: skip


def build_friction(linkage: Linkage, shape: schema.File, sense: Sense) -> tuple[Friction, ...]:
    """Friction pair by pair; none without its block."""
    given = shape.friction
    if given is None:
        return ()
    pairs = {p.name: p for p in analyse(linkage).pairs if p.lower}
    common = sense.positive(given.coefficient, NUMBER, ("friction", "coefficient"), zero=True)
    radius = sense.positive(given.radius, LENGTH, ("friction", "radius"), zero=True)
    for name, own in given.pairs.items():
        if name in {mesh.name for mesh in linkage.meshes}:
            raise ProblemError(
                "friction is computed in turning and sliding pairs, not between teeth and on cams",
                path=("friction", "pairs", name), found=quote(name), allowed=", ".join(pairs), key=True,
            )  # fmt: skip
        if name in pairs and pairs[name].kind == "P" and own.radius is not None:
            raise ProblemError(
                f"{name} is a sliding pair: it has no journal", path=("friction", "pairs", name, "radius"),
                found=str(own.radius), allowed="coefficient", key=True,
            )  # fmt: skip
        if name not in pairs:
            raise ProblemError(
                "there is no pair of that name", path=("friction", "pairs", name), found=quote(name),
                allowed=", ".join(pairs), near=nearest(name, list(pairs)), key=True,
            )  # fmt: skip
    found = []
    for name, pair in pairs.items():
        told = given.pairs.get(name)
        path: Path = ("friction", "pairs", name)

        def value(key: str, want: Any, other: float, own: Any = told, path: Path = path) -> float:
            own_value = getattr(own, key) if own is not None else None
            return other if own_value is None else sense.positive(own_value, want, (*path, key), zero=True)

        coefficient, journal = value("coefficient", NUMBER, common), value("radius", LENGTH, radius)
        if coefficient and (pair.kind == "P" or journal):
            found.append(Friction(name, coefficient, journal if pair.kind == "R" else 0.0))
    return tuple(found)
