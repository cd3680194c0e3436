"""Tables of variants in CSV and XLSX, with a row per student and a column per parameter."""

from __future__ import annotations

import io
import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from tmm_cli.batch import NUMBER_WITH_UNIT, Task
from tmm_cli.grading.record import VariantTable
from tmm_cli.grading.untrusted_tables import read_rows
from tmm_cli.language import _
from tmm_cli.problem import ProblemError, parse_unit, prefix_errors, quote, unknown_name_error
from tmm_cli.reports import csv_cell, open_workbook

LARGEST, MOST_ROWS = 20_000_000, 200_000  # bytes, rows: of all students of a course
WHO = ("student", "name", "студент", "фио", "имя", "student name", "ime", "ime i prezime", "prezime i ime")
WHICH = ("variant", "вариант", "varijanta", "no", "no.", "n", "№", "#", "br", "br.", "id")
HEADING = re.compile(r"(.*?)\s*(?:,\s*(.+)|\[(.+)\]|\((.+)\))?")
COMMA = re.compile(r"(?<![\d.,])(\d+),(\d+)(?![\d.,])")
MINUS = str.maketrans("−–\u2012\u2011", "----", "\xa0\u202f")
FORMULA = re.compile(r"\A'(?=[=+\-@\t\r])")  # what is written so that no spreadsheet runs it


def read_table(path: Path | str, task: Task) -> VariantTable:
    """Read a table of variants with a header row; without a column of students, variants are numbered from 1.

    Raises:
        ProblemError: The table is wrong.
    """
    rows = read_rows(path, LARGEST, MOST_ROWS)
    try:
        return _parse_table(rows, task)
    except ProblemError as error:
        raise error.located(str(path)) from None


def read_students(path: Path | str) -> tuple[str, ...]:
    """Read the names of students from the column `student`, or from the first column. A name that is repeated is read
    once.

    Raises:
        ProblemError: The table contains no names.
    """
    head, *rows = read_rows(path) or [[]]
    at = _find_column(head, WHO)
    rows = rows if at is not None else [head, *rows]
    names = [FORMULA.sub("", row[at or 0]) for row in rows if len(row) > (at or 0)]
    found = tuple(dict.fromkeys(" ".join(name.split()) for name in names if name))
    if not found:
        raise ProblemError(
            _("the table contains no names of students"), allowed=_("a name in each row"), file=str(path)
        )
    return found


def find_variant(table: VariantTable, asked: str) -> dict[str, str]:
    """Return the parameter values of one variant by parameter name.

    Args:
        table: Variants.
        asked: Name of a student, or number of the variant, counted from 1.

    Raises:
        ProblemError: There is no such variant.
    """
    students = list(table.rows)
    if asked not in table.rows and asked.isascii() and asked.isdigit() and 1 <= int(asked[:9]) <= len(students):
        asked = students[int(asked) - 1]
    if asked not in table.rows:
        allowed = _("a number from 1 to {last}, or the name of a student in the table").format(last=len(students))
        raise unknown_name_error(asked, students, _("unknown variant"), allowed)
    return dict(zip(table.names, table.rows[asked], strict=True))


def csv_bytes(rows: Iterable[Sequence[str]]) -> bytes:
    """Return rows of cells as the contents of a CSV file with a byte-order mark."""
    lines = (",".join(csv_cell(cell) for cell in row) for row in rows)
    return ("\ufeff" + "".join(f"{line}\n" for line in lines)).encode()


def xlsx_bytes(sheets: dict[str, Sequence[Sequence[str]]]) -> bytes | None:
    """Return the contents of an XLSX file without formulas and links; None if no package that writes XLSX is installed.

    sheets: rows of cells by the name of the worksheet.
    """
    stream = io.BytesIO()
    try:
        found = open_workbook("variants.xlsx", stream, {"in_memory": True})
    except ProblemError:
        return None
    with found as book:
        bold = book.add_format({"bold": True})
        for name, rows in sheets.items():
            sheet = book.add_worksheet(name)
            sheet.freeze_panes(1, 1)
            sheet.set_column(0, 0, max((min(len(row[0]), 40) for row in rows), default=8) + 2)
            for n, row in enumerate(rows):
                for k, cell in enumerate(row):
                    _write_cell(sheet, n, k, cell, bold if n == 0 else None)
    return stream.getvalue()


def _write_cell(sheet: Any, n: int, k: int, cell: str, form: Any) -> None:
    if n and k and re.fullmatch(r"-?\d+(\.\d+)?(e[-+]?\d+)?", cell):
        sheet.write_number(n, k, float(cell))
    else:
        sheet.write_string(n, k, cell, form)


def variant_table_rows(table: VariantTable) -> list[list[str]]:
    """Return a table of variants as rows of cells with a header; a unit common to a column is put in its heading."""
    columns = []
    for k, name in enumerate(table.names):
        texts = [row[k] for row in table.rows.values()]
        parts = [NUMBER_WITH_UNIT.fullmatch(text) for text in texts]
        units = {part[2] if part else None for part in parts}
        unit = units.pop() if len(units) == 1 else None
        alone = [part[1] for part in parts if part] if unit else texts
        columns.append([f"{name}, {unit}" if unit else name, *alone])
    return [list(row) for row in zip(["student", *table.rows], *columns, strict=True)]


def _find_column(head: Sequence[str], names: Sequence[str]) -> int | None:
    return next((k for k, text in enumerate(head) if text.casefold() in names), None)


def _parse_table(rows: list[list[str]], task: Task) -> VariantTable:
    if len(rows) < 2:
        raise ProblemError(_("expected a header row and one row for each variant"), allowed="student;OA, mm;n1, rpm")
    head, *rest = rows
    who, which = _find_column(head, WHO), _find_column(head, WHICH)
    key = which if who is None else who
    columns = [(k, *_split_heading(text)) for k, text in enumerate(head) if k not in (who, which) and text]
    names = tuple(name for _k, name, _unit in columns)
    dimensions = task.dimensions(names)
    if len(set(names)) < len(names):
        twice = next(name for name in names if names.count(name) > 1)
        raise ProblemError(_("two columns have the same name"), found=quote(twice))
    found: dict[str, tuple[str, ...]] = {}
    for number, row in enumerate(rest, 2):
        cells = [*row, *[""] * (len(head) - len(row))]
        student = str(number - 1) if key is None else FORMULA.sub("", " ".join(cells[key].split()))
        with prefix_errors(_("row {number}").format(number=number)):
            if not student or student in found:
                raise ProblemError(
                    _("each row must name a different student"),
                    found=quote(student),
                    allowed=_("a name that occurs only once"),
                )
            found[student] = tuple(
                _parse_cell(task, name, cells[k], unit, dimension)
                for (k, name, unit), dimension in zip(columns, dimensions, strict=True)
            )
    return VariantTable(names, found)


def _split_heading(text: str) -> tuple[str, str]:
    """Split the heading of a column into the parameter name and the unit."""
    found = HEADING.fullmatch(text)
    assert found is not None
    unit = found[2] or found[3] or found[4] or ""
    if unit:
        with prefix_errors(text):
            parse_unit(unit)
    return found[1], unit


def _parse_cell(task: Task, name: str, cell: str, unit: str, dimension: Any) -> str:
    """Return a cell as a parameter value of a problem file, with the unit of the column if the cell has none."""
    text = COMMA.sub(r"\1.\2", cell.translate(MINUS))
    with prefix_errors(name):
        if not text:
            raise ProblemError(_("expected a value"), found=_("an empty cell"))
        value = task.value(text)
        if unit and value.dimension is None:
            text = f"{text} {unit}"
            value = task.value(text)
        if dimension and value.dimension and not value.dimension.fits(dimension):
            raise ProblemError(
                _("expected here: {want}").format(want=dimension), found=quote(cell), allowed=dimension.example
            )
    return text
