"""The law of motion of a single run: works and energies at its end, and its figure."""

from __future__ import annotations

from collections.abc import Iterable

from tmm_cli.language import _
from tmm_cli.note.blocks import Block, Heading
from tmm_cli.note.chapters.law_of_motion import tables
from tmm_cli.note.context import Subject
from tmm_cli.note.dynamics.single import energies


def blocks(subject: Subject) -> Iterable[Block]:
    """Of a run with an end."""
    single = subject.results.single
    assert single is not None
    yield Heading(_("Law of motion"))
    yield from energies(single, crank=subject.results.linkage.driver.kind == "turn")
    yield from subject.figures("run", _("The run is shown in figure {figure}."), _("Law of motion of the driving link"))
    yield from tables(subject)
