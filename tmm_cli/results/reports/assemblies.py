"""All real assemblies of each group at a place of the driver; a table a group, a row an assembly."""

from __future__ import annotations

from collections.abc import Iterable

from tmm_cli.assemblies import Assemblies, GroupAssemblies, listed
from tmm_cli.pipeline import Results
from tmm_cli.places import place
from tmm_cli.problem.dimensions import ANGLE, LENGTH, NUMBER
from tmm_cli.results.table import Column, Table
from tmm_cli.words import say


def tables(results: Results) -> Iterable[Table]:
    """In solving order of the groups, at each place that was asked for."""
    for stem, here, group in listed(results.assemblies or ()):
        yield _table(stem, here, group, results)


def notes(group: GroupAssemblies) -> Iterable[str]:
    """How sure it is that there are no others, and what is odd about these."""
    number = len(group.assemblies)
    if group.moves:
        yield say("assemblies.moves")
    elif group.method == "polynomial":
        yield say("assemblies.polynomial", most=group.most)
    elif group.method == "closed form" and group.most == 2:
        yield say("assemblies.closed")
    elif group.method in ("closed form", "angles"):
        yield say("assemblies.one")
    else:
        yield say("assemblies.many")
    if number == 0 and group.complete:
        yield say("assemblies.none")
    if group.dead and not group.moves:
        yield say("assemblies.dead")


def _table(stem: str, here: Assemblies, group: GroupAssemblies, results: Results) -> Table:
    every = group.assemblies
    names = list(every[0].points) if every else []
    columns = [
        Column(say("word.group"), [group.group.title] * len(every)),
        Column(say("assemblies.number"), [str(k + 1) for k in range(len(every))]),
        Column(say("assemblies.of"), [say("assemblies.sketch") if a.of_sketch else "" for a in every]),
        Column(say("assemblies.margin"), [a.margin for a in every], NUMBER, digits=3),
        *(Column(say("assemblies.angle", link=n), [a.angles[n] for a in every], ANGLE) for n in group.group.links),
    ]
    for name in names:
        columns.append(Column(say("assemblies.x", point=name), [a.points[name].real for a in every], LENGTH))
        columns.append(Column(say("assemblies.y", point=name), [a.points[name].imag for a in every], LENGTH))
    title = say(
        "assemblies.title", group=group.group.title, count=len(every), place=place(results.problem, here.q, here.number)
    )
    return Table(stem, title, tuple(columns), notes=tuple(notes(group)))
