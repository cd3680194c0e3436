"""Flywheel: moment of inertia from the energy-mass diagram and by Mertsalov's method; diameter, width and mass."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from tmm_cli.language import _, symbol
from tmm_cli.mechanics.dynamics import Tangent
from tmm_cli.mechanics.forces import CourseSymbol, Symbol
from tmm_cli.note.blocks import Block, write_sentence
from tmm_cli.note.dynamics.reduced_model import (
    DELTA,
    FLYWHEEL,
    INERTIA,
    LARGEST,
    LEAST,
    MEAN,
    START,
    WORK,
    SteadyPosition,
)
from tmm_cli.note.expression import ComputedQuantity, Constant, Leaf, PowerOf, symbolic_formula
from tmm_cli.note.formula_tree import Letter, row

OFFSETS = Symbol("E", "a"), Symbol("E", "b")
FIRST_GROUP, CONSTANT = CourseSymbol("J_I"), CourseSymbol("J_c")
GAIN, ON_SHAFT, RATIO = Symbol("ΔT"), CourseSymbol("J_s"), Symbol("u")
DENSITY, SHARE, HEIGHT = Symbol("ρ"), Symbol("β"), Symbol("η")
DIAMETER, WIDTH, MASS = Symbol("D"), Symbol("b"), CourseSymbol("m_f")


def write_extreme_speeds(position: SteadyPosition) -> Iterable[Block]:
    """Write the largest and the smallest angular velocity from the mean one and the coefficient of fluctuation."""
    steady = position.steady
    low, high = steady.speeds
    middle, half = Leaf(MEAN, (low + high) / 2), Leaf(DELTA, steady.delta) / 2
    yield write_sentence(
        _(
            "The largest and the smallest angular velocity of the input link follow from the mean angular "
            "velocity {mean} and the coefficient of fluctuation of speed {delta}:"
        ),
        mean=MEAN,
        delta=DELTA,
    )
    yield ComputedQuantity(LARGEST, middle * (1 + half), high, _("rad/s"))
    yield ComputedQuantity(LEAST, middle * (1 - half), low, _("rad/s"))


def write_energy_mass_diagram(position: SteadyPosition) -> Iterable[Block]:
    """Write the energy-mass diagram and the energies (J) that its two tangents cut off on the energy axis."""
    upper, lower = Leaf(LARGEST) ** 2 / 2, Leaf(LEAST) ** 2 / 2
    slope = Leaf(Symbol("μ", "J")) * Leaf(Symbol("ω")) ** 2 / (2 * Leaf(Symbol("μ", "A")))
    yield write_sentence(
        _(
            "The kinetic energy of the machine is {T} in position 0 and then increases by the work {A} of all "
            "moments. This work, plotted against the reduced moment of inertia {J}, gives the energy-mass "
            "diagram (Wittenbauer's diagram). The upper tangent with the slope {up} corresponds to the largest "
            "speed, the lower tangent with the slope {low} to the smallest; on the drawing their angles are "
            "given by {psi}. On the axis {J} = 0 the tangents cut off the energies {Ea} and {Eb}:"
        ),
        T=START,
        A=WORK,
        J=INERTIA,
        up=symbolic_formula(upper),
        low=symbolic_formula(lower),
        Ea=OFFSETS[0],
        Eb=OFFSETS[1],
        psi=row(symbol("tan"), Letter(Symbol("ψ")), "=", symbolic_formula(slope)),
    )
    for tangent, name, speed, point in zip(position.tangents, OFFSETS, (LARGEST, LEAST), ("a", "b"), strict=True):
        energy, work = tangent_speed(tangent, speed) ** 2 / 2, Leaf(Symbol(WORK.letter, point), tangent.energy)
        cut = work - energy * Leaf(Symbol(INERTIA.letter, point), tangent.inertia)
        yield ComputedQuantity(name, cut, tangent.offset, _("J"))


def write_flywheel_by_tangents(position: SteadyPosition) -> Iterable[Block]:
    """Write the moment of inertia of the flywheel from the energies that the two tangents cut off."""
    steady = position.steady
    upper, lower = position.tangents
    text = _("The moment of inertia of the flywheel, reduced to the input link:")
    if steady.task.delta is None:
        text = _("The same construction gives the moment of inertia of the given flywheel, reduced to the input link:")
    elif steady.task.motor is not None:
        text = _(
            "The flywheel affects the moment of the motor, so both are determined together, and the diagram is "
            "drawn for the machine with the flywheel. The moment of inertia of the flywheel, reduced to the "
            "input link:"
        )
    yield write_sentence(text)
    cut = Leaf(OFFSETS[0], upper.offset) - Leaf(OFFSETS[1], lower.offset)
    squares = tangent_speed(upper, LARGEST) ** 2 - tangent_speed(lower, LEAST) ** 2
    yield ComputedQuantity(FLYWHEEL, 2 * cut / squares, steady.law.flywheel, _("kg·m²"))


def write_flywheel_by_mertsalov(position: SteadyPosition) -> Iterable[Block]:
    """Write the moment of inertia of the flywheel by two approximate methods that are usual in student courses.

    These are Mertsalov's method, and tangents whose slopes are approximated. Both assume a constant driving moment.
    Nothing is written if there is no exact result with which to compare them.
    """
    steady = position.steady
    if steady.found is None:
        return
    upper, lower = steady.at_mean
    most, least = Leaf(OFFSETS[0].primed, upper.offset), Leaf(OFFSETS[1].primed, lower.offset)
    square, delta = Leaf(MEAN, steady.task.mean) ** 2, Leaf(DELTA, steady.task.delta or 0.0)
    constant = steady.machine.constant
    second = Leaf(INERTIA) - Leaf(CONSTANT) if constant else Leaf(INERTIA)
    yield write_sentence(
        _(
            "If the squares of the speeds are approximated by {plus} and {minus}, as is usual in student "
            "projects, the same tangents give {found} kg·m²."
        ),
        plus=symbolic_formula(square * (1 + delta)),
        minus=symbolic_formula(square * (1 - delta)),
        found=position.subject.text(steady.wittenbauer),
    )
    if constant:
        yield write_sentence(
            _(
                "By Mertsalov's method the flywheel and the links with a constant velocity ratio to the input link "
                "form the first group; the moment of inertia of these links is {constant} = {value} kg·m². The "
                "energy of the other links, the second group, is taken at the mean speed. The energy of the first "
                "group then varies between {most} and {least}, the largest and the smallest value of {rest}:"
            ),
            constant=CONSTANT,
            value=position.subject.text(constant),
            most=most.symbol,
            least=least.symbol,
            rest=symbolic_formula(Leaf(WORK) - second * (Leaf(MEAN) ** 2 / 2)),
        )
    else:
        yield write_sentence(
            _(
                "By Mertsalov's method the energy of the links is taken at the mean speed. The energy of the "
                "flywheel then varies between {most} and {least}, the largest and the smallest value of {rest}:"
            ),
            most=most.symbol,
            least=least.symbol,
            rest=symbolic_formula(Leaf(WORK) - second * (Leaf(MEAN) ** 2 / 2)),
        )
    gain = most.value - least.value
    yield ComputedQuantity(GAIN, most - least, gain, _("J"))
    inertia = Leaf(GAIN, gain) / (delta * square)
    if not constant:
        yield ComputedQuantity(FLYWHEEL.primed, inertia, steady.mertsalov, _("kg·m²"))
        return
    yield ComputedQuantity(FIRST_GROUP, inertia, steady.first_group, _("kg·m²"))
    yield write_sentence(
        _("When the links of the first group are subtracted, the moment of inertia of the flywheel is")
    )
    flywheel = Leaf(FIRST_GROUP, steady.first_group) - Leaf(CONSTANT, constant)
    yield ComputedQuantity(FLYWHEEL.primed, flywheel, steady.mertsalov, _("kg·m²"))


def write_flywheel_on_its_shaft(position: SteadyPosition) -> Iterable[Block]:
    """Write the moment of inertia of the flywheel on its own shaft. Nothing is written if this is the input shaft."""
    steady = position.steady
    if steady.task.ratio == 1:
        return
    yield write_sentence(
        _(
            "The flywheel is mounted on a shaft that rotates {u} times as fast as the input link; its moment "
            "of inertia on this shaft is"
        ),
        u=RATIO,
    )
    on_shaft = Leaf(FLYWHEEL, steady.law.flywheel) / Leaf(RATIO, steady.task.ratio) ** 2
    yield ComputedQuantity(ON_SHAFT, on_shaft, steady.on_shaft, _("kg·m²"))


def write_flywheel_size(position: SteadyPosition) -> Iterable[Block]:
    """Write the diameter, the width and the mass of the flywheel, which is a disk or a rim."""
    steady = position.steady
    form, inertia = steady.task.size, Leaf(FLYWHEEL if steady.task.ratio == 1 else ON_SHAFT, steady.on_shaft)
    share, diameter = Leaf(SHARE, form.width), Leaf(DIAMETER, steady.diameter)
    section = Constant(math.pi, "π") * Leaf(DENSITY, form.density) * share
    moment = Leaf(MASS) * Leaf(DIAMETER) ** 2
    if form.shape == "disk":
        yield write_sentence(
            _(
                "The flywheel is a solid disk of density {rho}. Its width is {beta} times its diameter and its "
                "moment of inertia is {J}, so its diameter is"
            ),
            rho=DENSITY,
            beta=SHARE,
            J=symbolic_formula(moment / 8),
        )
        numbers = 32, 4
    else:
        yield write_sentence(
            _(
                "The flywheel is a rim of density {rho}. The width and the height of its section are {beta} and "
                "{eta} times the mean diameter; spokes and hub are neglected. Its moment of inertia is {J}, so its "
                "mean diameter is"
            ),
            rho=DENSITY,
            beta=SHARE,
            eta=HEIGHT,
            J=symbolic_formula(moment / 4),
        )
        section = section * Leaf(HEIGHT, form.height)
        numbers = 4, 1
    yield ComputedQuantity(DIAMETER, PowerOf(numbers[0] * inertia / section, 1, 5), diameter.value, _("m"))
    yield write_sentence(_("The width and the mass of the flywheel:"))
    yield ComputedQuantity(WIDTH, share * diameter, steady.width, _("m"))
    mass = section * diameter**3
    yield ComputedQuantity(MASS, mass if numbers[1] == 1 else mass / numbers[1], steady.mass, _("kg"))


def tangent_speed(tangent: Tangent, name: Symbol) -> Leaf:
    """Return the angular velocity (rad/s) that corresponds to a tangent of the energy-mass diagram: ω² = 2·slope."""
    return Leaf(name, float(np.sqrt(2 * tangent.slope)))
