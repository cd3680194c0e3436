"""The textbook multibody way in 60 digits: Newton on all constraints in absolute coordinates, Lagrange multipliers.

It knows no Assur groups, so nothing that is wrong in them can hide here. Derivatives by differences, with steps far
below what float64 can see.
"""

from __future__ import annotations

import mpmath as mp
import numpy as np

from tmm_cli.linkage import FRAME

DIGITS = 60
STEP, BEND = mp.mpf(10) ** -25, mp.mpf(10) ** -15  # of first and second differences


class Multibody:
    """One linkage; `at(k)` solves position k of a motion, started from what was found in float64."""

    def __init__(self, it, structure, motion):
        mp.mp.dps = DIGITS
        self.it, self.pairs, self.motion = it, structure.pairs, motion
        self.at_row = {name: 3 * i for i, name in enumerate(it.moving)}
        self.size = 3 * len(it.moving)

    def pose(self, X, name):
        if name == FRAME:
            return mp.mpc(0), mp.mpc(1)
        i = self.at_row[name]
        return mp.mpc(X[i], X[i + 1]), mp.expj(X[i + 2])

    def constraints(self, X, q):
        """Two rows a pair, the driver last; zero when closed (angles as sines, which do not mind full turns)."""
        rows = []
        for pair in self.pairs:
            (xi, zi), (xj, zj) = self.pose(X, pair.i), self.pose(X, pair.j)
            if pair.kind == "R":
                gap = xi + self.it.local(pair.i, pair.point) * zi - xj - self.it.local(pair.j, pair.point) * zj
                rows += [gap.real, gap.imag]
            else:
                slide = pair.slide
                off = xj + slide.at * zj - xi - slide.through * zi
                along = zi * mp.expj(slide.direction)
                rows += [(zj * mp.conj(zi) * mp.expj(-slide.turned)).imag, (mp.conj(along) * off).imag]
        turned = self.pose(X, self.it.driver.link)[1]
        return mp.matrix([*rows, (turned * mp.expj(-q)).imag])

    def jacobian(self, X, q):
        J = mp.matrix(self.size, self.size)
        for j in range(self.size):
            more, less = X.copy(), X.copy()
            more[j] += STEP
            less[j] -= STEP
            J[:, j] = (self.constraints(more, q) - self.constraints(less, q)) / (2 * STEP)
        return J

    def at(self, k):
        """Places, velocities, accelerations and multipliers at position k."""
        q, rate, acceleration = (
            mp.mpf(float(v[k])) for v in (self.motion.q, self.motion.rate, self.motion.acceleration)
        )
        X = mp.matrix(self.size, 1)
        for name, i in self.at_row.items():
            pose = self.motion.poses[name]
            X[i], X[i + 1], X[i + 2] = (float(v[k]) for v in (pose.x.real, pose.x.imag, np.angle(pose.z)))
        for _ in range(5):
            X = X - mp.lu_solve(self.jacobian(X, q), self.constraints(X, q))
        J = self.jacobian(X, q)
        drive = mp.matrix(self.size, 1)
        drive[self.size - 1] = 1
        V = mp.lu_solve(J, drive * rate)
        bend = self.constraints(X + BEND * V, q) - 2 * self.constraints(X, q) + self.constraints(X - BEND * V, q)
        A = mp.lu_solve(J, drive * acceleration - bend / BEND**2)
        return X, V, A, mp.lu_solve(J.T, self.missing(X, V, A))

    def missing(self, X, V, A):
        """What the constraints must supply on every coordinate: inertia less weights and loads."""
        Q = mp.matrix(self.size, 1)

        def add(name, force, arm, moment):
            i = self.at_row[name]
            Q[i] += force.real
            Q[i + 1] += force.imag
            Q[i + 2] += moment + (mp.conj(arm) * force).imag

        for name, i in self.at_row.items():
            link, z = self.it.links[name], self.pose(X, name)[1]
            arm = link.centre * z
            a = mp.mpc(A[i], A[i + 1]) + (1j * A[i + 2] - V[i + 2] ** 2) * arm
            add(name, link.mass * (a - self.it.gravity), arm, link.inertia * A[i + 2])
        for load in self.it.loads:
            z = self.pose(X, load.link)[1]
            add(load.link, -load.force * (z if load.follows else 1), load.at * z, -mp.mpf(load.moment))
        return Q
