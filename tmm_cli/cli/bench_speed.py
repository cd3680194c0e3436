"""`tmm bench speed`."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from tmm_cli.cli.bench_common import Out, Reduced, finish
from tmm_cli.cli.common import Json, say

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from tmm_cli.bench.speed import Speed
    from tmm_cli.results.table import Table


def speed(reduced: Reduced = False, out: Out = None, as_json: Json = False) -> None:
    """Time a position against code written by hand for one mechanism, other programs, and growing problems.

    Exit code 1 when a target is missed, of a reduced run by more than twice.
    """
    from tmm_cli.bench.speed import measure

    measured = measure(reduced=reduced, progress=say)
    finish("speed", measured, lambda: _tables(measured), lambda: _charts(measured), out, as_json=as_json)


def _tables(measured: Speed) -> Iterator[Table]:
    from tmm_cli.bench.speed import RIVALS
    from tmm_cli.results.table import Column, Table
    from tmm_cli.words import say as word

    def table(name: str, rows: list[tuple[str, ...]], *headers: str) -> Table:
        columns = tuple(Column(word(f"speed.{header}"), [row[k] for row in rows]) for k, header in enumerate(headers))
        return Table(name, word(f"speed.{name}_title"), columns)

    yield table(
        "races",
        [
            (r.mechanism, str(r.variants), str(r.positions), f"{r.ours:.0f}", f"{r.by_hand:.0f}", f"{r.ratio:.2f}",
             "" if r.target is None else f"{r.target:g}", f"{r.preparing:.0f}") for r in measured.races
        ],
        "mechanism", "variants", "positions", "ours", "by_hand", "ratio", "at_most", "preparing",
    )  # fmt: skip
    yield table(
        "growths",
        [
            (word(f"speed.{g.what}"), f"{g.numbers[0]} ... {g.numbers[-1]}",
             f"{1e3 * g.seconds[0]:.2f} ... {1e3 * g.seconds[-1]:.2f}", f"{g.exponent:.3f}") for g in measured.growths
        ],
        "what", "numbers", "milliseconds", "exponent",
    )  # fmt: skip
    if measured.rivals:
        yield table(
            "rivals",
            [
                (r.name, r.mechanism, f"{r.theirs:.0f}", f"{r.ours:.0f}", f"{r.ratio:.0f}", f"{RIVALS[r.name]:g}")
                for r in measured.rivals
            ],
            "rival", "mechanism", "theirs", "ours", "times", "at_least",
        )  # fmt: skip


def _charts(measured: Speed) -> dict[str, Figure]:
    from tmm_cli.bench.chart_speed import chart

    return {"speed": chart(measured)}
