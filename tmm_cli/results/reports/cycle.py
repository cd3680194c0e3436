"""The cycle at a glance: a row a position, the driver, the output and what balances it."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tmm_cli.motion import Motion
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
    Dimension,
)
from tmm_cli.results.table import Column, Table
from tmm_cli.strokes import output_link, output_run
from tmm_cli.vectors import Real, pi
from tmm_cli.words import say


def driver_columns(results: Results) -> list[Column]:
    """Number of each position and the driver's place."""
    motion = results.motion
    assert motion is not None
    turns = results.linkage.driver.kind == "turn"
    round_and_round = turns and results.way is not None and results.way.full
    q = np.mod(motion.q, 2 * pi(motion.q)) if round_and_round else motion.q
    return [
        Column(say("word.position"), [str(n) for n in results.numbers]),
        Column(say("cycle.phi" if turns else "cycle.drive"), q, ANGLE if turns else LENGTH),
    ]


def tables(results: Results) -> Iterable[Table]:
    """One table; positions that cannot be reached or are dead are said so in the last column."""
    motion = results.motion
    if motion is None:
        return
    columns = [*driver_columns(results), *_other_drivers(results)]
    for link in output_links(results):
        for key, values, dimension in output_motion(results, motion, link):
            columns.append(Column(say(f"cycle.{key}", link=link), values, dimension))
    columns += _balance(results)
    if not bool(np.all(motion.moving & ~results.locked)):
        columns.append(Column(say("word.state"), states(results)))
    yield Table("cycle", say("cycle.title"), tuple(columns))


def _other_drivers(results: Results) -> Iterable[Column]:
    """Where the drivers beside the first are."""
    motion = results.motion
    assert motion is not None
    for driver in results.linkage.others:
        value = motion.drives[driver.link].value
        turns = driver.kind == "turn"
        full = turns and results.way is not None and results.way.full
        key = "cycle.place_turn" if turns else "cycle.place_slide"
        yield Column(
            say(key, link=driver.link), np.mod(value, 2 * pi(value)) if full else value, ANGLE if turns else LENGTH
        )


def output_links(results: Results) -> tuple[str, ...]:
    """The outputs that the file names, or the one that is taken where it names none."""
    if results.linkage.outputs:
        return tuple(output.link for output in results.linkage.outputs)
    link = output_link(results.linkage, results.structure.groups)
    return () if link is None else (link,)


def output_motion(results: Results, motion: Motion, link: str) -> Iterable[tuple[str, Real, Dimension]]:
    """Run (or angle), speed and acceleration of an output: key of its name, values, what they measure."""
    slides = results.linkage.slides_on_frame(link)
    run, first, second = output_run(motion, link)
    v = first * motion.rate
    a = second * motion.rate**2 + first * motion.acceleration
    names = ("run", "v", "a") if slides else ("psi", "omega", "epsilon")
    dims = (LENGTH, SPEED, ACCELERATION) if slides else (ANGLE, ANGULAR_SPEED, ANGULAR_ACCELERATION)
    return zip(names, (run, v, a), dims, strict=True)


def _balance(results: Results) -> Iterable[Column]:
    """What balances the driver, by both ways; with several drivers each, then the sum that both ways give."""
    reactions, lever, motion = results.reactions, results.lever, results.motion
    if reactions is None or lever is None or motion is None:
        return
    from tmm_cli.forces.plan import power  # kinematics alone does not need it

    difference = Column(say("cycle.difference"), lever.difference * 100, NUMBER, digits=2)
    if len(reactions.balances) == 1:
        balance = reactions.balance
        crank = balance.kind == "moment"
        plan = balance.moment if crank else balance.force
        by_lever = lever.balancing if crank else lever.balancing / balance.arm
        size = MOMENT if crank else FORCE
        yield Column(say("cycle.plan" if crank else "cycle.plan_force"), plan, size)
        yield Column(say("cycle.lever" if crank else "cycle.lever_force"), by_lever, size)
        yield difference
        return
    for balance in reactions.balances:
        turns = balance.moment is not None
        name = say("cycle.moment_of" if turns else "cycle.force_of", link=balance.driver.link)
        yield Column(name, balance.generalized, MOMENT if turns else FORCE)
    first = results.linkage.driver
    size = MOMENT if first.kind == "turn" else FORCE
    yield Column(say("cycle.sum_plan", link=first.link), power(motion, reactions), size)
    yield Column(say("cycle.sum_lever", link=first.link), lever.balancing, size)
    yield difference


def states(results: Results) -> list[str]:
    """What is wrong with each position, or nothing."""
    motion = results.motion
    assert motion is not None
    lost = ~motion.moving | results.locked
    return [_state(results, k) if wrong else "" for k, wrong in enumerate(lost.tolist())]


def _state(results: Results, k: int) -> str:
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
