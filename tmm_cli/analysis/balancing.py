"""Balancing of a mechanism: shaking over its cycle and at its positions, at the constant speed of the driver."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from tmm_cli.analysis.mechanism import Mechanism
from tmm_cli.dynamics.balancing import Balanced, Shaking, balanced, shaking
from tmm_cli.dynamics.balancing_task import BalancingTask
from tmm_cli.errors import NoCycleError
from tmm_cli.groups.sequence import DriverMotion
from tmm_cli.kinematics.motion import Motion, move
from tmm_cli.linkage import FRAME, Linkage
from tmm_cli.vectors import Real, Vector

STEPS = 720  # in a turn


@dataclass(frozen=True)
class Balancing:
    """What was asked, over the whole cycle at places q of the driver, and at the positions; pivot: what moments are
    about. corrections: of the shaft with masses, kg m.
    """

    task: BalancingTask
    q: Real
    cycle: Balanced
    before: Shaking
    after: Shaking
    pivot: str
    corrections: Vector = field(default_factory=lambda: np.empty(0, complex))

    def at(self, mechanism: Mechanism, q: Real) -> tuple[Shaking, Shaking]:
        """What shakes at other places of the driver, without counterweights and with them."""
        return _shaken(mechanism, self.cycle, q)


def balancing(mechanism: Mechanism, start: float, places: Real, task: BalancingTask) -> Balancing:
    """Over the cycle from the driver's place `start` on, and at places. Raises NoCycleError, UnsettledError."""
    linkage, whole = mechanism.linkage, mechanism.driver_range
    driver = linkage.driver
    if driver.kind != "turn" or not whole.full or linkage.others:
        raise NoCycleError(("balancing",))

    count = STEPS * whole.turns
    q = start + driver.sense * 2 * np.pi * whole.turns * np.arange(count) / count
    pivot = _pivot(linkage)
    about = complex(linkage.local(FRAME, pivot)) if pivot else 0j
    cycle = balanced(steadily(mechanism, q), task, about)
    corrections = np.empty(0, complex) if task.rotor is None else task.rotor.corrections()
    return Balancing(task, q, cycle, *_shaken(mechanism, cycle, places), pivot, corrections)


def _shaken(mechanism: Mechanism, found: Balanced, q: Real) -> tuple[Shaking, Shaking]:
    """What shakes at places of the driver, without counterweights and with them."""
    motion, about = steadily(mechanism, q), found.before.about
    return shaking(motion, about), shaking(motion, about, found.counterweights)


def steadily(mechanism: Mechanism, q: Real) -> Motion:
    """The motion at constant speed of the driver."""
    driver = mechanism.linkage.driver
    law = DriverMotion(float(q[0]), driver.rate, 0.0, driver.sense)
    return move(mechanism.linkage, mechanism.kernels, q, law)


def _pivot(linkage: Linkage) -> str:
    """Where the crank turns on the frame; empty where it has no such point."""
    link = linkage.driver.link
    return next((h.point for h in linkage.hinges if {FRAME, link} <= set(h.links)), "")
