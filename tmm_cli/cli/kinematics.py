"""`tmm kinematics`."""

from __future__ import annotations

from typing import Annotated

import typer

from tmm_cli.cli.common import Digits, Files, Json, Out, Position, each, report, solved

Assemblies = Annotated[
    bool, typer.Option("--assemblies", help="List and draw every real assembly of the groups at one position.")
]


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
    of: Of = "",
    digits: Digits = False,
) -> None:
    """Positions, velocities, accelerations, transfer functions; of points, links and sliding pairs."""
    asked = [name.strip() for name in of.split(",") if name.strip()]
    names = ("points", "link-motion") if asked else ("quality", "pressure", "cycle", "points", "link-motion", "slides")

    def work(file: str) -> int:
        if assemblies:
            from tmm_cli.cli.assemblies import list_assemblies

            return list_assemblies(file, as_json, out, position)
        return report(solved(file, "kinematics", position, asked), names, as_json, out, digits)

    each(files, work, as_json=as_json, out=out)
