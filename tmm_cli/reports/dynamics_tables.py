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
    """Yield the main quantities of steady running or of a single run, then the law of motion."""
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
    yield _("least speed of the driver"), low, ANGULAR_SPEED
    yield _("largest speed of the driver"), high, ANGULAR_SPEED
    yield _("mean of the least and largest speed"), (low + high) / 2, ANGULAR_SPEED
    yield _("time of a cycle, s"), steady.law.period, NUMBER
    if not np.isnan(steady.own) and steady.law.flywheel != steady.task.flywheel:
        yield _("coefficient of fluctuation delta without the computed flywheel"), steady.own, NUMBER
    yield _("coefficient of fluctuation delta"), steady.delta, NUMBER


def _flywheel_rows(steady: SteadySolution) -> Iterable[ValueRow]:
    if steady.law.flywheel == 0:
        return
    yield _("inertia of the flywheel, reduced to the driver"), steady.law.flywheel, INERTIA
    if steady.found is not None:
        ways = (
            (_("flywheel by Wittenbauer's method"), steady.wittenbauer),
            (_("flywheel by Mertsalov's method"), steady.mertsalov),
        )
        for (name, inertia), error in zip(ways, steady.errors, strict=True):
            yield name, inertia, INERTIA
            yield _("{way}, error, %").format(way=name), 100 * error, NUMBER
        yield _("first group J_I by Mertsalov's method, with the flywheel"), steady.first_group, INERTIA
        yield _("links with a constant speed ratio in the first group"), steady.machine.constant, INERTIA
    if steady.task.ratio != 1:
        yield _("inertia of the flywheel on its own shaft"), steady.on_shaft, INERTIA
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
        (_("The loads drive the machine: the driving moment is a resisting moment that absorbs their work."),)
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
    """Yield the main quantities of a single run, and its law of motion in RUN_STEPS steps."""
    run, turns = single.run, results.linkage.driver.kind == "turn"
    time = _("the time of {time} s is over before the travel is completed").format(time=numeral(run.time[-1], ".6g"))
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
    balance = _("imbalance of work and energy: {share} of the largest of them").format(
        share=numeral(run.balance, ".1g")
    )
    note = _("end of the run: {why}").format(why=endings[run.ending])
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
    """Yield the counterweights with the largest shaking force and moment, then both at every position."""
    found = results.balancing
    assert found is not None
    rows, notes = (
        [*_counterweight_rows(found), *_shaking_rows(found), *_rotor_rows(results, found)],
        [*_balancing_notes(found)],
    )
    yield Table("balancing", _("Balancing"), value_columns(rows, results), notes=tuple(notes))
    if found.cycle.shakes:
        yield _shaking_table(results, found)


def _counterweight_rows(found: BalancingResults) -> Iterable[ValueRow]:
    for weight in found.cycle.counterweights:
        link = weight.place.link
        yield _("counterweight on link {link}: mass times radius, kg*m").format(link=link), weight.size, NUMBER
        yield _("angle of the counterweight from the x axis of link {link}").format(link=link), weight.angle, ANGLE
        if weight.mass is not None:
            yield _("mass at the specified radius"), weight.mass, MASS


def _shaking_rows(found: BalancingResults) -> Iterable[ValueRow]:
    if not found.cycle.shakes:
        return
    before, after = found.cycle.before, found.cycle.after
    yield _("largest shaking force"), np.nanmax(np.abs(before.force)), FORCE
    if found.cycle.counterweights:
        yield _("largest shaking force with counterweights"), np.nanmax(np.abs(after.force)), FORCE
        yield _("remaining shaking force, %"), 100 * found.cycle.left, NUMBER
    yield _("largest shaking moment"), np.nanmax(np.abs(before.moment)), MOMENT
    if found.cycle.counterweights:
        yield _("largest shaking moment with counterweights"), np.nanmax(np.abs(after.moment)), MOMENT


def _rotor_rows(results: Results, found: BalancingResults) -> Iterable[ValueRow]:
    rotor = found.task.rotor
    if rotor is None:
        return
    rate = results.linkage.driver.rate
    for words, added in ((_("shaft"), None), (_("balanced shaft"), found.corrections)):
        force, couple = (abs(part) * rate**2 for part in rotor.unbalance(added))
        yield _("{shaft}: centrifugal force").format(shaft=words), force, FORCE
        yield _("{shaft}: moment of the unbalances about the first plane").format(shaft=words), couple, MOMENT
    for number, (plane, size) in enumerate(zip(rotor.planes, found.corrections.tolist(), strict=True), 1):
        yield _("correction in plane {number}: mass times radius, kg*m").format(number=number), abs(size), NUMBER
        yield _("angle of this mass"), float(np.mod(np.angle(size), 2 * np.pi)), ANGLE
        if plane.radius:
            yield _("mass at the specified radius"), abs(size) / plane.radius, MASS


def _balancing_notes(found: BalancingResults) -> Iterable[str]:
    if found.cycle.shakes:
        yield _(
            "Shaking force and moment: inertia forces of all links, transmitted to the frame, over the cycle "
            "at constant speed of the driver."
        )
    if found.cycle.alike:
        yield _("Some counterweights can replace others: of all solutions the one with the least masses is shown.")
    if any(weight.mass is None for weight in found.cycle.counterweights):
        yield _(
            "If no radius is specified, the shaking moment does not include the counterweight's own moment of inertia."
        )


def _shaking_table(results: Results, found: BalancingResults) -> Table:
    columns = driver_columns(results)
    told = [(found.before, "F x", "F y", "F", "M")]
    if found.cycle.counterweights:
        told.append(
            (
                found.after,
                N_("F x, with counterweights"),
                N_("F y, with counterweights"),
                N_("F, with counterweights"),
                N_("M, with counterweights"),
            )
        )
    least = NO_FORCE * float(np.nanmax(np.abs(found.cycle.before.force)))
    for shaking, *headers in told:
        force = np.where(np.abs(shaking.force) < least, 0, shaking.force)  # rounding is none
        values = (force.real, force.imag, np.abs(force), shaking.moment)
        columns += [
            Column(h, v, MOMENT if v is shaking.moment else FORCE) for h, v in zip(headers, values, strict=True)
        ]
    note = _("M is taken about {pivot}, positive counterclockwise.").format(pivot=found.pivot or _("the origin"))
    return Table("shaking", _("Shaking force and moment on the frame"), tuple(columns), notes=(note,))


# Intermittent motion: wheels that a link takes along on some strokes, stroke by stroke and over a cycle.


def intermittent_tables(results: Results) -> Iterable[Table]:
    """Yield the periods of driven motion and rest, the totals of a cycle, and the motion of each wheel at close
    positions.
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
    """Return a table with a row for each period of motion or rest; back: the driver moves forward and back."""
    rows = [(wheel, part, wheel.jumps[k]) for wheel in wheels for k, part in enumerate(wheel.parts)]
    parts = [part for __, part, ___ in rows]
    columns = [
        Column(N_("wheel"), [wheel.task.name for wheel, __, ___ in rows]),
        Column(N_("state"), [_("driven") if part.ride.driven else _("at rest") for part in parts]),
    ]
    if any(len(wheel.task.settings) > 1 for wheel in wheels):
        columns.append(Column(N_("setting"), [_setting_text(wheel, part) for wheel, part, __ in rows]))
    columns += [
        Column(N_("initial driver position"), [part.ride.start for part in parts], place),
        Column(N_("final driver position"), [part.ride.end for part in parts], place),
        Column(N_("travel of the driver"), [part.ride.way for part in parts], place),
        Column(N_("t"), [part.time for part in parts], TIME),
        Column(N_("initial wheel angle"), [part.angles[0] for part in parts], ANGLE),
        Column(N_("final wheel angle"), [part.angles[-1] for part in parts], ANGLE),
        Column(N_("step"), [part.step for part in parts], ANGLE),
        Column(N_("jump of omega at the beginning"), [jump for __, ___, jump in rows], ANGULAR_SPEED),
    ]
    note = _("The angle of a wheel is measured from the beginning of the cycle, positive counterclockwise.")
    if back:
        note = f"{note} {_('The driver is assumed to reverse instantly and to move back at the same speed.')}"
    return Table("intermittent", _("Intermittent motion"), tuple(columns), notes=(note,))


def _setting_text(wheel: IntermittentMotion, part: WheelMotion) -> str:
    """Return the number of a setting and its parameter values; of the file's own values the number alone."""
    values = wheel.task.settings[part.setting].values
    told = ", ".join(f"{name} = {value}" for name, value in values.items())
    return f"{part.setting + 1}: {told}" if told else str(part.setting + 1)


def _wheel_cycle_rows(wheel: IntermittentMotion, place: Dimension) -> Iterable[ValueRow]:
    name = wheel.task.name
    yield _("rotation of wheel {name} per cycle").format(name=name), wheel.turn, ANGLE
    if wheel.cycles is not None:
        yield _("number of cycles for a whole number of turns"), wheel.cycles, NUMBER
    yield _("travel of the driver per cycle"), wheel.way, place
    yield _("fraction of it with the wheel at rest"), wheel.standing, NUMBER
    for words, driven in ((_("time of motion"), True), (_("time at rest"), False)):
        if np.isfinite(wheel.time(driven=driven)):
            yield words, wheel.time(driven=driven), TIME
    yield _("largest angular speed"), wheel.omega, ANGULAR_SPEED
    yield _("largest angular acceleration during motion"), wheel.epsilon, ANGULAR_ACCELERATION
    yield _("largest jump of omega at the beginning and end of motion"), wheel.shock, ANGULAR_SPEED


def _wheel_notes(wheel: IntermittentMotion) -> Iterable[str]:
    name = wheel.task.name
    if wheel.shock == 0:
        yield _("Wheel {name} starts and stops without shock: its angular speed does not jump.").format(name=name)
    else:
        yield _("Wheel {name} starts or stops with a shock: its angular speed jumps.").format(name=name)
    if wheel.cycles is None and wheel.turn:
        text = _("Wheel {name} does not complete a whole number of turns within {most} cycles.")
        yield text.format(name=name, most=MOST_CYCLES)


def _wheel_motion_table(wheels: Iterable[IntermittentMotion], place: Dimension) -> Table:
    every = [(wheel.task.name, part) for wheel in wheels for part in wheel.parts]
    columns = [Column(N_("wheel"), [name for name, part in every for __ in part.ways])]
    told = (
        (N_("travel of the driver"), "ways", place),
        (N_("angle"), "angles", ANGLE),
        (N_("omega"), "omegas", ANGULAR_SPEED),
        (N_("epsilon"), "epsilons", ANGULAR_ACCELERATION),
    )
    for header, name, dimension in told:
        values = np.concatenate([getattr(part, name) for __, part in every])
        columns.append(Column(header, values, dimension))
    return Table("intermittent-course", _("Intermittent motion of the wheels"), tuple(columns), long=True)
