"""Springs and friction of a problem file."""

from __future__ import annotations

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
            raise ProblemError("a load has this name", path=path, found=quote(name), key=True)
        i, j = (sense.known(n, linkage.links, (*path, "between", k), "link") for k, n in enumerate(given.between))
        if i == j:
            raise ProblemError("a spring joins two links", path=(*path, "between"), found=f"{i}, {j}")
        twists = given.torsion is not None
        if twists == (given.rate is not None):
            raise ProblemError(
                "rate or torsion is wanted", path=path, found="both" if twists else "neither",
                allowed="rate: 5 N/mm, or torsion: 2 N*m/rad", key=True,
            )  # fmt: skip
        if twists and given.at is not None:
            raise ProblemError("a torsion spring has no ends", path=(*path, "at"), key=True)
        ends = [next(iter(linkage.links[n].points.values()), 0j) for n in (i, j)]
        if given.at is not None:
            ends = [
                sense.place(place, linkage.links[n].points, (*path, "at", k), n)
                for k, (n, place) in enumerate(zip((i, j), given.at, strict=True))
            ]
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
        free = 0.0 if given.free is None else sense.number(given.free, ANGLE if twists else LENGTH, (*path, "free"))
        preload = sense.number(given.preload, MOMENT if twists else FORCE, (*path, "preload"))
        damping = sense.positive(
            given.damping, TORSION_DAMPING if twists else DAMPING, (*path, "damping"), zero=True
        )  # fmt: skip
        found.append(Spring(name, i, j, ends[0], ends[1], twists, rate, free, preload, damping))
    return tuple(found)


def build_friction(linkage: Linkage, shape: schema.File, sense: Sense) -> tuple[Friction, ...]:
    """Friction pair by pair; none without its block."""
    given = shape.friction
    if given is None:
        return ()
    pairs = {p.name: p for p in analyse(linkage).pairs if p.lower}
    common = sense.positive(given.coefficient, NUMBER, ("friction", "coefficient"), zero=True)
    radius = sense.positive(given.radius, LENGTH, ("friction", "radius"), zero=True)
    for name in given.pairs:
        if name not in pairs:
            raise ProblemError(
                "there is no pair of that name", path=("friction", "pairs", name), found=quote(name),
                allowed=", ".join(pairs), near=nearest(name, list(pairs)), key=True,
            )  # fmt: skip
    found = []
    for name, pair in pairs.items():
        own = given.pairs.get(name)
        path: Path = ("friction", "pairs", name)

        def value(key: str, want: Any, other: float, own: Any = own, path: Path = path) -> float:
            own_value = getattr(own, key) if own is not None else None
            return other if own_value is None else sense.positive(own_value, want, (*path, key), zero=True)

        coefficient, journal = value("coefficient", NUMBER, common), value("radius", LENGTH, radius)
        if coefficient and (pair.kind == "P" or journal):
            found.append(Friction(name, coefficient, journal if pair.kind == "R" else 0.0))
    return tuple(found)
