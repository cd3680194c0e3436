"""RRR dyad: links a and b are hinged to each other at C, and to known links at A and B.

With ra = C - A and rb = C - B, every result is divided by det = ra x rb. Its magnitude is the distance AB times half
the common chord of the two circles on which C lies.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tmm_cli.mechanics.groups.group_solver import Dyad, HingeEnd
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
from tmm_cli.mechanics.numerics import ROUNDINGS, Real, Vector, dot, roundoff, squared_length


@dataclass(frozen=True)
class RRR(Dyad[HingeEnd, HingeEnd, HingeEnd]):
    """Solver of an RRR dyad by intersection of two circles. The sign selects on which side of AB C lies.

    Half the common chord of the circles is computed from a factored product (Heron): W. Kahan, Miscalculating area and
    angles of a needle-like triangle, 2014.
    """

    type = "RRR"

    def _arms(self, at: Placement) -> tuple[Vector, Vector]:
        a, b, c = self.parts
        return (c.there - a.here) * at.a.z, (c.here - b.here) * at.b.z

    def closed(self, poses: Poses, drives: DriverStates) -> Placement:
        a, b, c = self.parts
        A, B = a.place(poses), b.place(poses)
        arm_a, arm_b = c.there - a.here, c.here - b.here  # in each link's own axes
        la, lb = np.abs(arm_a), np.abs(arm_b)
        base = B - A
        d = np.abs(base)
        flip = lb < la
        r, R = np.minimum(la, lb), np.maximum(la, lb)
        reach, spare = _slacks(d, r, R)
        with np.errstate(divide="ignore", invalid="ignore"):
            m = np.maximum(reach, 0) * (d + (R - r)) / (2 * d)
            p = np.maximum(spare, 0) * (d + (R + r)) / (2 * d)
            h = self.sign * np.sqrt(m * p)
            x = (p - m) / 2
            # Relative to the centre of the smaller circle; from B the base and the side are reversed.
            small = np.where(flip, x - 1j * h, x + 1j * h) * np.where(flip, -base, base) / d
        ra = np.where(flip, small + base, small)
        rb = np.where(flip, small, small - base)
        za, zb = ra * (np.conj(arm_a) / (la * la)), rb * (np.conj(arm_b) / (lb * lb))
        residual = -np.minimum(reach, spare)
        slack = roundoff(d) * (ROUNDINGS * (la + lb) + 2 * (np.abs(A) + np.abs(B)))
        return Placement(
            (Pose(A - a.here * za, za), Pose(B - b.here * zb, zb)), d * h, np.abs(d * h) / (la * lb), residual, slack
        )

    def residual_rate(self, at: Placement, poses: Poses, rates: Rates, drives: DriverStates) -> Real:
        a, b, c = self.parts
        base = b.place(poses) - a.place(poses)
        d = np.abs(base)
        la, lb = np.abs(c.there - a.here), np.abs(c.here - b.here)
        reach, spare = _slacks(d, np.minimum(la, lb), np.maximum(la, lb))
        longer: Real = dot(base, b.velocity(poses, rates) - a.velocity(poses, rates)) / d
        return np.where(reach < spare, longer, -longer)

    def rates(self, at: Placement, poses: Poses, rates: Rates, drives: DriverStates) -> tuple[Rate, ...]:
        a, b, _ = self.parts
        ra, rb = self._arms(at)
        vA = a.velocity(poses, rates)
        vB = b.velocity(poses, rates)
        w = vB - vA
        wa, wb = dot(w, rb) / at.det, dot(w, ra) / at.det
        return Rate.through(vA, wa, a.here * at.a.z), Rate.through(vB, wb, b.here * at.b.z)

    def accelerations(
        self, at: Placement, poses: Poses, rates: Rates, accels: Accels, drives: DriverStates
    ) -> tuple[Accel, ...]:
        a, b, _ = self.parts
        la, lb = self.group.links
        ra, rb = self._arms(at)
        wa, wb = rates[la].w, rates[lb].w
        aA = a.acceleration(poses, rates, accels)
        aB = b.acceleration(poses, rates, accels)
        w = (aB - wb * wb * rb) - (aA - wa * wa * ra)
        ea, eb = dot(w, rb) / at.det, dot(w, ra) / at.det
        return Accel.through(aA, ea, wa, a.here * at.a.z), Accel.through(aB, eb, wb, b.here * at.b.z)

    def reactions(self, at: Placement, poses: Poses, applied: tuple[Wrench, ...]) -> GroupReactions:
        """Compute the reactions from moments of each link about its external hinge, and from force polygons.

        The moments give the reaction at C, the force polygon of each link its external reaction. The tangential
        component of the latter follows from moments about C alone; the normal component is the remainder.
        """
        on_a, on_b = applied
        a, b, c = self.parts
        ra, rb = self._arms(at)
        t_a, t_b = on_a.about(a.here * at.a.z), -on_b.about(b.here * at.b.z)
        inner = (t_a * rb - t_b * ra) / at.det  # ra x inner = t_a, rb x inner = t_b
        RA, RB = inner - on_a.force, -(inner + on_b.force)
        tau_a = 1j * ra * (on_a.about(c.there * at.a.z) / squared_length(c.there - a.here))
        tau_b = 1j * rb * (on_b.about(c.here * at.b.z) / squared_length(c.here - b.here))
        return GroupReactions(
            (
                PairReaction(RA, tangential=tau_a, normal=RA - tau_a),
                PairReaction(RB, tangential=tau_b, normal=RB - tau_b),
            ),
            (PairReaction(inner),),
        )


def _slacks(d: Real, r: Real, R: Real) -> tuple[Real, Real]:
    """Return R + r - d and d - (R - r) for circles of radii R and r whose centres are at the distance d.

    The circles intersect if both are positive. They are computed with little rounding, by subtracting nearly equal
    numbers first.
    """
    with_base = 2 * r <= R
    t = d - R
    return np.where(with_base, r - t, (R + r) - d), np.where(with_base, r + t, d - (R - r))
