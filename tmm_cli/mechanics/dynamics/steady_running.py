"""Steady running: driving moment, flywheel for a required fluctuation of speed, and the resulting law of
motion.
"""

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

    The last three attributes are not computed for a machine driven by a motor.

    Attributes:
        task: the task.
        machine: the reduced machine.
        moment: mean driving moment over the cycle, N m or N.
        work: work of all moments from the beginning of the cycle, J.
        law: the law of motion.
        own: coefficient of fluctuation without the computed flywheel; nan if the machine then stops.
        found: exact flywheel, which includes the flywheel given in the task.
        wittenbauer: inertia of the flywheel by Wittenbauer's tangents, kg m2.
        first_group: inertia J_I of Mertsalov's first group, the flywheel and the links with a constant speed ratio, kg
            m2.
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
        """Inertia of the flywheel by Mertsalov's method, kg m2: J_I minus the inertia of the links with a constant
        speed ratio.
        """
        return self.first_group - self.machine.constant

    @property
    def on_shaft(self) -> float:
        """Inertia of the flywheel on its own shaft, kg m2.

        If no flywheel is computed, it is that of the flywheel given in the task.
        """
        return self.law.flywheel / self.task.ratio**2

    @property
    def errors(self) -> tuple[float, float]:
        """Relative errors of Wittenbauer's and Mertsalov's methods, compared with the exact flywheel."""
        exact = float("nan") if self.found is None else self.found.inertia
        return self.wittenbauer / exact - 1, self.mertsalov / exact - 1

    @property
    def diameter(self) -> float:
        """Diameter of the flywheel, m: outer diameter of a disk, or mean diameter of a rim."""
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
        """Coefficient of fluctuation of speed with the flywheel."""
        return speed_fluctuation(self.law)

    @property
    def tangents(self) -> tuple[Tangent, Tangent]:
        """Tangents to the energy-mass diagram for the largest and the least speed.

        They meet at the point with inertia -Jf and energy -T0, where Jf is the inertia of the flywheel and T0 the
        kinetic energy at the beginning of the cycle. They are also defined for a machine with a motor.
        """
        start = float(self.law.energy(np.zeros(1))[0])
        low, high = (self._tangent_at(x, speed, start) for x, speed in speed_extreme_places(self.law))
        return high, low

    def _tangent_at(self, x: float, speed: float, start: float) -> Tangent:
        inertia = float(self.machine.inertia(np.array([x]))[0])
        return Tangent(x, inertia, (self.law.flywheel + inertia) * speed**2 / 2 - start, speed**2 / 2)

    @property
    def at_mean(self) -> tuple[Tangent, Tangent]:
        """Tangents to the energy-mass diagram for the mean speed w, as used in Mertsalov's method.

        One touches the diagram from above and the other from below; their slope is w^2/2. In their points of contact,
        `inertia` does not include the links with a constant speed ratio to the driver (Mertsalov's first group).
        """
        slope = self.task.mean**2 / 2
        tangents = (find_tangent(self.machine, self.work, slope, top=top) for top in (True, False))
        upper, lower = (replace(line, inertia=line.inertia - self.machine.constant) for line in tangents)
        return upper, lower


def speed_extremes(law: SteadyLaw) -> tuple[float, float]:
    """Return the least and the largest speed over the cycle."""
    nodes, signs = law.energy.sample_points(), np.array([1.0, -1.0])
    values = law.speed(nodes)
    best = np.argmin(signs[:, None] * values, axis=1)
    low, high = (nodes[np.clip(best + side, 0, len(nodes) - 1)] for side in (-1, 1))
    minima = find_minima(lambda x: (law.speed(x).reshape(-1, 2) * signs).ravel(), low, high)[1]
    slowest, quickest = signs * np.minimum(minima, signs * values[best])
    return float(slowest), float(quickest)


def speed_extreme_places(law: SteadyLaw) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return two pairs (driver travel, speed): for the least and for the largest speed."""
    nodes = law.energy.sample_points()
    (slowest, low), (quickest, high) = find_minimum(law.speed, nodes), find_minimum(lambda x: -law.speed(x), nodes)
    length = law.energy.length
    return (
        (refine_minimum(law.acceleration, slowest, length), low),
        (refine_minimum(lambda x: -law.acceleration(x), quickest, length), -high),
    )


def speed_fluctuation(law: SteadyLaw) -> float:
    """Compute the coefficient of fluctuation: largest minus least speed, divided by the mean of the two."""
    low, high = speed_extremes(law)
    return 2 * (high - low) / (high + low)


def find_steady_running(machine: ReducedMachine, task: SteadyTask) -> SteadySolution:
    """Solve steady running of a reduced machine.

    Raises:
        StandstillError: the machine stops.
        NoFlywheelError: the fluctuation is small enough without a further flywheel.
        NoInertiaError: the inertia of the machine is zero at some driver coordinate.
    """
    if task.motor is not None:
        return _steady_with_motor(machine, task, task.motor)
    moment = -machine.work_of_cycle / machine.length
    work = fit_curves(lambda x: (machine.work(x) + moment * x,), machine.work.edges)[0]
    energy, fluctuation = energy_at_mean_speed(machine, work, task.mean, task.flywheel)
    if task.delta is None:
        if np.isnan(energy):
            raise StandstillError(find_minimum(work, work.sample_points())[0])
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
    """Solve steady running with a motor.

    A flywheel changes the driving moment, so its inertia is found iteratively.
    """

    cycle, nodes = MotorCycle.of(machine, motor), machine.inertia.sample_points()
    inertia = machine.inertia(nodes)
    heaviest, lightest = float(np.max(inertia)), float(np.min(inertia))
    if task.delta is None and not task.flywheel + lightest > ROUNDOFF * heaviest:
        raise NoInertiaError(round(float(nodes[np.argmin(inertia)]), 9))

    def delta_of(flywheel: float) -> float:
        if not flywheel + lightest > ROUNDOFF * heaviest:  # at some position all masses are at rest
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
    """Find the flywheel inertia with which the coefficient of fluctuation is `delta`.

    The reciprocal of the coefficient grows almost linearly with the inertia, so few trials are needed.

    Args:
        delta: required coefficient of fluctuation.
        delta_of: function that returns the coefficient of fluctuation for an inertia.
        low: inertia with which the fluctuation is too large, the lower bound of the search.
        unit: first increment of the inertia.
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
    """Reduce a mechanism to its crank over the cycle that begins at the crank angle `start` (rad).

    Raises:
        NoCycleError: the driver is not a fully rotating crank, or there are several drivers.
        SpeedDependentForceError: a load depends on the speed.
    """
    linkage, whole = mechanism.linkage, mechanism.driver_range
    if linkage.driver.kind != "turn" or not whole.full:
        raise NoCycleError
    length = 2 * np.pi * whole.turns
    machine = reduce_between(mechanism, start, linkage.driver.sense, length)
    return replace(machine, constant=_constant_inertia(mechanism, start, length))


def _constant_inertia(mechanism: Mechanism, start: float, length: float) -> float:
    """Compute the reduced inertia (kg m2) of the links with a constant speed ratio to the driver.

    They are the links whose reduced inertia does not change over the cycle: the crank, gears on the frame,
    links of parallelograms.
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
    """Reduce a mechanism to its driver. The driver moves by `length` (rad, or m) from the driver coordinate `start`.

    Raises:
        NoCycleError: there are several drivers.
        SpeedDependentForceError: a load depends on the speed.
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
    """Steady running of a mechanism, which is also the law of motion of its driver.

    Attributes:
        steady: steady running of the reduced machine.
        start: crank angle at the beginning of the cycle, rad.
        sense: sense of rotation, +1 or -1.
    """

    steady: SteadySolution
    start: float
    sense: int

    @property
    def task(self) -> SteadyTask:
        return self.steady.task

    def travel(self, q: Real) -> Real:
        """Return the travel of the driver (rad) from the beginning of the cycle to the coordinate q."""
        distance = np.mod(self.sense * (to_float(q) - self.start) + SEAM, self.steady.machine.length) - SEAM
        return np.asarray(np.maximum(distance, 0.0))

    def speed(self, q: Real) -> Real:
        """Return the angular velocity of the driver with its sign, rad/s."""
        return self.sense * self.steady.law.speed(self.travel(q))

    def accelerated(self, q: Real) -> Real:
        """Return the angular acceleration of the driver with its sign, rad/s2."""
        return self.sense * self.steady.law.acceleration(self.travel(q))

    def time(self, q: Real) -> Real:
        """Return the time since the beginning of the cycle, s."""
        return self.steady.law.time(self.travel(q))

    def driving(self, q: Real) -> Real:
        """Return the driving moment (N m), positive in the sense of rotation, at the driver coordinate q."""
        return self.steady.law.driving(self.travel(q))

    def work(self, q: Real) -> Real:
        """Return the work of all moments since the beginning of the cycle, J, at the driver coordinate q."""
        return self.steady.work(self.travel(q))


def find_running_law(mechanism: Mechanism, start: float, task: SteadyTask) -> SteadyRunning:
    """Solve steady running of a mechanism with its loads over the cycle that begins at the crank angle `start`
    (rad).

    Raises:
        NoCycleError: the driver is not a fully rotating crank, or there are several drivers.
        SpeedDependentForceError: a load depends on the speed.
        StandstillError: the machine stops.
        NoFlywheelError: the fluctuation is small enough without a further flywheel.
    """
    return SteadyRunning(
        find_steady_running(reduce_mechanism(mechanism, start), task), start, mechanism.linkage.driver.sense
    )
