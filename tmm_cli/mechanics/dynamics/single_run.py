"""A single run of a machine: starting, stopping, a press that works once, a cylinder under pressure.

The equation J w' + J' w^2 / 2 = M + Md is integrated over time until the driver has completed its travel x
or the machine stops; the works of the moments are integrated with it. The method is that of Dormand and
Prince of order 8; integration restarts wherever a moment may jump: E. Hairer, S. P. Norsett, G. Wanner,
Solving Ordinary Differential Equations I (1993), II.10. If the motor is so strong compared with the load
that the equation is stiff, LSODA (Petzold, Hindmarsh) is used.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import count, pairwise
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from scipy.integrate import OdeSolution, solve_ivp

from tmm_cli.mechanics.dynamics.reduced_model import PanelCurve, ReducedMachine
from tmm_cli.mechanics.dynamics.steady_running import reduce_between
from tmm_cli.mechanics.dynamics.tasks import RunTask
from tmm_cli.mechanics.errors import LongRunError, NoInertiaError, OutOfRangeError, StandstillError
from tmm_cli.mechanics.numerics import ROUNDOFF, SAME_DRIVER_POSITION, SEAM, Real, find_roots, to_float

if TYPE_CHECKING:
    from tmm_cli.mechanics.analysis import Mechanism


TOLERANCE = 1e-12  # relative, per integration step
STIFF_RATIO = 100.0  # speed changes by the motor per run above which a stiff method is faster
MOST_EVALUATIONS = 50_000  # of a run, about five seconds; the runs of the bank take 3 000 at most
NO_JUMP = 1e-9  # of the largest moment: a smaller step between two pieces of a curve is no jump

END_OFFSET = 1e-6  # of a piece: distance from its ends at which no jump has occurred yet
RunEnding = Literal["way", "standstill", "time"]


@dataclass(frozen=True)
class RunHistory:
    """Course of a single run: one value per integration step.

    Attributes:
        time: time, s.
        way, speed, acceleration: distance covered by the driver (rad or m), its speed and acceleration.
        kinetic: kinetic energy, J.
        driven, loaded, braked: work of the drive, of the loads and of the brake, J.
        ending: why the run ended: the travel was complete, the machine stopped, or the time limit was reached.
        steps: interpolants of the solution between the steps.
    """

    time: Real
    way: Real
    speed: Real
    acceleration: Real
    kinetic: Real
    driven: Real
    loaded: Real
    braked: Real
    ending: RunEnding
    steps: tuple[Any, ...] = ()

    @property
    def balance(self) -> float:
        """Largest error of the energy balance during the run, relative to the largest energy."""
        parts = (self.kinetic, self.driven, self.loaded, self.braked)
        scale = max(float(np.max(np.abs(energies))) for energies in parts)
        left = self.kinetic - self.kinetic[0] - self.driven - self.loaded - self.braked
        return float(np.max(np.abs(left))) / scale if scale > 0 else 0.0

    def at(self, travel: Real) -> tuple[Real, Real]:
        """Return the time (s) and the speed when the driver has covered each of these distances.

        Both are nan for distances that the run does not reach.
        """
        travel = np.asarray(travel, float)
        if self.steps:
            last = float(self.steps[-1](self.steps[-1].ts[-1])[0])
            travel = np.where((travel > last) & (travel < last + SEAM), last, travel)
        time, speed = np.full(travel.shape, np.nan), np.full(travel.shape, np.nan)
        for step in self.steps:
            low, high = step.ts[0], step.ts[-1]
            covered = (travel >= step(low)[0]) & (travel <= step(high)[0])
            if covered.any():
                missed = partial(_distance_past, step, travel[covered])
                times = find_roots(missed, low + 0 * travel[covered], high + 0 * travel[covered])
                time[covered], speed[covered] = times, step(times)[1]
        begins = travel == self.way[0]  # at the beginning, where rounding would spoil a root search from rest
        return np.where(begins, self.time[0], time), np.where(begins, self.speed[0], speed)

    def closely(self, count: int) -> list[tuple[Real, Real]]:
        """Sample the run at `count` evenly spaced times in each interval of integration, just inside its ends.

        Returns:
            For each interval the times (s), and an array (5, count) of travel, speed and the works of the drive,
            the loads and the brake.
        """
        ends = [(step.ts[0], step.ts[-1]) for step in self.steps]
        inner = [
            np.linspace(low + END_OFFSET * (high - low), high - END_OFFSET * (high - low), count) for low, high in ends
        ]
        return [(times, step(times)) for times, step in zip(inner, self.steps, strict=True)]


def integrate_run(machine: ReducedMachine, task: RunTask) -> RunHistory:
    """Integrate the equation of motion over a single run.

    The run ends when the travel is complete, the machine stops, or the time limit is reached.

    Args:
        machine: the reduced machine.
        task: drive, brake, flywheel, initial speed and time limit.

    Returns:
        Course of the run, one value per integration step.

    Raises:
        NoInertiaError: at some driver coordinate the machine, with its flywheel, has no inertia.
        StandstillError: the machine is at rest and does not start.
        LongRunError: the number of evaluations exceeds the limit.
    """
    nodes = machine.inertia.sample_points()
    inertia = task.flywheel + machine.inertia(nodes)
    if not np.min(inertia) > ROUNDOFF * np.max(inertia):
        raise NoInertiaError(round(float(nodes[np.argmin(inertia)]), 9))
    state = np.array([0.0, task.speed, 0.0, 0.0, 0.0])
    if task.speed == 0 and _rates(machine, task, (0.0, machine.length), 0.0, state)[1] <= 0:
        raise StandstillError(0.0)
    times, states, steps, time, evaluations = [], [], [], 0.0, count(MOST_EVALUATIONS, -1)
    ending: RunEnding = "time"
    for low, high in _pieces(machine.moment, task.way_edges):
        for end in sorted({t for t in task.edges if time < t < task.longest} | {task.longest}):
            solution = _integrate_piece(machine, task, (low, high), (time, end), state, evaluations)
            times.append(solution.t)
            states.append(solution.y)
            steps.append(solution.sol)
            time, state = float(solution.t[-1]), solution.y[:, -1]
            if solution.status == 1:
                break
        ending = "time" if solution.status == 0 else "standstill" if len(solution.t_events[1]) else "way"
        if ending != "way":
            break
    record = _run_history(machine, task, np.concatenate(times), np.concatenate(states, axis=1), ending)
    return replace(record, steps=tuple(steps))


def _integrate_piece(
    machine: ReducedMachine,
    task: RunTask,
    piece: tuple[float, float],
    times: tuple[float, float],
    state: Real,
    left: Iterator[int],
) -> Any:
    """Integrate over one interval of travel, until the end of the interval, standstill, or the end of the time span.

    Args:
        machine: the reduced machine.
        task: the task of the run.
        piece: ends of the interval of travel.
        times: ends of the time span, s.
        state: travel, speed, and the works of the drive, the loads and the brake at the beginning.
        left: counter of the evaluations that are still allowed; it is decreased.

    Raises:
        LongRunError: no evaluations are left.
    """

    last = float(np.nextafter(times[1], times[0]))  # at the end of a piece the driving moment may have jumped already

    def rates(t: float, y: Real) -> list[float]:
        if not next(left):
            raise LongRunError(t, float(y[0]), MOST_EVALUATIONS)
        return _rates(machine, task, piece, min(t, last), y)

    def gone(t: float, y: Real) -> float:
        return float(y[0] - piece[1])

    def rests(t: float, y: Real) -> float:
        return float(y[1])

    gone.terminal = rests.terminal = True  # type: ignore[attr-defined]
    gone.direction, rests.direction = 1.0, -1.0  # type: ignore[attr-defined]
    scale = max(abs(state[1]), 1e-3)
    energy = max(float(np.max(machine.inertia(machine.inertia.sample_points()))) * scale**2, 1e-9)
    method, error = ("LSODA", TOLERANCE / 10) if _is_stiff(machine, task) else ("DOP853", TOLERANCE)
    exact = {"rtol": error, "atol": [error * machine.length, error * scale, *[error * energy] * 3]}
    solution = solve_ivp(rates, times, state, method, events=(gone, rests), dense_output=True, **exact)
    return _with_last_step(solution, partial(solve_ivp, rates, method=method, dense_output=True, **exact))


def _with_last_step(solution: Any, integrate: Callable[..., Any]) -> Any:
    """Repeat the last step of an integration, now only up to the event that ended it.

    The step went beyond the end of the interval, where moments are no longer smooth, so its interpolant is
    inaccurate.
    """
    if solution.status != 1 or not solution.t[-1] > solution.t[-2]:
        return solution
    repeated = integrate((solution.t[-2], solution.t[-1]), solution.y[:, -2])
    if repeated.status != 0:
        return solution
    solution.t = np.concatenate([solution.t[:-1], repeated.t[1:]])
    solution.y = np.concatenate([solution.y[:, :-1], repeated.y[:, 1:]], axis=1)
    before = solution.sol.interpolants[:-1]
    solution.sol = OdeSolution(
        [*solution.sol.ts[: len(before)], *repeated.sol.ts], [*before, *repeated.sol.interpolants]
    )
    return solution


def _is_stiff(machine: ReducedMachine, task: RunTask) -> bool:
    """Return True if the motor changes the speed much faster than the machine covers its travel."""
    if task.motor is None:
        return False
    inertia = task.flywheel + float(np.min(machine.inertia(machine.inertia.sample_points())))
    steepest = float(task.motor.at_slip(np.zeros(1))[1][0]) / task.motor.idle
    return steepest * machine.length > STIFF_RATIO * inertia * task.motor.idle


def _distance_past(step: Any, travel: Real, time: Real) -> Real:
    """Return how far beyond `travel` the driver is at this time of an integration step."""
    excess: Real = step(time)[0] - travel
    return excess


def driver_acceleration(machine: ReducedMachine, task: RunTask, time: Real, travel: Real, speed: Real) -> Real:
    """Compute the acceleration of the driver (rad/s2, or m/s2) from time, travel and speed."""
    states = np.stack([travel, speed, 0 * travel, 0 * travel, 0 * travel], axis=-1)
    return np.array(
        [
            _rates(machine, task, (0.0, machine.length), float(t), y)[1] if np.isfinite(t) else np.nan
            for t, y in zip(np.ravel(time), states.reshape(-1, 5), strict=True)
        ]
    ).reshape(np.shape(travel))


def _rates(machine: ReducedMachine, task: RunTask, piece: tuple[float, float], t: float, state: Real) -> list[float]:
    """Return the time derivatives of the travel, the speed, and the works of the drive, the loads and the brake."""
    speed = float(state[1])
    x = np.array([min(max(float(state[0]), piece[0]), np.nextafter(piece[1], piece[0]))])
    load, driving = float(machine.moment(x)[0]), _driving_moment(task, t, x, speed)
    inertia = task.flywheel + float(machine.inertia(x)[0])
    squared = speed * speed  # not **, which raises an error on overflow in a trial step beyond the end
    net_moment = driving + load - task.brake - float(machine.slope(x)[0]) * squared / 2
    return [speed, net_moment / inertia, driving * speed, load * speed, -task.brake * speed]


def _driving_moment(task: RunTask, t: float, x: Real, speed: float) -> float:
    moment = 0.0 if task.motor is None else float(task.motor.moment(np.array([speed]))[0])
    return moment if task.drive is None else moment + float(task.drive(np.array([t]), x)[0])


def _pieces(moment: PanelCurve, way_edges: Sequence[float]) -> Iterator[tuple[float, float]]:
    """Yield the intervals of travel between points where the load moment jumps or the drive has a jump or a kink."""
    inner = moment.edges[1:-1]
    before, after = moment(np.nextafter(inner, 0.0)), moment(inner)
    jumps = inner[np.abs(after - before) > NO_JUMP * float(np.max(np.abs(moment(moment.sample_points()))))]
    edges = {edge for edge in way_edges if 0 < edge < moment.length} | set(jumps.tolist())
    yield from pairwise([0.0, *sorted(edges), moment.length])


def _run_history(machine: ReducedMachine, task: RunTask, time: Real, states: Real, ending: RunEnding) -> RunHistory:
    travel, speed, driven, loaded, braked = states
    x = np.clip(travel, 0.0, np.nextafter(machine.length, 0.0))
    changes = driver_acceleration(machine, task, time, travel, speed)
    kinetic = (task.flywheel + machine.inertia(x)) * speed**2 / 2
    return RunHistory(time, travel, speed, changes, kinetic, driven, loaded, braked, ending)


# A single run of a mechanism with its loads: a press that works once, a cylinder that lifts, starting and stopping.


@dataclass(frozen=True, eq=False)
class SingleRun:
    """Single run of a mechanism, which is also the law of motion of its driver.

    Attributes:
        task: the task, with its drive counted positive in the direction of the run.
        machine: the reduced machine.
        run: course of the run.
        first: driver coordinate at the beginning, rad or m.
        sense: direction of the run, +1 or -1.
        turn: angle after which a crank is in the same position again, 2 pi; None if the driver does not rotate
            fully.
    """

    task: RunTask
    machine: ReducedMachine
    run: RunHistory
    first: float
    sense: int
    turn: float | None

    def evenly(self, count: int) -> Real:
        """Return `count` evenly spaced driver coordinates from the beginning of the run to its end."""
        return self.first + self.sense * np.linspace(0, float(self.run.way[-1]), count)

    def travel(self, q: Real) -> Real:
        """Return the distance that the driver has covered when it reaches the coordinate q."""
        distance: Real = self.sense * (to_float(q) - self.first)
        reduced = (
            distance if self.turn is None else np.mod(distance + SAME_DRIVER_POSITION, self.turn) - SAME_DRIVER_POSITION
        )
        distance = np.where(
            (distance < -SAME_DRIVER_POSITION) | (distance > self.machine.length + SAME_DRIVER_POSITION),
            reduced,
            distance,
        )
        return (
            np.clip(distance, 0.0, None)
            if self.turn
            else np.where(np.abs(distance) < SAME_DRIVER_POSITION, 0.0, distance)
        )

    def driving(self, travel: Real, speed: Real, accelerated: Real) -> Real:
        """Compute the driving moment (N m) or force (N) that produces the given speed and acceleration of the driver.

        Args:
            travel: distance covered by the driver, rad or m.
            speed: speed at that distance.
            accelerated: acceleration at that distance.
        """
        machine = self.machine
        inertial = (self.task.flywheel + machine.inertia(travel)) * accelerated + machine.slope(travel) * speed**2 / 2
        moment: Real = inertial + self.task.brake - machine.moment(travel)
        return moment

    def speed(self, q: Real) -> Real:
        """Return the speed of the driver with its sign, rad/s or m/s; nan at coordinates q that the run does not
        reach.
        """
        return self.sense * self.run.at(self.travel(q))[1]

    def time(self, q: Real) -> Real:
        """Return the time since the beginning of the run, s; nan at coordinates q that the run does not reach."""
        return self.run.at(self.travel(q))[0]

    def kinetic(self, q: Real) -> Real:
        """Return the kinetic energy of the machine, J; nan at coordinates q that the run does not reach."""
        return self.energy(self.travel(q), self.speed(q))

    def energy(self, travel: Real, speed: Real) -> Real:
        """Compute the kinetic energy (J) from the distance covered by the driver and its speed."""
        energy: Real = (self.task.flywheel + self.machine.inertia(travel)) * speed**2 / 2
        return energy

    def acceleration(self, time: Real, travel: Real, speed: Real) -> Real:
        """Compute the acceleration of the driver from time, distance covered and speed."""
        return driver_acceleration(self.machine, self.task, time, travel, speed)

    def accelerated(self, q: Real) -> Real:
        """Return the acceleration of the driver with its sign, rad/s2 or m/s2; nan at coordinates q that are not
        reached.
        """
        travel = self.travel(q)
        time, speed = self.run.at(travel)
        return self.sense * self.acceleration(time, travel, speed)


def compute_single_run(mechanism: Mechanism, positions: Real, task: RunTask) -> SingleRun:
    """Compute a single run of a mechanism between two driver coordinates.

    They are given in the task; by default they are the first and the last requested position.

    Args:
        mechanism: the mechanism with its loads.
        positions: driver coordinates of the requested positions, rad or m.
        task: drive, brake, flywheel, initial speed, ends of the run.

    Raises:
        NoCycleError: the mechanism has several drivers.
        OutOfRangeError: an end of the run lies outside the range of the driver.
        StandstillError: the machine does not start.
    """
    first, last = (float(positions[k]) if end is None else end for k, end in ((0, task.first), (-1, task.last)))
    whole = mechanism.driver_range
    if not whole.full and not all(
        whole.start - SAME_DRIVER_POSITION <= end <= whole.end + SAME_DRIVER_POSITION for end in (first, last)
    ):
        raise OutOfRangeError(whole.start, whole.end)
    sense = 1 if last > first else -1
    machine = reduce_between(mechanism, first, sense, abs(last - first))
    task = task.along(sense)
    turn = 2 * np.pi if whole.full and mechanism.linkage.driver.kind == "turn" else None
    return SingleRun(task, machine, integrate_run(machine, task), first, sense, turn)
