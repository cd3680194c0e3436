"""`tmm bench accuracy`."""

from __future__ import annotations

from typing import Annotated

import typer

from tmm_cli.bench import REFERENCE_NAMES, accuracy_charts, measure_accuracy
from tmm_cli.cli.bench.finish import Out, Reduced, chosen, finish
from tmm_cli.cli.common import Json
from tmm_cli.cli.talk import say

Linkages = Annotated[
    list[str] | None,
    typer.Option("--linkage", metavar="NAME", help="This linkage only (may be repeated).", show_default=False),
]


def accuracy(linkage: Linkages = None, reduced: Reduced = False, out: Out = None, as_json: Json = False) -> None:
    """Time a position against largest relative error of many methods, on five linkages known to 50 digits.

    Exit code 1 when the product itself misses its targets: 1e-14 for positions, 1e-13 for all else.
    """
    names = chosen(linkage, REFERENCE_NAMES, "there is no reference linkage {name}; there are {names}")
    finish("accuracy", measure_accuracy(names, reduced=reduced, progress=say), accuracy_charts, out, as_json)
