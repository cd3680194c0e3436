"""The law of motion: the machine reduced to its driver, what drives it, the flywheel, speed and acceleration."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tmm_cli.language import _
from tmm_cli.mechanics.forces import Symbol
from tmm_cli.note.blocks import Block, Equation, Heading, paragraph, said, tabled
from tmm_cli.note.context import Subject
from tmm_cli.note.dynamics import flywheel, parts as driving, parts as reduced
from tmm_cli.note.dynamics.flywheel import OFFSETS, speed_of
from tmm_cli.note.dynamics.parts import DRIVING, FLYWHEEL, INERTIA, LARGEST, MOMENT, SLOPE, START, WORK, Here
from tmm_cli.note.expression import Found, Function, Leaf
from tmm_cli.note.math import Fraction, Letter, Sign, row
from tmm_cli.note.tables import rows_of
from tmm_cli.reports import signs, walk

TABLES = ("dynamics", "law-of-motion")


def blocks(subject: Subject) -> Iterable[Block]:
    """Of steady running."""
    every = [Here(subject, k) for k in subject.detail]
    here = every[0]
    yield Heading(_("Law of motion"))
    yield Heading(_("Reduced moments"), 2)
    yield from reduced.explained(here)
    for one in every:
        yield from reduced.inertia(one)
        yield from reduced.moment(one)
    yield from subject.figures(
        "law",
        _("Reduced moments, works and energies are shown in figure {figure}."),
        _("Reduced moments, works and energies over the cycle"),
        only="law-moments",
    )
    yield Heading(_("Driving moment"), 2)
    yield from driving.mean(here)
    for one in every:
        yield from driving.motor(one)
    flies = here.steady.law.flywheel > 0
    yield Heading(_("Flywheel") if flies else _("Fluctuation of speed"), 2)
    yield from flywheel.speeds(here)
    yield from flywheel.diagram(here)
    yield from subject.figures(
        "energy-mass", _("The energy-mass diagram is shown in figure {figure}."), _("Energy-mass diagram")
    )
    if flies:
        for part in (flywheel.by_tangents, flywheel.by_mertsalov, flywheel.on_shaft, flywheel.size):
            yield from part(here)
    yield Heading(_("Speed and acceleration of the driving link"), 2)
    yield from _energy_at_start(here)
    for one in every:
        yield from _position(one, explained=one is here)
    yield from _time(here)
    yield from subject.figures(
        "law",
        _("The law of motion is shown in figure {figure}."),
        _("Law of motion of the driving link"),
        only="law-motion",
    )
    if here.running.sense < 0:
        yield paragraph(signs(subject.results.linkage))
    yield from tables(subject)


def tables(subject: Subject) -> Iterable[Block]:
    """What was found, and the law of motion at every position."""
    found = list(walk(subject.results, TABLES))
    sentences = _("What was found is put together in table {table}."), _("The law of motion is given in table {table}.")
    for table, sentence in zip(found, sentences, strict=True):
        rows = rows_of(subject, table, key=table.name, zeros=table.name == "law-of-motion")
        yield from tabled(sentence, rows)


def _energy_at_start(here: Here) -> Iterable[Block]:
    """From the tangent of the largest speed."""
    upper, __ = here.tangents
    yield said(_("The kinetic energy of the machine in position 0:"))
    flywheel, offset = Leaf(FLYWHEEL, here.steady.law.flywheel), Leaf(OFFSETS[0], upper.offset)
    own = speed_of(upper, LARGEST) ** 2 / 2 * flywheel - offset if flywheel.value else -offset
    yield Found(START, own, here.start, _("J"))


def _position(here: Here, *, explained: bool) -> Iterable[Block]:
    """Speed and acceleration there."""
    text = _("Position {number}:")
    if explained:
        text = _(
            "The speed of the driving link follows from the kinetic energy, and its acceleration from the "
            "equation of motion, in which {slope} is the derivative of the reduced moment of inertia by the angle "
            "of the driving link. Position {number}:"
        )
    yield said(text, slope=SLOPE, number=here.number)
    steady, link = here.steady, here.motion.linkage.driver.link
    law, speed = steady.law, here.speed
    inertia = Leaf(INERTIA, here.of(steady.machine.inertia))
    every = Leaf(FLYWHEEL, law.flywheel) + inertia if law.flywheel else inertia
    energy = Leaf(START, here.start) + Leaf(WORK, here.of(steady.work))
    yield Found(speed.symbol, Function("sqrt", 2 * energy / every), speed.value, _("rad/s"))
    moments = Leaf(DRIVING, here.of(law.driving)) + Leaf(MOMENT, here.of(steady.machine.moment))
    turned = Leaf(SLOPE, here.of(steady.machine.slope)) * (speed**2 / 2)
    found = here.running.sense * float(np.broadcast_to(here.motion.acceleration, here.motion.q.shape)[here.k])
    yield Found(Symbol("ε", link), (moments - turned) / every, found, _("rad/s²"))


def _time(here: Here) -> Iterable[Block]:
    """The time from position 0 on."""
    omega = Letter(Symbol("ω", here.motion.linkage.driver.link))
    yield said(_("The time from position 0 on is the integral of the slowness over the angle:"))
    yield Equation(row(Letter(Symbol("t")), "=", Sign("∫"), Fraction(row("d", Letter(Symbol("φ"))), omega)))
    yield said(_("A cycle takes {time} s."), time=here.subject.text(here.steady.law.period))
