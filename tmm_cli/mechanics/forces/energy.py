"""Power balance, kinetic energy, and the mechanism reduced to its driver.

With q the coordinate of the first driver, the kinetic energy is T = J q'^2 / 2, with the reduced inertia J
= sum(m |dx/dq|^2 + I (dphi/dq)^2), and the reduced moment of the loads is M = sum(F dx/dq + M dphi/dq). The
drivers must supply J q'' + J_q q'^2 / 2 - M. I. I. Artobolevsky, Theory of Mechanisms and Machines, ch. 15.
The Zhukovsky lever takes the computed accelerations, whereas this balance takes the derivative of the
reduced inertia; so it also checks the accelerations.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tmm_cli.mechanics.forces.loads import AppliedLoad
from tmm_cli.mechanics.kinematics import Motion
from tmm_cli.mechanics.numerics import Real, dot, squared_length


@dataclass(frozen=True)
class Energy:
    """Kinetic energy and powers of the mechanism at every position, and the mechanism reduced to its first driver.

    Attributes:
        inertia: reduced inertia, kg m2 (kg if the driver is a cylinder).
        slope: derivative of the reduced inertia with respect to the driver coordinate.
        moment: reduced moment (N m) or force (N) of all loads except inertia.
        kinetic: kinetic energy, J.
        rate: time derivative of the kinetic energy, W.
        drivers, weights, loads, friction: powers of these forces, W.
        dampers: power of the elements that only dissipate energy, W, which is a part of `loads`; None if there are
            none.
        balance: sum of all powers minus `rate`, divided by the largest of these powers. It differs from zero only by
            rounding errors.
    """

    inertia: Real
    slope: Real
    moment: Real
    kinetic: Real
    rate: Real
    drivers: Real
    weights: Real
    loads: Real
    friction: Real
    dampers: Real | None
    balance: Real


def compute_energy(motion: Motion, loads: tuple[AppliedLoad, ...], drivers: Real) -> Energy:
    """Compute the reduced inertia, the kinetic energy and the powers at every position.

    Args:
        motion: solved motion of the mechanism.
        loads: all loads on the links; inertia loads are skipped.
        drivers: power of all drivers divided by the speed of the first one (N m or N), shape (positions,).
    """
    still = np.zeros(np.shape(motion.q))
    inertia, slope, dissipated = still, still, still
    for link_inertia, link_slope in reduced_inertias(motion).values():
        inertia, slope = inertia + link_inertia, slope + link_slope
    powers = dict.fromkeys(("weight", "load", "friction"), still)
    for load in loads:
        if load.kind != "inertia":
            reduced = reduced_moment(motion, load)
            powers[load.kind] = powers[load.kind] + reduced
            dissipated = dissipated + reduced if load.dissipates else dissipated
    moment = powers["weight"] + powers["load"] + powers["friction"]
    rate = motion.rate
    change = (inertia * motion.acceleration + slope * rate**2 / 2) * rate
    parts = [drivers * rate, *(work * rate for work in powers.values())]
    with np.errstate(invalid="ignore", divide="ignore"):
        scale = max(np.nanmax(np.abs(power), initial=0.0) for power in (*parts, change))
        balance = (sum(parts) - change) / scale if scale > 0 else still
    return Energy(
        inertia=inertia,
        slope=slope,
        moment=moment,
        kinetic=inertia * rate**2 / 2,
        rate=change,
        drivers=parts[0],
        weights=parts[1],
        loads=parts[2],
        friction=parts[3],
        dampers=dissipated * rate if any(e.dissipates for e in motion.linkage.elements) else None,
        balance=balance,
    )


def reduced_inertias(motion: Motion) -> dict[str, tuple[Real, Real]]:
    """Return the reduced inertia of each moving link and its derivative with respect to the driver coordinate.

    The keys are the names of the links; both arrays have the shape (positions,).
    """
    inertias = {}
    for name in motion.linkage.moving:
        link = motion.linkage.links[name]
        centre, rotation = motion.centre(name), motion.link(name)
        slope = 2 * (link.mass * dot(centre.first, centre.second) + link.inertia * rotation.first * rotation.second)
        inertias[name] = link.mass * squared_length(centre.first) + link.inertia * rotation.first**2, slope
    return inertias


def reduced_moment(motion: Motion, load: AppliedLoad) -> Real:
    """Compute the reduced moment (N m) or force (N) of a load: its power divided by the speed of the first driver."""
    moment: Real = dot(load.force, motion.point(load.link, load.at).first) + load.moment * motion.link(load.link).first
    return moment
