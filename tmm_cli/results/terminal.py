"""Tables on a terminal, in the units of the file."""

from __future__ import annotations

import math
from typing import Any

from rich import box
from rich.console import Console
from rich.table import Table as RichTable
from rich.text import Text

from tmm_cli.problem.dimensions import NUMBER
from tmm_cli.problem.units import UnitSystem
from tmm_cli.results.table import Column, Table

DIGITS = 6


def shown(value: Any, column: Column, units: UnitSystem) -> str:
    """One cell: words as they are, numbers to six digits, a dash where there is none."""
    if column.dimension is None:
        return str(value)
    if value is None or not math.isfinite(value):
        return "-"
    number = float(value) if column.dimension == NUMBER else units.from_si(float(value), column.dimension)
    return f"{number:.{DIGITS}g}" if number != 0 else "0"


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
    for k in range(table.rows):
        if rows is None or k in rows:
            rich_table.add_row(*(Text(shown(c.values[k], c, units)) for c in table.columns))
    console.print(rich_table)
    for note in table.notes:
        console.print(Text(note, style="dim"))
