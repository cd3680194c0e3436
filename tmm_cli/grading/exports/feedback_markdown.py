"""A student's sheet as Markdown."""

from __future__ import annotations

import re
from collections.abc import Iterable
from html import escape

from tmm_cli.grading.exports.student_sheet import Sheet
from tmm_cli.language import _

SIGNS = re.compile(r"([\\`*\[\]|#~])")
LINE = re.compile(r"(?<![^\W_])_|_(?![^\W_])")  # within a word it is no markup
BETWEEN = "\x1f"  # cells


def text(sheet: Sheet) -> str:
    """A sheet as Markdown; nothing in it is markup of the student's."""
    parts = [f"# {_plain(sheet.title)}", f"**{_plain(sheet.student)}**: {_plain(sheet.total)}"]
    parts += [_list(sheet.problems)] if sheet.problems else []
    rows = [sheet.headers, ["---"] * len(sheet.headers), *(row.cells for row in sheet.rows)]
    parts.append("\n".join(f"| {_plain(BETWEEN.join(row)).replace(BETWEEN, ' | ')} |" for row in rows))
    if sheet.reasons:
        parts += [f"## {_('Why')}", _list(f"{reason} ({names})" for reason, names in sheet.reasons)]
    return "\n\n".join([*parts, *map(_plain, sheet.notes)]) + "\n"


def _list(lines: Iterable[str]) -> str:
    return "\n".join(f"- {_plain(line)}" for line in lines)


def _plain(text: str) -> str:
    """A text with no markup in it, neither of Markdown nor of HTML."""
    safe = SIGNS.sub(r"\\\1", escape(text, quote=False))
    return LINE.sub(r"\\_", safe) if "_" in safe else safe
