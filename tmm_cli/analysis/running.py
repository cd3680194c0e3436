"""The machine reduced to its driver, and its steady running, from a mechanism with its loads."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tmm_cli.double_double import rounded
from tmm_cli.dynamics.reduced import Reduced, reduced
from tmm_cli.dynamics.steady import Steady, steady
from tmm_cli.errors import NoCycleError
from tmm_cli.forces.energy import energy
from tmm_cli.forces.loads import applied
from tmm_cli.groups.sequence import DriverMotion
from tmm_cli.kinematics.motion import move
from tmm_cli.tolerances import SAME_PLACE, SEAM
from tmm_cli.vectors import Real

if TYPE_CHECKING:
    from tmm_cli.analysis.mechanism import Mechanism
    from tmm_cli.dynamics.task import SteadyTask


def reduced_machine(mechanism: Mechanism, start: float) -> Reduced:
    """Over a cycle from the driver's place `start` on (rad), by the way in its sense. Raises NoCycleError."""
    linkage, whole = mechanism.linkage, mechanism.driver_range
    if linkage.driver.kind != "turn" or not whole.full:
        raise NoCycleError
    return reduced_between(mechanism, start, linkage.driver.sense, 2 * np.pi * whole.turns)


def reduced_between(mechanism: Mechanism, start: float, sense: int, length: float) -> Reduced:
    """Over a way of this length (rad, or m) of the driver from `start` on, in a sense. Raises NoCycleError."""
    linkage = mechanism.linkage
    if linkage.others:
        raise NoCycleError
    strokes = mechanism.strokes if any(x.working_stroke_only or x.table for x in linkage.loads) else None

    def sample(x: Real) -> tuple[Real, Real, Real]:
        motion = move(linkage, mechanism.kernels, start + sense * x, DriverMotion(start, 1.0, 0.0, sense))
        found = energy(motion, applied(motion, strokes), np.zeros(np.shape(x)))
        return found.inertia, sense * found.slope, sense * found.moment

    jumps = np.array([*_jumps(mechanism)]) if linkage.driver.kind == "turn" else np.empty(0)
    inner = np.mod(sense * (jumps - start), 2 * np.pi * mechanism.driver_range.turns)
    return reduced(sample, [0.0, *inner[(inner > SAME_PLACE) & (inner < length - SAME_PLACE)], length])


def _jumps(mechanism: Mechanism) -> Iterable[float]:
    """Places of the driver (rad) where loads jump, or bend: ends of strokes, rows of tables by the crank."""
    linkage = mechanism.linkage
    sense, turn = linkage.driver.sense, 2 * np.pi
    turns = mechanism.driver_range.turns
    strokes = mechanism.strokes.strokes if mechanism.strokes else ()
    first = strokes[0].start if strokes else linkage.sketch.at
    for stroke in strokes:
        yield from (stroke.start, stroke.start + sense * stroke.length)
    for load in linkage.loads:
        if load.table is not None and load.table.against != "stroke":
            begin = 0.0 if load.table.against == "crank angle" else first
            way = 1 if load.table.against == "crank angle" else sense
            for row in (*load.table.arguments, 0.0):
                yield from (begin + way * row + turn * k for k in range(turns))


@dataclass(frozen=True)
class Running:
    """Steady running of a mechanism, and the law of motion of its driver from the place `start` on (rad)."""

    steady: Steady
    start: float
    sense: int

    @property
    def task(self) -> SteadyTask:
        return self.steady.task

    def way(self, q: Real) -> Real:
        """How far the driver has gone in the cycle at its place q, rad."""
        gone = np.mod(self.sense * (rounded(np.asarray(q)) - self.start) + SEAM, self.steady.machine.length) - SEAM
        return np.asarray(np.maximum(gone, 0.0))

    def speed(self, q: Real) -> Real:
        """rad/s, with its sign."""
        found: Real = self.sense * self.steady.law.speed(self.way(q))
        return found

    def accelerated(self, q: Real) -> Real:
        """rad/s2, with its sign."""
        found: Real = self.sense * self.steady.law.acceleration(self.way(q))
        return found

    def time(self, q: Real) -> Real:
        """s, since the beginning of the cycle."""
        return self.steady.law.time(self.way(q))

    def driving(self, q: Real) -> Real:
        """Moment of what drives, along the sense of the driver, N m."""
        return self.steady.law.driving(self.way(q))

    def work(self, q: Real) -> Real:
        """Of all moments since the beginning of the cycle, J."""
        return self.steady.work(self.way(q))


def running(mechanism: Mechanism, start: float, task: SteadyTask) -> Running:
    """Of a mechanism with its loads, from the driver's place `start` on (rad).

    Raises NoCycleError, StandstillError, NoFlywheelError.
    """
    return Running(steady(reduced_machine(mechanism, start), task), start, mechanism.linkage.driver.sense)
