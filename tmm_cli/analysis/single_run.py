"""A single run of a mechanism with its loads: a press that works once, a cylinder that lifts, starting and stopping."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tmm_cli.analysis.mechanism import Mechanism
from tmm_cli.analysis.running import reduced_between
from tmm_cli.double_double import rounded
from tmm_cli.dynamics.reduced import Reduced
from tmm_cli.dynamics.run import Run, acceleration, run
from tmm_cli.dynamics.task import RunTask
from tmm_cli.errors import OutOfRangeError
from tmm_cli.tolerances import SAME_PLACE
from tmm_cli.vectors import Real


@dataclass(frozen=True, eq=False)
class SingleRun:
    """A run from the driver's place `first` on (rad, or m), and the law of motion that it is.

    task: its drive is positive along the run.

    turn: after how much a crank is at the same place again, 2 pi; None of what does not turn fully.
    """

    task: RunTask
    machine: Reduced
    run: Run
    first: float
    sense: int
    turn: float | None

    def evenly(self, count: int) -> Real:
        """Places of the driver, from the beginning of the run to its end."""
        return self.first + self.sense * np.linspace(0, float(self.run.way[-1]), count)

    def way(self, q: Real) -> Real:
        """How far the driver has gone at its place q."""
        gone: Real = self.sense * (rounded(q) - self.first)
        again = gone if self.turn is None else np.mod(gone + SAME_PLACE, self.turn) - SAME_PLACE
        gone = np.where((gone < -SAME_PLACE) | (gone > self.machine.length + SAME_PLACE), again, gone)
        return np.clip(gone, 0.0, None) if self.turn else np.where(np.abs(gone) < SAME_PLACE, 0.0, gone)

    def driving(self, way: Real, speed: Real, accelerated: Real) -> Real:
        """Moment (N m), or force, of what drives, where the driver moves like that on its way."""
        machine = self.machine
        own = (self.task.flywheel + machine.inertia(way)) * accelerated + machine.slope(way) * speed**2 / 2
        found: Real = own + self.task.brake - machine.moment(way)
        return found

    def speed(self, q: Real) -> Real:
        """rad/s, or m/s, with its sign; nan where the run does not come."""
        return self.sense * self.run.at(self.way(q))[1]

    def time(self, q: Real) -> Real:
        """s, since the beginning; nan where the run does not come."""
        return self.run.at(self.way(q))[0]

    def kinetic(self, q: Real) -> Real:
        """Kinetic energy, J; nan where the run does not come."""
        return self.energy(self.way(q), self.speed(q))

    def energy(self, way: Real, speed: Real) -> Real:
        """Kinetic energy of such a way and speed of the driver, J."""
        found: Real = (self.task.flywheel + self.machine.inertia(way)) * speed**2 / 2
        return found

    def acceleration(self, time: Real, way: Real, speed: Real) -> Real:
        """Of the driver, at such times, ways and speeds in its sense."""
        return acceleration(self.machine, self.task, time, way, speed)

    def accelerated(self, q: Real) -> Real:
        """rad/s2, or m/s2, with its sign; nan where the run does not come."""
        way = self.way(q)
        time, speed = self.run.at(way)
        return self.sense * self.acceleration(time, way, speed)


def single_run(mechanism: Mechanism, asked: Real, task: RunTask) -> SingleRun:
    """Between the places of the task, or of the first and the last position asked for.

    Raises NoCycleError, OutOfRangeError, StandstillError.
    """
    first, last = (float(asked[k]) if end is None else end for k, end in ((0, task.first), (-1, task.last)))
    whole = mechanism.driver_range
    if not whole.full and not all(whole.start - SAME_PLACE <= end <= whole.end + SAME_PLACE for end in (first, last)):
        raise OutOfRangeError(whole.start, whole.end)
    sense = 1 if last > first else -1
    machine = reduced_between(mechanism, first, sense, abs(last - first))
    task = task.along(sense)
    turn = 2 * np.pi if whole.full and mechanism.linkage.driver.kind == "turn" else None
    return SingleRun(task, machine, run(machine, task), first, sense, turn)
