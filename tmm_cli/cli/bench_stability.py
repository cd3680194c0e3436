"""`tmm bench stability`."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated

import typer

from tmm_cli.cli.bench_common import Out, Reduced, chosen, finish
from tmm_cli.cli.common import Json, say

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from tmm_cli.bench.stability import Stability
    from tmm_cli.results.table import Table

Families = Annotated[
    list[str] | None,
    typer.Option("--family", metavar="NAME", help="This family only (may be repeated).", show_default=False),
]


def stability(family: Families = None, reduced: Reduced = False, out: Out = None, as_json: Json = False) -> None:
    """Every method as it comes near what kills it, and the distance at which it first lies, against 50 digits.

    Exit code 1 when a value of the product is off by more than its bound, or when fewer than nine of ten of its bounds
    are within 100 times the true error.
    """
    from tmm_cli.bench.families import BY_NAME
    from tmm_cli.bench.stability import WIDE, measure
    from tmm_cli.words import say as word

    measured = measure(chosen(family, BY_NAME, "stability.no_family"), reduced=reduced, progress=say)
    sharp = word("stability.sharp", count=len(measured.widths), share=f"{measured.sharp:.1%}", wide=f"{WIDE:g}")
    finish(
        "stability", measured, lambda: _tables(measured), lambda: _charts(measured), out, as_json=as_json, more=[sharp]
    )


def _tables(measured: Stability) -> Iterator[Table]:
    """The table of first lies: a row a method, a column a family."""
    from tmm_cli.results.table import Column, Table
    from tmm_cli.words import say as word

    def first(family: str, method: str) -> str:
        if not measured.of(family, method):
            return "-"
        distance = measured.lies(family, method)
        return word("stability.never") if distance is None else f"{distance:.0e}".replace("e-0", "e-")

    columns = [Column(word("stability.method"), list(measured.methods))]
    columns += [Column(family, [first(family, method) for method in measured.methods]) for family in measured.families]
    yield Table("stability", word("stability.title"), tuple(columns))


def _charts(measured: Stability) -> dict[str, Figure]:
    from tmm_cli.bench.stability_chart import charts

    return {f"stability-{number}": figure for number, figure in enumerate(charts(measured), 1)}
