"""`tmm bench savings`."""

from __future__ import annotations

from tmm_cli.bench import measure_savings, savings_charts
from tmm_cli.cli.bench.finish import Out, Reduced, finish
from tmm_cli.cli.common import Json
from tmm_cli.cli.talk import say


def savings(reduced: Reduced = False, as_json: Json = False, out: Out = None) -> None:
    """Count and time what is saved by computing no more than what is asked; exit code 1 when something is not."""
    finish("savings", measure_savings(reduced=reduced, progress=say), savings_charts, out, as_json)
