"""Command `tmm explain`: explains how a file is understood and what is computed from it."""

from __future__ import annotations

from typing import Annotated

import typer

from tmm_cli.cli.common import Files, Settings, console, for_each_file
from tmm_cli.cli.opening import open_problem
from tmm_cli.cli.talk import OK
from tmm_cli.language import typeset
from tmm_cli.reports import explain_tables as tables, narrate_structure, print_on_terminal
from tmm_cli.synthesis import solve

Verbose = Annotated[
    bool, typer.Option("--verbose", "-v", help="Also show for how many positions each stage is computed.")
]


def explain(files: Files, settings: Settings = None, verbose: Verbose = False) -> None:
    """Explain how a file is understood, what is computed for each group, and what is omitted and why.

    The structure is described in sentences that can be used in an explanatory note.
    """

    def work(file: str) -> int:
        results = solve(open_problem(file, settings), "structure")
        screen = console()
        screen.print(f"{results.problem.name}: {results.problem.title}")
        for sentence in map(typeset, narrate_structure(results)):
            screen.print(sentence)
        for table in tables(results, verbose):
            print_on_terminal(table, results.problem.units, screen, most=None)  # no file contains all rows
        return OK

    for_each_file(files, work)
