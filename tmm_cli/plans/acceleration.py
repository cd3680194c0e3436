"""The acceleration plan of a position: pole π, normal and tangential parts of each link, Coriolis and sliding parts."""

from __future__ import annotations

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
    for link in linkage.moving:
        told = sorted(hinge_points(linkage, link), key=lambda p: p not in fixed)  # from the pivot on
        for base, point in pairwise(told):
            if point not in fixed:
                start = 0j if base in fixed else ends[letter_of[base]]
                arm = linkage.local(link, point) - linkage.local(link, base)
                vectors += _parts(motion, link, arm, start, f"{letter_of[point]}{letter_of[base]}", k)
    for slide, letter, under, local in stones(motion, ends, k):
        ends[under] = complex(motion.point(slide.carrier, local).a[k])
        # from the carrier's pivot on the frame, else from a point in which it is hinged to another moving link
        told = sorted(hinge_points(linkage, slide.carrier), key=lambda p: p not in fixed)
        if told:
            base = told[0]
            start = 0j if base in fixed else ends[letter_of[base]]
            arm = local - linkage.local(slide.carrier, base)
            vectors += _parts(motion, slide.carrier, arm, start, f"{under}{letter_of[base]}", k)
        sliding = motion.slide(slide)
        bend = ends[under] + complex(sliding.coriolis[k])
        vectors.append(NamedVector(f"k({letter})", ends[under], bend, "coriolis"))
        vectors.append(NamedVector(f"r({letter})", bend, bend + complex(sliding.a[k] * sliding.u[k]), "sliding"))
    for link in linkage.moving:
        if linkage.links[link].mass:
            ends[other_than(ends, f"s{link}")] = complex(motion.centre(link).a[k])
    return Plan((*absolute(ends, POLE), *vectors), ends)


def _parts(motion: Motion, link: str, arm: complex, start: complex, name: str, k: int) -> list[NamedVector]:
    """Normal part (towards the base) and tangential part of a point's acceleration about another of its link."""
    turning = motion.link(link)
    radius = complex(arm * motion.poses[link].z[k])
    bend = start - complex(turning.omega[k] ** 2) * radius
    end = bend + 1j * complex(turning.epsilon[k]) * radius
    return [NamedVector(f"n({name})", start, bend, "normal"), NamedVector(f"t({name})", bend, end, "tangential")]
