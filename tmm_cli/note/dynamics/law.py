"""Speed, acceleration and time of the driving link."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tmm_cli.language import _
from tmm_cli.note.blocks import Block, Equation, said
from tmm_cli.note.dynamics.flywheel import OFFSETS
from tmm_cli.note.dynamics.words import DRIVING, FLYWHEEL, INERTIA, LARGEST, MOMENT, SLOPE, START, WORK, Here
from tmm_cli.note.expression import Found, Leaf, SquareRoot, Sum
from tmm_cli.note.math import Fraction, Letter, Sign, row
from tmm_cli.plans.record import Symbol


def energy_at_start(here: Here) -> Iterable[Block]:
    """From the tangent of the largest speed."""
    upper, __ = here.tangents
    yield said(_("The kinetic energy of the machine in position 0:"))
    square = Leaf(LARGEST, float(np.sqrt(2 * upper.slope))) ** 2 / 2
    flywheel = (1, square * Leaf(FLYWHEEL, here.steady.law.flywheel))
    terms = (flywheel, (-1, Leaf(OFFSETS[0], upper.offset)))
    own = Sum(terms if here.steady.law.flywheel else terms[1:])
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
    root = SquareRoot(2 * energy / every)
    yield Found(speed.symbol, root, speed.value, _("rad/s"))
    moments = ((1, Leaf(DRIVING, here.of(law.driving))), (1, Leaf(MOMENT, here.of(steady.machine.moment))))
    turned = Leaf(SLOPE, here.of(steady.machine.slope)) * (speed**2 / 2)
    found = here.running.sense * float(np.broadcast_to(here.motion.acceleration, here.motion.q.shape)[here.k])
    whole = Sum((*moments, (-1, turned))) / every
    yield Found(Symbol("ε", link), whole, found, _("rad/s²"))


def time(here: Here) -> Iterable[Block]:
    """The time from position 0 on."""
    omega = Letter(Symbol("ω", here.motion.linkage.driver.link))
    yield said(_("The time from position 0 on is the integral of the slowness over the angle:"))
    yield Equation(row(Letter(Symbol("t")), "=", Sign("∫"), Fraction(row("d", Letter(Symbol("φ"))), omega)))
    yield said(
        _("A cycle takes {time} s."), time=here.subject.text(here.steady.law.period)
    )  # fmt: skip
