"""The textbook multibody way: three coordinates a link, all constraints at once, reactions as Lagrange multipliers.

E. J. Haug, Computer Aided Kinematics and Dynamics of Mechanical Systems, ch. 3, 4 and 8; A. A. Shabana, Dynamics of
Multibody Systems, ch. 3. The driver is a constraint too, so the Jacobian is square and its multiplier is what balances.
It knows no groups. Rows are in metres and radians, as in the books.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tmm_cli.bench.methods.case import Answers, Case, answers
from tmm_cli.bench.methods.loops import Rows, by_links, close, follow
from tmm_cli.mechanics.groups import Accel, Pose, Rate, drives_at, frame_state
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.numerics import Real, solve, unit

TOLERANCE = 0.0  # until gaps are rounding


@dataclass(frozen=True)
class Body:
    """Coordinates x, y, angle of every moving link in their order; rows: two a pair, the driver's last."""

    case: Case

    @cached_property
    def rows(self) -> Rows:
        return Rows(self.case.linkage, self.case.structure.pairs, driven=True)

    @cached_property
    def first(self) -> dict[str, int]:
        """Where the three coordinates of each link begin."""
        return {name: 3 * k for k, name in enumerate(self.case.linkage.moving)}

    def poses(self, X: Real) -> dict[str, Pose]:
        """Poses of all links, the frame's too."""
        found = {FRAME: frame_state(X[:, 0])[0]}
        for name, k in self.first.items():
            found[name] = Pose(X[:, k] + 1j * X[:, k + 1], unit(X[:, k + 2]), X[:, k + 2])
        return found

    def sketched(self, poses: dict[str, Pose], q: Real) -> Real:
        return by_links(self.case.linkage, {name: (poses[name].x, poses[name].turned) for name in self.first})

    def residuals(self, X: Real, q: Real) -> Real:
        return self.rows.residuals(self.poses(X), drives_at(self.case.linkage, q))

    def matrix(self, X: Real, q: Real) -> Real:
        return self.rows.matrix(self.poses(X))


def prepare(case: Case) -> Callable[[Real], Answers]:
    """One linear system a position and order: J^T for the forces, J for all else."""
    body = Body(case)
    nodes = follow(case, body)

    def at(q: Real) -> Answers:
        X = close(body, nodes.near(q), q, TOLERANCE)
        J, poses = body.matrix(X, q), body.poses(X)
        asked = np.zeros_like(X)
        asked[:, -1] = 1.0
        _, rest, still = frame_state(q)
        first, second = {FRAME: rest}, {FRAME: still}
        V = solve(J, asked)
        for name, k in body.first.items():
            first[name] = Rate(V[:, k] + 1j * V[:, k + 1], V[:, k + 2])
        A = solve(J, -body.rows.velocity_terms(poses, first))
        for name, k in body.first.items():
            second[name] = Accel(A[:, k] + 1j * A[:, k + 1], A[:, k + 2])
        motion = case.motion(q, poses, first, second)
        on = {name: (wrench.force, wrench.moment) for name, wrench in case.wrenches(motion).items()}
        multipliers = solve(np.swapaxes(J, -1, -2), -by_links(case.linkage, on))
        return answers(case, motion, body.rows.reactions(poses, multipliers), multipliers[:, -1])

    return at
