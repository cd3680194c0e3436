"""Steady running of a machine that a motor drives by its characteristic: what it comes to, the same every cycle.

With the speed w = w0 (1 - s), w0 that of the motor without load, the slip s by the way x is what is found:

    -w0 (Jf + J) w s' = M + Md(s) - J' w^2 / 2.

In the slip no digit is lost where a motor is strong, and the equation is stiff: it is solved panel by panel, by
collocation in the nodes and Newton's method, and a panel ends with the value of its polynomial there, so that what has
died away within it does not come back (E. Hairer, G. Wanner, Solving Ordinary Differential Equations II (1996), IV.3).
A panel on which the slip is no polynomial is halved: after a jump of the load that is as often as the motor is strong.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.polynomial import chebyshev

from tmm_cli.dynamics.curves import FIT, NODES, SUMS, Curve, nodes
from tmm_cli.dynamics.motion import Law
from tmm_cli.dynamics.motors import Motor
from tmm_cli.dynamics.reduced import Reduced
from tmm_cli.errors import StandstillError, WeakMotorError
from tmm_cli.tolerances import LAST_STEP
from tmm_cli.vectors import Real

STEPS = 60  # of Newton's method, at most
TAIL = 1e-13  # of the largest slip: the last coefficients are less, and a panel begins where the one before ends
NARROWEST = 1e-13  # of a cycle: where a panel as narrow as that has no solution the machine stands
ENDS: Real = chebyshev.chebvander(np.array([-1.0, 1.0]), NODES - 1) @ FIT  # values at the nodes to both ends


def with_motor(machine: Reduced, flywheel: float, motor: Motor) -> Law:
    """What the machine comes to when every cycle is as the one before, from the motor's speed without load on.

    Raises WeakMotorError, StandstillError.
    """
    wanted = -machine.work_of_cycle / machine.length
    if wanted >= motor.most:
        raise WeakMotorError(wanted, motor.most)
    cycle, slip = _Cycle.of(machine, flywheel, motor), 0.0
    for _ in range(STEPS):
        end, slope, values = cycle.run(slip)
        step = (slip - end) / (1 - slope) if slope < 1 else slip - end
        slip = min(slip - step, (slip + 1) / 2)
        if slope < 1 and abs(step) <= LAST_STEP * float(np.max(np.abs(values))):
            break
    else:
        raise StandstillError(float(nodes(cycle.edges)[np.argmax(values.T)]))
    values = cycle.run(slip)[2]
    inertia = np.stack([panel.inertia for panel in cycle.panels], axis=1)
    speed = motor.idle * (1 - values)
    energy, driving, pace = (
        Curve(cycle.edges, FIT @ own) for own in (inertia * speed**2 / 2, motor.at_slip(values)[0], 1 / speed)
    )
    return Law(machine, flywheel, energy, driving, pace.summed())


@dataclass(frozen=True)
class _Panel:
    """inertia: with the flywheel; slope of it by the way; moment of the loads: at the nodes between low and high."""

    low: float
    high: float
    inertia: Real
    slope: Real
    moment: Real

    @classmethod
    def of(cls, machine: Reduced, flywheel: float, low: float, high: float) -> _Panel:
        x = nodes(np.array([low, high]))
        return cls(low, high, flywheel + machine.inertia(x), machine.slope(x), machine.moment(x))


@dataclass
class _Cycle:
    """A cycle in panels, which are halved as it is run."""

    machine: Reduced
    flywheel: float
    motor: Motor
    panels: list[_Panel]

    @classmethod
    def of(cls, machine: Reduced, flywheel: float, motor: Motor) -> _Cycle:
        panels = [_Panel.of(machine, flywheel, *ends) for ends in pairwise(machine.moment.edges.tolist())]
        return cls(machine, flywheel, motor, panels)

    @property
    def edges(self) -> Real:
        return np.array([0.0, *(panel.high for panel in self.panels)])

    def run(self, begin: float) -> tuple[float, float, Real]:
        """Slip after the cycle, its slope by that at the beginning, and slips at the nodes, (nodes, panels).

        Raises StandstillError.
        """
        left, done, values, slope, size = self.panels[::-1], list[_Panel](), list[Real](), 1.0, abs(begin)
        while left:
            panel = left.pop()
            found = self._solved(panel, begin)
            largest = size if found is None else max(size, float(np.max(np.abs(found[0]))))
            if found is None or _rough(found[0], begin, largest):
                if panel.high - panel.low < NARROWEST * self.machine.length:
                    raise StandstillError(panel.low)
                middle = (panel.low + panel.high) / 2
                parts = pairwise((panel.low, middle, panel.high))
                left += [_Panel.of(self.machine, self.flywheel, *ends) for ends in parts][::-1]
                continue
            own, by_begin = found
            begin, size = float(ENDS[1] @ own), largest
            slope *= float(ENDS[1] @ by_begin)
            done.append(panel)
            values.append(own)
        self.panels = done
        return begin, slope, np.stack(values, axis=1)

    def _solved(self, panel: _Panel, begin: float) -> tuple[Real, Real] | None:
        """Slips at the nodes, and their slopes by that at the beginning; None where there are none."""
        idle, sums = self.motor.idle, (panel.high - panel.low) / 2 * SUMS[:-1]
        values = np.full(NODES, begin)
        for _ in range(STEPS):
            speed = idle * (1 - values)
            driving, by_slip = self.motor.at_slip(values)
            under = idle * panel.inertia * speed
            own = panel.moment + driving - panel.slope * speed**2 / 2
            rate = -(by_slip + panel.slope * speed * idle) / under - own * idle**2 * panel.inertia / under**2
            matrix = np.eye(NODES) - sums * rate
            step = np.linalg.solve(matrix, begin - sums @ (own / under) - values)
            found = values + step
            if not np.all(np.isfinite(found)):
                return None
            if np.all(np.abs(step) <= LAST_STEP * np.max(np.abs(found))) and np.all(found < 1):
                return found, np.linalg.solve(matrix, np.ones(NODES))
            values = np.minimum(found, (1 + values) / 2)
        return None


def _rough(values: Real, begin: float, size: float) -> bool:
    """Whether slips are no polynomial that begins where it is to, beside the largest of all."""
    tail = max(float(np.max(np.abs(FIT[-2:] @ values))), abs(float(ENDS[0] @ values) - begin))
    return tail > TAIL * size
