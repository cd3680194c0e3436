"""Command `tmm synthesis`: finds dimensions from requirements."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

from tmm_cli.cli.common import Files, Json, Out, Settings, console, draw_pictures, emit_json, for_each_file
from tmm_cli.cli.opening import print_file_summary, read_tree
from tmm_cli.cli.talk import CHECK_FAILED, OK, printable, say, warn
from tmm_cli.language import _, words_of_files
from tmm_cli.mechanics.analysis import Results
from tmm_cli.problem import Problem, ProblemError, Synthesised, Tree, UnitSystem, ValueReader
from tmm_cli.reports import (
    StagedFolder,
    csv_text,
    describe_units,
    find_bare_speeds,
    folder_name,
    json_bytes,
    print_on_terminal,
    quality_sentences,
    recorded_part,
    synthesis_json,
    tables_of_synthesis,
    unmet_demand_sentences,
)
from tmm_cli.synthesis import TaskFile, build_synthesised, measure_problem, quality_of, solve, solve_alone


def synthesis(files: Files, as_json: Json = False, out: Out = None, settings: Settings = None) -> None:
    """Find the lengths of a mechanism from its requirements, analyse it, and check the requirements.

    The file has a block `synthesis`, whose results become parameters of its linkage. Exit code 1 if a requirement is
    not met within 1e-9. With -o, tables and a drawing of the construction are also written.
    """

    def work(file: str) -> int:
        return _solve_and_report(file, as_json, out, settings)

    for_each_file(files, work, as_json=as_json, out=out)


def _solve_and_report(file: str, as_json: bool, out: Path | None, settings: Sequence[str] | None) -> int:
    """Solve the synthesis task of a file, show the results, and return the exit code. Raises ProblemError."""
    name, title, synthesised, units, results = _solve_task(file, settings, as_json)
    measured = None if results is None else measure_problem(results)
    quality = synthesised.outcome.quality if results is None else quality_of(results)
    judged = (quality, Problem.pressure_limits if results is None else results.problem.pressure_limits)
    with words_of_files():
        whole = {"problem": name, **synthesis_json(synthesised, measured, quality=quality)}
    if as_json:
        emit_json(whole)
    else:
        screen = console()
        for table in tables_of_synthesis(synthesised, measured, units, judged=judged):
            if not table.long:
                print_on_terminal(table, units, screen, most=None)
        if measured is None:
            say(_("the file describes no mechanism, so the requirements were not checked"))
    if out is not None:
        folder = out / folder_name(name if recorded_part(out / folder_name(name)) is None else f"{name}-synthesis")
        with StagedFolder(folder) as staged:
            with words_of_files():
                for table in tables_of_synthesis(synthesised, measured, units, 15, judged=judged):
                    staged.write(f"{table.name}.csv", csv_text(table, units))
            for drawing, picture in draw_pictures(
                "synthesis", title, synthesised.outcome, results, units, synthesised.names
            ):
                staged.write(drawing, (picture,))
            staged.write("synthesis.json", (json_bytes(whole),))
        say(_("written: {folder}").format(folder=printable(folder)))
    for doubt in quality_sentences(quality, judged[1], units) if quality else ():
        warn(doubt)
    for fault in unmet_demand_sentences(measured or (), units):
        warn(fault)
    return OK if all(m.met for m in measured or ()) else CHECK_FAILED


def _solve_task(
    file: str, settings: Sequence[str] | None, as_json: bool
) -> tuple[str, str, Synthesised, UnitSystem, Results | None]:
    """Solve the synthesis task of a file.

    Returns:
        Name and title of the problem, result of the task, units, and the motion of the mechanism (None if the file has
        no linkage).

    Raises:
        ProblemError: the file is wrong, has no synthesis task, or the task has no solution.
    """
    tree = read_tree(file, settings)
    if "synthesis" not in tree.data:
        build_synthesised(tree)  # reports a misspelt key, if any
        raise ProblemError(_("the file has no block `synthesis`"), allowed="synthesis: {task: ...}", file=file)
    if "links" not in tree.data:
        solution = solve_alone(tree)
        say(f"{solution[0]}: {describe_units(solution[3])}")
        for doubt in find_bare_speeds(tree.data, ValueReader(TaskFile(tree).independent, solution[3])):
            warn(f"{solution[0]}: {doubt}")
        return (*solution, None)
    problem = None
    try:
        problem = build_synthesised(tree)
        print_file_summary(problem)
        assert problem.synthesis is not None
        return problem.name, problem.title, problem.synthesis, problem.units, solve(problem, "kinematics")
    except ProblemError:
        _show_solution(tree, problem, as_json)
        raise


def _show_solution(tree: Tree, problem: Problem | None, as_json: bool) -> None:
    """Show what the task of a file found, if the linkage of the file then cannot be built or analysed."""
    synthesised = None if problem is None else problem.synthesis
    units = None if problem is None else problem.units
    if problem is None:
        with suppress(ProblemError):
            file = TaskFile(tree)
            synthesised, units = (None if file.searches else file.solve()), file.units
    if synthesised is None or units is None or as_json:
        return
    screen = console()
    for table in tables_of_synthesis(synthesised, None, units):
        if not table.long:
            print_on_terminal(table, units, screen, most=None)
