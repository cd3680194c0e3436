"""Chapter on forces: loads, groups from the last to the first, input links, Zhukovsky lever, tables of results."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

import numpy as np

from tmm_cli.language import _, filled
from tmm_cli.mechanics.forces import CourseSymbol, Symbol, balance_symbol, find_transmitted_forces, reaction_symbol
from tmm_cli.mechanics.numerics import NO_DIFFERENCE, NO_FORCE, Real, Vector, largest_magnitude, without_rounding
from tmm_cli.note.blocks import (
    Block,
    Heading,
    Line,
    Ref,
    Rows,
    cells,
    paragraph,
    refer_to_blocks,
    write_sentence,
    write_table,
)
from tmm_cli.note.forces import lever, loads, sections
from tmm_cli.note.forces.equations import MU
from tmm_cli.note.forces.sections import list_bodies
from tmm_cli.note.formula_tree import Letter, row
from tmm_cli.note.subject import NONE, Subject, table_over_positions
from tmm_cli.reports import has_flywheel, indeterminate_reactions


def write_forces(subject: Subject) -> Iterable[Block]:
    """Write the chapter on forces. It is empty if no load acts on the links."""
    if not subject.has_loads:
        return
    yield Heading(_("Force analysis"))
    yield write_sentence(
        _(
            "The reactions in the kinematic pairs and the balancing moment or force on the input link are "
            "found by kinetostatics: if the inertia forces are added to the acting forces (d'Alembert's "
            "principle), every group of links is in equilibrium. The groups are considered in the reverse "
            "order of the kinematic analysis, the input link last. The subscript of a reaction {R} contains "
            "the numbers of two links: the first acts on the second. The figures show all forces in their "
            "actual directions, so that their magnitudes are positive; the moment arms {h} are measured in the "
            "figures."
        ),
        R=Symbol("R"),
        h=Symbol("h"),
    )
    yield from map(paragraph, indeterminate_reactions(subject.results.structure))
    for k in subject.detail:
        yield from _write_position(subject, k)
    yield Heading(_("Forces in all positions"), 2)
    yield from write_reactions(subject)
    yield from write_balancing_loads(subject)
    yield from write_transmission(subject)
    yield from loads.write_losses(subject)


def _write_position(subject: Subject, k: int) -> Iterable[Block]:
    """Write the sections on one detailed position. If there are several, the headings name the position."""
    several = len(subject.detail) > 1

    def heading(text: str) -> str:
        if not several:
            return text
        return _("{section}, position {number}").format(section=text, number=subject.position_number(k))

    by_steps = subject.results.problem.note_style.sections == "MATI"
    yield from (_write_by_guidelines if by_steps else _write_by_groups)(subject, k, heading)
    yield from loads.write_balance_without_friction(subject, k)
    yield from lever.write_lever(
        subject, k, heading(_("Check by the Zhukovsky lever")), explained=k == subject.detail[0]
    )


def _write_by_groups(subject: Subject, k: int, heading: Callable[[str], str]) -> Iterable[Block]:
    """Write the force analysis of a position: all loads, then a section for each group and each input link."""
    first = k == subject.detail[0]
    yield Heading(heading(_("Loads on the links")), 2)
    if first:
        yield from loads.write_weights(subject)
    yield from loads.write_inertia(subject, k, explained=first)
    yield from _write_other_loads(subject, k)
    yield from _write_group_sections(subject, k, heading, 2)


def _write_by_guidelines(subject: Subject, k: int, heading: Callable[[str], str]) -> Iterable[Block]:
    """Write the force analysis of a position in the order of steps 2.3.1 to 2.3.4 of the MATI guidelines.

    The steps are: plan of the mechanism, weights and useful resistance, inertia forces, reactions group by group.
    """
    first, caption = k == subject.detail[0], subject.describe_position(k)
    yield Heading(heading(_("Plan of the mechanism")), 2)
    stem = subject.position(k).stem("position")
    yield write_sentence(
        _("The plan of the mechanism is drawn for {position}; its scale factor is {mu} = {value} m/mm."),
        position=caption,
        mu=MU,
        value=subject.text(subject.scale("position", k, stem)),
    )
    yield Heading(heading(_("Weights and useful resistance")), 2)
    yield write_sentence(_("These forces are drawn on the links as arrows of equal length, not to scale."))
    if first:
        yield from loads.write_weights(subject)
    yield from subject.figures(
        "position",
        _("All forces that act on the links are shown in figure {figure}."),
        _("Mechanism under load, {position}").format(position=caption),
        k,
    )
    yield Heading(heading(_("Acceleration plan and inertia forces")), 2)
    plans = list(subject.drawings("acceleration", k))
    if plans:
        yield write_sentence(_("For the acceleration plan see figure {figure}."), figure=Ref(plans[0]))
    yield from loads.write_inertia(subject, k, explained=first)
    yield from _write_other_loads(subject, k)
    yield Heading(heading(_("Reactions in the kinematic pairs")), 2)
    yield from _write_group_sections(subject, k, heading, 3)


def _write_other_loads(subject: Subject, k: int) -> Iterable[Block]:
    yield from loads.write_elements(subject, k)
    yield from loads.write_friction(subject, k, explained=k == subject.detail[0])
    yield from loads.write_load_table(subject, k, _("Loads, {position}").format(position=subject.describe_position(k)))


def _write_group_sections(subject: Subject, k: int, heading: Callable[[str], str], level: int) -> Iterable[Block]:
    """Write the sections on the groups, from the last to the first, and on the input links."""
    for number, body in enumerate(list_bodies(subject, k)):
        if body.forces is not None:
            text = _("Group of links {links}") if len(body.links) > 1 else _("Group of one link: {links}")
        else:
            text = _("Input link {links}")
        text = heading(text.format(links=", ".join(body.links)))
        yield from sections.write_section(body, Heading(text, level), first=k == subject.detail[0] and not number)


# Tables of all positions: reactions, transmitted forces, balancing loads by both methods.


PAIRS = 4  # reactions in one table


def write_reactions(subject: Subject) -> Iterable[Block]:
    """Write the tables of the reactions (N) with their angles, and of the pin forces in compound hinges."""
    reactions = subject.reactions
    pairs = [(r.pair.name, reaction_symbol(r.by, r.on), r.force, r.angle) for r in reactions.directed]
    tables = list(_force_tables(subject, _("Reactions in the pairs {names}"), pairs, "reactions"))
    yield refer_to_blocks(
        _("Table {first} gives the reactions in all positions and their angles to the x axis."),
        _("Tables {first} and {last} give the reactions in all positions and their angles to the x axis."),
        _("Tables {first} to {last} give the reactions in all positions and their angles to the x axis."),
        [table.key for table in tables],
    )
    yield from tables
    pins = [
        (pin.point, Symbol("R", f"{pin.point},{pin.link}"), pin.force, None)
        for pin in reactions.pins(subject.results.linkage)
    ]
    if pins:
        tables = list(_force_tables(subject, _("Forces of the pins {names} on their links"), pins, "pins"))
        yield refer_to_blocks(
            _(
                "In a compound hinge more than two links meet; table {first} gives the force of its pin on each of "
                "them."
            ),
            _(
                "In a compound hinge more than two links meet; tables {first} and {last} give the force of its pin on "
                "each of them."
            ),
            _(
                "In a compound hinge more than two links meet; tables {first} to {last} give the force of its pin on "
                "each of them."
            ),
            [table.key for table in tables],
        )
        yield from tables


def write_transmission(subject: Subject) -> Iterable[Block]:
    """Write the driving force on each driven link, and its useful component, in the detailed positions."""
    transmitted = find_transmitted_forces(subject.motion, subject.reactions)
    if not transmitted or not subject.reactions.loaded:
        return
    moving = [
        (force, k)
        for force in transmitted
        for k in subject.detail
        if force.driving[k] > NO_FORCE * np.nanmax(force.driving) and np.isfinite(force.useful[k])
    ]
    rows = [
        cells(
            force.link,
            force.pair,
            subject.position_number(k),
            subject.format_result(float(force.driving[k])),
            subject.angle(float(np.arccos(min(1.0, float(force.useful[k] / force.driving[k]))))),
            subject.format_result(float(force.useful[k])),
        )
        for force, k in moving
    ]
    if not rows:
        return
    P, Q, angle = Symbol("P"), Symbol("Q"), Symbol("λ")
    head = cells(
        _("driven link"),
        _("driven through pair"),
        _("position"),
        (P, ", ", _("N")),
        (angle, ", °"),
        (Q, ", ", _("N")),
    )
    yield from write_table(
        _(
            "Only the component of the driving force {P} along the velocity of its point of action moves the "
            "driven link: {Q} = {P} cos {angle}, where {angle} is the angle between force and velocity with "
            "all loads acting. Table {table} gives the values."
        ),
        Rows(_("Transmission of force"), head, tuple(rows), "transmission"),
        P=P,
        Q=Q,
        angle=angle,
    )


def _force_tables(
    subject: Subject, caption: str, forces: Sequence[tuple[str, Symbol, Vector, Real | None]], key: str
) -> Iterable[Rows]:
    """Yield tables of forces (N) and their angles in all positions, with at most PAIRS forces in each table.

    Args:
        subject: results that the note describes.
        caption: caption with the field {names}.
        forces: for each force: name of its pair, symbol, force (N) and angle (rad), the latter two of shape
            (positions,). An
            angle of None is computed from the force. This gives no meaningful angle where the force is zero.
        key: beginning of the keys of the tables.
    """
    for first in range(0, len(forces), PAIRS):
        group = forces[first : first + PAIRS]
        columns: list[tuple[Line, list[str]]] = []
        for __, symbol, force, angle in group:
            direction, magnitude = np.angle(force) if angle is None else angle, np.abs(force)
            magnitude = np.where(np.isnan(direction) & np.isfinite(magnitude), 0.0, magnitude)
            columns.append(((symbol, ", ", _("N")), _format_column(subject, magnitude, Subject.format_result)))
            columns.append(((_("angle, °"),), _format_column(subject, direction, Subject.angle)))
        names = ", ".join(dict.fromkeys(name for name, *__ in group))
        yield table_over_positions(subject, caption.format(names=names), columns, f"{key}-{first // PAIRS}")


def write_balancing_loads(subject: Subject) -> Iterable[Block]:
    """Write the table of the balancing moments or forces, found by the force plan and by the Zhukovsky lever."""
    results, balances, lever = subject.results, subject.reactions.balances, subject.lever
    several = len(balances) > 1
    symbols = [balance_symbol(b.driver.link, several, turns=b.moment is not None) for b in balances]
    units = [_("N·m") if b.moment is not None else _("N") for b in balances]
    heading = _("{symbol}, {unit}, by the force plan")
    head = [filled(heading, symbol=s, unit=u) for s, u in zip(symbols, units, strict=True)]
    total_symbol = balance_symbol(balances[0].driver.link, several=False, turns=balances[0].moment is not None)
    head.append(filled(_("{symbol}, {unit}, by the Zhukovsky lever"), symbol=total_symbol, unit=units[0]))
    columns = [*(b.generalized for b in balances), lever.balancing]
    if several:
        yield write_sentence(
            _("The Zhukovsky lever gives the combined effect of all drivers, reduced to the input link {link}."),
            link=balances[0].driver.link,
        )
    else:
        percent = 100 * lever.difference
        head.append((_("difference, %"),))
        columns.append(np.where(percent > NO_DIFFERENCE, percent, 0.0))
    caption = (
        _("Balancing moments and forces on the input links")
        if several
        else _("Balancing moment or force on the input link")
    )
    text = _("{balance} is positive counterclockwise, whatever the sense of rotation of the input link.")
    if results.linkage.driver.kind == "slide":
        text = _(
            "{balance} is positive in the positive direction of the guide of the input link, whatever the "
            "direction of motion of this link."
        )
    yield write_sentence(text, balance=total_symbol)
    texts = [_format_column(subject, column, Subject.format_result) for column in columns]
    rows = table_over_positions(subject, caption, list(zip(head, texts, strict=True)), "balance")
    yield from write_table(_("The values found by both methods are given in table {table}."), rows)
    if has_flywheel(results) and balances[0].moment is not None:
        yield write_sentence(
            _(
                "The flywheel is not counted as a link: {balance} balances only the links, and the driving moment "
                "is {whole}."
            ),
            balance=total_symbol,
            whole=row(
                Letter(CourseSymbol("M_d")),
                "=",
                Letter(total_symbol),
                "+",
                Letter(CourseSymbol("J_f")),
                "·",
                Letter(Symbol("ε")),
            ),
        )


def _format_column(subject: Subject, column: Real, write: Callable[[Subject, float], str]) -> list[str]:
    """Return the values in all positions as texts, with a dash where the mechanism cannot move."""
    values = without_rounding(column, largest_magnitude(column))
    defined = np.isfinite(values) & subject.motion.moving
    return [
        write(subject, float(value)) if is_defined else NONE for value, is_defined in zip(values, defined, strict=True)
    ]
