"""Steady running: what drives the machine, its flywheel, and the law of motion at every position."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_cli.analysis.pipeline import Results
from tmm_cli.language import N_, _
from tmm_cli.quantities import ANGULAR_ACCELERATION, ANGULAR_SPEED, INERTIA, LENGTH, MASS, MOMENT, NUMBER, Dimension
from tmm_cli.results.reports.cycle import driver_columns
from tmm_cli.results.reports.quality import of_rows
from tmm_cli.results.table import Column, Table

if TYPE_CHECKING:
    from tmm_cli.dynamics.steady import Steady

Row = tuple[str, Any, Dimension]


def tables(results: Results) -> Iterable[Table]:
    """What was found, then the law of motion."""
    assert results.running is not None
    steady = results.running.steady
    yield Table("dynamics", _("Steady running"), of_rows([*_driving(steady), *_flywheel(steady)], results))
    if results.motion is not None:
        yield _law(results)


def _driving(steady: Steady) -> Iterable[Row]:
    low, high = steady.speeds
    yield _("work of the loads in a cycle, J"), steady.machine.work_of_cycle, NUMBER
    yield _("mean driving moment"), steady.moment, MOMENT
    yield _("least speed of the driver"), low, ANGULAR_SPEED
    yield _("largest speed of the driver"), high, ANGULAR_SPEED
    yield _("mean of both"), (low + high) / 2, ANGULAR_SPEED
    yield _("time of a cycle, s"), steady.law.period, NUMBER
    if not np.isnan(steady.own) and steady.law.flywheel != steady.task.flywheel:
        yield _("fluctuation delta without it"), steady.own, NUMBER
    yield _("fluctuation delta"), steady.delta, NUMBER


def _flywheel(steady: Steady) -> Iterable[Row]:
    if steady.law.flywheel == 0:
        return
    yield _("flywheel, reduced to the driver"), steady.law.flywheel, INERTIA
    if steady.found is not None:
        exact = steady.found.inertia
        for name, inertia in ((_("by Wittenbauer"), steady.wittenbauer), (_("by Mertsalov"), steady.mertsalov)):
            yield name, inertia, INERTIA
            yield _("{way}, off by, %").format(way=name), 100 * (inertia / exact - 1), NUMBER
    if steady.task.ratio != 1:
        yield _("flywheel, on its shaft"), steady.on_shaft, INERTIA
    size = steady.task.size
    diameter = size.diameter(steady.on_shaft)
    yield _("diameter of a disk") if size.shape == "disk" else _("mean diameter of a rim"), diameter, LENGTH
    yield _("its width"), size.width * diameter, LENGTH
    yield _("its mass"), size.mass(diameter), MASS


def _law(results: Results) -> Table:
    motion, running = results.motion, results.running
    assert motion is not None and running is not None
    way = running.way(motion.q)
    work = running.steady.law.energy(way) - running.steady.law.energy(0 * way)
    driving = running.sense * running.steady.law.driving(way)
    return Table(
        "law-of-motion", _("Law of motion of the driver"),
        (
            *driver_columns(results),
            Column(N_("t, s"), motion.time, NUMBER),
            Column(N_("omega"), motion.rate, ANGULAR_SPEED),
            Column(N_("epsilon"), motion.acceleration, ANGULAR_ACCELERATION),
            Column(N_("driving moment"), driving, MOMENT),
            Column(N_("work of all moments, J"), work, NUMBER),
        ),
    )  # fmt: skip
