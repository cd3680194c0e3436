"""Chapters of the note and their order.

To add a chapter, write a function that takes the subject and yields blocks, and enter it in CHAPTERS.
"""

from __future__ import annotations

from importlib import import_module

from tmm_cli.language import language
from tmm_cli.mechanics.analysis import Results
from tmm_cli.note.blocks import Block, Note
from tmm_cli.note.subject import Subject

CHAPTERS = {  # module and function of each chapter, in the order of the note
    "title": ("short_chapters", "write_title_page"),
    "task": ("task", "write_task"),
    "synthesis": ("synthesis", "write_synthesis"),
    "structure": ("structure", "write_structure"),
    "kinematics": ("kinematics.chapter", "write_kinematics"),
    "centres": ("centres", "write_centres"),
    "law_of_motion": ("dynamics.law_of_motion", "write_steady_running"),
    "single_run": ("dynamics.law_of_motion", "write_single_run"),
    "forces": ("forces.chapter", "write_forces"),
    "balancing": ("balancing", "write_balancing"),
    "checks": ("short_chapters", "write_checks"),
    "literature": ("short_chapters", "write_literature"),
}
# results that only some files have; a chapter that needs them is imported only if they exist
PARTS = {"law_of_motion": "steady", "single_run": "single", "balancing": "balancing"}


def note(results: Results, *, drawn: bool = True) -> Note:
    """Write the explanatory note of a computed problem in the current language.

    Args:
        results: results of the problem.
        drawn: True to include drawings. Without them the note is written much faster.

    Returns:
        The note, to be written to a file by a function of FORMATS.
    """
    subject = Subject(results, drawn)
    present = [name for name in CHAPTERS if name not in PARTS or getattr(results, PARTS[name]) is not None]
    blocks: list[Block] = []
    for module, function in (CHAPTERS[name] for name in present):
        blocks += getattr(import_module(f"tmm_cli.note.{module}"), function)(subject)
    return Note(results.problem.title, language(), tuple(blocks))
