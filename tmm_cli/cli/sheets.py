"""Command `tmm sheets`: draws framed sheets to hand in."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated, Literal

import typer

from tmm_cli import solve
from tmm_cli.cli.common import Files, Folder, Settings, Variant, Variants, for_each_file
from tmm_cli.cli.drawing import run_on_all_cores
from tmm_cli.cli.opening import count_detailed_positions, open_problem, refuse_excess_work, variant_settings
from tmm_cli.cli.reporting import write_sheets
from tmm_cli.cli.talk import OK, say, warn
from tmm_cli.drawing.formats import FORMATS
from tmm_cli.drawing.layout import large_sheet_files, parse_formats, refuse_plans
from tmm_cli.drawing.run import position_remarks
from tmm_cli.reports import collect_warnings


def sheets(
    files: Files,
    paper: Annotated[Literal["A1", "A2", "A3"], typer.Option("--format", help="Paper size.")] = "A1",
    formats: Annotated[
        str, typer.Option("--as", metavar="KINDS", help=f"Formats, separated by commas: {', '.join(FORMATS)}.")
    ] = "pdf",
    out: Folder = Path("outputs"),
    positions: Annotated[
        Literal["all", "detail"], typer.Option(help="Positions for which velocity and acceleration plans are drawn.")
    ] = "detail",
    settings: Settings = None,
    variants: Variants = None,
    variant: Variant = None,
) -> None:
    """Draw framed sheets to scale and write them to DIR/<problem>/."""

    def work(file: str) -> int:
        formats_chosen = parse_formats(formats)
        problem = open_problem(file, variant_settings(file, variants, variant, settings))
        request = problem.whole.request
        detail, plans = (
            count_detailed_positions(problem.whole),
            (len(request.places) or request.count) * (positions == "all"),
        )
        refuse_plans(max(detail, plans))
        refuse_excess_work(problem.whole, None, detail=detail, large=True, plans=plans)
        results = solve(problem, "forces")
        for remark in position_remarks(results):
            say(remark)
        for warning in collect_warnings(results):
            warn(warning)
        runner = partial(run_on_all_cores, quiet=len(files) > 1)
        write_sheets(
            results,
            out,
            large_sheet_files(results, paper, formats_chosen, say, runner, all_positions=positions == "all"),
        )
        return OK

    for_each_file(files, work, out=out, headed=False)
