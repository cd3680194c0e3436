"""The flywheel: by tangents of the energy-mass diagram, by Mertsalov, on its shaft, and how large it is."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from tmm_cli.dynamics.flywheel import Tangent
from tmm_cli.language import _, symbol
from tmm_cli.note.blocks import Block, said
from tmm_cli.note.dynamics.words import DELTA, FLYWHEEL, INERTIA, LARGEST, LEAST, MEAN, START, WORK, Here
from tmm_cli.note.expression import (
    Constant,
    Expression,
    Found,
    Leaf,
    Product,
    Raised,
    Sum,
)
from tmm_cli.note.math import Brackets, Fraction, Letter, Node, Number, Power, row
from tmm_cli.plans.record import Lettered, Symbol

OFFSETS = Symbol("E", "a"), Symbol("E", "b")
GAIN, ON_SHAFT, RATIO = Symbol("ΔT"), Lettered("J_s"), Symbol("u")
DENSITY, SHARE, HEIGHT = Symbol("ρ"), Symbol("β"), Symbol("η")
DIAMETER, WIDTH, MASS = Symbol("D"), Symbol("b"), Lettered("m_f")


def speeds(here: Here) -> Iterable[Block]:
    """The largest and the least one, from their mean and the fluctuation."""
    steady = here.steady
    low, high = steady.speeds
    middle, delta = Leaf(MEAN, (low + high) / 2), Leaf(DELTA, steady.delta)
    yield said(
        _("The largest and the least speed of the driving link follow from their mean {mean} and the coefficient of "
          "fluctuation {delta}:"),
        mean=MEAN, delta=DELTA,
    )  # fmt: skip
    for name, value, sign in ((LARGEST, high, 1), (LEAST, low, -1)):
        share = Sum(((1, Constant(1)), (sign, delta / 2)))
        yield Found(name, middle * share, value, _("rad/s"))


def diagram(here: Here) -> Iterable[Block]:
    """The energy-mass diagram and what its tangents cut off."""
    yield said(
        _("The kinetic energy of the machine is {T} in position 0 and grows by the work {A} of all moments from there "
          "on. Over the reduced moment of inertia {J} this work gives the energy-mass diagram of Wittenbauer. A line "
          "that touches it from above with the slope {up}, and one that touches it from below with the slope {low}, "
          "belong to the largest and the least speed: on paper their angles are {psi}. They cut off from the axis on "
          "which {J} is zero the energies {Ea} and {Eb}:"),
        T=START, A=WORK, J=INERTIA, up=_half(LARGEST), low=_half(LEAST), Ea=OFFSETS[0], Eb=OFFSETS[1],
        psi=row(symbol("tan"), Letter(Symbol("ψ")), "=", Fraction(
            row(Letter(Symbol("μ", "J")), "·", Power(Letter(Symbol("ω")), Number("2"))),
            row(Number("2"), "·", Letter(Symbol("μ", "A"))),
        )),
    )  # fmt: skip
    for tangent, name, speed, point in zip(here.tangents, OFFSETS, (LARGEST, LEAST), ("a", "b"), strict=True):
        energy = _slope(tangent, speed)
        inertia = Leaf(Symbol(INERTIA.letter, point), tangent.inertia)
        ordinate = Leaf(Symbol(WORK.letter, point), tangent.energy)
        cut = ordinate - energy * inertia
        yield Found(name, cut, tangent.offset, _("J"))


def by_tangents(here: Here) -> Iterable[Block]:
    """Its inertia from what they cut off."""
    steady = here.steady
    upper, lower = here.tangents
    if steady.task.delta is not None and steady.task.motor is not None:
        yield said(
            _("The flywheel changes what the motor gives, so it is sought with the motor, and the diagram is that of "
              "the machine with it. Its moment of inertia, reduced to the driving link:")
        )  # fmt: skip
    elif steady.task.delta is not None:
        yield said(_("The moment of inertia of the flywheel, reduced to the driving link:"))
    else:
        yield said(_("The moment of inertia of the given flywheel, reduced to the driving link, is found there again:"))
    cut = Sum(tuple((s, Leaf(n, t.offset)) for s, n, t in zip((1, -1), OFFSETS, (upper, lower), strict=True)))
    squares = Sum(tuple((s, _speed(t, n) ** 2) for s, n, t in ((1, LARGEST, upper), (-1, LEAST, lower))))
    whole = 2 * cut / squares
    yield Found(FLYWHEEL, whole, steady.law.flywheel, _("kg·m²"))


def by_mertsalov(here: Here) -> Iterable[Block]:
    """Where the flywheel is found for a constant moment; and what the course's tangents give."""
    steady = here.steady
    if steady.found is None:
        return
    upper, lower = steady.at_mean
    most, least = Leaf(OFFSETS[0].primed, upper.offset), Leaf(OFFSETS[1].primed, lower.offset)
    yield said(
        _("With the squares {plus} and {minus} of the speeds, as they are taken in a course, the same tangents give "
          "{found} kg·m². By the method of Mertsalov the energy of the links is taken at the mean speed; then the "
          "energy of the flywheel changes between {most} and {least}, the largest and the least of {rest}:"),
        plus=_square(1), minus=_square(-1), found=here.subject.text(steady.wittenbauer),
        most=most.symbol, least=least.symbol, rest=row(Letter(WORK), "−", Letter(INERTIA), "·", _half(MEAN)),
    )  # fmt: skip
    gain = most.value - least.value
    yield Found(GAIN, most - least, gain, _("J"))
    under = Leaf(DELTA, steady.task.delta or 0.0) * Leaf(MEAN, steady.task.mean) ** 2
    yield Found(FLYWHEEL.primed, Leaf(GAIN, gain) / under, steady.mertsalov, _("kg·m²"))


def on_shaft(here: Here) -> Iterable[Block]:
    """Where it sits on another shaft."""
    steady = here.steady
    if steady.task.ratio == 1:
        return
    yield said(
        _("The flywheel sits on a shaft that turns {u} times as fast as the driving link; there its moment of inertia "
          "is"),
        u=RATIO,
    )  # fmt: skip
    own = Leaf(FLYWHEEL, steady.law.flywheel) / Leaf(RATIO, steady.task.ratio) ** 2
    yield Found(ON_SHAFT, own, steady.on_shaft, _("kg·m²"))


def size(here: Here) -> Iterable[Block]:
    """Diameter, width and mass of a disk, or of a rim."""
    steady = here.steady
    form, inertia = steady.task.size, Leaf(FLYWHEEL if steady.task.ratio == 1 else ON_SHAFT, steady.on_shaft)
    density, share, height = Leaf(DENSITY, form.density), Leaf(SHARE, form.width), Leaf(HEIGHT, form.height)
    diameter = steady.diameter
    pi = Constant(math.pi, "π")
    of_section: tuple[Expression, ...] = (density, share)
    if form.shape == "disk":
        yield said(
            _("The flywheel is a solid disk of the density {rho}, whose width is the share {beta} of its diameter; its "
              "moment of inertia is {J}, and so its diameter is"),
            rho=DENSITY, beta=SHARE, J=_of_form("8"),
        )  # fmt: skip
        numbers = 32.0, 0.25
    else:
        yield said(
            _("The flywheel is a rim of the density {rho}, whose section has the shares {beta} and {eta} of its mean "
              "diameter as width and height; spokes and hub are left out. Its moment of inertia is {J}, and so its "
              "mean diameter is"),
            rho=DENSITY, beta=SHARE, eta=HEIGHT, J=_of_form("4"),
        )  # fmt: skip
        numbers, of_section = (4.0, 1.0), (density, share, height)
    root = Constant(numbers[0]) * inertia / Product((pi, *of_section))
    yield Found(DIAMETER, Raised(root, 1, 5), diameter, _("m"))
    yield said(_("Its width and its mass:"))
    yield Found(WIDTH, share * Leaf(DIAMETER, diameter), steady.width, _("m"))
    mass = Product((pi, *of_section, Raised(Leaf(DIAMETER, diameter), 3)))
    whole = mass if numbers[1] == 1 else mass / 4
    yield Found(MASS, whole, steady.mass, _("kg"))


def _speed(tangent: Tangent, name: Symbol) -> Leaf:
    return Leaf(name, float(np.sqrt(2 * tangent.slope)))


def _slope(tangent: Tangent, name: Symbol) -> Expression:
    return _speed(tangent, name) ** 2 / 2


def _half(speed: Symbol) -> Node:
    return Fraction(Power(Letter(speed), Number("2")), Number("2"))


def _square(sign: int) -> Node:
    """Of the course: with the fluctuation itself."""
    share = Brackets(row(Number("1"), "+" if sign > 0 else "−", Letter(DELTA)))
    return row(Power(Letter(MEAN), Number("2")), "·", share)


def _of_form(under: str) -> Node:
    return Fraction(row(Letter(MASS), "·", Power(Letter(DIAMETER), Number("2"))), Number(under))
