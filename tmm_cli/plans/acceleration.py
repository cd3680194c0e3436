"""The acceleration plan of a position: pole π, normal and tangential parts of each link, Coriolis and sliding parts."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise

from tmm_cli.kinematics.motion import Motion
from tmm_cli.linkage import FRAME
from tmm_cli.plans.record import NamedVector, Plan
from tmm_cli.plans.velocity import absolute, ends_of, hinge_points, letters, other_than, stones

POLE = "π"


def acceleration_plan(motion: Motion, k: int) -> Plan:
    """Vectors πa, n_ba, t_ba, k, r in m/s2 at position k. Each chain of parts leads from one end to the next."""
    linkage = motion.linkage
    fixed, letter_of = linkage.links[FRAME].points, letters(linkage)
    ends = ends_of(linkage, POLE, lambda point: motion.named(point).a[k])
    vectors: list[NamedVector] = []

    def parts(link: str, base: str, local: complex, letter: str) -> Iterable[NamedVector]:
        """Normal part (towards the base) and tangential part of a point's acceleration about another of its link."""
        turning, start = motion.link(link), 0j if base in fixed else ends[letter_of[base]]
        radius = complex((local - linkage.local(link, base)) * motion.poses[link].z[k])
        bend = start - complex(turning.omega[k] ** 2) * radius
        end, name = bend + 1j * complex(turning.epsilon[k]) * radius, f"({letter}{letter_of[base]})"
        return NamedVector(f"n{name}", start, bend, "normal"), NamedVector(f"t{name}", bend, end, "tangential")

    def told(link: str) -> list[str]:
        """From the pivot on the frame on, else from a hinge with another moving link."""
        return sorted(hinge_points(linkage, link), key=lambda p: p not in fixed)

    for link in linkage.moving:
        for base, point in pairwise(told(link)):
            if point not in fixed:
                vectors += parts(link, base, linkage.local(link, point), letter_of[point])
    for slide, letter, under, local in stones(motion, ends, k):
        ends[under] = complex(motion.point(slide.carrier, local).a[k])
        for base in told(slide.carrier)[:1]:
            vectors += parts(slide.carrier, base, local, under)
        sliding = motion.slide(slide)
        bend = ends[under] + complex(sliding.coriolis[k])
        vectors.append(NamedVector(f"k({letter})", ends[under], bend, "coriolis"))
        vectors.append(NamedVector(f"r({letter})", bend, bend + complex(sliding.a[k] * sliding.u[k]), "sliding"))
    for link in linkage.moving:
        if linkage.links[link].mass:
            ends[other_than(ends, f"s{link}")] = complex(motion.centre(link).a[k])
    return Plan((*absolute(ends, POLE), *vectors), ends)
