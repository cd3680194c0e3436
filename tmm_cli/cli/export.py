"""`tmm export`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tmm_cli.cli.common import new_file, refusing
from tmm_cli.cli.opening import opened
from tmm_cli.cli.talk import printable, say
from tmm_cli.language import _
from tmm_cli.problem import chosen_names
from tmm_cli.reports import EXPORTS
from tmm_cli.synthesis import solve


def export(
    file: Annotated[str, typer.Argument(metavar="FILE", help="A problem file.")],
    to: Annotated[str, typer.Option("--to", help="The program: pylinkage.")],
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", metavar="FILE", help="Where to; - prints it; NAME.json here.", show_default=False),
    ] = None,
) -> None:
    """Write the linkage for another program."""
    with refusing():
        name, *__ = chosen_names(to, EXPORTS, "--to", _("there is no such program to export to"))
        text, left = EXPORTS[name](solve(opened(file), "kinematics"))
        target = out or Path(f"{Path(file).stem}.json")
        if new_file(target, text):
            say(_("written: {file}").format(file=printable(target)))
        for line in left:
            say(_("not taken over: {line}").format(line=line))
