"""Commands `tmm import` and `tmm export`: exchange with other programs."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tmm_cli.cli.common import reporting_errors, write_new_file
from tmm_cli.cli.opening import open_problem
from tmm_cli.cli.talk import printable, say
from tmm_cli.language import _
from tmm_cli.problem import (
    ProblemError,
    build_any_problem,
    clean,
    format_path,
    parse_names,
    problem_file_text,
    read_file_text,
    read_mechanism,
    read_text,
)
from tmm_cli.reports import EXPORTS
from tmm_cli.synthesis import solve


def import_(
    file: Annotated[str, typer.Argument(metavar="FILE", help="File of pylinkage, PMKS+ or linkage/v2.")],
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", "-o", metavar="FILE", help="File to write; default: NAME.yaml; - prints it.", show_default=False
        ),
    ] = None,
) -> None:
    """Convert a file of another program to a problem file."""
    with reporting_errors():
        foreign = read_mechanism(read_file_text(file), file)
        target = out or Path(f"{Path(file).stem}.yaml")
        text = problem_file_text(foreign, Path(file).name)
        try:
            build_any_problem(read_text(text, str(target)))  # the written file must be readable
        except ProblemError as error:  # without line numbers: the user does not see this file
            message = _("the resulting problem file would be invalid: {reason}")
            reason = ": ".join(piece for piece in (format_path(error.path), error.message) if piece)
            raise ProblemError(
                message.format(reason=reason), found=error.found, allowed=error.allowed, file=file
            ) from None
        if write_new_file(target, text):
            say(_("written: {file}; next step: tmm run {file}").format(file=printable(target)))
        for line in foreign.left:
            say(_("not converted: {line}").format(line=clean(line, 300)))


def export(
    file: Annotated[str, typer.Argument(metavar="FILE", help="Problem file (YAML).")],
    to: Annotated[str, typer.Option("--to", help="Name of the program: pylinkage.")],
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", "-o", metavar="FILE", help="File to write; default: NAME.json; - prints it.", show_default=False
        ),
    ] = None,
) -> None:
    """Write the linkage of a problem for another program."""
    with reporting_errors():
        name, *__ = parse_names(to, EXPORTS, "--to", _("export to this program is not available"))
        text, left = EXPORTS[name](solve(open_problem(file), "kinematics"))
        target = out or Path(f"{Path(file).stem}.json")
        if write_new_file(target, text):
            say(_("written: {file}").format(file=printable(target)))
        for line in left:
            say(_("not converted: {line}").format(line=line))
