"""Input and output of the methods: the common form in which they are compared."""

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


class MethodUnable(Exception):  # noqa: N818 - no error, but what a method says of itself
    """The method cannot compute this linkage."""


@dataclass(frozen=True, eq=False)
class Case:
    """An assembled linkage with its driver; lower pairs only.

    start: driver coordinate at t = 0 (rad or m); strokes: required if loads act in working strokes only.
    """

    name: str
    linkage: Linkage
    structure: Structure
    kernels: tuple[GroupSolver, ...]
    start: float = 0.0
    strokes: Strokes | None = None

    @classmethod
    def of(cls, linkage: Linkage, name: str = "", start: float = 0.0, strokes: Strokes | None = None) -> Case:
        """Assemble a linkage as sketched. Raises the errors of `assemble`."""
        structure = analyse_structure(linkage)
        return cls(name, linkage, structure, assemble(linkage, structure), start, strokes)

    @property
    def law(self) -> DriverMotion:
        driver = self.linkage.driver
        return DriverMotion(self.start, driver.rate, driver.acceleration, driver.sense)

    @cached_property
    def size(self) -> float:
        """Greatest distance of two points of one link, m: the unit of gaps."""
        return max(link_extent(self.linkage, link) for link in self.linkage.links) or 1.0

    def motion(
        self, q: Real, poses: Mapping[str, Pose], first: Mapping[str, Rate], second: Mapping[str, Accel]
    ) -> Motion:
        """Make a motion from the states of all links; first and second are derivatives with respect to q."""
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
        """Return all forces on the links of a motion except reactions."""
        return collect_loads(motion, self.strokes)

    def wrenches(self, motion: Motion) -> dict[str, Wrench]:
        """Return these forces summed about the origin of each link."""
        nothing = np.zeros(np.shape(motion.q))
        on = {name: Wrench(nothing + 0j, nothing) for name in self.linkage.links}
        for load in self.loads(motion):
            arm = load.at * motion.poses[load.link].z
            on[load.link] += Wrench(load.force, cross(arm, load.force) + load.moment)
        return on


@dataclass(frozen=True)
class MethodAnswers:
    """Results of a method at every position, SI; None if it does not compute a quantity. Arrays are (positions,).

    positions (m), velocities (m/s), accelerations (m/s2) of moving points by name; reactions (N) on the second link of
    each pair by name; balancing moment (N m) or force (N) of the first driver.
    """

    positions: Mapping[str, Vector] | None = None
    velocities: Mapping[str, Vector] | None = None
    accelerations: Mapping[str, Vector] | None = None
    reactions: Mapping[str, Vector] | None = None
    balancing: Real | None = None

    def series(self, quantity: Compared) -> Mapping[str, Vector] | None:
        """Return one quantity by name; the balancing moment under the name of its quantity."""
        values = getattr(self, quantity)
        return {quantity: values} if quantity == "balancing" and values is not None else values


@dataclass(frozen=True)
class Method:
    """A method of computation. `prepare` is called once for a linkage and returns a function of q.

    family: name shared by methods that differ in one setting; timed: False if its time has no meaning; alone: call of
    another program without conversion of its results.
    """

    name: str
    family: str
    prepare: Callable[[Case], Callable[[Real], MethodAnswers]]
    setting: float | None = None
    timed: bool = True
    alone: Callable[[Case], Callable[[Real], object]] | None = None

    def solve(self, case: Case, q: Real) -> MethodAnswers:
        """Prepare the case and evaluate it at q."""
        return self.prepare(case)(np.atleast_1d(np.asarray(q)))


def answers_of_motion(
    case: Case, motion: Motion, reactions: Mapping[str, Vector] | None, balancing: Real | None
) -> MethodAnswers:
    """Return the results from a motion and separately computed forces."""
    points = {name: motion.named(name) for name in case.linkage.moving_points}
    return MethodAnswers(
        {name: point.x for name, point in points.items()},
        {name: point.v for name, point in points.items()},
        {name: point.a for name, point in points.items()},
        reactions,
        balancing,
    )


def answers_of_plan(case: Case, motion: Motion, plan: Reactions) -> MethodAnswers:
    """Return the results from a motion and its force plan."""
    forces = {r.pair.name: r.onto(r.pair.j) for r in plan.all}
    return answers_of_motion(case, motion, forces, plan.balance.generalized)


def relative_errors(
    computed: MethodAnswers, exact: MethodAnswers, quantities: Iterable[Compared] = QUANTITIES
) -> dict[Compared, float]:
    """Return the largest error of each quantity relative to the largest value of the same point or pair in the cycle.

    nan if the quantity is not computed; infinite if the method fails in some position (nan).
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
