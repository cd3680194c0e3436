"""The force analysis: loads, groups from the last to the driving link, lever, tables of all positions."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from tmm_cli.language import _
from tmm_cli.note.blocks import Block, Heading, Ref, paragraph, said
from tmm_cli.note.context import Subject
from tmm_cli.note.forces import lever, loads, sections, tables
from tmm_cli.note.forces.equations import MU
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
    yield from tables.transmission(subject)
    yield from loads.losses(subject)


def _position(subject: Subject, k: int) -> Iterable[Block]:
    """One of those in detail, each of its sections named after it where there are several."""
    several = len(subject.detail) > 1

    def heading(text: str) -> str:
        if not several:
            return text
        return _("{section}, position {number}").format(section=text, number=subject.called(k))

    by_steps = subject.results.problem.note_style.sections == "MATI"
    yield from (_by_steps if by_steps else _by_parts)(subject, k, heading)
    yield from loads.without_friction(subject, k)
    yield from lever.written(subject, k, heading(_("Zhukovsky lever")), explained=k == subject.detail[0])


def _by_parts(subject: Subject, k: int, heading: Callable[[str], str]) -> Iterable[Block]:
    """All loads, then a section for each group and each driving link."""
    first = k == subject.detail[0]
    yield Heading(heading(_("Loads of the links")), 2)
    if first:
        yield from loads.weights(subject)
    yield from loads.inertia(subject, k, explained=first)
    yield from _further_loads(subject, k)
    yield from _reactions(subject, k, heading, 2)


def _by_steps(subject: Subject, k: int, heading: Callable[[str], str]) -> Iterable[Block]:
    """Steps 2.3.1 to 2.3.4 of the force guidelines: the plan, weights and loads, inertia, groups one after another."""
    first, caption = k == subject.detail[0], subject.at_position(k)
    yield Heading(heading(_("Plan of the mechanism")), 2)
    stem = subject.position(k).stem("position")
    yield said(
        _("The plan of the mechanism is drawn in {position}; its scale factor is {mu} = {value} m/mm."),
        position=caption, mu=MU, value=subject.text(subject.scale("position", k, stem)),
    )  # fmt: skip
    yield Heading(heading(_("Weights and useful loads")), 2)
    yield said(_("They are applied to the links as arrows of one length, without a scale."))
    if first:
        yield from loads.weights(subject)
    yield from subject.figures(
        "position", _("All forces that act on the links are shown in figure {figure}."),
        _("The mechanism under its loads, {position}").format(position=caption), k,
    )  # fmt: skip
    yield Heading(heading(_("Plan of accelerations and inertia forces")), 2)
    plans = list(subject.drawings("acceleration", k))
    if plans:
        yield said(_("The plan of accelerations is that of figure {figure}."), figure=Ref(plans[0]))
    yield from loads.inertia(subject, k, explained=first)
    yield from _further_loads(subject, k)
    yield Heading(heading(_("Reactions in the kinematic pairs")), 2)
    yield from _reactions(subject, k, heading, 3)


def _further_loads(subject: Subject, k: int) -> Iterable[Block]:
    yield from loads.springs(subject, k)
    yield from loads.friction(subject, k, explained=k == subject.detail[0])
    yield from loads.table(subject, k, _("Loads, {position}").format(position=subject.at_position(k)))


def _reactions(subject: Subject, k: int, heading: Callable[[str], str], level: int) -> Iterable[Block]:
    """The groups from the last one, and the driving links."""
    for number, part in enumerate(parts_of(subject, k)):
        if part.forces is not None:
            text = _("Group of links {links}") if len(part.links) > 1 else _("Group of link {links}")
        else:
            text = _("Driving link {links}")
        text = heading(text.format(links=", ".join(part.links)))
        yield from sections.written(part, Heading(text, level), first=k == subject.detail[0] and not number)
