"""Command `tmm run`: computes problems and writes tables, drawings and result.json."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tmm_cli.cli.common import (
    Files,
    Folder,
    Json,
    Position,
    Settings,
    Tables,
    Variant,
    Variants,
    WithDigits,
    draw_pictures,
    for_each_file,
)
from tmm_cli.cli.opening import variant_settings
from tmm_cli.cli.reporting import accuracy_of, compute_file, emit_results, find_exit_code, print_written, show_tables
from tmm_cli.cli.talk import warn
from tmm_cli.mechanics.structure import ChainResults
from tmm_cli.reports import collect_warnings, write_results

SHOWN = (
    "synthesis-found",
    "synthesis-measured",
    "structure",
    "links",
    "groups",
    "quality",
    "properties",
    "intermittent",
    "intermittent-cycle",
    "cycle",
    "dynamics",
    "checks",
)


def run(
    files: Files,
    out: Folder = Path("outputs"),
    as_json: Json = False,
    position: Position = None,
    digits: WithDigits = False,
    settings: Settings = None,
    variants: Variants = None,
    variant: Variant = None,
    tables: Tables = None,
    drawings: Annotated[bool, typer.Option(help="Draw the mechanism, plans, lever and diagrams.")] = True,
) -> None:
    """Compute a problem and write tables, drawings and result.json to DIR/<problem>/."""

    def work(file: str) -> int:
        values = variant_settings(file, variants, variant, settings)
        results = compute_file(file, "forces", position, settings=values, digits=digits, drawings=drawings)
        moves = drawings and not isinstance(results, ChainResults)
        pictures = draw_pictures("whole", results, quiet=len(files) > 1) if moves else None
        accuracy = accuracy_of(results, digits)
        written = write_results(results, out, pictures, accuracy, tables)
        if as_json:
            emit_results(results, accuracy)
        elif len(files) == 1:
            show_tables(results, SHOWN, accuracy)
        for warning in collect_warnings(results):
            warn(f"{results.problem.name}: {warning}")
        print_written(written)
        return find_exit_code(results)

    for_each_file(files, work, as_json=as_json, out=out, headed=False)
