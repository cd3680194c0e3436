"""The velocity plan of a position: pole p, ends of the absolute velocities, relative velocities between them."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from itertools import pairwise

import numpy as np

from tmm_cli.linkage import FRAME, Linkage
from tmm_cli.motion import Motion
from tmm_cli.pairs.gear import Gear
from tmm_cli.pairs.rack import Rack
from tmm_cli.plans.record import NamedVector, Plan
from tmm_cli.vectors import unit


def hinge_points(linkage: Linkage, link: str) -> list[str]:
    """Points of a link that tell its motion: those it shares with others, or all when it shares fewer than two."""
    points = list(linkage.links[link].points)
    shared = {h.point for h in linkage.hinges if link in h.links}
    running = {s.at for s in linkage.slides if s.runner == link}
    told = [p for p in points if p in shared or linkage.local(link, p) in running]
    return told if len(told) > 1 else points


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


def velocity_plan(motion: Motion, k: int) -> Plan:
    """Vectors pa, ab, ... in m/s at position k."""
    linkage = motion.linkage
    ends: dict[str, complex] = {"p": 0j}
    vectors: list[NamedVector] = []
    fixed, letter_of = set(linkage.links[FRAME].points), letters(linkage)
    for link in linkage.moving:
        for point in linkage.links[link].points:
            letter = letter_of[point]
            if point not in fixed and letter not in ends:
                ends[letter] = complex(motion.named(point).v[k])
                vectors.append(NamedVector(f"p{letter}", 0j, ends[letter], "absolute"))
    for link in linkage.moving:
        told = [p for p in hinge_points(linkage, link) if p not in fixed]
        for one, other in pairwise(told):
            a, b = letter_of[one], letter_of[other]
            vectors.append(NamedVector(a + b, ends[a], ends[b], "relative"))
    for slide in linkage.slides:
        if FRAME in (slide.carrier, slide.runner):
            continue
        runner = motion.point(slide.runner, slide.at)
        letter = letter_of.get(slide.point, slide.point.lower())
        under = other_than(ends, f"{letter}{slide.carrier}")
        carrier = motion.poses[slide.carrier]
        below = motion.point(slide.carrier, (runner.x[k] - carrier.x[k]) / carrier.z[k])
        ends[under] = complex(below.v[k])
        vectors.append(NamedVector(f"p{under}", 0j, ends[under], "absolute"))
        vectors.append(NamedVector(under + letter, ends[under], complex(runner.v[k]), "sliding"))
    for name, wheel, place in pitch_points(motion, k):
        letter = other_than(ends, name.lower())
        pose = motion.poses[wheel]
        ends[letter] = complex(motion.point(wheel, (place - pose.x[k]) / pose.z[k]).v[k])
        vectors.append(NamedVector(f"p{letter}", 0j, ends[letter], "absolute"))
    for link in linkage.moving:
        if linkage.links[link].mass:
            letter = other_than(ends, f"s{link}")
            ends[letter] = complex(motion.centre(link).v[k])
            vectors.append(NamedVector(f"p{letter}", 0j, ends[letter], "absolute"))
    return Plan(tuple(vectors), ends)


def pitch_points(motion: Motion, k: int) -> Iterable[tuple[str, str, complex]]:
    """Where wheels roll on one another or on racks, with one velocity for both: name, moving wheel, place (m)."""
    linkage = motion.linkage
    for mesh in linkage.meshes:
        if mesh.kind == "cam":
            continue
        points = [linkage.shared(mesh.carrier, wheel) for wheel in (mesh.i, mesh.j)]
        axes = [linkage.local(mesh.carrier, point) for point in points if point is not None]
        if mesh.kind == "gear":
            place = Gear(mesh.name, mesh, axes[0], axes[1]).pitch(motion.poses)[0]
        else:
            place = Rack(mesh.name, mesh, linkage.slide(mesh.slide), axes[0]).pitch(motion.poses)[0]
        yield mesh.name, mesh.j if mesh.i == FRAME else mesh.i, complex(np.broadcast_to(place, motion.q.shape)[k])


def guide_direction(motion: Motion, carrier: str, direction: float, k: int) -> complex:
    """The guide's direction in the drawing at position k."""
    return complex(motion.poses[carrier].z[k] * unit(direction))
