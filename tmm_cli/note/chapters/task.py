"""The task and its data, as the file gives them."""

from __future__ import annotations

from collections.abc import Iterable

from tmm_cli.language import _
from tmm_cli.note.blocks import Block, Heading, paragraph
from tmm_cli.note.context import Subject


def blocks(subject: Subject) -> Iterable[Block]:
    """What is given."""
    yield Heading(_("Task and data"))
    if subject.results.problem.description:
        yield paragraph(subject.results.problem.description)
