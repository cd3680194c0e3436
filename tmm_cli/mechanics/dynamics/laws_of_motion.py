"""Laws of motion in steady running: speed, acceleration and time along the travel of the driver, the same
every cycle.

Under a constant driving moment Md the kinetic energy T along the travel x follows by integration, dT/dx =
M(x) + Md, and the speed from w^2 = 2 T / (Jf + J), where J is the reduced inertia and Jf that of the
flywheel.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from math import isfinite

import numpy as np
from numpy.polynomial import chebyshev

from tmm_cli.mechanics.dynamics.motors import MotorCharacteristic
from tmm_cli.mechanics.dynamics.reduced_model import (
    NODES,
    VALUES_TO_COEFFICIENTS,
    VALUES_TO_INTEGRALS,
    PanelCurve,
    ReducedMachine,
    fit_curves,
    panel_nodes,
)
from tmm_cli.mechanics.errors import LinkageError, LostDigitsError, RunawayError, StandstillError, WeakMotorError
from tmm_cli.mechanics.linkage import SpeedTable
from tmm_cli.mechanics.numerics import LAST_STEP, SEAM, Real, to_float


@dataclass(frozen=True)
class SteadyLaw:
    """Law of motion over a cycle of steady running. Its quantities are functions of the driver travel x.

    x is in rad, or in m for a slider.

    Attributes:
        machine: the reduced machine.
        flywheel: inertia of the flywheel on the driver, kg m2 or kg.
        energy: kinetic energy, flywheel included, J.
        driving: driving moment, N m or N.
        time: time since the beginning of the cycle, s.
    """

    machine: ReducedMachine
    flywheel: float
    energy: PanelCurve
    driving: PanelCurve
    time: PanelCurve

    def speed(self, x: Real) -> Real:
        """Return the speed at travel x, rad/s or m/s."""
        return np.sqrt(2 * self.energy(x) / (self.flywheel + self.machine.inertia(x)))

    def acceleration(self, x: Real) -> Real:
        """Return the acceleration at travel x, rad/s2 or m/s2. Where the load jumps, it is the value just after the
        jump.
        """
        moment = self.driving(x) + self.machine.moment(x) - self.machine.slope(x) * self.speed(x) ** 2 / 2
        acceleration: Real = moment / (self.flywheel + self.machine.inertia(x))
        return acceleration

    @property
    def period(self) -> float:
        """Duration of a cycle, s."""
        return float(self.time(np.array([self.time.length]))[0])


def constant_moment_law(machine: ReducedMachine, flywheel: float, energy: float, moment: float) -> SteadyLaw:
    """Compute the law of motion under a constant driving moment.

    Args:
        machine: the reduced machine.
        flywheel: inertia of the flywheel, kg m2.
        energy: kinetic energy at the beginning of the cycle, J.
        moment: driving moment, N m.

    Raises:
        StandstillError: the kinetic energy falls to zero during the cycle.
    """
    work = fit_curves(lambda x: (energy + machine.work(x) + moment * x,), machine.work.edges)[0]
    nodes = work.sample_points()
    values = work(nodes)
    if not np.all(values > 0):
        raise StandstillError(float(nodes[np.argmin(values)]))

    def parts(x: Real) -> Sequence[Real]:
        return np.sqrt((flywheel + machine.inertia(x)) / (2 * work(x))), np.full(np.shape(x), moment)

    pace, driving = fit_curves(parts, work.edges)
    return SteadyLaw(machine, flywheel, work, driving, pace.integrate())


# Steady running of a machine driven by a motor with a given characteristic: the motion that repeats every cycle.
#
# With the speed w = w0 (1 - s), w0 that of the motor without load, the unknown is the slip s as a function of travel x:
#
#     -w0 (Jf + J) w s' = M + Md(s) - J' w^2 / 2.
#
# Solving for the slip loses no digits for a strong motor, but makes the equation stiff: it is solved panel by panel, by
# collocation and Newton's method, and a panel ends with the value of its polynomial there, so that components that
# have decayed within it do not return (E. Hairer, G. Wanner, Solving Ordinary Differential Equations II (1996),
# IV.3). A panel on which the slip is no polynomial is halved; after a jump of the load a strong motor needs many
# halvings.


NEWTON_STEPS = 60  # largest number
TAIL = 1e-13  # of the largest slip: tolerance of the last coefficients and of the initial value of a panel
SLIP_ROUNDED = 64 * 2.0**-53  # of the largest slip: a smaller change over the cycle is rounding
MOST_LOST_DIGITS = 1e-6  # of the slip: with a larger rounding error there is no solution
RUNAWAY = -1.0  # mean slip: the machine rotates twice as fast as its motor without load
WORK_IMBALANCE = 1e-6  # of the largest motor moment: tolerance of the work balance over a cycle
NARROWEST = 1e-13  # of a cycle: if so narrow a panel has no solution, the machine stands still
IDENTITY = np.eye(NODES)
VALUES_TO_ENDS: Real = (
    chebyshev.chebvander(np.array([-1.0, 1.0]), NODES - 1) @ VALUES_TO_COEFFICIENTS
)  # values at the nodes to both ends


@dataclass
class _Panel:
    """Interval of the driver travel in which the slip of the motor is approximated by one polynomial of the travel.

    Attributes:
        low, high: travel at both ends.
        inertia, slope, moment: reduced inertia without flywheel, its derivative, and load moment at the nodes.
        slips: slip at the nodes from the last solution, used as the next initial guess.
    """

    low: float
    high: float
    inertia: Real
    slope: Real
    moment: Real
    slips: Real | None = None

    @classmethod
    def of(cls, machine: ReducedMachine, low: float, high: float) -> _Panel:
        x = panel_nodes(np.array([low, high]))
        return cls(low, high, machine.inertia(x), machine.slope(x), machine.moment(x))


@dataclass
class MotorCycle:
    """Cycle of steady running of a machine with a motor. It can be solved for one flywheel after another.

    The cycle is divided into panels, on each of which the slip of the motor is a polynomial of the driver travel.

    Attributes:
        machine: the reduced machine.
        motor: the characteristic of the motor.
        whole: panels before any is halved.
        slip: slip at the beginning of the cycle in the last solution.
        panels: panels of the last solution.
    """

    machine: ReducedMachine
    motor: MotorCharacteristic
    whole: tuple[_Panel, ...]
    slip: float = 0.0
    panels: list[_Panel] = field(default_factory=list)

    @classmethod
    def of(cls, machine: ReducedMachine, motor: MotorCharacteristic) -> MotorCycle:
        """Prepare the cycle of a machine with a motor.

        Raises:
            WeakMotorError: the mean load exceeds the largest moment of the motor.
            RunawayError: the load drives the machine harder than the motor can brake it.
        """
        mean_moment = -machine.work_of_cycle / machine.length
        x = machine.moment.sample_points()
        if mean_moment >= motor.most:
            raise WeakMotorError(mean_moment, motor.most, float(x[np.argmin(machine.moment(x))]))
        if -mean_moment >= motor.holds:
            raise RunawayError(-mean_moment, motor.holds, motor.idle, float(x[np.argmax(machine.moment(x))]))
        edges = machine.moment.edges.tolist()
        return cls(machine, motor, tuple(_Panel.of(machine, *ends) for ends in pairwise(edges)))

    def law(self, flywheel: float) -> SteadyLaw:
        """Compute the law of motion with this flywheel inertia (kg m2, or kg).

        Raises:
            StandstillError: the machine stops.
            RunawayError: the machine runs away.
            LostDigitsError: rounding leaves too few digits.
        """
        slip, values, idle, self.panels = self.slip, np.zeros((NODES, 1)), self.motor.idle, list(self.whole)
        for _ in range(NEWTON_STEPS):
            end, slope, values = self._integrate_cycle(flywheel, slip)
            step = (slip - end) / (1 - slope) if slope < 1 else slip - end
            slip = min(slip - step, (slip + 1) / 2)
            largest = float(np.max(np.abs(values)))
            if slope < 1 and abs(step) <= LAST_STEP * largest:
                break
            if slope < 1 and abs(step) * (1 - slope) <= SLIP_ROUNDED * largest:  # the rest of the step is rounding
                if MOST_LOST_DIGITS * (1 - slope) < SLIP_ROUNDED:
                    raise self._lost_digits_error(values, 1 - slope)
                break
        else:
            raise self._unsteady_error(values)
        values = self._integrate_cycle(flywheel, slip)[2]
        inertia = flywheel + np.stack([panel.inertia for panel in self.panels], axis=1)
        speed = idle * (1 - values)
        energy, driving, pace = (
            PanelCurve(self._edges, VALUES_TO_COEFFICIENTS @ node_values)
            for node_values in (inertia * speed**2 / 2, self.motor.at_slip(values)[0], 1 / speed)
        )
        if abs(driving.total + self.machine.work_of_cycle) > WORK_IMBALANCE * energy.length * self.motor.most:
            raise self._lost_digits_error(
                values, 1 - slope
            )  # the flywheel is so heavy that the change of its energy in a cycle is rounding
        # on the rising branch of the characteristic this slip is a good initial guess for the next flywheel
        self.slip = slip if np.all(self.motor.at_slip(values)[1] > 0) else 0.0
        return SteadyLaw(self.machine, flywheel, energy, driving, pace.integrate())

    def _unsteady_error(self, values: Real) -> LinkageError:
        """Return the error to raise if the machine cannot run steadily.

        It is RunawayError if the mean slip shows that the machine runs away. Otherwise it is StandstillError at the
        travel where the slip is largest.
        """
        x, slips = panel_nodes(self._edges), values.T.ravel()
        if np.mean(values) < RUNAWAY:
            pushing, quickest = self.machine.work_of_cycle / self.machine.length, int(np.argmin(slips))
            speed = self.motor.idle * (1 - float(slips[quickest]))
            return RunawayError(pushing, self.motor.holds, self.motor.idle, float(x[quickest]), speed)
        return StandstillError(float(x[np.argmax(slips)]))

    def _lost_digits_error(self, values: Real, share: float) -> LinkageError:
        """Return the error to raise if rounding leaves too few digits of the slip; RunawayError if the machine runs
        away.
        """
        return self._unsteady_error(values) if np.mean(values) < RUNAWAY else LostDigitsError(share)

    @property
    def _edges(self) -> Real:
        return np.array([0.0, *(panel.high for panel in self.panels)])

    def _integrate_cycle(self, flywheel: float, begin: float) -> tuple[float, float, Real]:
        """Integrate the slip over one cycle. Panels on which it is not smooth enough are halved.

        begin: slip at the beginning of the cycle.

        Returns:
            Slip at the end of the cycle, its derivative with respect to `begin`, and the slip at the nodes, shape
            (nodes, panels).
        """
        pending, solved, slope, largest_slip = self.panels[::-1], list[_Panel](), 1.0, abs(begin)
        while pending:
            panel = pending.pop()
            solution = self._solve_panel(panel, flywheel, begin)
            largest = largest_slip if solution is None else max(largest_slip, float(np.abs(solution[:, 0]).max()))
            if solution is None or _is_rough(solution[:, 0], begin, largest):
                if panel.high - panel.low < NARROWEST * self.machine.length:
                    raise StandstillError(panel.low)
                middle = (panel.low + panel.high) / 2
                parts = pairwise((panel.low, middle, panel.high))
                pending += [_Panel.of(self.machine, *ends) for ends in parts][::-1]
                continue
            panel.slips = solution[:, 0]
            (begin, by_begin), largest_slip = (VALUES_TO_ENDS[1] @ solution).tolist(), largest
            slope *= by_begin
            solved.append(panel)
        self.panels = solved
        return begin, slope, np.stack([panel.slips for panel in solved if panel.slips is not None], axis=1)

    @np.errstate(all="ignore")  # at rest the derivative is not finite, and there is no solution
    def _solve_panel(self, panel: _Panel, flywheel: float, begin: float) -> Real | None:
        """Solve the slip on one panel by collocation and Newton's method.

        Returns:
            Slip at the nodes and its derivative with respect to the slip at the beginning of the panel, shape
            (nodes, 2); None if there is no solution.
        """
        idle, sums = self.motor.idle, (panel.high - panel.low) / 2 * VALUES_TO_INTEGRALS[:-1]
        values = np.full(NODES, begin) if panel.slips is None else panel.slips
        inertia, right = idle * (flywheel + panel.inertia), np.ones((NODES, 2))
        for _ in range(NEWTON_STEPS):
            speed = idle * (1 - values)
            driving, by_slip = self.motor.at_slip(values)
            under = inertia * speed
            rate = (panel.moment + driving - panel.slope * speed**2 / 2) / under
            by_rate = -(by_slip + panel.slope * speed * idle + rate * inertia * idle) / under
            right[:, 0] = begin - sums @ rate - values
            solution: Real = np.linalg.solve(IDENTITY - sums * by_rate, right)
            last = float(np.abs(solution[:, 0]).max())
            solution[:, 0] += values
            slips = solution[:, 0]
            largest = float(np.abs(slips).max())
            if not isfinite(largest):
                return None
            if slips.max() < 1 and last <= LAST_STEP * largest:
                return solution
            values = np.minimum(slips, (1 + values) / 2)
        return None


def _is_rough(values: Real, begin: float, largest_slip: float) -> bool:
    """Return True if one polynomial on this panel does not represent the slip accurately.

    The error is compared with the largest slip in the cycle so far.
    """
    tail = max(
        float(np.abs(VALUES_TO_COEFFICIENTS[-2:] @ values).max()), abs(float(VALUES_TO_ENDS[0] @ values) - begin)
    )
    return tail > TAIL * largest_slip


# Law of motion of a crank from a table of its speed: between rows the square of the speed is interpolated.
#
# The acceleration is half the derivative of the square with respect to the angle, so it is finite at rest too; a square
# that is linear between two rows means a constant acceleration between them.


LEAST_SQUARE = 1e-9  # of the largest squared speed: below it the travel time is not determined


@dataclass(frozen=True)
class SpeedTableLaw:
    """Law of motion of a crank whose speed is given by a table.

    Attributes:
        table: the table.
        start: crank angle at t = 0, rad.
        sense: sense of rotation, +1 or -1.
        cycle: angle after which the motion repeats, rad.
    """

    table: SpeedTable
    start: float
    sense: int
    cycle: float

    def speed(self, q: Real) -> Real:
        """Return the angular velocity with its sign (rad/s) at crank angles q; nan outside the table."""
        return self.sense * np.sqrt(np.maximum(self._within(self.table.squares(self._angle(q)), q), 0.0))

    def accelerated(self, q: Real) -> Real:
        """Return the angular acceleration with its sign (rad/s2) at crank angles q; nan outside the table."""
        accelerations = self.table.accelerations
        if accelerations is not None:
            return self.sense * self._within(accelerations(self._angle(q)), q)
        # at a row where the acceleration jumps, the value after the jump
        after = q if self.sense > 0 else q - 4 * SEAM * (1 + np.abs(q))
        return self._within(self.table.squares.slope(self._angle(after)) / 2, q)

    def time(self, q: Real) -> Real:
        """Return the time since the start (s) at crank angles q; nan outside the table.

        If the crank comes to rest at some angle of the table, the result is nan as well.
        """
        (laps, inner), (first, start_time) = (
            self._laps_and_time(to_float(q)),
            self._laps_and_time(to_float(self.start) + np.zeros(1)),
        )
        period = float(self._times(np.array([self._length]))[0]) if self.table.squares.closed else float("nan")
        return inner - start_time + np.where(laps == first, 0.0, (laps - first) * period)

    def _angle(self, q: Real) -> Real:
        """Reduce an angle to the cycle that begins with the first row of the table."""
        first, seam = self.table.squares.arguments[0], SEAM * (1 + np.abs(q))
        reduced: Real = first + np.maximum(np.mod(q - first + seam, self.cycle) - seam, 0.0)
        return reduced

    def _within(self, values: Real, q: Real) -> Real:
        """Return values at angles q, with nan where q is outside the table."""
        last = self.table.squares.arguments[-1]
        return np.where(self._angle(q) <= last + SEAM * (1 + np.abs(last)), values, np.nan)

    @cached_property
    def _first(self) -> float:
        """Angle of the first or the last row of the table, whichever the crank reaches first."""
        return float(to_float(self.table.squares.arguments[0 if self.sense > 0 else -1]))

    @cached_property
    def _length(self) -> float:
        arguments = self.table.squares.arguments
        return float(to_float(arguments[-1] - arguments[0]))

    @cached_property
    def _times(self) -> PanelCurve:
        """Time (s) as a function of the travel from the angle `_first`, at which the crank enters the table."""
        squares = self.table.squares
        edges = [self.sense * (float(to_float(row)) - self._first) for row in squares.arguments]

        def pace(x: Real) -> tuple[Real]:
            return (1 / np.sqrt(to_float(squares(self._first + self.sense * x))),)

        rows = np.array([float(to_float(value)) for value in squares.values])
        if np.min(rows) <= LEAST_SQUARE * np.max(rows):
            return PanelCurve(np.array([0.0, self._length]), np.full((1, 1), np.nan))
        return fit_curves(pace, edges)[0].integrate()

    def _laps_and_time(self, q: Real) -> tuple[Real, Real]:
        """Return the number of whole cycles since the crank was at the angle `_first`, and the time (s) in the current
        cycle.
        """
        travel = self.sense * (q - self._first)
        laps = np.floor((travel + SEAM * (1 + np.abs(travel))) / self.cycle)
        rest = travel - laps * self.cycle
        inner = np.where(rest <= self._length + SEAM, self._times(np.clip(rest, 0.0, self._length)), np.nan)
        return laps, inner
