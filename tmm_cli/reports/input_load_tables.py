"""Tables of the masses and loads that a file gives."""

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
from tmm_cli.reports.table import Table, show, show_vector, table_of_words

if TYPE_CHECKING:
    pass

FILE_WORDS: Final = {  # that a file may say, where they are shown
    "always": N_("always"),
    "working stroke": N_("working stroke"),
    "stroke": N_("stroke"),
    "share of stroke": N_("share of the stroke"),
    "crank angle": N_("crank angle"),
    "crank turn": N_("crank turn"),
}


def heavy(linkage: Linkage) -> list[str]:
    """Links that carry inertia."""
    links = linkage.links
    return [n for n in linkage.moving if np.any(links[n].mass != 0) or np.any(links[n].inertia != 0)]


def masses(problem: Problem) -> Table:
    """Masses of links, with their centres."""
    links = [problem.linkage.links[name] for name in heavy(problem.linkage)]
    return table_of_words(
        "masses",
        _("Masses"),
        (_("link"), _("mass"), _("inertia about S"), _("S in the link's axes")),
        [
            (x.name, show(problem, x.mass, MASS), show(problem, x.inertia, INERTIA), show_vector(problem, x.centre))
            for x in links
        ],
    )


def loads(problem: Problem) -> Iterable[Table]:
    """All loads, then the rows of those by table."""
    yield table_of_words(
        "loads",
        _("Loads"),
        (_("name"), _("link"), _("acts at (link's axes)"), _("size"), _("when")),
        [_load(problem, load) for load in problem.linkage.loads],
    )
    for load in problem.linkage.loads:
        if load.table is not None:
            yield _tabulated(problem, load, load.table)


def _load(problem: Problem, load: Load) -> tuple[str, ...]:
    dimension, value = (FORCE, load.force) if load.force else (MOMENT, load.moment)
    if load.table is not None:
        size = _("table of {rows} rows against the {against}").format(
            rows=len(load.table.values), against=_first_column(load.table)
        )
    elif load.resists:
        size = _("{size}, opposite to the motion").format(size=show(problem, abs(value), dimension))
    elif load.force:
        size = f"{show_vector(problem, load.force, FORCE)} {problem.units.spelt(FORCE)}"
    else:
        size = show(problem, load.moment, MOMENT)
    place = show_vector(problem, load.at) if load.force else ""
    link = load.link if load.base == FRAME else _("{link} from {base}").format(link=load.link, base=load.base)
    when = _(FILE_WORDS[load.when])
    if load.stroke_link:
        when = _("working stroke of link {link}").format(link=load.stroke_link)
    if load.window is not None:
        first, last = (show(problem, angle, ANGLE) for angle in load.window)
        when = _("crank angle from {first} to {last}").format(first=first, last=last)
    return load.name, link, place, size, when


def argument_dimension(linkage: Linkage, table: LoadTable) -> Dimension:
    """What the first column of a load's table measures."""
    if table.shares:
        return NUMBER
    return stroke_dimension(linkage, table.stroke_link) if table.against == "stroke" else ANGLE


def _first_column(table: LoadTable) -> str:
    """What the first column of a table is, with the link whose stroke it is if that is not the main output."""
    words = _(FILE_WORDS[table.first_column])
    return words if not table.stroke_link else _("{stroke} of link {link}").format(stroke=words, link=table.stroke_link)


def _tabulated(problem: Problem, load: Load, table: LoadTable) -> Table:
    """The rows of a load's table; of a force, its direction too."""
    linkage, measure = problem.linkage, argument_dimension(problem.linkage, table)
    rows = [
        (show(problem, at, measure), show(problem, size, FORCE if load.force else MOMENT))
        for at, size in zip(table.arguments, table.values, strict=True)
    ]
    direction = show(problem, np.angle(load.force), ANGLE)
    notes = [_("Its direction is {direction}.").format(direction=direction)] if load.force else []
    if table.between == "step":
        notes.append(_("Each row holds up to the next one."))
    elif table.between == "smooth":
        closed, natural = _("Between rows: a cubic spline that closes."), _("Between rows: a natural cubic spline.")
        notes.append(closed if table.closed else natural)
    title = _("{load} against the {against}").format(load=load.name, against=_first_column(table))
    name = f"load_table_{linkage.loads.index(load) + 1}"
    return table_of_words(name, title, (_first_column(table), _("size")), rows, tuple(notes))
