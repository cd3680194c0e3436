"""Power balance, reduced inertia and reduced moment at every position; friction over the cycle."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tmm_cli.pipeline import Results
from tmm_cli.problem.dimensions import FORCE, INERTIA, LENGTH, MASS, MOMENT, NUMBER
from tmm_cli.results.reports.cycle import driver_columns
from tmm_cli.results.table import Column, Table
from tmm_cli.words import say


def tables(results: Results) -> Iterable[Table]:
    """The balance, and where there is friction what it takes."""
    found, motion = results.energy, results.motion
    if found is None or motion is None:
        return
    crank = results.linkage.driver.kind == "turn"
    columns = [
        *driver_columns(results),
        Column(say("energy.J" if crank else "energy.m"), found.inertia, INERTIA if crank else MASS),
        Column(say("energy.M" if crank else "energy.F"), found.moment, MOMENT if crank else FORCE),
        Column(say("energy.T"), found.kinetic, NUMBER),
        Column(say("energy.rate"), found.rate, NUMBER),
        Column(say("energy.drivers"), found.drivers, NUMBER),
        Column(say("energy.weights"), found.weights, NUMBER),
        Column(say("energy.loads"), found.loads, NUMBER),
    ]
    if results.friction is not None:
        columns.append(Column(say("energy.friction"), found.friction, NUMBER))
    columns.append(Column(say("energy.balance"), 100 * np.abs(found.balance), NUMBER, digits=2))
    yield Table("energy", say("energy.title"), tuple(columns))
    if results.friction is not None:
        yield _friction(results)


def _friction(results: Results) -> Table:
    rubbed, lost = results.friction, results.losses
    assert rubbed is not None
    given = results.linkage.friction
    notes = []
    share = None if lost is None else lost.efficiency
    notes.append(say("friction.none") if share is None else say("friction.efficiency", share=f"{100 * share:.4g}"))
    locked = [str(n) for n, lost in zip(results.numbers, rubbed.locked, strict=True) if lost]
    if locked:
        notes.append(say("friction.locked", numbers=", ".join(locked)))
    return Table(
        "friction", say("friction.title"),
        (
            Column(say("word.pair"), [f.pair for f in given]),
            Column(say("friction.coefficient"), [f.coefficient for f in given], NUMBER),
            Column(say("friction.radius"), [f.radius if f.radius else float("nan") for f in given], LENGTH),
            Column(say("friction.work"), [lost.pairs[f.pair] if lost else float("nan") for f in given], NUMBER),
        ),
        notes=tuple(notes),
    )  # fmt: skip
