"""`tmm kinematics`."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from tmm_cli.cli.common import Files, Json, Out, Position, Settings, Tables, Variant, Variants, WithDigits, drawn, each
from tmm_cli.cli.opening import afford, count_detail, opened, variant_settings
from tmm_cli.cli.reporting import report, write_pictures
from tmm_cli.cli.talk import say
from tmm_cli.language import _
from tmm_cli.mechanics.analysis import Results, with_assemblies, with_centres, with_extremes
from tmm_cli.mechanics.assembly import listed
from tmm_cli.problem import in_words_of
from tmm_cli.synthesis import inputs_of, solve

INTERMITTENT = ("intermittent", "intermittent-cycle")
Assemblies = Annotated[
    bool, typer.Option("--assemblies", help="List and draw every real assembly of the groups at one position.")
]
Centres = Annotated[
    bool, typer.Option("--centres", help="Instantaneous centres in the positions in detail; mechanical advantage.")
]
Extremes = Annotated[bool, typer.Option("--extremes", help="Extreme places of all points, links and stones.")]
Of = Annotated[
    str,
    typer.Option("--of", metavar="NAMES", help="These points, links, centres of mass only: E,5,S3", show_default=False),
]


def kinematics(
    files: Files,
    as_json: Json = False,
    out: Out = None,
    position: Position = None,
    assemblies: Assemblies = False,
    centres: Centres = False,
    extremes: Extremes = False,
    of: Of = "",
    digits: WithDigits = False,
    settings: Settings = None,
    variants: Variants = None,
    variant: Variant = None,
    tables: Tables = None,
) -> None:
    """Positions, velocities, accelerations, transfer functions; of points, links and sliding pairs."""
    asked = [name.strip() for name in of.split(",") if name.strip()]
    usual = ("quality", "properties", *INTERMITTENT, "pressure", "cycle", "points", "link-motion", "slides", "centres")
    names = ("points", "link-motion") if asked else usual

    def work(file: str) -> int:
        own = variant_settings(file, variants, variant, settings)

        if assemblies:
            return _list_assemblies(file, as_json, out, position, own)
        problem = opened(file, own, position, digits)
        if centres or problem.whole.request.centres:
            number = len(position) if position else count_detail(problem.whole)
            afford(problem.whole, position, digits=digits, centres=number)
        results = solve(problem, "kinematics", position, asked)
        if extremes:
            results = with_extremes(results)
        if centres:
            return _draw_centres(with_centres(results), as_json, out)
        return report(results, ("extremes",) if extremes else names, as_json, out, digits, tables)

    each(files, work, as_json=as_json, out=out)


def _draw_centres(results: Results, as_json: bool, out: Path | None) -> int:
    """Instantaneous centres, listed and drawn; the exit code."""
    code = report(results, ("extremes", "centres", "advantage"), as_json, None)
    write_pictures(results, out, dict(drawn("centres", results)))
    return code


def _list_assemblies(
    file: str, as_json: bool, out: Path | None, positions: Sequence[int] | None, settings: Sequence[str] | None
) -> int:
    """Kinematics with every real assembly of the groups, listed and drawn; the exit code. Raises ProblemError."""
    problem = opened(file, settings).whole
    with in_words_of(problem):
        results = with_assemblies(inputs_of(problem), positions, problem)
    code = report(results, [stem for stem, *__ in listed(results.assemblies or ())], as_json, None)
    for here in results.assemblies or ():
        if here.undecided is not None:
            text = _("the sketch does not decide which assembly {group} has; all of them are listed")
            say(text.format(group=here.undecided.title))
            if positions and here.number is None:
                say(_("while the sketch decides nothing, positions have no numbers; listed at its own place"))
        for group in here.lost:
            say(_("{group} is not listed: links that it hangs on cannot be placed there").format(group=group.title))
    write_pictures(results, out, dict(drawn("assemblies", results)))
    return code
