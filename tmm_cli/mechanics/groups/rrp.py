"""RRP dyad: link a is hinged to a known link at A and to link b at C; b slides along a guide of a known link.

With ra = C - A and the unit vector u along the guide, every result is divided by det = u . ra.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tmm_cli.mechanics.groups.group_solver import Dyad, HingeEnd, SliderEnd, guide_line
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
from tmm_cli.mechanics.numerics import ROUNDINGS, Real, Vector, cross, dot, roundoff, squared_length, unit


@dataclass(frozen=True)
class RRP(Dyad[HingeEnd, SliderEnd, HingeEnd]):
    """Solver of an RRP dyad: C is an intersection of a circle about A and a line parallel to the guide.

    The sign selects on which side of the perpendicular from A to that line C lies.
    """

    type = "RRP"

    def closed(self, poses: Poses, drives: DriverStates) -> Placement:
        a, b, c = self.parts
        A = a.place(poses)
        Q, u = guide_line(b, poses)
        zb = poses[b.known].z * unit(b.turned)
        arm = c.there - a.here
        la = np.abs(arm)
        start = Q + (c.here - b.here) * zb  # C moves on the parallel line through this point
        off = A - start
        y, run = cross(u, off), dot(u, off)
        half = self.sign * np.sqrt(np.maximum((la - y) * (la + y), 0))
        ra = u * (half - 1j * y)
        za = ra * (np.conj(arm) / (la * la))
        C = start + u * (run + half)
        residual = np.abs(y) - la
        slack = roundoff(y) * (ROUNDINGS * la + 2 * (np.abs(A) + np.abs(start)))
        return Placement(
            (Pose(A - a.here * za, za), Pose(C - c.here * zb, zb)), half, np.abs(half) / la, residual, slack
        )

    def _arms(self, at: Placement, poses: Poses) -> tuple[Vector, Vector, Vector]:
        """Return the vector ra, the unit vector u, and the vector to C from the origin of the link with the guide."""
        a, b, c = self.parts
        _, u = guide_line(b, poses)
        return (c.there - a.here) * at.a.z, u, at.b.at(c.here) - poses[b.known].x

    def residual_rate(self, at: Placement, poses: Poses, rates: Rates, drives: DriverStates) -> Real:
        a, b, c = self.parts
        Q, u = guide_line(b, poses)
        A = a.place(poses)
        start = Q + (c.here - b.here) * poses[b.known].z * unit(b.turned)
        away: Real = cross(u, a.velocity(poses, rates) - rates[b.known].at(A - poses[b.known].x))
        rate: Real = np.sign(cross(u, A - start)) * away
        return rate

    def rates(self, at: Placement, poses: Poses, rates: Rates, drives: DriverStates) -> tuple[Rate, ...]:
        a, b, c = self.parts
        ra, u, onto = self._arms(at, poses)
        vA = a.velocity(poses, rates)
        carried = rates[b.known].at(onto)
        w = carried - vA
        wa = cross(u, w) / at.det
        vC = carried - u * (dot(w, ra) / at.det)
        wb = rates[b.known].w
        return Rate.through(vA, wa, a.here * at.a.z), Rate.through(vC, wb, c.here * at.b.z)

    def accelerations(
        self, at: Placement, poses: Poses, rates: Rates, accels: Accels, drives: DriverStates
    ) -> tuple[Accel, ...]:
        a, b, c = self.parts
        ra, u, onto = self._arms(at, poses)
        wa, wb = rates[self.group.links[0]].w, rates[b.known].w
        vC = rates[self.group.links[1]].at(c.here * at.b.z)
        sliding = dot(u, vC - rates[b.known].at(onto))
        aA = a.acceleration(poses, rates, accels)
        carried = accels[b.known].at(onto, wb) + 2j * wb * sliding * u
        w = carried - (aA - wa * wa * ra)
        ea = cross(u, w) / at.det
        aC = carried - u * (dot(w, ra) / at.det)
        eb = accels[b.known].e
        return Accel.through(aA, ea, wa, a.here * at.a.z), Accel.through(aC, eb, wb, c.here * at.b.z)

    def reactions(self, at: Placement, poses: Poses, applied: tuple[Wrench, ...]) -> GroupReactions:
        """Compute the reactions from moments of link a about C, the force polygon of the dyad, and moments of link b
        about C.
        """
        on_a, on_b = applied
        a, b, c = self.parts
        ra, u, _ = self._arms(at, poses)
        tau = 1j * ra * (on_a.about(c.there * at.a.z) / squared_length(c.there - a.here))
        rest = on_a.force + on_b.force + tau
        normal = ra * (-dot(rest, u) / at.det)
        guide = 1j * u * (-dot(rest + normal, 1j * u))
        inner = -(guide + on_b.force)
        arm_c = c.here * at.b.z
        couple = -on_b.about(arm_c) - cross(b.runner_arm(at.b, poses) - arm_c, guide)
        return GroupReactions(
            (PairReaction(tau + normal, tangential=tau, normal=normal), PairReaction(guide, couple)),
            (PairReaction(inner),),
        )
