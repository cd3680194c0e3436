"""Third derivatives of the motion of links: jerk of points, and the derivative of the angular acceleration.

The accelerations of each group are evaluated in dual numbers. The slopes of the input are known: velocities are the
slopes of poses, accelerations those of velocities. The slopes of the resulting accelerations are the third derivatives.
This holds for groups of every class.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from tmm_cli.mechanics.groups import (
    Accel,
    ClosedFormSolver,
    DriverStates,
    GroupSolver,
    LinkStates,
    Placement,
    Pose,
    Poses,
    Rate,
    WrappedSolver,
    driven_state,
    frame_state,
)
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.numerics import Real, Vector, split_dual, with_slope


@dataclass(frozen=True)
class ThirdDerivative:
    """Third derivatives of the pose of a link with respect to a parameter (time or the driver coordinate).

    Attributes:
        j: third derivative of the position of its origin (m per cubed unit of the parameter).
        i: third derivative of its angle (rad per cubed unit of the parameter).
    """

    j: Vector
    i: Real

    def at(self, arm: Vector, rate: Rate, accel: Accel) -> Vector:
        """Return the third derivative of the position of a point of the link.

        Args:
            arm: vector from the origin of the link to the point (m).
            rate, accel: first and second derivatives of the pose of the link.
        """
        w = rate.w
        third: Vector = self.j + (1j * (self.i - w * w * w) - 3 * w * accel.e) * arm
        return third


def third_derivatives(
    states: LinkStates, rates: Mapping[str, Rate], accels: Mapping[str, Accel], drives: DriverStates
) -> dict[str, ThirdDerivative]:
    """Compute the third derivatives of the poses of all links, by name of the link.

    Args:
        states: poses of the links and placements of the groups.
        rates, accels: first and second derivatives of the poses with respect to a parameter (time or the driver
            coordinate), by name of the link.
        drives: coordinates of the drivers and their derivatives with respect to this parameter, in dual numbers.
    """
    linkage = states.linkage
    poses = {link: _dual_pose(pose, rates[link]) for link, pose in states.poses.items()}
    velocities = {
        link: Rate(with_slope(r.v, accels[link].a), with_slope(r.w, accels[link].e)) for link, r in rates.items()
    }
    known: dict[str, Accel] = {FRAME: frame_state(states.q)[2]}
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        for driver in linkage.cranks:
            known[driver.link] = driven_state(linkage, driver, drives[driver.link])[2]
        for kernel, at in zip(states.kernels, states.placements, strict=True):
            placement = _dual_placement(kernel, at, states.q, poses, drives)
            own = kernel.accelerations(placement, poses, velocities, known, drives)
            known.update(zip(kernel.group.links, own, strict=True))
    return {link: ThirdDerivative(split_dual(accel.a)[1], split_dual(accel.e)[1]) for link, accel in known.items()}


def _dual_pose(pose: Pose, rate: Rate) -> Pose:
    unwrapped = None if pose.unwrapped is None else with_slope(pose.unwrapped, rate.w)
    return Pose(with_slope(pose.x, rate.v), with_slope(pose.z, 1j * rate.w * pose.z), unwrapped)


def _dual_placement(kernel: GroupSolver, at: Placement, q: Real, poses: Poses, drives: DriverStates) -> Placement:
    """Return the placement of a group in dual numbers, whose slopes are the derivatives of poses and determinant."""
    while isinstance(kernel, WrappedSolver):
        kernel = kernel.inner
    if isinstance(kernel, ClosedFormSolver):
        return replace(kernel, sign=kernel.sign * kernel.side(q)).closed(poses, drives)
    return replace(at, poses=tuple(poses[link] for link in kernel.group.links))
