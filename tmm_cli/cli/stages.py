"""Commands for single stages: `tmm structure`, `tmm kinematics`, `tmm forces`, `tmm dynamics`."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from tmm_cli.cli.common import (
    Files,
    Json,
    Out,
    Position,
    Settings,
    Tables,
    Variant,
    Variants,
    WithDigits,
    draw_pictures,
    for_each_file,
)
from tmm_cli.cli.opening import count_detailed_positions, open_problem, refuse_excess_work, variant_settings
from tmm_cli.cli.reporting import compute_file, report, write_pictures
from tmm_cli.cli.talk import say
from tmm_cli.language import _
from tmm_cli.mechanics.analysis import Results, with_assemblies, with_centres, with_extremes
from tmm_cli.mechanics.assembly import name_assembly_files
from tmm_cli.mechanics.structure import ChainResults
from tmm_cli.problem import ProblemError, translate_errors
from tmm_cli.synthesis import inputs_of, solve

Drawings = Annotated[
    bool, typer.Option("--drawings", help="Draw the structural scheme and each group, as PNG and SVG in outputs/.")
]
Driver = Annotated[
    str | None,
    typer.Option(
        "--driver", metavar="LINK", help="Use this link as input link; the groups may change.", show_default=False
    ),
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
    """Show the structure: mobility, pairs, Assur groups, link names, closed loops, redundant constraints.

    Redundant constraints are counted for the mechanism in space. A file may also give a spatial chain by its pairs
    alone.
    """
    names = ("structure", "properties", "links", "pairs", "groups", "contours", "space", "replacements")

    def work(file: str) -> int:
        values = variant_settings(file, variants, variant, settings)
        results = compute_file(
            file, "structure", driver=driver, drafted=not drawings, settings=values, drawings=drawings
        )
        if isinstance(results, ChainResults) or not drawings:
            return report(results, names, as_json, out, people=tables)
        code = report(results, names, as_json, None)
        pictures = dict(draw_pictures("whole", results))
        if not pictures:
            text = _(
                "the scheme is not drawn: the groups of {problem} cannot be assembled in the position of the sketch"
            )
            say(text.format(problem=results.problem.name))
        write_pictures(results, out, pictures)
        return code

    for_each_file(files, work, as_json=as_json, out=out)


INTERMITTENT = ("intermittent", "intermittent-cycle")
Assemblies = Annotated[
    bool, typer.Option("--assemblies", help="List and draw all real assemblies of the groups at one position.")
]
Centres = Annotated[
    bool, typer.Option("--centres", help="Find instantaneous centres and mechanical advantage at detailed positions.")
]
ExtremePlaces = Annotated[
    bool, typer.Option("--extremes", help="Find extreme positions of all points, links and sliding blocks.")
]
Of = Annotated[
    str,
    typer.Option(
        "--of",
        metavar="NAMES",
        help="Compute only these points, links, centres of mass, e.g. E,5,S3.",
        show_default=False,
    ),
]


def kinematics(
    files: Files,
    as_json: Json = False,
    out: Out = None,
    position: Position = None,
    assemblies: Assemblies = False,
    centres: Centres = False,
    extremes: ExtremePlaces = False,
    of: Of = "",
    digits: WithDigits = False,
    settings: Settings = None,
    variants: Variants = None,
    variant: Variant = None,
    tables: Tables = None,
) -> None:
    """Show positions, velocities, accelerations and transfer functions of points, links and prismatic pairs."""
    requested = [name.strip() for name in of.split(",") if name.strip()]
    usual = ("quality", "properties", *INTERMITTENT, "pressure", "cycle", "points", "link-motion", "slides", "centres")
    names = ("points", "link-motion") if requested else usual

    def work(file: str) -> int:
        values = variant_settings(file, variants, variant, settings)

        if assemblies:
            return _list_assemblies(file, as_json, out, position, values)
        problem = open_problem(file, values, position, digits)
        if centres or problem.whole.request.centres:
            number = len(position) if position else count_detailed_positions(problem.whole)
            refuse_excess_work(problem.whole, position, digits=digits, centres=number)
        results = solve(problem, "kinematics", position, requested)
        if extremes:
            results = with_extremes(results)
        if centres:
            return _draw_centres(with_centres(results), as_json, out)
        return report(results, ("extremes",) if extremes else names, as_json, out, digits, tables)

    for_each_file(files, work, as_json=as_json, out=out)


def _draw_centres(results: Results, as_json: bool, out: Path | None) -> int:
    """List and draw the instantaneous centres of rotation, and return the exit code."""
    code = report(results, ("extremes", "centres", "advantage"), as_json, None)
    write_pictures(results, out, dict(draw_pictures("centres", results)))
    return code


def _list_assemblies(
    file: str, as_json: bool, out: Path | None, positions: Sequence[int] | None, settings: Sequence[str] | None
) -> int:
    """List and draw every real assembly of the groups, and return the exit code. Raises ProblemError."""
    problem = open_problem(file, settings).whole
    with translate_errors(problem):
        results = with_assemblies(inputs_of(problem), positions, problem)
    code = report(results, [stem for stem, *__ in name_assembly_files(results.assemblies or ())], as_json, None)
    for listed in results.assemblies or ():
        if listed.undecided is not None:
            text = _("the sketch does not determine the assembly of {group}; all assemblies are listed")
            say(text.format(group=listed.undecided.title))
            if positions and listed.number is None:
                say(
                    _(
                        "positions have no numbers until the assembly is determined; the list is for the position "
                        "of the "
                        "sketch"
                    )
                )
        for group in listed.lost:
            say(
                _(
                    "group {group} is omitted: the links to which it is attached cannot be assembled in this position"
                ).format(group=group.title)
            )
    write_pictures(results, out, dict(draw_pictures("assemblies", results)))
    return code


ExtremeReactions = Annotated[
    bool, typer.Option("--extremes", help="Find the largest and smallest reactions over the cycle.")
]
Hodographs = Annotated[bool, typer.Option("--hodographs", help="Draw the hodograph of every reaction.")]


def forces(
    files: Files,
    as_json: Json = False,
    out: Out = None,
    position: Position = None,
    extremes: ExtremeReactions = False,
    hodographs: Hodographs = False,
    digits: WithDigits = False,
    settings: Settings = None,
    variants: Variants = None,
    variant: Variant = None,
    tables: Tables = None,
) -> None:
    """Show loads, reactions in all pairs, the balancing moment or force, and the Zhukovsky lever."""
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
        values = variant_settings(file, variants, variant, settings)
        results = solve(open_problem(file, values, position, digits), "forces", position)
        if extremes:
            results = with_extremes(results)
        code = report(
            results, ("extremes",) if extremes else names, as_json, None if hodographs else out, digits, tables
        )
        if hodographs:
            write_pictures(results, out, dict(draw_pictures("hodographs", results)), "hodographs")
        return code

    for_each_file(files, work, as_json=as_json, out=out)


DYNAMICS_TABLES = ("dynamics", "law-of-motion", "balancing", "shaking")


def dynamics(
    files: Files,
    as_json: Json = False,
    out: Out = None,
    position: Position = None,
    digits: WithDigits = False,
    settings: Settings = None,
    variants: Variants = None,
    variant: Variant = None,
) -> None:
    """Show the law of motion (driving moment or motor, flywheel, speeds of the driver) and balancing."""

    def work(file: str) -> int:
        problem = open_problem(file, variant_settings(file, variants, variant, settings), position, digits).whole
        if problem.dynamics is None and problem.balancing is None:
            missing = ProblemError(
                _("the file has neither a block `dynamics` nor a block `balancing`"),
                path=("dynamics",),
                allowed="dynamics: {delta: 1/30}, balancing: {counterweights: {1: {}}}",
            )
            raise missing.located(problem.file, problem.source)
        return report(solve(problem, "forces", position), DYNAMICS_TABLES, as_json, out, digits)

    for_each_file(files, work, as_json=as_json, out=out)
