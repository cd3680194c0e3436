"""The two tables of a gradebook, row by row: a student a row, and an answer a row."""

from __future__ import annotations

import math
from collections.abc import Iterator

from tmm_cli.grading.exports.book import Answer, Gradebook, direction, percent, rounded
from tmm_cli.grading.record import Mark, StudentMarks
from tmm_cli.grading.shown import sentence, shown
from tmm_cli.language import _

Cell = str | float | None | Mark  # a mark: its points, and its state beside them or as a colour


def marks_header(book: Gradebook) -> list[str]:
    """Of a table with a column an answer."""
    return ["student", "points", "of", "percent", *(answer.name for answer in book.answers), "notes"]


def marks_rows(book: Gradebook) -> Iterator[list[Cell]]:
    """A row a student."""
    for student in book.marks:
        points = rounded(student.points), rounded(student.of), percent(student)
        yield [shown(student.student), *points, *student.marks, _notes(student)]


def _notes(student: StudentMarks) -> str:
    """For the teacher."""
    copied = (_("the answers fit the variant of {student}").format(student=shown(student.copied)),)
    return "; ".join((*map(sentence, student.problems), *(copied if student.copied else ())))


ANSWERS_HEADER = (
    "student", "quantity", "position", "written", "value", "direction, deg", "right value", "right direction, deg",
    "unit", "error, %", "allowed, %", "state", "points", "of", "unit read", "reasons",
)  # fmt: skip


def answers_rows(book: Gradebook) -> Iterator[list[Cell]]:
    """A row an answer; values in the units of the file, those of a vector as size and direction."""
    for student in book.marks:
        name = shown(student.student)
        for answer, mark in zip(book.answers, student.marks, strict=True):
            right, allowed = (mark.right, mark.allowed) if mark.judged else (None, None)
            error = None if mark.value is None else mark.error
            yield [
                name, answer.asked.quantity.name, answer.asked.number, shown(mark.text),
                *_value(answer, mark.value, mark.size), *_value(answer, right), answer.unit, _percent(error),
                _percent(allowed), mark.state, rounded(mark.points), rounded(mark.of), mark.reading, reasons(mark),
            ]  # fmt: skip


def _value(answer: Answer, value: complex | None, size: bool = False) -> tuple[Cell, Cell]:
    if value is None:
        return None, None
    number = answer.number(value) / answer.scale + 0.0
    turned = answer.asked.quantity.vector and not size
    return finite(number), finite(round(direction(value), 2)) if turned else None


def _percent(share: float | None) -> float | None:
    return None if share is None else finite(100 * share)


def finite(number: float) -> float | None:
    """To six figures; nothing where it is no number."""
    return float(f"{number:.6g}") if math.isfinite(number) else None


def reasons(mark: Mark) -> str:
    """All sentences of a mark."""
    return " ".join(map(sentence, mark.reasons))
