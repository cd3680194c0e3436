"""Positions near a dead one are computed once more in double-doubles, with the data as they are written.

At a distance eps (rad) from a dead position the nearest double to a length of the file already changes velocities by
1e-16/eps of themselves, whatever the method; with 31 digits that is nothing. The results are rounded to float64 again;
a position is treated so or not by itself alone.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tmm_cli.groups.sequence import LawOfMotion
from tmm_cli.kinematics.motion import Motion, move, spliced
from tmm_cli.linkage import Linkage
from tmm_cli.vectors import Real


def near_dead(motion: Motion) -> Real:
    """Positions where a group is so near to a dead position that float64 blurs its motion, but not in it."""
    near = np.zeros(np.shape(motion.q), dtype=bool)
    for kernel, at in zip(motion.kernels, motion.placements, strict=True):
        near |= at.margin < kernel.blurred
    return near & motion.moving


def refined(motion: Motion, linkage: Linkage, q: Real, law: LawOfMotion, where: Real) -> Motion:
    """A motion with some of its positions taken from that of the same linkage with numbers in double-doubles.

    q: the driver's places there, in double-doubles. The assemblies are those of the motion's own groups.
    """
    closer = move(linkage, tuple(kernel.rebind(linkage) for kernel in motion.kernels), q, law)
    if not bool(np.all(closer.moving)):
        return motion
    return replace(spliced(motion, closer, where), finer=closer, where=where)
