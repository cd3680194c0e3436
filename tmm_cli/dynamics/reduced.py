"""The machine reduced to its driver: inertia, its slope, and the moment of all loads, along the driver's way.

I. I. Artobolevsky, Theory of Mechanisms and Machines (1988), ch. 15 and 16: T = J w^2 / 2, J w' + J' w^2 / 2 = M.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from tmm_cli.dynamics.curves import Curve, fitted
from tmm_cli.vectors import Real

Sample = Callable[[Real], tuple[Real, Real, Real]]  # at ways x: inertia, its slope by x, moment of the loads


@dataclass(frozen=True)
class Reduced:
    """Over a cycle, by the way x that the driver has gone in its sense (rad, or m of a slider).

    inertia (kg m2, or kg), slope of it by x, moment of all loads but inertia (N m, or N) along the sense, and work of
    these from the beginning on (J). With a slider as driver, speeds are m/s and moments forces.
    constant: the inertia of the links with a constant speed ratio to the driver, and of the driver itself; with a
    flywheel they are the first group of N. I. Mertsalov (kg m2).
    """

    inertia: Curve
    slope: Curve
    moment: Curve
    work: Curve
    constant: float = 0.0

    @property
    def work_of_cycle(self) -> float:
        """What the loads do in a cycle, J."""
        return self.moment.total

    @property
    def length(self) -> float:
        return self.inertia.length


def reduced(sample: Sample, edges: Sequence[float], constant: float = 0.0) -> Reduced:
    """Of a machine that can be computed at any place; edges: where loads may jump, the ends of the cycle too."""
    inertia, slope, moment = fitted(sample, edges)
    return Reduced(inertia, slope, moment, moment.summed(), constant)
