"""The explanatory note: blocks and formulas of a course project, written as DOCX or HTML.

A chapter is a file in `chapters` with a function `blocks(subject)`, and a line here.
"""

from __future__ import annotations

from tmm_cli.analysis.pipeline import Results
from tmm_cli.language import language
from tmm_cli.note import blocks
from tmm_cli.note.chapters import (
    balancing,
    centres,
    checks,
    forces,
    kinematics,
    law_of_motion,
    literature,
    structure,
    synthesis,
    task,
    title,
)
from tmm_cli.note.context import Subject

CHAPTERS = (
    title,
    task,
    synthesis,
    structure,
    kinematics,
    centres,
    law_of_motion,
    forces,
    balancing,
    checks,
    literature,
)


def note(results: Results, *, drawn: bool = True) -> blocks.Note:
    """The note of a problem that was computed, in the language that is spoken; drawn: with drawings."""
    subject = Subject(results, language(), drawn)
    return blocks.Note(results.problem.title, language(), blocks.chapters(*(c.blocks(subject) for c in CHAPTERS)))
