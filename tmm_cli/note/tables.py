"""Tables of the results as tables of a note: fewer digits, in the note's language."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from tmm_cli.note.blocks import Line, Rows
from tmm_cli.note.context import Subject, by_hand, with_degrees
from tmm_cli.problem.units import on_paper
from tmm_cli.results.table import Column, Table
from tmm_cli.results.terminal import cells

DIGITS = 4


def rows_of(subject: Subject, table: Table, caption: str = "", key: str = "", digits: int = DIGITS) -> Rows:
    """The same table in the units of the file; columns in which nothing stands are left out."""
    units, every = subject.results.problem.units, range(table.rows)
    columns = [
        (by_hand(on_paper(c.heading(units))), cells(replace(_on_paper(c), digits=digits), units, every), c.dimension)
        for c in table.columns
    ]
    kept = [(head, texts, dimension) for head, texts, dimension in columns if any(texts)]
    shown = [
        [by_hand(with_degrees(t)) if dimension is None else subject.figures_of(t) for t in texts]
        for __, texts, dimension in kept
    ]
    head: Sequence[Line] = [(text,) for text, *__ in kept]
    rows = tuple(tuple((texts[k],) for texts in shown) for k in every)
    return Rows(caption or table.title, tuple(head), rows, key)


def _on_paper(column: Column) -> Column:
    """A column of units as they are printed."""
    return replace(column, values=[on_paper(unit) for unit in column.values]) if column.header == "unit" else column
