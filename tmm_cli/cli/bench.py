"""`tmm bench`: measurements. A new one is a file beside this one and a line here."""

from __future__ import annotations

import typer

from tmm_cli.cli import bench_accuracy, bench_stability

app = typer.Typer(
    name="bench",
    help="Measure speed, accuracy and stability on this machine.",
    no_args_is_help=True,
    rich_markup_mode=None,
)

app.command("accuracy")(bench_accuracy.accuracy)
app.command("stability")(bench_stability.stability)


@app.callback()
def _group() -> None:
    """One command alone would else stand in the place of the group."""
