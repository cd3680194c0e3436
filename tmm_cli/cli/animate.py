"""`tmm animate`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tmm_cli import solve
from tmm_cli.animation import animation_page
from tmm_cli.cli.common import Settings, Variant, Variants, refusing
from tmm_cli.cli.opening import opened, variant_settings
from tmm_cli.cli.talk import printable, say, warn
from tmm_cli.language import _
from tmm_cli.reports import collect_warnings, folder_name, refuse_place, write_whole


def animate(
    file: Annotated[str, typer.Argument(metavar="FILE", help="A problem file (YAML).", show_default=False)],
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", "-o", metavar="FILE.html", help="The page; else outputs/<problem>.html.", show_default=False
        ),
    ] = None,
    settings: Settings = None,
    variants: Variants = None,
    variant: Variant = None,
) -> None:
    """Write a page on which the mechanism turns, with its plans of motion and diagrams; it needs no network."""
    with refusing():
        if out is not None:
            refuse_place(out, folder=False)
        problem = opened(file, variant_settings(file, variants, variant, settings))
        results = solve(problem)
        target = out or Path("outputs") / f"{folder_name(results.problem.name)}.html"
        write_whole(target, animation_page(results).encode())
        for warning in collect_warnings(results):
            warn(warning)
        say(_("written: {folder}").format(folder=printable(target)))
