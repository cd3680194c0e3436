"""`tmm bench speed`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import typer

from tmm_cli.cli.bench_accuracy import Out, Reduced
from tmm_cli.cli.common import BAD_INPUT, CHECK_FAILED, OK, Json, console, emit_json, say

if TYPE_CHECKING:
    from pathlib import Path

    from tmm_cli.bench.speed import Speed


def speed(reduced: Reduced = False, out: Out = None, as_json: Json = False) -> None:
    """Time a position against code written by hand for one mechanism, other programs, and growing problems.

    Exit code 1 when a target is missed, of a reduced run by more than twice.
    """
    from tmm_cli.bench.speed import measure
    from tmm_cli.words import say as word

    measured = measure(reduced=reduced, progress=say)
    if as_json:
        emit_json(measured.to_dict())
    else:
        _show(measured)
    if out is not None:
        try:
            say(word("speed.written", files=_write(measured, out)))
        except OSError as error:
            say(f"error: {error.filename or out}: {error.strerror}")
            raise typer.Exit(BAD_INPUT) from None
    for line in measured.absent:
        say(line)
    for failure in measured.failures:
        say(word("speed.missed", what=failure))
    if not measured.failures:
        say(word("speed.met"))
    raise typer.Exit(CHECK_FAILED if measured.failures else OK)


def _show(measured: Speed) -> None:
    from tmm_cli.bench.speed import RIVALS
    from tmm_cli.problem.units import UnitSystem
    from tmm_cli.results.table import Column, Table
    from tmm_cli.results.terminal import show
    from tmm_cli.words import say as word

    def table(name: str, rows: list[tuple[str, ...]], *headers: str) -> None:
        columns = tuple(
            Column(word(f"speed.{header}"), [row[k] for row in rows]) for k, header in enumerate(headers)
        )  # fmt: skip
        show(Table(name, word(f"speed.{name}_title"), columns), UnitSystem(), console())

    table(
        "races",
        [
            (r.mechanism, str(r.variants), str(r.positions), f"{r.ours:.0f}", f"{r.by_hand:.0f}", f"{r.ratio:.2f}",
             "" if r.target is None else f"{r.target:g}", f"{r.preparing:.0f}") for r in measured.races
        ],
        "mechanism", "variants", "positions", "ours", "by_hand", "ratio", "at_most", "preparing",
    )  # fmt: skip
    table(
        "growths",
        [
            (word(f"speed.{g.what}"), f"{g.numbers[0]} ... {g.numbers[-1]}",
             f"{1e3 * g.seconds[0]:.2f} ... {1e3 * g.seconds[-1]:.2f}", f"{g.exponent:.3f}") for g in measured.growths
        ],
        "what", "numbers", "milliseconds", "exponent",
    )  # fmt: skip
    if measured.rivals:
        table(
            "rivals",
            [
                (r.name, r.mechanism, f"{r.theirs:.0f}", f"{r.ours:.0f}", f"{r.ratio:.0f}", f"{RIVALS[r.name]:g}")
                for r in measured.rivals
            ],
            "rival", "mechanism", "theirs", "ours", "times", "at_least",
        )  # fmt: skip


def _write(measured: Speed, folder: Path) -> str:
    """speed.json and the chart; their names."""
    from tmm_cli.bench.chart_speed import chart
    from tmm_cli.draw.sheet import picture
    from tmm_cli.results.files import write_whole
    from tmm_cli.results.text import json_bytes

    contents = {"speed.json": json_bytes(measured.to_dict()), "speed.png": picture(chart(measured), "png")}
    for name, content in contents.items():
        write_whole(folder / name, content)
    return ", ".join(str(folder / name) for name in contents)
