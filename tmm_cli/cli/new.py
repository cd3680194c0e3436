"""Command `tmm new`: writes a commented problem file to start from."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tmm_cli.cli.common import reporting_errors, write_new_file
from tmm_cli.cli.talk import printable, say
from tmm_cli.language import _, language
from tmm_cli.problem import ProblemError, list_templates, nearest_name, template_text


def new(
    template: Annotated[
        str | None, typer.Argument(help="Name of the template; without it all are listed.", show_default=False)
    ] = None,
    out: Annotated[
        Path | None, typer.Option("--out", "-o", metavar="FILE", help="File to write; - prints it.", show_default=False)
    ] = None,
) -> None:
    """Create a problem file from a commented template."""
    templates = list_templates(language())
    if template is None:
        for name, title in templates.items():
            typer.echo(f"{name:15} {title}")
        return
    with reporting_errors():
        if template not in templates:
            raise ProblemError(
                _("there is no template called '{template}'").format(template=template),
                allowed=", ".join(templates),
                near=nearest_name(template, templates),
            )
        file = out or Path(f"{template}.yaml")
        named = None if str(file) == "-" else printable(file)
        if write_new_file(file, template_text(template, language(), named)):
            say(_("written: {file}; next step: tmm run {file}").format(file=printable(file)))
