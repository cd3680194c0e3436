"""`tmm bench synthesis`."""

from __future__ import annotations

from tmm_cli.bench import measure_searches, search_charts
from tmm_cli.cli.bench.finish import Out, Reduced, finish
from tmm_cli.cli.common import Json
from tmm_cli.cli.talk import say


def synthesis(reduced: Reduced = False, out: Out = None, as_json: Json = False) -> None:
    """Count candidates a second of the optimal synthesis, and how near 10 seeds come to the best known.

    Exit code 1 when a target is missed, of a reduced run by more than twice.
    """
    finish("synthesis", measure_searches(reduced=reduced, progress=say), search_charts, out, as_json)
