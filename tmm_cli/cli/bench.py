"""Command `tmm bench`: measurements of speed, accuracy and other properties.

To add a measurement, write a function here; its computation and charts belong in `tmm_cli/bench`.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Annotated, NoReturn, TypeVar

import typer
from matplotlib.figure import Figure

from tmm_cli.bench import (
    FAMILIES_BY_NAME,
    REFERENCE_NAMES,
    Measurement,
    accuracy_charts,
    measure_accuracy,
    measure_grading,
    measure_savings,
    measure_searches,
    measure_speed,
    measure_stability,
    png_bytes,
    savings_charts,
    search_charts,
    speed_charts,
    stability_charts,
)
from tmm_cli.cli.app import add_commands
from tmm_cli.cli.common import Json, console, emit_json
from tmm_cli.cli.talk import BAD_INPUT, CHECK_FAILED, OK, say
from tmm_cli.problem import UnitSystem
from tmm_cli.reports import csv_text, json_bytes, print_on_terminal, write_atomically

MEASUREMENTS = {
    "accuracy": "Time per position and error of many methods.",
    "grading": "Time and memory of grading; mistakes identified.",
    "savings": "Work saved by computing only what is requested.",
    "speed": "Time per position, compared with other programs.",
    "stability": "Errors of every method near singular positions.",
    "synthesis": "Candidates per second and quality of the optimum.",
}


def group(words: Sequence[str]) -> typer.Typer:
    """Create the command group `tmm bench` with the requested measurement."""
    app = typer.Typer(
        name="bench",
        help="Measure speed, accuracy, stability, savings and synthesis on this machine.",
        no_args_is_help=True,
        rich_markup_mode=None,
    )
    app.callback()(_keep_group)
    add_commands(app, MEASUREMENTS, words, lambda name: "bench")
    return app


def _keep_group() -> None:
    """Do nothing. With this callback typer creates a command group even if it contains a single measurement."""


Charts = Mapping[str, Figure]  # by file name
M = TypeVar("M", bound=Measurement)

Reduced = Annotated[
    bool, typer.Option("--reduced", help="Run a shorter measurement; each target may be missed by a factor of two.")
]
Out = Annotated[
    Path | None,
    typer.Option("--out", "-o", metavar="DIR", help="Write JSON, CSV and charts to this folder.", show_default=False),
]


def requested_names(requested: Sequence[str] | None, names: Iterable[str], unknown: str) -> list[str]:
    """Return the requested names, or all names if none is requested. An unknown name ends the program with an error.

    Args:
        requested: names given on the command line.
        names: allowed names.
        unknown: error message for an unknown name, with the fields {name} and {names}.
    """
    available = list(names)
    chosen = list(dict.fromkeys(requested or available))
    for name in chosen:
        if name not in available:
            say("error: " + unknown.format(name=name, names=", ".join(available)))
            raise typer.Exit(BAD_INPUT)
    return chosen


def show_and_write(name: str, measured: M, charts: Callable[[M], Charts], out: Path | None, as_json: bool) -> NoReturn:
    """Print a measurement as tables or JSON, write its files, report missed targets and end the program."""
    if as_json:
        emit_json(measured.to_dict())
    else:
        for table in measured.tables:
            print_on_terminal(table, UnitSystem(), console())
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


def _write(name: str, measured: Measurement, charts: Charts, folder: Path) -> str:
    """Write NAME.json, NAME.csv and the charts; return the paths of the files, separated by commas.

    The CSV file contains the rows for it that the measurement provides (`lines`), otherwise the only table of the
    measurement.
    """
    contents = {f"{name}.json": json_bytes(measured.to_dict())}
    lines = io.StringIO()
    csv.writer(lines, lineterminator="\n").writerows(measured.lines())
    if lines.getvalue():
        contents[f"{name}.csv"] = lines.getvalue().encode()
    elif len(measured.tables) == 1:
        contents[f"{name}.csv"] = "".join(csv_text(measured.tables[0], UnitSystem())).encode()
    contents |= {file: png_bytes(figure) for file, figure in charts.items()}
    for file, content in contents.items():
        write_atomically(folder / file, content)
    return ", ".join(str(folder / file) for file in contents)


Linkages = Annotated[
    list[str] | None,
    typer.Option("--linkage", metavar="NAME", help="Measure only this linkage (may be repeated).", show_default=False),
]


def accuracy(linkage: Linkages = None, reduced: Reduced = False, out: Out = None, as_json: Json = False) -> None:
    """Measure time per position and largest relative error of many methods.

    The methods solve five linkages whose motion is known to 50 digits.

    Exit code 1 if tmm misses its targets: an error of 1e-14 for positions, 1e-13 for everything else.
    """
    names = requested_names(linkage, REFERENCE_NAMES, "there is no reference linkage {name}; there are {names}")
    show_and_write("accuracy", measure_accuracy(names, reduced=reduced, progress=say), accuracy_charts, out, as_json)


def grading(
    reduced: Reduced = False,
    full: Annotated[bool, typer.Option("--full", help="Also measure a group of 100 000 students.")] = False,
    out: Out = None,
    as_json: Json = False,
) -> None:
    """Measure time and memory of grading a group of students, and how often mistakes are identified correctly.

    Exit code 1 if a target is missed; in a reduced run, if it is missed by more than a factor of two.
    """
    show_and_write("grading", measure_grading(reduced=reduced, full=full, progress=say), lambda _: {}, out, as_json)


def savings(reduced: Reduced = False, as_json: Json = False, out: Out = None) -> None:
    """Measure how much work is saved when only the requested quantities are computed.

    Exit code 1 if something that was not requested is computed.
    """
    show_and_write("savings", measure_savings(reduced=reduced, progress=say), savings_charts, out, as_json)


def speed(reduced: Reduced = False, out: Out = None, as_json: Json = False) -> None:
    """Measure time per position and compare it with hand-written code and other programs, for large problems as well.

    Exit code 1 if a target is missed; in a reduced run, if it is missed by more than a factor of two.
    """
    show_and_write("speed", measure_speed(reduced=reduced, progress=say), speed_charts, out, as_json)


Families = Annotated[
    list[str] | None,
    typer.Option("--family", metavar="NAME", help="Measure only this family (may be repeated).", show_default=False),
]


def stability(family: Families = None, reduced: Reduced = False, out: Out = None, as_json: Json = False) -> None:
    """Compare every method near singular positions with a solution to 50 digits, and find at which distance it first
    fails.

    Exit code 1 if an error of tmm exceeds its error bound, or if more than one error bound in ten is over 100 times the
    true error.
    """
    names = requested_names(family, FAMILIES_BY_NAME, "there is no family {name}; there are {names}")
    show_and_write("stability", measure_stability(names, reduced=reduced, progress=say), stability_charts, out, as_json)


def synthesis(reduced: Reduced = False, out: Out = None, as_json: Json = False) -> None:
    """Measure candidates per second of the optimal synthesis, and how close 10 seeds come to the best known solution.

    Exit code 1 if a target is missed; in a reduced run, if it is missed by more than a factor of two.
    """
    show_and_write("synthesis", measure_searches(reduced=reduced, progress=say), search_charts, out, as_json)
