"""Tables on a terminal, in the units of the file."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from rich import box
from rich.console import Console
from rich.table import Table as RichTable
from rich.text import Text

from tmm_cli.problem.dimensions import NUMBER
from tmm_cli.problem.units import UnitSystem
from tmm_cli.results.table import Column, Table, true_digits
from tmm_cli.words import say

MOST_ROWS = 120  # on a terminal; files have them all
GAP = 3  # between columns
ROUNDING = 1e-13  # of the largest number of a column: less is rounding, and would print untrue digits


def cells(column: Column, units: UnitSystem, rows: Sequence[int]) -> list[str]:
    """Words as they are, numbers to six digits, a dash where there is none, 0 for what is only rounding."""
    if column.dimension is None:
        return [str(column.values[k]) for k in rows]
    given = column.values
    values = np.array([math.nan if v is None else v for v in given] if isinstance(given, list) else given, dtype=float)
    nothing = ROUNDING * np.max(np.abs(values), where=np.isfinite(values), initial=0.0)
    chosen = values[list(rows)]
    if column.bound is not None:
        bound = np.asarray(column.bound)[list(rows)]
        known = np.isfinite(chosen) & np.isfinite(bound)
        factor = 1.0 if column.dimension == NUMBER else units.from_si(1.0, column.dimension)
        true = true_digits(np.where(known, chosen, 0.0) * factor, np.where(known, bound, 0.0) * factor)
        told = zip(chosen.tolist(), true.tolist(), known.tolist(), strict=True)
        return ["-" if not sound else _number(v, column, units, n) if n else "0" for v, n, sound in told]
    return [_number(v, column, units) if abs(v) > nothing or v != v else "0" for v in chosen.tolist()]


def _number(value: float, column: Column, units: UnitSystem, true: int = 17) -> str:
    if not math.isfinite(value):
        return "-"
    number = value if column.dimension in (None, NUMBER) else units.from_si(value, column.dimension)
    return f"{number:.{min(column.digits, true)}g}"


def heading(column: Column, units: UnitSystem) -> str:
    """A column's header with its unit."""
    if column.dimension is None or column.dimension == NUMBER:
        return column.header
    return f"{column.header}, {units.symbol(column.dimension)}"


def show(
    table: Table, units: UnitSystem, console: Console, rows: set[int] | None = None, *,
    most: int | None = MOST_ROWS, more: str = "table.more",
) -> None:  # fmt: skip
    """Print a table; of a long one, the given rows only. A table wider than the terminal is printed in parts.

    more: the word that says how many rows beyond `most` (None: no bound) are left out, and where they all are.
    """
    chosen = [k for k in range(table.rows) if rows is None or k in rows]
    printed = chosen[:most]
    told = [_told(column, cells(column, units, printed), units) for column in table.columns]
    for number, part in enumerate(_parts(table, told, console.width)):
        title = table.title if number == 0 else say("table.continued", title=table.title)
        rich_table = RichTable(title=Text(title), title_justify="left", box=box.SIMPLE_HEAD, pad_edge=False)
        for k, wide in zip(part, _widths(table, told, part, console.width), strict=True):
            words = table.columns[k].dimension is None
            rich_table.add_column(Text(told[k][0]), justify="left" if words else "right", width=wide)
        for row in range(len(printed)):
            rich_table.add_row(*(Text(told[k][1][row]) for k in part))
        console.print(rich_table)
    if len(chosen) > len(printed):
        console.print(Text(say(more, rows=len(chosen) - len(printed)), style="dim"))
    for note in table.notes:
        console.print(Text(note, style="dim"))


def _told(column: Column, shown: list[str], units: UnitSystem) -> tuple[str, list[str]]:
    """A column's heading and the cells that are printed."""
    return heading(column, units), shown


def _least(column: tuple[str, list[str]], words: bool) -> int:
    """The least width of a column: headings and words may be broken between words, numbers may not."""
    parts = [word for cell in column[1] for word in cell.split()] if words else column[1]
    return max([len(part) for part in (*column[0].split(), *parts)], default=0)


def _widths(table: Table, told: list[tuple[str, list[str]]], part: list[int], width: int) -> list[int]:
    """Widths of columns beside each other: as their texts want, less of the widest where they do not fit."""
    least = [_least(told[k], table.columns[k].dimension is None) for k in part]
    wide = [max([len(text) for text in (told[k][0], *told[k][1])], default=0) for k in part]
    while sum(wide) > width + 1 - GAP * len(part):
        slack = [k for k in range(len(part)) if wide[k] > least[k]]
        if not slack:
            break
        wide[max(slack, key=lambda k: wide[k])] -= 1
    return wide


def _parts(table: Table, told: list[tuple[str, list[str]]], width: int) -> list[list[int]]:
    """Columns that fit beside each other; what tells the rows apart stands in every part."""
    keys = 0
    while keys < len(told) and (table.columns[keys].dimension is None or keys == 1):
        keys += 1
    wide = [_least(told[k], column.dimension is None) + GAP for k, column in enumerate(table.columns)]
    if keys == len(told):  # words only: the first column tells the rows apart
        if sum(wide) <= width + 1:
            return [list(range(len(told)))]
        keys = 1
    parts: list[list[int]] = []
    for k in range(keys, len(told)):
        if not parts or sum(wide[i] for i in parts[-1]) + wide[k] > width + 1:
            parts.append(list(range(keys)))
        parts[-1].append(k)
    return parts
