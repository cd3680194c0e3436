"""Newton's method on the constraint equations of the pairs: loop closure, and the multibody formulation.

The multibody formulation uses the equations of all pairs at once. Loop closure uses only those of the pairs at which
the loops are cut open.

E. J. Haug, Computer Aided Kinematics and Dynamics of Mechanical Systems, ch. 3, 4 and 8; J. Garcia de Jalon, E. Bayo,
Kinematic and Dynamic Simulation of Multibody Systems, ch. 2 and 3; A. A. Shabana, Dynamics of Multibody Systems, ch. 3.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Protocol

import numpy as np

from tmm_cli.bench.methods.case import Case, MethodAnswers, build_answers
from tmm_cli.mechanics.groups import (
    PAIR_CONSTRAINTS,
    Accel,
    DriverConstraint,
    DriverStates,
    GuideGeometry,
    PairConstraint,
    Pose,
    Poses,
    Rate,
    Rates,
    Wrench,
    drives_at,
    frame_state,
)
from tmm_cli.mechanics.kinematics import compute_motion
from tmm_cli.mechanics.linkage import FRAME, Linkage
from tmm_cli.mechanics.numerics import Real, Vector, dot, solve, unit
from tmm_cli.mechanics.structure import Pair


@dataclass(frozen=True)
class PairEquations:
    """Constraint equations of some pairs, two for each pair.

    Attributes:
        driven: True to add the equation of the driver as the last one.
        size: unit of length that makes the equations dimensionless, m.
    """

    linkage: Linkage
    pairs: tuple[Pair, ...]
    driven: bool = False
    size: float = 1.0

    @cached_property
    def constraints(self) -> tuple[PairConstraint, ...]:
        """Constraints of all pairs, followed by that of the driver if `driven` is True."""
        pair_constraints = tuple(PAIR_CONSTRAINTS[pair.kind](pair, self.linkage) for pair in self.pairs)
        return (
            (*pair_constraints, DriverConstraint.of(self.linkage.driver, self.linkage))
            if self.driven
            else pair_constraints
        )

    @cached_property
    def scale(self) -> Real:
        """Factors that make the equations dimensionless, (equations,)."""
        return np.array([1 / self.size if length else 1.0 for c in self.constraints for length in c.lengths])

    def residuals(self, poses: Poses, drives: DriverStates) -> Real:
        """Return the residuals of the equations, (positions, equations)."""
        return np.stack([row for c in self.constraints for row in c.residuals(poses, drives)], axis=-1) * self.scale

    def matrix(self, poses: Poses) -> Real:
        """Return the Jacobian matrix, (positions, equations, 3 links).

        The columns are derivatives with respect to x, y and angle of each moving link.
        """
        first = {name: 3 * k for k, name in enumerate(self.linkage.moving)}
        J = np.zeros((len(poses[self.linkage.driver.link].x), len(self.scale), 3 * len(first)))
        for number, constraint in enumerate(self.constraints):
            for link, parts in constraint.jacobian_rows(poses).items():
                if link in first:
                    at = first[link]
                    for row, (along, around) in enumerate(parts, 2 * number):
                        J[:, row, at], J[:, row, at + 1], J[:, row, at + 2] = along.real, along.imag, around
        return J * self.scale[:, None]

    def velocity_terms(self, poses: Poses, rates: Rates) -> Real:
        """Return the second time derivatives of the equations without link accelerations, (positions, equations)."""
        return np.stack([row for c in self.constraints for row in c.velocity_terms(poses, rates)], axis=-1) * self.scale

    def reactions(self, poses: Poses, multipliers: Real) -> dict[str, Vector]:
        """Convert Lagrange multipliers to forces (N) on the second link of each pair, by the name of the pair."""
        forces: dict[str, Vector] = {}
        pushes = list(np.moveaxis(multipliers * self.scale, -1, 0))
        for number, (pair, constraint) in enumerate(zip(self.pairs, self.constraints, strict=False)):
            force = constraint.reaction(poses, pushes[2 * number : 2 * number + 2]).force
            forces[pair.name] = force if pair.j == constraint.links[1] else -force
        return forces


def arrange_columns(linkage: Linkage, parts: Mapping[str, tuple[Vector, Real]]) -> Real:
    """Arrange a vector and a number for each moving link like the columns x, y, angle of the Jacobian matrix."""
    columns = [column for at, around in map(parts.__getitem__, linkage.moving) for column in (at.real, at.imag, around)]
    return np.stack(columns, axis=-1)


# Newton's method on the closure of the whole linkage, from the nearest node of a trace that is made once.


MOST_ITERATIONS = 12  # of Newton's method; more do not help where it converges at all
TRACED_POSITIONS = 36  # in a turn of the driver, or over the length of the linkage to both sides of the sketch
LEAST_GAP = 1e-11  # a residual below this that is no longer halved is rounding


class LinkageClosure(Protocol):
    """Interface of dimensionless closure equations of a linkage, with unknowns X of shape (positions, unknowns)."""

    def residuals(self, X: Real, q: Real) -> Real:
        """Return the residuals, (positions, unknowns)."""

    def matrix(self, X: Real, q: Real) -> Real:
        """Return the Jacobian matrix, (positions, unknowns, unknowns)."""

    def coordinates_from_poses(self, poses: dict[str, Pose], q: Real) -> Real:
        """Return the coordinates X that describe given poses of the links."""


def close_positions(closure: LinkageClosure, X: Real, q: Real, tolerance: float) -> Real:
    """Solve closure equations by Newton's method at driver coordinates q.

    Iteration stops when the residuals of a position are within the tolerance or no longer decrease because of rounding.

    Args:
        closure: Closure equations.
        X: Initial guesses, (positions, unknowns).
        q: Driver coordinates, (positions,).
        tolerance: Largest permitted residual, dimensionless.

    Returns:
        Coordinates X; nan at positions where the iteration does not converge.
    """
    active, last = np.ones(len(q), dtype=bool), np.full(len(q), np.inf)
    for _ in range(MOST_ITERATIONS):
        residuals = closure.residuals(X, q)
        gaps = np.max(np.abs(residuals), axis=-1)
        active = active & ~(gaps <= tolerance) & ~((gaps < LEAST_GAP) & (gaps > last / 2))
        if not np.any(active):
            break
        step = solve(closure.matrix(X, q), -residuals)
        X, last = np.where(active[:, None], X + step, X), gaps
    if np.any(active):
        gaps = np.max(np.abs(closure.residuals(X, q)), axis=-1)
        X = np.where((active & ~(gaps <= max(tolerance, LEAST_GAP)))[:, None], np.nan, X)
    return X


@dataclass(frozen=True)
class TracedCoordinates:
    """Coordinates X of closure equations along the motion, used as initial guesses.

    Attributes:
        q: increasing driver coordinates, (nodes,).
        X: coordinates, (nodes, unknowns).
        cycle: period in q if the driver makes full revolutions, otherwise None.
    """

    q: Real
    X: Real
    cycle: float | None

    def find_nearest(self, q: Real) -> Real:
        """Return the coordinates X of the node nearest to each driver coordinate."""
        within = q if self.cycle is None else self.q[0] + np.mod(q - self.q[0], self.cycle)
        right = np.clip(np.searchsorted(self.q, within), 1, len(self.q) - 1)
        nearer = np.where(within - self.q[right - 1] < self.q[right] - within, right - 1, right)
        return self.X[nearer]


def trace_coordinates(case: Case, closure: LinkageClosure) -> TracedCoordinates:
    """Follow the coordinates X from the sketch in both directions, a crank through half a turn each way."""
    at = case.linkage.sketch.at
    sketch_q = np.array([at])
    poses = dict(compute_motion(case.linkage, case.kernels, sketch_q, case.law).poses)
    turns = case.linkage.driver.kind == "turn"
    reach = np.pi if turns else case.size
    q, X = [at], [close_positions(closure, closure.coordinates_from_poses(poses, sketch_q), sketch_q, 0.0)[0]]
    ways = [_trace_one_way(closure, X[0], at, sense * reach / (TRACED_POSITIONS // 2)) for sense in (-1, 1)]
    whole = turns and all(len(trace) == TRACED_POSITIONS // 2 for trace in ways)
    q = [*(place for place, _ in reversed(ways[0])), at, *(place for place, _ in ways[1])]
    X = [*(coordinates for _, coordinates in reversed(ways[0])), X[0], *(coordinates for _, coordinates in ways[1])]
    return TracedCoordinates(np.array(q), np.array(X), 2 * np.pi if whole else None)


def _trace_one_way(closure: LinkageClosure, X: Real, at: float, step: float) -> list[tuple[float, Real]]:
    """Return driver coordinates with their X, step by step, until Newton's method fails."""
    nodes: list[tuple[float, Real]] = []
    with np.errstate(all="ignore"):
        for k in range(1, TRACED_POSITIONS // 2 + 1):
            q = np.array([at + k * step])
            X = close_positions(closure, X[None, :], q, 0.0)[0]
            if not np.max(np.abs(closure.residuals(X[None, :], q))) < LEAST_GAP:
                break
            nodes.append((float(q[0]), X))
    return nodes


# Newton's method on loop closure: joint coordinates along a spanning tree of pairs; each other pair closes a loop.
#
# R. L. Norton, Design of Machinery, ch. 4 and 7; J. Garcia de Jalon, E. Bayo, Kinematic and Dynamic Simulation of
# Multibody Systems, ch. 2 (relative coordinates). There are two equations per loop. One matrix gives positions,
# velocities, accelerations and, transposed, the forces in the cut pairs; forces in the tree then follow from its
# leaves to its root.


@dataclass(frozen=True)
class TreeBranch:
    """A pair of the spanning tree, with the link `own` that it connects to the tree."""

    pair: Pair
    own: str

    @property
    def before(self) -> str:
        return self.pair.other(self.own)

    @property
    def runs(self) -> bool:
        """True if `own` slides in a prismatic pair; False if it carries the guide, or if the pair is revolute."""
        return self.pair.slide is not None and self.pair.slide.runner == self.own


@dataclass(frozen=True)
class LoopEquations:
    """Loop closure in joint coordinates: the relative angle or displacement in each pair of a spanning tree."""

    case: Case

    @cached_property
    def tree(self) -> tuple[TreeBranch, ...]:
        """Branches of the spanning tree from the frame outwards; driving pairs are preferred."""
        structure = self.case.structure
        driving = [structure.driving_pair(driver) for driver in structure.drivers]
        pairs = sorted(structure.pairs, key=lambda pair: pair not in driving)
        reached, branches = {FRAME}, []
        while len(reached) <= len(self.case.linkage.moving):
            pair = next(p for p in pairs if len({p.i, p.j} & reached) == 1)
            link = pair.j if pair.i in reached else pair.i
            reached.add(link)
            branches.append(TreeBranch(pair, link))
        return tuple(branches)

    @cached_property
    def cut(self) -> tuple[Pair, ...]:
        """Pairs outside the spanning tree, at which the loops are cut open."""
        inside = [branch.pair for branch in self.tree]
        return tuple(pair for pair in self.case.structure.pairs if pair not in inside)

    @cached_property
    def rows(self) -> PairEquations:
        """Constraint equations of the cut pairs."""
        return PairEquations(self.case.linkage, self.cut, size=self.case.size)

    @cached_property
    def driver_index(self) -> int:
        """Index of the driver coordinate among the joint coordinates."""
        pair = self.case.structure.driving_pair(self.case.linkage.driver)
        return next(k for k, branch in enumerate(self.tree) if branch.pair == pair)

    @cached_property
    def unknowns(self) -> list[int]:
        """Indices of the joint coordinates that are unknown, i.e. of all except that of the driver."""
        return [k for k in range(len(self.tree)) if k != self.driver_index]

    @cached_property
    def coordinates_of(self) -> Mapping[str, frozenset[int]]:
        """Indices of the joint coordinates on which the pose of each link depends, by link."""
        coordinates_of: dict[str, frozenset[int]] = {FRAME: frozenset()}
        for k, branch in enumerate(self.tree):
            coordinates_of[branch.own] = coordinates_of[branch.before] | {k}
        return coordinates_of

    # positions

    def insert_driver(self, X: Real, q: Real) -> list[Real]:
        """Return all joint coordinates in the order of the tree: the unknowns X and the driver coordinate q."""
        columns = list(np.moveaxis(X, -1, 0))
        columns.insert(self.driver_index, q)
        return columns

    def poses(self, X: Real, q: Real) -> dict[str, Pose]:
        local = self.case.linkage.local
        poses = {FRAME: frame_state(q)[0]}
        for branch, s in zip(self.tree, self.insert_driver(X, q), strict=True):
            before, pair, slide = poses[branch.before], branch.pair, branch.pair.slide
            if slide is None:
                unwrapped = before.turned + s
                z = unit(unwrapped)
                x = before.at(local(branch.before, pair.point)) - local(branch.own, pair.point) * z
            elif branch.runs:
                unwrapped = before.turned + slide.turned
                z = unit(unwrapped)
                x = before.at(slide.through + s * unit(slide.direction)) - slide.at * z
            else:
                unwrapped = before.turned - slide.turned
                z = unit(unwrapped)
                x = before.at(slide.at) - (slide.through + s * unit(slide.direction)) * z
            poses[branch.own] = Pose(x, z, unwrapped)
        return poses

    def coordinates_from_poses(self, poses: dict[str, Pose], q: Real) -> Real:
        columns = []
        for k in self.unknowns:
            branch = self.tree[k]
            slide = branch.pair.slide
            if slide is None:
                columns.append(poses[branch.own].turned - poses[branch.before].turned)
            else:
                guide = GuideGeometry.at(slide, poses)
                columns.append(dot(guide.u, guide.off))
        return np.stack(columns, axis=-1)

    def residuals(self, X: Real, q: Real) -> Real:
        return self.rows.residuals(self.poses(X, q), {})

    # motion

    def matrix(self, X: Real, q: Real) -> Real:
        poses = self.poses(X, q)
        return (self.rows.matrix(poses) @ self.transformation(poses))[..., self.unknowns]

    def transformation(self, poses: Poses) -> Real:
        """Return the derivatives of x, y and angle of the links with respect to all joint coordinates.

        The shape is (positions, 3 links, coordinates). This is matrix R of Garcia de Jalon and Bayo.
        """
        R = np.zeros((len(poses[FRAME].x), 3 * len(self.tree), len(self.tree)))
        for k, branch in enumerate(self.tree):
            slide = branch.pair.slide
            for n, link in enumerate(self.case.linkage.moving):
                if k not in self.coordinates_of[link]:
                    continue
                if slide is None:
                    moved = 1j * (poses[link].x - self._joint_position(branch.pair, branch.own, poses))
                    R[:, 3 * n + 2, k] = 1.0
                else:
                    moved = GuideGeometry.at(slide, poses).u * (1 if branch.runs else -1)
                R[:, 3 * n, k], R[:, 3 * n + 1, k] = moved.real, moved.imag
        return R

    def _joint_position(self, pair: Pair, link: str, poses: Poses) -> Vector:
        return poses[link].at(self.case.linkage.local(link, pair.point))

    def link_motion(
        self, poses: Poses, speeds: list[Real], bends: list[Real]
    ) -> tuple[dict[str, Rate], dict[str, Accel]]:
        """Return velocities and accelerations of all links from first and second derivatives of the coordinates."""
        _, rest, still = frame_state(poses[FRAME].x)
        first, second = {FRAME: rest}, {FRAME: still}
        for branch, s1, s2 in zip(self.tree, speeds, bends, strict=True):
            rate, accel, before = first[branch.before], second[branch.before], poses[branch.before]
            own, slide = poses[branch.own], branch.pair.slide
            if slide is None:
                place = self._joint_position(branch.pair, branch.own, poses)
                w, e = rate.w + s1, accel.e + s2
            else:
                place = poses[slide.runner].at(slide.at)
                w, e = rate.w, accel.e
            arm, v, a = place - own.x, rate.at(place - before.x), accel.at(place - before.x, rate.w)
            if slide is not None:
                u = GuideGeometry.at(slide, poses).u
                sense = 1 if branch.runs else -1
                v = v + sense * s1 * u
                # Coriolis; relative to its own points, the carrier sees the point of the runner move backwards
                a = a + sense * (2j * w * s1 * u + s2 * u)
            first[branch.own] = Rate.through(v, w, arm)
            second[branch.own] = Accel.through(a, e, w, arm)
        return first, second

    # forces

    def solve_forces(self, poses: Poses, J: Real, Q: Real, on: Mapping[str, Wrench]) -> tuple[dict[str, Vector], Real]:
        """Compute the reactions, from the cut pairs to the root of the tree, and the balancing moment.

        Args:
            poses: Poses of the links.
            J: Jacobian matrix of the cut pairs with respect to all joint coordinates.
            Q: Generalized forces of the loads.
            on: Resultant load on each link, reactions excluded.

        Returns:
            Forces (N) on the second link of each pair, and the balancing moment (N m) or force (N) of the driver.
        """
        cut = solve(np.swapaxes(J[..., self.unknowns], -1, -2), -Q[..., self.unknowns])
        balancing = -(Q[:, self.driver_index] + np.einsum("nr,nr->n", J[..., self.driver_index], cut))
        borne = {link: wrench.force for link, wrench in on.items()}
        reactions = self.rows.reactions(poses, cut)
        for pair in self.cut:
            borne[pair.j] = borne[pair.j] + reactions[pair.name]
            borne[pair.i] = borne[pair.i] - reactions[pair.name]
        for branch in reversed(self.tree):
            all_of_it = borne[branch.own]
            reactions[branch.pair.name] = -all_of_it if branch.own == branch.pair.j else all_of_it
            borne[branch.before] = borne[branch.before] + all_of_it
        return reactions, balancing


@lru_cache(maxsize=8)
def _trace_loops(case: Case) -> tuple[LoopEquations, TracedCoordinates]:
    """Return the loop equations of a linkage and their coordinates along the motion, for use with all tolerances."""
    loops = LoopEquations(case)
    return loops, trace_coordinates(case, loops)


def prepare_loops(tolerance: float, case: Case) -> Callable[[Real], MethodAnswers]:
    """Prepare Newton's method on loop closure; tolerance: gap of a loop in rad or as a fraction of the linkage size."""
    loops, nodes = _trace_loops(case)

    def at(q: Real) -> MethodAnswers:
        poses = loops.poses(close_positions(loops, nodes.find_nearest(q), q, tolerance), q)
        links, R = loops.rows.matrix(poses), loops.transformation(poses)
        J = links @ R
        free, driver_column = J[..., loops.unknowns], J[..., loops.driver_index]
        still = np.zeros(len(q))
        speeds = loops.insert_driver(solve(free, -driver_column), still + 1)
        first, bent = loops.link_motion(poses, speeds, [still] * len(speeds))
        accels = arrange_columns(case.linkage, {name: (accel.a, accel.e) for name, accel in bent.items()})
        bends = np.einsum("nrc,nc->nr", links, accels) + loops.rows.velocity_terms(poses, first)
        first, second = loops.link_motion(poses, speeds, loops.insert_driver(solve(free, -bends), still))
        motion = case.motion(q, poses, first, second)
        on = case.wrenches(motion)
        loads = arrange_columns(case.linkage, {name: (wrench.force, wrench.moment) for name, wrench in on.items()})
        forces, balancing = loops.solve_forces(poses, J, np.einsum("nck,nc->nk", R, loads), on)
        return build_answers(case, motion, forces, balancing)

    return at


TOLERANCE = 0.0  # until residuals are rounding


@dataclass(frozen=True)
class MultibodyEquations:
    """Constraint equations of all pairs and the driver, in coordinates x, y and angle of each moving link."""

    case: Case

    @cached_property
    def rows(self) -> PairEquations:
        return PairEquations(self.case.linkage, self.case.structure.pairs, driven=True)

    @cached_property
    def first(self) -> dict[str, int]:
        """Index of the x coordinate of each link among all coordinates."""
        return {name: 3 * k for k, name in enumerate(self.case.linkage.moving)}

    def poses(self, X: Real) -> dict[str, Pose]:
        """Return the poses of all links, including the frame, from their coordinates."""
        poses = {FRAME: frame_state(X[:, 0])[0]}
        for name, k in self.first.items():
            poses[name] = Pose(X[:, k] + 1j * X[:, k + 1], unit(X[:, k + 2]), X[:, k + 2])
        return poses

    def coordinates_from_poses(self, poses: dict[str, Pose], q: Real) -> Real:
        return arrange_columns(self.case.linkage, {name: (poses[name].x, poses[name].turned) for name in self.first})

    def residuals(self, X: Real, q: Real) -> Real:
        return self.rows.residuals(self.poses(X), drives_at(self.case.linkage, q))

    def matrix(self, X: Real, q: Real) -> Real:
        return self.rows.matrix(self.poses(X))


def prepare_multibody(case: Case) -> Callable[[Real], MethodAnswers]:
    """Prepare the multibody method: linear systems with the Jacobian matrix for motion, its transpose for forces."""
    body = MultibodyEquations(case)
    nodes = trace_coordinates(case, body)

    def at(q: Real) -> MethodAnswers:
        X = close_positions(body, nodes.find_nearest(q), q, TOLERANCE)
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
        multipliers = solve(np.swapaxes(J, -1, -2), -arrange_columns(case.linkage, on))
        return build_answers(case, motion, body.rows.reactions(poses, multipliers), multipliers[:, -1])

    return at
