"""`tmm bench grading`."""

from __future__ import annotations

from typing import Annotated

import typer

from tmm_cli.bench import measure_grading
from tmm_cli.cli.bench.finish import Out, Reduced, finish
from tmm_cli.cli.common import Json
from tmm_cli.cli.talk import say


def grading(
    reduced: Reduced = False,
    full: Annotated[bool, typer.Option("--full", help="A group of 100 000 students too.")] = False,
    out: Out = None,
    as_json: Json = False,
) -> None:
    """Time and memory of grading a group, how they grow, and how often mistakes are named rightly.

    Exit code 1 when a target is missed, of a reduced run by more than twice.
    """
    finish("grading", measure_grading(reduced=reduced, full=full, progress=say), lambda _: {}, out, as_json)
