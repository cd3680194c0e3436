"""`tmm forces`."""

from __future__ import annotations

from tmm_cli.cli.common import Files, Json, Out, Position, Settings, Tables, Variant, Variants, WithDigits, each
from tmm_cli.cli.opening import opened, variant_settings
from tmm_cli.cli.reporting import report
from tmm_cli.library import solve


def forces(
    files: Files,
    as_json: Json = False,
    out: Out = None,
    position: Position = None,
    digits: WithDigits = False,
    settings: Settings = None,
    variants: Variants = None,
    variant: Variant = None,
    tables: Tables = None,
) -> None:
    """Loads, reactions in all pairs, what balances the driver, and the Zhukovsky lever."""
    names = ("cycle", "loads", "reactions", "pins", "balance", "lever", "energy", "friction")

    def work(file: str) -> int:
        own = variant_settings(file, variants, variant, settings)
        results = solve(opened(file, own, position, digits), "forces", position)
        return report(results, names, as_json, out, digits, tables)

    each(files, work, as_json=as_json, out=out)
