"""RPP dyad: link a is hinged to a known link at A; link b slides along a guide of a known link and along a.

The angle of the known link determines the angles of a and b, and the position of a then follows from A. Link b is at
the intersection of the two guides, so every result is divided by det, the sine of the angle between them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tmm_cli.mechanics.groups.group_solver import (
    Dyad,
    HingeEnd,
    SliderEnd,
    common_point_rate,
    guide_acceleration,
    guide_line,
    intersect_lines,
    parallel_residual,
    split_across_guides,
)
from tmm_cli.mechanics.groups.state import (
    Accel,
    Accels,
    DriverStates,
    GroupReactions,
    PairReaction,
    Placement,
    Pose,
    Poses,
    Rate,
    Rates,
    Wrench,
)
from tmm_cli.mechanics.numerics import Real, Vector, cross, unit


@dataclass(frozen=True)
class RPP(Dyad[HingeEnd, SliderEnd, SliderEnd]):
    """Solver of an RPP dyad by intersection of two lines. It has one assembly only."""

    type = "RPP"
    assemblies = 1

    def closed(self, poses: Poses, drives: DriverStates) -> Placement:
        a, b, run = self.parts
        Q, v = guide_line(b, poses)
        zb = poses[b.known].z * unit(b.turned)
        za = zb * unit(-run.turned)
        A = a.place(poses)
        pose_a = Pose(A - a.here * za, za)
        u = za * unit(run.direction)
        # the origin of b lies on both guides
        origin, det = intersect_lines(pose_a.at(run.there) - run.here * zb, u, Q - b.here * zb, v)
        residual, slack = parallel_residual(det)
        return Placement((pose_a, Pose(origin, zb)), det, np.abs(det), residual, slack)

    def _frame(self, at: Placement, poses: Poses) -> tuple[Vector, Vector]:
        """Return the unit vectors along the guide on link a and along the guide on the known link."""
        _, b, run = self.parts
        return at.a.z * unit(run.direction), guide_line(b, poses)[1]

    def residual_rate(self, at: Placement, poses: Poses, rates: Rates, drives: DriverStates) -> Real:
        return np.zeros(np.shape(at.det))  # both guides rotate with the known link: their angle is constant

    def rates(self, at: Placement, poses: Poses, rates: Rates, drives: DriverStates) -> tuple[Rate, ...]:
        a, b, _ = self.parts
        u, v = self._frame(at, poses)
        w = rates[b.known].w
        vA = a.velocity(poses, rates)
        rate_a = Rate.through(vA, w, a.here * at.a.z)
        by_a = rate_a.at(at.b.x - at.a.x)
        by_g = rates[b.known].at(at.b.x - poses[b.known].x)
        return rate_a, Rate(common_point_rate(by_a, u, by_g, v, at.det), w)

    def accelerations(
        self, at: Placement, poses: Poses, rates: Rates, accels: Accels, drives: DriverStates
    ) -> tuple[Accel, ...]:
        a, b, _ = self.parts
        u, v = self._frame(at, poses)
        w, e = rates[b.known].w, accels[b.known].e
        aA = a.acceleration(poses, rates, accels)
        accel_a = Accel.through(aA, e, w, a.here * at.a.z)
        rate_a, rate_b = (rates[link] for link in self.group.links)
        by_a = guide_acceleration(at.b.x, rate_b.v, (at.a.x, u, rate_a, accel_a))
        by_g = guide_acceleration(at.b.x, rate_b.v, (poses[b.known].x, v, rates[b.known], accels[b.known]))
        return accel_a, Accel(common_point_rate(by_a, u, by_g, v, at.det), e)

    def reactions(self, at: Placement, poses: Poses, applied: tuple[Wrench, ...]) -> GroupReactions:
        """Compute the reactions link by link.

        The force polygon of b gives both guide forces, the force polygon of a then gives the reaction at A. Moments of
        a about A, then moments of b, give the couples.
        """
        on_a, on_b = applied
        a, b, run = self.parts
        u, v = self._frame(at, poses)
        inner, guide = split_across_guides(on_b.force, u, v, at.det)  # on b, from a and from the known link
        RA = inner - on_a.force
        # on a act the opposite force and couple, both at the sliding point
        arm_a = a.here * at.a.z
        on_own = run.there * at.a.z if not run.runs_here else at.b.at(run.here) - at.a.x
        couple = on_a.about(arm_a) - cross(on_own - arm_a, inner)
        arm = run.runner_arm(at.b, {run.known: at.a})
        moment = on_b.about(arm) + couple
        reaction = b.runner_arm(at.b, poses) - arm
        return GroupReactions(
            (PairReaction(RA), PairReaction(guide, -moment - cross(reaction, guide))), (PairReaction(inner, couple),)
        )
