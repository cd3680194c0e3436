"""The law of motion of steady running: speed, acceleration and time along the way of the driver, the same every cycle.

Under a constant driving moment Md the kinetic energy T by the way x is a sum: dT/dx = M(x) + Md, w^2 = 2 T / (Jf + J).
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
    """Along the way x of a cycle (rad, or m of a slider). flywheel: its inertia on the driver (kg m2, or kg).

    energy: kinetic energy (J), that of the flywheel with it; driving: moment of what drives (N m, or N); time: since
    the beginning (s).
    """

    machine: ReducedMachine
    flywheel: float
    energy: PanelCurve
    driving: PanelCurve
    time: PanelCurve

    def speed(self, x: Real) -> Real:
        """rad/s, or m/s."""
        return np.sqrt(2 * self.energy(x) / (self.flywheel + self.machine.inertia(x)))

    def acceleration(self, x: Real) -> Real:
        """rad/s2, or m/s2; where a load jumps, that after it."""
        moment = self.driving(x) + self.machine.moment(x) - self.machine.slope(x) * self.speed(x) ** 2 / 2
        found: Real = moment / (self.flywheel + self.machine.inertia(x))
        return found

    @property
    def period(self) -> float:
        """Time of a cycle, s."""
        return float(self.time(np.array([self.time.length]))[0])


def constant_moment_law(machine: ReducedMachine, flywheel: float, energy: float, moment: float) -> SteadyLaw:
    """From an energy (J) at the beginning of the cycle. Raises StandstillError."""
    work = fit_curves(lambda x: (energy + machine.work(x) + moment * x,), machine.work.edges)[0]
    places = work.places()
    values = work(places)
    if not np.all(values > 0):
        raise StandstillError(float(places[np.argmin(values)]))

    def parts(x: Real) -> Sequence[Real]:
        return np.sqrt((flywheel + machine.inertia(x)) / (2 * work(x))), np.full(np.shape(x), moment)

    pace, driving = fit_curves(parts, work.edges)
    return SteadyLaw(machine, flywheel, work, driving, pace.summed())


# Steady running of a machine that a motor drives by its characteristic: what it comes to, the same every cycle.
#
# With the speed w = w0 (1 - s), w0 that of the motor without load, the slip s by the way x is what is found:
#
#     -w0 (Jf + J) w s' = M + Md(s) - J' w^2 / 2.
#
# In the slip no digit is lost where a motor is strong, and the equation is stiff: it is solved panel by panel, by
# collocation in the nodes and Newton's method, and a panel ends with the value of its polynomial there, so that what
# has died away within it does not come back (E. Hairer, G. Wanner, Solving Ordinary Differential Equations II (1996),
# IV.3). A panel on which the slip is no polynomial is halved: after a jump of the load that is as often as the motor
# is strong.


NEWTON_STEPS = 60  # of Newton's method, at most
TAIL = 1e-13  # of the largest slip: the last coefficients are less, and a panel begins where the one before ends
SLIP_ROUNDED = 64 * 2.0**-53  # of the largest slip: a change over the cycle below that is rounding
MOST_LOST_DIGITS = 1e-6  # of the slip: where rounding leaves more of it open there is no answer
RUNAWAY = -1.0  # mean slip: a machine that turns twice as fast as its motor without load has run away
WORK_IMBALANCE = 1e-6  # of a motor's largest moment: by more the works of a cycle are not in balance
NARROWEST = 1e-13  # of a cycle: where a panel as narrow as that has no solution the machine stands
IDENTITY = np.eye(NODES)
VALUES_TO_ENDS: Real = (
    chebyshev.chebvander(np.array([-1.0, 1.0]), NODES - 1) @ VALUES_TO_COEFFICIENTS
)  # values at the nodes to both ends


@dataclass
class _Panel:
    """inertia without flywheel, slope of it by the way, moment of the loads: at the nodes between low and high.

    slips: found there last, from which the next search begins.
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
    """A cycle in panels, which are halved as it is run, for one flywheel after another.

    whole: before they are; slip: at the beginning of the cycle that was found last.
    """

    machine: ReducedMachine
    motor: MotorCharacteristic
    whole: tuple[_Panel, ...]
    slip: float = 0.0
    panels: list[_Panel] = field(default_factory=list)

    @classmethod
    def of(cls, machine: ReducedMachine, motor: MotorCharacteristic) -> MotorCycle:
        """Raises WeakMotorError, RunawayError."""
        wanted = -machine.work_of_cycle / machine.length
        x = machine.moment.places()
        if wanted >= motor.most:
            raise WeakMotorError(wanted, motor.most, float(x[np.argmin(machine.moment(x))]))
        if -wanted >= motor.holds:
            raise RunawayError(-wanted, motor.holds, motor.idle, float(x[np.argmax(machine.moment(x))]))
        edges = machine.moment.edges.tolist()
        return cls(machine, motor, tuple(_Panel.of(machine, *ends) for ends in pairwise(edges)))

    def law(self, flywheel: float) -> SteadyLaw:
        """The steady running with a flywheel (kg m2, or kg). Raises StandstillError, RunawayError, LostDigitsError."""
        slip, values, idle, self.panels = self.slip, np.zeros((NODES, 1)), self.motor.idle, list(self.whole)
        for _ in range(NEWTON_STEPS):
            end, slope, values = self._run(flywheel, slip)
            step = (slip - end) / (1 - slope) if slope < 1 else slip - end
            slip = min(slip - step, (slip + 1) / 2)
            largest = float(np.max(np.abs(values)))
            if slope < 1 and abs(step) <= LAST_STEP * largest:
                break
            if slope < 1 and abs(step) * (1 - slope) <= SLIP_ROUNDED * largest:  # the rest of the step is rounding
                if MOST_LOST_DIGITS * (1 - slope) < SLIP_ROUNDED:
                    raise self._lost(values, 1 - slope)
                break
        else:
            raise self._unsteady(values)
        values = self._run(flywheel, slip)[2]
        inertia = flywheel + np.stack([panel.inertia for panel in self.panels], axis=1)
        speed = idle * (1 - values)
        energy, driving, pace = (
            PanelCurve(self._edges, VALUES_TO_COEFFICIENTS @ own)
            for own in (inertia * speed**2 / 2, self.motor.at_slip(values)[0], 1 / speed)
        )
        if abs(driving.total + self.machine.work_of_cycle) > WORK_IMBALANCE * energy.length * self.motor.most:
            raise self._lost(values, 1 - slope)  # so heavy a flywheel that a cycle's change of its energy is rounding
        # on the rising branch of the characteristic it is a good beginning for the next flywheel
        self.slip = slip if np.all(self.motor.at_slip(values)[1] > 0) else 0.0
        return SteadyLaw(self.machine, flywheel, energy, driving, pace.summed())

    def _unsteady(self, values: Real) -> LinkageError:
        """A machine that runs away, or comes to rest where its slip is largest."""
        x, slips = panel_nodes(self._edges), values.T.ravel()
        if np.mean(values) < RUNAWAY:
            pushing, quickest = self.machine.work_of_cycle / self.machine.length, int(np.argmin(slips))
            speed = self.motor.idle * (1 - float(slips[quickest]))
            return RunawayError(pushing, self.motor.holds, self.motor.idle, float(x[quickest]), speed)
        return StandstillError(float(x[np.argmax(slips)]))

    def _lost(self, values: Real, share: float) -> LinkageError:
        """A machine of whose slip rounding leaves too few digits, if it does not run away."""
        return self._unsteady(values) if np.mean(values) < RUNAWAY else LostDigitsError(share)

    @property
    def _edges(self) -> Real:
        return np.array([0.0, *(panel.high for panel in self.panels)])

    def _run(self, flywheel: float, begin: float) -> tuple[float, float, Real]:
        """Slip after the cycle, its slope by that at the beginning, and slips at the nodes, (nodes, panels)."""
        left, done, slope, size = self.panels[::-1], list[_Panel](), 1.0, abs(begin)
        while left:
            panel = left.pop()
            found = self._solved(panel, flywheel, begin)
            largest = size if found is None else max(size, float(np.abs(found[:, 0]).max()))
            if found is None or _is_rough(found[:, 0], begin, largest):
                if panel.high - panel.low < NARROWEST * self.machine.length:
                    raise StandstillError(panel.low)
                middle = (panel.low + panel.high) / 2
                parts = pairwise((panel.low, middle, panel.high))
                left += [_Panel.of(self.machine, *ends) for ends in parts][::-1]
                continue
            panel.slips = found[:, 0]
            (begin, by_begin), size = (VALUES_TO_ENDS[1] @ found).tolist(), largest
            slope *= by_begin
            done.append(panel)
        self.panels = done
        return begin, slope, np.stack([panel.slips for panel in done if panel.slips is not None], axis=1)

    @np.errstate(all="ignore")  # at rest the rate is not finite, and there is no solution
    def _solved(self, panel: _Panel, flywheel: float, begin: float) -> Real | None:
        """Slips at the nodes, and their slopes by that at the beginning, (nodes, 2); None where there are none."""
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
            found: Real = np.linalg.solve(IDENTITY - sums * by_rate, right)
            last = float(np.abs(found[:, 0]).max())
            found[:, 0] += values
            own = found[:, 0]
            largest = float(np.abs(own).max())
            if not isfinite(largest):
                return None
            if own.max() < 1 and last <= LAST_STEP * largest:
                return found
            values = np.minimum(own, (1 + values) / 2)
        return None


def _is_rough(values: Real, begin: float, size: float) -> bool:
    """Whether slips are no polynomial that begins where it is to, beside the largest of all."""
    tail = max(
        float(np.abs(VALUES_TO_COEFFICIENTS[-2:] @ values).max()), abs(float(VALUES_TO_ENDS[0] @ values) - begin)
    )
    return tail > TAIL * size


# The law of motion of a crank by a table of its speeds: between rows the square of the speed is interpolated.
#
# The acceleration is half the slope of the square by the angle, so it is finite at rest too; linear squares are a
# constant acceleration from row to row.


LEAST_SQUARE = 1e-9  # of the largest square of the speed: with less somewhere the time of a way is not told


@dataclass(frozen=True)
class SpeedTableLaw:
    """Of a crank in its sense; start: its angle at t = 0 (rad); cycle: after which all comes again (rad)."""

    table: SpeedTable
    start: float
    sense: int
    cycle: float

    def speed(self, q: Real) -> Real:
        """rad/s, with its sign; nan where the table does not reach."""
        return self.sense * np.sqrt(np.maximum(self._within(self.table.squares(self._angle(q)), q), 0.0))

    def accelerated(self, q: Real) -> Real:
        """rad/s2, with its sign."""
        given = self.table.accelerations
        if given is not None:
            return self.sense * self._within(given(self._angle(q)), q)
        # in a row where it jumps, that after it
        after = q if self.sense > 0 else q - 4 * SEAM * (1 + np.abs(q))
        return self._within(self.table.squares.slope(self._angle(after)) / 2, q)

    def time(self, q: Real) -> Real:
        """s, since the start; nan where the table has a rest, or does not reach."""
        (laps, inner), (first, begun) = self._passed(to_float(q)), self._passed(to_float(self.start) + np.zeros(1))
        period = float(self._times(np.array([self._length]))[0]) if self.table.squares.closed else float("nan")
        return inner - begun + np.where(laps == first, 0.0, (laps - first) * period)

    def _angle(self, q: Real) -> Real:
        """Within the cycle that begins with the table."""
        first, seam = self.table.squares.arguments[0], SEAM * (1 + np.abs(q))
        found: Real = first + np.maximum(np.mod(q - first + seam, self.cycle) - seam, 0.0)
        return found

    def _within(self, values: Real, q: Real) -> Real:
        """Values where the table reaches."""
        last = self.table.squares.arguments[-1]
        return np.where(self._angle(q) <= last + SEAM * (1 + np.abs(last)), values, np.nan)

    @cached_property
    def _first(self) -> float:
        """The end of the table that the driver comes to first."""
        return float(to_float(self.table.squares.arguments[0 if self.sense > 0 else -1]))

    @cached_property
    def _length(self) -> float:
        arguments = self.table.squares.arguments
        return float(to_float(arguments[-1] - arguments[0]))

    @cached_property
    def _times(self) -> PanelCurve:
        """Time by the way from the first end of the table on, s."""
        squares = self.table.squares
        edges = [self.sense * (float(to_float(row)) - self._first) for row in squares.arguments]

        def pace(x: Real) -> tuple[Real]:
            return (1 / np.sqrt(to_float(squares(self._first + self.sense * x))),)

        rows = np.array([float(to_float(value)) for value in squares.values])
        if np.min(rows) <= LEAST_SQUARE * np.max(rows):
            return PanelCurve(np.array([0.0, self._length]), np.full((1, 1), np.nan))
        return fit_curves(pace, edges)[0].summed()

    def _passed(self, q: Real) -> tuple[Real, Real]:
        """Whole cycles since the first end of the table, and the time in the one that is under way, s."""
        way = self.sense * (q - self._first)
        laps = np.floor((way + SEAM * (1 + np.abs(way))) / self.cycle)
        rest = way - laps * self.cycle
        inner = np.where(rest <= self._length + SEAM, self._times(np.clip(rest, 0.0, self._length)), np.nan)
        return laps, inner
