"""Formats of the note: a new one is a function in a file here and an entry below."""

from __future__ import annotations

from collections.abc import Callable

from tmm_cli.language import _
from tmm_cli.note.blocks import Note
from tmm_cli.note.formats.html import html
from tmm_cli.problem.errors import ProblemError, nearest, quote

FORMATS: dict[str, Callable[[Note], bytes]] = {"html": html}


def formats_of(text: str) -> list[str]:
    """Formats from their names with commas. Raises ProblemError."""
    wanted = [part.strip().lower() for part in text.split(",") if part.strip()]
    for name in wanted or [text]:
        if name not in FORMATS:
            raise ProblemError(
                _("there is no such format of notes"), found=quote(name), allowed=", ".join(FORMATS),
                near=nearest(name, FORMATS), file="--as",
            )  # fmt: skip
    return wanted
