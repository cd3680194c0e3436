"""Velocity and acceleration plans of one position, and the values that are measured on them."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from tmm_cli.mechanics.forces import Symbol, distinct_letter, subscript
from tmm_cli.mechanics.groups import GearConstraint, RackConstraint, carrier_axis
from tmm_cli.mechanics.kinematics import Motion
from tmm_cli.mechanics.linkage import FRAME, Linkage, Slide
from tmm_cli.mechanics.numerics import NO_VECTOR
from tmm_cli.mechanics.plans.named_vectors import NamedVector, Plan
from tmm_cli.mechanics.plans.vector_equations import (
    MovingGuideEquation,
    SameLinkEquation,
    motion_points,
    solution_rank,
    solution_steps,
)
from tmm_cli.mechanics.structure import Group


def plan_letters(linkage: Linkage) -> dict[str, str]:
    """Return the lower-case letter that marks each point on the plans, by name of the point.

    Moving points have different letters, none of them p or π, the letters of the poles.
    """
    fixed = linkage.links[FRAME].points
    letters = {point: point.lower() for point in fixed}
    taken = {"p", "π"}
    for link in linkage.moving:
        for point in linkage.links[link].points:
            if point not in letters:
                letters[point] = distinct_letter(taken, point.lower())
                taken.add(letters[point])
    return letters


def plan_ends(linkage: Linkage, pole: str, value: Callable[[str], complex]) -> dict[str, complex]:
    """Return the coordinates of the pole and of the ends of all moving points' vectors, by letter.

    value: function that returns the vector of a point from the name of the point.
    """
    letter_of = plan_letters(linkage)
    return {pole: 0j} | {letter_of[point]: complex(value(point)) for point in linkage.moving_points}


def relative_vectors(motion: Motion, ends: Mapping[str, complex]) -> list[NamedVector]:
    """Return the relative velocities ab, ac, ... of the points of each link.

    All vectors of a link begin at the same point: the one whose motion is known first.
    """
    linkage = motion.linkage
    fixed, letter_of = linkage.links[FRAME].points, plan_letters(linkage)
    rank = solution_rank(linkage, groups_of(motion))
    vectors = []
    for link in linkage.moving:
        base, *others = sorted((p for p in motion_points(linkage, link) if p not in fixed), key=rank.__getitem__) or [
            ""
        ]
        for point in others:
            a, b = letter_of[base], letter_of[point]
            vectors.append(NamedVector(a + b, ends[a], ends[b], "relative", Symbol("v", point + base)))
    return vectors


def groups_of(motion: Motion) -> list[Group]:
    """Return the Assur groups of a solved motion, in solution order."""
    return [kernel.group for kernel in motion.kernels]


def absolute_vectors(
    ends: Mapping[str, complex], pole: str, letter: str = "v", names: Mapping[str, str] | None = None
) -> list[NamedVector]:
    """Return the vectors pa, pb, ... from the pole to the end of every point's vector.

    Args:
        ends: ends of the vectors by letter.
        pole: letter of the pole.
        letter: v or a, the letter of the symbols.
        names: name of the point for each letter, used as subscript; default: the letter itself.
    """
    names = names or {}
    return [
        NamedVector(pole + end, 0j, value, "absolute", Symbol(letter, names.get(end, end)))
        for end, value in ends.items()
        if end != pole
    ]


@dataclass(frozen=True)
class SlidingBlock:
    """Sliding block on a moving guide, and the point of the guide that coincides with it.

    Attributes:
        slide: the prismatic pair.
        letter, under: letters of the block and of the coincident point on the plan.
        name, below: names of the two points.
        local: coincident point in the axes of the guide's link, m.
    """

    slide: Slide
    letter: str
    under: str
    name: str
    below: str
    local: complex


def sliding_blocks(motion: Motion, ends: Collection[str], k: int) -> Iterable[SlidingBlock]:
    """Yield the sliding blocks on moving guides at position k.

    ends: letters already used on the plan.
    """
    letter_of = plan_letters(motion.linkage)
    for slide in motion.linkage.slides:
        if FRAME not in (slide.carrier, slide.runner):
            letter, point = letter_of.get(slide.point, slide.point.lower()), slide.point
            carrier, runner = motion.poses[slide.carrier], motion.point(slide.runner, slide.at)
            local = complex((runner.x[k] - carrier.x[k]) / carrier.z[k])
            under = distinct_letter(ends, f"{letter}{slide.carrier}")
            yield SlidingBlock(slide, letter, under, point, f"{point}{slide.carrier}", local)


def velocity_plan(motion: Motion, k: int) -> Plan:
    """Build the velocity plan at position k: pole p and the vectors pa, ab, ... in m/s."""
    linkage = motion.linkage
    ends = plan_ends(linkage, "p", lambda point: motion.named(point).v[k])
    vectors, names = relative_vectors(motion, ends), {letter: point for point, letter in plan_letters(linkage).items()}
    for block in sliding_blocks(motion, ends, k):
        slide, under = block.slide, block.under
        ends[under], names[under] = complex(motion.point(slide.carrier, block.local).v[k]), block.below
        runner, symbol = complex(motion.point(slide.runner, slide.at).v[k]), Symbol("v", block.name + block.below)
        segment = under + (block.letter if block.letter in ends else "p")  # a pivot of the frame is the pole
        vectors.append(NamedVector(segment, ends[under], runner, "sliding", symbol))
    for name, wheel, place in pitch_points(motion, k):
        pose, letter = motion.poses[wheel], distinct_letter(ends, name.lower())
        ends[letter] = complex(motion.point(wheel, (place - pose.x[k]) / pose.z[k]).v[k])
        names[letter] = name
    for link in links_with_mass(linkage):
        letter = distinct_letter(ends, f"s{link}")
        ends[letter], names[letter] = complex(motion.centre(link).v[k]), f"S{link}"
    return Plan((*absolute_vectors(ends, "p", "v", names), *vectors), ends)


def links_with_mass(linkage: Linkage) -> list[str]:
    """Return the names of the moving links that have a mass. These links also have a centre of mass."""
    return [link for link in linkage.moving if np.any(linkage.links[link].mass != 0)]


def pitch_points(motion: Motion, k: int) -> Iterable[tuple[str, str, complex]]:
    """Yield the pitch point of each pair of gears, or gear and rack, at which both bodies have the same velocity.

    Yields:
        Name of the pitch point, name of the moving gear, position of the pitch point (m).
    """
    linkage = motion.linkage
    for mesh in linkage.meshes:
        if mesh.kind == "cam":
            continue
        axis = carrier_axis(linkage, mesh.i, mesh.carrier)
        if mesh.kind == "gear":
            place = GearConstraint(mesh.name, mesh, axis, carrier_axis(linkage, mesh.j, mesh.carrier)).contact(
                motion.poses
            )[0]
        else:
            place = RackConstraint(mesh.name, mesh, linkage.slide(mesh.slide), axis).contact(motion.poses)[0]
        yield mesh.name, mesh.j if mesh.i == FRAME else mesh.i, complex(np.broadcast_to(place, motion.q.shape)[k])


# The acceleration plan of a position: pole π, normal and tangential parts of each link, Coriolis and sliding parts.


ACCELERATION_POLE = "π"

VectorPair = tuple[NamedVector, NamedVector]


def acceleration_plan(motion: Motion, k: int) -> Plan:
    """Build the acceleration plan at position k: pole π and the vectors πa, a^n_BA, a^τ_BA, a^k, a^r in m/s2.

    Two components together lead from the end of one absolute acceleration to the end of another.
    """
    linkage = motion.linkage
    ends = plan_ends(linkage, ACCELERATION_POLE, lambda point: motion.named(point).a[k])
    names = {letter: point for point, letter in plan_letters(linkage).items()}
    blocks = {block.slide.name: block for block in sliding_blocks(motion, ends, k)}
    for block in blocks.values():
        ends[block.under] = complex(motion.point(block.slide.carrier, block.local).a[k])
        names[block.under] = block.below
    ended = {name: ends[letter] for letter, name in names.items() if letter in ends}
    local = {block.below: block.local for block in blocks.values()}
    pairs: list[VectorPair] = []
    for step in solution_steps(linkage, groups_of(motion)):
        for equation in (*step.equations, *step.after):
            if isinstance(equation, MovingGuideEquation):
                block = blocks[equation.slide.name]
                pairs.append(_sliding_parts(motion, k, block, ends[block.under]))
            elif isinstance(equation, SameLinkEquation) and not equation.idle:
                pairs.append(_rotation_parts(motion, k, equation, local, ended.get(equation.base.name, 0j)))
    for link in links_with_mass(linkage):
        letter = distinct_letter(ends, f"s{link}")
        ends[letter], names[letter] = complex(motion.centre(link).a[k]), f"S{link}"
    vectors = [component for pair in pairs for component in pair]
    least = NO_VECTOR * Plan(tuple(vectors), ends).size
    corners = _corners(pairs, ends, least)
    segments = [replace(v, name=_segment_letters(v, {**ends, **corners}, least)) for v in vectors]
    return Plan((*absolute_vectors(ends, ACCELERATION_POLE, "a", names), *segments), ends, corners)


def _rotation_parts(
    motion: Motion, k: int, about: SameLinkEquation, local: Mapping[str, complex], start: complex
) -> VectorPair:
    """Compute the normal and the tangential component of the acceleration of a point relative to another point of its
    link.

    Args:
        motion: solved motion.
        k: index of the position.
        about: equation that relates the two points.
        local: points of guides that coincide with sliding blocks, in the axes of their links (m).
        start: end of the other point's acceleration, where the normal component begins.
    """
    link, index = about.link, about.point.name + about.base.name
    rotation, points = motion.link(link), {**motion.linkage.links[link].points, **local}
    radius = complex((points[about.point.name] - points[about.base.name]) * motion.poses[link].z[k])
    bend = start - complex(rotation.omega[k] ** 2) * radius
    end = bend + 1j * complex(rotation.epsilon[k]) * radius
    return (
        NamedVector("", start, bend, "normal", Symbol("a", index, "n")),
        NamedVector("", bend, end, "tangential", Symbol("a", index, "τ")),
    )


def _sliding_parts(motion: Motion, k: int, block: SlidingBlock, start: complex) -> VectorPair:
    """Compute the Coriolis and the sliding component of the acceleration of a block relative to its guide.

    start: end of the acceleration of the guide's point that coincides with the block. The Coriolis component begins
    there.
    """
    sliding, index = motion.slide(block.slide), block.name + block.below
    bend = start + complex(sliding.coriolis[k])
    end = bend + complex(sliding.a[k] * sliding.u[k])
    return (
        NamedVector("", start, bend, "coriolis", Symbol("a", index, "k")),
        NamedVector("", bend, end, "sliding", Symbol("a", index, "r")),
    )


def _corners(pairs: Sequence[VectorPair], ends: Mapping[str, complex], least: float) -> dict[str, complex]:
    """Return letters and positions of the points n₁, n₂, ..., k at which two components of an acceleration meet.

    There is no such point where one of the components is zero.
    """
    corners: dict[str, complex] = {}
    for letter, kind in (("n", "normal"), ("k", "coriolis")):
        bends = [
            first.end
            for first, last in pairs
            if first.kind == kind and min(map(abs, (first.value, last.value))) > least
        ]
        for number, bend in enumerate(bends, 1):
            corners[distinct_letter(ends, letter + (subscript(str(number)) if len(bends) > 1 else ""))] = bend
    return corners


def _segment_letters(vector: NamedVector, lettered: Mapping[str, complex], least: float) -> str:
    """Return the letters at the two ends of a vector; empty for a zero vector.

    The nearest lettered points are taken, since near a dead position rounding errors separate ends that
    coincide.
    """
    if abs(vector.value) <= least:
        return ""
    return "".join(
        min(lettered, key=lambda letter: max(abs(lettered[letter] - end), least)) for end in (vector.start, vector.end)
    )


# Readings of a plan: each vector once with its segment and magnitude, and angular velocities of links.


PART_KINDS = ("normal", "tangential")


@dataclass(frozen=True)
class PlanReading:
    """Vector measured on a plan.

    Attributes:
        symbols: symbols of all quantities that this vector represents.
        segment: letters at its two ends; empty if it is zero.
        size: magnitude in SI units.
    """

    symbols: tuple[Symbol, ...]
    segment: str
    size: float


@dataclass(frozen=True)
class AngularValue:
    """Angular velocity omega (rad/s) or acceleration epsilon (rad/s2) of a link, positive counterclockwise."""

    symbol: Symbol
    value: float


def plan_readings(plan: Plan) -> list[PlanReading]:
    """Return the vectors to be measured on a plan, in the order of the plan.

    Absolute vectors that are equal make one reading. Normal and tangential components of links that do not
    rotate are left out.
    """
    least = NO_VECTOR * plan.size
    turning = {v.symbol.below for v in plan.vectors if v.kind in PART_KINDS and abs(v.value) > least}
    readings: dict[complex | int, PlanReading] = {}
    for number, vector in enumerate(plan.vectors):
        magnitude = abs(vector.value)
        if vector.kind in PART_KINDS and vector.symbol.below not in turning:
            continue
        key: complex | int = number
        if vector.kind == "absolute":
            key = next(
                (end for end in readings if isinstance(end, complex) and abs(end - vector.end) <= least), vector.end
            )
        if key in readings:
            readings[key] = PlanReading(
                (*readings[key].symbols, vector.symbol), readings[key].segment, readings[key].size
            )
        else:
            readings[key] = PlanReading(
                (vector.symbol,), vector.name if magnitude > least else "", magnitude if magnitude > least else 0.0
            )
    return list(readings.values())


def angular_values(motion: Motion, k: int, quantity: Literal["omega", "epsilon"]) -> Iterable[AngularValue]:
    """Yield omega or epsilon at position k for each link that rotates at some position."""
    letter = {"omega": "ω", "epsilon": "ε"}[quantity]
    links = {link: motion.link(link) for link in motion.linkage.moving}
    rates = {link: getattr(rotation, quantity) for link, rotation in links.items()}
    largest = max((float(np.nanmax(np.abs(rate))) for rate in rates.values()), default=0.0)
    if quantity == "epsilon":  # in uniform rotation rounding errors are small only compared with omega squared
        largest = max([largest, *(float(np.nanmax(np.abs(rotation.omega))) ** 2 for rotation in links.values())])
    for link, rate in rates.items():
        if np.nanmax(np.abs(rate)) > NO_VECTOR * largest:
            value = float(rate[k])
            yield AngularValue(Symbol(letter, link), value if abs(value) > NO_VECTOR * largest else 0.0)
