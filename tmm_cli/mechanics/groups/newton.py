"""Solver of groups of any class: Newton's method on the constraint equations of the pairs, at all positions at once.

Unknowns are the origins and angles of the links; lengths are divided by the size of the group. One matrix serves
positions, velocities and accelerations, and its transpose serves reactions: E. J. Haug, Computer Aided Kinematics and
Dynamics of Mechanical Systems, ch. 3 and 4. A group with more equations than unknowns (redundant constraints) is solved
by least squares, which is exact as long as the equations are consistent.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, reduce
from typing import Any

import numpy as np

from tmm_cli.mechanics.groups.branch_trace import BranchTrace
from tmm_cli.mechanics.groups.group_solver import GroupSolver, link_extent, slider_search_range
from tmm_cli.mechanics.groups.pairs import PAIR_CONSTRAINTS
from tmm_cli.mechanics.groups.pairs.lower import DriverConstraint, JacobianRow, PairConstraint
from tmm_cli.mechanics.groups.state import (
    Accel,
    Accels,
    DriverStates,
    GroupReactions,
    GroupState,
    Placement,
    Pose,
    Poses,
    Rate,
    Rates,
    Wrench,
)
from tmm_cli.mechanics.linkage import Linkage
from tmm_cli.mechanics.numerics import (
    BLURRED_PASSIVE,
    CONVERGED,
    LAST_STEP,
    LAST_STEP_EXTENDED,
    NEAR_SINGULAR,
    ROUNDINGS,
    SINGULAR,
    TRUNCATED,
    DoubleDouble,
    Real,
    Vector,
    cross,
    determinant_sign,
    roundoff,
    singular_value_ratio,
    solve,
    to_double_double,
    to_float,
    unit,
)
from tmm_cli.mechanics.structure import Group

MOST_ITERATIONS = 12  # of Newton's method


@dataclass(frozen=True)
class NewtonSolver(GroupSolver):
    """Solver of a group of any class by Newton's method.

    Attributes:
        constraints: constraint equations of external pairs, internal pairs and drivers, in the order of the group.
        start: state of the group in the sketch, the initial guess if there is no trace; None if not yet assembled.
        trace: states traced along the range of the driver, which give initial guesses, or None.
        passive: True if the group has redundant constraints.
        order: index of each link of the group, by name.
    """

    constraints: tuple[PairConstraint, ...]
    start: GroupState | None = None
    trace: BranchTrace | None = None
    passive: bool = False
    order: Mapping[str, int] = field(default_factory=dict)

    near = NEAR_SINGULAR

    @property
    def blurred(self) -> float:
        """Margin below which float64 is not accurate enough, so that the group must be solved in double-doubles.

        It is greater for a group with redundant constraints. In float64 its equations are consistent only to rounding,
        so angles lose a factor 1/margin of their accuracy and accelerations its square.
        """
        return BLURRED_PASSIVE if self.passive else self.near

    @classmethod
    def of(cls, group: Group, linkage: Linkage) -> NewtonSolver:
        """Make the solver of a group of this linkage, not yet assembled. Dimensions may be arrays."""
        pairs = tuple(PAIR_CONSTRAINTS[pair.kind](pair, linkage) for pair in (*group.outer, *group.inner))
        drives = tuple(DriverConstraint.of(driver, linkage) for driver in group.drivers)
        size = reduce(np.maximum, [link_extent(linkage, link) for link in sorted({*group.links, *group.known})])
        size = size if np.any(size > 0) else slider_search_range(linkage)
        rows = sum(len(c.lengths) for c in (*pairs, *drives))
        order = {link: k for k, link in enumerate(group.links)}
        return cls(group, size, (*pairs, *drives), passive=rows > 3 * len(group.links), order=order)

    def rebind(self, linkage: Linkage) -> NewtonSolver:
        return replace(NewtonSolver.of(self.group.rebind(linkage), linkage), start=self.start, trace=self.trace)

    @property
    def followed(self) -> BranchTrace | None:
        return self.trace

    @cached_property
    def by_angle(self) -> bool:
        """True if linear equations between angles determine all angles. There is then only one assembly."""
        still = {name: Pose(np.zeros(1, complex), np.ones(1, complex), np.zeros(1)) for name in self._all}
        rows = []
        for constraint in self.constraints:
            of_links = constraint.jacobian_rows(still) if constraint.kind in "GPD" else {}
            for k, length in enumerate(constraint.lengths):
                if not length and of_links:
                    rows.append(
                        [float(np.ravel(of_links[n][k][1])[0]) if n in of_links else 0.0 for n in self.group.links]
                    )
        return bool(rows) and int(np.linalg.matrix_rank(np.array(rows))) == len(self.group.links)

    @property
    def _all(self) -> set[str]:
        return {link for constraint in self.constraints for link in constraint.links} | set(self.group.links)

    @cached_property
    def _scale(self) -> Real:
        return _stack([1 / self.size if length else 1.0 for c in self.constraints for length in c.lengths])

    @cached_property
    def _columns(self) -> Real:
        return _stack([self.size, self.size, 1.0] * len(self.group.links))

    @property
    def unit(self) -> Real:
        """Size of the group (m), as an array whose last axis has length 1."""
        return _stack([self.size])

    def _assemble_matrix(self, parts: Sequence[Mapping[str, Sequence[JacobianRow]]], like: Real) -> Real:
        """Assemble the Jacobian rows of all pairs into one dimensionless matrix (..., rows, unknowns)."""
        matrix: Real = np.zeros_like(like, shape=(*np.shape(like), self._scale.shape[-1], 3 * len(self.group.links)))
        row = 0
        for constraint, of_links in zip(self.constraints, parts, strict=True):
            for link, lines in of_links.items():
                if link in self.order:
                    at = 3 * self.order[link]
                    for k, (c, m) in enumerate(lines):
                        constant = isinstance(c, complex)  # along an axis, or zero
                        if not constant or c.real:
                            matrix[..., row + k, at] = c.real
                        if not constant or c.imag:
                            matrix[..., row + k, at + 1] = c.imag
                        matrix[..., row + k, at + 2] = m
            row += len(constraint.lengths)
        matrix = matrix * (self._scale[..., :, None] * self._columns[..., None, :])
        return matrix  # noqa: RET504  typed

    def matrix(self, poses: Poses) -> Real:
        """Return the dimensionless Jacobian of the constraint equations, shape (..., rows, unknowns)."""
        x = poses[self.group.links[0]].x
        return self._assemble_matrix(self._rows(poses), x.real + 0 * self.size)

    def _rows(self, poses: Poses) -> list[Mapping[str, Sequence[JacobianRow]]]:
        return [c.jacobian_rows(poses) for c in self.constraints]

    def residuals(self, poses: Poses, drives: DriverStates) -> Real:
        """Return the dimensionless residuals of the constraint equations, shape (..., rows)."""
        return _stack([residual for c in self.constraints for residual in c.residuals(poses, drives)]) * self._scale

    def known(self, poses: Poses, motion: Mapping[str, tuple[object, Real]]) -> Real:
        """Return the terms of the differentiated constraint equations that are due to the motion of the known links.

        They are dimensionless, shape (..., rows).

        motion: velocities (or accelerations) of origin and angle of each known link, by name.
        """
        shape = np.shape(poses[self.group.links[0]].x)
        rows: list[Real] = []
        nothing = np.zeros(shape)
        for constraint in self.constraints:
            total: list[Real] = [nothing] * len(constraint.lengths)
            outer = [link for link in constraint.links if link not in self.order]
            of_links = constraint.jacobian_rows(poses) if outer else {}
            for link, lines in of_links.items():
                if link not in self.order:
                    v, w = motion[link]
                    total = [
                        t + (c.real * v.real + c.imag * v.imag) + m * w  # type: ignore[attr-defined]
                        for t, (c, m) in zip(total, lines, strict=True)
                    ]
            rows += total
        return _stack(rows) * self._scale

    def asked(self, drives: DriverStates, order: int, shape: tuple[int, ...]) -> Real:
        """Return the time derivative that the drivers prescribe for each constraint equation, dimensionless.

        It is zero for equations of pairs. order: 1 for the first derivative, 2 for the second.
        """
        if not self.group.drivers:
            return np.zeros((*shape, self._scale.shape[-1]))
        rows = [value for c in self.constraints for value in c.asked(drives, order)]
        return _stack([np.zeros(shape), *rows])[..., 1:] * self._scale

    def poses_of(self, state: GroupState) -> dict[str, Pose]:
        """Convert a state of the group to poses of its links, by name."""
        x, z, unwrapped = state.x, unit(state.unwrapped), state.unwrapped
        return {link: Pose(x[..., k], z[..., k], unwrapped[..., k]) for link, k in self.order.items()}

    def close(
        self, start: GroupState, poses: Poses, drives: DriverStates, rounds: int = MOST_ITERATIONS
    ) -> tuple[GroupState, Real]:
        """Solve the constraint equations by Newton's method.

        Args:
            start: initial guess.
            poses: poses of the known links.
            drives: coordinates of the drivers.
            rounds: largest number of iterations.

        Returns:
            The last state and the size of the last step, which is small where the iteration has converged.
        """
        state = start
        if isinstance(self.size, DoubleDouble) or any(isinstance(pose.x, DoubleDouble) for pose in poses.values()):
            state = GroupState(to_double_double(start.x), to_double_double(start.unwrapped))
        step_size = np.full(np.shape(start.x)[:-1], np.inf)
        for _ in range(rounds):
            near = step_size < (LAST_STEP_EXTENDED if isinstance(state.unwrapped, DoubleDouble) else LAST_STEP)
            everything = {**poses, **self.poses_of(state)}
            step = solve(to_float(self.matrix(everything)), -to_float(self.residuals(everything, drives)))
            step_size = np.max(np.abs(step), axis=-1)
            state = state.moved(step, self.unit)
            if bool(np.all(near | ~np.isfinite(step_size))):
                break
        return state, step_size

    def begun(self, poses: Poses, q: Real, drives: DriverStates) -> tuple[GroupState, Real]:
        """Return the initial guesses of Newton's method at driver coordinates q.

        With a trace, they and their residuals are those of `BranchTrace.start`. Otherwise they are the state of the
        sketch.
        """
        if self.trace is not None:
            start, residual = self.trace.start(q)
            nothing = (residual > 0)[..., None]  # no solution there
            return GroupState(start.x, np.where(nothing, np.nan, start.unwrapped)), residual
        assert self.start is not None
        shape = (*np.shape(q), len(self.group.links))
        start = GroupState(np.broadcast_to(self.start.x, shape), np.broadcast_to(self.start.unwrapped, shape))
        return start, np.full(np.shape(q), -1.0)

    def place(self, poses: Poses, q: Real, drives: DriverStates) -> Placement:
        start, residual = self.begun(poses, q, drives)
        with np.errstate(all="ignore"):
            state, step = self.close(start, poses, drives)
        dead, side = np.zeros(np.shape(q), dtype=bool), np.ones(np.shape(q))
        if self.trace is not None:  # in a dead position that is passed, the state is that of the trace
            dead, side = self.trace.in_dead(q, ROUNDINGS**2 * roundoff(start.unwrapped)), self.trace.side(q)
            through = dead[..., None]
            state = GroupState(np.where(through, start.x, state.x), np.where(through, start.unwrapped, state.unwrapped))
        own_poses = self.poses_of(state)
        everything = {**poses, **own_poses}
        matrix = self.matrix(everything)
        margin = singular_value_ratio(matrix)
        missed = np.max(np.abs(self.residuals(everything, drives)), axis=-1) if self.passive else np.zeros(np.shape(q))
        lost = ~(step < CONVERGED) | ~(missed < CONVERGED)
        slack = np.full(np.shape(q), ROUNDINGS * roundoff(state.unwrapped))
        residual = np.where(
            lost & (residual < -slack), np.maximum(np.where(np.isfinite(step), step, 1.0), missed), residual
        )
        residual = np.where(dead, 0.0, residual)
        residual = np.where(
            margin < (TRUNCATED if self.passive else SINGULAR), np.where(residual > slack, residual, 0.0), residual
        )
        det = determinant_sign(matrix) * margin * side
        return Placement(
            tuple(own_poses[link] for link in self.group.links), det, margin, residual * self.size, slack * self.size
        )

    def _all_poses(self, at: Placement, poses: Poses) -> dict[str, Pose]:
        return {**poses, **dict(zip(self.group.links, at.poses, strict=True))}

    def rates(self, at: Placement, poses: Poses, rates: Rates, drives: DriverStates) -> tuple[Rate, ...]:
        everything = self._all_poses(at, poses)
        return self.rates_at(everything, self.matrix(everything), at.det, rates, drives)

    def rates_at(
        self, everything: Poses, matrix: Real, det: Real, rates: Rates, drives: DriverStates
    ) -> tuple[Rate, ...]:
        """Compute the velocities of the links of the group from the poses of all links and the Jacobian matrix.

        They are nan where det is nan.
        """
        known = self.known(everything, {name: (rate.v, rate.w) for name, rate in rates.items()})
        solution = solve(matrix, self.asked(drives, 1, np.shape(det)) - known)
        return tuple(Rate(v, w) for v, w in self._split_by_link(solution, det))

    def accelerations(
        self, at: Placement, poses: Poses, rates: Rates, accels: Accels, drives: DriverStates
    ) -> tuple[Accel, ...]:
        everything = self._all_poses(at, poses)
        return self.accelerations_at(everything, self.matrix(everything), at.det, rates, accels, drives)

    def accelerations_at(
        self, everything: Poses, matrix: Real, det: Real, rates: Rates, accels: Accels, drives: DriverStates
    ) -> tuple[Accel, ...]:
        """Compute the accelerations of the links of the group from the poses of all links and the Jacobian matrix.

        They are nan where det is nan.

        rates: velocities of all links, including those of the group.
        """
        known = self.known(everything, {name: (accel.a, accel.e) for name, accel in accels.items()})
        bend = _stack(self.velocity_terms(everything, rates)) * self._scale
        solution = solve(matrix, self.asked(drives, 2, np.shape(det)) - known - bend)
        return tuple(Accel(a, e) for a, e in self._split_by_link(solution, det))

    def velocity_terms(self, poses: Poses, rates: Rates) -> list[Real]:
        """Return the terms of the second derivative of each constraint equation that contain velocities only.

        The other terms are linear in the accelerations.
        """
        return [term for constraint in self.constraints for term in constraint.velocity_terms(poses, rates)]

    def _split_by_link(self, solution: Real, det: Real) -> Iterator[tuple[Vector, Real]]:
        """Split a dimensionless solution into the complex origin and the angle of each link, in metres and radians.

        They are nan where det is nan.
        """
        solution = np.where(np.isfinite(det)[..., None], solution * self._columns, np.nan)
        for k in range(0, solution.shape[-1], 3):
            yield solution[..., k] + 1j * solution[..., k + 1], solution[..., k + 2]

    def _split_by_constraint(self, multipliers: Sequence[Real]) -> list[tuple[PairConstraint, list[Real]]]:
        """Group the Lagrange multipliers of all equations by pair and driver."""
        each, row = [], 0
        for constraint in self.constraints:
            each.append((constraint, list(multipliers[row : row + len(constraint.lengths)])))
            row += len(constraint.lengths)
        return each

    def _separating_forces(self, everything: Poses, multipliers: Sequence[Real]) -> dict[str, Wrench]:
        """Return the radial (separating) forces of gear teeth on each link.

        They follow from the tangential forces and do no work.
        """
        total: dict[str, Wrench] = {}
        for constraint, constraint_multipliers in self._split_by_constraint(multipliers):
            apart = constraint.apart(everything, constraint_multipliers)
            if apart is None:
                continue
            point, force = apart
            for link, sense in ((constraint.links[1], 1.0), (constraint.links[0], -1.0)):
                if link in self.order:
                    more = Wrench(sense * force, sense * cross(point - everything[link].x, force))
                    total[link] = total[link] + more if link in total else more
        return total

    def reactions(self, at: Placement, poses: Poses, applied: tuple[Wrench, ...]) -> GroupReactions:
        """Compute the reactions from the transposed constraint equations.

        The equations are solved again with the radial forces of gear teeth, which only the hinges carry.
        """
        everything = self._all_poses(at, poses)
        under = self._transposed(at, everything)
        multipliers = under(applied)
        more = self._separating_forces(everything, multipliers)
        if more:
            both = zip(self.group.links, applied, strict=True)
            multipliers = under([wrench + more[link] if link in more else wrench for link, wrench in both])
        return self.given_by(everything, self._split_by_constraint(multipliers))

    def _transposed(self, at: Placement, everything: Poses) -> Callable[[Sequence[Wrench]], Sequence[Real]]:
        """Return a function that computes the Lagrange multipliers of all equations from the forces on the links."""
        pushes = self._assemble_matrix(
            [c.pushes(everything) for c in self.constraints], at.poses[0].x.real + 0 * self.size
        )
        turned = np.swapaxes(pushes, -1, -2)

        def under(wrenches: Sequence[Wrench]) -> Sequence[Real]:
            borne = [
                component for wrench in wrenches for component in (wrench.force.real, wrench.force.imag, wrench.moment)
            ]
            multipliers = solve(turned, -_stack(borne) * self._columns)
            multipliers = np.where(np.isfinite(at.det)[..., None], multipliers, np.nan) * self._scale
            return [multipliers[..., row] for row in range(multipliers.shape[-1])]

        return under

    def given_by(self, everything: Poses, multipliers: Sequence[tuple[PairConstraint, list[Real]]]) -> GroupReactions:
        """Convert the Lagrange multipliers of each pair and driver to reactions."""
        reaction = [
            constraint.reaction(everything, constraint_multipliers)
            for constraint, constraint_multipliers in multipliers
        ]
        outer, inner = len(self.group.outer), len(self.group.inner)
        for k, pair in enumerate(self.group.outer):
            if pair.i in self.order:
                reaction[k] = reaction[k].opposite
        drives = {
            driver.link: constraint_multipliers[0]
            for driver, (_, constraint_multipliers) in zip(
                self.group.drivers, multipliers[outer + inner :], strict=True
            )
        }
        return GroupReactions(tuple(reaction[:outer]), tuple(reaction[outer : outer + inner]), drives)


def _stack(values: Sequence[Any]) -> Real:
    """Stack numbers or arrays along a new last axis, after broadcasting them to one shape."""
    if len({np.shape(value) for value in values}) > 1:
        values = np.broadcast_arrays(*values)
    return np.stack(values, axis=-1)
