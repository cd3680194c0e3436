"""`tmm bench`: a measurement is a file beside this one and a line here."""

from __future__ import annotations

import typer

from tmm_cli.cli.bench_savings import savings

app = typer.Typer(help="Measure what the program costs and what it is worth.", no_args_is_help=True)

app.command("savings")(savings)
