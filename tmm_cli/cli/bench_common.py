"""What the measuring commands share: their options, how they show and write what they found, their exit codes."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NoReturn

import typer

from tmm_cli.cli.common import BAD_INPUT, CHECK_FAILED, OK, console, emit_json, say
from tmm_cli.errors import _

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from tmm_cli.bench.measured import Measured
    from tmm_cli.results.table import Table

Reduced = Annotated[bool, typer.Option("--reduced", help="A shorter measurement; its targets are twice as wide.")]
Out = Annotated[
    Path | None,
    typer.Option("--out", "-o", metavar="DIR", help="Write JSON, CSV, charts there.", show_default=False),
]


def chosen(asked: Sequence[str] | None, names: Iterable[str], unknown: str) -> list[str]:
    """Those asked for, or all; an unknown one ends the command with the words for that (of {name} and {names})."""
    known = list(names)
    found = list(dict.fromkeys(asked or known))
    for name in found:
        if name not in known:
            say("error: " + unknown.format(name=name, names=", ".join(known)))
            raise typer.Exit(BAD_INPUT)
    return found


def table(name: str, title: str, headers: Sequence[str], rows: Sequence[Sequence[str]]) -> Table:
    """A table of words."""
    from tmm_cli.results.table import Column, Table

    return Table(name, title, tuple(Column(header, [row[k] for row in rows]) for k, header in enumerate(headers)))


def finish(
    name: str, measured: Measured, tables: Sequence[Table], charts: Callable[[], Mapping[str, Figure]],
    out: Path | None, *, as_json: bool, more: Iterable[str] = (), met: str = _("all targets met"),
) -> NoReturn:  # fmt: skip
    """Show tables or JSON, write name.json, charts, name.csv of the lines or of the one table; then the verdict.

    charts: by the names of their files; more: lines said before the verdict; met: the verdict when nothing is missed.
    """
    if as_json:
        emit_json(measured.to_dict())
    else:
        from tmm_cli.problem.units import UnitSystem
        from tmm_cli.results.terminal import show

        for each in tables:
            show(each, UnitSystem(), console())
    if out is not None:
        try:
            say(_("written: {files}").format(files=_write(name, measured, tables, charts(), out)))
        except OSError as error:
            say(f"error: {error.filename or out}: {error.strerror}")
            raise typer.Exit(BAD_INPUT) from None
    for line in (*measured.absent, *more):
        say(line)
    for failure in measured.failures:
        say(_("target missed: {what}").format(what=failure))
    if not measured.failures:
        say(met)
    raise typer.Exit(CHECK_FAILED if measured.failures else OK)


def _write(name: str, measured: Measured, tables: Sequence[Table], charts: Mapping[str, Figure], folder: Path) -> str:
    from tmm_cli.draw.formats import FORMATS
    from tmm_cli.problem.units import UnitSystem
    from tmm_cli.results.files import write_whole
    from tmm_cli.results.text import csv_text, json_bytes

    contents = {f"{name}.json": json_bytes(measured.to_dict())}
    lines = io.StringIO()
    csv.writer(lines, lineterminator="\n").writerows(measured.lines())
    if lines.getvalue():
        contents[f"{name}.csv"] = lines.getvalue().encode()
    elif len(tables) == 1:
        contents[f"{name}.csv"] = "".join(csv_text(tables[0], UnitSystem())).encode()
    contents |= {file: FORMATS[file.rpartition(".")[2]](figure) for file, figure in charts.items()}
    for file, content in contents.items():
        write_whole(folder / file, content)
    return ", ".join(str(folder / file) for file in contents)
