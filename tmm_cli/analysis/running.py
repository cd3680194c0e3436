"""The machine reduced to its driver, and its steady running, from a mechanism with its loads."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from tmm_cli.analysis.jumps import jumps
from tmm_cli.analysis.mechanism import Mechanism
from tmm_cli.double_double import rounded
from tmm_cli.dynamics.reduced import Reduced, reduced
from tmm_cli.dynamics.steady import Steady, steady
from tmm_cli.dynamics.task import SteadyTask
from tmm_cli.errors import BySpeedError, NoCycleError
from tmm_cli.forces.energy import energy, inertias
from tmm_cli.forces.loads import applied
from tmm_cli.groups.sequence import DriverMotion
from tmm_cli.kinematics.motion import move
from tmm_cli.tolerances import CONSTANT_INERTIA, SAME_PLACE, SEAM
from tmm_cli.vectors import Real

CONSTANT_SAMPLES = 97  # positions of a cycle at which the reduced inertia of a link is compared


def reduced_machine(mechanism: Mechanism, start: float) -> Reduced:
    """Over a cycle from the driver's place `start` on (rad), by the way in its sense.

    Raises NoCycleError, BySpeedError.
    """
    linkage, whole = mechanism.linkage, mechanism.driver_range
    if linkage.driver.kind != "turn" or not whole.full:
        raise NoCycleError
    length = 2 * np.pi * whole.turns
    machine = reduced_between(mechanism, start, linkage.driver.sense, length)
    return replace(machine, constant=_constant_inertia(mechanism, start, length))


def _constant_inertia(mechanism: Mechanism, start: float, length: float) -> float:
    """Reduced inertia of the links with a constant speed ratio to the driver over a cycle, kg m2.

    A link counts if its reduced inertia does not change: the crank, gears on the frame, links of parallelograms.
    """
    q = start + mechanism.linkage.driver.sense * np.linspace(0, length, CONSTANT_SAMPLES, endpoint=False)
    motion = move(
        mechanism.linkage, mechanism.kernels, q, DriverMotion(start, 1.0, 0.0, mechanism.linkage.driver.sense)
    )
    inertia = [np.broadcast_to(rounded(own), q.shape) for own, _ in inertias(motion).values()]
    return float(sum(np.mean(own) for own in inertia if np.ptp(own) <= CONSTANT_INERTIA * np.max(own)))


def reduced_between(mechanism: Mechanism, start: float, sense: int, length: float) -> Reduced:
    """Over a way of this length (rad, or m) of the driver from `start` on, in a sense.

    Raises NoCycleError, BySpeedError.
    """
    linkage = mechanism.linkage
    if linkage.others:
        raise NoCycleError
    if linkage.by_speed is not None:
        raise BySpeedError(linkage.by_speed)
    strokes = mechanism.strokes if linkage.by_strokes else None

    def sample(x: Real) -> tuple[Real, Real, Real]:
        motion = move(linkage, mechanism.kernels, start + sense * x, DriverMotion(start, 1.0, 0.0, sense))
        found = energy(motion, applied(motion, strokes), np.zeros(np.shape(x)))
        return found.inertia, sense * found.slope, sense * found.moment

    places = np.array([*jumps(mechanism)]) if linkage.driver.kind == "turn" else np.empty(0)
    inner = np.sort(np.mod(sense * (places - start), 2 * np.pi * mechanism.driver_range.turns))
    inner = inner[np.diff(inner, prepend=-1.0) > SAME_PLACE]
    return reduced(sample, [0.0, *inner[(inner > SAME_PLACE) & (inner < length - SAME_PLACE)], length])


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
        gone = np.mod(self.sense * (rounded(q) - self.start) + SEAM, self.steady.machine.length) - SEAM
        return np.asarray(np.maximum(gone, 0.0))

    def speed(self, q: Real) -> Real:
        """rad/s, with its sign."""
        return self.sense * self.steady.law.speed(self.way(q))

    def accelerated(self, q: Real) -> Real:
        """rad/s2, with its sign."""
        return self.sense * self.steady.law.acceleration(self.way(q))

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

    Raises NoCycleError, BySpeedError, StandstillError, NoFlywheelError.
    """
    return Running(steady(reduced_machine(mechanism, start), task), start, mechanism.linkage.driver.sense)
