"""`tmm bench stability`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from tmm_cli.cli.common import BAD_INPUT, CHECK_FAILED, OK, Json, console, emit_json, say

if TYPE_CHECKING:
    from tmm_cli.bench.stability import Stability

Families = Annotated[
    list[str] | None,
    typer.Option("--family", metavar="NAME", help="This family only (may be repeated).", show_default=False),
]
Reduced = Annotated[bool, typer.Option("--reduced", help="Fewer methods, linkages and distances.")]
Out = Annotated[
    Path | None,
    typer.Option("--out", "-o", metavar="DIR", help="Write CSV, JSON, charts there.", show_default=False),
]


def stability(family: Families = None, reduced: Reduced = False, out: Out = None, as_json: Json = False) -> None:
    """Every method as it comes near what kills it, and the distance at which it first lies, against 50 digits.

    Exit code 1 when a value of the product is off by more than its bound, or when fewer than nine of ten of its bounds
    are within 100 times the true error.
    """
    from tmm_cli.bench.families import BY_NAME
    from tmm_cli.bench.stability import WIDE, measure
    from tmm_cli.words import say as word

    chosen = list(dict.fromkeys(family or BY_NAME))
    for name in chosen:
        if name not in BY_NAME:
            say("error: " + word("stability.no_family", name=name, names=", ".join(BY_NAME)))
            raise typer.Exit(BAD_INPUT)
    measured = measure(chosen, reduced=reduced, progress=say)
    if as_json:
        emit_json(measured.to_dict())
    else:
        _show(measured)
    if out is not None:
        try:
            say(word("stability.written", files=_write(measured, out)))
        except OSError as error:
            say(f"error: {error.filename or out}: {error.strerror}")
            raise typer.Exit(BAD_INPUT) from None
    for line in measured.absent:
        say(line)
    say(word("stability.sharp", count=len(measured.widths), share=f"{measured.sharp:.1%}", wide=f"{WIDE:g}"))
    for failure in measured.failures:
        say(word("stability.missed", what=failure))
    if not measured.failures:
        say(word("stability.met"))
    raise typer.Exit(CHECK_FAILED if measured.failures else OK)


def _show(measured: Stability) -> None:
    """The table of first lies: a row a method, a column a family."""
    from tmm_cli.problem.units import UnitSystem
    from tmm_cli.results.table import Column, Table
    from tmm_cli.results.terminal import show
    from tmm_cli.words import say as word

    def first(family: str, method: str) -> str:
        if not measured.of(family, method):
            return "-"
        distance = measured.lies(family, method)
        return word("stability.never") if distance is None else f"{distance:.0e}".replace("e-0", "e-")

    columns = [Column(word("stability.method"), list(measured.methods))]
    columns += [Column(family, [first(family, method) for method in measured.methods]) for family in measured.families]
    show(Table("stability", word("stability.title"), tuple(columns)), UnitSystem(), console())


def _write(measured: Stability, folder: Path) -> str:
    """stability.csv, stability.json and the charts; their names."""
    from tmm_cli.bench.stability_chart import charts
    from tmm_cli.draw.sheet import picture
    from tmm_cli.results.files import write_whole
    from tmm_cli.results.text import json_bytes

    contents = {"stability.csv": measured.to_csv().encode(), "stability.json": json_bytes(measured.to_dict())}
    for number, figure in enumerate(charts(measured), 1):
        contents[f"stability-{number}.png"] = picture(figure, "png")
    for name, content in contents.items():
        write_whole(folder / name, content)
    return ", ".join(str(folder / name) for name in contents)
