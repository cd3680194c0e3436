"""Stages that few files need. Their modules are imported only when they run, scipy only for single runs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tmm_cli.mechanics.analysis.mechanism import Mechanism
from tmm_cli.mechanics.groups import DriverMotion, LawOfMotion
from tmm_cli.mechanics.linkage import Linkage
from tmm_cli.mechanics.numerics import Real

if TYPE_CHECKING:
    from tmm_cli.mechanics.analysis.intermittent import IntermittentMotion
    from tmm_cli.mechanics.dynamics import (
        BalancingResults,
        BalancingTask,
        RunTask,
        SingleRun,
        SteadyRunning,
        SteadyTask,
    )


def driver_motion(linkage: Linkage, start: float) -> LawOfMotion:
    """Return the law of motion of the first driver.

    The speed in the file holds at position 0 or, with several drivers, at the position of the sketch.
    """
    driver = linkage.driver
    if driver.law is not None:
        from tmm_cli.mechanics.dynamics import SpeedTableLaw

        return SpeedTableLaw(driver.law, start, driver.sense, 2 * np.pi * linkage.turns)
    at = linkage.sketch.at if linkage.others else start
    return DriverMotion(at, driver.rate, driver.acceleration, driver.sense)


def law_of_motion(mechanism: Mechanism, task: SteadyTask | RunTask) -> SteadyRunning | SingleRun:
    """Compute the law of motion of steady running, or of a single run, from position 0.

    Raises:
        LinkageError: see `find_running_law` and `compute_single_run`.
    """
    if task.cyclic:
        from tmm_cli.mechanics.dynamics import find_running_law

        return find_running_law(mechanism, float(mechanism.asked[0]), task)

    from tmm_cli.mechanics.dynamics import compute_single_run

    return compute_single_run(mechanism, mechanism.asked, task)


def balancing_stage(mechanism: Mechanism, q: Real, task: BalancingTask) -> BalancingResults:
    """Balance the mechanism over the cycle from position 0, and at driver coordinates q.

    Raises:
        LinkageError: see `balance_machine`.
    """
    from tmm_cli.mechanics.dynamics import balance_machine

    return balance_machine(mechanism, float(mechanism.asked[0]), q, task)


def intermittent_stage(mechanism: Mechanism, running: LawOfMotion | None) -> tuple[IntermittentMotion, ...]:
    """Compute the motion of the wheels from position 0.

    running: law of motion of the machine, used for every setting; None for the law of motion in the file.

    Raises:
        LinkageError: see `compute_intermittent`.
    """
    from tmm_cli.mechanics.analysis.intermittent import compute_intermittent

    start = float(mechanism.asked[0])
    return compute_intermittent(
        mechanism, start, lambda linkage: driver_motion(linkage, start) if running is None else running
    )
