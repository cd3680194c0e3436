"""Stage: pressure angles of the groups over the driver's way.

The pressure angle is the acute angle between the force that drives a link, without gravity and inertia, and the
velocity of the point where it acts (I. I. Artobolevsky, Theory of Mechanisms and Machines, ch. 5). The force follows
from statics: the link is resisted by a moment (a force along its guide), the rest of its group carries nothing, and the
reactions of the group say where it is driven and in what direction. So it holds for a group of any class, with no
formula of its own.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial

import numpy as np

from tmm_cli.groups.base import Kernel
from tmm_cli.groups.state import Placement, Wrench
from tmm_cli.linkage import FRAME, Linkage
from tmm_cli.motion import Law, Motion, move
from tmm_cli.quality import SCAN, Range
from tmm_cli.roots import least
from tmm_cli.structure.assur import Group, Pair
from tmm_cli.vectors import Real, cross, dot, unit

NOTHING = 1e-9  # rad: below this the angle is zero everywhere and has no largest place


@dataclass(frozen=True)
class Pressure:
    """The largest pressure angle (rad) of a driven link, and the driver's place there (rad or m).

    pair: where the link is driven. slides: whether it slides on what holds it (else it turns). angles: at the positions
    that were asked for. allowed: rad; gain: the coefficient of force increase, 1/cos of the largest.
    """

    group: str
    link: str
    pair: str
    slides: bool
    largest: float
    place: float
    allowed: float
    angles: Real

    @property
    def transmission(self) -> float:
        """The least transmission angle, rad."""
        return np.pi / 2 - self.largest

    @property
    def gain(self) -> float:
        return float(1 / np.cos(self.largest)) if self.largest < np.pi / 2 - 1e-12 else float("inf")

    @property
    def holds(self) -> bool:
        """Whether it stays within what is allowed."""
        return self.largest <= self.allowed


def followers(group: Group) -> Iterable[tuple[str, Pair, Pair]]:
    """Links of a group that it drives: with the pair that holds them and the one in which they are driven.

    They have one inner pair; those held by the frame count, or the last one where none is.
    """
    leads = []
    for outer in group.outer:
        link = outer.i if outer.i in group.links else outer.j
        inner = [p for p in group.inner if link in (p.i, p.j)]
        held = [p for p in group.outer if link in (p.i, p.j)]
        if outer.lower and len(inner) == 1 and len(held) == 1 and inner[0].lower:
            leads.append((link, outer, inner[0]))
    on_frame = [lead for lead in leads if FRAME in (lead[1].i, lead[1].j)]
    return on_frame or leads[-1:]


def angle(motion: Motion, kernel: Kernel, at: Placement, lead: tuple[str, Pair, Pair]) -> Real:
    """Pressure angle of a driven link at every position, rad; nan where there is none."""
    link, outer, inner = lead
    group, poses = kernel.group, motion.poses
    pose = poses[link]
    still = np.zeros(np.shape(motion.q))
    if outer.slide is None:
        pivot = pose.at(motion.linkage.local(link, outer.point))
        resistance = Wrench(still + 0j, still + 1.0)
    else:
        u = poses[outer.slide.carrier].z * unit(outer.slide.direction)
        resistance = Wrench(u, cross(poses[outer.slide.runner].at(outer.slide.at) - pose.x, u))
    on = tuple(resistance if name == link else Wrench(still + 0j, still) for name in group.links)
    held = kernel.reactions(at, poses, on).inner[group.inner.index(inner)]
    size = np.abs(held.force)
    if inner.slide is None:
        point = poses[inner.i].at(motion.linkage.local(inner.i, inner.point))
    else:
        point = poses[inner.slide.runner].at(inner.slide.at)
        guide = poses[inner.slide.carrier].z * unit(inner.slide.direction)
        assert held.couple is not None
        point = point + guide * held.couple / dot(held.force, 1j * guide)
    along = u if outer.slide is not None else 1j * (point - pivot) / np.abs(point - pivot)
    across = np.abs(cross(held.force, along)) / size
    found: Real = np.arctan2(across, np.abs(dot(held.force, along)) / size)
    return found


def find_pressure(
    linkage: Linkage, kernels: tuple[Kernel, ...], way: Range, motion: Motion, allowed: tuple[float, float]
) -> tuple[Pressure, ...]:
    """The largest pressure angle of every driven link; allowed: of sliding and of turning links (rad)."""
    law = Law(way.start, 1.0, 0.0, 1)
    ends = (way.end - way.start) * 1e-9 * (not way.full)
    q = np.linspace(way.start + ends, way.end - ends, SCAN * way.turns + 1)
    scan = move(linkage, kernels, q, law)
    found = []
    with np.errstate(all="ignore"):
        for number, kernel in enumerate(kernels):
            for lead in followers(kernel.group):
                of = partial(_of, number, kernel, lead)
                angles = of(scan)
                if not np.any(np.isfinite(angles)):
                    continue
                k = int(np.nanargmax(angles))
                place, value = float(q[k]), float(angles[k])
                if value > NOTHING:
                    low, high = q[max(k - 1, 0)], q[min(k + 1, len(q) - 1)]
                    place, value = least(partial(_negative, of, linkage, kernels), low, high)
                    value = -value
                slides = lead[1].kind == "P"
                limit = allowed[0 if slides else 1]
                found.append(
                    Pressure(kernel.group.title, lead[0], lead[2].name, slides, value, place, limit, of(motion))
                )
    return tuple(found)


def _of(number: int, kernel: Kernel, lead: tuple[str, Pair, Pair], motion: Motion) -> Real:
    return angle(motion, kernel, motion.placements[number], lead)


def _negative(of: Callable[[Motion], Real], linkage: Linkage, kernels: tuple[Kernel, ...], q: Real) -> Real:
    return -of(move(linkage, kernels, q, Law(0.0, 1.0, 0.0, 1)))
