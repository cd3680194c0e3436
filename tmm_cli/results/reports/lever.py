"""The Zhukovsky lever: every force and couple with its arm and moment. Long: a row a position."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from tmm_cli.pipeline import Results
from tmm_cli.problem.dimensions import FORCE, LENGTH, MOMENT, NUMBER
from tmm_cli.results.reports.cycle import driver_columns
from tmm_cli.results.table import Column, Table
from tmm_cli.words import say


def tables(results: Results) -> Iterable[Table]:
    """One table: forces with arms in length per unit turn of the crank, couples with the ratio of angular speeds."""
    lever = results.lever
    if lever is None or not lever.items:
        return
    items, count = lever.items, len(results.numbers)
    crank = results.linkage.driver.kind == "turn"

    def stacked(parts: list[Any]) -> Any:
        return np.stack([np.broadcast_to(p, (count,)) for p in parts], axis=1).ravel()

    forces = [item.end is not None for item in items]
    nothing = np.full(count, np.nan)
    head = [
        Column(c.header, np.repeat(np.asarray(c.values), len(items)).tolist(), c.dimension)
        for c in driver_columns(results)
    ]
    columns = (
        *head,
        Column(say("forces.name"), [item.name for item in items] * count),
        Column(say("word.link"), [item.link for item in items] * count),
        Column(say("lever.force"), stacked([i.size if f else nothing for i, f in zip(items, forces, strict=True)]), FORCE),
        Column(say("lever.arm"), stacked([i.arm if f else nothing for i, f in zip(items, forces, strict=True)]),
               LENGTH if crank else NUMBER),
        Column(say("lever.couple"), stacked([nothing if f else i.size for i, f in zip(items, forces, strict=True)]), MOMENT),
        Column(say("lever.ratio"), stacked([nothing if f else i.arm for i, f in zip(items, forces, strict=True)]), NUMBER),
        Column(say("lever.moment"), stacked([i.moment for i in items]), MOMENT if crank else FORCE),
    )  # fmt: skip
    yield Table("lever", say("lever.title"), columns, long=True, notes=(say("lever.note"),))
