"""What the measuring commands share: their options, how they show and write what they found, their exit codes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NoReturn, Protocol

import typer

from tmm_cli.cli.common import BAD_INPUT, CHECK_FAILED, OK, console, emit_json, say

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from tmm_cli.results.table import Table

Reduced = Annotated[bool, typer.Option("--reduced", help="A shorter measurement; its targets are twice as wide.")]
Out = Annotated[
    Path | None,
    typer.Option("--out", "-o", metavar="DIR", help="Write JSON, CSV, charts there.", show_default=False),
]


class Measured(Protocol):
    """What a measurement tells: its content as JSON, the targets it misses, what could not be measured."""

    @property
    def failures(self) -> Sequence[str]: ...

    @property
    def absent(self) -> Sequence[str]: ...

    def to_dict(self) -> dict[str, Any]: ...


def chosen(asked: Sequence[str] | None, names: Iterable[str], key: str) -> list[str]:
    """Those asked for, or all; an unknown one ends the command. key: of the words for that."""
    from tmm_cli.words import say as word

    known = list(names)
    found = list(dict.fromkeys(asked or known))
    for name in found:
        if name not in known:
            say("error: " + word(key, name=name, names=", ".join(known)))
            raise typer.Exit(BAD_INPUT)
    return found


def show(tables: Iterable[Table]) -> None:
    """Tables on the terminal."""
    from tmm_cli.problem.units import UnitSystem
    from tmm_cli.results.terminal import show as print_table

    for table in tables:
        print_table(table, UnitSystem(), console())


def finish(
    name: str, measured: Measured, tables: Callable[[], Iterable[Table]], charts: Callable[[], Mapping[str, Figure]],
    out: Path | None, *, as_json: bool, more: Iterable[str] = (),
) -> NoReturn:  # fmt: skip
    """Show tables or JSON, write name.json, name.csv where there is one and the charts; then the verdict.

    more: lines said before the verdict.
    """
    from tmm_cli.words import say as word

    if as_json:
        emit_json(measured.to_dict())
    else:
        show(tables())
    if out is not None:
        try:
            say(word(f"{name}.written", files=_write(name, measured, charts(), out)))
        except OSError as error:
            say(f"error: {error.filename or out}: {error.strerror}")
            raise typer.Exit(BAD_INPUT) from None
    for line in (*measured.absent, *more):
        say(line)
    for failure in measured.failures:
        say(word(f"{name}.missed", what=failure))
    if not measured.failures:
        say(word(f"{name}.met"))
    raise typer.Exit(CHECK_FAILED if measured.failures else OK)


def _write(name: str, measured: Measured, charts: Mapping[str, Figure], folder: Path) -> str:
    from tmm_cli.draw.sheet import picture
    from tmm_cli.results.files import write_whole
    from tmm_cli.results.text import json_bytes

    contents = {f"{name}.json": json_bytes(measured.to_dict())}
    to_csv = getattr(measured, "to_csv", None)
    if to_csv is not None:
        contents[f"{name}.csv"] = to_csv().encode()
    contents |= {f"{chart}.png": picture(figure, "png") for chart, figure in charts.items()}
    for file, content in contents.items():
        write_whole(folder / file, content)
    return ", ".join(str(folder / file) for file in contents)
