"""`tmm structure`."""

from __future__ import annotations

from typing import Annotated

import typer

from tmm_cli.cli.common import Files, Json, Out, Settings, Tables, Variant, Variants, drawn, each
from tmm_cli.cli.opening import variant_settings
from tmm_cli.cli.reporting import computed, report, write_pictures
from tmm_cli.cli.talk import say
from tmm_cli.language import _
from tmm_cli.mechanics.structure import ChainResults

Drawings = Annotated[
    bool, typer.Option("--drawings", help="Draw the structural scheme and the groups apart: PNG, SVG in outputs/.")
]
Driver = Annotated[
    str | None,
    typer.Option("--driver", metavar="LINK", help="Drive this link instead: other groups.", show_default=False),
]


def structure(
    files: Files,
    as_json: Json = False,
    out: Out = None,
    drawings: Drawings = False,
    driver: Driver = None,
    settings: Settings = None,
    variants: Variants = None,
    variant: Variant = None,
    tables: Tables = None,
) -> None:
    """Mobility, pairs, Assur groups, names of links; contours and redundant constraints in space; chains by pairs."""
    names = ("structure", "properties", "links", "pairs", "groups", "contours", "space", "replacements")

    def work(file: str) -> int:
        own = variant_settings(file, variants, variant, settings)
        results = computed(file, "structure", driver=driver, drafted=not drawings, settings=own, drawings=drawings)
        if isinstance(results, ChainResults) or not drawings:
            return report(results, names, as_json, out, people=tables)
        code = report(results, names, as_json, None)
        pictures = dict(drawn("whole", results))
        if not pictures:
            text = _("not drawn: the groups of {problem} cannot be assembled at the sketch")
            say(text.format(problem=results.problem.name))
        write_pictures(results, out, pictures)
        return code

    each(files, work, as_json=as_json, out=out)
