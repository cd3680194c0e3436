"""What drives: a moment from zero work over the cycle, or a motor by its characteristic."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from tmm_cli.dynamics.motors import Kloss, Linear
from tmm_cli.language import _
from tmm_cli.note.blocks import Block, said
from tmm_cli.note.dynamics.words import DRIVING, MOMENT, Here
from tmm_cli.note.expression import Constant, Found, Leaf
from tmm_cli.plans.record import Lettered, Symbol

CYCLE, WHOLE = Lettered("A_c"), Lettered("φ_c")
STALL, FREE = Lettered("M_s"), Symbol("ω", "0")
BREAKDOWN, SLIP, CRITICAL = Lettered("M_k"), Symbol("s"), Lettered("s_k")


def mean(here: Here) -> Iterable[Block]:
    """Over a cycle all moments together do no work."""
    steady = here.steady
    turns = round(steady.machine.length / (2 * math.pi))
    yield said(
        _("In steady running the machine comes back to the same speed after every cycle, so that all moments together "
          "do no work over the cycle. The work {A} of the loads is the area between the diagram of their reduced "
          "moment {M} and its axis, and {phi} is the angle of the cycle."),
        A=CYCLE, M=MOMENT, phi=WHOLE,
    )  # fmt: skip
    text = _("The driving moment is constant:")
    if steady.moment < 0:
        text = _("The loads do work, and what the machine drives takes it with a constant moment:")
    if steady.task.motor is not None:
        text = _("The mean moment of the motor, reduced to the driving link:")
    yield said(text)
    way = 2 * turns * Constant(math.pi, "π")
    work = Leaf(CYCLE, steady.machine.work_of_cycle) / Leaf(WHOLE, 2 * math.pi * turns, of=way)
    yield Found(DRIVING, -work, steady.moment, _("N·m"))


def motor(here: Here) -> Iterable[Block]:
    """The moment in a position, by the speed there."""
    match here.steady.task.motor:
        case Linear() as found:
            yield said(
                _("The characteristic of the motor is a straight line; reduced to the driving link, it gives {M} at "
                  "rest and nothing at {omega}. At the speed of position {number}:"),
                M=STALL, omega=FREE, number=here.number,
            )  # fmt: skip
            moment = Leaf(STALL, found.stall) * (1 - here.speed / Leaf(FREE, found.free))
            yield Found(DRIVING, moment, here.of(here.steady.law.driving), _("N·m"))
        case Kloss() as found:
            yield from _asynchronous(here, found)


def _asynchronous(here: Here, motor: Kloss) -> Iterable[Block]:
    yield said(
        _("The motor is an asynchronous one, whose moment follows its slip {s} by the formula of Kloss. Reduced to the "
          "driving link its synchronous speed is {omega}; {M} is its largest moment, at the slip {sk}. At the speed of "
          "position {number}:"),
        s=SLIP, omega=FREE, M=BREAKDOWN, sk=CRITICAL, number=here.number,
    )  # fmt: skip
    slip, critical = Leaf(SLIP, 1 - here.speed.value / motor.synchronous), Leaf(CRITICAL, motor.slip)
    yield Found(SLIP, 1 - here.speed / Leaf(FREE, motor.synchronous), slip.value)
    if slip.value:
        moment = 2 * Leaf(BREAKDOWN, motor.breakdown) / (slip / critical + critical / slip)
        found = float(motor.moment(np.array([here.speed.value]))[0])
        yield Found(DRIVING, moment, found, _("N·m"))
