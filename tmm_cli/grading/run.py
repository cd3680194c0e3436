"""Grading of a group: solve the variants, judge each answer, explain the wrong ones, save the marks for later runs.

The file of saved marks has one line per student, added as soon as the student is graded. A line contains a key, a
checksum of the line, and the marks as JSON. The key is a digest of everything that the marks depend on. A damaged line
is ignored.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, fields, replace
from functools import partial
from hashlib import blake2b
from pathlib import Path
from typing import Any

import numpy as np

from tmm_cli.batch import (
    JobRunner,
    Question,
    Task,
    VariantFamily,
    in_processes,
    program_digest,
    read_task,
    run_here,
    split_families,
)
from tmm_cli.grading.copies import find_copies
from tmm_cli.grading.diagnose import diagnose_students
from tmm_cli.grading.exports import write_formats
from tmm_cli.grading.exports.book import Gradebook
from tmm_cli.grading.exports.result_json import plain_marks
from tmm_cli.grading.mistakes.data import OtherZero
from tmm_cli.grading.own_answers import find_carried_errors, find_repeated_mistakes
from tmm_cli.grading.record import Mark, State, StudentMarks, Submission, VariantTable, read_in_si
from tmm_cli.grading.sheet import compute_right_answers
from tmm_cli.grading.submissions.answers import assign_to_positions
from tmm_cli.grading.submissions.read import read_submissions
from tmm_cli.grading.variant_tables import read_table
from tmm_cli.language import _, language
from tmm_cli.mechanics.errors import LinkageError
from tmm_cli.mechanics.numerics import Real
from tmm_cli.mechanics.quantities import Dimension
from tmm_cli.problem import ProblemError, Tree, read_file

NAMES = tuple(field.name for field in fields(Mark))
VECTORS = ("value", "right")


def compute_marks_key(task: Task, table: VariantTable, submission: Submission) -> str:
    """Return a digest of everything that a student's marks depend on.

    This is the version of the program, the language, the task, the variant and the submission.
    """
    row = table.rows.get(submission.student)
    return _digest(program_digest(), language(), task.tree.data, table.names, row, submission)


def _digest(*parts: object) -> str:
    return blake2b(repr(parts).encode(errors="backslashreplace"), digest_size=16).hexdigest()


def _marks_line(key: str, marks: StudentMarks) -> str:
    """Return a line of the file of saved marks, without the line break."""
    rows = [[_json_field(getattr(mark, name), name) for name in NAMES] for mark in marks.marks]
    text = json.dumps([marks.student, rows, marks.problems])
    return f"{key} {_digest(text)} {text}"


def _json_field(value: Any, name: str) -> Any:
    """Return a field of a mark as JSON data; a complex number as a list of its real and imaginary parts."""
    if name not in VECTORS or value is None:
        return value
    number = complex(value)
    return [number.real, number.imag]


def read_saved_marks(path: Path, keys: Collection[str]) -> dict[str, StudentMarks]:
    """Read the saved marks of earlier runs.

    Args:
        path: File of saved marks; it need not exist.
        keys: Keys of the students' marks that are needed.

    Returns:
        Marks by key, for those found in the file.
    """
    found: dict[str, StudentMarks] = {}
    try:
        with path.open(encoding="ascii", errors="replace") as stream:
            for line in stream:
                key, _, rest = line.rstrip("\n").partition(" ")
                digest, _, text = rest.partition(" ")
                if key in keys and digest == _digest(text):
                    with suppress(TypeError, ValueError, KeyError):  # of another form: graded again
                        found[key] = _parse_marks(text)
    except OSError:
        pass  # there is none yet, or none that can be read
    return found


def _parse_marks(text: str) -> StudentMarks:
    student, rows, problems = json.loads(text)
    return StudentMarks(
        student, tuple(_parse_mark(dict(zip(NAMES, row, strict=True))) for row in rows), tuple(problems)
    )


def _parse_mark(row: dict[str, Any]) -> Mark:
    vectors = {name: None if row[name] is None else complex(*row[name]) for name in VECTORS}
    return Mark(**row | vectors | {name: tuple(row[name]) for name in ("key", "reasons", "mistakes", "identifiers")})


def append_marks(path: Path, marks: Mapping[str, StudentMarks]) -> None:
    """Append marks to the file of saved marks.

    marks: marks of students, by the key that `compute_marks_key` returns.

    Raises:
        OSError: The file cannot be written.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("a", encoding="ascii") as stream:
        stream.writelines(f"\n{_marks_line(key, own)}" for key, own in marks.items())


# The way of grading: variants solved together, every answer judged, what is wrong explained.


CHUNK = 500  # students at once: all their numbers stay near the processor
POSITIONS = 100_000  # of all these students, at most: numbers of the work are some hundred megabytes


def grade(task: Task, table: VariantTable, submissions: Sequence[Submission]) -> Iterator[StudentMarks]:
    """Yield the marks of all students in the order of the submissions.

    Args:
        task: Task whose block `grading` lists the questions.
        table: Variants of the students.
        submissions: Submissions of the students.

    Raises:
        ProblemError: The table or the task is wrong.
    """
    some = max(1, min(CHUNK, POSITIONS // task.positions))
    for first in range(0, len(submissions), some):
        yield from _grade_chunk(task, table, submissions[first : first + some])


def _grade_chunk(task: Task, table: VariantTable, submissions: Sequence[Submission]) -> Iterator[StudentMarks]:
    found: dict[int, StudentMarks] = {}
    known = [n for n, s in enumerate(submissions) if s.student in table.rows]
    dimensions, columns = read_parameter_values(task, table, [submissions[n].student for n in known])
    for rows, family in split_families(lambda numbers: task.make(table.names, dimensions, numbers), columns):
        own = [known[row] for row in rows]
        if isinstance(family, LinkageError):
            found |= {n: mark_as_ungraded(task, submissions[n], str(family)) for n in own}
        else:
            for part, begun in _group_by_zero_position(task, family, [submissions[n] for n in own]):
                there = [own[row] for row in part]
                found |= dict(zip(there, _mark_family(task, begun, [submissions[n] for n in there]), strict=True))
    for n, submission in enumerate(submissions):
        yield found.get(n) or mark_as_ungraded(task, submission, _("this student has no variant"))


def read_parameter_values(
    task: Task, table: VariantTable, students: Sequence[str]
) -> tuple[tuple[Dimension | None, ...], Real]:
    """Read the parameter values of the students' variants.

    Returns:
        Dimension of each parameter, and the values in SI, (students, parameters). If no cell of a column has a unit,
        the dimension is the one that the task file gives the parameter. If it gives none either, the dimension is None
        and the values are not converted.

    Raises:
        ProblemError: A value cannot be read.
    """
    found = [[task.value(text) for text in table.rows[student]] for student in students]
    said = [next((v.dimension for v in column if v.dimension), None) for column in zip(*found, strict=True)]
    own = task.dimensions(table.names)
    dimensions = tuple(first or then for first, then in zip(said or own, own, strict=True))
    columns = np.array(
        [[task.number(value, dimension) for value, dimension in zip(row, dimensions, strict=True)] for row in found]
    ).reshape(len(students), len(table.names))
    return dimensions, columns


def mark_as_ungraded(task: Task, submission: Submission, why: str) -> StudentMarks:
    """Return marks without points for a student whose answers cannot be judged; why: the reason, for the teacher."""
    marks = tuple(Mark(one.key, "missing", 0.0, one.points) for one in task.asked)
    return StudentMarks(submission.student, marks, (*submission.problems, why))


def _group_by_zero_position(
    task: Task, family: VariantFamily, submissions: Sequence[Submission]
) -> Iterator[tuple[Real, VariantFamily]]:
    """Group the students by the extreme position of the output from which they number the positions.

    The other extreme position is considered only if the task allows it. It is chosen for a student if more of the
    student's answers are then right. Each group consists of the indices of its students and their variants.
    """
    rows, strokes = np.arange(len(submissions)), family.strokes
    if task.rules.from_ == "task" or strokes is None or len(strokes.strokes) != 2:
        yield rows, family
        return
    both = (family, OtherZero(True).change_family(family))
    holds = []
    for one in both:
        wanted = compute_right_answers(one, task.asked)
        holds.append(np.sum(wanted.error(read_in_si(task.units, wanted, submissions)[0]) <= wanted.allowed, axis=1))
    other = holds[1] > holds[0]
    for one, part in zip(both, (rows[~other], rows[other]), strict=True):
        if part.size:
            yield part, one.take(part)


def _mark_family(task: Task, family: VariantFamily, submissions: Sequence[Submission]) -> list[StudentMarks]:
    """Return the marks of students whose variants form one family, with the same zero position."""
    submissions = [assign_to_positions(one, task, places) for one, places in zip(submissions, family.q, strict=True)]
    found: dict[int, StudentMarks] = {}
    for rows, asked in _group_by_attachment(task, family, submissions):
        same = [submissions[n] for n in rows.tolist()]
        part = family if len(rows) == len(submissions) else family.take(rows)
        found |= dict(zip(rows.tolist(), _mark_students(task, asked, part, same), strict=True))
    return [marks for _row, marks in sorted(found.items())]


def _group_by_attachment(
    task: Task, family: VariantFamily, submissions: Sequence[Submission]
) -> Iterator[tuple[Real, tuple[Question, ...]]]:
    """Group the students by the link to which they attach the others at a hinge of three or more links.

    This choice determines which forces a reaction at the hinge includes. The other choice is used for answers that are
    right only with it. Each group consists of the indices of its students and their questions.
    """
    other = tuple(replace(one, quantity=one.quantity.otherwise or one.quantity) for one in task.asked)
    if other == task.asked:
        yield np.arange(len(submissions)), task.asked
        return
    holds = []
    for asked in (task.asked, other):
        wanted = compute_right_answers(family, asked)
        holds.append(wanted.error(read_in_si(task.units, wanted, submissions)[0]) <= wanted.allowed)
    patterns, which = np.unique(holds[1] & ~holds[0], axis=0, return_inverse=True)
    for number, pattern in enumerate(patterns):
        asked = tuple(b if chosen else a for a, b, chosen in zip(task.asked, other, pattern, strict=True))
        yield np.flatnonzero(which.ravel() == number), asked


def _mark_students(
    task: Task, asked_all: tuple[Question, ...], family: VariantFamily, submissions: Sequence[Submission]
) -> list[StudentMarks]:
    """Return the marks of students whose variants form one family and who have the same questions."""
    wanted = compute_right_answers(family, asked_all)
    written, how, refused = read_in_si(task.units, wanted, submissions)
    error = wanted.error(written)
    claims = diagnose_students(family, wanted, written)
    follows = find_carried_errors(family, wanted, written)
    repeated = find_repeated_mistakes(wanted, follows, claims)
    found = []
    for n, submission in enumerate(submissions):
        marks = []
        for k, asked in enumerate(asked_all):
            there, given = bool(written.given[n, k]), submission.answers.get(asked.key)
            state: State = "missing"
            if there or (n, k) in refused:
                wrong: State = "follows" if (n, k) in follows else "repeated" if (n, k) in repeated else "wrong"
                state = "right" if error[n, k] <= wanted.allowed[n, k] else wrong
            named = [claim for claim in claims.get(n, ()) if k in claim.answers]
            reasons = [refused[n, k]] if (n, k) in refused else [claim.description for claim in named]
            if state == "follows":
                sources = ", ".join(asked_all[j].name for j in follows[n, k])
                reasons = [
                    _("This answer is right if your own earlier values of {sources} are used.").format(sources=sources)
                ]
                named = []
            if state == "repeated":
                first = asked_all[repeated[n, k]].name
                reasons.append(_("This mistake has already cost the points of {answer}.").format(answer=first))
            marks.append(
                Mark(
                    asked.key,
                    state,
                    0.0 if state in ("missing", "wrong") else asked.points,
                    asked.points,
                    complex(written.value[n, k]) if there else None,
                    complex(wanted.value[n, k]),
                    bool(written.size[n, k]),
                    float(wanted.scale[n, k]),
                    float(error[n, k]) if there else 0.0,
                    float(wanted.allowed[n, k]),
                    how.get((n, k), ""),
                    tuple(reasons),
                    tuple(claim.label for claim in named),
                    given.text if given else "",
                    tuple(claim.identifiers for claim in named),
                )
            )
        found.append(StudentMarks(submission.student, tuple(marks), submission.problems))
    return found


# A group graded chunk by chunk, here, in processes or on a cluster, and only what has changed since the last time.
#
# Chunks do not depend on who grades them, so the gradebook is the same to the last bit.


SLOW = ("xlsx", "drawing", "junit")  # formats that take as long as all the others


@dataclass(frozen=True)
class Chunk:
    """A job for one process: some students whose submissions are to be graded. Calling it returns their marks.

    Attributes:
        tree: contents of the task file.
        table: variants of these students.
        submissions: their submissions.
    """

    tree: Tree
    table: VariantTable
    submissions: tuple[Submission, ...]

    def __call__(self) -> list[StudentMarks]:
        """Grade the students; return their marks in the order of the submissions.

        If an error occurs, each half of the students is graded separately, and so on. In the end only the student whose
        submission causes the error remains ungraded.
        """
        task = Task(self.tree)
        try:
            return list(grade(task, self.table, self.submissions))
        except Exception as error:
            if len(self.submissions) == 1:
                why = _("the answers could not be graded: {error}").format(
                    error="; ".join(map(str.strip, str(error).splitlines()))
                )
                return [mark_as_ungraded(task, self.submissions[0], why)]
            half = len(self.submissions) // 2
            parts = self.submissions[:half], self.submissions[half:]
            return [marks for part in parts for marks in Chunk(self.tree, self.table, part)()]


def grade_group(
    task: Task,
    table: VariantTable,
    submissions: Sequence[Submission],
    way: JobRunner = run_here,
    kept: Path | None = None,
    seen: Callable[[int], None] = lambda count: None,
    stopped: Callable[[], bool] = lambda: False,
) -> list[StudentMarks]:
    """Grade all students, if required in parallel; students with saved marks of earlier runs are not graded again.

    Args:
        task: Task.
        table: Variants of the students.
        submissions: Submissions of the students.
        way: Function that runs the jobs: in this process, in several processes or on a cluster.
        kept: File of saved marks; None to save nothing.
        seen: Called with the number of students graded since the last call.
        stopped: Called from time to time; grading stops early if it returns True.

    Returns:
        Marks in the order of the submissions; after an early stop, those of the students graded so far.

    Raises:
        ProblemError: The table or the task is wrong.
        OSError: The file of saved marks cannot be written.
    """
    task.dimensions(table.names)
    task.asked  # noqa: B018  refuses what is wrong in it before the work starts
    keys = [compute_marks_key(task, table, submission) for submission in submissions]
    found = read_saved_marks(kept, set(keys)) if kept else {}
    new = [n for n, key in enumerate(keys) if key not in found]
    seen(len(keys) - len(new))
    parts = [new[first : first + CHUNK] for first in range(0, len(new), CHUNK)]
    chunks = [_build_chunk(task, table, [submissions[n] for n in part]) for part in parts]
    for number, marks in way(chunks, stopped):
        own = {keys[n]: one for n, one in zip(parts[number], marks, strict=True)}
        found |= own
        if kept:
            append_marks(kept, own)
        seen(len(marks))
    return find_copies([found[key] for key in keys if key in found])


def write_gradebook(folder: Path, book: Gradebook, formats: Collection[str], jobs: int) -> None:
    """Write a gradebook in several formats; for a large group in two processes, one for the slow formats.

    Args:
        folder: Folder for the files.
        book: Gradebook.
        formats: Names of formats, keys of EXPORTS.
        jobs: Largest number of processes.

    Raises:
        OSError: A file cannot be written.
    """
    parts = [[name for name in formats if (name in SLOW) == slow] for slow in (True, False)]
    parts = [part for part in parts if part]
    if len(book.marks) <= CHUNK or len(parts) < 2:
        write_formats(folder, book, formats)
        return
    for _done in in_processes(jobs)([partial(write_formats, folder, book, part) for part in parts], lambda: False):
        pass


def _build_chunk(task: Task, table: VariantTable, submissions: Sequence[Submission]) -> Chunk:
    students = [submission.student for submission in submissions]
    rows = {student: table.rows[student] for student in students if student in table.rows}
    return Chunk(task.tree, VariantTable(table.names, rows), tuple(submissions))


HANDED_IN = ("submissions", "answers.csv", "answers.xlsx")


def grade_example(task_file: Path) -> dict[str, Any]:
    """Grade an example: a folder with a task file, variants.csv and submissions.

    Returns:
        Marks of all students as dictionaries and lists that JSON can represent.

    Raises:
        ProblemError: A file of the example is missing or wrong.
    """
    task, folder = read_task(read_file(str(task_file))), task_file.parent
    table = read_table(str(folder / "variants.csv"), task)
    handed_in = next((folder / name for name in HANDED_IN if (folder / name).exists()), None)
    if handed_in is None:
        raise ProblemError(_("nothing was handed in"), allowed=", ".join(HANDED_IN), file=str(folder))
    submissions = list(read_submissions(handed_in, task, table.rows))
    return {"students": {marks.student: plain_marks(marks) for marks in grade_group(task, table, submissions)}}
