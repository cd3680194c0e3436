"""What every method is given, and what it gives back: the common form in which methods are measured side by side."""

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
    """A method has no way to compute this linkage."""


@dataclass(frozen=True, eq=False)
class Case:
    """A linkage that is assembled, and how it is driven; lower pairs only.

    start: the driver's place at t = 0 (rad or m); strokes: needed where loads act on working strokes only.
    """

    name: str
    linkage: Linkage
    structure: Structure
    kernels: tuple[GroupSolver, ...]
    start: float = 0.0
    strokes: Strokes | None = None

    @classmethod
    def of(cls, linkage: Linkage, name: str = "", start: float = 0.0, strokes: Strokes | None = None) -> Case:
        """A linkage assembled as its sketch shows it. Raises what assembly raises."""
        structure = analyse_structure(linkage)
        return cls(name, linkage, structure, assemble(linkage, structure), start, strokes)

    @property
    def law(self) -> DriverMotion:
        driver = self.linkage.driver
        return DriverMotion(self.start, driver.rate, driver.acceleration, driver.sense)

    @cached_property
    def size(self) -> float:
        """The farthest two points of one link, m: what gaps of length are measured against."""
        return max(link_extent(self.linkage, link) for link in self.linkage.links) or 1.0

    def motion(
        self, q: Real, poses: Mapping[str, Pose], first: Mapping[str, Rate], second: Mapping[str, Accel]
    ) -> Motion:
        """A motion from the states of all links, whatever found them; first and second are derivatives by q."""
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
        )

    def loads(self, motion: Motion) -> tuple[AppliedLoad, ...]:
        """All that acts on the links of a motion besides reactions."""
        return collect_loads(motion, self.strokes)

    def wrenches(self, motion: Motion) -> dict[str, Wrench]:
        """The same, added up about the origin of each link."""
        nothing = np.zeros(np.shape(motion.q))
        on = {name: Wrench(nothing + 0j, nothing) for name in self.linkage.links}
        for load in self.loads(motion):
            arm = load.at * motion.poses[load.link].z
            on[load.link] += Wrench(load.force, cross(arm, load.force) + load.moment)
        return on


@dataclass(frozen=True)
class MethodAnswers:
    """What a method found at every position, SI; None is what it does not give.

    positions (m), velocities (m/s), accelerations (m/s2) of moving points by their names; reactions (N) on the second
    link of each pair by its name; balancing moment (N m) or force (N) of the first driver. Arrays are (positions,).
    """

    positions: Mapping[str, Vector] | None = None
    velocities: Mapping[str, Vector] | None = None
    accelerations: Mapping[str, Vector] | None = None
    reactions: Mapping[str, Vector] | None = None
    balancing: Real | None = None

    def series(self, quantity: Compared) -> Mapping[str, Vector] | None:
        """One quantity by name; the balancing moment under the name of its quantity."""
        found = getattr(self, quantity)
        return {quantity: found} if quantity == "balancing" and found is not None else found


@dataclass(frozen=True)
class Method:
    """A way to compute a case. `prepare` does what is done once a linkage and gives what is done at places q.

    family: methods that differ in one setting only; timed: whether its time means anything; alone: of another program
    its own call, without what puts its answers into the common form.
    """

    name: str
    family: str
    prepare: Callable[[Case], Callable[[Real], MethodAnswers]]
    setting: float | None = None
    timed: bool = True
    alone: Callable[[Case], Callable[[Real], object]] | None = None

    def solve(self, case: Case, q: Real) -> MethodAnswers:
        """All in one."""
        return self.prepare(case)(np.atleast_1d(np.asarray(q)))


def answers_of_motion(
    case: Case, motion: Motion, reactions: Mapping[str, Vector] | None, balancing: Real | None
) -> MethodAnswers:
    """The answers that a motion holds, with forces found from it."""
    points = {name: motion.named(name) for name in case.linkage.moving_points}
    return MethodAnswers(
        {name: point.x for name, point in points.items()},
        {name: point.v for name, point in points.items()},
        {name: point.a for name, point in points.items()},
        reactions,
        balancing,
    )


def answers_of_plan(case: Case, motion: Motion, plan: Reactions) -> MethodAnswers:
    """The answers that a motion and its force plan hold."""
    forces = {r.pair.name: r.onto(r.pair.j) for r in plan.all}
    return answers_of_motion(case, motion, forces, plan.balance.generalized)


def relative_errors(
    found: MethodAnswers, exact: MethodAnswers, quantities: Iterable[Compared] = QUANTITIES
) -> dict[Compared, float]:
    """The largest error of each quantity over the largest value of the same point or pair in the cycle; nan: not given.

    Errors of a method that fails somewhere (nan) are infinite.
    """
    worst: dict[Compared, float] = {}
    for quantity in quantities:
        mine, true = found.series(quantity), exact.series(quantity)
        if mine is None or true is None:
            worst[quantity] = float("nan")
            continue
        names = [name for name in true if name in mine]
        off = [float(np.max(np.abs(mine[n] - true[n])) / np.max(np.abs(true[n]))) for n in names]
        worst[quantity] = max((e if np.isfinite(e) else float("inf") for e in off), default=float("nan"))
    return worst
