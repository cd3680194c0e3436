"""The law of motion of steady running: speed, acceleration and time along the way of the driver, the same every cycle.

Under a constant driving moment Md the kinetic energy T by the way x is a sum: dT/dx = M(x) + Md, w^2 = 2 T / (Jf + J).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tmm_cli.dynamics.curves import Curve, fitted
from tmm_cli.dynamics.reduced import Reduced
from tmm_cli.errors import StandstillError
from tmm_cli.vectors import Real


@dataclass(frozen=True)
class Law:
    """Along the way x of a cycle (rad, or m of a slider). flywheel: its inertia on the driver (kg m2, or kg).

    energy: kinetic energy (J), that of the flywheel with it; driving: moment of what drives (N m, or N); time: since
    the beginning (s).
    """

    machine: Reduced
    flywheel: float
    energy: Curve
    driving: Curve
    time: Curve

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


def under_constant_moment(machine: Reduced, flywheel: float, energy: float, moment: float) -> Law:
    """From an energy (J) at the beginning of the cycle. Raises StandstillError."""
    work = fitted(lambda x: (energy + machine.work(x) + moment * x,), machine.work.edges)[0]
    places = work.places()
    values = work(places)
    if not np.all(values > 0):
        raise StandstillError(float(places[np.argmin(values)]))

    def parts(x: Real) -> Sequence[Real]:
        return np.sqrt((flywheel + machine.inertia(x)) / (2 * work(x))), np.full(np.shape(x), moment)

    pace, driving = fitted(parts, work.edges)
    return Law(machine, flywheel, work, driving, pace.summed())
