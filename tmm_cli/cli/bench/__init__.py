"""`tmm bench`: measurements. A new one is a file here, with its measurement and its chart in `tmm_cli/bench`."""

from __future__ import annotations

from collections.abc import Sequence

import typer

from tmm_cli.cli.app import add_commands

MEASUREMENTS = {
    "accuracy": "Time of a position against its error, of many methods.",
    "grading": "Time and memory of grading a group, mistakes named rightly.",
    "savings": "What is saved by computing no more than what is asked.",
    "speed": "Time of a position, beside code by hand and other programs.",
    "stability": "Every method as it comes near what kills it.",
    "synthesis": "Candidates a second, how near seeds come to the best known.",
}


def group(words: Sequence[str]) -> typer.Typer:
    """The command with the measurement that the further words of a command line ask for."""
    app = typer.Typer(
        name="bench",
        help="Measure speed, accuracy, stability, savings and synthesis on this machine.",
        no_args_is_help=True,
        rich_markup_mode=None,
    )
    app.callback()(_together)
    add_commands(app, __name__, MEASUREMENTS, words)
    return app


def _together() -> None:
    """One measurement alone is a command of its group too."""
