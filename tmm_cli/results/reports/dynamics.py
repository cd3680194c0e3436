"""Steady running: what drives the machine, its flywheel, and the law of motion at every position."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from tmm_cli.analysis.pipeline import Results
from tmm_cli.analysis.running import Running
from tmm_cli.dynamics.steady import Steady
from tmm_cli.language import N_, _, numeral
from tmm_cli.quantities import (
    ACCELERATION,
    ANGLE,
    ANGULAR_ACCELERATION,
    ANGULAR_SPEED,
    INERTIA,
    LENGTH,
    MASS,
    MOMENT,
    NUMBER,
    SPEED,
)  # fmt: skip
from tmm_cli.results.reports.cycle import driver_columns
from tmm_cli.results.reports.quality import Row, of_rows
from tmm_cli.results.table import Column, Table

if TYPE_CHECKING:
    from tmm_cli.analysis.single_run import SingleRun  # it imports scipy

STEPS = 25  # of a single run, that are shown


def tables(results: Results) -> Iterable[Table]:
    """What was found, then the law of motion."""
    running = results.running
    assert running is not None
    if not isinstance(running, Running):
        yield from _single(results, running)
        return
    steady = running.steady
    yield Table("dynamics", _("Steady running"), of_rows([*_driving(steady), *_flywheel(steady)], results))
    if results.motion is not None:
        yield _law(results)


def _driving(steady: Steady) -> Iterable[Row]:
    low, high = steady.speeds
    yield _("work of the loads in a cycle, J"), steady.machine.work_of_cycle, NUMBER
    if steady.moment < 0 and steady.task.motor is None:
        yield _("mean moment of resistance"), -steady.moment, MOMENT
    else:
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
        ways = (_("by Wittenbauer"), steady.wittenbauer), (_("by Mertsalov"), steady.mertsalov)
        for (name, inertia), error in zip(ways, steady.errors, strict=True):
            yield name, inertia, INERTIA
            yield _("{way}, off by, %").format(way=name), 100 * error, NUMBER
        yield _("first group J_I by Mertsalov, flywheel included"), steady.first_group, INERTIA
        yield _("links of constant speed ratio in it"), steady.machine.constant, INERTIA
    if steady.task.ratio != 1:
        yield _("flywheel, on its shaft"), steady.on_shaft, INERTIA
    shape = steady.task.size.shape
    yield _("diameter of a disk") if shape == "disk" else _("mean diameter of a rim"), steady.diameter, LENGTH
    yield _("its width"), steady.width, LENGTH
    yield _("its mass"), steady.mass, MASS


def _law(results: Results) -> Table:
    motion, running = results.motion, results.running
    assert motion is not None and isinstance(running, Running)
    driving, work = running.sense * running.driving(motion.q), running.work(motion.q)
    resists = running.steady.moment < 0 and running.task.motor is None
    notes = (_("The loads do work; the driving moment is that of the resistance which takes it."),) if resists else ()
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
        notes=notes,
    )  # fmt: skip


def _single(results: Results, single: SingleRun) -> Iterable[Table]:
    """A single run: its sums, and as many of its steps as one reads."""
    run, turns = single.run, results.linkage.driver.kind == "turn"
    time = _("the time of {time} s is over before its way is gone").format(time=numeral(run.time[-1], ".6g"))
    endings = {"way": _("the way is gone"), "standstill": _("the machine stands"), "time": time}
    place, speed = (ANGLE, ANGULAR_SPEED) if turns else (LENGTH, SPEED)
    rows: list[Row] = [
        (_("begins at"), single.first, place),
        (_("ends at"), single.first + single.sense * run.way[-1], place),
        (_("lasts, s"), run.time[-1], NUMBER),
        (_("speed at its end"), run.speed[-1], speed),
        (_("work of what drives, J"), run.driven[-1], NUMBER),
        (_("work of the loads, J"), run.loaded[-1], NUMBER),
        (_("work of the brake, J"), run.braked[-1], NUMBER),
        (_("kinetic energy at the beginning, J"), run.kinetic[0], NUMBER),
        (_("kinetic energy at the end, J"), run.kinetic[-1], NUMBER),
    ]
    balance = _("what works and energies leave of one another: {share} of the largest").format(
        share=numeral(run.balance, ".1g")
    )
    note = _("the run ends: {why}").format(why=endings[run.ending])
    yield Table("dynamics", _("Single run"), of_rows(rows, results), notes=(note, balance))
    at = single.evenly(STEPS)
    rate = single.speed(at)
    acceleration = ANGULAR_ACCELERATION if turns else ACCELERATION
    yield Table(
        "law-of-motion", _("Law of motion of the driver"),
        (
            Column(N_("t, s"), single.time(at), NUMBER),
            Column(N_("driver"), at, place),
            Column(N_("speed"), rate, speed),
            Column(N_("acceleration"), single.accelerated(at), acceleration),
            Column(N_("kinetic energy, J"), single.kinetic(at), NUMBER),
        ),
    )  # fmt: skip
