"""Steady running: driving moment, flywheel for a fluctuation of speed, and the law of motion with it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from tmm_cli.mechanics.dynamics.flywheel import (
    FlywheelSolution,
    Tangent,
    energy_at_mean_speed,
    exact_flywheel,
    find_minimum,
    find_tangent,
    mertsalov_inertia,
    refine_minimum,
    wittenbauer_flywheel,
)
from tmm_cli.mechanics.dynamics.laws_of_motion import MotorCycle, SteadyLaw, constant_moment_law
from tmm_cli.mechanics.dynamics.motors import MotorCharacteristic
from tmm_cli.mechanics.dynamics.reduced_model import PanelCurve, ReducedMachine, fit_curves, reduce_machine
from tmm_cli.mechanics.dynamics.tasks import SteadyTask
from tmm_cli.mechanics.errors import (
    NoCycleError,
    NoFlywheelError,
    NoInertiaError,
    RunawayError,
    SpeedDependentForceError,
    StandstillError,
)
from tmm_cli.mechanics.forces import collect_loads, compute_energy, find_load_jumps, reduced_inertias
from tmm_cli.mechanics.groups import DriverMotion
from tmm_cli.mechanics.kinematics import compute_motion
from tmm_cli.mechanics.numerics import (
    CONSTANT_INERTIA,
    ROUNDOFF,
    SAME_DRIVER_POSITION,
    SEAM,
    Real,
    find_minima,
    find_roots,
    to_float,
)

if TYPE_CHECKING:
    from tmm_cli.mechanics.analysis import Mechanism


STANDSTILL_FLUCTUATION = 2.0  # fluctuation of a machine that stops: the largest possible value
DOUBLINGS = 60  # of the flywheel in the search for an upper bound
FLUCTUATION_TOLERANCE = 1e-12  # relative tolerance of the fluctuation


@dataclass(frozen=True)
class SteadySolution:
    """Steady running of a reduced machine.

    moment: mean driving moment over the cycle (N m, or N). work: work of all moments from the beginning of
    the cycle (J). own: fluctuation with the given flywheel alone, nan if the machine stops then. found: the
    exact flywheel, given one included. wittenbauer: its inertia by the tangents of a course (kg m2).
    first_group: inertia J_I by Mertsalov of the flywheel with the links of constant speed ratio (kg m2). With
    a motor the last three do not exist.
    """

    task: SteadyTask
    machine: ReducedMachine
    moment: float
    work: PanelCurve
    law: SteadyLaw
    own: float
    found: FlywheelSolution | None = None
    wittenbauer: float = float("nan")
    first_group: float = float("nan")

    @property
    def mertsalov(self) -> float:
        """Inertia of the flywheel by Mertsalov: J_I without the links of constant speed ratio (kg m2)."""
        return self.first_group - self.machine.constant

    @property
    def on_shaft(self) -> float:
        """Inertia of the flywheel on its own shaft, kg m2: the computed one, or the given one if none is computed."""
        return self.law.flywheel / self.task.ratio**2

    @property
    def errors(self) -> tuple[float, float]:
        """Relative errors of Wittenbauer's and Mertsalov's methods against the exact flywheel."""
        exact = float("nan") if self.found is None else self.found.inertia
        return self.wittenbauer / exact - 1, self.mertsalov / exact - 1

    @property
    def diameter(self) -> float:
        """Diameter of the flywheel, for a rim the mean diameter, m."""
        return self.task.size.diameter(self.on_shaft)

    @property
    def width(self) -> float:
        """Width of the flywheel, m."""
        return self.task.size.width * self.diameter

    @property
    def mass(self) -> float:
        """Mass of the flywheel, kg."""
        return self.task.size.mass(self.diameter)

    @property
    def speeds(self) -> tuple[float, float]:
        """Least and largest speed of the driver, rad/s or m/s."""
        return speed_extremes(self.law)

    @property
    def delta(self) -> float:
        """Coefficient of fluctuation of speed that is reached."""
        return speed_fluctuation(self.law)

    @property
    def tangents(self) -> tuple[Tangent, Tangent]:
        """Tangents to the energy-mass diagram for the largest and the least speed, whatever the drive.

        They pass through the point with inertia -Jf and energy -T0.
        """
        start = float(self.law.energy(np.zeros(1))[0])
        low, high = (self._touching(x, speed, start) for x, speed in speed_extreme_places(self.law))
        return high, low

    def _touching(self, x: float, speed: float, start: float) -> Tangent:
        inertia = float(self.machine.inertia(np.array([x]))[0])
        return Tangent(x, inertia, (self.law.flywheel + inertia) * speed**2 / 2 - start, speed**2 / 2)

    @property
    def at_mean(self) -> tuple[Tangent, Tangent]:
        """Tangents of the mean speed above and below the diagram, by Mertsalov.

        The inertia is that of the second group, the links without a constant speed ratio.
        """
        slope = self.task.mean**2 / 2
        tangents = (find_tangent(self.machine, self.work, slope, top=top) for top in (True, False))
        upper, lower = (replace(line, inertia=line.inertia - self.machine.constant) for line in tangents)
        return upper, lower


def speed_extremes(law: SteadyLaw) -> tuple[float, float]:
    """Return the least and the largest speed over the cycle."""
    nodes, signs = law.energy.places(), np.array([1.0, -1.0])
    values = law.speed(nodes)
    best = np.argmin(signs[:, None] * values, axis=1)
    low, high = (nodes[np.clip(best + side, 0, len(nodes) - 1)] for side in (-1, 1))
    minima = find_minima(lambda x: (law.speed(x).reshape(-1, 2) * signs).ravel(), low, high)[1]
    slowest, quickest = signs * np.minimum(minima, signs * values[best])
    return float(slowest), float(quickest)


def speed_extreme_places(law: SteadyLaw) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return travel and speed of the least and of the largest speed."""
    nodes = law.energy.places()
    (slowest, low), (quickest, high) = find_minimum(law.speed, nodes), find_minimum(lambda x: -law.speed(x), nodes)
    length = law.energy.length
    return (
        (refine_minimum(law.acceleration, slowest, length), low),
        (refine_minimum(lambda x: -law.acceleration(x), quickest, length), -high),
    )


def speed_fluctuation(law: SteadyLaw) -> float:
    """Coefficient of fluctuation: largest minus least speed, divided by the mean of both."""
    low, high = speed_extremes(law)
    return 2 * (high - low) / (high + low)


def find_steady_running(machine: ReducedMachine, task: SteadyTask) -> SteadySolution:
    """Solve steady running of a reduced machine.

    Raises:
        StandstillError: the machine stops.
        NoFlywheelError: the given flywheel already keeps the fluctuation.
        NoInertiaError: the machine has no inertia somewhere.
    """
    if task.motor is not None:
        return _steady_with_motor(machine, task, task.motor)
    moment = -machine.work_of_cycle / machine.length
    work = fit_curves(lambda x: (machine.work(x) + moment * x,), machine.work.edges)[0]
    energy, fluctuation = energy_at_mean_speed(machine, work, task.mean, task.flywheel)
    if task.delta is None:
        if np.isnan(energy):
            raise StandstillError(find_minimum(work, work.places())[0])
        law = constant_moment_law(machine, task.flywheel, energy, moment)
        return SteadySolution(task, machine, moment, work, law, fluctuation)
    arguments = (machine, work, task.mean, task.delta)
    flywheel = exact_flywheel(*arguments)
    if flywheel.inertia <= task.flywheel:
        raise NoFlywheelError(task.delta, fluctuation)
    law = constant_moment_law(machine, flywheel.inertia, flywheel.energy, moment)
    return SteadySolution(
        task,
        machine,
        moment,
        work,
        law,
        fluctuation,
        flywheel,
        wittenbauer_flywheel(*arguments).inertia,
        mertsalov_inertia(*arguments),
    )


def _steady_with_motor(machine: ReducedMachine, task: SteadyTask, motor: MotorCharacteristic) -> SteadySolution:
    """Steady running with a motor: a flywheel changes the driving moment, so its size is found iteratively."""

    cycle, nodes = MotorCycle.of(machine, motor), machine.inertia.places()
    inertia = machine.inertia(nodes)
    heaviest, lightest = float(np.max(inertia)), float(np.min(inertia))
    if task.delta is None and not task.flywheel + lightest > ROUNDOFF * heaviest:
        raise NoInertiaError(round(float(nodes[np.argmin(inertia)]), 9))

    def delta_of(flywheel: float) -> float:
        if not flywheel + lightest > ROUNDOFF * heaviest:  # all masses rest somewhere on the driver's way
            return STANDSTILL_FLUCTUATION
        try:
            return speed_fluctuation(cycle.law(flywheel))
        except (StandstillError, RunawayError):
            return STANDSTILL_FLUCTUATION

    fluctuation = delta_of(task.flywheel)
    flywheel = task.flywheel
    if task.delta is not None:
        if fluctuation <= task.delta:
            raise NoFlywheelError(task.delta, fluctuation)
        flywheel = _search_flywheel(task.delta, delta_of, task.flywheel, heaviest)
    law = cycle.law(flywheel)
    gained = law.energy.coefficients.copy()
    gained[0] -= law.energy(np.zeros(1))[0]
    work = PanelCurve(law.energy.edges, gained)
    return SteadySolution(
        task,
        machine,
        law.driving.total / machine.length,
        work,
        law,
        fluctuation if fluctuation < STANDSTILL_FLUCTUATION else float("nan"),
    )


def _search_flywheel(delta: float, delta_of: Callable[[float], float], low: float, unit: float) -> float:
    """Find the flywheel inertia that gives the fluctuation delta; with the lower bound `low` the fluctuation is
    larger.

    The reciprocal of the fluctuation grows almost linearly with the flywheel, so few trials are needed.
    """

    def over(flywheel: Real) -> Real:
        excess = delta / delta_of(float(flywheel[0])) - 1
        return np.array([0.0 if abs(excess) <= FLUCTUATION_TOLERANCE else excess])

    below, above = np.array([low]), np.array([low + unit])
    for _ in range(DOUBLINGS):
        if over(above)[0] > 0:
            return float(find_roots(over, below, above)[0])
        below, above = above, 2 * above
    raise NoFlywheelError(delta, float("nan"))


# The machine reduced to its driver, and its steady running, from a mechanism with its loads.


CONSTANT_SAMPLES = 97  # positions of a cycle at which the reduced inertias of links are compared


def reduce_mechanism(mechanism: Mechanism, start: float) -> ReducedMachine:
    """Reduce a mechanism to its crank over a cycle that begins at the crank angle `start` (rad).

    Raises:
        NoCycleError: the driver is not a fully rotating crank, or not the only one.
        BySpeedError: a load depends on speed.
    """
    linkage, whole = mechanism.linkage, mechanism.driver_range
    if linkage.driver.kind != "turn" or not whole.full:
        raise NoCycleError
    length = 2 * np.pi * whole.turns
    machine = reduce_between(mechanism, start, linkage.driver.sense, length)
    return replace(machine, constant=_constant_inertia(mechanism, start, length))


def _constant_inertia(mechanism: Mechanism, start: float, length: float) -> float:
    """Reduced inertia of the links with a constant speed ratio to the driver, kg m2.

    A link counts if its reduced inertia does not change over the cycle: the crank, gears on the frame, links
    of parallelograms.
    """
    q = start + mechanism.linkage.driver.sense * np.linspace(0, length, CONSTANT_SAMPLES, endpoint=False)
    motion = compute_motion(
        mechanism.linkage, mechanism.kernels, q, DriverMotion(start, 1.0, 0.0, mechanism.linkage.driver.sense)
    )
    inertia = [
        np.broadcast_to(to_float(link_inertia), q.shape) for link_inertia, _ in reduced_inertias(motion).values()
    ]
    return float(
        sum(
            np.mean(link_inertia)
            for link_inertia in inertia
            if np.ptp(link_inertia) <= CONSTANT_INERTIA * np.max(link_inertia)
        )
    )


def reduce_between(mechanism: Mechanism, start: float, sense: int, length: float) -> ReducedMachine:
    """Reduce a mechanism to its driver over a travel `length` (rad, or m) from the coordinate `start`.

    Raises:
        NoCycleError: there are several drivers.
        BySpeedError: a load depends on speed.
    """
    linkage = mechanism.linkage
    if linkage.others:
        raise NoCycleError
    if linkage.by_speed is not None:
        raise SpeedDependentForceError(linkage.by_speed)
    strokes = mechanism.strokes if linkage.by_strokes else None

    def sample(x: Real) -> tuple[Real, Real, Real]:
        motion = compute_motion(linkage, mechanism.kernels, start + sense * x, DriverMotion(start, 1.0, 0.0, sense))
        energy = compute_energy(motion, collect_loads(motion, strokes), np.zeros(np.shape(x)))
        return energy.inertia, sense * energy.slope, sense * energy.moment

    jumps = np.array([*find_load_jumps(mechanism)]) if linkage.driver.kind == "turn" else np.empty(0)
    inner = np.sort(np.mod(sense * (jumps - start), 2 * np.pi * mechanism.driver_range.turns))
    inner = inner[np.diff(inner, prepend=-1.0) > SAME_DRIVER_POSITION]
    return reduce_machine(
        sample, [0.0, *inner[(inner > SAME_DRIVER_POSITION) & (inner < length - SAME_DRIVER_POSITION)], length]
    )


@dataclass(frozen=True)
class SteadyRunning:
    """Steady running of a mechanism; also the law of motion of its driver from the crank angle `start` (rad)."""

    steady: SteadySolution
    start: float
    sense: int

    @property
    def task(self) -> SteadyTask:
        return self.steady.task

    def way(self, q: Real) -> Real:
        """Travel of the driver in the cycle at coordinate q, rad."""
        gone = np.mod(self.sense * (to_float(q) - self.start) + SEAM, self.steady.machine.length) - SEAM
        return np.asarray(np.maximum(gone, 0.0))

    def speed(self, q: Real) -> Real:
        """Angular velocity with its sign, rad/s."""
        return self.sense * self.steady.law.speed(self.way(q))

    def accelerated(self, q: Real) -> Real:
        """Angular acceleration with its sign, rad/s2."""
        return self.sense * self.steady.law.acceleration(self.way(q))

    def time(self, q: Real) -> Real:
        """Time since the beginning of the cycle, s."""
        return self.steady.law.time(self.way(q))

    def driving(self, q: Real) -> Real:
        """Driving moment along the sense of rotation, N m."""
        return self.steady.law.driving(self.way(q))

    def work(self, q: Real) -> Real:
        """Work of all moments since the beginning of the cycle, J."""
        return self.steady.work(self.way(q))


def find_running_law(mechanism: Mechanism, start: float, task: SteadyTask) -> SteadyRunning:
    """Solve steady running of a mechanism with its loads from the crank angle `start` (rad).

    Raises:
        NoCycleError: the driver is not a fully rotating crank, or not the only one.
        BySpeedError: a load depends on speed.
        StandstillError: the machine stops.
        NoFlywheelError: the given flywheel already keeps the fluctuation.
    """
    return SteadyRunning(
        find_steady_running(reduce_mechanism(mechanism, start), task), start, mechanism.linkage.driver.sense
    )
