"""Tables printed on a terminal, in the units of the file."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from rich import box
from rich.console import Console
from rich.table import Table as RichTable
from rich.text import Text

from tmm_cli.language import N_, _, numeral, typeset
from tmm_cli.problem import UnitSystem
from tmm_cli.reports.table import Column, Table

MOST_ROWS = 120  # on a terminal; files have them all
GAP = 3  # between columns
ROUNDING = 1e-13  # of the largest number of a column: less is rounding, and would print untrue digits
MORE_ROWS = N_("... further rows: {rows}; all rows are written with -o DIR and with --json")
MORE_ROWS_AS_JSON = N_("... further rows: {rows}; --json prints all rows")


def terminal_cells(column: Column, units: UnitSystem, rows: Sequence[int]) -> list[str]:
    """Return the cells of a column as texts.

    A missing number becomes a dash; a number that consists only of rounding error becomes 0.
    """
    if column.dimension is None:
        return [typeset(str(column.values[k])) for k in rows]
    values, count = column.numbers(units), printed_figures(column, units)
    return [_number_text(float(values[k]), int(count[k])) for k in rows]


def printed_figures(column: Column, units: UnitSystem) -> Any:
    """Return how many significant figures of each number are printed.

    The result is 0 if the number consists only of rounding error, and -1 if it is missing.
    """
    values, figures = column.numbers(units), column.true_figures(units)
    if figures is None:
        nothing = ROUNDING * np.max(np.abs(values), where=np.isfinite(values), initial=0.0)
        figures = np.where(np.abs(values) <= nothing, 0, 17)
    return np.where(np.isfinite(values), np.minimum(figures, column.digits), -1)


def _number_text(value: float, count: int) -> str:
    if count < 0:
        return "-"
    return numeral(value, f".{count}g") if count else "0"


def print_on_terminal(
    table: Table,
    units: UnitSystem,
    console: Console,
    rows: set[int] | None = None,
    *,
    most: int | None = MOST_ROWS,
    more: str = MORE_ROWS,
) -> None:
    """Print a table; one that is wider than the terminal is printed in parts.

    Args:
        table: table to print.
        units: units of the file.
        console: terminal.
        rows: indices of the rows to print; None: all rows.
        most: largest number of rows; None: no limit.
        more: message about the rows that are not printed, with the field {rows}.
    """
    chosen = [k for k in range(table.rows) if rows is None or k in rows]
    printed = chosen[:most]
    texts = [[typeset(column.heading(units)), *terminal_cells(column, units, printed)] for column in table.columns]
    words = [column.dimension is None for column in table.columns]
    least = [_least_width(*column) for column in zip(texts, words, strict=True)]
    for number, indices in enumerate(_table_parts(words, least, console.width)):
        title = table.title if number == 0 else _("{title} (continued)").format(title=table.title)
        rich_table = RichTable(title=Text(title), title_justify="left", box=box.SIMPLE_HEAD, pad_edge=False)
        wide = [max(map(len, texts[k])) for k in indices]
        for k, width in zip(indices, _column_widths(wide, [least[k] for k in indices], console.width), strict=True):
            rich_table.add_column(Text(texts[k][0]), justify="left" if words[k] else "right", width=width)
        for row in range(1, len(printed) + 1):
            rich_table.add_row(*(Text(texts[k][row]) for k in indices))
        console.print(rich_table)
    if len(chosen) > len(printed):
        console.print(Text(_(more).format(rows=len(chosen) - len(printed)), style="dim"))
    for note in table.notes:
        console.print(Text(typeset(note), style="dim"))


def _least_width(texts: Sequence[str], words: bool) -> int:
    """Return the least width of a column, given by its texts with the heading first.

    Headings, and texts if `words` is True, may be broken between words; numbers may not.
    """
    parts = [*texts[0].split(), *(word for text in texts[1:] for word in (text.split() if words else [text]))]
    return max(map(len, parts), default=0)


def _column_widths(wide: list[int], least: Sequence[int], width: int) -> list[int]:
    """Return the widths of columns side by side. If they do not fit, the widest are narrowed, at most to their least
    widths.
    """
    while sum(wide) > width + 1 - GAP * len(wide):
        slack = [k for k in range(len(wide)) if wide[k] > least[k]]
        if not slack:
            break
        wide[max(slack, key=lambda k: wide[k])] -= 1
    return wide


def _table_parts(words: Sequence[bool], least: Sequence[int], width: int) -> list[list[int]]:
    """Divide the columns into parts that fit on the terminal, and return the indices of the columns in each part.

    The columns that identify the rows are repeated in every part.
    """
    count = len(words)
    keys = next((k for k in range(count) if not words[k] and k != 1), count)
    wide = [w + GAP for w in least]
    if keys == count:  # words only: the first column tells the rows apart
        if sum(wide) <= width + 1:
            return [list(range(count))]
        keys = 1
    parts: list[list[int]] = []
    for k in range(keys, count):
        if not parts or sum(wide[i] for i in parts[-1]) + wide[k] > width + 1:
            parts.append(list(range(keys)))
        parts[-1].append(k)
    return parts
