"""Common input and output of the methods that are compared."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from tmm_cli.mechanics.assembly import assemble
from tmm_cli.mechanics.forces import AppliedLoad, Reactions, collect_loads
from tmm_cli.mechanics.groups import Accel, DriverMotion, GroupSolver, Pose, Rate, Wrench, drives_at, link_extent
from tmm_cli.mechanics.kinematics import Motion, Strokes
from tmm_cli.mechanics.linkage import Linkage
from tmm_cli.mechanics.numerics import Real, Vector, cross
from tmm_cli.mechanics.structure import Structure, analyse_structure

Compared = Literal["positions", "velocities", "accelerations", "reactions", "balancing"]
QUANTITIES: tuple[Compared, ...] = ("positions", "velocities", "accelerations", "reactions", "balancing")


class UnsupportedLinkageError(Exception):
    """Raised by a method that cannot compute a linkage; the message says why."""


@dataclass(frozen=True, eq=False)
class Case:
    """Input of a method: an assembled linkage with its driver; lower pairs only.

    Attributes:
        name: name of the linkage.
        linkage: the linkage.
        structure: its Assur groups and pairs.
        kernels: solvers of its groups.
        start: driver coordinate at t = 0, rad or m.
        strokes: strokes of the output; required if loads act in working strokes only.
    """

    name: str
    linkage: Linkage
    structure: Structure
    kernels: tuple[GroupSolver, ...]
    start: float = 0.0
    strokes: Strokes | None = None

    @classmethod
    def of(cls, linkage: Linkage, name: str = "", start: float = 0.0, strokes: Strokes | None = None) -> Case:
        """Assemble a linkage as its sketch shows it. Raises the errors of `assemble`."""
        structure = analyse_structure(linkage)
        return cls(name, linkage, structure, assemble(linkage, structure), start, strokes)

    @property
    def law(self) -> DriverMotion:
        driver = self.linkage.driver
        return DriverMotion(self.start, driver.rate, driver.acceleration, driver.sense)

    @cached_property
    def size(self) -> float:
        """Size of the linkage (m): the largest distance between two points of one link."""
        return max(link_extent(self.linkage, link) for link in self.linkage.links) or 1.0

    def motion(
        self, q: Real, poses: Mapping[str, Pose], first: Mapping[str, Rate], second: Mapping[str, Accel]
    ) -> Motion:
        """Build the motion from the poses of all links and their derivatives.

        Args:
            q: Driver coordinates.
            poses: Poses of the links.
            first, second: First and second derivatives of the poses with respect to q.
        """
        law, every = self.law, np.ones(np.shape(q), dtype=bool)
        acceleration = np.full(np.shape(q), float(law.sense * law.acceleration))
        return Motion(
            self.linkage,
            (),
            q,
            poses,
            first,
            second,
            (),
            every,
            every,
            drives=drives_at(self.linkage, q),
            time=law.time(q),
            rate=law.speed(q),
            acceleration=acceleration,
            law=law,
        )

    def loads(self, motion: Motion) -> tuple[AppliedLoad, ...]:
        """Return all forces and moments on the links except reactions: loads, weights, inertia forces."""
        return collect_loads(motion, self.strokes)

    def wrenches(self, motion: Motion) -> dict[str, Wrench]:
        """Return the resultant force on each link and its resultant moment about the origin of the link, without
        reactions.
        """
        nothing = np.zeros(np.shape(motion.q))
        on = {name: Wrench(nothing + 0j, nothing) for name in self.linkage.links}
        for load in self.loads(motion):
            arm = load.at * motion.poses[load.link].z
            on[load.link] += Wrench(load.force, cross(arm, load.force) + load.moment)
        return on


@dataclass(frozen=True)
class MethodAnswers:
    """Results of a method at all positions, SI; None for a quantity that it does not compute.

    Attributes:
        positions, velocities, accelerations: vectors of the moving points by name, (positions,).
        reactions: force on the second link of each pair, by the name of the pair, (positions,).
        balancing: balancing moment or force of the first driver, (positions,).
    """

    positions: Mapping[str, Vector] | None = None
    velocities: Mapping[str, Vector] | None = None
    accelerations: Mapping[str, Vector] | None = None
    reactions: Mapping[str, Vector] | None = None
    balancing: Real | None = None

    def series(self, quantity: Compared) -> Mapping[str, Vector] | None:
        """Return the values of one quantity by the name of the point or pair; None if it is not computed.

        The balancing moment is returned under the name "balancing".
        """
        values = getattr(self, quantity)
        return {quantity: values} if quantity == "balancing" and values is not None else values


@dataclass(frozen=True)
class Method:
    """A method of computation that is compared with others.

    Attributes:
        name: name of the method.
        family: name shared by methods that differ in one setting.
        prepare: called once for a linkage; returns a function of the driver coordinates.
        setting: value of the setting, e.g. the tolerance; None if there is none.
        timed: False if its time is not meaningful, as for the drawing board.
        alone: for another program, a function like `prepare` that does not convert the results of the program, so that
            its own computation is timed.
    """

    name: str
    family: str
    prepare: Callable[[Case], Callable[[Real], MethodAnswers]]
    setting: float | None = None
    timed: bool = True
    alone: Callable[[Case], Callable[[Real], object]] | None = None

    def solve(self, case: Case, q: Real) -> MethodAnswers:
        """Prepare the method for a linkage and compute the linkage at driver coordinates q."""
        return self.prepare(case)(np.atleast_1d(np.asarray(q)))


def build_answers(
    case: Case, motion: Motion, reactions: Mapping[str, Vector] | None, balancing: Real | None
) -> MethodAnswers:
    """Return the results of a method from a motion and separately computed reactions and balancing moments."""
    points = {name: motion.named(name) for name in case.linkage.moving_points}
    return MethodAnswers(
        {name: point.x for name, point in points.items()},
        {name: point.v for name, point in points.items()},
        {name: point.a for name, point in points.items()},
        reactions,
        balancing,
    )


def build_answers_from_forces(case: Case, motion: Motion, plan: Reactions) -> MethodAnswers:
    """Return the results of a method from a motion and its force analysis."""
    forces = {r.pair.name: r.onto(r.pair.j) for r in plan.all}
    return build_answers(case, motion, forces, plan.balance.generalized)


def relative_errors(
    computed: MethodAnswers, exact: MethodAnswers, quantities: Iterable[Compared] = QUANTITIES
) -> dict[Compared, float]:
    """Return the largest relative error of each quantity over all positions.

    Errors are relative to the largest value at the same point or pair. The result is nan for a quantity that is not
    computed, and infinite if the method fails (nan) at some position.
    """
    worst: dict[Compared, float] = {}
    for quantity in quantities:
        mine, true = computed.series(quantity), exact.series(quantity)
        if mine is None or true is None:
            worst[quantity] = float("nan")
            continue
        names = [name for name in true if name in mine]
        off = [float(np.max(np.abs(mine[n] - true[n])) / np.max(np.abs(true[n]))) for n in names]
        worst[quantity] = max((e if np.isfinite(e) else float("inf") for e in off), default=float("nan"))
    return worst
