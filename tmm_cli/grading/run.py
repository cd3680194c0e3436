"""A group graded chunk by chunk, here, in processes or on a cluster, and only what has changed since the last time.

Chunks do not depend on who grades them, so the gradebook is the same to the last bit.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from tmm_cli.grading.copies import with_copies
from tmm_cli.grading.exports import write
from tmm_cli.grading.exports.book import Gradebook
from tmm_cli.grading.grade import CHUNK, grade, ungraded
from tmm_cli.grading.kept import keep, key_of, read_kept
from tmm_cli.grading.record import StudentMarks, Submission, VariantTable
from tmm_cli.grading.task import Task
from tmm_cli.grading.workers import Way, here, processes
from tmm_cli.language import _
from tmm_cli.problem.tree import Tree

SLOW = ("xlsx", "drawing", "junit")  # formats that take as long as all the others


@dataclass(frozen=True)
class Chunk:
    """What a worker needs for some of the students, and what it does."""

    tree: Tree
    table: VariantTable
    submissions: tuple[Submission, ...]

    def __call__(self) -> list[StudentMarks]:
        """Marks in the order of the submissions. What fails is halved until one student is left to say so."""
        task = Task(self.tree)
        try:
            return list(grade(task, self.table, self.submissions))
        except Exception as error:
            if len(self.submissions) == 1:
                why = _("could not be graded: {error}").format(error="; ".join(map(str.strip, str(error).splitlines())))
                return [ungraded(task, self.submissions[0], why)]
            half = len(self.submissions) // 2
            parts = self.submissions[:half], self.submissions[half:]
            return [marks for part in parts for marks in Chunk(self.tree, self.table, part)()]


def graded(
    task: Task, table: VariantTable, submissions: Sequence[Submission], way: Way = here, kept: Path | None = None,
    seen: Callable[[int], None] = lambda count: None, stopped: Callable[[], bool] = lambda: False,
) -> list[StudentMarks]:  # fmt: skip
    """Marks of all students in the order of the submissions; when it was stopped, of those that are graded.

    kept: the file of marks of earlier runs. seen: is told of so many more students. Raises ProblemError, OSError.
    """
    task.dimensions(table.names)
    task.asked  # noqa: B018  refuses what is wrong in it before the work starts
    keys = [key_of(task, table, submission) for submission in submissions]
    found = read_kept(kept, set(keys)) if kept else {}
    new = [n for n, key in enumerate(keys) if key not in found]
    seen(len(keys) - len(new))
    parts = [new[first : first + CHUNK] for first in range(0, len(new), CHUNK)]
    chunks = [_chunk(task, table, [submissions[n] for n in part]) for part in parts]
    for number, marks in way(chunks, stopped):
        own = {keys[n]: one for n, one in zip(parts[number], marks, strict=True)}
        found |= own
        if kept:
            keep(kept, own)
        seen(len(marks))
    return with_copies([found[key] for key in keys if key in found])


def written(folder: Path, book: Gradebook, formats: Collection[str], jobs: int) -> None:
    """Write a gradebook; that of a large group in two processes, where there are more. Raises OSError."""
    parts = [[name for name in formats if (name in SLOW) == slow] for slow in (True, False)]
    parts = [part for part in parts if part]
    if len(book.marks) <= CHUNK or len(parts) < 2:
        write(folder, book, formats)
        return
    for _done in processes(jobs)([partial(write, folder, book, part) for part in parts], lambda: False):
        pass


def _chunk(task: Task, table: VariantTable, submissions: Sequence[Submission]) -> Chunk:
    students = [submission.student for submission in submissions]
    rows = {student: table.rows[student] for student in students if student in table.rows}
    return Chunk(task.tree, VariantTable(table.names, rows), tuple(submissions))
