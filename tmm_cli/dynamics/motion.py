"""The law of motion of steady running: speed, acceleration and time along the way of the driver, the same every cycle.

Kinetic energy T by the way x is what is found: dT/dx = M(x) + Md(w), w^2 = 2 T / (Jf + J). Under a constant driving
moment it is a sum; with a motor's characteristic it is found panel by panel, by collocation in the nodes and Newton's
method, and begins with what comes back after a cycle.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tmm_cli.dynamics.curves import FIT, NODES, SUMS, Curve, fitted, nodes
from tmm_cli.dynamics.motors import Constant, Motor
from tmm_cli.dynamics.reduced import Reduced
from tmm_cli.errors import StandstillError
from tmm_cli.tolerances import LAST_STEP
from tmm_cli.vectors import Real

STEPS = 60  # of Newton's method, at most
ROUNDS = 8  # of halving panels on which the energy is no polynomial yet
FINER = 4  # of them, where a machine seems to come to rest
TAIL = 1e-13  # of the largest energy: its last coefficients are less


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
        found: Real = np.sqrt(2 * self.energy(x) / (self.flywheel + self.machine.inertia(x)))
        return found

    def acceleration(self, x: Real) -> Real:
        """rad/s2, or m/s2; where a load jumps, that after it."""
        moment = self.driving(x) + self.machine.moment(x) - self.machine.slope(x) * self.speed(x) ** 2 / 2
        found: Real = moment / (self.flywheel + self.machine.inertia(x))
        return found

    @property
    def period(self) -> float:
        """Time of a cycle, s."""
        return float(self.time(np.array([self.time.length]))[0])


def of_energy(machine: Reduced, flywheel: float, energy: Curve, motor: Motor) -> Law:
    """The law with this energy along the way, of what drives with it. Raises StandstillError."""
    places = energy.places()
    values = energy(places)
    if not np.all(values > 0):
        raise StandstillError(float(places[np.argmin(values)]))

    def parts(x: Real) -> Sequence[Real]:
        speed = np.sqrt(2 * energy(x) / (flywheel + machine.inertia(x)))
        return 1 / speed, motor.moment(speed)[0]

    pace, driving = fitted(parts, energy.edges)
    return Law(machine, flywheel, energy, driving, pace.summed())


def under_constant_moment(machine: Reduced, flywheel: float, energy: float, moment: float) -> Law:
    """From an energy (J) at the beginning of the cycle. Raises StandstillError."""
    work = fitted(lambda x: (energy + machine.work(x) + moment * x,), machine.work.edges)[0]
    return of_energy(machine, flywheel, work, Constant(moment))


def with_motor(machine: Reduced, flywheel: float, motor: Motor, guess: float) -> Law:
    """What the machine comes to when every cycle is as the one before; guess: a speed to begin with, rad/s.

    Raises StandstillError.
    """
    edges = machine.moment.edges
    begin = (flywheel + float(machine.inertia(np.zeros(1))[0])) * guess**2 / 2
    for left in reversed(range(ROUNDS)):
        try:
            begin, values = _periodic(_Cycle.of(machine, flywheel, motor, edges), begin)
        except StandstillError:  # or a motor so strong that the energy is no polynomial on a panel
            if left < ROUNDS - FINER:
                raise
            edges = np.sort(np.concatenate([edges, (edges[:-1] + edges[1:]) / 2]))
            continue
        tails = np.abs(FIT[-2:] @ values).max(axis=0)
        rough = tails > TAIL * float(np.max(values))
        if not (rough.any() and left):
            break
        edges = np.sort(np.concatenate([edges, (edges[:-1] + edges[1:])[rough] / 2]))
    return of_energy(machine, flywheel, Curve(edges, FIT @ values), motor)


def _periodic(cycle: _Cycle, begin: float) -> tuple[float, Real]:
    """The energy that comes back after a cycle, and the energies at the nodes of its panels."""
    for _ in range(STEPS):
        end, slope, __ = cycle.run(begin)
        step = (begin - end) / (1 - slope) if slope < 1 else begin - end
        begin = max(begin - step, begin / 4)
        if abs(step) <= LAST_STEP * begin:
            break
    return begin, cycle.run(begin)[2]


@dataclass(frozen=True)
class _Cycle:
    """A cycle in numbers. Arrays are (panels, nodes); half: of the widths of panels, (panels,)."""

    inertia: Real
    moment: Real
    half: Real
    edges: Real
    motor: Motor

    @classmethod
    def of(cls, machine: Reduced, flywheel: float, motor: Motor, edges: Real) -> _Cycle:
        x = nodes(edges)
        inertia, moment = (of(x).reshape(-1, NODES) for of in (machine.inertia, machine.moment))
        return cls(flywheel + inertia, moment, np.diff(edges) / 2, edges, motor)

    def run(self, begin: float) -> tuple[float, float, Real]:
        """Energy after the cycle, its slope by that at the beginning, and energies at the nodes, (nodes, panels)."""
        slope, values = 1.0, np.empty((NODES, len(self.half)))
        for panel in range(len(self.half)):  # the energy at the end of one is that at the beginning of the next
            values[:, panel], begin, own = self._panel(panel, begin)
            slope *= own
        return begin, slope, values

    def _panel(self, panel: int, begin: float) -> tuple[Real, float, float]:
        inertia, moment, half = self.inertia[panel], self.moment[panel], self.half[panel]
        values = np.full(NODES, begin)
        for _ in range(STEPS):
            speed = np.sqrt(2 * values / inertia)
            own, by_speed = self.motor.moment(speed)
            rate = by_speed / (inertia * speed)  # of the driving moment by the energy
            matrix = np.eye(NODES) - half * SUMS[:-1] * rate
            step = np.linalg.solve(matrix, begin + half * (SUMS[:-1] @ (own + moment)) - values)
            found = values + step
            if not np.all(found > 0):
                if float(np.max(values)) < LAST_STEP * begin:
                    break
                found = np.maximum(found, values / 4)
            done = bool(np.all(np.abs(step) <= LAST_STEP * values))
            values = found
            if done:
                speed = np.sqrt(2 * values / inertia)
                own, by_speed = self.motor.moment(speed)
                sums = SUMS[-1] @ (own + moment)
                slope = 1 + half * (SUMS[-1] @ (by_speed / (inertia * speed) * np.linalg.solve(matrix, np.ones(NODES))))
                return values, begin + half * sums, slope
        raise StandstillError(float(self.edges[panel]))
