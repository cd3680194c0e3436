"""RPR dyad: link a is hinged to a known link at A, link b at B, and they slide along each other.

Both links rotate together. With the unit vector u along the guide and B - A = (x + i h) u, the offset h is constant and
x varies. Every result is divided by det = x. The dyad is dead when the sliding block reaches the pivot of its slotted
link (x = 0).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tmm_cli.mechanics.groups.group_solver import Dyad, HingeEnd, SliderEnd
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
from tmm_cli.mechanics.numerics import ROUNDINGS, Real, Vector, cross, dot, roundoff, unit


@dataclass(frozen=True)
class RPR(Dyad[HingeEnd, HingeEnd, SliderEnd]):
    """Solver of an RPR dyad: a right triangle on AB. The sign of x selects the assembly."""

    type = "RPR"

    def _offset(self) -> Real:
        """Return the offset h (m): distance of B from the line through A along the guide, positive to the left."""
        a, b, run = self.parts
        turned = unit(run.turned)
        # In a's axes, B - A = (there - a.here) + s e^(i direction) - (run.here - b.here) e^(i turned).
        fixed = (run.there - a.here) - (run.here - b.here) * turned
        offset: Real = cross(unit(run.direction), fixed)
        return offset

    def closed(self, poses: Poses, drives: DriverStates) -> Placement:
        a, b, run = self.parts
        A, B = a.place(poses), b.place(poses)
        base = B - A
        d, h = np.abs(base), self._offset()
        x = self.sign * np.sqrt(np.maximum((d - h) * (d + h), 0))
        full = x + 1j * h
        # base / (x + i h), and |x + i h| = d
        with np.errstate(divide="ignore", invalid="ignore"):
            u = base * np.conj(full) / (d * d)
        za = u * np.conj(unit(run.direction))
        zb = za * unit(run.turned)
        slack = roundoff(d) * (ROUNDINGS * np.maximum(d, np.abs(h)) + 2 * (np.abs(A) + np.abs(B)))
        size = np.maximum(d, self.size)
        with np.errstate(divide="ignore", invalid="ignore"):
            margin = np.abs(x) / size
        return Placement((Pose(A - a.here * za, za), Pose(B - b.here * zb, zb)), x, margin, np.abs(h) - d, slack)

    def _frame(self, at: Placement) -> tuple[Vector, Real]:
        _, _, run = self.parts
        return at.a.z * unit(run.direction), self._offset()

    def residual_rate(self, at: Placement, poses: Poses, rates: Rates, drives: DriverStates) -> Real:
        a, b, _ = self.parts
        base = b.place(poses) - a.place(poses)
        shorter: Real = -dot(base, b.velocity(poses, rates) - a.velocity(poses, rates)) / np.abs(base)
        return shorter

    def rates(self, at: Placement, poses: Poses, rates: Rates, drives: DriverStates) -> tuple[Rate, ...]:
        a, b, _ = self.parts
        u, _ = self._frame(at)
        vA = a.velocity(poses, rates)
        vB = b.velocity(poses, rates)
        w = cross(u, vB - vA) / at.det
        return Rate.through(vA, w, a.here * at.a.z), Rate.through(vB, w, b.here * at.b.z)

    def accelerations(
        self, at: Placement, poses: Poses, rates: Rates, accels: Accels, drives: DriverStates
    ) -> tuple[Accel, ...]:
        a, b, _ = self.parts
        u, h = self._frame(at)
        w = rates[self.group.links[0]].w
        sliding = dot(u, b.velocity(poses, rates) - a.velocity(poses, rates)) + w * h
        aA, aB = a.acceleration(poses, rates, accels), b.acceleration(poses, rates, accels)
        # aB - aA = (i e - w^2) (x + i h) u + 2 i w sliding u + (sliding)' u
        e = (cross(u, aB - aA) + w * w * h - 2 * w * sliding) / at.det
        return Accel.through(aA, e, w, a.here * at.a.z), Accel.through(aB, e, w, b.here * at.b.z)

    def reactions(self, at: Placement, poses: Poses, applied: tuple[Wrench, ...]) -> GroupReactions:
        """Compute the reactions from forces on b along the guide, moments of the dyad about A, and force polygons."""
        on_a, on_b = applied
        a, b, run = self.parts
        u, h = self._frame(at)
        A = at.a.at(a.here)
        push = -dot(on_b.force, u)
        across = (-(on_a.about(a.here * at.a.z) + on_b.about(A - at.b.x)) + h * push) / at.det
        tau, normal = 1j * u * across, u * push
        RB = tau + normal
        guide = -1j * u * dot(RB + on_b.force, 1j * u)  # on b from a
        RA = guide - on_a.force
        # on b; from moments of the runner, whose arm is constant and often zero, so that no large terms cancel
        if run.runs_here:
            couple = -on_b.about(b.here * at.b.z) - cross((run.here - b.here) * at.b.z, guide)
        else:
            couple = on_a.about(a.here * at.a.z) - cross((run.there - a.here) * at.a.z, guide)
        push_a = u * dot(RA, u)
        return GroupReactions(
            (PairReaction(RA, tangential=RA - push_a, normal=push_a), PairReaction(RB, tangential=tau, normal=normal)),
            (PairReaction(guide, couple),),
        )
