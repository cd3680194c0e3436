"""`tmm bench savings`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from tmm_cli.cli.common import BAD_INPUT, CHECK_FAILED, OK, Json, console, emit_json, say

if TYPE_CHECKING:
    from tmm_cli.problem.record import Problem

File = Annotated[
    str | None, typer.Argument(metavar="[FILE]", help="Problem file; none: the shaper of tmm new.", show_default=False)
]
Reduced = Annotated[bool, typer.Option("--reduced", help="Fewer repetitions: under 10 s.")]
Folder = Annotated[
    Path | None, typer.Option("--out", "-o", metavar="DIR", help="Write table and chart there.", show_default=False)
]


def savings(file: File = None, reduced: Reduced = False, as_json: Json = False, out: Folder = None) -> None:
    """Count and time what is saved by computing no more than what is asked; exit code 1 when something is not."""
    from tmm_cli.problem.errors import ProblemError

    try:
        problem = _read(file)
        found = _measure(problem, reduced)
    except ProblemError as error:
        if as_json:
            emit_json({"error": error.to_dict()})
        say(f"error: {error}")
        raise typer.Exit(BAD_INPUT) from None
    from tmm_cli.problem.units import UnitSystem
    from tmm_cli.results.savings import savings_json, savings_table

    table = savings_table(found)
    if as_json:
        emit_json(savings_json(problem.name, found))
    else:
        from tmm_cli.results.terminal import show

        show(table, UnitSystem(), console())
    if out is not None:
        from tmm_cli.draw.savings import chart
        from tmm_cli.results.files import Staged
        from tmm_cli.results.text import csv_text, json_bytes

        with Staged(out) as staged:
            staged.write("savings.csv", csv_text(table, UnitSystem()))
            staged.write("savings.json", (json_bytes(savings_json(problem.name, found)),))
            for kind in ("png", "svg"):
                staged.write(f"savings.{kind}", (chart(problem.title, found, kind),))
        say(f"written: {out}")
    raise typer.Exit(OK if all(saving.holds for saving in found) else CHECK_FAILED)


def _read(file: str | None) -> Problem:
    """Raises ProblemError."""
    from tmm_cli.problem.build import build, load
    from tmm_cli.problem.reader import read_text
    from tmm_cli.problem.templates import template_text

    return load(file) if file is not None else build(read_text(template_text("shaper"), "shaper.yaml"))


def _measure(problem: Problem, reduced: bool):  # type: ignore[no-untyped-def]
    from tmm_cli.bench.savings import savings as measured
    from tmm_cli.problem.refusals import refusal
    from tmm_cli.refused import Refused

    try:
        return list(measured(problem, reduced=reduced))
    except Refused as error:
        raise refusal(error, problem) from None
