"""Tables on a terminal, in the units of the file."""

from __future__ import annotations

import math

from rich import box
from rich.console import Console
from rich.table import Table as RichTable
from rich.text import Text

from tmm_cli.problem.dimensions import NUMBER
from tmm_cli.problem.units import UnitSystem
from tmm_cli.results.table import Column, Table
from tmm_cli.words import say

DIGITS = 6
MOST_ROWS = 120  # on a terminal; files have them all
ROUNDING = 1e-13  # of the largest number of a column: less is rounding, and would print untrue digits


def cells(column: Column, units: UnitSystem) -> list[str]:
    """Words as they are, numbers to six digits, a dash where there is none, 0 for what is only rounding."""
    if column.dimension is None:
        return [str(value) for value in column.values]
    values = [math.nan if value is None else float(value) for value in column.values]
    nothing = ROUNDING * max((abs(v) for v in values if math.isfinite(v)), default=0.0)
    return [_number(v, column, units) if abs(v) > nothing or v != v else "0" for v in values]


def _number(value: float, column: Column, units: UnitSystem) -> str:
    if not math.isfinite(value):
        return "-"
    number = value if column.dimension in (None, NUMBER) else units.from_si(value, column.dimension)
    return f"{number:.{DIGITS}g}"


def heading(column: Column, units: UnitSystem) -> str:
    """A column's header with its unit."""
    if column.dimension is None or column.dimension == NUMBER:
        return column.header
    return f"{column.header}, {units.symbol(column.dimension)}"


def show(table: Table, units: UnitSystem, console: Console, rows: set[int] | None = None) -> None:
    """Print a table; of a long one, the given rows only."""
    rich_table = RichTable(title=Text(table.title), title_justify="left", box=box.SIMPLE_HEAD, pad_edge=False)
    for column in table.columns:
        words = column.dimension is None
        rich_table.add_column(Text(heading(column, units)), justify="left" if words else "right", no_wrap=not words)
    columns = [cells(column, units) for column in table.columns]
    chosen = [k for k in range(table.rows) if rows is None or k in rows]
    for k in chosen[:MOST_ROWS]:
        rich_table.add_row(*(Text(column[k]) for column in columns))
    console.print(rich_table)
    if len(chosen) > MOST_ROWS:
        console.print(Text(say("table.more", rows=len(chosen) - MOST_ROWS), style="dim"))
    for note in table.notes:
        console.print(Text(note, style="dim"))
