"""Section on the Zhukovsky lever: couples, moments about the pole, difference from the force plan."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tmm_cli.drawing.paper import file_safe_name
from tmm_cli.language import _
from tmm_cli.mechanics.forces import AppliedLoad, Symbol, balance_symbol, load_symbols
from tmm_cli.mechanics.numerics import NO_DIFFERENCE
from tmm_cli.mechanics.plans import DrawingScales, LeverPlan, balance_drawings, drawn_check, lever_plan
from tmm_cli.note.blocks import Block, Equation, Heading, write_sentence
from tmm_cli.note.expression import ComputedQuantity, Expression, Function, Leaf, Product, sum_terms
from tmm_cli.note.forces.equations import moment_equation, solve_moment_equation
from tmm_cli.note.subject import Subject


def write_lever(subject: Subject, k: int, heading: str, *, explained: bool) -> Iterable[Block]:
    """Write the section on the Zhukovsky lever in position k.

    explained: True if the section begins with an explanation of the method.
    """
    plan = lever_plan(subject.motion, subject.reactions, subject.lever, k)
    if not plan.equation.terms:
        return
    yield Heading(heading, 2)
    unit = _("N·m") if driver_rotates(subject) else _("N")
    if explained:
        yield _explain_lever(turns=driver_rotates(subject))
    yield from _write_couples(subject, plan, k)
    yield from subject.figures(
        "lever",
        _("The Zhukovsky lever is shown in figure {figure}."),
        _("Zhukovsky lever, {position}").format(position=subject.describe_position(k)),
        k,
    )
    yield write_sentence(_("The equation of moments about the pole {p}:"), p=Symbol("p"))
    quantity = solve_moment_equation(plan.equation, unit)
    if quantity is None:
        yield write_sentence(_("No force has a moment about the pole, so there is nothing to balance."))
    elif plan.equation.sought is None:
        yield quantity
        yield from _write_reduced_balance(subject, k, unit)
    else:
        yield from (Equation(moment_equation(plan.equation)), quantity)
        yield from _write_difference(subject, k)
        yield from _write_drawn_check(subject, k)


def _explain_lever(*, turns: bool) -> Block:
    """Explain the Zhukovsky lever for a rotating or a sliding driver."""
    turning = _(
        "The balancing moment is checked by the Zhukovsky lever: the velocity plan, drawn for an angular "
        "velocity of the input link of 1 rad/s and rotated by 90° clockwise, is treated as a rigid lever "
        "that can rotate about its pole {p}. Each force acts on it at the end of the velocity vector of "
        "its point of action, and the lever is in equilibrium."
    )
    sliding = _(
        "The balancing force is checked by the Zhukovsky lever: the velocity plan, drawn for a velocity of "
        "the input link of 1 m/s and rotated by 90° clockwise, is treated as a rigid lever that can rotate "
        "about its pole {p}. Each force acts on it at the end of the velocity vector of its point of "
        "action, and the lever is in equilibrium."
    )
    return write_sentence(turning if turns else sliding, p=Symbol("p"))


def _write_couples(subject: Subject, plan: LeverPlan, k: int) -> Iterable[Block]:
    """Write how couples act on the Zhukovsky lever.

    A couple is replaced by a pair of forces, or multiplied by the velocity ratio of its link to the driver.
    """
    if plan.pairs:
        yield write_sentence(
            _(
                "A couple on a link is replaced by two opposite forces {P} and {Pp} perpendicular to the line "
                "through two points of the link, at the distance {l} from each other:"
            ),
            P=Symbol("P"),
            Pp=Symbol("P").primed,
            l=Symbol("l"),
        )
    for pair in plan.pairs:
        couple, apart = Leaf(pair.couple, abs(pair.moment)), Leaf(Symbol("l", "".join(pair.points)), pair.distance)
        yield ComputedQuantity(pair.symbol, couple / apart, pair.force, _("N"))
    if plan.couples:
        yield write_sentence(
            _(
                "The other couples act on the lever as {M}, that is, multiplied by the ratio of the angular "
                "velocity of their link to the velocity of the input link:"
            ),
            M=Symbol("M").primed,
        )
    for load, turned in plan.couples:
        product = Product((Leaf(load_symbols(load)[1], abs(float(load.moment[k]))), *_velocity_ratio(subject, load, k)))
        yield ComputedQuantity(turned.symbol, product, turned.size, _("N·m") if driver_rotates(subject) else _("N"))


def driver_rotates(subject: Subject) -> bool:
    """Return True if the first driver rotates."""
    return subject.results.linkage.driver.kind == "turn"


def _velocity_ratio(subject: Subject, load: AppliedLoad, k: int) -> tuple[Expression, ...]:
    """Return the velocity ratio of a loaded link to the driver, as a tuple of factors.

    The tuple is empty for a couple on the rotating driver itself. The ratio is a quotient of velocities; if the driver
    is at rest in position k, it is a number.
    """
    motion, driver = subject.motion, subject.results.linkage.driver
    rate = abs(subject.rate(k))
    if load.link == driver.link and driver_rotates(subject):
        return ()
    if not rate:
        return (Leaf(Symbol("i", load.link), abs(float(motion.link(load.link).first[k]))),)
    omega = Leaf(Symbol("ω", load.link), abs(float(motion.link(load.link).omega[k])))
    return (omega / Leaf(Symbol("ω" if driver_rotates(subject) else "v", driver.link), rate),)


def _write_reduced_balance(subject: Subject, k: int, unit: str) -> Iterable[Block]:
    """Write the sum of the balancing loads of several drivers, reduced to the first driver.

    Each is multiplied by the velocity ratio of its driver to the first one.
    """
    motion, reactions, lever = subject.motion, subject.reactions, subject.lever
    first, terms = reactions.balance, list[Expression]()
    for balance in reactions.balances:
        driver = balance.driver.link
        symbol = balance_symbol(driver, several=True, turns=balance.moment is not None)
        balance_leaf = Leaf(symbol, float(balance.generalized[k]))
        ratio = Leaf(Symbol("i", driver), float(np.broadcast_to(motion.drives[driver].first, motion.q.shape)[k]))
        terms.append(balance_leaf if balance is first else balance_leaf * ratio)
    name = balance_symbol(first.driver.link, several=False, turns=first.moment is not None)
    yield write_sentence(
        _(
            "The balancing loads of all drivers enter the equation with their values from the force plan, and "
            "the lever is in equilibrium. Reduced to link {link}, that is, multiplied by the ratio {i} of the "
            "velocity of the driver to the velocity of this link, they add up to"
        ),
        link=first.driver.link,
        i=Symbol("i"),
    )
    yield ComputedQuantity(name, sum_terms(terms), float(lever.balancing[k]), unit)


def _write_difference(subject: Subject, k: int) -> Iterable[Block]:
    """Write the difference between the balancing loads found by the lever and by the force plan.

    It is given in per cent of the largest balancing load in all positions.
    """
    balance, lever = subject.reactions.balance, subject.lever
    moment = balance.kind == "moment"
    name = balance_symbol(balance.driver.link, several=False, turns=moment)
    arm = 1.0 if moment or balance.moment is None else balance.arm  # of a balancing force at the end of a crank
    sense = -1 if lever.balancing[k] < 0 else 1  # the equation gives a magnitude, in the drawn sense
    by_plan, by_lever = sense * float(balance.generalized[k]) / arm, sense * float(lever.balancing[k]) / arm
    largest = float(np.nanmax(np.abs(np.where(subject.motion.moving, balance.generalized, 0.0)))) / arm
    if not largest:
        return
    yield write_sentence(
        _(
            "The difference {delta} from the value {plan} found by the force plan, in per cent of {largest}, "
            "the largest magnitude in all positions:"
        ),
        delta=Symbol("Δ"),
        plan=Symbol(name.letter, name.below, "R"),
        largest=Symbol(name.letter, "max"),
    )
    gap = Function("abs", Leaf(Symbol(name.letter, name.below, "R"), by_plan) - Leaf(name, by_lever))
    whole = gap / Leaf(Symbol(name.letter, "max"), largest) * 100.0
    percent = 100 * float(lever.difference[k])
    yield ComputedQuantity(Symbol("Δ"), whole, percent if percent > NO_DIFFERENCE else 0.0, "%")


def _write_drawn_check(subject: Subject, k: int) -> Iterable[Block]:
    """Write the balancing loads by force plan and by lever with arms and segments as measured on the drawings."""
    drawn = balance_drawings(subject.motion, subject.reactions, subject.lever, k)
    if drawn is None:
        return
    position, link = subject.position(k), f"link-{drawn.link.links[0]}"
    names = ("group-loads", "forces", "lever")
    stems = [
        file_safe_name(position.stem(name) if name == "lever" else f"{position.stem(name)}-{link}") for name in names
    ]
    scales = drawn.scales()
    if subject.drawn:
        scales = DrawingScales(*(subject.scale(name, k, stem) for name, stem in zip(names, stems, strict=True)))
    check = drawn_check(subject.motion, subject.reactions, drawn, scales)
    moment = subject.reactions.balance.kind == "moment"
    yield write_sentence(
        _(
            "If moment arms and segments are measured on the drawings to 0.5 mm, the force plan gives {plan} "
            "{unit} and the lever {lever} {unit}. This difference, {share} % of the largest magnitude, is due "
            "to the accuracy of drawing; the difference above comes from the calculation."
        ),
        plan=subject.format_result(abs(check.plan)),
        lever=subject.format_result(abs(check.lever)),
        unit=_("N·m") if moment else _("N"),
        share=subject.text(100 * check.difference, 2),
    )
