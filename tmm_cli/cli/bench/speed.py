"""`tmm bench speed`."""

from __future__ import annotations

from tmm_cli.bench import measure_speed, speed_charts
from tmm_cli.cli.bench.finish import Out, Reduced, finish
from tmm_cli.cli.common import Json
from tmm_cli.cli.talk import say


def speed(reduced: Reduced = False, out: Out = None, as_json: Json = False) -> None:
    """Time a position against code written by hand for one mechanism, other programs, and growing problems.

    Exit code 1 when a target is missed, of a reduced run by more than twice.
    """
    finish("speed", measure_speed(reduced=reduced, progress=say), speed_charts, out, as_json)
