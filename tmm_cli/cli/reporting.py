"""Computing a problem file, and printing or writing its results."""

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
    """Read and compute a problem file, of a planar mechanism or of a spatial chain.

    Args:
        file: name of the problem file.
        stage: last stage to compute.
        positions: numbers of the positions to compute; None for all.
        driver: link to use as input link; None for the one in the file.
        drafted: compute only the structure, without solving a synthesis task of the file.
        silent: do not print a summary of the file.
        settings: texts such as `OA=120`, each of which sets a parameter.
        digits: error bounds will be requested; their work is checked against the limit.
        drawings: drawings will be requested; their work is checked against the limit.

    Raises:
        ProblemError: the file cannot be computed.
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


def accuracy_of(
    results: Results | ChainResults, digits: bool, table_names: Collection[str] = ()
) -> AccuracyReport | None:
    """Assess the accuracy of results.

    Args:
        results: results of a problem.
        digits: also estimate the sensitivity of each value to the data.
        table_names: names of the tables that are shown; empty for all.

    Returns:
        The report on accuracy, or None if no motion was computed.
    """
    if isinstance(results, ChainResults) or results.motion is None:
        return None
    return assess_accuracy(results, digits, table_names)


def report(
    results: Results | ChainResults,
    names: Collection[str],
    as_json: bool,
    out: Path | None,
    digits: bool = False,
    people: SpreadsheetKind | None = None,
) -> int:
    """Print results as tables or JSON, write the requested files, print warnings, and return the exit code.

    Args:
        results: results of a problem.
        names: names of the tables to print.
        as_json: print result.json instead of tables.
        out: folder for the files; None if none are written.
        digits: print error bounds and sensitivities beside the values.
        people: kind of spreadsheet to write as well.
    """
    if not properties_met(results):
        names = {*names, "properties"}  # they determine the exit code
    accuracy = accuracy_of(results, digits, () if as_json or out is not None else names)
    if as_json:
        emit_results(results, accuracy)
    else:
        show_tables(results, names, accuracy)
    if out is not None:
        print_written(write_results(results, out, digits=accuracy, spreadsheets=people))
    for warning in collect_warnings(results):
        warn(warning)
    return find_exit_code(results)


def find_exit_code(results: Results | ChainResults) -> int:
    """Return the exit code of a run: 1 if a check fails, otherwise 0.

    A check fails if a property differs from its expected value, if the balancing moment by the Zhukovsky lever differs
    from that by force analysis, or if a synthesised mechanism does not meet a requirement.
    """
    if not properties_met(results):
        return CHECK_FAILED
    if isinstance(results, ChainResults) or results.motion is None:
        return OK
    return OK if results.lever_holds and all(m.met for m in measure_problem(results)) else CHECK_FAILED


def properties_met(results: Results | ChainResults) -> bool:
    """Return True if all properties requested in the file have their expected values."""
    return all(shown_property.met for shown_property in shown_properties(results))


def emit_results(results: Results | ChainResults, digits: AccuracyReport | None = None) -> None:
    """Write result.json to standard output in pieces, to save memory."""
    with words_of_files():
        sys.stdout.writelines(json_text(sections(results, None if digits is None else digits.json())))


def write_pictures(results: Results, out: Path | None, pictures: Mapping[str, bytes], picture_kind: str = "") -> None:
    """Write pictures to files.

    With an output folder they are written there together with the tables. Otherwise only the pictures are written to
    the usual folder of the problem; if that already contains files of the same names, to a separate folder.

    Args:
        results: results that the pictures show.
        out: requested output folder, or None.
        pictures: contents by file name.
        picture_kind: kind of the pictures, if the results do not determine it.
    """
    if out is not None:
        print_written(write_results(results, out, pictures.items(), part=picture_kind))
    elif pictures:
        usual, separate = (Path("outputs") / folder_name(f"{results.problem.name}{end}") for end in ("", "-drawings"))
        taken = not listed_files(usual).isdisjoint(pictures)
        with StagedFolder(separate if taken else usual) as staged:
            for name, content in pictures.items():
                staged.write(name, (content,))
        print_written(WrittenFolder(separate if taken else usual, staged.removed, usual if taken else None))


def write_sheets(results: Results, out: Path, pictures: Iterable[tuple[str, bytes]]) -> None:
    """Write sheets to the folder of the problem, and delete its older sheets of the same formats."""
    with StagedFolder(out / folder_name(results.problem.name)) as staged:
        for name, content in pictures:
            staged.write(name, (content,))
    formats = {Path(name).suffix for name in staged.names}
    old = [path.name for path in staged.folder.glob("sheet-*") if path.suffix in formats]
    for name in set(old) - staged.names:
        (staged.folder / name).unlink()
    print_written(WrittenFolder(staged.folder, sorted(set(old) - staged.names), None))


def print_written(written: WrittenFolder) -> None:
    """Print where the results were written, and which files of earlier runs were removed or kept."""
    folder, removed, kept = written
    if kept is None:
        say(_("written: {folder}").format(folder=printable(folder)))
    else:
        say(
            _("written: {folder}; the folder {kept} with the results of another run is unchanged").format(
                folder=printable(folder), kept=printable(kept)
            )
        )
    if removed:
        text = _("removed from {folder}: {files} (files of an earlier run that this run does not write)")
        say(text.format(folder=printable(folder), files=", ".join(removed)))


def show_tables(results: Results | ChainResults, names: Iterable[str], accuracy: AccuracyReport | None = None) -> None:
    """Print the tables with these names; of a spatial chain, all tables.

    Of a long table only the rows of the detailed positions are printed.
    """
    screen = console()
    tables = walk(results, () if isinstance(results, ChainResults) else set(names))
    if accuracy is not None:
        tables = accuracy.with_bounds(tables)
        tables = map(with_bound_columns, tables) if accuracy.full else tables
    for table in tables:
        print_table(table, results.problem.units, screen, detailed_rows(results, table))


def detailed_rows(results: Results | ChainResults, table: Table) -> set[int] | None:
    """Return the indices of the rows of a long table that belong to detailed positions; None for all rows.

    If no detailed positions are requested, the rows of the first position are returned.
    """
    if isinstance(results, ChainResults) or not table.long:
        return None
    chosen = {results.numbers.index(n) for n in results.problem.request.detail if n in results.numbers}
    per = table.rows // max(len(results.numbers), 1)
    return {k * per + i for k in chosen or {0} for i in range(per)}
