"""The command `tmm`. A new command is a file beside this one, with a function of the same name, and a word here."""

from __future__ import annotations

import gc
import os
import sys
from collections.abc import Iterable
from importlib import import_module
from typing import Annotated

import typer

from tmm_cli import __version__

COMMANDS = ("run", "structure", "kinematics", "forces", "check", "explain", "new", "schema", "schemes", "synthesis")
GROUPS = ("bench",)  # commands that have commands of their own, in `app`


def application(names: Iterable[str] = (*COMMANDS, *GROUPS)) -> typer.Typer:
    """The application with these commands: one that is asked for by its name needs no others made for it."""
    app = typer.Typer(
        name="tmm",
        help="Course-project calculator for the theory of mechanisms and machines: planar lever mechanisms.",
        no_args_is_help=True,
        add_completion=False,
        pretty_exceptions_enable=False,
        rich_markup_mode=None,
    )
    app.callback()(_options)
    for name in names:
        module = import_module(f"tmm_cli.cli.{name}")
        if name in GROUPS:
            app.add_typer(module.app)
        else:
            app.command(name)(getattr(module, name))
    return app


def _version(asked: bool) -> None:
    if asked:
        typer.echo(f"tmm {__version__}")
        raise typer.Exit


def _options(
    version: Annotated[bool, typer.Option("--version", callback=_version, is_eager=True, help="Print it.")] = False,
) -> None:
    pass


def main() -> None:
    """Entry point of the command."""
    gc.set_threshold(100_000)  # a short run makes little rubbish, and importing makes much that only looks like it
    # looking for plugins of pydantic reads every installed package; there is nothing here for them to do
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(encoding="utf-8", errors="replace")
    asked = [name for name in sys.argv[1:2] if name in (*COMMANDS, *GROUPS)]
    try:
        application(asked or (*COMMANDS, *GROUPS))()
    except BrokenPipeError:  # `tmm ... | head` is not an error
        sys.stderr.close()
        sys.exit(0)
