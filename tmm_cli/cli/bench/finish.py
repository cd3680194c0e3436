"""What the measurements share: options, the end of each with its tables, files and verdict."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Annotated, NoReturn, TypeVar

import typer
from matplotlib.figure import Figure

from tmm_cli.bench import Measured, png
from tmm_cli.cli.common import console, emit_json
from tmm_cli.cli.talk import BAD_INPUT, CHECK_FAILED, OK, say
from tmm_cli.problem import UnitSystem
from tmm_cli.reports import csv_text, json_bytes, show, write_whole

Charts = Mapping[str, Figure]  # by the names of their files
M = TypeVar("M", bound=Measured)

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


def finish(name: str, measured: M, charts: Callable[[M], Charts], out: Path | None, as_json: bool) -> NoReturn:
    """Show tables or JSON, write the files; then the verdict."""
    if as_json:
        emit_json(measured.to_dict())
    else:
        for table in measured.tables:
            show(table, UnitSystem(), console())
    if out is not None:
        try:
            say(f"written: {_write(name, measured, charts(measured), out)}")
        except OSError as error:
            say(f"error: {error.filename or out}: {error.strerror}")
            raise typer.Exit(BAD_INPUT) from None
    for line in measured.remarks:
        say(line)
    for failure in measured.failures:
        say(f"target missed: {failure}")
    if not measured.failures:
        say(measured.met)
    raise typer.Exit(CHECK_FAILED if measured.failures else OK)


def _write(name: str, measured: Measured, charts: Charts, folder: Path) -> str:
    """name.json, name.csv of the lines or of the one table, charts."""
    contents = {f"{name}.json": json_bytes(measured.to_dict())}
    lines = io.StringIO()
    csv.writer(lines, lineterminator="\n").writerows(measured.lines())
    if lines.getvalue():
        contents[f"{name}.csv"] = lines.getvalue().encode()
    elif len(measured.tables) == 1:
        contents[f"{name}.csv"] = "".join(csv_text(measured.tables[0], UnitSystem())).encode()
    contents |= {file: png(figure) for file, figure in charts.items()}
    for file, content in contents.items():
        write_whole(folder / file, content)
    return ", ".join(str(folder / file) for file in contents)
