"""The Zhukovsky lever of a position: the velocity plan turned through 90 degrees, loaded with all forces."""

from __future__ import annotations

from dataclasses import dataclass

from tmm_cli.forces.lever import Item, Lever
from tmm_cli.kinematics.motion import Motion
from tmm_cli.plans.record import NamedVector
from tmm_cli.plans.velocity import absolute, ends_of, relative


@dataclass(frozen=True)
class LeverForce:
    """A force (N) at a place of the lever (m per unit of the driver's motion), and the foot of its arm."""

    name: str
    at: complex
    force: complex
    foot: complex


@dataclass(frozen=True)
class LeverPlan:
    """ends: lettered points of the turned plan. bars: its lines.

    A couple on a link of two points and more is the pair of forces in `forces` that has its moment; couples has the
    others: name and moment on the lever, N m.
    """

    ends: dict[str, complex]
    bars: tuple[NamedVector, ...]
    forces: tuple[LeverForce, ...]
    couples: tuple[tuple[str, float], ...]
    balancing: float


def lever_plan(motion: Motion, lever: Lever, k: int) -> LeverPlan:
    """Velocities per unit of the driver's motion, turned by +90 degrees; forces keep their directions."""
    linkage = motion.linkage
    ends = ends_of(linkage, "p", lambda point: 1j * complex(motion.named(point).first[k]))
    bars = (*absolute(ends, "p"), *relative(linkage, ends))
    forces, couples = [], []
    for item in lever.items:
        if item.end is None or item.force is None:
            pair = _couple(motion, item, k)
            forces += pair
            if not pair:
                couples.append((item.name, float(item.moment[k])))
        elif item.force[k] != 0:
            forces.append(_force(item.name, 1j * complex(item.end[k]), complex(item.force[k])))
    return LeverPlan(ends, bars, tuple(forces), tuple(couples), float(lever.balancing[k]))


def _force(name: str, at: complex, force: complex) -> LeverForce:
    along = force / abs(force)
    return LeverForce(name, at, force, at - along * (at * along.conjugate()).real)


def _couple(motion: Motion, item: Item, k: int) -> list[LeverForce]:
    """A couple as two forces across the line of the link's first two points, at the ends of their velocities."""
    link = motion.linkage.links[item.link]
    size = float(item.size[k])
    if len(link.points) < 2 or size == 0:
        return []
    one, other, *_ = link.points.values()
    if one == other:
        return []
    arm = complex((other - one) * motion.poses[item.link].z[k])
    force = 1j * arm * (size / abs(arm) ** 2)
    ends = (1j * complex(motion.point(item.link, local).first[k]) for local in (one, other))
    return [_force(item.name, end, f) for end, f in zip(ends, (-force, force), strict=True)]
