"""Speed, acceleration and time of the driving link."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tmm_cli.language import _
from tmm_cli.note.blocks import Block, Equation, said
from tmm_cli.note.dynamics.flywheel import OFFSETS, speed_of
from tmm_cli.note.dynamics.words import DRIVING, FLYWHEEL, INERTIA, LARGEST, MOMENT, SLOPE, START, WORK, Here
from tmm_cli.note.expression import Found, Function, Leaf
from tmm_cli.note.math import Fraction, Letter, Sign, row
from tmm_cli.plans.record import Symbol


def energy_at_start(here: Here) -> Iterable[Block]:
    """From the tangent of the largest speed."""
    upper, __ = here.tangents
    yield said(_("The kinetic energy of the machine in position 0:"))
    flywheel, offset = Leaf(FLYWHEEL, here.steady.law.flywheel), Leaf(OFFSETS[0], upper.offset)
    own = speed_of(upper, LARGEST) ** 2 / 2 * flywheel - offset if flywheel.value else -offset
    yield Found(START, own, here.start, _("J"))


def position(here: Here, *, explained: bool) -> Iterable[Block]:
    """Speed and acceleration there."""
    if explained:
        yield said(
            _("The speed of the driving link follows from the kinetic energy, and its acceleration from the equation "
              "of motion, in which {slope} is the derivative of the reduced moment of inertia by the angle of the "
              "driving link. Position {number}:"),
            slope=SLOPE, number=here.number,
        )  # fmt: skip
    else:
        yield said(_("Position {number}:"), number=here.number)
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


def time(here: Here) -> Iterable[Block]:
    """The time from position 0 on."""
    omega = Letter(Symbol("ω", here.motion.linkage.driver.link))
    yield said(_("The time from position 0 on is the integral of the slowness over the angle:"))
    yield Equation(row(Letter(Symbol("t")), "=", Sign("∫"), Fraction(row("d", Letter(Symbol("φ"))), omega)))
    yield said(_("A cycle takes {time} s."), time=here.subject.text(here.steady.law.period))
