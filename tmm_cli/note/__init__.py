"""The explanatory note: blocks and formulas of a course project, written as DOCX or HTML.

A chapter is a file in `chapters` with a function `blocks(subject)`, and a line here.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from importlib import import_module

from tmm_cli.analysis.pipeline import Results
from tmm_cli.language import language
from tmm_cli.note import blocks
from tmm_cli.note.context import Subject

# file in chapters, the part of Results that it needs: one of what was not computed is not even imported
CHAPTERS: tuple[tuple[str, str], ...] = (
    ("title", "structure"),
    ("task", "structure"),
    ("synthesis", "structure"),
    ("structure", "structure"),
    ("kinematics", "structure"),
    ("centres", "structure"),
    ("law_of_motion", "steady"),
    ("single_run", "single"),
    ("forces", "structure"),
    ("balancing", "balancing"),
    ("checks", "structure"),
    ("literature", "structure"),
)


def note(results: Results, *, drawn: bool = True) -> blocks.Note:
    """The note of a problem that was computed, in the language that is spoken; drawn: with drawings."""
    subject = Subject(results, language(), drawn)
    return blocks.Note(results.problem.title, language(), blocks.chapters(*_chapters(subject)))


def _chapters(subject: Subject) -> Iterator[Iterable[blocks.Block]]:
    for name, part in CHAPTERS:
        if getattr(subject.results, part) is not None:
            yield import_module(f"{__name__}.chapters.{name}").blocks(subject)
