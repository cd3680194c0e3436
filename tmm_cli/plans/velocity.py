"""The velocity plan of a position: pole p, ends of the absolute velocities, relative velocities between them."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from tmm_cli.kinematics.motion import Motion
from tmm_cli.linkage import FRAME, Linkage, Slide
from tmm_cli.pairs.base import axis
from tmm_cli.pairs.gear import Gear
from tmm_cli.pairs.rack import Rack
from tmm_cli.plans.record import NamedVector, Plan, Symbol
from tmm_cli.plans.vector_equations import found_first, hinge_points
from tmm_cli.structure.assur import Group


def letters(linkage: Linkage) -> dict[str, str]:
    """What each point is called on a plan: in small letters; P is not the pole p, nor A the same as a."""
    fixed = linkage.links[FRAME].points
    found = {point: point.lower() for point in fixed}
    taken = {"p", "π"}
    for link in linkage.moving:
        for point in linkage.links[link].points:
            if point not in found:
                found[point] = other_than(taken, point.lower())
                taken.add(found[point])
    return found


def other_than(taken: Collection[str], letter: str) -> str:
    """The letter, with as many primes as it needs not to be one of those taken."""
    while letter in taken:
        letter += "′"
    return letter


def ends_of(linkage: Linkage, pole: str, value: Callable[[str], complex]) -> dict[str, complex]:
    """The pole, and the ends of the vectors of all moving points, by their letters; value: of a point by its name."""
    letter_of = letters(linkage)
    return {pole: 0j} | {letter_of[point]: complex(value(point)) for point in linkage.moving_points}


def relative(motion: Motion, ends: Mapping[str, complex]) -> list[NamedVector]:
    """Vectors ab, ac, ... along each link, from the end of its point that is found first to those of the others."""
    linkage = motion.linkage
    fixed, letter_of = linkage.links[FRAME].points, letters(linkage)
    rank = found_first(linkage, groups_of(motion))
    vectors = []
    for link in linkage.moving:
        base, *others = sorted((p for p in hinge_points(linkage, link) if p not in fixed), key=rank.__getitem__) or [""]
        for point in others:
            a, b = letter_of[base], letter_of[point]
            vectors.append(NamedVector(a + b, ends[a], ends[b], "relative", Symbol("v", point + base)))
    return vectors


def groups_of(motion: Motion) -> list[Group]:
    """The groups as they were solved."""
    return [kernel.group for kernel in motion.kernels]


def absolute(
    ends: Mapping[str, complex], pole: str, letter: str = "v", names: Mapping[str, str] | None = None
) -> list[NamedVector]:
    """Vectors pa, pb, ... from the pole to every end. letter: of their values; names: of points by their letters."""
    names = names or {}
    return [
        NamedVector(pole + end, 0j, value, "absolute", Symbol(letter, names.get(end, end)))
        for end, value in ends.items()
        if end != pole
    ]


@dataclass(frozen=True)
class Stone:
    """A stone on a moving guide and the point of the guide under it, at `local` in the axes of the guide's link.

    letter, under: letters of both on the plan; name, below: names of both.
    """

    slide: Slide
    letter: str
    under: str
    name: str
    below: str
    local: complex


def stones(motion: Motion, ends: Collection[str], k: int) -> Iterable[Stone]:
    """Stones on moving guides; ends: letters that are taken."""
    letter_of = letters(motion.linkage)
    for slide in motion.linkage.slides:
        if FRAME not in (slide.carrier, slide.runner):
            letter, point = letter_of.get(slide.point, slide.point.lower()), slide.point
            carrier, runner = motion.poses[slide.carrier], motion.point(slide.runner, slide.at)
            local = complex((runner.x[k] - carrier.x[k]) / carrier.z[k])
            under = other_than(ends, f"{letter}{slide.carrier}")
            yield Stone(slide, letter, under, point, f"{point}{slide.carrier}", local)


def velocity_plan(motion: Motion, k: int) -> Plan:
    """Vectors pa, ab, ... in m/s at position k."""
    linkage = motion.linkage
    ends = ends_of(linkage, "p", lambda point: motion.named(point).v[k])
    vectors, names = relative(motion, ends), {letter: point for point, letter in letters(linkage).items()}
    for stone in stones(motion, ends, k):
        slide, under = stone.slide, stone.under
        ends[under], names[under] = complex(motion.point(slide.carrier, stone.local).v[k]), stone.below
        runner, symbol = complex(motion.point(slide.runner, slide.at).v[k]), Symbol("v", stone.name + stone.below)
        segment = under + (stone.letter if stone.letter in ends else "p")  # a pivot of the frame is the pole
        vectors.append(NamedVector(segment, ends[under], runner, "sliding", symbol))
    for name, wheel, place in pitch_points(motion, k):
        pose, letter = motion.poses[wheel], other_than(ends, name.lower())
        ends[letter] = complex(motion.point(wheel, (place - pose.x[k]) / pose.z[k]).v[k])
        names[letter] = name
    for link in massive(linkage):
        letter = other_than(ends, f"s{link}")
        ends[letter], names[letter] = complex(motion.centre(link).v[k]), f"S{link}"
    return Plan((*absolute(ends, "p", "v", names), *vectors), ends)


def massive(linkage: Linkage) -> list[str]:
    """Moving links that have a mass, and so a centre of mass."""
    return [link for link in linkage.moving if np.any(linkage.links[link].mass != 0)]


def pitch_points(motion: Motion, k: int) -> Iterable[tuple[str, str, complex]]:
    """Where wheels roll on one another or on racks, with one velocity for both: name, moving wheel, place (m)."""
    linkage = motion.linkage
    for mesh in linkage.meshes:
        if mesh.kind == "cam":
            continue
        one = axis(linkage, mesh.i, mesh.carrier)
        if mesh.kind == "gear":
            place = Gear(mesh.name, mesh, one, axis(linkage, mesh.j, mesh.carrier)).contact(motion.poses)[0]
        else:
            place = Rack(mesh.name, mesh, linkage.slide(mesh.slide), one).contact(motion.poses)[0]
        yield mesh.name, mesh.j if mesh.i == FRAME else mesh.i, complex(np.broadcast_to(place, motion.q.shape)[k])
