"""Reduced moment of inertia and reduced moment of a machine in detailed positions, and the driving moment."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tmm_cli.language import _
from tmm_cli.mechanics.dynamics import KlossMotor, LinearMotor, PanelCurve, SteadyRunning, SteadySolution, Tangent
from tmm_cli.mechanics.forces import AppliedLoad, CourseSymbol, Symbol, load_symbols
from tmm_cli.mechanics.kinematics import Motion
from tmm_cli.mechanics.numerics import NO_VECTOR
from tmm_cli.note.blocks import Block, write_sentence
from tmm_cli.note.expression import (
    EXACT,
    ComputedQuantity,
    Constant,
    Expression,
    Function,
    Leaf,
    Sum,
    apply_sign,
    evaluate,
    sum_terms,
)
from tmm_cli.note.subject import Subject

INERTIA, SLOPE, MOMENT, DRIVING, WORK = Symbol("J"), Symbol("J′"), Symbol("M"), CourseSymbol("M_d"), Symbol("A")
FLYWHEEL, START, MEAN, DELTA = CourseSymbol("J_f"), Symbol("T", "0"), CourseSymbol("ω_m"), Symbol("δ")
LARGEST, LEAST = Symbol("ω", "max"), Symbol("ω", "min")


@dataclass(frozen=True)
class SteadyPosition:
    """Position of a machine in steady running. Quantities are positive in the sense of rotation of the input link."""

    subject: Subject
    k: int

    @property
    def running(self) -> SteadyRunning:
        assert self.subject.results.steady is not None
        return self.subject.results.steady

    @property
    def steady(self) -> SteadySolution:
        return self.running.steady

    @property
    def motion(self) -> Motion:
        return self.subject.motion

    @property
    def number(self) -> str:
        return self.subject.position_number(self.k)

    @property
    def speed(self) -> Leaf:
        """Magnitude of the angular velocity of the input link (rad/s)."""
        return Leaf(Symbol("ω", self.motion.linkage.driver.link), abs(self.subject.rate(self.k)))

    @cached_property
    def tangents(self) -> tuple[Tangent, Tangent]:
        return self.steady.tangents

    @cached_property
    def initial_energy(self) -> float:
        """Kinetic energy in position 0 (J)."""
        upper, __ = self.tangents
        return upper.slope * self.steady.law.flywheel - upper.offset

    def value_of(self, curve: PanelCurve) -> float:
        """Return the value in this position of a curve plotted against the angle of the input link."""
        return float(curve(self.running.travel(self.motion.q))[self.k])


# Reduced moment of inertia and reduced moment in one position: terms of the links and of the loads.


def explain_reduction(position: SteadyPosition) -> Iterable[Block]:
    """Explain the reduction of masses and loads to the input link."""
    link = position.motion.linkage.driver.link
    yield write_sentence(
        _(
            "The machine is replaced by its input link {link}, to which all masses and all loads are reduced; "
            "quantities in its direction of rotation are positive. An input link with the reduced moment of "
            "inertia {J} has the same kinetic energy as all links together, and the power of the reduced "
            "moment {M} equals the total power of all loads. Both are computed from velocity ratios, which do "
            "not depend on the speed of the input link."
        ),
        link=link,
        J=INERTIA,
        M=MOMENT,
    )


def write_reduced_inertia(position: SteadyPosition) -> Iterable[Block]:
    """Write the reduced moment of inertia.

    It is the sum of the masses and moments of inertia of the links, each multiplied by its squared velocity ratio.
    """
    terms = [term for link in position.motion.linkage.moving for term in _inertia_terms(position, link)]
    if not terms:
        return
    yield write_sentence(
        _(
            "In position {number} the reduced moment of inertia is found by the following formula, in which "
            "{m} is the mass of a link, {v} the velocity of its centre of mass, {J} its moment of inertia "
            "about the centre of mass and {omega} its angular velocity:"
        ),
        number=position.number,
        m=Symbol("m"),
        v=Symbol("v", "S"),
        J=Symbol("J", "S"),
        omega=Symbol("ω"),
    )
    yield ComputedQuantity(
        INERTIA, _sum_without_negligible(terms), position.value_of(position.steady.machine.inertia), _("kg·m²")
    )


def _inertia_terms(position: SteadyPosition, name: str) -> Iterable[Expression]:
    motion, link, omega = position.motion, position.motion.linkage.links[name], position.speed
    speed = Leaf(Symbol("v", f"S{name}"), abs(complex(motion.centre(name).v[position.k])))
    turned = Leaf(Symbol("ω", name), abs(float(motion.link(name).omega[position.k])))
    yield Leaf(Symbol("m", name), float(np.ravel(link.mass)[0])) * (speed / omega) ** 2
    inertia = Leaf(Symbol("J", f"S{name}"), float(np.ravel(link.inertia)[0]))
    yield inertia if turned.symbol == omega.symbol else inertia * (turned / omega) ** 2


def write_reduced_moment(position: SteadyPosition) -> Iterable[Block]:
    """Write the reduced moment: the power of all loads divided by the angular velocity of the input link."""
    terms = [
        term
        for load in position.subject.results.loads
        if load.kind != "inertia"
        for term in _power_terms(position, load)
    ]
    if not terms:
        return
    yield write_sentence(
        _(
            "The reduced moment of the loads is found by the following formula, in which {v} is the velocity "
            "of the point of action of a force and {alpha} the angle between the force and this velocity; the "
            "power of a couple is positive if it acts in the sense of the angular velocity of its link:"
        ),
        v=Symbol("v"),
        alpha=Symbol("α"),
    )
    whole = _sum_without_negligible(terms) / position.speed
    yield ComputedQuantity(MOMENT, whole, position.value_of(position.steady.machine.moment), _("N·m"))


def _power_terms(position: SteadyPosition, load: AppliedLoad) -> Iterable[Expression]:
    k, motion = position.k, position.motion
    force, couple = load_symbols(load)
    force_vector, turned = complex(load.force[k]), float(load.moment[k])
    speed = complex(motion.point(load.link, load.at).v[k])
    if force_vector and speed:
        in_centre = load.kind == "weight"
        velocity = Leaf(Symbol("v", f"S{load.link}" if in_centre else force.plain), abs(speed))
        angle, factors = abs(float(np.angle(force_vector / speed))), Leaf(force, abs(force_vector)) * velocity
        if min(angle, np.pi - angle) < NO_VECTOR:
            yield apply_sign(1 - angle, factors)
        else:
            cosine = Function("cos", Leaf(Symbol("α", force.plain), angle, angle=True))
            yield factors * cosine
    omega = float(motion.link(load.link).omega[k])
    if turned and omega:
        velocity = Leaf(Symbol("ω", load.link), abs(omega))
        yield apply_sign(turned * omega, Leaf(couple, abs(turned)) * velocity)


def _sum_without_negligible(terms: list[Expression]) -> Sum:
    magnitudes = [abs(evaluate(term, EXACT)) for term in terms]
    return sum_terms(
        term for term, magnitude in zip(terms, magnitudes, strict=True) if magnitude > NO_VECTOR * max(magnitudes)
    )


# Driving moment: constant, from zero work over the cycle, or that of a motor by its characteristic.


CYCLE, WHOLE = CourseSymbol("A_c"), CourseSymbol("φ_c")
STALL, FREE = CourseSymbol("M_s"), Symbol("ω", "0")
BREAKDOWN, SLIP, CRITICAL = CourseSymbol("M_k"), Symbol("s"), CourseSymbol("s_k")


def write_mean_driving_moment(position: SteadyPosition) -> Iterable[Block]:
    """Write the mean driving moment. It follows from the condition that the total work over the cycle is zero."""
    steady = position.steady
    turns = round(steady.machine.length / (2 * math.pi))
    yield write_sentence(
        _(
            "In steady running the machine returns to the same speed after every cycle, so the total work of "
            "all moments over the cycle is zero. The work {A} of the loads is the area under the diagram of "
            "their reduced moment {M}, and {phi} is the angle of the cycle."
        ),
        A=CYCLE,
        M=MOMENT,
        phi=WHOLE,
    )
    text = _("The driving moment is constant:")
    if steady.moment < 0:
        text = _("The loads do positive work over the cycle; the driven machine absorbs it with a constant moment:")
    if steady.task.motor is not None:
        text = _("The mean moment of the motor, reduced to the input link:")
    yield write_sentence(text)
    cycle_angle = 2 * turns * Constant(math.pi, "π")
    work = Leaf(CYCLE, steady.machine.work_of_cycle) / Leaf(WHOLE, 2 * math.pi * turns, of=cycle_angle)
    yield ComputedQuantity(DRIVING, -work, steady.moment, _("N·m"))


def write_motor_moment(position: SteadyPosition) -> Iterable[Block]:
    """Write the moment of the motor at the speed in this position. Nothing is written if no motor is given."""
    match position.steady.task.motor:
        case LinearMotor() as motor:
            yield write_sentence(
                _(
                    "The characteristic of the motor is a straight line: reduced to the input link, the moment is {M} "
                    "at rest and zero at the speed {omega}. At the speed in position {number}:"
                ),
                M=STALL,
                omega=FREE,
                number=position.number,
            )
            moment = Leaf(STALL, motor.stall) * (1 - position.speed / Leaf(FREE, motor.free))
            yield ComputedQuantity(DRIVING, moment, position.value_of(position.steady.law.driving), _("N·m"))
        case KlossMotor() as motor:
            yield from _write_kloss_moment(position, motor)


def _write_kloss_moment(position: SteadyPosition, motor: KlossMotor) -> Iterable[Block]:
    yield write_sentence(
        _(
            "The motor is asynchronous; its moment depends on the slip {s} according to Kloss's formula. "
            "Reduced to the input link, the synchronous speed is {omega} and the breakdown torque (the largest "
            "moment) {M}, which is reached at the slip {sk}. At the speed in position {number}:"
        ),
        s=SLIP,
        omega=FREE,
        M=BREAKDOWN,
        sk=CRITICAL,
        number=position.number,
    )
    slip, critical = Leaf(SLIP, 1 - position.speed.value / motor.synchronous), Leaf(CRITICAL, motor.slip)
    yield ComputedQuantity(SLIP, 1 - position.speed / Leaf(FREE, motor.synchronous), slip.value)
    if slip.value:
        moment = 2 * Leaf(BREAKDOWN, motor.breakdown) / (slip / critical + critical / slip)
        computed_moment = float(motor.moment(np.array([position.speed.value]))[0])
        yield ComputedQuantity(DRIVING, moment, computed_moment, _("N·m"))
