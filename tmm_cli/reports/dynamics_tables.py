"""Tables of the law of motion and the flywheel, of a single run, of balancing, and of intermittent motion."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from tmm_cli.language import N_, _, numeral
from tmm_cli.mechanics.analysis import MOST_CYCLES, IntermittentMotion, Results, WheelMotion
from tmm_cli.mechanics.dynamics import BalancingResults, SteadyRunning, SteadySolution
from tmm_cli.mechanics.numerics import NO_FORCE
from tmm_cli.mechanics.quantities import (
    ACCELERATION,
    ANGLE,
    ANGULAR_ACCELERATION,
    ANGULAR_SPEED,
    FORCE,
    INERTIA,
    LENGTH,
    MASS,
    MOMENT,
    NUMBER,
    SPEED,
    TIME,
    Dimension,
    coordinate_dimension,
)
from tmm_cli.reports.cycle_tables import driver_columns
from tmm_cli.reports.quality_tables import ValueRow, value_columns
from tmm_cli.reports.table import Column, Table

if TYPE_CHECKING:
    from tmm_cli.mechanics.dynamics import SingleRun


RUN_STEPS = 25  # of a single run, that are shown


def dynamics_tables(results: Results) -> Iterable[Table]:
    """Yield the table of the main quantities of steady running or of a single run, then that of the law of motion."""
    running = results.running
    assert running is not None
    if not isinstance(running, SteadyRunning):
        yield from _run_tables(results, running)
        return
    steady = running.steady
    yield Table(
        "dynamics", _("Steady motion"), value_columns([*_steady_rows(steady), *_flywheel_rows(steady)], results)
    )
    if results.motion is not None:
        yield _law_table(results)


def _steady_rows(steady: SteadySolution) -> Iterable[ValueRow]:
    low, high = steady.speeds
    yield _("work of the loads per cycle, J"), steady.machine.work_of_cycle, NUMBER
    if steady.moment < 0 and steady.task.motor is None:
        yield _("mean load moment"), -steady.moment, MOMENT
    else:
        yield _("mean driving moment"), steady.moment, MOMENT
    yield _("smallest speed of the driver"), low, ANGULAR_SPEED
    yield _("largest speed of the driver"), high, ANGULAR_SPEED
    yield _("mean of the smallest and the largest speed"), (low + high) / 2, ANGULAR_SPEED
    yield _("duration of a cycle, s"), steady.law.period, NUMBER
    if not np.isnan(steady.own) and steady.law.flywheel != steady.task.flywheel:
        yield _("coefficient of fluctuation delta without the computed flywheel"), steady.own, NUMBER
    yield _("coefficient of fluctuation delta"), steady.delta, NUMBER


def _flywheel_rows(steady: SteadySolution) -> Iterable[ValueRow]:
    if steady.law.flywheel == 0:
        return
    yield _("moment of inertia of the flywheel, reduced to the driver"), steady.law.flywheel, INERTIA
    if steady.found is not None:
        ways = (
            (_("moment of inertia of the flywheel by Wittenbauer's method"), steady.wittenbauer),
            (_("moment of inertia of the flywheel by Mertsalov's method"), steady.mertsalov),
        )
        for (name, inertia), error in zip(ways, steady.errors, strict=True):
            yield name, inertia, INERTIA
            yield _("{way}: error, %").format(way=name), 100 * error, NUMBER
        yield (
            _("moment of inertia J_I of the first group by Mertsalov's method, including the flywheel"),
            steady.first_group,
            INERTIA,
        )
        yield (
            _("moment of inertia of the links in the first group (constant speed ratio)"),
            steady.machine.constant,
            INERTIA,
        )
    if steady.task.ratio != 1:
        yield _("moment of inertia of the flywheel on its own shaft"), steady.on_shaft, INERTIA
    shape = steady.task.size.shape
    yield _("diameter of the disk") if shape == "disk" else _("mean diameter of the rim"), steady.diameter, LENGTH
    yield _("width of the flywheel"), steady.width, LENGTH
    yield _("mass of the flywheel"), steady.mass, MASS


def _law_table(results: Results) -> Table:
    motion, running = results.motion, results.running
    assert motion is not None and isinstance(running, SteadyRunning)
    driving, work = running.sense * running.driving(motion.q), running.work(motion.q)
    resists = running.steady.moment < 0 and running.task.motor is None
    notes = (
        (_("The loads drive the machine, so the driving moment here resists the motion and absorbs their work."),)
        if resists
        else ()
    )
    return Table(
        "law-of-motion",
        _("Law of motion of the driver"),
        (
            *driver_columns(results),
            Column(N_("t, s"), motion.time, NUMBER),
            Column(N_("omega"), motion.rate, ANGULAR_SPEED),
            Column(N_("epsilon"), motion.acceleration, ANGULAR_ACCELERATION),
            Column(N_("driving moment"), driving, MOMENT),
            Column(N_("work of all moments, J"), work, NUMBER),
        ),
        notes=notes,
    )


def _run_tables(results: Results, single: SingleRun) -> Iterable[Table]:
    """Yield the table of the main quantities of a single run, and its law of motion at RUN_STEPS driver coordinates."""
    run, turns = single.run, results.linkage.driver.kind == "turn"
    time = _("the given time of {time} s ended before the travel was completed").format(
        time=numeral(run.time[-1], ".6g")
    )
    endings = {"way": _("the travel is completed"), "standstill": _("the machine has stopped"), "time": time}
    place, speed = (ANGLE, ANGULAR_SPEED) if turns else (LENGTH, SPEED)
    rows: list[ValueRow] = [
        (_("driver position at the beginning"), single.first, place),
        (_("driver position at the end"), single.first + single.sense * run.way[-1], place),
        (_("duration, s"), run.time[-1], NUMBER),
        (_("speed at the end"), run.speed[-1], speed),
        (_("work of the driving forces, J"), run.driven[-1], NUMBER),
        (_("work of the loads, J"), run.loaded[-1], NUMBER),
        (_("work of the brake, J"), run.braked[-1], NUMBER),
        (_("kinetic energy at the beginning, J"), run.kinetic[0], NUMBER),
        (_("kinetic energy at the end, J"), run.kinetic[-1], NUMBER),
    ]
    balance = _("discrepancy in the energy balance: {share} of its largest term").format(
        share=numeral(run.balance, ".1g")
    )
    note = _("reason for the end of the run: {why}").format(why=endings[run.ending])
    yield Table("dynamics", _("Single run"), value_columns(rows, results), notes=(note, balance))
    at = single.evenly(RUN_STEPS)
    rate = single.speed(at)
    acceleration = ANGULAR_ACCELERATION if turns else ACCELERATION
    yield Table(
        "law-of-motion",
        _("Law of motion of the driver"),
        (
            Column(N_("t, s"), single.time(at), NUMBER),
            Column(N_("driver"), at, place),
            Column(N_("speed"), rate, speed),
            Column(N_("acceleration"), single.accelerated(at), acceleration),
            Column(N_("kinetic energy, J"), single.kinetic(at), NUMBER),
        ),
    )


# Balancing: counterweights, what shakes the frame before and after, and masses on a shaft.


def balancing_tables(results: Results) -> Iterable[Table]:
    """Yield the table of counterweights with the largest shaking force and moment, then a table of both at every
    position.
    """
    balancing = results.balancing
    assert balancing is not None
    rows, notes = (
        [*_counterweight_rows(balancing), *_shaking_rows(balancing), *_rotor_rows(results, balancing)],
        [*_balancing_notes(balancing)],
    )
    yield Table("balancing", _("Balancing"), value_columns(rows, results), notes=tuple(notes))
    if balancing.cycle.shakes:
        yield _shaking_table(results, balancing)


def _counterweight_rows(balancing: BalancingResults) -> Iterable[ValueRow]:
    for weight in balancing.cycle.counterweights:
        link = weight.place.link
        yield _("counterweight on link {link}: mass times radius, kg*m").format(link=link), weight.size, NUMBER
        yield _("angle of the counterweight from the x axis of link {link}").format(link=link), weight.angle, ANGLE
        if weight.mass is not None:
            yield _("mass at the specified radius"), weight.mass, MASS


def _shaking_rows(balancing: BalancingResults) -> Iterable[ValueRow]:
    if not balancing.cycle.shakes:
        return
    before, after = balancing.cycle.before, balancing.cycle.after
    yield _("largest shaking force"), np.nanmax(np.abs(before.force)), FORCE
    if balancing.cycle.counterweights:
        yield _("largest shaking force with counterweights"), np.nanmax(np.abs(after.force)), FORCE
        yield _("remaining part of the shaking force, %"), 100 * balancing.cycle.left, NUMBER
    yield _("largest shaking moment"), np.nanmax(np.abs(before.moment)), MOMENT
    if balancing.cycle.counterweights:
        yield _("largest shaking moment with counterweights"), np.nanmax(np.abs(after.moment)), MOMENT


def _rotor_rows(results: Results, balancing: BalancingResults) -> Iterable[ValueRow]:
    rotor = balancing.task.rotor
    if rotor is None:
        return
    rate = results.linkage.driver.rate
    for words, added in ((_("shaft"), None), (_("balanced shaft"), balancing.corrections)):
        force, couple = (abs(unbalance) * rate**2 for unbalance in rotor.unbalance(added))
        yield _("{shaft}: centrifugal force").format(shaft=words), force, FORCE
        yield _("{shaft}: moment of the unbalances about the first plane").format(shaft=words), couple, MOMENT
    for number, (plane, correction) in enumerate(zip(rotor.planes, balancing.corrections.tolist(), strict=True), 1):
        yield (
            _("correction mass in plane {number}: mass times radius, kg*m").format(number=number),
            abs(correction),
            NUMBER,
        )
        yield _("angle of the correction mass"), float(np.mod(np.angle(correction), 2 * np.pi)), ANGLE
        if plane.radius:
            yield _("mass at the specified radius"), abs(correction) / plane.radius, MASS


def _balancing_notes(balancing: BalancingResults) -> Iterable[str]:
    if balancing.cycle.shakes:
        yield _(
            "The inertia forces of all links act on the frame as the shaking force and the shaking moment. "
            "Both are computed over a cycle, at constant speed of the driver."
        )
    if balancing.cycle.alike:
        yield _("Some counterweights can replace others: of all solutions the one with the smallest masses is shown.")
    if any(weight.mass is None for weight in balancing.cycle.counterweights):
        yield _(
            "If no radius is specified, the shaking moment does not include the counterweight's own moment of inertia."
        )


def _shaking_table(results: Results, balancing: BalancingResults) -> Table:
    columns = driver_columns(results)
    blocks = [(balancing.before, "F x", "F y", "F", "M")]
    if balancing.cycle.counterweights:
        blocks.append(
            (
                balancing.after,
                N_("F x, with counterweights"),
                N_("F y, with counterweights"),
                N_("F, with counterweights"),
                N_("M, with counterweights"),
            )
        )
    least = NO_FORCE * float(np.nanmax(np.abs(balancing.cycle.before.force)))
    for shaking, *headers in blocks:
        force = np.where(np.abs(shaking.force) < least, 0, shaking.force)  # rounding is none
        values = (force.real, force.imag, np.abs(force), shaking.moment)
        columns += [
            Column(h, v, MOMENT if v is shaking.moment else FORCE) for h, v in zip(headers, values, strict=True)
        ]
    note = _("M is taken about {pivot}, positive counterclockwise.").format(pivot=balancing.pivot or _("the origin"))
    return Table("shaking", _("Shaking force and moment on the frame"), tuple(columns), notes=(note,))


# Intermittent motion: wheels that a link takes along on some strokes, stroke by stroke and over a cycle.


def intermittent_tables(results: Results) -> Iterable[Table]:
    """Yield the tables of intermittent motion.

    They contain the periods of motion and rest of each wheel, its totals over a cycle, and its motion against time.
    """
    wheels = results.wheels
    assert wheels is not None
    place = coordinate_dimension(results.linkage.driver.kind)
    yield _wheel_period_table(wheels, place, back=not results.turns)
    rows = [row for wheel in wheels for row in _wheel_cycle_rows(wheel, place)]
    notes = [note for wheel in wheels for note in _wheel_notes(wheel)]
    yield Table(
        "intermittent-cycle",
        _("Intermittent motion: values per cycle"),
        value_columns(rows, results),
        notes=tuple(notes),
    )
    yield _wheel_motion_table(wheels, place)


def _wheel_period_table(wheels: Iterable[IntermittentMotion], place: Dimension, *, back: bool) -> Table:
    """Return a table with a row for each period in which a wheel moves or rests.

    back: True if the driver moves forward and back.
    """
    rows = [(wheel, period, wheel.jumps[k]) for wheel in wheels for k, period in enumerate(wheel.parts)]
    periods = [period for __, period, ___ in rows]
    columns = [
        Column(N_("wheel"), [wheel.task.name for wheel, __, ___ in rows]),
        Column(N_("state"), [_("driven") if period.ride.driven else _("at rest") for period in periods]),
    ]
    if any(len(wheel.task.settings) > 1 for wheel in wheels):
        columns.append(Column(N_("setting"), [_setting_text(wheel, period) for wheel, period, __ in rows]))
    columns += [
        Column(N_("initial driver position"), [period.ride.start for period in periods], place),
        Column(N_("final driver position"), [period.ride.end for period in periods], place),
        Column(N_("travel of the driver"), [period.ride.way for period in periods], place),
        Column(N_("t"), [period.time for period in periods], TIME),
        Column(N_("initial wheel angle"), [period.angles[0] for period in periods], ANGLE),
        Column(N_("final wheel angle"), [period.angles[-1] for period in periods], ANGLE),
        Column(N_("step"), [period.step for period in periods], ANGLE),
        Column(N_("jump of omega at the beginning"), [jump for __, ___, jump in rows], ANGULAR_SPEED),
    ]
    note = _("The angle of a wheel is measured from the beginning of the cycle, positive counterclockwise.")
    if back:
        note = f"{note} {_('The driver is assumed to reverse instantly and to move back at the same speed.')}"
    return Table("intermittent", _("Intermittent motion"), tuple(columns), notes=(note,))


def _setting_text(wheel: IntermittentMotion, period: WheelMotion) -> str:
    """Return the number of a wheel's setting, followed by its parameter values.

    The number stands alone if the setting uses the parameter values of the file.
    """
    values = wheel.task.settings[period.setting].values
    text = ", ".join(f"{name} = {value}" for name, value in values.items())
    return f"{period.setting + 1}: {text}" if text else str(period.setting + 1)


def _wheel_cycle_rows(wheel: IntermittentMotion, place: Dimension) -> Iterable[ValueRow]:
    name = wheel.task.name
    yield _("rotation of wheel {name} per cycle").format(name=name), wheel.turn, ANGLE
    if wheel.cycles is not None:
        yield _("number of cycles for a whole number of turns"), wheel.cycles, NUMBER
    yield _("travel of the driver per cycle"), wheel.way, place
    yield _("fraction of the driver travel with the wheel at rest"), wheel.standing, NUMBER
    for words, driven in ((_("duration of motion"), True), (_("duration of rest"), False)):
        if np.isfinite(wheel.time(driven=driven)):
            yield words, wheel.time(driven=driven), TIME
    yield _("largest angular speed"), wheel.omega, ANGULAR_SPEED
    yield _("largest angular acceleration during motion"), wheel.epsilon, ANGULAR_ACCELERATION
    yield _("largest jump of omega at the beginning or end of motion"), wheel.shock, ANGULAR_SPEED


def _wheel_notes(wheel: IntermittentMotion) -> Iterable[str]:
    name = wheel.task.name
    if wheel.shock == 0:
        yield _("Wheel {name} starts and stops without an impact: its angular speed does not jump.").format(name=name)
    else:
        yield _("Wheel {name} starts or stops with an impact: its angular speed jumps.").format(name=name)
    if wheel.cycles is None and wheel.turn:
        text = _("Wheel {name} does not complete a whole number of turns after any number of cycles up to {most}.")
        yield text.format(name=name, most=MOST_CYCLES)


def _wheel_motion_table(wheels: Iterable[IntermittentMotion], place: Dimension) -> Table:
    named_periods = [(wheel.task.name, period) for wheel in wheels for period in wheel.parts]
    columns = [Column(N_("wheel"), [name for name, period in named_periods for __ in period.ways])]
    series = (
        (N_("travel of the driver"), "ways", place),
        (N_("angle"), "angles", ANGLE),
        (N_("omega"), "omegas", ANGULAR_SPEED),
        (N_("epsilon"), "epsilons", ANGULAR_ACCELERATION),
    )
    for header, name, dimension in series:
        values = np.concatenate([getattr(period, name) for __, period in named_periods])
        columns.append(Column(header, values, dimension))
    return Table("intermittent-course", _("Intermittent motion of the wheels"), tuple(columns), long=True)
