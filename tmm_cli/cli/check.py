"""`tmm check`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tmm_cli.cli.common import problems_in, progress, refusing
from tmm_cli.cli.golden_runs import compared, compared_grades, show_outcomes, write_junit
from tmm_cli.cli.talk import say
from tmm_cli.language import _

EXAMPLES = ("variants.csv", "*/variants.csv", "grading/*/variants.csv")  # beside the task of a graded example


def check(
    paths: Annotated[list[Path], typer.Argument(metavar="DIR|FILE...", help="A bank of problems.", show_default=False)],
    update: Annotated[bool, typer.Option("--update", help="Rewrite the expected values.")] = False,
    junit: Annotated[
        Path | None, typer.Option("--junit", metavar="FILE", help="Write a JUnit report too.", show_default=False)
    ] = None,
) -> None:
    """Compute every problem again, also in folders of DIR, and compare it with expected/<problem>.json beside it.

    Graded examples are graded again too. What is expected is a golden run: what an earlier version computed. Every
    quantity of result.json is compared, relative to its largest value in the cycle; the tolerance is in the expected
    file. Exit code 1 when something differs.
    """
    tables = [table for path in paths if path.is_dir() for depth in EXAMPLES for table in sorted(path.glob(depth))]
    tasks = [table.with_name("task.yaml") for table in tables if table.with_name("task.yaml").is_file()]
    files = [*(f for f in problems_in(paths, tasks) if f not in tasks), *tasks]
    outcomes = [
        compared_grades(Path(name), update) if Path(name) in tasks else compared(Path(name), update)
        for name in progress([str(f) for f in files])
    ]
    show_outcomes(outcomes)
    if junit is not None:
        with refusing():
            write_junit(junit, outcomes)
    differing = sum(bool(outcome.wrong or outcome.different) for outcome in outcomes)
    say(_("{count} problems, {differing} differ").format(count=len(outcomes), differing=differing))
    raise typer.Exit(max(outcome.code for outcome in outcomes))
