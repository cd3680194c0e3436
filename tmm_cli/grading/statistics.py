"""Statistics of a group: distribution of points, hardest quantities, most frequent mistakes."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from tmm_cli.batch import Task
from tmm_cli.grading.record import State, StudentMarks
from tmm_cli.grading.untrusted_tables import printable_sentence, printable_text
from tmm_cli.language import _
from tmm_cli.mechanics.numerics import Real
from tmm_cli.mechanics.quantities import NUMBER
from tmm_cli.reports import Column, Table, text_table

STEP = 10  # per cent: a bar of the histogram


@dataclass
class Difficulty:
    """Results of the group for one quantity, at all requested positions together.

    Attributes:
        name: name of the quantity.
        answers: number of answers by state (right, follows, repeated, wrong, missing).
        points, of: points earned and available.
    """

    name: str
    answers: Counter[State] = field(default_factory=Counter)
    points: float = 0.0
    of: float = 0.0

    @property
    def share(self) -> float:
        """Fraction of the available points that was earned; if the task gives no points, the fraction of right
        answers.
        """
        if self.of:
            return self.points / self.of
        earned = self.answers.total() - self.answers["wrong"] - self.answers["missing"]
        return earned / max(1, self.answers.total())


def select_handed_in(marks: Sequence[StudentMarks]) -> list[StudentMarks]:
    """Return the students who gave at least one answer."""
    return [student for student in marks if any(mark.state != "missing" for mark in student.marks)]


def percents_of_points(marks: Sequence[StudentMarks]) -> Real:
    """Return the points of each student who handed in answers, in per cent of the maximum."""
    return np.array([100 * student.points / student.of for student in select_handed_in(marks) if student.of])


def count_by_points(marks: Sequence[StudentMarks]) -> Real:
    """Return the numbers of students with 0 to 10 %, 10 to 20 %, ... of the points; the last range includes 100 %."""
    return np.histogram(np.round(percents_of_points(marks), 6), np.arange(0, 101, STEP))[0]


def rank_difficulties(task: Task, marks: Sequence[StudentMarks]) -> list[Difficulty]:
    """Return the results for each quantity, the hardest quantity first."""
    found = {asked.quantity.name: Difficulty(asked.quantity.name) for asked in task.asked}
    for student in select_handed_in(marks):
        for mark in student.marks:
            own = found[mark.key[0]]
            own.answers[mark.state] += 1
            own.points += mark.points
            own.of += mark.of
    return sorted(found.values(), key=lambda own: round(own.share, 9))


def rank_mistakes(marks: Sequence[StudentMarks]) -> list[tuple[str, int, int]]:
    """Return the mistakes, the most frequent first: name, number of students, number of answers."""
    students: defaultdict[str, set[int]] = defaultdict(set)
    answers = Counter[str]()
    for n, student in enumerate(marks):
        for mark in student.marks:
            for mistake in mark.mistakes:
                students[mistake].add(n)
                answers[mistake] += 1
    found = [(name, len(own), answers[name]) for name, own in students.items()]
    return sorted(found, key=lambda one: (-one[1], -one[2], one[0]))


def statistics_tables(task: Task, marks: Sequence[StudentMarks]) -> Iterator[Table]:
    """Yield the tables with the statistics of a group; empty tables are omitted."""
    own = percents_of_points(marks)
    absent = len(marks) - len(select_handed_in(marks))
    notes = [_("students: {count}").format(count=len(marks))]
    notes += [_("students without any answer (not counted): {count}").format(count=absent)] if absent else []
    if own.size:
        rows = {
            _("highest score"): own.max(),
            _("upper quartile"): np.quantile(own, 0.75),
            _("median"): np.median(own),
            _("mean"): own.mean(),
            _("lower quartile"): np.quantile(own, 0.25),
            _("lowest score"): own.min(),
        }
        shares = _number_column(_("points, %"), np.round(list(rows.values()), 1))
        yield Table(
            "group",
            _("Group"),
            (Column(_("scores of the students who handed in answers"), list(rows)), shares),
            notes=tuple(notes),
        )
        ranges = [f"{low} - {low + STEP} %" for low in range(0, 100, STEP)]
        yield Table(
            "histogram",
            _("Points"),
            (Column(_("score"), ranges), _number_column(_("students"), count_by_points(marks))),
        )
        yield _difficulty_table(rank_difficulties(task, marks))
    mistakes = rank_mistakes(marks)
    if mistakes:
        names, students, answers = zip(*mistakes, strict=True)
        counts = _number_column(_("students"), students), _number_column(_("answers"), answers)
        yield Table("mistakes", _("Most frequent mistakes"), (Column(_("mistake"), list(names)), *counts))
    copied = [
        (
            printable_text(student.student),
            printable_text(student.copied),
            ", ".join(map(printable_text, student.shared)),
        )
        for student in marks
        if student.copied
    ]
    if copied:
        yield text_table(
            "copies",
            _("Answers that match another student's variant"),
            (_("student"), _("student whose variant the answers match"), _("answers equal to those of that student")),
            copied,
        )
    unread = [
        (printable_text(student.student), printable_sentence(problem))
        for student in marks
        for problem in student.problems
    ]
    if unread:
        yield text_table("problems", _("Problems with the submissions"), (_("student"), _("reason")), unread)


def _difficulty_table(found: Sequence[Difficulty]) -> Table:
    states: dict[str, State] = {
        _("right, %"): "right",
        _("error carried forward, %"): "follows",
        _("same mistake again, %"): "repeated",
        _("wrong, %"): "wrong",
        _("answers missing, %"): "missing",
    }
    columns = [
        Column(_("quantity"), [own.name for own in found]),
        _number_column(_("points earned, %"), [round(100 * own.share, 1) for own in found]),
    ]
    for header, state in states.items():
        shares = [round(100 * own.answers[state] / max(1, own.answers.total()), 1) for own in found]
        columns.append(_number_column(header, shares))
    return Table("hardest", _("Hardest quantities"), tuple(columns))


def _number_column(header: str, values: object) -> Column:
    return Column(header, np.asarray(values, dtype=float), NUMBER)
