"""`tmm forces`."""

from __future__ import annotations

from typing import Annotated

import typer

from tmm_cli.cli.common import Files, Json, Out, Position, Settings, Tables, Variant, Variants, WithDigits, drawn, each
from tmm_cli.cli.opening import opened, variant_settings
from tmm_cli.cli.reporting import report, write_pictures
from tmm_cli.mechanics.analysis import with_extremes
from tmm_cli.synthesis import solve

Extremes = Annotated[bool, typer.Option("--extremes", help="Largest and smallest reactions over the cycle.")]
Hodographs = Annotated[bool, typer.Option("--hodographs", help="Draw the hodograph of every reaction.")]


def forces(
    files: Files,
    as_json: Json = False,
    out: Out = None,
    position: Position = None,
    extremes: Extremes = False,
    hodographs: Hodographs = False,
    digits: WithDigits = False,
    settings: Settings = None,
    variants: Variants = None,
    variant: Variant = None,
    tables: Tables = None,
) -> None:
    """Loads, reactions in all pairs, what balances the driver, and the Zhukovsky lever."""
    names = (
        "properties",
        "cycle",
        "loads",
        "reactions",
        "pins",
        "transmission",
        "balance",
        "lever",
        "lever-drawn",
        "energy",
        "friction",
    )

    def work(file: str) -> int:
        own = variant_settings(file, variants, variant, settings)
        results = solve(opened(file, own, position, digits), "forces", position)
        if extremes:
            results = with_extremes(results)
        code = report(
            results, ("extremes",) if extremes else names, as_json, None if hodographs else out, digits, tables
        )
        if hodographs:
            write_pictures(results, out, dict(drawn("hodographs", results)), "hodographs")
        return code

    each(files, work, as_json=as_json, out=out)
