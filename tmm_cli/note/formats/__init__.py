"""File formats of the note. To add a format, write a function in a module here and enter it in FORMATS."""

from __future__ import annotations

from collections.abc import Callable
from importlib.util import find_spec

from tmm_cli.language import _
from tmm_cli.note.blocks import Note
from tmm_cli.note.formats.html import html
from tmm_cli.problem import ProblemError, parse_names


def _docx(note: Note) -> bytes:
    from tmm_cli.note.formats.docx import docx  # an optional package that takes 0.25 s to import

    return docx(note)


FORMATS: dict[str, Callable[[Note], bytes]] = {"html": html, "docx": _docx}


def formats_of(text: str) -> list[str]:
    """Parse comma-separated names of formats, e.g. "html,docx".

    Raises:
        ProblemError: A format is unknown, or python-docx is not installed.
    """
    names = parse_names(text, FORMATS, "--as", _("unknown format of the note"))
    if "docx" in names and find_spec("docx") is None:
        raise ProblemError(
            _("DOCX requires the package python-docx, which is not installed"),
            allowed=_("html; for docx, first run pip install 'tmm-cli[note]'"),
        )
    return names
