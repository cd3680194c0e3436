"""The structure: links, pairs, mobility, Assur groups, formula, class."""

from __future__ import annotations

from collections.abc import Iterable

from tmm_cli.language import _
from tmm_cli.note.blocks import Block, Heading, paragraph
from tmm_cli.note.context import Subject
from tmm_cli.results.in_words import in_words


def blocks(subject: Subject) -> Iterable[Block]:
    """From the scheme to the class."""
    yield Heading(_("Structure of the mechanism"))
    yield from subject.figures(
        "structure", _("The structural scheme is shown in figure {figure}."), _("Structural scheme")
    )
    for sentence in in_words(subject.results):
        yield paragraph(sentence)
