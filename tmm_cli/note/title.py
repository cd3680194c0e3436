"""The title page and the table of contents."""

from __future__ import annotations

from collections.abc import Iterable

from tmm_cli.language import _
from tmm_cli.note.blocks import Block, Contents, Title
from tmm_cli.note.context import Subject


def blocks(subject: Subject) -> Iterable[Block]:
    """What the block `sheet` of the file gives; lines are left for what it does not."""
    texts = subject.results.problem.title_texts
    people = ((_("Student"), texts.student), (_("Group"), texts.group), (_("Teacher"), texts.teacher))
    above = "\n".join(text for text in (texts.institution, texts.department) if text)
    yield Title(
        above,
        _("Explanatory note to the course project in the theory of mechanisms and machines"),
        subject.results.problem.title,
        people,
        texts.code,
    )
    yield Contents()
