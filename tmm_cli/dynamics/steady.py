"""Steady running: what drives the machine, the flywheel for a fluctuation of speed, and the law of motion with it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from tmm_cli.dynamics.by_motor import Cycle
from tmm_cli.dynamics.curves import Curve, fitted
from tmm_cli.dynamics.flywheel import (
    Flywheel,
    Tangent,
    at_mean,
    exact,
    lowest,
    mertsalov,
    sharper,
    touching,
    wittenbauer,
)
from tmm_cli.dynamics.motion import Law, under_constant_moment
from tmm_cli.dynamics.motors import Motor
from tmm_cli.dynamics.reduced import Reduced
from tmm_cli.dynamics.task import SteadyTask
from tmm_cli.errors import NoFlywheelError, NoInertiaError, RunawayError, StandstillError
from tmm_cli.roots import least, roots
from tmm_cli.tolerances import ROUNDOFF
from tmm_cli.vectors import Real

STANDS = 2.0  # fluctuation of a machine that comes to rest on its way: no larger one is possible
DOUBLINGS = 60  # of a flywheel, in search of one that is heavy enough
MET = 1e-12  # of a fluctuation: it is as wanted


@dataclass(frozen=True)
class Steady:
    """moment: mean of what drives over the cycle (N m, or N). own: fluctuation with the given flywheel alone, nan where
    the machine comes to rest then. work: of all moments from the beginning of the cycle (J).

    found: the flywheel by tangents, beside the given one; wittenbauer: its inertia (kg m2) by the tangents of a course;
    first_group: inertia J_I by Mertsalov of the flywheel with the links of constant speed ratio (kg m2); of a motor
    there are none.
    """

    task: SteadyTask
    machine: Reduced
    moment: float
    work: Curve
    law: Law
    own: float
    found: Flywheel | None = None
    wittenbauer: float = float("nan")
    first_group: float = float("nan")

    @property
    def mertsalov(self) -> float:
        """Inertia of the flywheel by Mertsalov, J_I less the links of constant speed ratio (kg m2)."""
        return self.first_group - self.machine.constant

    @property
    def on_shaft(self) -> float:
        """Inertia of the flywheel on its own shaft, kg m2: what is found, and a given one where nothing is."""
        return self.law.flywheel / self.task.ratio**2

    @property
    def errors(self) -> tuple[float, float]:
        """Of Wittenbauer's way and of Mertsalov's, shares of the exact flywheel."""
        exact = float("nan") if self.found is None else self.found.inertia
        return self.wittenbauer / exact - 1, self.mertsalov / exact - 1

    @property
    def diameter(self) -> float:
        """Of the flywheel, or the mean one of its rim, m."""
        return self.task.size.diameter(self.on_shaft)

    @property
    def width(self) -> float:
        """Of the flywheel, m."""
        return self.task.size.width * self.diameter

    @property
    def mass(self) -> float:
        """Of the flywheel, kg."""
        return self.task.size.mass(self.diameter)

    @property
    def speeds(self) -> tuple[float, float]:
        """The least and the largest speed of the driver, rad/s or m/s."""
        return extremes(self.law)

    @property
    def delta(self) -> float:
        """The fluctuation that there is."""
        return fluctuation(self.law)

    @property
    def tangents(self) -> tuple[Tangent, Tangent]:
        """To the energy-mass diagram, from where the inertia is -Jf and the energy -T0: of the largest and the least
        speed, whatever drives."""
        start = float(self.law.energy(np.zeros(1))[0])
        low, high = (self._touching(x, speed, start) for x, speed in extreme_places(self.law))
        return high, low

    def _touching(self, x: float, speed: float, start: float) -> Tangent:
        inertia = float(self.machine.inertia(np.array([x]))[0])
        return Tangent(x, inertia, (self.law.flywheel + inertia) * speed**2 / 2 - start, speed**2 / 2)

    @property
    def at_mean(self) -> tuple[Tangent, Tangent]:
        """By Mertsalov: tangents of the mean speed above the diagram and below it; the inertia is that of the second
        group, the links without a constant speed ratio."""
        slope = self.task.mean**2 / 2
        tangents = (touching(self.machine, self.work, slope, top=top) for top in (True, False))
        upper, lower = (replace(line, inertia=line.inertia - self.machine.constant) for line in tangents)
        return upper, lower


def extremes(law: Law) -> tuple[float, float]:
    """The least and the largest speed over the cycle, both searched for at once."""
    places, signs = law.energy.places(), np.array([1.0, -1.0])
    values = law.speed(places)
    best = np.argmin(signs[:, None] * values, axis=1)
    low, high = (places[np.clip(best + side, 0, len(places) - 1)] for side in (-1, 1))
    found = least(lambda x: (law.speed(x).reshape(-1, 2) * signs).ravel(), low, high)[1]
    slowest, quickest = signs * np.minimum(found, signs * values[best])
    return float(slowest), float(quickest)


def extreme_places(law: Law) -> tuple[tuple[float, float], tuple[float, float]]:
    """Where on the way the speed is least and largest, each with that speed."""
    places = law.energy.places()
    (slowest, low), (quickest, high) = lowest(law.speed, places), lowest(lambda x: -law.speed(x), places)
    length = law.energy.length
    return (
        (sharper(law.acceleration, slowest, length), low),
        (sharper(lambda x: -law.acceleration(x), quickest, length), -high),
    )


def fluctuation(law: Law) -> float:
    """The largest speed less the least, over the mean of both."""
    low, high = extremes(law)
    return 2 * (high - low) / (high + low)


def steady(machine: Reduced, task: SteadyTask) -> Steady:
    """Steady running of a machine. Raises StandstillError, NoFlywheelError, NoInertiaError."""
    if task.motor is not None:
        return _driven(machine, task, task.motor)
    moment = -machine.work_of_cycle / machine.length
    work = fitted(lambda x: (machine.work(x) + moment * x,), machine.work.edges)[0]
    energy, own = at_mean(machine, work, task.mean, task.flywheel)
    if task.delta is None:
        if np.isnan(energy):
            raise StandstillError(lowest(work, work.places())[0])
        law = under_constant_moment(machine, task.flywheel, energy, moment)
        return Steady(task, machine, moment, work, law, own)
    given = (machine, work, task.mean, task.delta)
    found = exact(*given)
    if found.inertia <= task.flywheel:
        raise NoFlywheelError(task.delta, own)
    law = under_constant_moment(machine, found.inertia, found.energy, moment)
    return Steady(task, machine, moment, work, law, own, found, wittenbauer(*given).inertia, mertsalov(*given))


def _driven(machine: Reduced, task: SteadyTask, motor: Motor) -> Steady:
    """With a motor's characteristic: a flywheel changes what the motor does, so its size is searched for."""

    cycle, places = Cycle.of(machine, motor), machine.inertia.places()
    inertia = machine.inertia(places)
    heaviest, lightest = float(np.max(inertia)), float(np.min(inertia))
    if task.delta is None and not task.flywheel + lightest > ROUNDOFF * heaviest:
        raise NoInertiaError(round(float(places[np.argmin(inertia)]), 9))

    def delta_of(flywheel: float) -> float:
        if not flywheel + lightest > ROUNDOFF * heaviest:  # all masses rest somewhere on the driver's way
            return STANDS
        try:
            return fluctuation(cycle.law(flywheel))
        except (StandstillError, RunawayError):
            return STANDS

    own = delta_of(task.flywheel)
    flywheel = task.flywheel
    if task.delta is not None:
        if own <= task.delta:
            raise NoFlywheelError(task.delta, own)
        flywheel = _searched(task.delta, delta_of, task.flywheel, heaviest)
    law = cycle.law(flywheel)
    gained = law.energy.coefficients.copy()
    gained[0] -= law.energy(np.zeros(1))[0]
    work = Curve(law.energy.edges, gained)
    return Steady(task, machine, law.driving.total / machine.length, work, law, own if own < STANDS else float("nan"))


def _searched(delta: float, delta_of: Callable[[float], float], low: float, unit: float) -> float:
    """The inertia with which the fluctuation is delta; with the least one, low, it is larger.

    One over the fluctuation grows with the flywheel nearly evenly, so that few trials are enough.
    """

    def over(flywheel: Real) -> Real:
        found = delta / delta_of(float(flywheel[0])) - 1
        return np.array([0.0 if abs(found) <= MET else found])

    below, above = np.array([low]), np.array([low + unit])
    for _ in range(DOUBLINGS):
        if over(above)[0] > 0:
            return float(roots(over, below, above)[0])
        below, above = above, 2 * above
    raise NoFlywheelError(delta, float("nan"))
