"""PRP dyad: two links slide along guides of known links and are hinged to each other at C.

C is the intersection of two lines. Every result is divided by det = u1 x u2, the sine of the angle between the guides.
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
    parallel_residual_rate,
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
class PRP(Dyad[SliderEnd, SliderEnd, HingeEnd]):
    """Solver of a PRP dyad by intersection of two lines. It has one assembly only."""

    type = "PRP"
    assemblies = 1

    def closed(self, poses: Poses, drives: DriverStates) -> Placement:
        a, b, c = self.parts
        (P, u), (Q, v) = guide_line(a, poses), guide_line(b, poses)
        za, zb = poses[a.known].z * unit(a.turned), poses[b.known].z * unit(b.turned)
        C, det = intersect_lines(P + (c.there - a.here) * za, u, Q + (c.here - b.here) * zb, v)
        residual, slack = parallel_residual(det)
        return Placement((Pose(C - c.there * za, za), Pose(C - c.here * zb, zb)), det, np.abs(det), residual, slack)

    def _frame(self, at: Placement, poses: Poses) -> tuple[Vector, Vector, Vector]:
        """Return the position of C and the unit vectors along both guides."""
        a, b, c = self.parts
        return at.a.at(c.there), guide_line(a, poses)[1], guide_line(b, poses)[1]

    def residual_rate(self, at: Placement, poses: Poses, rates: Rates, drives: DriverStates) -> Real:
        a, b, _ = self.parts
        u, v = guide_line(a, poses)[1], guide_line(b, poses)[1]
        return parallel_residual_rate(u, v, rates[a.known].w, rates[b.known].w)

    def rates(self, at: Placement, poses: Poses, rates: Rates, drives: DriverStates) -> tuple[Rate, ...]:
        a, b, c = self.parts
        C, u, v = self._frame(at, poses)
        ra, rb = rates[a.known], rates[b.known]
        vC = common_point_rate(ra.at(C - poses[a.known].x), u, rb.at(C - poses[b.known].x), v, at.det)
        return Rate.through(vC, ra.w, c.there * at.a.z), Rate.through(vC, rb.w, c.here * at.b.z)

    def accelerations(
        self, at: Placement, poses: Poses, rates: Rates, accels: Accels, drives: DriverStates
    ) -> tuple[Accel, ...]:
        a, b, c = self.parts
        C, u, v = self._frame(at, poses)
        vC = rates[self.group.links[0]].at(c.there * at.a.z)
        by_a = guide_acceleration(C, vC, (poses[a.known].x, u, rates[a.known], accels[a.known]))
        by_b = guide_acceleration(C, vC, (poses[b.known].x, v, rates[b.known], accels[b.known]))
        aC = common_point_rate(by_a, u, by_b, v, at.det)
        (wa, ea), (wb, eb) = ((rates[k].w, accels[k].e) for k in (a.known, b.known))
        return Accel.through(aC, ea, wa, c.there * at.a.z), Accel.through(aC, eb, wb, c.here * at.b.z)

    def reactions(self, at: Placement, poses: Poses, applied: tuple[Wrench, ...]) -> GroupReactions:
        """Compute the guide forces from the force polygon, and their couples from the moments of each link about C."""
        on_a, on_b = applied
        a, b, c = self.parts
        _, u, v = self._frame(at, poses)
        by_a, by_b = split_across_guides(on_a.force + on_b.force, u, v, at.det)
        arm_a, arm_b = c.there * at.a.z, c.here * at.b.z
        couple_a = -on_a.about(arm_a) - cross(a.runner_arm(at.a, poses) - arm_a, by_a)
        couple_b = -on_b.about(arm_b) - cross(b.runner_arm(at.b, poses) - arm_b, by_b)
        return GroupReactions(
            (PairReaction(by_a, couple_a), PairReaction(by_b, couple_b)), (PairReaction(-(by_b + on_b.force)),)
        )
