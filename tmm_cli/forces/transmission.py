"""The part of the driving force that moves a driven link: Q = P cos(pressure angle)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tmm_cli.forces.plan import Reactions
from tmm_cli.kinematics.motion import Motion
from tmm_cli.kinematics.pressure import Lead, followers
from tmm_cli.vectors import Real, dot, unit


@dataclass(frozen=True)
class TransmittedForce:
    """The reaction that drives a link and its component along the velocity of its point, both (positions,), N.

    group, link, pair: names. driving: size P of the reaction in the pair. useful: size of its component Q along the
    velocity; without weights, inertia and friction Q = P cos(pressure angle).
    """

    group: str
    link: str
    pair: str
    driving: Real
    useful: Real


def find_transmitted_forces(motion: Motion, reactions: Reactions) -> tuple[TransmittedForce, ...]:
    """Compute P and Q of every link that is driven in one pair.

    The direction of the velocity is that of a rotation about the pivot that holds the link, or of its guide, so that it
    is there where the link rests, too.
    """
    leads = [(kernel.group, lead) for kernel in motion.kernels for lead in followers(kernel.group)]
    return tuple(_transmitted(motion, reactions, group.title, lead) for group, lead in leads if len(lead[2]) == 1)


def _transmitted(motion: Motion, reactions: Reactions, group: str, lead: Lead) -> TransmittedForce:
    link, outer, (pair,) = lead
    reaction = reactions.of(pair.name)
    force = reaction.onto(link)
    if outer.slide is not None:
        along = motion.poses[outer.slide.carrier].z * unit(outer.slide.direction)
        work = dot(force, along)
    else:
        radius = reaction.at - motion.poses[link].at(motion.linkage.local(link, outer.point))
        couple = 0.0 if reaction.couple is None else reaction.couple * (1 if reaction.on == link else -1)
        with np.errstate(all="ignore"):  # a pair on the pivot drives by its couple alone, at no radius
            work = (dot(force, 1j * radius) + couple) / np.abs(radius)
    return TransmittedForce(group, link, pair.name, np.abs(force), np.abs(work))
