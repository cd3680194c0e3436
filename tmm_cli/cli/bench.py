"""`tmm bench`: measurements. A new one is a function here, with its measurement and its chart in `tmm_cli/bench`."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NoReturn, TypeVar

import typer

from tmm_cli.cli.common import BAD_INPUT, CHECK_FAILED, OK, Json, console, emit_json, say
from tmm_cli.errors import _

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from tmm_cli.bench.measured import Measured

    Charts = Mapping[str, Figure]  # by the names of their files

M = TypeVar("M", bound="Measured")

app = typer.Typer(
    name="bench",
    help="Measure speed, accuracy, stability, savings and synthesis on this machine.",
    no_args_is_help=True,
    rich_markup_mode=None,
)
Linkages = Annotated[
    list[str] | None,
    typer.Option("--linkage", metavar="NAME", help="This linkage only (may be repeated).", show_default=False),
]
Families = Annotated[
    list[str] | None,
    typer.Option("--family", metavar="NAME", help="This family only (may be repeated).", show_default=False),
]
Reduced = Annotated[bool, typer.Option("--reduced", help="A shorter measurement; its targets are twice as wide.")]
Out = Annotated[
    Path | None,
    typer.Option("--out", "-o", metavar="DIR", help="Write JSON, CSV, charts there.", show_default=False),
]


@app.command()
def accuracy(linkage: Linkages = None, reduced: Reduced = False, out: Out = None, as_json: Json = False) -> None:
    """Time a position against largest relative error of many methods, on five linkages known to 50 digits.

    Exit code 1 when the product itself misses its targets: 1e-14 for positions, 1e-13 for all else.
    """
    from tmm_cli.bench.accuracy import measure
    from tmm_cli.bench.chart_accuracy import charts
    from tmm_cli.bench.references import NAMES

    names = _chosen(linkage, NAMES, _("there is no reference linkage {name}; there are {names}"))
    _finish("accuracy", measure(names, reduced=reduced, progress=say), charts, out, as_json)


@app.command()
def grading(
    reduced: Reduced = False,
    full: Annotated[bool, typer.Option("--full", help="A group of 100 000 students too.")] = False,
    out: Out = None, as_json: Json = False,
) -> None:  # fmt: skip
    """Time and memory of grading a group, how they grow, and how often mistakes are named rightly.

    Exit code 1 when a target is missed, of a reduced run by more than twice.
    """
    from tmm_cli.bench.grading import measure

    _finish("grading", measure(reduced=reduced, full=full, progress=say), lambda _: {}, out, as_json)


@app.command()
def savings(reduced: Reduced = False, as_json: Json = False, out: Out = None) -> None:
    """Count and time what is saved by computing no more than what is asked; exit code 1 when something is not."""
    from tmm_cli.bench.chart_savings import charts
    from tmm_cli.bench.savings import measure

    _finish("savings", measure(reduced=reduced, progress=say), charts, out, as_json)


@app.command()
def speed(reduced: Reduced = False, out: Out = None, as_json: Json = False) -> None:
    """Time a position against code written by hand for one mechanism, other programs, and growing problems.

    Exit code 1 when a target is missed, of a reduced run by more than twice.
    """
    from tmm_cli.bench.chart_speed import charts
    from tmm_cli.bench.speed import measure

    _finish("speed", measure(reduced=reduced, progress=say), charts, out, as_json)


@app.command()
def stability(family: Families = None, reduced: Reduced = False, out: Out = None, as_json: Json = False) -> None:
    """Every method as it comes near what kills it, and the distance at which it first lies, against 50 digits.

    Exit code 1 when a value of the product is off by more than its bound, or when fewer than nine of ten of its bounds
    are within 100 times the true error.
    """
    from tmm_cli.bench.chart_stability import charts
    from tmm_cli.bench.families import BY_NAME
    from tmm_cli.bench.stability import measure

    names = _chosen(family, BY_NAME, _("there is no family {name}; there are {names}"))
    _finish("stability", measure(names, reduced=reduced, progress=say), charts, out, as_json)


@app.command()
def synthesis(reduced: Reduced = False, out: Out = None, as_json: Json = False) -> None:
    """Count candidates a second of the optimal synthesis, and how near 10 seeds come to the best known.

    Exit code 1 when a target is missed, of a reduced run by more than twice.
    """
    from tmm_cli.bench.chart_searches import charts
    from tmm_cli.bench.searches import measure

    _finish("synthesis", measure(reduced=reduced, progress=say), charts, out, as_json)


def _chosen(asked: Sequence[str] | None, names: Iterable[str], unknown: str) -> list[str]:
    """Those asked for, or all; an unknown one ends the command with the words for that (of {name} and {names})."""
    known = list(names)
    found = list(dict.fromkeys(asked or known))
    for name in found:
        if name not in known:
            say("error: " + unknown.format(name=name, names=", ".join(known)))
            raise typer.Exit(BAD_INPUT)
    return found


def _finish(name: str, measured: M, charts: Callable[[M], Charts], out: Path | None, as_json: bool) -> NoReturn:
    """Show tables or JSON, write the files; then the verdict."""
    if as_json:
        emit_json(measured.to_dict())
    else:
        from tmm_cli.problem.units import UnitSystem
        from tmm_cli.results.terminal import show

        for table in measured.tables:
            show(table, UnitSystem(), console())
    if out is not None:
        try:
            say(_("written: {files}").format(files=_write(name, measured, charts(measured), out)))
        except OSError as error:
            say(f"error: {error.filename or out}: {error.strerror}")
            raise typer.Exit(BAD_INPUT) from None
    for line in measured.remarks:
        say(line)
    for failure in measured.failures:
        say(_("target missed: {what}").format(what=failure))
    if not measured.failures:
        say(measured.met)
    raise typer.Exit(CHECK_FAILED if measured.failures else OK)


def _write(name: str, measured: Measured, charts: Charts, folder: Path) -> str:
    """name.json, name.csv of the lines or of the one table, charts."""
    from tmm_cli.bench.figures import FIGURES
    from tmm_cli.problem.units import UnitSystem
    from tmm_cli.results.files import write_whole
    from tmm_cli.results.text import csv_text, json_bytes

    contents = {f"{name}.json": json_bytes(measured.to_dict())}
    lines = io.StringIO()
    csv.writer(lines, lineterminator="\n").writerows(measured.lines())
    if lines.getvalue():
        contents[f"{name}.csv"] = lines.getvalue().encode()
    elif len(measured.tables) == 1:
        contents[f"{name}.csv"] = "".join(csv_text(measured.tables[0], UnitSystem())).encode()
    contents |= {file: FIGURES[file.rpartition(".")[2]](figure) for file, figure in charts.items()}
    for file, content in contents.items():
        write_whole(folder / file, content)
    return ", ".join(str(folder / file) for file in contents)
