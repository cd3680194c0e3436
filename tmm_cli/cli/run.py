"""`tmm run`."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from tmm_cli.cli.chains import report_chain, solved_any
from tmm_cli.cli.common import Digits, Files, Json, Position, bounds_of, checked, each, emit_results, say, show
from tmm_cli.errors import _

if TYPE_CHECKING:
    from tmm_cli.analysis.pipeline import Results


SHOWN = ("synthesis-found", "synthesis-measured", "structure", "links", "groups", "quality", "cycle")


def run(
    files: Files,
    out: Annotated[Path, typer.Option("--out", "-o", metavar="DIR", help="Folder of the results.")] = Path("outputs"),
    as_json: Json = False,
    position: Position = None,
    digits: Digits = False,
    drawings: Annotated[bool, typer.Option(help="Draw the mechanism, plans, lever and diagrams.")] = True,
) -> None:
    """Compute a problem whole and write its tables, drawings and result.json to DIR/<problem>/."""

    def work(file: str) -> int:
        from tmm_cli.analysis.spatial_chain import ChainResults
        from tmm_cli.results.output import write_results
        from tmm_cli.results.warnings import warnings

        results = solved_any(file, "forces", position)
        if isinstance(results, ChainResults):  # without dimensions there is its structure only
            return report_chain(results, as_json, out, quiet=len(files) > 1)
        found = bounds_of(results, digits)
        folder = write_results(results, out, drawn(results) if drawings else (), found)
        if as_json:
            emit_results(results, found)
        elif len(files) == 1:
            show(results, SHOWN, found)
        for warning in warnings(results):
            say(_("warning: {warning}").format(warning=f"{results.problem.name}: {warning}"))
        say(_("written: {folder}").format(folder=folder))
        return checked(results)

    def drawn(results: Results) -> Iterable[tuple[str, bytes]]:
        from tmm_cli.draw import files as drawing_files

        return drawing_files(results)

    each(files, work, as_json=as_json, out=out, headed=False)
