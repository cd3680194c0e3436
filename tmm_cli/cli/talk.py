"""What every file of the command line leans on: exit codes, and where talk goes."""

from __future__ import annotations

import typer

OK, CHECK_FAILED, BAD_INPUT = 0, 1, 2


def say(text: str) -> None:
    """Talk goes to standard error."""
    typer.echo(text, err=True)
