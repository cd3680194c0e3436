"""All real assemblies of each group at a place of the driver; a table a group, a row an assembly."""

from __future__ import annotations

import math
from collections.abc import Iterable

from tmm_cli.analysis.pipeline import Results
from tmm_cli.assembly.enumerate import Assemblies, GroupAssemblies, listed
from tmm_cli.language import N_, Phrase, _, numeral
from tmm_cli.problem.record import Problem
from tmm_cli.quantities import ANGLE, LENGTH, NUMBER, place_dimension
from tmm_cli.results.table import Column, Table


def tables(results: Results) -> Iterable[Table]:
    """In solving order of the groups, at each place that was asked for."""
    for stem, here, group in listed(results.assemblies or ()):
        yield _table(stem, here, group, results)


def place(problem: Problem, q: float, number: int | None) -> str:
    """Which position it is and where the driver stands (rad or m), which at the sketch has no number."""
    crank = problem.linkage.driver.kind == "turn"
    measure = place_dimension(problem.linkage.driver.kind)
    value = problem.units.from_si(q % math.tau if crank else q, measure)
    at = f"{numeral(round(value, 9) + 0.0, '.6g')} {problem.units.spelt(measure)}"
    if number is None:
        text = _("place of the sketch, crank at {place}") if crank else _("place of the sketch, driver at {place}")
        return text.format(place=at)
    text = _("position {number}, crank at {place}") if crank else _("position {number}, driver at {place}")
    return text.format(number=number, place=at)


def notes(group: GroupAssemblies) -> Iterable[str]:
    """How sure it is that there are no others, and what is odd about these."""
    number = len(group.assemblies)
    if group.moves:
        yield _("The group moves by itself at this place: it has assemblies without end, one of them is shown.")
    elif group.method == "polynomial":
        yield _("There are no others: they are the real roots of a polynomial of degree {most}.").format(
            most=group.most
        )
    elif group.method == "closed form" and group.most == 2:
        yield _("There are no others: a group of class II is solved in closed form.")
    elif group.method in ("closed form", "angles"):
        yield _("There are no others: its equations have one solution.")
    else:
        yield _("Found by Newton's method from many starts: it is not proved that there are no others.")
    if number == 0 and group.complete:
        yield _("At this place of the driver the group cannot be assembled.")
    if group.dead and not group.moves:
        yield _("Where the margin is 0 the group is dead: two assemblies meet in one.")


def _table(stem: str, here: Assemblies, group: GroupAssemblies, results: Results) -> Table:
    every = group.assemblies
    names = list(every[0].points) if every else []
    columns = [
        Column(N_("group"), [group.group.title] * len(every)),
        Column(N_("assembly"), [str(k + 1) for k in range(len(every))]),
        Column(N_("that of"), [_("sketch") if a.of_sketch else "" for a in every]),
        Column(N_("margin"), [a.margin for a in every], NUMBER, digits=3),
        *(Column(Phrase("angle of {link}", link=n), [a.angles[n] for a in every], ANGLE) for n in group.group.links),
    ]
    for name in names:
        columns.append(Column(Phrase("{point} x", point=name), [a.points[name].real for a in every], LENGTH))
        columns.append(Column(Phrase("{point} y", point=name), [a.points[name].imag for a in every], LENGTH))
    title = _("Real assemblies of {group}, {place}: {count}").format(
        group=group.group.title, count=len(every), place=place(results.problem, here.q, here.number)
    )
    return Table(stem, title, tuple(columns), notes=tuple(notes(group)))
