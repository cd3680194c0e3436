"""`tmm explain`."""

from __future__ import annotations

from tmm_cli.cli.common import OK, Files, Settings, console, each


def explain(files: Files, settings: Settings = None) -> None:
    """Say what a file was understood to mean, what will be computed, by which group, what is skipped and why."""

    def work(file: str) -> int:
        from tmm_cli import solve
        from tmm_cli.cli.opening import opened
        from tmm_cli.results.explain import explain as tables
        from tmm_cli.results.terminal import show

        results = solve(opened(file, settings), "structure")
        screen = console()
        screen.print(f"{results.problem.name}: {results.problem.title}")
        for table in tables(results):
            show(table, results.problem.units, screen, most=None)  # there is no other place that has them all
        return OK

    each(files, work)
