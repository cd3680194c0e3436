"""`tmm run`."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from tmm_cli.analysis.spatial_chain import ChainResults
from tmm_cli.cli.common import Files, Json, Position, Settings, Tables, Variant, Variants, WithDigits, each
from tmm_cli.cli.opening import variant_settings
from tmm_cli.cli.reporting import bounds_of, checked, computed, emit_results, say_written, show
from tmm_cli.cli.talk import say
from tmm_cli.language import _
from tmm_cli.results.output import write_results
from tmm_cli.results.warnings import warnings

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
    out: Annotated[Path, typer.Option("--out", "-o", metavar="DIR", help="Folder of the results.")] = Path("outputs"),
    as_json: Json = False,
    position: Position = None,
    digits: WithDigits = False,
    settings: Settings = None,
    variants: Variants = None,
    variant: Variant = None,
    tables: Tables = None,
    drawings: Annotated[bool, typer.Option(help="Draw the mechanism, plans, lever and diagrams.")] = True,
) -> None:
    """Compute a problem whole and write its tables, drawings and result.json to DIR/<problem>/."""

    def work(file: str) -> int:
        own = variant_settings(file, variants, variant, settings)
        results = computed(file, "forces", position, settings=own, digits=digits, drawings=drawings)
        pictures: Iterable[tuple[str, bytes]] | None = None
        if drawings and not isinstance(results, ChainResults):
            from tmm_cli.cli.drawing import by_all_cores
            from tmm_cli.draw import files as drawn

            pictures = drawn(results, say, partial(by_all_cores, quiet=len(files) > 1))
        found = bounds_of(results, digits)
        written = write_results(results, out, pictures, found, tables)
        if as_json:
            emit_results(results, found)
        elif len(files) == 1:
            show(results, SHOWN, found)
        for warning in warnings(results):
            say(_("warning: {warning}").format(warning=f"{results.problem.name}: {warning}"))
        say_written(written)
        return checked(results)

    each(files, work, as_json=as_json, out=out, headed=False)
