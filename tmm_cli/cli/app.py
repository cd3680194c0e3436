"""The command `tmm`. A new command is a file beside this one and a line here."""

from __future__ import annotations

import gc
import os
import sys
from typing import Annotated

import typer

from tmm_cli import __version__
from tmm_cli.cli import bench, check, explain, forces, kinematics, new, run, schema, schemes, structure

app = typer.Typer(
    name="tmm",
    help="Course-project calculator for the theory of mechanisms and machines: planar lever mechanisms.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)

app.command("run")(run.run)
app.command("structure")(structure.structure)
app.command("kinematics")(kinematics.kinematics)
app.command("forces")(forces.forces)
app.command("check")(check.check)
app.command("explain")(explain.explain)
app.command("new")(new.new)
app.command("schema")(schema.schema)
app.command("schemes")(schemes.schemes)
app.add_typer(bench.app, name="bench")


def _version(asked: bool) -> None:
    if asked:
        typer.echo(f"tmm {__version__}")
        raise typer.Exit


@app.callback()
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
    try:
        app()
    except BrokenPipeError:  # `tmm ... | head` is not an error
        sys.stderr.close()
        sys.exit(0)
