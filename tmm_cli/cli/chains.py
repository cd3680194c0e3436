"""Commands on a file that gives a chain by pairs alone: there is only its structure."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from tmm_cli.cli.common import OK, console, emit_results, say
from tmm_cli.errors import _

if TYPE_CHECKING:
    from tmm_cli.analysis.pipeline import Results, Stage
    from tmm_cli.analysis.spatial_chain import ChainResults


def solved_any(
    file: str, stage: Stage, positions: Sequence[int] | None = None, driver: str | None = None, *, drafted: bool = False
) -> Results | ChainResults:
    """Read and compute one file of either form, a linkage with another driver if one is named. Raises ProblemError.

    drafted: the structure without the lengths that a task of synthesis finds.
    """
    from tmm_cli.problem.build import is_chain
    from tmm_cli.problem.reader import read_file

    tree = read_file(file)
    if is_chain(tree):
        from tmm_cli import count
        from tmm_cli.problem.build_chain import build_chain

        return count(build_chain(tree))
    from tmm_cli import problem_of, redrive, solve, structure_of

    problem = problem_of(tree)
    if driver is not None:
        return solve(redrive(problem, driver), stage, positions)
    return structure_of(problem) if drafted else solve(problem, stage, positions)


def report_chain(results: ChainResults, as_json: bool, out: Path | None, *, quiet: bool = False) -> int:
    """Show the count as tables (unless quiet) or JSON and write the files if asked; the exit code."""
    from tmm_cli.results.reports import tables
    from tmm_cli.results.terminal import show

    if as_json:
        emit_results(results)
    elif not quiet:
        screen = console()
        for table in tables(results):
            show(table, results.problem.units, screen)
    if out is not None:
        from tmm_cli.results.output import write_results

        say(_("written: {folder}").format(folder=write_results(results, out)))
    return OK
