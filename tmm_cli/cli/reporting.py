"""Computing a problem file and showing or writing the results."""

from __future__ import annotations

import sys
from collections.abc import Collection, Iterable, Mapping, Sequence
from pathlib import Path

from tmm_cli.cli.common import console
from tmm_cli.cli.opening import count_detailed_positions, print_file_summary, read_tree, refuse_excess_work
from tmm_cli.cli.talk import CHECK_FAILED, OK, printable, say, warn
from tmm_cli.language import _, words_of_files
from tmm_cli.mechanics.analysis import Results, Stage
from tmm_cli.mechanics.structure import ChainResults
from tmm_cli.problem import build_any_problem, build_chain, is_chain
from tmm_cli.reports import (
    AccuracyReport,
    SpreadsheetKind,
    StagedFolder,
    Table,
    WrittenFolder,
    assess_accuracy,
    collect_warnings,
    folder_name,
    json_text,
    listed_files,
    print_on_terminal as print_table,
    sections,
    shown_properties,
    walk,
    with_bound_columns,
    write_results,
)
from tmm_cli.synthesis import count, measure_problem, redrive, solve, structure_of


def compute_file(
    file: str,
    stage: Stage,
    positions: Sequence[int] | None = None,
    driver: str | None = None,
    *,
    drafted: bool = False,
    silent: bool = False,
    settings: Sequence[str] | None = None,
    digits: bool = False,
    drawings: bool = False,
) -> Results | ChainResults:
    """Read and compute a problem file, of a mechanism or a chain. Raises ProblemError.

    Args:
        file: the problem file.
        stage: last stage.
        positions: numbers of positions; None: all.
        driver: link that drives instead of the file's own driver.
        drafted: structure only, without the lengths that a synthesis finds.
        silent: without the summary of the file.
        settings: other values of parameters.
        digits, drawings: options that add work, which is checked against the budget.
    """
    tree = read_tree(file, settings)
    if is_chain(tree):
        return count(build_chain(tree))
    problem = build_any_problem(tree)
    if driver is not None:
        problem = redrive(problem, driver)
    if not silent:
        print_file_summary(problem, drafted=drafted)
    if digits or drawings:
        whole = problem.whole
        single = positions is not None and len(positions) == 1
        detailed = 0 if stage == "structure" else 1 if single else count_detailed_positions(whole)
        refuse_excess_work(whole, positions, digits=digits, detail=detailed if drawings else None)
    return structure_of(problem) if drafted else solve(problem, stage, positions)


def accuracy_of(results: Results | ChainResults, digits: bool, shown: Collection[str] = ()) -> AccuracyReport | None:
    """Return the accuracy of results, complete with `digits`; None if nothing moves. shown: tables that are
    shown, if not all.
    """
    if isinstance(results, ChainResults) or results.motion is None:
        return None
    return assess_accuracy(results, digits, shown)


def report(
    results: Results | ChainResults,
    names: Collection[str],
    as_json: bool,
    out: Path | None,
    digits: bool = False,
    people: SpreadsheetKind | None = None,
) -> int:
    """Show results as tables or JSON, write files if requested, print warnings; returns the exit code.

    digits: show bounds and sensitivities beside the values. people: also write tables for spreadsheets.
    """
    if not properties_met(results):
        names = {*names, "properties"}  # they end the command with an exit code
    accuracy = accuracy_of(results, digits, () if as_json or out is not None else names)
    if as_json:
        emit_results(results, accuracy)
    else:
        show_tables(results, names, accuracy)
    if out is not None:
        print_written(write_results(results, out, digits=accuracy, people=people))
    for warning in collect_warnings(results):
        warn(warning)
    return find_exit_code(results)


def find_exit_code(results: Results | ChainResults) -> int:
    """Return the exit code: properties as expected, lever within its limit, synthesis met."""
    if not properties_met(results):
        return CHECK_FAILED
    if isinstance(results, ChainResults) or results.motion is None:
        return OK
    return OK if results.lever_holds and all(m.met for m in measure_problem(results)) else CHECK_FAILED


def properties_met(results: Results | ChainResults) -> bool:
    """Return True if the shown properties have their expected values."""
    return all(shown.met for shown in shown_properties(results))


def emit_results(results: Results | ChainResults, digits: AccuracyReport | None = None) -> None:
    """Write result.json to standard output piece by piece."""
    with words_of_files():
        sys.stdout.writelines(json_text(sections(results, None if digits is None else digits.json())))


def write_pictures(results: Results, out: Path | None, pictures: Mapping[str, bytes], part: str = "") -> None:
    """Write pictures with the tables into the requested folder, or alone beside the usual results, without
    replacing them.

    part: kind of the pictures, where the results do not tell it.
    """
    if out is not None:
        print_written(write_results(results, out, pictures.items(), part=part))
    elif pictures:
        usual, separate = (Path("outputs") / folder_name(f"{results.problem.name}{end}") for end in ("", "-drawings"))
        taken = not listed_files(usual).isdisjoint(pictures)
        with StagedFolder(separate if taken else usual) as staged:
            for name, content in pictures.items():
                staged.write(name, (content,))
        print_written(WrittenFolder(separate if taken else usual, staged.removed, usual if taken else None))


def write_sheets(results: Results, out: Path, pictures: Iterable[tuple[str, bytes]]) -> None:
    """Write sheets beside the results of the problem, replacing sheets of the same formats from an earlier run."""
    with StagedFolder(out / folder_name(results.problem.name)) as staged:
        for name, content in pictures:
            staged.write(name, (content,))
    formats = {Path(name).suffix for name in staged.names}
    old = [path.name for path in staged.folder.glob("sheet-*") if path.suffix in formats]
    for name in set(old) - staged.names:
        (staged.folder / name).unlink()
    print_written(WrittenFolder(staged.folder, sorted(set(old) - staged.names), None))


def print_written(written: WrittenFolder) -> None:
    """Print where the results are, and which files of earlier runs were removed or kept."""
    folder, removed, kept = written
    if kept is None:
        say(_("written: {folder}").format(folder=printable(folder)))
    else:
        say(
            _("written: {folder}; {kept} with the results of another run is unchanged").format(
                folder=printable(folder), kept=printable(kept)
            )
        )
    if removed:
        text = _("removed from {folder}, as only an earlier run had written them: {files}")
        say(text.format(folder=printable(folder), files=", ".join(removed)))


def show_tables(results: Results | ChainResults, names: Iterable[str], accuracy: AccuracyReport | None = None) -> None:
    """Print tables by name, of a chain all; of long ones only detailed positions."""
    screen = console()
    tables = walk(results, () if isinstance(results, ChainResults) else set(names))
    if accuracy is not None:
        tables = accuracy.with_bounds(tables)
        tables = map(with_bound_columns, tables) if accuracy.full else tables
    for table in tables:
        print_table(table, results.problem.units, screen, detailed_rows(results, table))


def detailed_rows(results: Results | ChainResults, table: Table) -> set[int] | None:
    """Rows of a long table that belong to detailed positions, or to the first one; None: all rows."""
    if isinstance(results, ChainResults) or not table.long:
        return None
    chosen = {results.numbers.index(n) for n in results.problem.request.detail if n in results.numbers}
    per = table.rows // max(len(results.numbers), 1)
    return {k * per + i for k in chosen or {0} for i in range(per)}
