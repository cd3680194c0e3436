"""What springs, and cylinders that only push, do to the two links that they join."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tmm_cli.forces.applied import Applied
from tmm_cli.kinematics.motion import Motion
from tmm_cli.kinematics.strokes import Strokes
from tmm_cli.linkage import Spring
from tmm_cli.vectors import Real, dot, unit


def spring_loads(motion: Motion, strokes: Strokes | None) -> Iterable[Applied]:
    """The equal and opposite loads of each spring; on the frame they are left out."""
    still = np.zeros(np.shape(motion.q))
    moving = motion.linkage.moving
    for spring in motion.linkage.springs:
        if spring.turns:
            pull = _twist(spring, motion)
            pairs = ((spring.j, spring.at_j, still + 0j, -pull), (spring.i, spring.at_i, still + 0j, pull))
        else:
            i, j = motion.point(spring.i, spring.at_i), motion.point(spring.j, spring.at_j)
            length = np.abs(j.x - i.x)
            with np.errstate(invalid="ignore", divide="ignore"):
                along = np.where(length > 0, (j.x - i.x) / length, 0.0)
            longer = dot(along, j.v - i.v)
            pull = spring.preload + spring.rate * (length - spring.free) + spring.damping * longer
            pairs = ((spring.j, spring.at_j, -pull * along, still), (spring.i, spring.at_i, pull * along, still))
        for link, at, force, moment in pairs:
            if link in moving:
                name = spring.name if link == spring.j or spring.j not in moving else f"{spring.name}'"
                yield Applied(name, "load", link, at, force, moment, name)


def twisted(spring: Spring, motion: Motion) -> Real:
    """Angle by which a torsion spring is turned from its free angle, within half a turn (rad)."""
    turned = motion.poses[spring.j].z * np.conj(motion.poses[spring.i].z) * np.conj(unit(spring.free))
    found: Real = np.angle(turned)
    return found


def _twist(spring: Spring, motion: Motion) -> Real:
    """Moment of a torsion spring, N m, from the angle of j from i within half a turn of the free angle."""
    speed = motion.link(spring.j).omega - (motion.link(spring.i).omega if spring.i in motion.linkage.moving else 0.0)
    return spring.preload + spring.rate * twisted(spring, motion) + spring.damping * speed
