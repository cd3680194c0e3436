"""Gradebook with the marks of all students, and the texts of its tables that all output formats share."""

from __future__ import annotations

import cmath
import math
import unicodedata
from collections import Counter
from collections.abc import Callable, Container, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Literal

from tmm_cli.batch import Question, Task
from tmm_cli.grading.record import Mark, StudentMarks, si_factor
from tmm_cli.grading.untrusted_tables import printable_sentence, printable_text
from tmm_cli.language import N_, _, numeral, spelt
from tmm_cli.problem import typeset_unit
from tmm_cli.reports import folder_name

STATES = {
    "right": N_("right"),
    "follows": N_("right with your earlier values"),
    "repeated": N_("the same mistake again"),
    "wrong": N_("wrong"),
    "missing": N_("no answer"),
}


@dataclass(frozen=True)
class Answer:
    """A requested answer as it appears in the output formats.

    Attributes:
        asked: the question.
        name: name of the quantity with the position number.
        unit: unit in which values are written.
        scale: this unit in SI.
    """

    asked: Question
    name: str
    unit: str
    scale: float

    def text(self, value: complex, unit: str = "", size: bool = False) -> str:
        """Return a value (SI) as text with its unit; a vector by magnitude and direction, e.g. `1.31 m/s at 35°`.

        Args:
            value: Value, SI.
            unit: Unit to write it in; by default that of the answer.
            size: True if only the magnitude of a vector is known.
        """
        scale = si_factor(unit, self.asked.quantity.dimension) if unit else self.scale
        number = f"{numeral(self.number(value) / scale + 0.0, '.5g')} {typeset_unit(spelt(unit or self.unit))}".rstrip()
        if not self.asked.quantity.vector or size:
            return number
        return _("{size} at {direction}°").format(size=number, direction=numeral(direction(value), ".4g"))

    def number(self, value: complex) -> float:
        """Return a value (SI) as one real number: the magnitude of a vector, otherwise the value itself."""
        return abs(value) if self.asked.quantity.vector else value.real

    @property
    def reference_name(self) -> str:
        """Name of the quantity to which relative errors refer, e.g. "the largest value in the cycle"."""
        return _(OF[self.asked.quantity.against])


OF = {
    "largest": N_("the largest value in the cycle"),
    "range": N_("the whole range of motion"),
    "angle": N_("one radian"),
    "exact": "",
}


@dataclass(frozen=True)
class Gradebook:
    """Marks of all students for one task.

    Attributes:
        task: the task.
        marks: marks of each student, in the order of the task's questions.
        decimal: decimal mark of CSV files; with a comma, cells are separated by semicolons.
        users: students on the teacher's list; the file for Moodle omits all others. None: no list, all are included.
    """

    task: Task
    marks: Sequence[StudentMarks]
    decimal: Literal[".", ","] = "."
    users: Container[str] | None = None

    @property
    def title(self) -> str:
        return self.task.problem.title

    @cached_property
    def answers(self) -> tuple[Answer, ...]:
        units = self.task.units
        return tuple(
            Answer(asked, asked.name, units.symbol(dimension), units.factor(dimension))
            for asked in self.task.asked
            for dimension in (asked.quantity.dimension,)
        )

    @cached_property
    def files(self) -> tuple[str, ...]:
        """File name for each student, without extension. All names differ, even where case is ignored."""
        taken: set[str] = set()
        found, count = [], Counter[str]()
        for student in self.marks:
            base = name = unicodedata.normalize("NFC", folder_name(student.student))
            while name.casefold() in taken:
                count[base] += 1
                name = f"{base}-{count[base] + 1}"
            taken.add(name.casefold())
            found.append(name)
        return tuple(found)


Export = Callable[[Gradebook], Iterable[tuple[str, Iterable[str | bytes]]]]  # files by name, piece by piece


@lru_cache(maxsize=1024)
def points_text(points: float) -> str:
    """Return a number of points as text, e.g. 4 or 3.5."""
    return f"{round_points(points):.10g}"


def round_points(points: float) -> float:
    """Round points to three decimals."""
    return round(points, 3) + 0.0


def percent_of_points(student: StudentMarks) -> float | None:
    """Return a student's points in per cent of the maximum, or None if the maximum is zero."""
    return round(100 * student.points / student.of, 1) if student.of else None


def share_text(share: float) -> str:
    """Return a fraction in per cent with two significant figures: 0.51 %, 5.1 %, 51 %."""
    if not share < 10:  # nan too
        return _("more than 999 %")
    return f"{100 * share:.0f} %" if share >= 0.0995 else f"{numeral(100 * share, '.2g')} %"


def direction(value: complex) -> float:
    """Return the direction of a vector in degrees, from 0 up to 360, counterclockwise from the x axis."""
    found = math.degrees(cmath.phase(value)) % 360
    return 0.0 if found >= 359.95 else found


def earns_points(mark: Mark) -> bool:
    """Return True if the answer earns its points.

    It does if it is right, if it follows correctly from wrong earlier answers, or if it is wrong only because of a
    mistake that already cost points.
    """
    return mark.state in ("right", "follows", "repeated")


# The two tables of a gradebook, row by row: a student a row, and an answer a row.


Cell = str | float | None | Mark  # a mark: its points, and its state beside them or as a colour


def marks_header(book: Gradebook) -> list[str]:
    """Return the header of the table of marks, which has a row per student and a column per answer."""
    return ["student", "points", "of", "percent", *(answer.name for answer in book.answers), "notes"]


def marks_rows(book: Gradebook) -> Iterator[list[Cell]]:
    """Yield the rows of the table of marks, one per student."""
    for student in book.marks:
        points = round_points(student.points), round_points(student.of), percent_of_points(student)
        yield [printable_text(student.student), *points, *student.marks, _notes(student)]


def _notes(student: StudentMarks) -> str:
    """Return the notes on a student for the teacher: what could not be read, and whose variant the answers fit."""
    name, shared = printable_text(student.copied), ", ".join(map(printable_text, student.shared))
    copied = (_("the answers match the variant of {student}").format(student=name),)
    if shared:
        copied = (_("the same answers as {student}: {answers}").format(student=name, answers=shared),)
    return "; ".join((*map(printable_sentence, student.problems), *(copied if student.copied else ())))


ANSWERS_HEADER = (
    "student",
    "quantity",
    "position",
    "written",
    "value",
    "direction, deg",
    "right value",
    "right direction, deg",
    "unit",
    "error, %",
    "allowed, %",
    "state",
    "points",
    "of",
    "unit read",
    "reasons",
    "mistakes",
)


def answers_rows(book: Gradebook) -> Iterator[list[Cell]]:
    """Yield the rows of the table of answers, one per answer of each student.

    Values are in the units of the task file; vectors are given by magnitude and direction.
    """
    for student in book.marks:
        name = printable_text(student.student)
        for answer, mark in zip(book.answers, student.marks, strict=True):
            right, allowed = (mark.right, mark.allowed) if mark.is_judged else (None, None)
            error = None if mark.value is None else mark.error
            yield [
                name,
                answer.asked.quantity.name,
                answer.asked.number,
                printable_text(mark.text),
                *_value(answer, mark.value, mark.size),
                *_value(answer, right),
                answer.unit,
                _percent(error),
                _percent(allowed),
                mark.state,
                round_points(mark.points),
                round_points(mark.of),
                mark.reading,
                join_reasons(mark),
                "; ".join(mark.identifiers),
            ]


def _value(answer: Answer, value: complex | None, size: bool = False) -> tuple[Cell, Cell]:
    if value is None:
        return None, None
    number = answer.number(value) / answer.scale + 0.0
    turned = answer.asked.quantity.vector and not size
    return round_if_finite(number), round_if_finite(round(direction(value), 2)) if turned else None


def _percent(share: float | None) -> float | None:
    return None if share is None else round_if_finite(100 * share)


def round_if_finite(number: float) -> float | None:
    """Return a number rounded to six significant figures; None if it is infinite or nan."""
    return float(f"{number:.6g}") if math.isfinite(number) else None


def join_reasons(mark: Mark) -> str:
    """Join the sentences that explain a mark into one text."""
    return " ".join(map(printable_sentence, mark.reasons))
