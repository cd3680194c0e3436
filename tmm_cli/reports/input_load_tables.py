"""Tables of the masses and loads of a problem file."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Final

import numpy as np

from tmm_cli.language import N_, _
from tmm_cli.mechanics.linkage import FRAME, Linkage, Load, LoadTable
from tmm_cli.mechanics.quantities import (
    ANGLE,
    FORCE,
    INERTIA,
    MASS,
    MOMENT,
    NUMBER,
    Dimension,
)
from tmm_cli.problem import Problem, stroke_dimension
from tmm_cli.reports.table import Table, format_value, format_vector, text_table

if TYPE_CHECKING:
    pass

FILE_WORDS: Final = {  # that a file may say, where they are shown
    "always": N_("always"),
    "working stroke": N_("working stroke"),
    "stroke": N_("stroke"),
    "share of stroke": N_("fraction of the stroke"),
    "crank angle": N_("crank angle"),
    "crank turn": N_("crank rotation"),
}


def links_with_inertia(linkage: Linkage) -> list[str]:
    """Return the moving links that have a mass or a moment of inertia."""
    links = linkage.links
    return [n for n in linkage.moving if np.any(links[n].mass != 0) or np.any(links[n].inertia != 0)]


def mass_table(problem: Problem) -> Table:
    """Return the table of masses, moments of inertia and centres of mass."""
    links = [problem.linkage.links[name] for name in links_with_inertia(problem.linkage)]
    return text_table(
        "masses",
        _("Masses"),
        (
            _("link"),
            _("mass"),
            _("moment of inertia about the centre of mass S"),
            _("centre of mass S in the coordinate axes of the link"),
        ),
        [
            (
                x.name,
                format_value(problem, x.mass, MASS),
                format_value(problem, x.inertia, INERTIA),
                format_vector(problem, x.centre),
            )
            for x in links
        ],
    )


def load_tables(problem: Problem) -> Iterable[Table]:
    """Yield the table of loads, then one table for each load that is given by a table in the file."""
    yield text_table(
        "loads",
        _("Loads"),
        (
            _("name"),
            _("link"),
            _("point of application (in the coordinate axes of the link)"),
            _("magnitude"),
            _("when the load acts"),
        ),
        [_load_row(problem, load) for load in problem.linkage.loads],
    )
    for load in problem.linkage.loads:
        if load.table is not None:
            yield _load_table(problem, load, load.table)


def _load_row(problem: Problem, load: Load) -> tuple[str, ...]:
    dimension, value = (FORCE, load.force) if load.force else (MOMENT, load.moment)
    if load.table is not None:
        magnitude = _("table with {rows} rows, argument: {against}").format(
            rows=len(load.table.values), against=_argument_name(load.table)
        )
    elif load.resists:
        magnitude = _("{size}, opposite to the motion").format(size=format_value(problem, abs(value), dimension))
    elif load.force:
        magnitude = f"{format_vector(problem, load.force, FORCE)} {problem.units.spelt(FORCE)}"
    else:
        magnitude = format_value(problem, load.moment, MOMENT)
    place = format_vector(problem, load.at) if load.force else ""
    link = (
        load.link
        if load.base == FRAME
        else _("{link} (relative to link {base})").format(link=load.link, base=load.base)
    )
    when = _(FILE_WORDS[load.when])
    if load.stroke_link:
        when = _("working stroke of link {link}").format(link=load.stroke_link)
    if load.window is not None:
        first, last = (format_value(problem, angle, ANGLE) for angle in load.window)
        when = _("crank angle from {first} to {last}").format(first=first, last=last)
    return load.name, link, place, magnitude, when


def argument_dimension(linkage: Linkage, table: LoadTable) -> Dimension:
    """Return the dimension of the argument (first column) of a load table."""
    if table.shares:
        return NUMBER
    return stroke_dimension(linkage, table.stroke_link) if table.against == "stroke" else ANGLE


def _argument_name(table: LoadTable) -> str:
    """Return the heading of the first column of a load table.

    If the argument is the stroke of a link other than the main output, the heading names this link.
    """
    words = _(FILE_WORDS[table.first_column])
    return words if not table.stroke_link else _("{stroke} of link {link}").format(stroke=words, link=table.stroke_link)


def _load_table(problem: Problem, load: Load, table: LoadTable) -> Table:
    """Return the table of a load that the file gives row by row. For a force, a note states its direction."""
    linkage, measure = problem.linkage, argument_dimension(problem.linkage, table)
    rows = [
        (format_value(problem, at, measure), format_value(problem, magnitude, FORCE if load.force else MOMENT))
        for at, magnitude in zip(table.arguments, table.values, strict=True)
    ]
    direction = format_value(problem, np.angle(load.force), ANGLE)
    notes = [_("Direction angle of the force: {direction}.").format(direction=direction)] if load.force else []
    if table.between == "step":
        notes.append(_("Each value holds until the next row."))
    elif table.between == "smooth":
        closed, natural = _("Between rows: periodic cubic spline."), _("Between rows: natural cubic spline.")
        notes.append(closed if table.closed else natural)
    title = _("Load {load}; argument: {against}").format(load=load.name, against=_argument_name(table))
    name = f"load_table_{linkage.loads.index(load) + 1}"
    return text_table(name, title, (_argument_name(table), _("magnitude")), rows, tuple(notes))
