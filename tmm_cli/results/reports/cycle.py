"""The cycle at a glance: a row a position, the driver, the output and what balances it."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tmm_cli.analysis.pipeline import Results
from tmm_cli.forces.plan import power
from tmm_cli.kinematics.motion import Motion
from tmm_cli.kinematics.output import output_run
from tmm_cli.language import N_, Phrase, _
from tmm_cli.linkage import Driver, Linkage
from tmm_cli.quantities import FORCE, LINK, MOMENT, NUMBER, SLIDE, Dimension, place_dimension
from tmm_cli.results.table import Column, Table
from tmm_cli.vectors import Real, pi

OF_OUTPUT = {
    "run": N_("s of {link}"),
    "v": N_("v of {link}"),
    "a": N_("a of {link}"),
    "angle": N_("angle of {link}"),
    "omega": N_("omega of {link}"),
    "epsilon": N_("epsilon of {link}"),
}


def signs(linkage: Linkage) -> str:
    """What is positive, in a sentence for below a table."""
    if linkage.driver.kind == "slide":
        return _(
            "A driven slider's place, speed and F_b are positive along its guide, however it moves; angles and moments "
            "counterclockwise."
        )
    return _(
        "Angles, angular speeds and moments are positive counterclockwise, however the driver turns: a negative M_b "
        "drives it clockwise."
    )


def driver_columns(results: Results) -> list[Column]:
    """Number of each position and the driver's place."""
    assert results.motion is not None
    name = _("phi") if results.linkage.driver.kind == "turn" else _("driver")
    return [
        Column(N_("position"), [str(n) for n in results.numbers]),
        _place(results, results.linkage.driver, name, results.motion.q),
    ]


def _place(results: Results, driver: Driver, name: str, q: Real) -> Column:
    """A driver's places, within a turn where it turns round and round, or within the turns of a cycle of loads."""
    full = driver.kind == "turn" and results.driver_range is not None and results.driver_range.full
    return Column(name, np.mod(q, 2 * results.linkage.turns * pi(q)) if full else q, place_dimension(driver.kind))


def tables(results: Results) -> Iterable[Table]:
    """One table; positions that cannot be reached or are dead are said so in the last column."""
    motion = results.motion
    assert motion is not None
    columns = driver_columns(results)
    for driver in results.linkage.others:
        name = _("phi of {link}") if driver.kind == "turn" else _("driver {link}")
        columns.append(_place(results, driver, name.format(link=driver.link), motion.drives[driver.link].value))
    for link in results.mechanism.outputs:
        if results.linkage.output_carrier(link) not in motion.poses:  # with --of only some links move
            continue
        columns += [Column(name, values, dimension) for name, values, dimension in output_motion(results, motion, link)]
    columns += _balance(results)
    if not bool(np.all(motion.moving & ~results.locked)):
        columns.append(Column(N_("state"), states(results)))
    yield Table("cycle", _("Cycle"), tuple(columns), notes=(signs(results.linkage), *_beside_flywheel(results)))


def output_motion(results: Results, motion: Motion, link: str) -> Iterable[tuple[str, Real, Dimension]]:
    """Run (or angle), speed and acceleration of an output: what it is called, its values, what they measure."""
    run, first, second = output_run(motion, link)
    v = first * motion.rate
    a = second * motion.rate**2 + first * motion.acceleration
    words = OF_OUTPUT if link in results.linkage.links else OF_OUTPUT | {"run": "{link}"}
    quantities = LINK if results.linkage.output_swings(link) else SLIDE
    for quantity, values in zip(quantities, (run, v, a), strict=False):
        yield Phrase(words[quantity.name], link=link), values, quantity.dimension


def _balance(results: Results) -> Iterable[Column]:
    """What balances the driver, by both ways; with several drivers each, then the sum that both ways give."""
    reactions, lever, motion = results.reactions, results.lever, results.motion
    if reactions is None or lever is None or motion is None:
        return
    difference = Column(N_("difference, %"), lever.difference * 100, NUMBER, digits=2)
    if len(reactions.balances) == 1:
        balance = reactions.balance
        if balance.kind == "moment":
            yield Column(N_("M_b, force plan"), balance.moment, MOMENT)
            yield Column(N_("M_b, lever"), lever.balancing, MOMENT)
        else:
            yield Column(N_("F_b, force plan"), balance.force, FORCE)
            yield Column(N_("F_b, lever"), lever.balancing / balance.arm, FORCE)
        yield difference
        return
    for balance in reactions.balances:
        turns, link = balance.moment is not None, balance.driver.link
        name = _("M_b of {link}") if turns else _("F_b of {link}")
        yield Column(name.format(link=link), balance.generalized, MOMENT if turns else FORCE)
    first = results.linkage.driver
    size = MOMENT if first.kind == "turn" else FORCE
    yield Column(Phrase("reduced to {link}, force plan", link=first.link), power(motion, reactions), size)
    yield Column(Phrase("reduced to {link}, lever", link=first.link), lever.balancing, size)
    yield difference


def has_flywheel(results: Results) -> bool:
    """Whether what drives has a flywheel to speed up besides the links, and nothing else, as a brake."""
    if results.single is not None:
        return bool(results.single.task.flywheel) and not results.single.task.brake
    return results.steady is not None and bool(results.steady.steady.law.flywheel)


def _beside_flywheel(results: Results) -> Iterable[str]:
    """Where a law of motion is computed, what balances the driver is not what drives the machine."""
    if results.reactions is None or not has_flywheel(results):
        return
    if results.linkage.driver.kind == "turn":
        yield _("The flywheel is not a link: M_b moves the links alone, and what drives is M_d = M_b + J_f epsilon.")
    else:
        yield _("The flywheel is not a link: F_b moves the links alone, and what drives is F_d = F_b + m_f a.")


def states(results: Results) -> list[str]:
    """What is wrong with each position, or nothing."""
    motion = results.motion
    assert motion is not None
    limits = np.zeros(np.shape(motion.q), dtype=bool) if motion.limits is None else motion.limits
    told = np.where(motion.moving, "", _("the driver has stopped before")).astype(object)
    told[results.locked & motion.moving] = _("locks by friction")
    told[limits] = _("change point: limits")
    for text, groups in ((_("{group} is dead"), motion.dead), (_("{group} cannot be assembled"), motion.missing)):
        for group, lost in reversed(list(groups.items())):
            told[lost & (~motion.moving | results.locked) & ~limits] = text.format(group=group)
    return list(told)
