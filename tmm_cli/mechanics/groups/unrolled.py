"""What follows from what in the equations of a group's pairs: angles from angles, then origins from angles."""

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

GIVE_ANGLES = "PGD"  # kinds of constraints whose first row may give an angle from others


@dataclass(frozen=True)
class ExplicitOrder:
    """Explicit angles and origins as (number of the constraint, link), in their order, and the order of elimination.

    An unknown is three times the number of its link, and 0, 1 or 2 more for x, y and the angle. shifts: whole turns
    (rad) by which the angle of a link lies beyond what its constraint gives. pushing: order of the equations of forces,
    where some constraint pushes otherwise than it moves.
    """

    angles: tuple[tuple[int, str], ...]
    origins: tuple[tuple[int, str], ...]
    order: EliminationOrder
    pushing: EliminationOrder
    shifts: Mapping[str, float] = field(default_factory=dict)


def find_explicit_order(constraints: Sequence[PairConstraint], links: Sequence[str]) -> ExplicitOrder:
    """Of constraints on some links; as many unknowns as can be are explicit."""
    alike = {n for n, c in enumerate(constraints) if type(c).pushes is PairConstraint.pushes}
    own = {n: [link for link in _links_with_angles(c) if link in links] for n, c in enumerate(constraints)}
    angles, origins, order = _order_unknowns(constraints, links, own)
    pushing = order
    if len(alike) < len(constraints):
        pushing = _order_unknowns(constraints, links, {n: own[n] for n in alike})[2]
    return ExplicitOrder(angles, origins, order, pushing)


Explicit = tuple[tuple[int, str], ...]


def _order_unknowns(
    constraints: Sequence[PairConstraint], links: Sequence[str], turning: dict[int, list[str]]
) -> tuple[Explicit, Explicit, EliminationOrder]:
    """Explicit angles, those that constraints with these links may give, and origins; and their order."""
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
    columns = (*(3 * order[link] + part for link in loose for part in (0, 1)), *(3 * order[link] + 2 for link in free))
    return tuple(angles), tuple(origins), EliminationOrder(tuple(explicit), closing, columns)


def _links_with_angles(constraint: PairConstraint) -> tuple[str, ...]:
    """Links whose angles are in the first row of a constraint that may give one of them."""
    if constraint.kind not in GIVE_ANGLES or constraint.lengths[0]:
        return ()
    return constraint.links


def _assign_rows(
    rows: dict[int, list[str]], links: Sequence[str], busy: Mapping[str, int]
) -> tuple[list[tuple[int, str]], list[str]]:
    """Which rows, of links that are not known, give which link, in their order; and links that none gives.

    Where no row has one link alone that is not given yet, the busiest link of one is left free.
    """
    found: list[tuple[int, str]] = []
    free: list[str] = []
    left, rows = list(links), dict(rows)
    while left:
        ready = next((n for n, own in rows.items() if sum(link in left for link in own) == 1), None)
        if ready is not None:
            link = next(link for link in rows.pop(ready) if link in left)
            found.append((ready, link))
        else:
            open_ones = {link for own in rows.values() for link in own if link in left} or set(left)
            link = max((one for one in left if one in open_ones), key=lambda one: busy[one])
            free.append(link)
        left.remove(link)
    return found, free


# Newton's method as straight-line arithmetic: for tapes, and many positions at once.
#
# The same equations as in newton.py, with every coefficient an array of its own. Angles that a pair gives from
# others, and origins that a hinge gives from angles, are written down at once, so that few unknowns are left (two,
# after thin columns are turned away, of a group of class III); these get a fixed number of steps from given starts.
# Whether that was enough is told by `doubt`, for all positions at once; where it was not, the group has to be found
# by newton.py.


STEPS = 1  # from starts that are read from a table


class NotUnrolledError(ValueError):
    """The group cannot be written so: more equations than unknowns, or nothing is known of where it goes."""


@dataclass(frozen=True)
class UnrolledNewton(NewtonSolver):
    """A group so. starts: of its free unknowns (m, rad), arrays over positions; steps: of Newton's method.

    enough: it has closed where the last of these was less (sizes of the group, rad).
    """

    closure: ExplicitOrder | None = None
    starts: tuple[Any, ...] = ()
    steps: int = STEPS
    enough: float = LAST_STEP

    @classmethod
    def from_newton(
        cls, kernel: NewtonSolver, poses: Poses, drives: DriverStates, geared: Container[str] = ()
    ) -> UnrolledNewton:
        """The same group; poses and drives: at the sketch; geared: links whose whole turns count.

        Raises NotUnrolledError.
        """
        rows = sum(len(c.lengths) for c in kernel.constraints)
        if kernel.passive or kernel.start is None or rows != 3 * len(kernel.group.links):
            raise NotUnrolledError
        closure = find_explicit_order(kernel.constraints, kernel.group.links)
        found = cls(
            kernel.group,
            kernel.size,
            kernel.constraints,
            kernel.start,
            kernel.trace,
            kernel.passive,
            kernel.order,
            closure,
        )
        if kernel.trace is None and not found.linear:
            raise NotUnrolledError
        for number, link in closure.angles:
            known = [one for one in kernel.constraints[number].links if one not in kernel.order]
            if link in geared and any(poses[one].unwrapped is None for one in known):
                raise NotUnrolledError
        return replace(found, closure=replace(closure, shifts=found._shifts(poses, drives)))

    def rebind(self, linkage: Linkage) -> UnrolledNewton:
        new = NewtonSolver.of(self.group.rebind(linkage), linkage)
        return replace(self, group=new.group, size=new.size, constraints=new.constraints)

    @property
    def closed_by(self) -> ExplicitOrder:
        """How it is written."""
        assert self.closure is not None
        return self.closure

    @property
    def free(self) -> tuple[int, ...]:
        """Free unknowns: three times the number of a link, and 0, 1 or 2 for x, y or the angle."""
        return self.closed_by.order.free

    @cached_property
    def linear(self) -> bool:
        """Whether one step from anywhere closes it."""
        return all(column % 3 < 2 for column in self.free)

    @cached_property
    def lengths(self) -> list[bool]:
        """For each row, whether it is in metres."""
        return [length for c in self.constraints for length in c.lengths]

    def values(self, states: Sequence[Any]) -> list[Any]:
        """Of free unknowns from the three unknowns x, y and angle of all links, one after another."""
        return [states[column] for column in self.free]

    def _shifts(self, poses: Poses, drives: DriverStates) -> dict[str, float]:
        assert self.start is not None
        angles = {name: float(np.ravel(pose.turned)[0]) for name, pose in poses.items()}
        angles |= {link: float(self.start.unwrapped[0, k]) for link, k in self.order.items()}
        shifts = {}
        for number, link in self.closed_by.angles:
            given = self.constraints[number].turned(link, angles, drives)
            assert given is not None
            shifts[link] = 2 * np.pi * float(np.round((angles[link] - float(np.ravel(given)[0])) / (2 * np.pi)))
        return shifts

    def posed(self, free: Mapping[int, Any], poses: Poses, drives: DriverStates) -> dict[str, Pose]:
        """All links for values of the free unknowns; explicit equations hold."""
        angles: dict[str, Any] = _AnglesOfLinks(poses)
        names = self.group.links
        angles.update({names[k // 3]: value for k, value in free.items() if k % 3 == 2})
        for number, link in self.closed_by.angles:
            given: Any = self.constraints[number].turned(link, angles, drives)
            angles[link] = given + self.closed_by.shifts[link]
        turned = {link: unit(angles[link]) for link in names}
        found: dict[str, Pose] = dict(poses)
        for k, link in enumerate(names):
            if 3 * k in free:
                found[link] = Pose(free[3 * k] + 1j * free[3 * k + 1], turned[link], angles[link])
        for number, link in self.closed_by.origins:
            pair = self.constraints[number]
            assert isinstance(pair, HingeConstraint)
            other, there, here = (pair.i, pair.at_i, pair.at_j) if link == pair.j else (pair.j, pair.at_j, pair.at_i)
            found[link] = Pose(found[other].at(there) - here * turned[link], turned[link], angles[link])
        return found

    def rows(self, parts: Sequence[Mapping[str, Sequence[JacobianRow]]]) -> list[EquationRow]:
        """Rows of all constraints; lengths are not scaled."""
        found: list[dict[int, Any]] = []
        for constraint, of_links in zip(self.constraints, parts, strict=True):
            own: list[dict[int, Any]] = [{} for _ in constraint.lengths]
            for link, lines in of_links.items():
                if link in self.order:
                    for row, (c, m) in zip(own, lines, strict=True):
                        for part, value in enumerate((c.real, c.imag, m)):
                            plain = isinstance(c if part < 2 else value, complex | float)
                            if not plain or value:
                                row[3 * self.order[link] + part] = value
            found += own
        return list(found)

    def eliminated(
        self, parts: Sequence[Mapping[str, Sequence[JacobianRow]]], order: EliminationOrder
    ) -> EliminatedSystem:
        """The equations of given rows, ready to be solved."""
        mixed = len({self.lengths[row] for row in order.closing}) > 1 or len({k % 3 == 2 for k in order.free}) > 1
        scales = None
        if mixed:
            down = [1 / self.size if length else 1.0 for length in self.lengths]
            scales = down, [1.0 if k % 3 == 2 else self.size for k in range(3 * len(self.group.links))]
        return EliminatedSystem(self.rows(parts), order, scales)

    def _moved(self, free: Mapping[int, Any], poses: Poses, drives: DriverStates) -> dict[int, Any]:
        """A step of Newton's method."""
        everything = self.posed(free, poses, drives)
        short = [value for c in self.constraints for value in c.residuals(everything, drives)]
        by = self.eliminated(self._rows(everything), self.closed_by.order)
        return by.free([-short[row] for row in self.closed_by.order.closing])

    def place(self, poses: Poses, q: Real, drives: DriverStates) -> Placement:
        starts = self.starts or tuple(np.zeros(np.shape(q)) for _ in self.free)
        free = dict(zip(self.free, starts, strict=True))
        size: Any = np.zeros(np.shape(q))
        for _ in range(self.steps if self.free else 0):
            step = self._moved(free, poses, drives)
            free = {k: free[k] + step[k] for k in self.free}
            size = reduce(np.maximum, [np.abs(value / self.size if k % 3 < 2 else value) for k, value in step.items()])
        everything = self.posed(free, poses, drives)
        rows = self._rows(everything)
        own = tuple(everything[link] for link in self.group.links)
        diagonal = self.eliminated(rows, self.closed_by.order).diagonal
        det = reduce(np.multiply, diagonal, 1.0 + np.zeros(np.shape(q)))
        sharp: Any = 1.0
        if diagonal:
            sizes = [np.abs(value) for value in diagonal]
            sharp = reduce(np.minimum, sizes) / reduce(np.maximum, sizes)
        sure = (sharp > NEAR_SINGULAR) & ((size < self.enough) | self.linear)
        margin = singular_margin(self.rows(rows), self.lengths, self.size)
        residual = np.where(sure, -1.0, 1.0) * self.size
        return Placement(own, det, margin, residual, np.zeros(np.shape(q)))

    def rates_at(
        self, everything: Poses, matrix: Any, det: Real, rates: Rates, drives: DriverStates
    ) -> tuple[Rate, ...]:
        right = self._right(everything, {name: (rate.v, rate.w) for name, rate in rates.items()}, drives, 1)
        return tuple(Rate(v, w) for v, w in _split_by_link(matrix.solve(right)))

    def accelerations_at(
        self, everything: Poses, matrix: Any, det: Real, rates: Rates, accels: Accels, drives: DriverStates
    ) -> tuple[Accel, ...]:
        right = self._right(everything, {name: (accel.a, accel.e) for name, accel in accels.items()}, drives, 2)
        bend = self.velocity_terms(everything, rates)
        found = matrix.solve([value - term for value, term in zip(right, bend, strict=True)])
        return tuple(Accel(a, e) for a, e in _split_by_link(found))

    def matrix(self, poses: Poses) -> Any:
        return self.eliminated(self._rows(poses), self.closed_by.order)

    def _right(
        self, poses: Poses, motion: Mapping[str, tuple[Any, Any]], drives: DriverStates, order: int
    ) -> list[Any]:
        """What drivers ask of each row less what the links it hangs on do to it, with dimensions."""
        found = []
        for constraint in self.constraints:
            total = list(constraint.asked(drives, order))
            if any(link not in self.order for link in constraint.links):
                for link, lines in constraint.jacobian_rows(poses).items():
                    if link not in self.order:
                        v, w = motion[link]
                        total = [t - (dot(c, v) + m * w) for t, (c, m) in zip(total, lines, strict=True)]
            found += total
        return found

    def _transposed(self, at: Placement, everything: Poses) -> Callable[[Sequence[Wrench]], list[Any]]:
        by = self.eliminated([c.pushes(everything) for c in self.constraints], self.closed_by.pushing)

        def under(wrenches: Sequence[Wrench]) -> list[Any]:
            borne = [part for one in wrenches for part in (one.force.real, one.force.imag, one.moment)]
            return by.transposed([-value for value in borne])

        return under


class _AnglesOfLinks(dict[str, Any]):
    """Angles of a group's links, and when they are asked for those of the links it hangs on."""

    def __init__(self, poses: Poses) -> None:
        super().__init__()
        self.poses = poses

    def __missing__(self, link: str) -> Any:
        self[link] = self.poses[link].turned
        return self[link]


def _split_by_link(found: Sequence[Any]) -> Iterator[tuple[Any, Any]]:
    """Unknowns by links."""
    for k in range(0, len(found), 3):
        yield found[k] + 1j * found[k + 1], found[k + 2]
