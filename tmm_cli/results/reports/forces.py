"""Loads and reactions. Long: a row a position."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tmm_cli.forces.applied import Applied
from tmm_cli.forces.plan import Reaction
from tmm_cli.linkage import FRAME
from tmm_cli.pipeline import Results
from tmm_cli.problem.dimensions import ANGLE, FORCE, LENGTH, MOMENT
from tmm_cli.results.reports.cycle import driver_columns
from tmm_cli.results.reports.long import Values, long_table
from tmm_cli.results.table import Column, Table
from tmm_cli.vectors import Real, Vector
from tmm_cli.words import say


def label(by: str, on: str) -> str:
    """R_12 acts from link 1 on link 2."""
    return f"R_{by}{on}" if len(by) == len(on) == 1 else f"R_{by},{on}"


def tables(results: Results) -> Iterable[Table]:
    """Reactions, loads, and the driving link."""
    reactions = results.reactions
    if reactions is None:
        return
    words = {
        "word.pair": [r.pair.name for r in reactions.all],
        "forces.name": [label(r.by, r.on) for r in reactions.all],
    }
    values = [_reaction(r) for r in reactions.all]
    yield long_table(results, "reactions", words, values, say("reactions.note"))
    loads = reactions.applied
    if loads:
        words = {"word.link": [x.link for x in loads], "forces.name": [x.name for x in loads]}
        yield long_table(results, "loads", words, [_load(x) for x in loads])
    yield _balances(results)


def _reaction(r: Reaction) -> Values:
    def length(v: Vector | None) -> Real | None:
        return None if v is None else np.abs(v)

    return [
        *_force(r.force), ("forces.angle", np.angle(r.force), ANGLE), ("forces.tau", length(r.tangential), FORCE),
        ("forces.n", length(r.normal), FORCE), ("forces.couple", r.couple, MOMENT), ("forces.arm", r.arm, LENGTH),
    ]  # fmt: skip


def _load(load: Applied) -> Values:
    return [*_force(load.force), ("forces.moment", load.moment, MOMENT)]


def _force(force: Vector) -> Values:
    return [("forces.Fx", force.real, FORCE), ("forces.Fy", force.imag, FORCE), ("forces.F", np.abs(force), FORCE)]


def _balances(results: Results) -> Table:
    """Every driver's moment or force, and what the frame does to the links that are driven from it."""
    reactions = results.reactions
    assert reactions is not None
    columns = driver_columns(results)
    several = len(reactions.balances) > 1
    for balance in reactions.balances:
        of = say("balance.of", link=balance.driver.link) if several else ""
        if balance.moment is not None:
            columns.append(Column(say("balance.moment") + of, balance.moment, MOMENT))
        if balance.moment is None or balance.driver.base == FRAME:
            columns.append(Column(say("balance.force") + of, balance.force, FORCE))
        for frame in (f for f in reactions.frames if f.on == balance.driver.link):
            name = label(frame.by, frame.on)
            columns.append(Column(say("balance.frame_x", name=name), frame.force.real, FORCE))
            columns.append(Column(say("balance.frame_y", name=name), frame.force.imag, FORCE))
    return Table("balance", say("balance.title"), tuple(columns))
