"""Bounds by rounding from what the stages found on their way: how far each group is from its dead positions.

A group whose margin is m gives places to u/m and velocities, accelerations and forces to u/m^2 (u: unit roundoff), and
hands its errors on to the groups after it. So at a position all numbers are known to

    bound = LOSS u (1 + |q|) product(1/m)^2

of the largest value of their kind that the mechanism has. It costs nothing, needs no wider float, and is wide: it says
10 to 13 digits where 15 are true. Near dead positions, where it says fewer than are printed, positions are judged by
accuracy.digits.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from tmm_cli.analysis.pipeline import Results
from tmm_cli.analysis.selection import mass_centres
from tmm_cli.double_double import EPS
from tmm_cli.groups.base import spread
from tmm_cli.quantities import (
    ACCELERATION,
    ANGLE,
    ANGULAR_ACCELERATION,
    ANGULAR_SPEED,
    FORCE,
    INERTIA,
    LENGTH,
    MOMENT,
    NUMBER,
    SPEED,
    Dimension,
)
from tmm_cli.tolerances import KNOWN_LAW, LIMIT_AGREES, ROUNDOFF
from tmm_cli.vectors import Real

LOSS = 128.0  # measured: of 50 sample problems and 500 random linkages the largest error is a third of such a bound
SHARP = 10.0  # times the margin at which a group is said to be near a dead position: from there on nothing is lost
AWAY = 4.0  # the same for a driver that is not where it was asked to be
FEWEST = 0.5e-6  # of the largest value: where so much is open, six figures are not sure


def relative(results: Results, blur: float = 0.0) -> Real:
    """How far numbers at each position may be from the truth, in shares of the largest of their kind.

    blur: how far places of the driver may be from those that were asked for (rad or m).
    """
    motion = results.motion
    assert motion is not None
    unit = np.full(np.shape(motion.q), ROUNDOFF)
    if motion.where is not None:  # computed in extended precision, and rounded
        unit[motion.where] = EPS
    away = blur if results.linkage.driver.kind == "turn" else blur / _longest(results)
    lost = growth(results)
    way = np.max([np.abs(drive.value) for drive in motion.drives.values()], axis=0)
    if motion.limits is not None:
        lost = np.where(motion.limits, LIMIT_AGREES / (LOSS * ROUNDOFF), lost)
    found: Real = LOSS * (ROUNDOFF + unit * (1 + way) * slenderness(results) * lost) + AWAY * away * lost
    return found if results.running is None else np.maximum(found, KNOWN_LAW)


def growth(results: Results) -> Real:
    """How much errors grow on their way through the groups, at each position."""
    motion = results.motion
    assert motion is not None
    lost = np.ones(np.shape(motion.q))
    for kernel, at in zip(motion.kernels, motion.placements, strict=True):
        with np.errstate(all="ignore"):
            lost = lost * np.maximum(SHARP * kernel.near / at.margin, 1.0) ** 2
    return lost


def slenderness(results: Results) -> float:
    """The size of the mechanism over its shortest link: errors of places turn that by so much more."""
    short = [spread(results.linkage, link) for link in results.linkage.moving]
    return _longest(results) / min((size for size in short if size > 0), default=1.0)


def sizes(results: Results) -> Mapping[Dimension, float]:
    """The largest value of each kind that the mechanism has, SI; of plain numbers that of transfer functions."""
    motion = results.motion
    assert motion is not None
    size = _longest(results)
    w = _most(rate.w for rate in motion.first.values())
    v = _most(rate.v for rate in motion.first.values()) + w * size
    e = _most(accel.e for accel in motion.second.values()) + w * w
    a = _most(accel.a for accel in motion.second.values()) + e * size
    rate, gain = _most([motion.rate]), _most([motion.acceleration])
    found = {
        LENGTH: max(size, v), ANGLE: np.pi, SPEED: v * rate, ANGULAR_SPEED: w * rate,
        ACCELERATION: a * rate**2 + v * gain, ANGULAR_ACCELERATION: e * rate**2 + w * gain, NUMBER: max(v, w, a, e),
    }  # fmt: skip
    if results.reactions is not None:
        applied = results.reactions.applied
        links = results.linkage.links.values()
        mass, inertia = _most(link.mass for link in links), _most(link.inertia for link in links)
        # a link that does not move has the errors of its forces all the same
        forces = max(found[ACCELERATION] * mass, _most(reaction.force for reaction in results.reactions.all))
        couples = max(found[ANGULAR_ACCELERATION] * inertia, _most(load.moment for load in applied))
        found[INERTIA] = mass * v**2 + inertia * w**2  # reduced to the driver
        found[FORCE] = max(forces, _most(load.force for load in applied)) + couples / size
        found[MOMENT] = found[FORCE] * found[LENGTH]
    return found


def _longest(results: Results) -> float:
    """How far points of the links, and what acts on them, are from one another and from the origin, m."""
    assert results.motion is not None
    linkage = results.linkage
    spreads = (spread(linkage, link) for link in linkage.links)
    acted_on = _most([*(at for __, at in mass_centres(linkage).values()), *(load.at for load in linkage.loads)])
    longest: float = max(*spreads, acted_on) + _most(pose.x for pose in results.motion.poses.values())
    return longest


def _most(values: object) -> float:
    """The largest size of arrays, nan left out."""
    found = [np.max(np.abs(v), where=np.isfinite(v), initial=0.0) for v in map(np.asarray, values)]  # type: ignore
    return float(max(found, default=0.0))
