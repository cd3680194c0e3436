"""Checks of what was computed, each with its number and its limit."""

from __future__ import annotations

from collections.abc import Iterable

from tmm_cli.language import _
from tmm_cli.note.blocks import Block, Heading, Items, line, paragraph
from tmm_cli.note.context import Subject
from tmm_cli.note.tables import rows_of
from tmm_cli.results.reports import walk
from tmm_cli.results.warnings import warnings


def blocks(subject: Subject) -> Iterable[Block]:
    """The table of checks, then what is worth a second look."""
    results = subject.results
    tables = list(walk(results, ("checks",)))
    told = tuple(warnings(results))
    if not tables and not told:
        return
    yield Heading(_("Checks"))
    for table in tables:
        yield paragraph(_("What was computed is checked; each quantity is compared with its limit."))
        yield rows_of(subject, table, _("Checks"))
    if told:
        yield paragraph(_("Worth a second look:"))
        yield Items(tuple(line(text) for text in told))
