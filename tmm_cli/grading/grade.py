"""The way of grading: variants solved together, every answer judged, what is wrong explained."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from tmm_cli.errors import LinkageError
from tmm_cli.grading.diagnose import diagnose
from tmm_cli.grading.following import following
from tmm_cli.grading.mistakes.other_zero import OtherZero
from tmm_cli.grading.readings import read
from tmm_cli.grading.record import Mark, State, StudentMarks, Submission, VariantTable
from tmm_cli.grading.sheet import right
from tmm_cli.grading.submissions.positions import at_positions
from tmm_cli.grading.task import Asked, Task
from tmm_cli.language import _
from tmm_cli.quantities import Dimension
from tmm_cli.variants.family import Family, families
from tmm_cli.vectors import Real

CHUNK = 500  # students at once: all their numbers stay near the processor
POSITIONS = 100_000  # of all these students, at most: numbers of the work are some hundred megabytes


def grade(task: Task, table: VariantTable, submissions: Sequence[Submission]) -> Iterator[StudentMarks]:
    """Marks of every student, in the order of the submissions. Raises ProblemError."""
    some = max(1, min(CHUNK, POSITIONS // task.positions))
    for first in range(0, len(submissions), some):
        yield from _chunk(task, table, submissions[first : first + some])


def _chunk(task: Task, table: VariantTable, submissions: Sequence[Submission]) -> Iterator[StudentMarks]:
    found: dict[int, StudentMarks] = {}
    known = [n for n, s in enumerate(submissions) if s.student in table.rows]
    dimensions, columns = numbers_of(task, table, [submissions[n].student for n in known])
    for rows, family in families(lambda numbers: task.make(table.names, dimensions, numbers), columns):
        own = [known[row] for row in rows]
        if isinstance(family, LinkageError):
            found |= {n: ungraded(task, submissions[n], str(family)) for n in own}
        else:
            for part, begun in _begun(task, family, [submissions[n] for n in own]):
                there = [own[row] for row in part]
                found |= dict(zip(there, _marks(task, begun, [submissions[n] for n in there]), strict=True))
    for n, submission in enumerate(submissions):
        yield found.get(n) or ungraded(task, submission, _("there is no variant of this student"))


def numbers_of(task: Task, table: VariantTable, students: Sequence[str]) -> tuple[tuple[Dimension | None, ...], Real]:
    """Dimensions of the parameters, and their numbers (students, parameters): in SI, bare where no value has a unit.

    Raises ProblemError.
    """
    found = [[task.value(text) for text in table.rows[student]] for student in students]
    said = [next((v.dimension for v in column if v.dimension), None) for column in zip(*found, strict=True)]
    own = task.dimensions(table.names)
    dimensions = tuple(first or then for first, then in zip(said or own, own, strict=True))
    columns = np.array([
        [task.number(value, dimension) for value, dimension in zip(row, dimensions, strict=True)] for row in found
    ]).reshape(len(students), len(table.names))  # fmt: skip
    return dimensions, columns


def ungraded(task: Task, submission: Submission, why: str) -> StudentMarks:
    """Of a student of whom nothing can be judged."""
    marks = tuple(Mark(one.key, "missing", 0.0, one.points) for one in task.asked)
    return StudentMarks(submission.student, marks, (*submission.problems, why))


def _begun(task: Task, family: Family, submissions: Sequence[Submission]) -> Iterator[tuple[Real, Family]]:
    """The students who count the positions from where the task does, and those who do from the other extreme position.

    The latter only where the task allows it; each by what makes more of the answers right.
    """
    rows, strokes = np.arange(len(submissions)), family.strokes
    if task.rules.from_ == "task" or strokes is None or len(strokes.strokes) != 2:
        yield rows, family
        return
    both = (family, OtherZero(True).family(family))
    holds = []
    for one in both:
        wanted = right(one, task.asked)
        holds.append(np.sum(wanted.error(read(task.units, wanted, submissions)[0]) <= wanted.allowed, axis=1))
    other = holds[1] > holds[0]
    for one, part in zip(both, (rows[~other], rows[other]), strict=True):
        if part.size:
            yield part, one.take(part)


def _marks(task: Task, family: Family, submissions: Sequence[Submission]) -> list[StudentMarks]:
    """Of the students of one family."""
    submissions = [at_positions(one, task, places) for one, places in zip(submissions, family.q, strict=True)]
    found: dict[int, StudentMarks] = {}
    for rows, asked in _by_attachment(task, family, submissions):
        same = [submissions[n] for n in rows.tolist()]
        part = family if len(rows) == len(submissions) else family.take(rows)
        found |= dict(zip(rows.tolist(), _marks_of(task, asked, part, same), strict=True))
    return [marks for _row, marks in sorted(found.items())]


def _by_attachment(
    task: Task, family: Family, submissions: Sequence[Submission]
) -> Iterator[tuple[Real, tuple[Asked, ...]]]:
    """Students with what is asked of them, reactions in compound hinges as each has attached the links there.

    The other attachment counts for an answer that it makes right and the usual one does not.
    """
    other = tuple(replace(one, quantity=one.quantity.otherwise or one.quantity) for one in task.asked)
    if other == task.asked:
        yield np.arange(len(submissions)), task.asked
        return
    holds = []
    for asked in (task.asked, other):
        wanted = right(family, asked)
        holds.append(wanted.error(read(task.units, wanted, submissions)[0]) <= wanted.allowed)
    patterns, which = np.unique(holds[1] & ~holds[0], axis=0, return_inverse=True)
    for number, pattern in enumerate(patterns):
        asked = tuple(b if chosen else a for a, b, chosen in zip(task.asked, other, pattern, strict=True))
        yield np.flatnonzero(which.ravel() == number), asked


def _marks_of(
    task: Task, asked_all: tuple[Asked, ...], family: Family, submissions: Sequence[Submission]
) -> list[StudentMarks]:
    """Of students of one family of whom the same is asked."""
    wanted = right(family, asked_all)
    written, how, refused = read(task.units, wanted, submissions)
    error = wanted.error(written)
    claims = diagnose(family, wanted, written)
    follows = following(family, wanted, written, claims)
    found = []
    for n, submission in enumerate(submissions):
        marks = []
        for k, asked in enumerate(asked_all):
            there, given = bool(written.there[n, k]), submission.answers.get(asked.key)
            state: State = "missing"
            if there or (n, k) in refused:
                state = "right" if error[n, k] <= wanted.allowed[n, k] else "follows" if (n, k) in follows else "wrong"
            named = [claim for claim in claims.get(n, ()) if k in claim.answers]
            reasons = [refused[n, k]] if (n, k) in refused else [claim.told for claim in named]
            if state == "follows":
                sources = ", ".join(asked_all[j].name for j in follows[n, k])
                reasons = [_("It is right given your own {sources}.").format(sources=sources)]
            marks.append(Mark(
                asked.key, state, asked.points if state in ("right", "follows") else 0.0, asked.points,
                complex(written.value[n, k]) if there else None, complex(wanted.value[n, k]),
                bool(written.size[n, k]), float(wanted.scale[n, k]), float(error[n, k]) if there else 0.0,
                float(wanted.allowed[n, k]), how.get((n, k), ""), tuple(reasons),
                tuple(claim.called for claim in named), given.text if given else "",
            ))  # fmt: skip
        found.append(StudentMarks(submission.student, tuple(marks), submission.problems))
    return found
