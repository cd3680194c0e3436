"""Balancing: what shakes the frame, the counterweights that take it away, and a shaft with masses in planes."""

from __future__ import annotations

from collections.abc import Iterable

from tmm_cli.analysis.balancing import Balancing
from tmm_cli.language import _
from tmm_cli.note.balancing import counterweights, shaft, shaking
from tmm_cli.note.blocks import Block, Heading
from tmm_cli.note.context import Subject
from tmm_cli.note.tables import rows_of
from tmm_cli.results.reports import walk


def blocks(subject: Subject) -> Iterable[Block]:
    """Of a file that asks for it."""
    found = subject.results.balancing
    if found is not None and (found.task.rotor is not None or found.cycle.shakes):
        yield Heading(_("Balancing"))
        if found.cycle.shakes:
            yield from _of_links(subject, found)
        if found.task.rotor is not None:
            yield Heading(_("Rotating masses"), 2)
            yield from shaft.blocks(subject, found.task.rotor, found.corrections)


def _of_links(subject: Subject, found: Balancing) -> Iterable[Block]:
    yield Heading(_("Shaking force and moment"), 2)
    yield from shaking.explained(found)
    for k in subject.detail:
        yield from shaking.position(subject, found, k)
    if found.cycle.counterweights:
        yield Heading(_("Counterweights"), 2)
        yield from counterweights.blocks(subject, found.cycle, found.task)
    text = _("The hodograph of the shaking force is shown in figure {figure}.")
    if found.cycle.counterweights:
        text = _("The hodographs of the shaking force before and after balancing are shown in figure {figure}.")
    yield from subject.figures("shaking", text, _("Hodograph of the shaking force"))
    yield from (rows_of(subject, table) for table in walk(subject.results, ("shaking",)))
