"""`tmm bench synthesis`."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from tmm_cli.cli.bench_common import Out, Reduced, finish
from tmm_cli.cli.common import Json, say

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from tmm_cli.bench.searches import Searches
    from tmm_cli.results.table import Table


def synthesis(reduced: Reduced = False, out: Out = None, as_json: Json = False) -> None:
    """Count candidates a second of the optimal synthesis, and how near 10 seeds come to the best known.

    Exit code 1 when a target is missed, of a reduced run by more than twice.
    """
    from tmm_cli.bench.searches import measure

    measured = measure(reduced=reduced, progress=say)
    finish("synthesis", measured, lambda: _tables(measured), lambda: _charts(measured), out, as_json=as_json)


def _tables(measured: Searches) -> Iterator[Table]:
    from tmm_cli.results.table import Column, Table
    from tmm_cli.words import say as word

    def table(name: str, rows: list[tuple[str, ...]], *headers: str) -> Table:
        columns = tuple(
            Column(word(f"searches.{header}"), [row[k] for row in rows]) for k, header in enumerate(headers)
        )
        return Table(name, word(f"searches.{name}_title", **known), columns)

    runs = measured.known["runs"]
    known = {
        "problem": measured.known["problem"], "objective": measured.known["objective"], "runs": len(runs),
        "evaluations": max(run["evaluations"] for run in runs),
    }  # fmt: skip
    yield table(
        "rates",
        [
            (r.problem, str(r.parameters), str(r.constraints), str(r.positions), str(r.operations), str(r.generation),
             f"{r.per_second:.0f}", "" if r.target is None else f"{r.target:.0f}") for r in measured.rates
        ],
        "problem", "parameters", "constraints", "positions", "operations", "generation", "per_second", "at_least",
    )  # fmt: skip
    yield table(
        "found",
        [
            (str(f.seed), f"{f.objective:.9g}", f"{100 * f.off:.2g}", str(f.evaluations), f"{f.searching:.2f}",
             f"{f.polishing:.2f}") for f in measured.found
        ],
        "seed", "objective", "off", "evaluations", "searching", "polishing",
    )  # fmt: skip


def _charts(measured: Searches) -> dict[str, Figure]:
    from tmm_cli.bench.chart_searches import chart

    return {"synthesis": chart(measured)}
