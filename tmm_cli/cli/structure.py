"""`tmm structure`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from tmm_cli.cli.chains import report_chain, solved_any
from tmm_cli.cli.common import Files, Json, Out, each, report, say, write_pictures
from tmm_cli.errors import _

if TYPE_CHECKING:
    from tmm_cli.analysis.pipeline import Results

Drawings = Annotated[
    bool, typer.Option("--drawings", help="Draw the structural scheme and the groups apart: PNG, SVG in outputs/.")
]


Driver = Annotated[
    str | None,
    typer.Option("--driver", metavar="LINK", help="Drive this link instead: other groups.", show_default=False),
]


def structure(
    files: Files, as_json: Json = False, out: Out = None, drawings: Drawings = False, driver: Driver = None
) -> None:
    """Mobility, pairs, Assur groups, names of links; contours and redundant constraints in space; chains by pairs."""
    names = ("structure", "links", "pairs", "groups", "contours", "space", "replacements")

    def work(file: str) -> int:
        from tmm_cli.analysis.spatial_chain import ChainResults

        results = solved_any(file, "structure", None, driver, drafted=not drawings)
        if isinstance(results, ChainResults):
            return report_chain(results, as_json, out)
        code = report(results, names, as_json, None if drawings else out)
        if drawings:
            _draw(results, out)
        return code

    each(files, work, as_json=as_json, out=out)


def _draw(results: Results, out: Path | None) -> None:
    from tmm_cli.draw import files as drawn

    pictures = dict(drawn(results))
    if not pictures:
        say(
            _("not drawn: the groups of {problem} cannot be assembled at the sketch").format(
                problem=results.problem.name
            )
        )
    write_pictures(results, out, pictures)
