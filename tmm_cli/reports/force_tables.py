"""Tables of forces: reactions, loads, force transmission, balancing, Zhukovsky lever, energy and friction."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from tmm_cli.language import N_, Phrase, _, numeral, printed, symbol
from tmm_cli.mechanics.analysis import Results, detailed_positions
from tmm_cli.mechanics.forces import LeverItem, find_transmitted_forces, load_names
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.numerics import NO_DIFFERENCE, SAME_DRIVER_POSITION, SAME_RATIO
from tmm_cli.mechanics.plans import balance_drawings, drawn_check
from tmm_cli.mechanics.quantities import (
    ANGLE,
    ENERGY,
    FORCE,
    LENGTH,
    LEVER_COUPLE,
    LEVER_FORCE,
    LEVER_MOMENT,
    LOAD,
    MOMENT,
    NUMBER,
    REACTION,
    TRANSMITTED,
    NamedValues,
    coordinate_dimension,
    quantity_columns,
)
from tmm_cli.reports.cycle_tables import driver_columns, long_table, sign_convention
from tmm_cli.reports.structure_tables import indeterminate_reactions
from tmm_cli.reports.table import Column, Table


def reaction_name(by: str, on: str) -> str:
    """Return the symbol of a reaction, e.g. R_12 for the force of link 1 on link 2."""
    by, on = printed(by), printed(on)
    return f"R_{by}{on}" if len(by) == len(on) == 1 else f"R_{by},{on}"


def forces_tables(results: Results) -> Iterable[Table]:
    """Yield the tables of reactions, pins of compound hinges, loads, force transmission and balancing loads."""
    reactions = results.reactions
    assert reactions is not None
    words = {
        N_("pair"): [r.pair.name for r in reactions.all],
        N_("name"): [reaction_name(r.by, r.on) for r in reactions.all],
    }
    note = _(
        "R_ik is the force of link i on link k. In a prismatic pair, the point of action is given by its "
        "distance along the guide from the point that slides."
    )
    note = " ".join([note, *indeterminate_reactions(results.structure)])
    values = [quantity_columns(REACTION, reaction) for reaction in reactions.directed]
    yield long_table(results, "reactions", _("Reactions"), words, values, note)
    pins = reactions.pins(results.linkage)
    if pins:
        words = {
            N_("pin"): [pin.point for pin in pins],
            N_("link"): [pin.link for pin in pins],
            N_("pairs"): [", ".join(pin.pairs) for pin in pins],
        }
        title = _("Compound hinges: force of the pin on each link")
        note = _(
            "The link in whose row all pairs are listed carries the full force of the pin, because the other "
            "links are attached to it. The forces on all links add up to zero."
        )
        yield long_table(results, "pins", title, words, [quantity_columns(LOAD[:1], pin) for pin in pins], note)
    loads = reactions.applied
    if loads:
        words = {N_("link"): [x.link for x in loads], N_("name"): [load_names(x)[0] for x in loads]}
        title = _("Loads: weights {G}, inertia forces {U}, inertia couples {M}, and loads of the file").format(
            G=symbol("G"), U=symbol("U"), M=symbol("M")
        )
        yield long_table(results, "loads", title, words, [quantity_columns(LOAD, load) for load in loads])
    yield from _transmission_table(results)
    yield _balance_table(results)


def _transmission_table(results: Results) -> Iterable[Table]:
    """Yield the table of force transmission: pressure angle, driving force and its useful component.

    It has a row for each driven link and position. Only links that are driven through a single pair are included.
    """
    assert results.motion is not None and results.reactions is not None
    transmitted = find_transmitted_forces(results.motion, results.reactions)
    if transmitted and results.reactions.loaded:
        angles = {(p.group, p.link): p.angles for p in results.pressure}
        words = {
            N_("driven link"): [f.link for f in transmitted],
            N_("driven through pair"): [f.pair for f in transmitted],
        }
        things = [
            [(N_("pressure angle"), angles.get((f.group, f.link)), ANGLE), *quantity_columns(TRANSMITTED, f)]
            for f in transmitted
        ]
        note = _(
            "P is the reaction in the pair through which the link is driven; Q is its component along the "
            "velocity of its point of application. Without weights, inertia and friction Q = P cos(pressure "
            "angle)."
        )
        yield long_table(results, "transmission", _("Force transmission"), words, things, note)


def _balance_table(results: Results) -> Table:
    """Return the table of the balancing moment or force of each driver, with the reaction of the frame on its link."""
    reactions = results.reactions
    assert reactions is not None
    columns = driver_columns(results)
    several = len(reactions.balances) > 1
    for balance in reactions.balances:
        link = balance.driver.link
        if balance.moment is not None:
            name = _("M_b of link {link}").format(link=link) if several else _("M_b")
            columns.append(Column(name, balance.moment, MOMENT))
        if balance.moment is None or balance.driver.base == FRAME:
            name = _("F_b of link {link}").format(link=link) if several else _("F_b")
            columns.append(Column(name, balance.force, FORCE))
        for frame in (f for f in reactions.frames if f.on == link):
            name = reaction_name(frame.by, frame.on)
            columns.append(Column(Phrase("{name} x", name=name), frame.force.real, FORCE))
            columns.append(Column(Phrase("{name} y", name=name), frame.force.imag, FORCE))
    return Table("balance", _("Input link"), tuple(columns), notes=(sign_convention(results.linkage),))


# The Zhukovsky lever: every force and couple with its arm and moment, a row for each at every position.


def lever_tables(results: Results) -> Iterable[Table]:
    """Yield the table of the Zhukovsky lever: arm and moment of every force and couple at every position.

    The lever is drawn for a crank speed of 1 rad/s, so that the arm of a force is a length. The arm of a couple is the
    angular speed of its link divided by that of the crank.
    """
    lever = results.lever
    assert lever is not None
    if not lever.items:
        return
    slider = results.linkage.driver.kind == "slide"
    assert results.reactions is not None
    course_names: dict[str, str] = {}  # letters of the course
    for load in results.reactions.applied:
        force, couple = load_names(load)
        course_names |= {load.couple_name: couple, load.name: force}
    words = {N_("name"): [course_names[i.name] for i in lever.items], N_("link"): [i.link for i in lever.items]}
    note = _(
        "Arms are measured on the Zhukovsky lever, drawn for a crank rotating counterclockwise at 1 rad/s, "
        "to the scale 1 m for 1 m/s. Counterclockwise moments are positive."
    )
    items = [_lever_columns(item, slider) for item in lever.items]
    yield long_table(results, "lever", _("Zhukovsky lever"), words, items, note)


def _lever_columns(item: LeverItem, slider: bool) -> list[NamedValues]:
    force, couple = (item, None) if item.end is not None else (None, item)
    return [
        *quantity_columns(LEVER_FORCE, force, slider),
        *quantity_columns(LEVER_COUPLE, couple, slider),
        *LEVER_MOMENT.columns(item, slider),
    ]


# What balances the driver as a student draws it: the force plan beside the Zhukovsky lever, in positions in detail.


def drawn_tables(results: Results) -> Iterable[Table]:
    """Yield the table of the balancing load as measured on the drawn force plan and on the drawn Zhukovsky lever.

    It has a row for each detailed position, with the difference between both methods in per cent.
    """
    motion, reactions, lever = results.motion, results.reactions, results.lever
    assert motion is not None and reactions is not None and lever is not None
    positions = [(k, balance_drawings(motion, reactions, lever, k)) for k in detailed_positions(results) if lever.items]
    checked = [
        (k, drawn_check(motion, reactions, drawn, drawn.scales())) for k, drawn in positions if drawn is not None
    ]
    if not checked:
        return
    moment = reactions.balance.kind == "moment"
    name, dimension = (N_("M_b"), MOMENT) if moment else (N_("F_b"), FORCE)
    chosen = [k for k, __ in checked]
    head = [replace(column, values=[column.values[k] for k in chosen]) for column in driver_columns(results)]
    exact = [100 * float(lever.difference[k]) for k in chosen]
    columns = [
        Column(Phrase("{name} by the force plan", name=name), [abs(c.plan) for __, c in checked], dimension, 4),
        Column(Phrase("{name} by the Zhukovsky lever", name=name), [abs(c.lever) for __, c in checked], dimension, 4),
        Column(N_("difference, %"), [100 * c.difference for __, c in checked], NUMBER, 2),
        Column(N_("exact difference, %"), [0.0 if x < 100 * NO_DIFFERENCE else x for x in exact], NUMBER, 2),
    ]
    note = _(
        "Arms and segments are measured to 0.5 mm on drawings on A4, so `difference` is due to drawing "
        "errors. The limit `checks: lever` applies to the exact difference, which is between the values "
        "computed by both methods."
    )
    yield Table(
        "lever-drawn",
        _("Balancing load measured on the drawings of the force plan and the Zhukovsky lever"),
        (*head, *columns),
        notes=(note,),
    )


# Power balance, reduced inertia and reduced moment at every position; friction over the cycle.


def energy_tables(results: Results) -> Iterable[Table]:
    """Yield the table of the power balance, the reduced inertia and the reduced moment.

    If friction is computed, the table of the friction work follows.
    """
    energy = results.energy
    assert energy is not None
    quantities = [
        quantity
        for quantity in ENERGY
        if quantity.there(energy) and (quantity.name != "friction" or results.friction is not None)
    ]
    columns_of = quantity_columns(quantities, energy, results.linkage.driver.kind == "slide")
    table = [
        *driver_columns(results),
        *(Column(header, values, dimension) for header, values, dimension in columns_of),
        Column(N_("imbalance, %"), 100 * np.abs(energy.balance), NUMBER, digits=2),
    ]
    note = _(
        "A power that accelerates the mechanism is positive. Quantities are reduced to the driver "
        "coordinate, which increases counterclockwise or along the guide, whatever the direction of motion."
    )
    yield Table("energy", _("Power balance and reduction of the mechanism to its driver"), tuple(table), notes=(note,))
    if results.friction is not None:
        yield _friction_table(results)


def _friction_table(results: Results) -> Table:
    locking, losses = results.friction, results.losses
    assert locking is not None
    friction = results.linkage.friction
    notes = [
        _(
            "the efficiency over the cycle is undefined: friction locks the mechanism in a part of the cycle, "
            "or the driver does no work"
        )
    ]
    if losses is not None and losses.efficiency is not None:
        notes = [_("efficiency over the cycle: {share} %").format(share=numeral(100 * losses.efficiency, ".4g"))]
    notes += [_("self-locking: {range}").format(range=text) for text in describe_locked_ranges(results)]
    return Table(
        "friction",
        _("Friction"),
        (
            Column(N_("pair"), [f.pair for f in friction]),
            Column(N_("mu"), [f.coefficient for f in friction], NUMBER),
            Column(N_("journal radius"), [f.radius if f.radius else float("nan") for f in friction], LENGTH),
            Column(
                N_("work per cycle, J"), [losses.pairs[f.pair] if losses else float("nan") for f in friction], NUMBER
            ),
        ),
        notes=tuple(notes),
    )


def describe_locked_ranges(results: Results) -> list[str]:
    """Return a text for each range of the driver coordinate in which friction locks the mechanism.

    Each text names the positions within the range and the pair that mainly causes the locking.
    """
    units, measure = results.problem.units, coordinate_dimension(results.linkage.driver.kind)
    cycle, texts = 2 * np.pi * results.turns, []
    for locked in results.losses.ranges if results.losses is not None else ():
        ends = np.array([locked.start, locked.end])
        requested = results.asked[list(results.numbers)]
        if cycle:
            whole = ends[1] - ends[0] > cycle * (1 - SAME_RATIO)
            requested = (
                locked.start + np.mod(requested - locked.start + SAME_DRIVER_POSITION, cycle) - SAME_DRIVER_POSITION
            )
            ends = ends - ends[0] if whole else np.mod(ends, cycle)
        inside = (requested > locked.start - SAME_DRIVER_POSITION) & (requested < locked.end + SAME_DRIVER_POSITION)
        numbers = [str(number) for number, is_inside in zip(results.numbers, inside, strict=True) if is_inside]
        start, end = (numeral(float(units.from_si(q, measure)), ".5g") for q in ends)
        pair = results.structure.pair(locked.pair)
        if not numbers:
            text = _(
                "from {start} to {end} {unit}, between the computed positions, mainly in pair {pair} of links {i} "
                "and {j}"
            )
        elif len(numbers) == 1:
            text = _("from {start} to {end} {unit} (position {numbers}), mainly in pair {pair} of links {i} and {j}")
        else:
            text = _("from {start} to {end} {unit} (positions {numbers}), mainly in pair {pair} of links {i} and {j}")
        texts.append(
            text.format(
                start=start,
                end=end,
                unit=units.spelt(measure),
                numbers=", ".join(numbers),
                pair=locked.pair,
                i=pair.i,
                j=pair.j,
            )
        )
    return texts
