"""`tmm bench accuracy`."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from tmm_cli.cli.common import BAD_INPUT, CHECK_FAILED, OK, Json, console, emit_json, say

if TYPE_CHECKING:
    from tmm_cli.bench.accuracy import Accuracy

Linkages = Annotated[
    list[str] | None,
    typer.Option("--linkage", metavar="NAME", help="This linkage only (may be repeated).", show_default=False),
]
Reduced = Annotated[bool, typer.Option("--reduced", help="Fewer methods and repeats; targets twice as wide.")]
Out = Annotated[
    Path | None,
    typer.Option("--out", "-o", metavar="DIR", help="Write CSV, JSON, charts there.", show_default=False),
]


def accuracy(linkage: Linkages = None, reduced: Reduced = False, out: Out = None, as_json: Json = False) -> None:
    """Time a position against largest relative error of many methods, on five linkages known to 50 digits.

    Exit code 1 when the product itself misses its targets: 1e-14 for positions, 1e-13 for all else.
    """
    from tmm_cli.bench.accuracy import measure
    from tmm_cli.bench.references import NAMES
    from tmm_cli.words import say as word

    chosen = list(dict.fromkeys(linkage or NAMES))
    for name in chosen:
        if name not in NAMES:
            say("error: " + word("accuracy.no_linkage", name=name, names=", ".join(NAMES)))
            raise typer.Exit(BAD_INPUT)
    measured = measure(chosen, reduced=reduced, progress=say)
    if as_json:
        emit_json(measured.to_dict())
    else:
        _show(measured)
    if out is not None:
        try:
            say(word("accuracy.written", files=_write(measured, out)))
        except OSError as error:
            say(f"error: {error.filename or out}: {error.strerror}")
            raise typer.Exit(BAD_INPUT) from None
    for line in measured.absent:
        say(line)
    for failure in measured.failures:
        say(word("accuracy.missed", what=failure))
    if not measured.failures:
        say(word("accuracy.met"))
    raise typer.Exit(CHECK_FAILED if measured.failures else OK)


def _show(measured: Accuracy) -> None:
    from tmm_cli.accuracy.case import QUANTITIES
    from tmm_cli.problem.units import UnitSystem
    from tmm_cli.results.table import Column, Table
    from tmm_cli.results.terminal import show
    from tmm_cli.words import say as word

    for linkage in dict.fromkeys(row.linkage for row in measured.rows):
        rows = [row for row in measured.rows if row.linkage == linkage]
        times = ["-" if row.microseconds is None else f"{row.microseconds:.3g}" for row in rows]
        columns = [Column(word("accuracy.method"), [row.method for row in rows]), Column(word("accuracy.time"), times)]
        for quantity in QUANTITIES:
            found = ["-" if math.isnan(row.errors[quantity]) else f"{row.errors[quantity]:.1e}" for row in rows]
            columns.append(Column(word(f"accuracy.{quantity}"), found))
        show(Table("accuracy", word("accuracy.title", linkage=linkage), tuple(columns)), UnitSystem(), console())


def _write(measured: Accuracy, folder: Path) -> str:
    """accuracy.csv, accuracy.json and a chart a linkage; their names."""
    from tmm_cli.bench.chart import chart
    from tmm_cli.draw.sheet import picture
    from tmm_cli.results.files import write_whole
    from tmm_cli.results.text import json_bytes

    contents = {"accuracy.csv": measured.to_csv().encode(), "accuracy.json": json_bytes(measured.to_dict())}
    for linkage in dict.fromkeys(row.linkage for row in measured.rows):
        contents[f"accuracy-{linkage}.png"] = picture(chart(measured, linkage), "png")
    for name, content in contents.items():
        write_whole(folder / name, content)
    return ", ".join(str(folder / name) for name in contents)
