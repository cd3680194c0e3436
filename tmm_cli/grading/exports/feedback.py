"""feedback/<student>.md and .html: what each student is told."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Final

from tmm_cli.grading.exports import feedback_html, feedback_markdown
from tmm_cli.grading.exports.book import Gradebook
from tmm_cli.grading.exports.student_sheet import Sheet, sheets

FORMATS: Final[Mapping[str, Callable[[Sheet], str]]] = {"md": feedback_markdown.text, "html": feedback_html.text}


def files(book: Gradebook) -> Iterator[tuple[str, Iterable[str]]]:
    """Each sheet in every format."""
    for name, sheet in zip(book.files, sheets(book), strict=True):
        yield from ((f"feedback/{name}.{ending}", (text(sheet),)) for ending, text in FORMATS.items())
