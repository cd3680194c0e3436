"""CSV files: marks.csv (a row per student), answers.csv (a row per answer), moodle.csv for the gradebook of Moodle."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from tmm_cli.grading.exports.book import (
    ANSWERS_HEADER,
    Cell,
    Gradebook,
    answers_rows,
    marks_header,
    marks_rows,
    points_text,
    round_points,
)
from tmm_cli.grading.record import Mark
from tmm_cli.grading.untrusted_tables import printable_text
from tmm_cli.reports import csv_cell


def csv_tables(book: Gradebook) -> Iterator[tuple[str, Iterable[str]]]:
    """Yield marks.csv and answers.csv with their lines."""
    yield "marks.csv", csv_lines(book, marks_header(book), marks_rows(book))
    yield "answers.csv", csv_lines(book, ANSWERS_HEADER, answers_rows(book))


def csv_lines(book: Gradebook, header: Sequence[str], rows: Iterable[Sequence[Cell]]) -> Iterator[str]:
    """Yield the lines of a CSV table.

    If the gradebook uses decimal commas, cells are separated by semicolons, and a byte-order mark comes first.
    """
    comma = book.decimal == ","
    between = ";" if comma else ","
    yield ("\ufeff" if comma else "") + between.join(map(csv_cell, header)) + "\n"
    for row in rows:
        yield between.join([_cell(cell, comma) for cell in row]) + "\n"


def _cell(cell: Cell, comma: bool) -> str:
    if isinstance(cell, str):
        return csv_cell(cell)
    if cell is None:
        return ""
    number = points_text(cell.points) if isinstance(cell, Mark) else f"{cell:.10g}"
    number = number.replace(".", ",") if comma else number
    return f"{number} {cell.state}" if isinstance(cell, Mark) else number


def moodle_file(book: Gradebook) -> Iterator[tuple[str, Iterable[str]]]:
    """Yield moodle.csv with the points of each student, who is named as in the teacher's list (login, id or e-mail)."""
    known = [one for one in book.marks if book.users is None or one.student in book.users]
    rows = ((printable_text(student.student), round_points(student.points)) for student in known)
    yield "moodle.csv", csv_lines(book, ("user", "grade"), rows)
