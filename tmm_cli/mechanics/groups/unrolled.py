"""Newton's method as a fixed sequence of array operations, so that it can be traced and run for many positions at once.

The equations are those of newton.py, with a separate array for every coefficient. Some unknowns are computed
explicitly, one by one: angles that a pair determines from other angles, and origins of links that a hinge determines
from angles. Newton's method solves for the remaining, free unknowns, which are few: two, after elimination, for a group
of class III. It makes a fixed number of steps from given initial guesses. Positions at which the residual shows that
the steps were not enough have to be solved by newton.py.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, reduce
from typing import Any

import numpy as np

from tmm_cli.mechanics.groups.newton import NewtonSolver
from tmm_cli.mechanics.groups.pairs.lower import HingeConstraint, JacobianRow, PairConstraint
from tmm_cli.mechanics.groups.state import Accel, Accels, DriverStates, Placement, Pose, Poses, Rate, Rates, Wrench
from tmm_cli.mechanics.linkage import Linkage
from tmm_cli.mechanics.numerics import (
    LAST_STEP,
    NEAR_SINGULAR,
    EliminatedSystem,
    EliminationOrder,
    EquationRow,
    Real,
    dot,
    singular_margin,
    unit,
)

GIVE_ANGLES = "PGD"  # kinds of constraints whose first row may determine an angle from others


@dataclass(frozen=True)
class ExplicitOrder:
    """Explicit unknowns of a group, which follow one by one from single equations, and the order of elimination.

    The unknowns x, y and angle of the link with index k have the numbers 3k, 3k + 1 and 3k + 2.

    Attributes:
        angles: explicit angles in turn, as (index of the constraint that gives the angle, link).
        origins: explicit origins in turn, as (index of the constraint that gives the origin, link).
        order: order of elimination.
        pushing: order of elimination of the force equations. It differs from `order` if a constraint has other
            coefficients for forces than for motion.
        shifts: full turns (rad) to be added to the angle that the constraint gives, by name of the link.
    """

    angles: tuple[tuple[int, str], ...]
    origins: tuple[tuple[int, str], ...]
    order: EliminationOrder
    pushing: EliminationOrder
    shifts: Mapping[str, float] = field(default_factory=dict)


def find_explicit_order(constraints: Sequence[PairConstraint], links: Sequence[str]) -> ExplicitOrder:
    """Find an order of the unknowns of a group in which as many as possible follow from single equations.

    Args:
        constraints: constraint equations of the group.
        links: links of the group.
    """
    alike = {n for n, c in enumerate(constraints) if type(c).pushes is PairConstraint.pushes}
    angle_links = {n: [link for link in _links_with_angles(c) if link in links] for n, c in enumerate(constraints)}
    angles, origins, order = _order_unknowns(constraints, links, angle_links)
    pushing = order
    if len(alike) < len(constraints):
        pushing = _order_unknowns(constraints, links, {n: angle_links[n] for n in alike})[2]
    return ExplicitOrder(angles, origins, order, pushing)


Explicit = tuple[tuple[int, str], ...]


def _order_unknowns(
    constraints: Sequence[PairConstraint], links: Sequence[str], turning: dict[int, list[str]]
) -> tuple[Explicit, Explicit, EliminationOrder]:
    """Find explicit angles, explicit origins and the order of elimination.

    turning: links whose angles occur in each constraint that may give an angle explicitly, by index of the constraint.
    """
    order = {link: k for k, link in enumerate(links)}
    first = [sum(len(c.lengths) for c in constraints[:n]) for n in range(len(constraints))]
    busy = {link: sum(link in c.links for c in constraints) for link in links}
    hinges = {
        n: [link for link in c.links if link in order]
        for n, c in enumerate(constraints)
        if isinstance(c, HingeConstraint)
    }
    angles, free = _assign_rows(turning, links, busy)
    origins, loose = _assign_rows(hinges, links, busy)
    explicit = [(first[n], 3 * order[link] + 2) for n, link in angles]
    for n, link in origins:
        explicit += [(first[n], 3 * order[link]), (first[n] + 1, 3 * order[link] + 1)]
    rows = sum(len(c.lengths) for c in constraints)
    closing = tuple(row for row in range(rows) if row not in {row for row, _ in explicit})
    columns = (
        *(3 * order[link] + coordinate for link in loose for coordinate in (0, 1)),
        *(3 * order[link] + 2 for link in free),
    )
    return tuple(angles), tuple(origins), EliminationOrder(tuple(explicit), closing, columns)


def _links_with_angles(constraint: PairConstraint) -> tuple[str, ...]:
    """Return the links whose angles the first row of a constraint relates; empty if it relates other quantities."""
    if constraint.kind not in GIVE_ANGLES or constraint.lengths[0]:
        return ()
    return constraint.links


def _assign_rows(
    rows: dict[int, list[str]], links: Sequence[str], busy: Mapping[str, int]
) -> tuple[list[tuple[int, str]], list[str]]:
    """Assign to each link, one after another, an equation (row) that determines it.

    Where every row has more than one undetermined link, the link with most constraints is left free: Newton's method
    solves for it.

    Returns:
        The assignments (row, link), and the links that are left free.
    """
    assigned: list[tuple[int, str]] = []
    free: list[str] = []
    left, rows = list(links), dict(rows)
    while left:
        ready = next((n for n, row_links in rows.items() if sum(link in left for link in row_links) == 1), None)
        if ready is not None:
            link = next(link for link in rows.pop(ready) if link in left)
            assigned.append((ready, link))
        else:
            open_ones = {link for row_links in rows.values() for link in row_links if link in left} or set(left)
            link = max(
                (candidate for candidate in left if candidate in open_ones), key=lambda candidate: busy[candidate]
            )
            free.append(link)
        left.remove(link)
    return assigned, free


# Newton's method on the free unknowns.


STEPS = 1  # from tabulated initial guesses


class NotUnrolledError(ValueError):
    """The group cannot be solved by UnrolledNewton.

    It has more equations than unknowns, or no trace that gives initial guesses.
    """


@dataclass(frozen=True)
class UnrolledNewton(NewtonSolver):
    """Newton's method for the free unknowns of a group, those that do not follow explicitly from single equations.

    Attributes:
        closure: explicit unknowns and order of elimination.
        starts: initial guesses of the free unknowns (m, rad), arrays over positions.
        steps: number of Newton steps.
        enough: convergence tolerance of the last step; lengths divided by the size of the group, angles in rad.
    """

    closure: ExplicitOrder | None = None
    starts: tuple[Any, ...] = ()
    steps: int = STEPS
    enough: float = LAST_STEP

    @classmethod
    def from_newton(
        cls, kernel: NewtonSolver, poses: Poses, drives: DriverStates, geared: Container[str] = ()
    ) -> UnrolledNewton:
        """Convert a solver that iterates by Newton's method to one with a fixed number of steps.

        Args:
            kernel: the solver.
            poses: poses of the known links in the sketch.
            drives: coordinates of the drivers in the sketch.
            geared: links whose full turns matter to gears.

        Raises:
            NotUnrolledError: the solver cannot be converted.
        """
        rows = sum(len(c.lengths) for c in kernel.constraints)
        if kernel.passive or kernel.start is None or rows != 3 * len(kernel.group.links):
            raise NotUnrolledError
        closure = find_explicit_order(kernel.constraints, kernel.group.links)
        unrolled = cls(
            kernel.group,
            kernel.size,
            kernel.constraints,
            kernel.start,
            kernel.trace,
            kernel.passive,
            kernel.order,
            closure,
        )
        if kernel.trace is None and not unrolled.linear:
            raise NotUnrolledError
        for number, link in closure.angles:
            known = [name for name in kernel.constraints[number].links if name not in kernel.order]
            if link in geared and any(poses[name].unwrapped is None for name in known):
                raise NotUnrolledError
        return replace(unrolled, closure=replace(closure, shifts=unrolled._shifts(poses, drives)))

    def rebind(self, linkage: Linkage) -> UnrolledNewton:
        new = NewtonSolver.of(self.group.rebind(linkage), linkage)
        return replace(self, group=new.group, size=new.size, constraints=new.constraints)

    @property
    def closed_by(self) -> ExplicitOrder:
        """Explicit unknowns and order of elimination."""
        assert self.closure is not None
        return self.closure

    @property
    def free(self) -> tuple[int, ...]:
        """Numbers of the free unknowns. The link with index k has 3k, 3k + 1 and 3k + 2 for x, y and the angle."""
        return self.closed_by.order.free

    @cached_property
    def linear(self) -> bool:
        """True if the equations of the free unknowns are linear, so that one step solves them."""
        return all(column % 3 < 2 for column in self.free)

    @cached_property
    def lengths(self) -> list[bool]:
        """For each constraint equation, True if it is in metres."""
        return [length for c in self.constraints for length in c.lengths]

    def values(self, states: Sequence[Any]) -> list[Any]:
        """Select the free unknowns from a list of x, y and angle of all links."""
        return [states[column] for column in self.free]

    def _shifts(self, poses: Poses, drives: DriverStates) -> dict[str, float]:
        assert self.start is not None
        angles = {name: float(np.ravel(pose.turned)[0]) for name, pose in poses.items()}
        angles |= {link: float(self.start.unwrapped[0, k]) for link, k in self.order.items()}
        shifts = {}
        for number, link in self.closed_by.angles:
            angle = self.constraints[number].turned(link, angles, drives)
            assert angle is not None
            shifts[link] = 2 * np.pi * float(np.round((angles[link] - float(np.ravel(angle)[0])) / (2 * np.pi)))
        return shifts

    def posed(self, free: Mapping[int, Any], poses: Poses, drives: DriverStates) -> dict[str, Pose]:
        """Compute the poses of all links from values of the free unknowns."""
        angles: dict[str, Any] = _AnglesOfLinks(poses)
        names = self.group.links
        angles.update({names[k // 3]: value for k, value in free.items() if k % 3 == 2})
        for number, link in self.closed_by.angles:
            angle: Any = self.constraints[number].turned(link, angles, drives)
            angles[link] = angle + self.closed_by.shifts[link]
        turned = {link: unit(angles[link]) for link in names}
        link_poses: dict[str, Pose] = dict(poses)
        for k, link in enumerate(names):
            if 3 * k in free:
                link_poses[link] = Pose(free[3 * k] + 1j * free[3 * k + 1], turned[link], angles[link])
        for number, link in self.closed_by.origins:
            pair = self.constraints[number]
            assert isinstance(pair, HingeConstraint)
            other, on_other, on_link = (
                (pair.i, pair.at_i, pair.at_j) if link == pair.j else (pair.j, pair.at_j, pair.at_i)
            )
            link_poses[link] = Pose(link_poses[other].at(on_other) - on_link * turned[link], turned[link], angles[link])
        return link_poses

    def rows(self, parts: Sequence[Mapping[str, Sequence[JacobianRow]]]) -> list[EquationRow]:
        """Arrange the coefficients of all constraints in rows of linear equations. Lengths are not scaled."""
        all_rows: list[dict[int, Any]] = []
        for constraint, of_links in zip(self.constraints, parts, strict=True):
            pair_rows: list[dict[int, Any]] = [{} for _ in constraint.lengths]
            for link, lines in of_links.items():
                if link in self.order:
                    for row, (c, m) in zip(pair_rows, lines, strict=True):
                        for coordinate, value in enumerate((c.real, c.imag, m)):
                            plain = isinstance(c if coordinate < 2 else value, complex | float)
                            if not plain or value:
                                row[3 * self.order[link] + coordinate] = value
            all_rows += pair_rows
        return list(all_rows)

    def eliminated(
        self, parts: Sequence[Mapping[str, Sequence[JacobianRow]]], order: EliminationOrder
    ) -> EliminatedSystem:
        """Eliminate the explicit unknowns from the linear equations, and make the remaining equations triangular."""
        mixed = len({self.lengths[row] for row in order.closing}) > 1 or len({k % 3 == 2 for k in order.free}) > 1
        scales = None
        if mixed:
            down = [1 / self.size if length else 1.0 for length in self.lengths]
            scales = down, [1.0 if k % 3 == 2 else self.size for k in range(3 * len(self.group.links))]
        return EliminatedSystem(self.rows(parts), order, scales)

    def _newton_step(self, free: Mapping[int, Any], poses: Poses, drives: DriverStates) -> dict[int, Any]:
        """Compute one Newton step of the free unknowns."""
        everything = self.posed(free, poses, drives)
        short = [value for c in self.constraints for value in c.residuals(everything, drives)]
        by = self.eliminated(self._rows(everything), self.closed_by.order)
        return by.free([-short[row] for row in self.closed_by.order.closing])

    def place(self, poses: Poses, q: Real, drives: DriverStates) -> Placement:
        starts = self.starts or tuple(np.zeros(np.shape(q)) for _ in self.free)
        free = dict(zip(self.free, starts, strict=True))
        step_size: Any = np.zeros(np.shape(q))
        for _ in range(self.steps if self.free else 0):
            step = self._newton_step(free, poses, drives)
            free = {k: free[k] + step[k] for k in self.free}
            step_size = reduce(
                np.maximum, [np.abs(value / self.size if k % 3 < 2 else value) for k, value in step.items()]
            )
        everything = self.posed(free, poses, drives)
        rows = self._rows(everything)
        own_poses = tuple(everything[link] for link in self.group.links)
        diagonal = self.eliminated(rows, self.closed_by.order).diagonal
        det = reduce(np.multiply, diagonal, 1.0 + np.zeros(np.shape(q)))
        sharp: Any = 1.0
        if diagonal:
            sizes = [np.abs(value) for value in diagonal]
            sharp = reduce(np.minimum, sizes) / reduce(np.maximum, sizes)
        sure = (sharp > NEAR_SINGULAR) & ((step_size < self.enough) | self.linear)
        margin = singular_margin(self.rows(rows), self.lengths, self.size)
        residual = np.where(sure, -1.0, 1.0) * self.size
        return Placement(own_poses, det, margin, residual, np.zeros(np.shape(q)))

    def rates_at(
        self, everything: Poses, matrix: Any, det: Real, rates: Rates, drives: DriverStates
    ) -> tuple[Rate, ...]:
        right = self._right_sides(everything, {name: (rate.v, rate.w) for name, rate in rates.items()}, drives, 1)
        return tuple(Rate(v, w) for v, w in _split_by_link(matrix.solve(right)))

    def accelerations_at(
        self, everything: Poses, matrix: Any, det: Real, rates: Rates, accels: Accels, drives: DriverStates
    ) -> tuple[Accel, ...]:
        right = self._right_sides(everything, {name: (accel.a, accel.e) for name, accel in accels.items()}, drives, 2)
        bend = self.velocity_terms(everything, rates)
        solution = matrix.solve([value - term for value, term in zip(right, bend, strict=True)])
        return tuple(Accel(a, e) for a, e in _split_by_link(solution))

    def matrix(self, poses: Poses) -> Any:
        return self.eliminated(self._rows(poses), self.closed_by.order)

    def _right_sides(
        self, poses: Poses, motion: Mapping[str, tuple[Any, Any]], drives: DriverStates, order: int
    ) -> list[Any]:
        """Return the right-hand sides of the velocity (order 1) or acceleration (order 2) equations, in SI units.

        They are the derivatives that drivers prescribe less the contributions of the known links.
        """
        right_sides = []
        for constraint in self.constraints:
            total = list(constraint.asked(drives, order))
            if any(link not in self.order for link in constraint.links):
                for link, lines in constraint.jacobian_rows(poses).items():
                    if link not in self.order:
                        v, w = motion[link]
                        total = [t - (dot(c, v) + m * w) for t, (c, m) in zip(total, lines, strict=True)]
            right_sides += total
        return right_sides

    def _transposed(self, at: Placement, everything: Poses) -> Callable[[Sequence[Wrench]], list[Any]]:
        by = self.eliminated([c.pushes(everything) for c in self.constraints], self.closed_by.pushing)

        def under(wrenches: Sequence[Wrench]) -> list[Any]:
            borne = [
                component for wrench in wrenches for component in (wrench.force.real, wrench.force.imag, wrench.moment)
            ]
            return by.transposed([-value for value in borne])

        return under


class _AnglesOfLinks(dict[str, Any]):
    """Angles of links by name. The angle of a known link is computed from its pose when it is first read."""

    def __init__(self, poses: Poses) -> None:
        super().__init__()
        self.poses = poses

    def __missing__(self, link: str) -> Any:
        self[link] = self.poses[link].turned
        return self[link]


def _split_by_link(unknowns: Sequence[Any]) -> Iterator[tuple[Any, Any]]:
    """Split a list of unknowns into complex origin and angle of each link."""
    for k in range(0, len(unknowns), 3):
        yield unknowns[k] + 1j * unknowns[k + 1], unknowns[k + 2]
