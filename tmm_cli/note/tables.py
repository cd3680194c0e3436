"""Tables of the results as tables of a note: fewer digits, in the note's language."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from tmm_cli.language import _, spelt
from tmm_cli.note.blocks import Line, Rows, cells
from tmm_cli.note.context import Subject, by_hand, with_degrees
from tmm_cli.note.expression import fixed, plain, rounded
from tmm_cli.problem import UnitSystem, on_paper
from tmm_cli.reports import Column, Table, figures, terminal_cells as cells_of

DIGITS = 4
NONE = "—"


def rows_of(
    subject: Subject, table: Table, caption: str = "", key: str = "", digits: int = DIGITS, *, zeros: bool = False
) -> Rows:
    """The same table in the units of the file, a dash in empty cells; columns in which nothing stands are left out.

    zeros: at the end of a number are kept, so that all of a column have as many figures.
    """
    units = subject.results.problem.units
    columns = [
        (by_hand(on_paper(c.heading(units))), _texts(replace(_on_paper(c), digits=digits), units, zeros), c.dimension)
        for c in table.columns
    ]
    kept = [(head, texts, dimension) for head, texts, dimension in columns if any(texts)]
    shown = [
        [_cell(by_hand(with_degrees(t)) if dimension is None else subject.figures_of(t)) for t in texts]
        for __, texts, dimension in kept
    ]
    _told_apart(table, shown)
    rows = tuple(cells(*row) for row in zip(*shown, strict=True))
    return Rows(caption or table.title, cells(*(head for head, *__ in kept)), rows, key)


def over_positions(subject: Subject, caption: str, columns: Sequence[tuple[Line, Sequence[str]]], key: str) -> Rows:
    """A row a position; columns: the head and the texts of each."""
    rows = zip(map(str, subject.results.numbers), *(texts for __, texts in columns), strict=True)
    head = cells(_("position"), *(head for head, __ in columns))
    return Rows(caption, head, tuple(cells(*row) for row in rows), key)


def unbroken(text: str) -> str:
    """Kept on one line of a cell."""
    return text.replace(" ", "\N{NO-BREAK SPACE}")


def _told_apart(table: Table, shown: list[list[str]]) -> None:
    """Units that stand after the names of quantities go into the column of units: "time, s" is "time" and "s"."""
    headers = [column.header for column in table.columns]
    if headers != ["what", "value", "unit"] or len(shown) != len(headers):
        return
    names, units = shown[0], shown[2]
    for k, name in enumerate(names):
        quantity, __, unit = name.rpartition(", ")
        if units[k] == NONE and unit in (spelt("J"), spelt("s"), "%"):
            names[k], units[k] = quantity, unit


def _texts(column: Column, units: UnitSystem, zeros: bool) -> list[str]:
    """Without powers of ten as far as people write numbers so."""
    if column.dimension is None:
        return cells_of(column, units, range(len(column.values)))
    write = fixed if zeros else plain
    told = zip(column.numbers(units).tolist(), figures(column, units).tolist(), strict=True)
    return [write(rounded(value, count), count) if count > 0 else "0" if count == 0 else NONE for value, count in told]


def _cell(text: str) -> str:
    return NONE if text in ("", "-", "−") else text


def _on_paper(column: Column) -> Column:
    """A column of units as they are printed."""
    return replace(column, values=[on_paper(unit) for unit in column.values]) if column.header == "unit" else column
