"""Command `tmm note`: writes the explanatory note of a course project."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tmm_cli import solve
from tmm_cli.cli.common import Files, Folder, Settings, Variant, Variants, for_each_file
from tmm_cli.cli.opening import count_detailed_positions, open_problem, refuse_excess_work, variant_settings
from tmm_cli.cli.talk import OK, printable, say, warn
from tmm_cli.drawing.run import position_remarks
from tmm_cli.language import _
from tmm_cli.note import FORMATS, formats_of, note as note_of
from tmm_cli.reports import collect_warnings, folder_name, write_atomically


def note(
    files: Files,
    formats: Annotated[
        str, typer.Option("--as", metavar="KINDS", help=f"Formats, separated by commas: {', '.join(FORMATS)}.")
    ] = "html",
    out: Folder = Path("outputs"),
    settings: Settings = None,
    variants: Variants = None,
    variant: Variant = None,
) -> None:
    """Write the explanatory note of a course project with formulas, numbers and results to DIR/<problem>/note.html."""

    def work(file: str) -> int:
        formats_chosen = formats_of(formats)
        problem = open_problem(file, variant_settings(file, variants, variant, settings))
        refuse_excess_work(problem.whole, None, detail=count_detailed_positions(problem.whole))
        results = solve(problem)
        for remark in position_remarks(results):
            say(remark)
        for warning in collect_warnings(results):
            warn(warning)
        written = note_of(results)
        for name in formats_chosen:
            target = out / folder_name(results.problem.name) / f"note.{name}"
            write_atomically(target, FORMATS[name](written))
            say(_("written: {folder}").format(folder=printable(target)))
        return OK

    for_each_file(files, work, out=out, headed=False)
