"""Short chapters: title page with table of contents, checks of the results, list of references."""

from __future__ import annotations

from collections.abc import Iterable

from tmm_cli.language import _
from tmm_cli.note.blocks import Block, Contents, Heading, Items, Source, Sources, Title, paragraph, write_table
from tmm_cli.note.subject import Subject, note_table, with_degrees
from tmm_cli.reports import collect_warnings, walk


def write_title_page(subject: Subject) -> Iterable[Block]:
    """Write the title page and the table of contents.

    Names come from the block `sheet` of the file. Missing ones become blanks to be filled in.
    """
    texts = subject.results.problem.title_texts
    people = ((_("Student"), texts.student), (_("Group"), texts.group), (_("Teacher"), texts.teacher))
    above = "\n".join(text for text in (texts.institution, texts.department) if text)
    yield Title(
        above,
        _("Explanatory note for the course project in the theory of mechanisms and machines"),
        subject.results.problem.title,
        people,
        texts.code,
    )
    yield Contents()


def write_checks(subject: Subject) -> Iterable[Block]:
    """Write the table of checks of the results, and the warnings."""
    results = subject.results
    tables = list(walk(results, ("checks",)))
    warnings = tuple(collect_warnings(results, checked=False))
    if not tables and not warnings:
        return
    yield Heading(_("Checks"))
    for table in tables:
        text = _("The results are checked: table {table} compares each quantity with its limit.")
        yield from write_table(text, note_table(subject, table, _("Checks"), "checks"))
    if warnings:
        yield paragraph(_("The following deserves attention:"))
        yield Items(tuple((with_degrees(text),) for text in warnings))


def write_literature(subject: Subject) -> Iterable[Block]:
    """Write the list of references."""
    yield Heading(_("References"))
    yield Sources(tuple(Source(key, text) for key, text in _sources()))


def _sources() -> Iterable[tuple[str, str]]:
    yield (
        "artobolevskii",
        _("Artobolevskii I. I. Theory of mechanisms and machines. 4th ed. Moscow: Nauka, 1988 (in Russian)."),
    )
    yield (
        "frolov",
        _("Frolov K. V. (ed.) Theory of mechanisms and machines. Moscow: Vysshaya shkola, 1987 (in Russian)."),
    )
