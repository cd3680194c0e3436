"""The acceleration plan of a position: pole π, normal and tangential parts of each link, Coriolis and sliding parts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from tmm_cli.kinematics.motion import Motion
from tmm_cli.plans.record import NamedVector, Plan, Symbol, subscript
from tmm_cli.plans.vector_equations import About, Along, steps
from tmm_cli.plans.velocity import Stone, absolute, ends_of, groups_of, letters, massive, other_than, stones
from tmm_cli.tolerances import NO_VECTOR

POLE = "π"

Pair = tuple[NamedVector, NamedVector]


def acceleration_plan(motion: Motion, k: int) -> Plan:
    """Vectors πa, a^n_BA, a^τ_BA, a^k, a^r in m/s2 at position k. Each pair of parts leads from one end to another."""
    linkage = motion.linkage
    ends = ends_of(linkage, POLE, lambda point: motion.named(point).a[k])
    names = {letter: point for point, letter in letters(linkage).items()}
    found = {stone.slide.name: stone for stone in stones(motion, ends, k)}
    for stone in found.values():
        ends[stone.under] = complex(motion.point(stone.slide.carrier, stone.local).a[k])
        names[stone.under] = stone.below
    ended = {name: ends[letter] for letter, name in names.items() if letter in ends}
    local = {stone.below: stone.local for stone in found.values()}
    pairs: list[Pair] = []
    for step in steps(linkage, groups_of(motion)):
        for equation in (*step.equations, *step.after):
            if isinstance(equation, Along):
                stone = found[equation.slide.name]
                pairs.append(_sliding(motion, k, stone, ends[stone.under]))
            elif isinstance(equation, About) and not equation.idle:
                pairs.append(_turning(motion, k, equation, local, ended.get(equation.base.name, 0j)))
    for link in massive(linkage):
        letter = other_than(ends, f"s{link}")
        ends[letter], names[letter] = complex(motion.centre(link).a[k]), f"S{link}"
    vectors = [part for pair in pairs for part in pair]
    least = NO_VECTOR * Plan(tuple(vectors), ends).size
    corners = _corners(pairs, ends, least)
    segments = [replace(v, name=_segment(v, {**ends, **corners}, least)) for v in vectors]
    return Plan((*absolute(ends, POLE, "a", names), *segments), ends, corners)


def _turning(motion: Motion, k: int, about: About, local: Mapping[str, complex], start: complex) -> Pair:
    """Normal part (towards the base) and tangential part of a point's acceleration about another of its link.

    local: of the points under stones, in the axes of their links.
    """
    link, index = about.link, about.point.name + about.base.name
    turning, own = motion.link(link), {**motion.linkage.links[link].points, **local}
    radius = complex((own[about.point.name] - own[about.base.name]) * motion.poses[link].z[k])
    bend = start - complex(turning.omega[k] ** 2) * radius
    end = bend + 1j * complex(turning.epsilon[k]) * radius
    return (
        NamedVector("", start, bend, "normal", Symbol("a", index, "n")),
        NamedVector("", bend, end, "tangential", Symbol("a", index, "τ")),
    )


def _sliding(motion: Motion, k: int, stone: Stone, start: complex) -> Pair:
    """Coriolis part and sliding part of a stone's acceleration about the point of its guide under it."""
    sliding, index = motion.slide(stone.slide), stone.name + stone.below
    bend = start + complex(sliding.coriolis[k])
    end = bend + complex(sliding.a[k] * sliding.u[k])
    return (
        NamedVector("", start, bend, "coriolis", Symbol("a", index, "k")),
        NamedVector("", bend, end, "sliding", Symbol("a", index, "r")),
    )


def _corners(pairs: Sequence[Pair], ends: Mapping[str, complex], least: float) -> dict[str, complex]:
    """Letters of the points in which two parts meet: n₁, n₂, ..., k; none where one of the parts is zero."""
    found: dict[str, complex] = {}
    for letter, kind in (("n", "normal"), ("k", "coriolis")):
        bends = [
            first.end
            for first, last in pairs
            if first.kind == kind and min(map(abs, (first.value, last.value))) > least
        ]
        for number, bend in enumerate(bends, 1):
            found[other_than(ends, letter + (subscript(str(number)) if len(bends) > 1 else ""))] = bend
    return found


def _segment(vector: NamedVector, lettered: Mapping[str, complex], least: float) -> str:
    """The letters of a vector's ends, of the nearest places: near a dead position rounding parts them; nothing where
    it is zero."""
    if abs(vector.value) <= least:
        return ""
    return "".join(
        min(lettered, key=lambda letter: max(abs(lettered[letter] - end), least)) for end in (vector.start, vector.end)
    )
