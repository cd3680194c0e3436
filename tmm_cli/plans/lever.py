"""The Zhukovsky lever of a position: the velocity plan turned through 90 degrees, loaded with all forces."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

from tmm_cli.forces.lever import Lever
from tmm_cli.motion import Motion
from tmm_cli.plans.record import NamedVector
from tmm_cli.plans.velocity import hinge_points


@dataclass(frozen=True)
class LeverForce:
    """A force (N) at a place of the lever (m per unit of the driver's motion), and the foot of its arm."""

    name: str
    at: complex
    force: complex
    foot: complex


@dataclass(frozen=True)
class LeverPlan:
    """ends: lettered points of the turned plan. bars: its lines. couples: name and moment on the lever, N m."""

    ends: dict[str, complex]
    bars: tuple[NamedVector, ...]
    forces: tuple[LeverForce, ...]
    couples: tuple[tuple[str, float], ...]
    balancing: float


def lever_plan(motion: Motion, lever: Lever, k: int) -> LeverPlan:
    """Velocities per unit of the driver's motion, turned by +90 degrees; forces keep their directions."""
    linkage = motion.linkage
    ends: dict[str, complex] = {"p": 0j}
    fixed = set(linkage.links["0"].points)
    for link in linkage.moving:
        for point in linkage.links[link].points:
            if point not in fixed:
                ends.setdefault(point.lower(), 1j * complex(motion.named(point).first[k]))
    bars = [NamedVector(f"p{name}", 0j, end, "absolute") for name, end in ends.items() if name != "p"]
    for link in linkage.moving:
        told = [p.lower() for p in hinge_points(linkage, link) if p not in fixed]
        bars += [NamedVector(a + b, ends[a], ends[b], "relative") for a, b in pairwise(told)]
    forces, couples = [], []
    for item in lever.items:
        if item.end is None or item.force is None:
            couples.append((item.name, float(item.moment[k])))
            continue
        at, force = 1j * complex(item.end[k]), complex(item.force[k])
        if force == 0:
            continue
        along = force / abs(force)
        foot = at - along * (at * along.conjugate()).real
        forces.append(LeverForce(item.name, at, force, foot))
    return LeverPlan(ends, tuple(bars), tuple(forces), tuple(couples), float(lever.balancing[k]))
