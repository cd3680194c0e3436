"""Commands `tmm animate` and `tmm gallery`: web pages with moving mechanisms."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from tmm_cli import solve
from tmm_cli.animation import Card, animation_page, gallery_page, make_card
from tmm_cli.cli.common import Settings, Variant, Variants, problems_in, reporting_errors
from tmm_cli.cli.drawing import run_on_all_cores
from tmm_cli.cli.opening import open_problem, variant_settings
from tmm_cli.cli.talk import BAD_INPUT, CHECK_FAILED, printable, say, warn
from tmm_cli.language import _
from tmm_cli.problem import ProblemError
from tmm_cli.reports import collect_warnings, folder_name, refuse_unwritable, write_atomically


def animate(
    file: Annotated[str, typer.Argument(metavar="FILE", help="Problem file (YAML).", show_default=False)],
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            "-o",
            metavar="FILE.html",
            help="Page to write; default: outputs/<problem>.html.",
            show_default=False,
        ),
    ] = None,
    settings: Settings = None,
    variants: Variants = None,
    variant: Variant = None,
) -> None:
    """Write a web page with the moving mechanism, its motion plans and its diagrams. The page works offline."""
    with reporting_errors():
        if out is not None:
            refuse_unwritable(out, folder=False)
        problem = open_problem(file, variant_settings(file, variants, variant, settings))
        results = solve(problem)
        page = out or Path("outputs") / f"{folder_name(results.problem.name)}.html"
        write_atomically(page, animation_page(results).encode())
        for warning in collect_warnings(results):
            warn(warning)
        say(_("written: {folder}").format(folder=printable(page)))


def gallery(
    paths: Annotated[
        list[Path], typer.Argument(metavar="DIR|FILE...", help="Problem files, or folders of them.", show_default=False)
    ],
    out: Annotated[Path, typer.Option("--out", "-o", metavar="DIR", help="Folder for index.html.")] = Path(
        "outputs/gallery"
    ),
) -> None:
    """Write a web page with many moving mechanisms. The page works offline.

    Mechanisms can be searched by class, group, purpose and property. A file that cannot be computed is reported and
    omitted; the exit code is then 1.
    """
    with reporting_errors():
        refuse_unwritable(out / "index.html", folder=False)
    outcomes = list(run_on_all_cores([partial(_try_card, str(file)) for file in problems_in(paths)]))
    cards = [outcome for outcome in outcomes if isinstance(outcome, Card)]
    for outcome in outcomes:
        if isinstance(outcome, str):
            say(_("error: {error}").format(error=outcome))
    if not cards:
        raise typer.Exit(BAD_INPUT)
    with reporting_errors():
        target = out / "index.html"
        write_atomically(target, gallery_page(cards).encode())
        say(_("written: {folder}").format(folder=printable(target)))
    if len(cards) < len(outcomes):
        say(_("files omitted: {count}").format(count=len(outcomes) - len(cards)))
        raise typer.Exit(CHECK_FAILED)


def _try_card(file: str) -> Card | str:
    """Create the gallery card of a file; return an error message if the file cannot be computed."""
    try:
        return make_card(file)
    except ProblemError as error:
        return str(error)
