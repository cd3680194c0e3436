"""`tmm bench`: measurements. A new one is a file beside this one and a line here."""

from __future__ import annotations

import typer

from tmm_cli.cli import bench_accuracy, bench_savings, bench_speed, bench_stability, bench_synthesis

app = typer.Typer(
    name="bench",
    help="Measure speed, accuracy, stability, savings and synthesis on this machine.",
    no_args_is_help=True,
    rich_markup_mode=None,
)

app.command("accuracy")(bench_accuracy.accuracy)
app.command("savings")(bench_savings.savings)
app.command("speed")(bench_speed.speed)
app.command("stability")(bench_stability.stability)
app.command("synthesis")(bench_synthesis.synthesis)
