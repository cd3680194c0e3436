"""Chapter on the law of motion of a machine in steady running or in a single run."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tmm_cli.language import _
from tmm_cli.mechanics.dynamics import SingleRun
from tmm_cli.mechanics.forces import CourseSymbol, Symbol
from tmm_cli.note.blocks import Block, Equation, Heading, paragraph, write_sentence, write_table
from tmm_cli.note.dynamics import flywheel, reduced_model
from tmm_cli.note.dynamics.flywheel import OFFSETS, tangent_speed
from tmm_cli.note.dynamics.reduced_model import (
    DRIVING,
    FLYWHEEL,
    INERTIA,
    LARGEST,
    MOMENT,
    SLOPE,
    START,
    WORK,
    SteadyPosition,
)
from tmm_cli.note.expression import ComputedQuantity, Expression, Function, Leaf, sum_terms
from tmm_cli.note.formula_tree import Fraction, Letter, Sign, row
from tmm_cli.note.subject import Subject, note_table
from tmm_cli.reports import sign_convention, walk

TABLES = ("dynamics", "law-of-motion")


def write_steady_running(subject: Subject) -> Iterable[Block]:
    """Write the chapter on the law of motion in steady running."""
    positions = [SteadyPosition(subject, k) for k in subject.detail]
    first = positions[0]
    yield Heading(_("Law of motion"))
    yield Heading(_("Reduced moments"), 2)
    yield from reduced_model.explain_reduction(first)
    for position in positions:
        yield from reduced_model.write_reduced_inertia(position)
        yield from reduced_model.write_reduced_moment(position)
    yield from subject.figures(
        "law",
        _("The reduced moments, the work and the energies are shown in figure {figure}."),
        _("Reduced moments, work and energies over the cycle"),
        only="law-moments",
    )
    yield Heading(_("Driving moment"), 2)
    yield from reduced_model.write_mean_driving_moment(first)
    for position in positions:
        yield from reduced_model.write_motor_moment(position)
    flies = first.steady.law.flywheel > 0
    yield Heading(_("Flywheel") if flies else _("Fluctuation of speed"), 2)
    yield from flywheel.write_extreme_speeds(first)
    yield from flywheel.write_energy_mass_diagram(first)
    yield from subject.figures(
        "energy-mass", _("The energy-mass diagram is shown in figure {figure}."), _("Energy-mass diagram")
    )
    if flies:
        for write_section in (
            flywheel.write_flywheel_by_tangents,
            flywheel.write_flywheel_by_mertsalov,
            flywheel.write_flywheel_on_its_shaft,
            flywheel.write_flywheel_size,
        ):
            yield from write_section(first)
    yield Heading(_("Velocity and acceleration of the input link"), 2)
    yield from _write_initial_energy(first)
    for position in positions:
        yield from _write_input_motion(position, explained=position is first)
    yield from _write_time(first)
    yield from subject.figures(
        "law",
        _("The law of motion is shown in figure {figure}."),
        _("Law of motion of the input link"),
        only="law-motion",
    )
    if first.running.sense < 0:
        yield paragraph(sign_convention(subject.results.linkage))
    yield from write_tables(subject)


def write_tables(subject: Subject) -> Iterable[Block]:
    """Write the table of results and the table of the law of motion in all positions."""
    tables = list(walk(subject.results, TABLES))
    sentences = _("The results are summarised in table {table}."), _("The law of motion is given in table {table}.")
    for table, sentence in zip(tables, sentences, strict=True):
        rows = note_table(subject, table, key=table.name, zeros=table.name == "law-of-motion")
        yield from write_table(sentence, rows)


def _write_initial_energy(position: SteadyPosition) -> Iterable[Block]:
    """Write the kinetic energy in position 0, found from the tangent of the largest speed."""
    upper, __ = position.tangents
    yield write_sentence(_("The kinetic energy of the machine in position 0:"))
    flywheel, offset = Leaf(FLYWHEEL, position.steady.law.flywheel), Leaf(OFFSETS[0], upper.offset)
    energy = tangent_speed(upper, LARGEST) ** 2 / 2 * flywheel - offset if flywheel.value else -offset
    yield ComputedQuantity(START, energy, position.initial_energy, _("J"))


def _write_input_motion(position: SteadyPosition, *, explained: bool) -> Iterable[Block]:
    """Write the angular velocity and acceleration of the input link in one position."""
    text = _("Position {number}:")
    if explained:
        text = _(
            "The angular velocity of the input link follows from the kinetic energy, its angular acceleration "
            "from the equation of motion, in which {slope} is the derivative of the reduced moment of inertia "
            "with respect to the angle of the input link. Position {number}:"
        )
    yield write_sentence(text, slope=SLOPE, number=position.number)
    steady, link = position.steady, position.motion.linkage.driver.link
    law, speed = steady.law, position.speed
    inertia = Leaf(INERTIA, position.value_of(steady.machine.inertia))
    total_inertia = Leaf(FLYWHEEL, law.flywheel) + inertia if law.flywheel else inertia
    energy = Leaf(START, position.initial_energy) + Leaf(WORK, position.value_of(steady.work))
    yield ComputedQuantity(speed.symbol, Function("sqrt", 2 * energy / total_inertia), speed.value, _("rad/s"))
    moments = Leaf(DRIVING, position.value_of(law.driving)) + Leaf(MOMENT, position.value_of(steady.machine.moment))
    turned = Leaf(SLOPE, position.value_of(steady.machine.slope)) * (speed**2 / 2)
    acceleration = position.running.sense * float(
        np.broadcast_to(position.motion.acceleration, position.motion.q.shape)[position.k]
    )
    yield ComputedQuantity(Symbol("ε", link), (moments - turned) / total_inertia, acceleration, _("rad/s²"))


def _write_time(position: SteadyPosition) -> Iterable[Block]:
    """Write the time as the integral of the reciprocal angular velocity, and the duration of the cycle."""
    omega = Letter(Symbol("ω", position.motion.linkage.driver.link))
    yield write_sentence(
        _("The time from position 0 is the integral of the reciprocal angular velocity over the angle of rotation:")
    )
    yield Equation(row(Letter(Symbol("t")), "=", Sign("∫"), Fraction(row("d", Letter(Symbol("φ"))), omega)))
    yield write_sentence(_("A cycle takes {time} s."), time=position.subject.text(position.steady.law.period))


DRIVEN, LOADED, BRAKED, END = CourseSymbol("A_d"), CourseSymbol("A_l"), CourseSymbol("A_b"), Symbol("T", "1")


def write_single_run(subject: Subject) -> Iterable[Block]:
    """Write the chapter on the law of motion of a single run."""
    single = subject.results.single
    assert single is not None
    yield Heading(_("Law of motion"))
    yield from _write_energy_balance(single, crank=subject.results.linkage.driver.kind == "turn")
    yield from subject.figures(
        "run", _("The motion of the machine is shown in figure {figure}."), _("Law of motion of the input link")
    )
    yield from write_tables(subject)


def _write_energy_balance(single: SingleRun, *, crank: bool) -> Iterable[Block]:
    """Write the energy balance of the whole run and the final velocity."""
    run = single.run
    yield write_sentence(
        _(
            "The machine is replaced by its input link, to which all masses and all loads are reduced; the "
            "equation of motion of this link is integrated from the beginning of the run."
        )
    )
    parts = [(START, run.kinetic[0]), (DRIVEN, run.driven[-1]), (LOADED, run.loaded[-1])]
    text = _(
        "The kinetic energy at the end of the run is the sum of the initial kinetic energy {T0}, the work "
        "{Ad} of the driving forces and the work {Al} of the loads:"
    )
    if single.task.brake:
        parts.append((BRAKED, run.braked[-1]))
        text = _(
            "The kinetic energy at the end of the run is the sum of the initial kinetic energy {T0}, the work "
            "{Ad} of the driving forces, the work {Al} of the loads and the work {Ab} of the brake:"
        )
    yield write_sentence(text, T0=START, Ad=DRIVEN, Al=LOADED, Ab=BRAKED)
    end = Leaf(END, float(run.kinetic[-1]))
    yield ComputedQuantity(END, sum_terms(Leaf(symbol, float(value)) for symbol, value in parts), end.value, _("J"))
    inertia = float(single.machine.inertia(np.array([run.way[-1]]))[0])
    total_inertia: Expression = Leaf(INERTIA if crank else Symbol("m"), inertia)
    if single.task.flywheel:
        total_inertia = Leaf(FLYWHEEL, single.task.flywheel) + total_inertia
    if run.speed[-1] > 0:
        yield write_sentence(
            _("The final velocity follows from the kinetic energy and the reduced inertia at the end of the run:")
        )
        root = Function("sqrt", 2 * end / total_inertia)
        unit = _("rad/s") if crank else _("m/s")
        yield ComputedQuantity(Symbol("ω" if crank else "v", "1"), root, float(run.speed[-1]), unit)
