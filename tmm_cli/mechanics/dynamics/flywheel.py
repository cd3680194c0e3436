"""Flywheel for a required fluctuation of speed: exact, by Wittenbauer and by Mertsalov.

Let E(x) be the work of all moments from the beginning of the cycle, T0 the energy at the beginning, J the
reduced inertia without the flywheel and Jf the inertia of the flywheel. The speed is w^2 = 2 (T0 + E) / (Jf
+ J). The conditions that the largest speed is w1 and the least w2 are linear in T0 and Jf, so the flywheel
follows without iteration:

    Jf = (max(w2^2 J / 2 - E) - min(w1^2 J / 2 - E)) / ((w1^2 - w2^2) / 2).

The two conditions are the tangents to the energy-mass diagram (J, E) with the slopes w1^2 / 2 and w2^2 / 2:
F. Wittenbauer, Graphische Dynamik (1923); I. I. Artobolevsky, Theory of Mechanisms and Machines (1988), ch.
19. In course projects w^2 (1 +- delta) is taken for w1^2 and w2^2.

N. I. Mertsalov divides the machine into a first group, the flywheel and the links with a constant speed
ratio to the driver (inertia Jc), and a second group, all other links (inertia J - Jc). The energy of the
second group is computed at the mean speed. The inertia of the first group is then J_I = (max - min of E -
(J - Jc) w^2 / 2) / (delta w^2), and that of the flywheel Jf = J_I - Jc: K. V. Frolov (ed.), Theory of
Mechanisms and Machines (1987).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from tmm_cli.mechanics.dynamics.reduced_model import PanelCurve, ReducedMachine
from tmm_cli.mechanics.numerics import Real, find_minima, find_roots

REFINEMENT_WIDTH = 1e-4  # rad (or m): accuracy of a tangent point found from function values


@dataclass(frozen=True)
class Tangent:
    """Tangent to the energy-mass diagram, with the whole diagram on one side.

    Attributes:
        x: driver travel at the point of contact.
        inertia, energy: coordinates of the point of contact, kg m2 and J.
        slope: w^2 / 2, J / (kg m2).
    """

    x: float
    inertia: float
    energy: float
    slope: float

    @property
    def offset(self) -> float:
        return self.energy - self.slope * self.inertia


@dataclass(frozen=True)
class FlywheelSolution:
    """Flywheel on the shaft of the driver.

    Attributes:
        inertia: moment of inertia, kg m2; negative if no flywheel is needed.
        energy: kinetic energy T0 at the beginning of the cycle, J.
        upper, lower: tangents to the energy-mass diagram for the largest and the least speed.
    """

    inertia: float
    energy: float
    upper: Tangent
    lower: Tangent


def exact_flywheel(machine: ReducedMachine, work: PanelCurve, mean: float, delta: float) -> FlywheelSolution:
    """Find the flywheel with which the speed varies exactly from w (1 - delta/2) to w (1 + delta/2).

    Args:
        machine: the reduced machine.
        work: work of all moments from the beginning of the cycle, J.
        mean: mean speed w, rad/s.
        delta: coefficient of fluctuation of speed.
    """
    return _flywheel_between(machine, work, mean * (1 - delta / 2), mean * (1 + delta / 2))


def wittenbauer_flywheel(machine: ReducedMachine, work: PanelCurve, mean: float, delta: float) -> FlywheelSolution:
    """Find the flywheel from tangents with the slopes w^2 (1 +- delta) / 2, as drawn in course projects.

    The arguments are those of `exact_flywheel`.
    """
    return _flywheel_between(machine, work, mean * np.sqrt(max(1 - delta, 0.0)), mean * np.sqrt(1 + delta))


def mertsalov_inertia(machine: ReducedMachine, work: PanelCurve, mean: float, delta: float) -> float:
    """Compute the inertia J_I of Mertsalov's first group (kg m2): the flywheel and the links with a constant speed
    ratio.

    The energy of the other links is computed at the mean speed. The arguments are those of `exact_flywheel`.
    """
    slope = mean**2 / 2
    upper, lower = find_tangent(machine, work, slope, top=True), find_tangent(machine, work, slope, top=False)
    return (upper.offset - lower.offset) / (delta * mean**2)


def energy_at_mean_speed(
    machine: ReducedMachine, work: PanelCurve, mean: float, flywheel: float = 0.0
) -> tuple[float, float]:
    """Find the energy at the beginning of the cycle for which the mean of the largest and the least speed is `mean`.

    Returns:
        The energy (J) and the coefficient of fluctuation. Both are nan if the machine stops at that mean speed, or if
        its inertia is zero at some driver coordinate.
    """
    nodes = work.sample_points()
    if flywheel + float(np.min(machine.inertia(nodes))) <= 0:
        return float("nan"), float("nan")

    def speeds(energy: Real) -> Real:
        """Return the least and the largest speed for each initial energy, (energies, 2)."""
        square = [
            (find_minimum(squared_speed, nodes)[1], -find_minimum(partial(_negated, squared_speed), nodes)[1])
            for squared_speed in (partial(_squared_speed, machine, work, flywheel, float(e)) for e in np.ravel(energy))
        ]
        return np.asarray(np.sqrt(np.maximum(np.array(square), 0.0)))

    low = -float(np.min(work(nodes)))
    high = low + np.ptp(work(nodes)) + mean**2 * (float(np.max(machine.inertia(nodes))) + flywheel)
    if speeds(np.array([low])).mean() >= mean:
        return float("nan"), float("nan")
    energy = find_roots(lambda e: speeds(e).mean(axis=1) - mean, np.array([low]), np.array([high]))
    slowest, quickest = speeds(energy)[0]
    return float(energy[0]), float((quickest - slowest) / mean)


def _flywheel_between(machine: ReducedMachine, work: PanelCurve, low: float, high: float) -> FlywheelSolution:
    upper = find_tangent(machine, work, high**2 / 2, top=True)
    lower = find_tangent(machine, work, low**2 / 2, top=False)
    inertia = (upper.offset - lower.offset) / (upper.slope - lower.slope)
    # T0 + E <= slope (Jf + J) with equality where the upper tangent touches
    return FlywheelSolution(inertia, upper.slope * inertia - upper.offset, upper, lower)


def find_tangent(machine: ReducedMachine, work: PanelCurve, slope: float, *, top: bool) -> Tangent:
    """Find the tangent of this slope to the energy-mass diagram.

    top: True for the tangent that touches the diagram from above, False for the one that touches it from below.
    """
    sign = -1.0 if top else 1.0

    def height(x: Real) -> Real:
        return sign * (work(x) - slope * machine.inertia(x))

    x, __ = find_minimum(height, work.sample_points())
    rate = work.slope()

    def steepness(x: Real) -> Real:
        return sign * (rate(x) - slope * machine.slope(x))

    x = refine_minimum(steepness, x, work.length)
    at = np.array([x])
    return Tangent(x, float(machine.inertia(at)[0]), float(work(at)[0]), slope)


def _squared_speed(machine: ReducedMachine, work: PanelCurve, inertia: float, energy: float, x: Real) -> Real:
    return 2 * (energy + work(x)) / (inertia + machine.inertia(x))


def _negated(function: Callable[[Real], Real], x: Real) -> Real:
    return -function(x)


def refine_minimum(rate: Callable[[Real], Real], x: float, length: float) -> float:
    """Refine a minimum near x, inside 0..length, to full precision: find where its derivative `rate` changes sign.

    Function values alone give only half the digits. The sign may also change at a jump of the load.
    """
    ends = np.clip([x - REFINEMENT_WIDTH, x + REFINEMENT_WIDTH], 0.0, np.nextafter(length, 0.0))
    below, above = rate(ends)
    return float(find_roots(rate, ends[:1], ends[1:])[0]) if below < 0 < above else x


def find_minimum(function: Callable[[Real], Real], nodes: Real) -> tuple[float, float]:
    """Return the argument and the value of the minimum of a function; `nodes` must separate its local minima."""
    values = function(nodes)
    best = int(np.argmin(values))
    x, value = find_minima(function, float(nodes[max(best - 1, 0)]), float(nodes[min(best + 1, len(nodes) - 1)]))
    return (x, value) if value < values[best] else (float(nodes[best]), float(values[best]))
