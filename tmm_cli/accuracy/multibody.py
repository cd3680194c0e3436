"""The textbook multibody way: three coordinates a link, all constraints at once, reactions as Lagrange multipliers.

E. J. Haug, Computer Aided Kinematics and Dynamics of Mechanical Systems, ch. 3, 4 and 8; A. A. Shabana, Dynamics of
Multibody Systems, ch. 3. The driver is a constraint too, so the Jacobian is square and its multiplier is what balances.
It knows no groups and shares nothing with them but the loads. Rows are in metres and radians, as in the books.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from tmm_cli.accuracy.case import Answers, Case, answers
from tmm_cli.accuracy.following import close, follow
from tmm_cli.groups.linear import solve
from tmm_cli.groups.state import Accel, Pose, Rate
from tmm_cli.linkage import FRAME
from tmm_cli.structure.assur import Pair
from tmm_cli.vectors import Real, Vector, cross, dot, unit

TOLERANCE = 0.0  # until gaps are rounding


@dataclass(frozen=True)
class Body:
    """Coordinates x, y, angle of every moving link in their order; rows: two a pair, the driver's last."""

    case: Case

    @property
    def _at(self) -> dict[str, int]:
        return {name: 3 * k for k, name in enumerate(self.case.linkage.moving)}

    def poses(self, X: Real) -> dict[str, Pose]:
        """Poses of all links, the frame's too."""
        still = np.zeros(X.shape[0])
        found = {FRAME: Pose(still + 0j, still + 1 + 0j, still)}
        for name, k in self._at.items():
            found[name] = Pose(X[:, k] + 1j * X[:, k + 1], unit(X[:, k + 2]), X[:, k + 2])
        return found

    def sketched(self, poses: dict[str, Pose], q: Real) -> Real:
        columns = [part for name in self._at for part in (poses[name].x.real, poses[name].x.imag, poses[name].turned)]
        X = np.stack(columns, axis=-1)
        driver = self.case.linkage.driver
        if driver.kind == "turn" and driver.base == FRAME:  # its angle is not brought within half a turn
            X[:, self._at[driver.link] + 2] = q
        return X

    def gaps(self, X: Real, q: Real) -> Real:
        poses, rows = self.poses(X), []
        for pair in self.case.structure.pairs:
            if pair.kind == "R":
                gap = (
                    self._arm(pair, pair.j, poses) + poses[pair.j].x - poses[pair.i].x - self._arm(pair, pair.i, poses)
                )
                rows += [gap.real, gap.imag]
            else:
                assert pair.slide is not None
                slide = pair.slide
                u, off, _, _ = self._guided(pair, poses)
                turned = poses[slide.runner].turned - poses[slide.carrier].turned - slide.turned
                rows += [_within_half_a_turn(turned), cross(u, off)]
        driver = self.case.linkage.driver
        if driver.kind == "turn":
            rows.append(_within_half_a_turn(poses[driver.link].turned - poses[driver.base].turned - q))
        else:
            u, off, _, _ = self._guided(self._driving, poses)
            rows.append(dot(u, off) - q)
        return np.stack(rows, axis=-1)

    @property
    def _driving(self) -> Pair:
        return self.case.structure.driving_pair(self.case.linkage.driver)

    def _arm(self, pair: Pair, link: str, poses: dict[str, Pose]) -> Vector:
        arm: Vector = self.case.linkage.local(link, pair.point) * poses[link].z
        return arm

    def _guided(self, pair: Pair, poses: dict[str, Pose]) -> tuple[Vector, Vector, Vector, Vector]:
        """Guide's direction; running point from the guide's point, from the carrier's and from the runner's origin."""
        slide = pair.slide
        assert slide is not None
        carrier, runner = poses[slide.carrier], poses[slide.runner]
        on_runner = slide.at * runner.z
        on_carrier = runner.x + on_runner - carrier.x
        return carrier.z * unit(slide.direction), on_carrier - slide.through * carrier.z, on_carrier, on_runner

    def matrix(self, X: Real, q: Real) -> Real:
        poses = self.poses(X)
        at, rows = self._at, X.shape[-1]
        J = np.zeros((X.shape[0], rows, rows))

        def put(row: int, link: str, along: Any, turn: Any) -> None:
            if link != FRAME:
                k = at[link]
                J[:, row, k], J[:, row, k + 1], J[:, row, k + 2] = np.real(along), np.imag(along), turn

        for number, pair in enumerate(self.case.structure.pairs):
            row = 2 * number
            if pair.kind == "R":
                for link, sense in ((pair.i, -1.0), (pair.j, 1.0)):
                    arm = self._arm(pair, link, poses)
                    put(row, link, sense, -sense * arm.imag)
                    put(row + 1, link, sense * 1j, sense * arm.real)
            else:
                slide = pair.slide
                assert slide is not None
                u, _, on_carrier, on_runner = self._guided(pair, poses)
                put(row, slide.carrier, 0j, -1.0)
                put(row, slide.runner, 0j, 1.0)
                put(row + 1, slide.carrier, -1j * u, -cross(on_carrier, 1j * u))
                put(row + 1, slide.runner, 1j * u, cross(on_runner, 1j * u))
        driver = self.case.linkage.driver
        if driver.kind == "turn":
            put(rows - 1, driver.base, 0j, -1.0)
            put(rows - 1, driver.link, 0j, 1.0)
        else:
            slide = self.case.linkage.slide(driver.joint)
            u, _, on_carrier, on_runner = self._guided(self._driving, poses)
            put(rows - 1, slide.carrier, -u, -cross(on_carrier, u))
            put(rows - 1, slide.runner, u, cross(on_runner, u))
        return J

    def bends(self, X: Real, V: Real) -> Real:
        """Second derivatives of the rows when no coordinate accelerates (minus gamma of the books)."""
        poses, at = self.poses(X), self._at
        still = np.zeros(X.shape[0])
        w = {name: V[:, at[name] + 2] if name in at else still for name in poses}
        v = {name: V[:, at[name]] + 1j * V[:, at[name] + 1] if name in at else still + 0j for name in poses}
        rows: list[Real] = []

        def sliding(pair: Pair) -> tuple[Vector, Vector, Real, Real]:
            slide = pair.slide
            assert slide is not None
            i, j = slide.carrier, slide.runner
            u, _, on_carrier, on_runner = self._guided(pair, poses)
            speed = dot(u, v[j] + 1j * w[j] * on_runner - v[i] - 1j * w[i] * on_carrier)
            return u, w[i] ** 2 * on_carrier - w[j] ** 2 * on_runner, speed, w[i]

        for pair in self.case.structure.pairs:
            if pair.kind == "R":
                bend = w[pair.i] ** 2 * self._arm(pair, pair.i, poses) - w[pair.j] ** 2 * self._arm(pair, pair.j, poses)
                rows += [bend.real, bend.imag]
            else:
                u, bend, speed, turn = sliding(pair)
                rows += [still, cross(u, bend) - 2 * turn * speed]
        if self.case.linkage.driver.kind == "turn":
            rows.append(still)
        else:
            u, bend, _, _ = sliding(self._driving)
            rows.append(dot(u, bend))
        return np.stack(rows, axis=-1)

    def forces(self, found: Real, poses: dict[str, Pose]) -> dict[str, Vector]:
        """Multipliers as forces on the second link of each pair."""
        forces: dict[str, Vector] = {}
        for number, pair in enumerate(self.case.structure.pairs):
            row = 2 * number
            if pair.kind == "R":
                forces[pair.name] = found[:, row] + 1j * found[:, row + 1]
            else:
                assert pair.slide is not None
                u = poses[pair.slide.carrier].z * unit(pair.slide.direction)
                forces[pair.name] = 1j * u * found[:, row + 1] * (1 if pair.j == pair.slide.runner else -1)
        return forces


def _within_half_a_turn(angle: Real) -> Real:
    within: Real = np.arctan2(np.sin(angle), np.cos(angle))
    return within


def prepare(case: Case) -> Callable[[Real], Answers]:
    """One linear system a position and order: J^T for the forces, J for all else."""
    body = Body(case)
    nodes = follow(case, body)

    def at(q: Real) -> Answers:
        X = close(body, nodes.near(q), q, TOLERANCE)
        J, poses = body.matrix(X, q), body.poses(X)
        asked = np.zeros_like(X)
        asked[:, -1] = 1.0
        V = solve(J, asked)
        A = solve(J, -body.bends(X, V))
        still = np.zeros(len(q))
        first, second = {FRAME: Rate(still + 0j, still)}, {FRAME: Accel(still + 0j, still)}
        for name, k in body._at.items():
            first[name] = Rate(V[:, k] + 1j * V[:, k + 1], V[:, k + 2])
            second[name] = Accel(A[:, k] + 1j * A[:, k + 1], A[:, k + 2])
        motion = case.motion(q, poses, first, second)
        on = case.wrenches(motion)
        moving = case.linkage.moving
        Q = np.stack([p for n in moving for p in (on[n].force.real, on[n].force.imag, on[n].moment)], axis=-1)
        found = solve(np.swapaxes(J, -1, -2), -Q)
        return answers(case, motion, body.forces(found, poses), found[:, -1])

    return at
