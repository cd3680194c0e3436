"""The literature that the note refers to."""

from __future__ import annotations

from collections.abc import Iterable

from tmm_cli.language import _
from tmm_cli.note.blocks import Block, Heading, Source, Sources
from tmm_cli.note.context import Subject


def blocks(subject: Subject) -> Iterable[Block]:
    """A list."""
    yield Heading(_("Literature"))
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
