"""The cycle at a glance: a row a position, the driver, the output and what balances it."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tmm_cli.pipeline import Results
from tmm_cli.problem.dimensions import (
    ACCELERATION,
    ANGLE,
    ANGULAR_ACCELERATION,
    ANGULAR_SPEED,
    FORCE,
    LENGTH,
    MOMENT,
    NUMBER,
    SPEED,
)
from tmm_cli.results.table import Column, Table
from tmm_cli.strokes import output_link, output_run
from tmm_cli.words import say


def driver_columns(results: Results) -> list[Column]:
    """Number of each position and the driver's place."""
    motion = results.motion
    assert motion is not None
    turns = results.linkage.driver.kind == "turn"
    round_and_round = turns and results.way is not None and results.way.full
    q = np.mod(motion.q, 2 * np.pi) if round_and_round else motion.q
    return [
        Column(say("word.position"), [str(n) for n in results.numbers]),
        Column(say("cycle.phi" if turns else "cycle.drive"), q, ANGLE if turns else LENGTH),
    ]


def tables(results: Results) -> Iterable[Table]:
    """One table; positions that cannot be reached or are dead are said so in the last column."""
    motion = results.motion
    if motion is None:
        return
    columns = driver_columns(results)
    link = output_link(results.linkage, results.structure.groups)
    if link is not None:
        slides = results.strokes is not None and results.strokes.kind == "slide"
        run, first, second = output_run(motion, link)
        v = first * motion.rate
        a = second * motion.rate**2 + first * motion.acceleration
        names = ("run", "v", "a") if slides else ("psi", "omega", "epsilon")
        dims = (LENGTH, SPEED, ACCELERATION) if slides else (ANGLE, ANGULAR_SPEED, ANGULAR_ACCELERATION)
        for name, values, dim in zip(names, (run, v, a), dims, strict=True):
            columns.append(Column(say(f"cycle.{name}", link=link), values, dim))
    if results.reactions is not None and results.lever is not None:
        balance = results.reactions.balance
        crank = balance.kind == "moment"
        plan = balance.moment if crank else balance.force
        by_lever = results.lever.balancing if crank else results.lever.balancing / balance.arm
        size = MOMENT if crank else FORCE
        columns.append(Column(say("cycle.plan" if crank else "cycle.plan_force"), plan, size))
        columns.append(Column(say("cycle.lever" if crank else "cycle.lever_force"), by_lever, size))
        columns.append(Column(say("cycle.difference"), results.lever.difference * 100, NUMBER, digits=2))
    if not bool(np.all(motion.moving & ~results.locked)):
        columns.append(Column(say("word.state"), [state(results, k) for k in range(len(results.numbers))]))
    yield Table("cycle", say("cycle.title"), tuple(columns))


def state(results: Results, k: int) -> str:
    """What is wrong with a position, or nothing."""
    motion = results.motion
    assert motion is not None
    for title, lost in motion.missing.items():
        if lost[k]:
            return say("state.missing", group=title)
    for title, dead in motion.dead.items():
        if dead[k]:
            return say("state.dead", group=title)
    if motion.moving[k]:
        return say("state.locked") if results.locked[k] else ""
    return say("state.stopped")
