"""The explanatory note: blocks and formulas of a course project, written as DOCX or HTML.

A chapter is a module with a function `blocks(subject)`, and a line here.
"""

from __future__ import annotations

from importlib import import_module
from itertools import chain

from tmm_cli.language import language
from tmm_cli.mechanics.analysis import Results
from tmm_cli.note.blocks import Note
from tmm_cli.note.context import Subject

CHAPTERS = (
    "title",
    "task",
    "synthesis",
    "structure",
    "kinematics",
    "centres",
    "law_of_motion",
    "single_run",
    "forces",
    "balancing",
    "checks",
    "literature",
)
# the part of Results that a chapter needs, where it is not there for every file: without it the chapter is not imported
PARTS = {"law_of_motion": "steady", "single_run": "single", "balancing": "balancing"}

MODULES = {  # chapters that are a module of a package
    "kinematics": "kinematics.chapter",
    "law_of_motion": "dynamics.chapter",
    "single_run": "dynamics.single_run",
    "forces": "forces.chapter",
    "balancing": "balancing.chapter",
}


def note(results: Results, *, drawn: bool = True) -> Note:
    """The note of a problem that was computed, in the language that is spoken; drawn: with drawings."""
    subject = Subject(results, drawn)
    there = [name for name in CHAPTERS if name not in PARTS or getattr(results, PARTS[name]) is not None]
    chapters = [import_module(f"tmm_cli.note.{MODULES.get(name, name)}") for name in there]
    return Note(results.problem.title, language(), tuple(chain.from_iterable(c.blocks(subject) for c in chapters)))
