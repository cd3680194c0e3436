"""Sections on the loads: weights, inertia forces and couples, load elements, friction, and the losses by friction."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from tmm_cli.language import _
from tmm_cli.mechanics.forces import (
    AppliedLoad,
    Symbol,
    balance_symbol,
    course_symbol,
    load_symbols,
    reaction_symbol,
    solve_reactions,
)
from tmm_cli.mechanics.linkage import Friction
from tmm_cli.mechanics.numerics import NO_FORCE
from tmm_cli.note.blocks import Block, Line, Rows, cells, join_inline, write_sentence, write_table
from tmm_cli.note.expression import ComputedQuantity, Leaf, Product, state_value, sum_terms
from tmm_cli.note.kinematics.equations import name_sense, write_equality
from tmm_cli.note.subject import Subject
from tmm_cli.reports import describe_locked_ranges, element_view


def write_weights(subject: Subject) -> Iterable[Block]:
    """Write the weights of the links."""
    linkage = subject.results.linkage
    gravity = Leaf(Symbol("g"), abs(complex(linkage.gravity)))
    weights = [load for load in subject.results.loads if load.kind == "weight"]
    if not weights or not gravity.value:
        return
    yield write_sentence(
        _(
            "The weight {G} of a link is the product of its mass {m} and the acceleration of gravity {g}; it "
            "acts at the centre of mass of the link:"
        ),
        G=course_symbol("G"),
        m=Symbol("m"),
        g=gravity.symbol,
    )
    for load in weights:
        mass = Leaf(Symbol("m", load.link), float(linkage.links[load.link].mass))
        magnitude = float(np.abs(np.ravel(load.force)[0]))
        yield ComputedQuantity(load_symbols(load)[0], mass * gravity, magnitude, _("N"))


def write_inertia(subject: Subject, k: int, *, explained: bool) -> Iterable[Block]:
    """Write the inertia forces and couples in one position. A sentence names those that are zero."""
    quantities = [
        quantity
        for load in subject.results.loads
        if load.kind == "inertia"
        for quantity in _inertia_load(subject, load, k)
    ]
    if not quantities:
        return
    explanation = (
        _(
            "The inertia force {U} of a link acts at its centre of mass, opposite to the acceleration of this "
            "point; the inertia couple {M} is opposite to the angular acceleration {epsilon} of the link; {J} "
            "is the moment of inertia of the link about its centre of mass:"
        )
        if explained
        else _("Inertia forces and couples:")
    )
    yield write_sentence(
        explanation, U=course_symbol("U"), M=course_symbol("M"), epsilon=Symbol("ε"), J=Symbol("J", "S")
    )
    units = {quantity.unit for quantity in quantities}
    largest = {unit: max(quantity.result for quantity in quantities if quantity.unit == unit) for unit in units}
    nonzero = [quantity for quantity in quantities if quantity.result > NO_FORCE * largest[quantity.unit]]
    yield from nonzero
    zero_symbols = [quantity.name for quantity in quantities if quantity not in nonzero]
    if zero_symbols:
        text = _("The following are zero, because the corresponding accelerations are zero: {names}.")
        if len(zero_symbols) == 1:
            text = _("{names} = 0, because the corresponding acceleration is zero.")
        yield write_sentence(text, names=join_inline(zero_symbols))


def _inertia_load(subject: Subject, load: AppliedLoad, k: int) -> Iterable[ComputedQuantity]:
    motion, link = subject.motion, subject.results.linkage.links[load.link]
    force, couple = load_symbols(load)
    if np.any(link.mass != 0):
        mass = Leaf(Symbol("m", load.link), float(link.mass))
        a = Leaf(Symbol("a", f"S{load.link}"), abs(complex(motion.centre(load.link).a[k])))
        yield ComputedQuantity(force, mass * a, abs(complex(load.force[k])), _("N"))
    if np.any(link.inertia != 0):
        moment = Leaf(Symbol("J", f"S{load.link}"), float(link.inertia))
        epsilon = Leaf(Symbol("ε", load.link), abs(float(motion.link(load.link).epsilon[k])))
        yield ComputedQuantity(couple, moment * epsilon, abs(float(load.moment[k])), _("N·m"))


def write_elements(subject: Subject, k: int) -> Iterable[Block]:
    """Write the force or moment of each load element, as its law gives it in one position."""
    for element in subject.results.linkage.elements:
        load = next((candidate for candidate in subject.results.loads if candidate.name == element.name), None)
        if load is not None:
            stretch = element.stretch(subject.motion)
            law = element_view(element.block).law(element, float(stretch.size[k]), float(stretch.rate[k]), Leaf)
            magnitude, unit = abs(complex(load.force[k])), _("N")
            if element.turns:
                magnitude, unit = abs(float(load.moment[k])), _("N·m")
            name = load_symbols(load)[0]
            yield write_sentence(law.sentence, name=name, **law.symbols)
            yield ComputedQuantity(name, abs(law.pull), magnitude, unit)


def write_friction(subject: Subject, k: int, *, explained: bool) -> Iterable[Block]:
    """Write the friction force or moment in each pair. They follow from the reactions found with friction."""
    frictions = subject.results.linkage.friction
    if not frictions:
        return
    explanation = (
        _(
            "Friction {T} acts against the relative motion in the pairs. In a hinge with a journal of radius "
            "{r} it is a moment, on a guide a force; both are proportional to the reaction, and {f} is the "
            "coefficient of friction. The subscript contains the name of the pair and the link on which the "
            "friction acts. Reactions and friction are determined together, so that the friction corresponds "
            "to the reactions given below:"
        )
        if explained
        else _("Friction for the reactions given below:")
    )
    yield write_sentence(explanation, T=Symbol("T"), r=Symbol("r"), f=Symbol("f"))
    for pair_friction in frictions:
        yield from _write_pair_friction(subject, pair_friction, k)


def _write_pair_friction(subject: Subject, friction: Friction, k: int) -> Iterable[Block]:
    reaction = subject.reactions.of(friction.pair)
    names = [
        f"T{friction.pair}{link}" for link in (reaction.on, reaction.by)
    ]  # there is no load for friction on the frame
    loads = [x for x in subject.results.loads if x.kind == "friction" and x.name in names]
    if not loads:
        return
    load = loads[0]
    f, r = Leaf(Symbol("f", friction.pair), friction.coefficient), Leaf(Symbol("r", friction.pair), friction.radius)
    normal = Leaf(reaction_symbol(reaction.by, reaction.on), abs(complex(reaction.force[k])))
    slides = reaction.pair.slide is not None
    magnitude = abs(complex(load.force[k])) if slides else abs(float(load.moment[k]))
    if magnitude:
        factors = (f, normal) if slides else (f, r, normal)
        yield ComputedQuantity(load_symbols(load)[0], Product(factors), magnitude, _("N") if slides else _("N·m"))
        if len(loads) > 1:
            yield write_equality(*(load_symbols(opposite)[0] for opposite in reversed(loads)))


def write_balance_without_friction(subject: Subject, k: int) -> Iterable[Block]:
    """Write the balancing moment or force that would be required without friction."""
    if not subject.results.linkage.friction:
        return
    loads = tuple(load for load in subject.results.loads if load.kind != "friction")
    free = solve_reactions(subject.motion, subject.results.structure, loads)
    yield write_sentence(_("Without friction the balancing load would be:"))
    for balance in free.balances:
        turns = balance.moment is not None
        symbol = balance_symbol(balance.driver.link, len(free.balances) > 1, turns=turns)
        magnitude = abs(float(balance.generalized[k]))
        yield state_value(replace(symbol, above="0"), magnitude, _("N·m") if turns else _("N"))


def write_load_table(subject: Subject, k: int, caption: str) -> Iterable[Block]:
    """Write the table of the loads in one position: magnitudes, angles of forces, senses of couples."""
    rows: list[tuple[Line, ...]] = []
    loads = subject.results.loads
    least = NO_FORCE * max((abs(complex(load.force[k])) for load in loads), default=0.0)
    still = NO_FORCE * max((abs(float(load.moment[k])) for load in loads), default=0.0)
    for load in loads:
        (force, couple), push, moment = load_symbols(load), complex(load.force[k]), float(load.moment[k])
        if abs(push) > least:
            magnitude = f"{subject.format_result(abs(push))} {_('N')}"
            rows.append(cells(force, load.link, magnitude, subject.direction(push)))
        if abs(moment) > still:
            magnitude = f"{subject.format_result(abs(moment))} {_('N·m')}"
            rows.append(cells(couple, load.link, magnitude, name_sense(moment)))
    if rows:
        text = _("Table {table} lists everything that acts on the links in this position except the reactions.")
        head = cells(_("force or couple"), _("acts on link"), _("magnitude"), _("angle to the x axis, or sense"))
        yield from write_table(text, Rows(caption, head, tuple(rows), f"loads-{k}"))


def write_losses(subject: Subject) -> Iterable[Block]:
    """Write the work of the driving forces and of friction over the cycle (J), and the efficiency.

    For a self-locking mechanism the ranges in which it locks are written instead.
    """
    lost = subject.results.losses
    if lost is None or lost.locked:
        ranges = describe_locked_ranges(subject.results)
        if ranges:
            yield write_sentence(
                _(
                    "The mechanism is self-locking because of friction {ranges}: no driving force moves it there, so "
                    "the efficiency over the cycle is not defined."
                ),
                ranges="; ".join(ranges),
            )
        return
    work = Leaf(Symbol("A", "d"), lost.drivers)
    taken = [Leaf(Symbol("A", pair), value) for pair, value in lost.pairs.items()]
    yield write_sentence(
        _("The work {work} of the driving forces and the work of friction in the pairs over the cycle:"),
        work=work.symbol,
    )
    for work_leaf in (work, *taken):
        yield state_value(work_leaf.symbol, work_leaf.value, _("J"))
    if lost.efficiency is not None:
        yield write_sentence(_("The efficiency of the mechanism is:"))
        yield ComputedQuantity(Symbol("η"), sum_terms((work, *taken)) / work, lost.efficiency)
