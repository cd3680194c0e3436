"""Tables for spreadsheets: rounded as on the terminal, in the current language.

A workbook has a sheet for each table. Local CSV files have semicolons and decimal commas, as in most of Europe. For
further calculation use result.json and the other CSV files, which contain all correct digits.
"""

from __future__ import annotations

import io
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from datetime import datetime
from io import BytesIO
from typing import Any, Final, Literal

from tmm_cli.language import _, half_up, typeset
from tmm_cli.problem import ProblemError, UnitSystem, typeset_unit
from tmm_cli.reports.table import Column, Table, csv_cell
from tmm_cli.reports.terminal import printed_figures

INSTALL_COMMAND: Final = "pip install 'tmm-cli[excel]'"
CREATED: Final = datetime(2000, 1, 1)  # the same tables give the same bytes
WORKBOOK_OPTIONS: Final = {
    "constant_memory": True,
    "strings_to_formulas": False,
    "strings_to_urls": False,
    "strings_to_numbers": False,
}


def open_workbook(
    file: str, stream: BytesIO, options: Mapping[str, bool] = WORKBOOK_OPTIONS, allowed: str = INSTALL_COMMAND
) -> Any:
    """Return an xlsxwriter workbook that writes into a stream.

    Args:
        file: name of the file, for an error message.
        stream: stream that receives the bytes of the file.
        options: options of xlsxwriter.
        allowed: command that installs xlsxwriter, for an error message.

    Raises:
        ProblemError: xlsxwriter is not installed.
    """
    try:
        from xlsxwriter import Workbook
    except ImportError:
        raise ProblemError(
            _("writing {file} requires xlsxwriter, which is not installed").format(file=file), allowed=allowed
        ) from None
    return Workbook(stream, dict(options))


SpreadsheetKind = Literal["xlsx", "csv-local"]
Cell = str | float | None
Files = Iterator[tuple[str, Iterable[str | bytes]]]

NUMBER_IN_TEXT = re.compile(
    r"-?(0|[1-9]\d{0,14})([.,]\d+)?(e[+-]?\d{1,2})?"
)  # in a column of words: a position, a value
MOST_ROWS = 1_000_000  # of a sheet; the format has 48 576 more
WIDTHS = 8.0, 60.0  # of columns, letters: at least, at most
HEAD_HEIGHT = 32  # points: two lines
LONGEST_NAME, FORBIDDEN = 31, re.compile(r"[\[\]:*?/\\']")  # of sheets


def spreadsheet_files(kind: SpreadsheetKind, tables: Iterable[Table], units: UnitSystem) -> Files:
    """Yield the name and the content of each spreadsheet file; the content is an iterable of pieces.

    Raises:
        ProblemError: xlsxwriter is not installed.
    """
    if kind == "xlsx":
        yield "tables.xlsx", (write_workbook(tables, units),)
        return
    for table in tables:
        yield f"{table.name}-local.csv", local_csv(table, units)


def spreadsheet_cells(column: Column, units: UnitSystem) -> list[Cell]:
    """Return the cells of a column for a spreadsheet.

    Numbers are rounded as on the terminal, texts are unchanged, and empty cells are None.
    """
    if column.dimension is None:
        return [_word_cell(str(value)) for value in column.values]
    values = column.numbers(units).tolist()
    return [_number_cell(value, n) for value, n in zip(values, printed_figures(column, units).tolist(), strict=True)]


def _word_cell(text: str) -> Cell:
    if not text:
        return None
    return float(text.replace(",", ".")) if NUMBER_IN_TEXT.fullmatch(text) else typeset(text)


def _number_cell(value: float, count: int) -> float | None:
    if count < 0:
        return None
    return float(f"{half_up(value):.{count}g}") + 0.0 if count else 0.0


def local_csv(table: Table, units: UnitSystem) -> Iterator[str]:
    """Yield the lines of a table as local CSV; a byte order mark makes spreadsheets read it as UTF-8."""
    yield "\ufeff" + ";".join(csv_cell(typeset(typeset_unit(column.heading(units)))) for column in table.columns) + "\n"
    for row in zip(*(spreadsheet_cells(column, units) for column in table.columns), strict=True):
        yield ";".join(map(_cell_text, row)) + "\n"


def _cell_text(cell: Cell) -> str:
    if isinstance(cell, float):
        return f"{cell:.15g}".replace(".", ",")
    return "" if cell is None else csv_cell(cell)


def write_workbook(tables: Iterable[Table], units: UnitSystem) -> bytes:
    """Return the bytes of a workbook with a sheet for each table. No text becomes a formula or a link."""
    stream = io.BytesIO()
    with open_workbook("tables.xlsx", stream) as book:
        book.set_properties({"created": CREATED})
        formats = {
            "title": book.add_format({"bold": True, "font_size": 12}),
            "words": book.add_format({"align": "left", "indent": 1}),
            "head": book.add_format({"bold": True, "bottom": 1, "text_wrap": True, "valign": "top", "indent": 1}),
            "head of numbers": book.add_format(
                {"bold": True, "bottom": 1, "text_wrap": True, "valign": "top", "align": "right"}
            ),
            "note": book.add_format({"italic": True, "font_color": "#555555"}),
        }
        taken: set[str] = set()
        for table in tables:
            _write_sheet(book.add_worksheet(_sheet_name(table.title, taken)), table, units, formats)
    return stream.getvalue()


def _write_sheet(sheet: Any, table: Table, units: UnitSystem, formats: Mapping[str, Any]) -> None:
    """Write the title, headings, rows and notes of a table to a sheet."""
    heads = [typeset(typeset_unit(column.heading(units))) for column in table.columns]
    columns = [spreadsheet_cells(column, units)[:MOST_ROWS] for column in table.columns]
    for k, (head, column) in enumerate(zip(heads, columns, strict=True)):
        sheet.set_column(k, k, _column_width(head, column))
    sheet.freeze_panes(2, 1)
    sheet.set_landscape()
    sheet.set_paper(9)  # A4
    sheet.fit_to_pages(1, 0)
    sheet.repeat_rows(1)
    sheet.write_string(0, 0, table.title, formats["title"])
    sheet.set_row(1, HEAD_HEIGHT)
    words = [column.dimension is None for column in table.columns]
    for k, head in enumerate(heads):
        sheet.write_string(1, k, head, formats["head" if words[k] else "head of numbers"])
    for n, row in enumerate(zip(*columns, strict=True), 2):
        for k, cell in enumerate(row):
            if isinstance(cell, float):
                sheet.write_number(n, k, cell, formats["words"] if words[k] else None)
            elif cell is not None:
                sheet.write_string(n, k, cell, formats["words"])
    for n, note in enumerate(table.notes, 3 + min(table.rows, MOST_ROWS)):
        sheet.write_string(n, 0, typeset(note), formats["note"])


def _column_width(head: str, column: Sequence[Cell]) -> float:
    """Return a column width (characters) that fits the longest word of the heading and every cell, within WIDTHS."""
    longest = max((len(_cell_text(cell)) for cell in column), default=0)
    word = max(map(len, head.split()), default=0)
    least, most = WIDTHS
    return min(max(least, longest + 3, word + 3, len(head) / 1.6), most)


def _sheet_name(title: str, taken: set[str]) -> str:
    """Derive a valid name of a worksheet from a title.

    The name differs from all names in `taken` and is added to them.
    """
    name = " ".join(FORBIDDEN.sub(" ", title.partition(":")[0]).split())
    if len(name) > LONGEST_NAME:
        name = name[: LONGEST_NAME - 4].rpartition(" ")[0] or name[: LONGEST_NAME - 4]
        name = re.sub(r"( \w{1,3})+$", "", name)  # not "Balance of powers and"
    name = name.rstrip(",;. ") or "-"
    names = (name if n == 1 else f"{name} {n}" for n in range(1, len(taken) + 2))
    unused = next(candidate for candidate in names if candidate.casefold() not in taken)
    taken.add(unused.casefold())
    return unused
