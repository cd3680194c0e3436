"""`tmm bench accuracy`."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated

import typer

from tmm_cli.cli.bench_common import Out, Reduced, chosen, finish
from tmm_cli.cli.common import Json, say

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from tmm_cli.bench.accuracy import Accuracy
    from tmm_cli.results.table import Table

Linkages = Annotated[
    list[str] | None,
    typer.Option("--linkage", metavar="NAME", help="This linkage only (may be repeated).", show_default=False),
]


def accuracy(linkage: Linkages = None, reduced: Reduced = False, out: Out = None, as_json: Json = False) -> None:
    """Time a position against largest relative error of many methods, on five linkages known to 50 digits.

    Exit code 1 when the product itself misses its targets: 1e-14 for positions, 1e-13 for all else.
    """
    from tmm_cli.bench.accuracy import measure
    from tmm_cli.bench.references import NAMES

    measured = measure(chosen(linkage, NAMES, "accuracy.no_linkage"), reduced=reduced, progress=say)
    finish("accuracy", measured, lambda: _tables(measured), lambda: _charts(measured), out, as_json=as_json)


def _tables(measured: Accuracy) -> Iterator[Table]:
    from tmm_cli.accuracy.case import QUANTITIES
    from tmm_cli.results.table import Column, Table
    from tmm_cli.words import say as word

    for linkage in dict.fromkeys(row.linkage for row in measured.rows):
        rows = [row for row in measured.rows if row.linkage == linkage]
        times = ["-" if row.microseconds is None else f"{row.microseconds:.3g}" for row in rows]
        columns = [Column(word("accuracy.method"), [row.method for row in rows]), Column(word("accuracy.time"), times)]
        for quantity in QUANTITIES:
            found = ["-" if math.isnan(row.errors[quantity]) else f"{row.errors[quantity]:.1e}" for row in rows]
            columns.append(Column(word(f"accuracy.{quantity}"), found))
        yield Table("accuracy", word("accuracy.title", linkage=linkage), tuple(columns))


def _charts(measured: Accuracy) -> dict[str, Figure]:
    """One a linkage."""
    from tmm_cli.bench.chart import chart

    return {f"accuracy-{name}": chart(measured, name) for name in dict.fromkeys(row.linkage for row in measured.rows)}
