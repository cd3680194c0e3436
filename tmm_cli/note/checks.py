"""Checks of what was computed, each with its number and its limit."""

from __future__ import annotations

from collections.abc import Iterable

from tmm_cli.language import _
from tmm_cli.note.blocks import Block, Heading, Items, paragraph, tabled
from tmm_cli.note.context import Subject, with_degrees
from tmm_cli.note.tables import rows_of
from tmm_cli.reports import collect_warnings, walk


def blocks(subject: Subject) -> Iterable[Block]:
    """The table of checks, then what is worth a second look."""
    results = subject.results
    tables = list(walk(results, ("checks",)))
    told = tuple(collect_warnings(results, checked=False))
    if not tables and not told:
        return
    yield Heading(_("Checks"))
    for table in tables:
        text = _("The results are checked: table {table} compares each quantity with its limit.")
        yield from tabled(text, rows_of(subject, table, _("Checks"), "checks"))
    if told:
        yield paragraph(_("The following deserves attention:"))
        yield Items(tuple((with_degrees(text),) for text in told))
