"""Workbook marks.xlsx: marks, answers and statistics. Texts are never written as formulas or links."""

from __future__ import annotations

import io
from collections.abc import Iterable, Iterator, Sequence
from itertools import count, islice
from typing import Any

import numpy as np

from tmm_cli.grading.exports.book import (
    Cell,
    Gradebook,
    join_reasons,
    marks_header,
    marks_rows,
    round_if_finite,
    round_points,
)
from tmm_cli.grading.exports.feedback import answer_text
from tmm_cli.grading.record import Mark
from tmm_cli.grading.statistics import statistics_tables
from tmm_cli.grading.untrusted_tables import printable_text
from tmm_cli.mechanics.quantities import NUMBER
from tmm_cli.reports import CREATED, Column, open_workbook

MOST_ROWS = 1_000_000  # of a sheet; the format has 48 576 more
COLOURS = {"right": "#d9efdf", "follows": "#fdebc8", "repeated": "#fdebc8", "wrong": "#f8d7d4", "missing": "#ececec"}
MARKS_WIDTH, ANSWERS_WIDTHS = 13.0, (16.0, 24.0, 24.0, 9.0, 8.0)  # of columns between the first and the last, letters
ANSWERS_HEADER = ("student", "asked", "answer", "right value", "error, %", "points", "reasons")
HEAD_HEIGHT = 32  # points: two lines


def xlsx_file(book: Gradebook) -> Iterator[tuple[str, Iterable[bytes]]]:
    """Yield marks.xlsx with its contents."""
    yield "marks.xlsx", (_workbook(book),)


def _workbook(book: Gradebook) -> bytes:
    """Return the contents of marks.xlsx.

    Raises:
        ProblemError: No package that writes XLSX is installed.
    """
    stream = io.BytesIO()
    with open_workbook("marks.xlsx", stream) as workbook:
        workbook.set_properties({"created": CREATED, "title": "marks"})
        formats = {name: workbook.add_format({"bg_color": colour}) for name, colour in COLOURS.items()}
        head = workbook.add_format({"bold": True, "bottom": 1, "text_wrap": True, "valign": "top"})
        marks = marks_header(book)
        _write_table(workbook, "Marks", marks, marks_rows(book), formats, head, [MARKS_WIDTH] * (len(marks) - 2))
        _write_table(workbook, "Answers", ANSWERS_HEADER, _answer_rows(book), formats, head, ANSWERS_WIDTHS)
        _write_statistics(workbook, book, head)
    return stream.getvalue()


def _answer_rows(book: Gradebook) -> Iterator[list[Cell]]:
    """Yield the rows of the sheet of answers: fewer columns than in answers.csv, values as texts for reading."""
    for student in book.marks:
        name = printable_text(student.student)
        for answer, mark in zip(book.answers, student.marks, strict=True):
            value = answer.text(mark.right) if mark.is_judged else ""
            error = round_if_finite(float(f"{100 * mark.error:.3g}")) if mark.value is not None else None
            yield [name, answer.name, answer_text(answer, mark), value, error, mark, join_reasons(mark)]


def _write_table(
    workbook: Any,
    name: str,
    header: Sequence[str],
    rows: Iterable[Sequence[Cell]],
    formats: dict[str, Any],
    head: Any,
    widths: Sequence[float],
) -> None:
    """Write a table to a worksheet; rows beyond MOST_ROWS continue on further worksheets."""
    rows = iter(rows)
    for number in count(1):
        some = islice(rows, MOST_ROWS)
        first = next(some, None)
        if first is None and number > 1:
            return
        sheet = workbook.add_worksheet(name if number == 1 else f"{name} {number}")
        sheet.freeze_panes(1, 1)
        for k, width in enumerate((24.0, *widths, 60.0)):
            sheet.set_column(k, k, width)
        sheet.set_landscape()
        sheet.fit_to_pages(1, 0)  # as wide as a page, as long as it takes
        sheet.repeat_rows(0)
        sheet.set_row(0, HEAD_HEIGHT)
        for k, text in enumerate(header):
            sheet.write_string(0, k, text, head)
        last = 0
        for last, row in enumerate(() if first is None else (first, *some), 1):
            _write_row(sheet, last, row, formats)
        sheet.autofilter(0, 0, last, len(header) - 1)


def _write_row(sheet: Any, at: int, row: Sequence[Cell], formats: dict[str, Any]) -> None:
    for k, cell in enumerate(row):
        if isinstance(cell, str):
            if cell:
                sheet.write_string(at, k, cell)
        elif isinstance(cell, Mark):
            sheet.write_number(at, k, round_points(cell.points), formats[cell.state])
        elif cell is not None:
            sheet.write_number(at, k, cell)


def _write_statistics(workbook: Any, book: Gradebook, head: Any) -> None:
    """Write all statistics tables to the worksheet Group, one below another."""
    sheet, at = workbook.add_worksheet("Group"), 0
    sheet.set_column(0, 0, 40)
    sheet.set_column(1, 7, 18)
    sheet.set_landscape()
    sheet.fit_to_pages(1, 0)
    title = workbook.add_format({"bold": True, "font_size": 13})
    for table in statistics_tables(book.task, book.marks):
        sheet.write_string(at, 0, table.title, title)
        for k, column in enumerate(table.columns):
            sheet.write_string(at + 1, k, column.heading(book.task.units), head)
        for n, row in enumerate(zip(*(_cells(book, column) for column in table.columns), strict=True)):
            _write_row(sheet, at + 2 + n, row, {})
        at += table.rows + 2
        for note in table.notes:
            sheet.write_string(at, 0, note)
            at += 1
        at += 1


def _cells(book: Gradebook, column: Column) -> list[Cell]:
    if column.dimension is None:
        return list(column.values)
    assert column.dimension == NUMBER
    return [v if np.isfinite(v) else None for v in column.numbers(book.task.units).tolist()]
