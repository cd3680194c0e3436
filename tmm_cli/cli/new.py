"""`tmm new`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tmm_cli.cli.common import BAD_INPUT, say


def new(
    template: Annotated[str | None, typer.Argument(help="Which one; none: list them.", show_default=False)] = None,
    out: Annotated[
        Path | None, typer.Option("--out", "-o", metavar="FILE", help="Where to; - prints it.", show_default=False)
    ] = None,
) -> None:
    """Start a problem file from a commented template."""
    from tmm_cli.problem.errors import nearest
    from tmm_cli.problem.templates import template_text, templates

    known = templates()
    if template is None:
        for name, title in known.items():
            typer.echo(f"{name:15} {title}")
        return
    if template not in known:
        near = nearest(template, known)
        say(f"error: there is no template '{template}'\n  allowed: {', '.join(known)}"
            + (f"\n  did you mean '{near}'?" if near else ""))  # fmt: skip
        raise typer.Exit(BAD_INPUT)
    text = template_text(template)
    if out is not None and str(out) == "-":
        typer.echo(text, nl=False)
        return
    file = out or Path(f"{template}.yaml")
    try:
        with file.open("x", encoding="utf-8") as stream:
            stream.write(text)
    except FileExistsError:
        say(f"error: {file} is there already; name another file with -o")
        raise typer.Exit(BAD_INPUT) from None
    except OSError as error:
        say(f"error: {file}: {error.strerror}")
        raise typer.Exit(BAD_INPUT) from None
    say(f"written: {file}; next: tmm run {file}")
