"""Command `tmm sweep`: shows quantities as functions of one or two parameters."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated

import typer

from tmm_cli.batch import Task, in_processes, on_cluster
from tmm_cli.cli.common import Jobs, Json, Scheduler, Settings, console, emit_json, progress_bars, reporting_errors
from tmm_cli.cli.opening import print_file_summary, read_tree
from tmm_cli.cli.talk import OK, printable, say, warn
from tmm_cli.drawing.formats import drawing_files as drawings
from tmm_cli.language import _, words_of_files
from tmm_cli.problem import Problem
from tmm_cli.reports import (
    RECORD,
    StagedFolder,
    csv_text,
    find_unused_parameters,
    folder_name,
    json_text,
    json_value,
    print_on_terminal as show_table,
    refuse_unwritable,
    warn_of_load_tables,
)
from tmm_cli.sweep import (
    SweepResults,
    SweptMechanisms,
    borders_table,
    points_table,
    read_axes,
    refuse_points,
    run_sweep,
    sections,
    sweep_sheets,
)

File = Annotated[str, typer.Argument(metavar="FILE", help="Problem file (YAML) with parameters.", show_default=False)]
Over = Annotated[
    list[str],
    typer.Option(metavar="NAME=FROM..TO:COUNT", help="Parameter to sweep (at most two).", show_default=False),
]
Show = Annotated[
    list[str] | None,
    typer.Option(metavar="NAMES", help="Quantities to show, e.g. H,k,pressure,M_b,R_34,v_E.", show_default=False),
]
Folder = Annotated[
    Path | None,
    typer.Option(
        "--out", "-o", metavar="DIR", help="Write CSV, result.json and drawings to this folder.", show_default=False
    ),
]


def sweep(
    file: File,
    over: Over,
    show: Show = None,
    settings: Settings = None,
    out: Folder = None,
    jobs: Jobs = None,
    scheduler: Scheduler = None,
    as_json: Json = False,
) -> None:
    """Show quantities as functions of one or two parameters, and the boundaries of the range in which the mechanism
    works.

    These are the boundaries of assembly, of full rotation and of the limits in the file. Every point is a variant of
    the mechanism with the assembly of the file.
    """
    with reporting_errors(as_json):
        if out is not None:
            refuse_unwritable(out, folder=True)
        tree = read_tree(file, settings)
        task = Task(tree)
        print_file_summary(task.problem)
        problem = task.problem.whole
        mechanisms = SweptMechanisms(tree, read_axes(task, over), show or ())
        taped, cores = mechanisms.crank_variants is not None, jobs or os.cpu_count() or 1
        points = 1
        for axis in mechanisms.axes:
            points *= len(axis.values)
        peaks = any(not quantity.whole for quantity in mechanisms.shown)
        refuse_points(problem, points, peaks=peaks, taped=taped, cores=None if scheduler else cores)
        _announce(points, taped)
        for doubt in find_unused_parameters(tree, mechanisms.names):
            say(_("warning: {warning}").format(warning=f"{problem.name}: {doubt}"))
        runner = on_cluster(scheduler) if scheduler else in_processes(cores)
        with progress_bars() as progress:
            work = progress.add_task(_("mechanisms solved"), total=points)
            swept = run_sweep(mechanisms, runner, lambda count: progress.advance(work, count))
        for slip in warn_of_load_tables(problem.linkage, problem.units, swept.reach):
            warn(f"{problem.name}: {slip}")
        if as_json:
            emit_json(json_value(dict(sections(swept, problem))))
        else:
            show_table(points_table(swept, words=True), problem.units, console())
            if swept.marks:
                show_table(borders_table(swept, words=True), problem.units, console())
        if out is not None:
            _write(swept, problem, out)
        raise typer.Exit(OK)


def _announce(points: int, taped: bool) -> None:
    """Print the number of mechanisms before they are solved."""
    text = (
        _("mechanisms to solve: {points}, all together")
        if taped
        else _("mechanisms to solve: {points}, one after another")
    )
    say(text.format(points=points))


def _write(swept: SweepResults, problem: Problem, out: Path) -> None:
    """Write all files of a sweep, or none if one fails. Raises OSError."""
    folder = out / folder_name(f"{problem.name}-sweep")
    with StagedFolder(folder) as staged:
        with words_of_files():
            staged.write("sweep.csv", csv_text(points_table(swept), problem.units))
            staged.write("borders.csv", csv_text(borders_table(swept), problem.units))
        for name, picture in drawings(sweep_sheets(problem.title, swept, problem.units), say):
            staged.write(name, (picture,))
        names = sorted(staged.names)
        with words_of_files():
            staged.write(RECORD, json_text([*sections(swept, problem), ("files", names)]))
    say(_("written: {files}").format(files=printable(folder)))
