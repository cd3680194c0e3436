"""Savings as a table and as plain data."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tmm_cli.bench.savings import Saving
from tmm_cli.problem.dimensions import NUMBER
from tmm_cli.results.table import Column, Table
from tmm_cli.words import say


def savings_table(found: Sequence[Saving]) -> Table:
    """A row a saving: what was counted and how long it took, with it and without."""

    def number(values: Sequence[float | None], key: str) -> Column:
        return Column(say(key), [None if s.why else v for s, v in zip(found, values, strict=True)], NUMBER, digits=3)

    def count(values: Sequence[int], key: str) -> Column:
        return Column(say(key), ["" if s.why else str(v) for s, v in zip(found, values, strict=True)])

    return Table(
        "savings", say("savings.title"),
        (
            Column(say("savings.saving"), [say(f"savings.{s.name}") for s in found]),
            Column(say("savings.counted"), ["" if s.why else say(f"savings.{s.counts}") for s in found]),
            count([s.with_ for s in found], "savings.with"),
            count([s.without for s in found], "savings.without"),
            number([s.seconds[0] * 1e3 for s in found], "savings.ms_with"),
            number([s.seconds[1] * 1e3 for s in found], "savings.ms_without"),
            number([s.seconds[1] / s.seconds[0] if s.seconds[0] else None for s in found], "savings.times"),
            Column(say("savings.remark"), [_remark(s) for s in found]),
        ),
        notes=(say("savings.note"),),
    )  # fmt: skip


def _remark(saving: Saving) -> str:
    if saving.why:
        return say(f"savings.{saving.why}")
    return "" if saving.holds else say("savings.fails")


def savings_json(name: str, found: Sequence[Saving]) -> dict[str, Any]:
    """As plain data, times in s."""
    rows = [
        {"name": s.name, "why_not": s.why} if s.why else
        {"name": s.name, "counts": s.counts, "with": s.with_, "without": s.without, "seconds_with": s.seconds[0],
         "seconds_without": s.seconds[1], "holds": s.holds}
        for s in found
    ]  # fmt: skip
    return {"problem": name, "savings": rows, "holds": all(s.holds for s in found)}
