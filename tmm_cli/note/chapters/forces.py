"""The force analysis: loads, groups from the last to the driving link, lever, tables of all positions."""

from __future__ import annotations

from collections.abc import Iterable

from tmm_cli.language import _
from tmm_cli.note.blocks import Block, Heading, paragraph, said
from tmm_cli.note.context import Subject
from tmm_cli.note.forces import lever, loads, sections, tables
from tmm_cli.note.forces.parts import parts_of
from tmm_cli.plans.record import Symbol
from tmm_cli.results.reports.structure import indeterminate


def blocks(subject: Subject) -> Iterable[Block]:
    """Of what has forces."""
    if not subject.acts:
        return
    yield Heading(_("Force analysis"))
    yield said(
        _("The reactions in the kinematic pairs and the balancing load of the driving link are found by the method "
          "of kinetostatics: when the forces of inertia are added to the acting forces (d'Alembert's principle), "
          "every group of links is in equilibrium. The groups are taken in the order opposite to that of the "
          "kinematic analysis, the driving link last. The subscript of a reaction {R} has the numbers of two links: "
          "the first one acts on the second. The figures show all forces in their actual senses, so that their "
          "magnitudes are positive; the arms {h} are measured in the figures."),
        R=Symbol("R"), h=Symbol("h"),
    )  # fmt: skip
    yield from map(paragraph, indeterminate(subject.results.structure))
    for k in subject.detail:
        yield from _position(subject, k)
    yield Heading(_("Forces in all positions"), 2)
    yield from tables.reactions(subject)
    yield from tables.balancing(subject)
    yield from loads.losses(subject)


def _position(subject: Subject, k: int) -> Iterable[Block]:
    """One of those in detail, each of its sections named after it where there are several."""
    several, first = len(subject.detail) > 1, k == subject.detail[0]

    def heading(text: str) -> str:
        if not several:
            return text
        return _("{section}, position {number}").format(section=text, number=subject.called(k))

    yield Heading(heading(_("Loads of the links")), 2)
    if first:
        yield from loads.weights(subject)
    yield from loads.inertia(subject, k, explained=first)
    yield from loads.springs(subject, k)
    yield from loads.friction(subject, k, explained=first)
    yield from loads.table(subject, k, _("Loads, {position}").format(position=subject.at_position(k)))
    for number, part in enumerate(parts_of(subject, k)):
        if part.forces is not None:
            text = _("Group of links {links}") if len(part.links) > 1 else _("Group of link {links}")
        else:
            text = _("Driving link {links}")
        yield from sections.written(part, heading(text.format(links=", ".join(part.links))), first=first and not number)
    yield from loads.without_friction(subject, k)
    yield from lever.written(subject, k, heading(_("Zhukovsky lever")), explained=first)
