"""A graded example of the bank: a folder with a task, a table of variants, and what was handed in."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from tmm_cli.batch import read_task
from tmm_cli.grading.record import StudentMarks
from tmm_cli.grading.run import graded
from tmm_cli.grading.submissions.read import read_submissions
from tmm_cli.grading.tables import read_table
from tmm_cli.language import _
from tmm_cli.problem import ProblemError, read_file

HANDED_IN = ("submissions", "answers.csv", "answers.xlsx")


def grades(task_file: Path) -> dict[str, Any]:
    """What an example is graded with, student by student, as plain data. Raises ProblemError."""
    task, folder = read_task(read_file(str(task_file))), task_file.parent
    table = read_table(str(folder / "variants.csv"), task)
    handed_in = next((folder / name for name in HANDED_IN if (folder / name).exists()), None)
    if handed_in is None:
        raise ProblemError(_("nothing was handed in"), allowed=", ".join(HANDED_IN), file=str(folder))
    submissions = list(read_submissions(handed_in, task, table.rows))
    return {"students": _plain(graded(task, table, submissions))}


def _plain(found: Sequence[StudentMarks]) -> dict[str, Any]:
    return {
        marks.student: {
            "points": marks.points,
            "copied": marks.copied,
            "problems": list(marks.problems),
            "marks": {
                mark.key[0] if mark.key[1] is None else f"{mark.key[0]} at {mark.key[1]}": {
                    "state": mark.state,
                    "error": mark.error,
                    "allowed": mark.allowed,
                    "mistakes": list(mark.mistakes),
                }
                for mark in marks.marks
            },
        }
        for marks in found
    }
