"""Steady running of a machine that a motor drives by its characteristic: what it comes to, the same every cycle.

With the speed w = w0 (1 - s), w0 that of the motor without load, the slip s by the way x is what is found:

    -w0 (Jf + J) w s' = M + Md(s) - J' w^2 / 2.

In the slip no digit is lost where a motor is strong, and the equation is stiff: it is solved panel by panel, by
collocation in the nodes and Newton's method, and a panel ends with the value of its polynomial there, so that what has
died away within it does not come back (E. Hairer, G. Wanner, Solving Ordinary Differential Equations II (1996), IV.3).
A panel on which the slip is no polynomial is halved: after a jump of the load that is as often as the motor is strong.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from math import isfinite

import numpy as np
from numpy.polynomial import chebyshev

from tmm_cli.dynamics.curves import FIT, NODES, SUMS, Curve, nodes
from tmm_cli.dynamics.motion import Law
from tmm_cli.dynamics.motors import Motor
from tmm_cli.dynamics.reduced import Reduced
from tmm_cli.errors import LinkageError, LostDigitsError, RunawayError, StandstillError, WeakMotorError
from tmm_cli.tolerances import LAST_STEP
from tmm_cli.vectors import Real

STEPS = 60  # of Newton's method, at most
TAIL = 1e-13  # of the largest slip: the last coefficients are less, and a panel begins where the one before ends
SLIP_ROUNDED = 64 * 2.0**-53  # of the largest slip: a change over the cycle below that is rounding
MOST_LOST = 1e-6  # of the slip: where rounding leaves more of it open there is no answer
RUNAWAY = -1.0  # mean slip: a machine that turns twice as fast as its motor without load has run away
UNEVEN = 1e-6  # of a motor's largest moment: by more the works of a cycle are not in balance
NARROWEST = 1e-13  # of a cycle: where a panel as narrow as that has no solution the machine stands
EYE = np.eye(NODES)
ENDS: Real = chebyshev.chebvander(np.array([-1.0, 1.0]), NODES - 1) @ FIT  # values at the nodes to both ends


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
    def of(cls, machine: Reduced, low: float, high: float) -> _Panel:
        x = nodes(np.array([low, high]))
        return cls(low, high, machine.inertia(x), machine.slope(x), machine.moment(x))


@dataclass
class Cycle:
    """A cycle in panels, which are halved as it is run, for one flywheel after another.

    whole: before they are; slip: at the beginning of the cycle that was found last.
    """

    machine: Reduced
    motor: Motor
    whole: tuple[_Panel, ...]
    slip: float = 0.0
    panels: list[_Panel] = field(default_factory=list)

    @classmethod
    def of(cls, machine: Reduced, motor: Motor) -> Cycle:
        """Raises WeakMotorError, RunawayError."""
        wanted = -machine.work_of_cycle / machine.length
        x = machine.moment.places()
        if wanted >= motor.most:
            raise WeakMotorError(wanted, motor.most, float(x[np.argmin(machine.moment(x))]))
        if -wanted >= motor.holds:
            raise RunawayError(-wanted, motor.holds, motor.idle, float(x[np.argmax(machine.moment(x))]))
        edges = machine.moment.edges.tolist()
        return cls(machine, motor, tuple(_Panel.of(machine, *ends) for ends in pairwise(edges)))

    def law(self, flywheel: float) -> Law:
        """The steady running with a flywheel (kg m2, or kg). Raises StandstillError, RunawayError, LostDigitsError."""
        slip, values, idle, self.panels = self.slip, np.zeros((NODES, 1)), self.motor.idle, list(self.whole)
        for _ in range(STEPS):
            end, slope, values = self._run(flywheel, slip)
            step = (slip - end) / (1 - slope) if slope < 1 else slip - end
            slip = min(slip - step, (slip + 1) / 2)
            largest = float(np.max(np.abs(values)))
            if slope < 1 and abs(step) <= LAST_STEP * largest:
                break
            if slope < 1 and abs(step) * (1 - slope) <= SLIP_ROUNDED * largest:  # the rest of the step is rounding
                if MOST_LOST * (1 - slope) < SLIP_ROUNDED:
                    raise self._lost(values, 1 - slope)
                break
        else:
            raise self._unsteady(values)
        values = self._run(flywheel, slip)[2]
        inertia = flywheel + np.stack([panel.inertia for panel in self.panels], axis=1)
        speed = idle * (1 - values)
        energy, driving, pace = (
            Curve(self._edges, FIT @ own) for own in (inertia * speed**2 / 2, self.motor.at_slip(values)[0], 1 / speed)
        )
        if abs(driving.total + self.machine.work_of_cycle) > UNEVEN * energy.length * self.motor.most:
            raise self._lost(values, 1 - slope)  # so heavy a flywheel that a cycle's change of its energy is rounding
        # on the rising branch of the characteristic it is a good beginning for the next flywheel
        self.slip = slip if np.all(self.motor.at_slip(values)[1] > 0) else 0.0
        return Law(self.machine, flywheel, energy, driving, pace.summed())

    def _unsteady(self, values: Real) -> LinkageError:
        """A machine that runs away, or comes to rest where its slip is largest."""
        x, slips = nodes(self._edges), values.T.ravel()
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
            if found is None or _rough(found[:, 0], begin, largest):
                if panel.high - panel.low < NARROWEST * self.machine.length:
                    raise StandstillError(panel.low)
                middle = (panel.low + panel.high) / 2
                parts = pairwise((panel.low, middle, panel.high))
                left += [_Panel.of(self.machine, *ends) for ends in parts][::-1]
                continue
            panel.slips = found[:, 0]
            (begin, by_begin), size = (ENDS[1] @ found).tolist(), largest
            slope *= by_begin
            done.append(panel)
        self.panels = done
        return begin, slope, np.stack([panel.slips for panel in done if panel.slips is not None], axis=1)

    @np.errstate(all="ignore")  # at rest the rate is not finite, and there is no solution
    def _solved(self, panel: _Panel, flywheel: float, begin: float) -> Real | None:
        """Slips at the nodes, and their slopes by that at the beginning, (nodes, 2); None where there are none."""
        idle, sums = self.motor.idle, (panel.high - panel.low) / 2 * SUMS[:-1]
        values = np.full(NODES, begin) if panel.slips is None else panel.slips
        inertia, right = idle * (flywheel + panel.inertia), np.ones((NODES, 2))
        for _ in range(STEPS):
            speed = idle * (1 - values)
            driving, by_slip = self.motor.at_slip(values)
            under = inertia * speed
            rate = (panel.moment + driving - panel.slope * speed**2 / 2) / under
            by_rate = -(by_slip + panel.slope * speed * idle + rate * inertia * idle) / under
            right[:, 0] = begin - sums @ rate - values
            found: Real = np.linalg.solve(EYE - sums * by_rate, right)
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


def _rough(values: Real, begin: float, size: float) -> bool:
    """Whether slips are no polynomial that begins where it is to, beside the largest of all."""
    tail = max(float(np.abs(FIT[-2:] @ values).max()), abs(float(ENDS[0] @ values) - begin))
    return tail > TAIL * size
