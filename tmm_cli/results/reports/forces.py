"""Loads and reactions. Long: a row a position."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from tmm_cli.forces.plan import Reaction
from tmm_cli.pipeline import Results
from tmm_cli.problem.dimensions import ANGLE, FORCE, LENGTH, MOMENT, Dimension
from tmm_cli.results.reports.cycle import driver_columns
from tmm_cli.results.table import Column, Table
from tmm_cli.words import say


def label(by: str, on: str) -> str:
    """R_12 acts from link 1 on link 2."""
    return f"R_{by}{on}" if len(by) == len(on) == 1 else f"R_{by},{on}"


def tables(results: Results) -> Iterable[Table]:
    """Reactions, loads, and the driving link."""
    reactions = results.reactions
    if reactions is None:
        return
    count = len(results.numbers)
    per = [_reaction(r) for r in reactions.all]
    head = [
        Column(c.header, np.repeat(np.asarray(c.values), len(per)).tolist(), c.dimension)
        for c in driver_columns(results)
    ]
    columns = [
        *head,
        Column(say("word.pair"), [r.pair.name for r in reactions.all] * count),
        Column(say("forces.name"), [label(r.by, r.on) for r in reactions.all] * count),
    ]
    for k, (symbol, _, dimension) in enumerate(per[0]):
        values = np.stack([np.broadcast_to(_none(p[k][1]), (count,)) for p in per], axis=1).ravel()
        columns.append(Column(say(f"forces.{symbol}"), values, dimension))
    yield Table("reactions", say("reactions.title"), tuple(columns), long=True, notes=(say("reactions.note"),))
    if reactions.applied:
        yield _loads(results)
    yield _balance(results)


def _none(values: Any) -> Any:
    return np.nan if values is None else values


def _reaction(r: Reaction) -> list[tuple[str, Any, Dimension]]:
    def length(v: Any) -> Any:
        return None if v is None else np.abs(v)

    return [
        ("Fx", r.force.real, FORCE), ("Fy", r.force.imag, FORCE), ("F", np.abs(r.force), FORCE),
        ("angle", np.angle(r.force), ANGLE), ("tau", length(r.tangential), FORCE), ("n", length(r.normal), FORCE),
        ("couple", r.couple, MOMENT), ("arm", r.arm, LENGTH),
    ]  # fmt: skip


def _loads(results: Results) -> Table:
    reactions = results.reactions
    assert reactions is not None
    loads, count = reactions.applied, len(results.numbers)

    def stacked(parts: list[Any]) -> Any:
        return np.stack([np.broadcast_to(p, (count,)) for p in parts], axis=1).ravel()

    head = [
        Column(c.header, np.repeat(np.asarray(c.values), len(loads)).tolist(), c.dimension)
        for c in driver_columns(results)
    ]
    columns = [
        *head,
        Column(say("word.link"), [x.link for x in loads] * count),
        Column(say("forces.name"), [x.name for x in loads] * count),
        Column(say("forces.Fx"), stacked([x.force.real for x in loads]), FORCE),
        Column(say("forces.Fy"), stacked([x.force.imag for x in loads]), FORCE),
        Column(say("forces.F"), stacked([np.abs(x.force) for x in loads]), FORCE),
        Column(say("forces.moment"), stacked([x.moment for x in loads]), MOMENT),
    ]
    return Table("loads", say("loads.title"), tuple(columns), long=True)


def _balance(results: Results) -> Table:
    reactions = results.reactions
    assert reactions is not None
    balance = reactions.balance
    columns = driver_columns(results)
    if balance.moment is not None:
        columns.append(Column(say("balance.moment"), balance.moment, MOMENT))  # type: ignore[arg-type]
    columns.append(Column(say("balance.force"), balance.force, FORCE))
    frame = reactions.frame
    columns += [
        Column(say("balance.frame_x", name=label(frame.by, frame.on)), frame.force.real, FORCE),
        Column(say("balance.frame_y", name=label(frame.by, frame.on)), frame.force.imag, FORCE),
    ]
    return Table("balance", say("balance.title"), tuple(columns))
