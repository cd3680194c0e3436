"""`tmm bench stability`."""

from __future__ import annotations

from typing import Annotated

import typer

from tmm_cli.bench import BY_NAME, measure_stability, stability_charts
from tmm_cli.cli.bench.finish import Out, Reduced, chosen, finish
from tmm_cli.cli.common import Json
from tmm_cli.cli.talk import say

Families = Annotated[
    list[str] | None,
    typer.Option("--family", metavar="NAME", help="This family only (may be repeated).", show_default=False),
]


def stability(family: Families = None, reduced: Reduced = False, out: Out = None, as_json: Json = False) -> None:
    """Every method as it comes near what kills it, and the distance at which it first lies, against 50 digits.

    Exit code 1 when a value of the product is off by more than its bound, or when fewer than nine of ten of its bounds
    are within 100 times the true error.
    """
    names = chosen(family, BY_NAME, "there is no family {name}; there are {names}")
    finish("stability", measure_stability(names, reduced=reduced, progress=say), stability_charts, out, as_json)
