"""What the user should know besides the numbers: limited range, dead positions, nearness to them, failed checks."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tmm_cli.pipeline import Results
from tmm_cli.problem.dimensions import ANGLE, LENGTH
from tmm_cli.words import say

NEAR = 0.05  # a margin (sine of the transmission angle) below which a position is said to be near a dead one


def warnings(results: Results) -> Iterable[str]:
    """One sentence each, in the units of the file."""
    motion, way = results.motion, results.way
    if motion is None or way is None:
        return
    units = results.problem.units
    measure = ANGLE if results.linkage.driver.kind == "turn" else LENGTH

    def place(q: float) -> str:
        return f"{round(units.from_si(q, measure), 5) + 0.0:.8g} {units.symbol(measure)}"

    if way.limits and results.linkage.driver.kind == "turn":
        groups = ", ".join(dict.fromkeys(limit.group for limit in way.limits))
        given = "" if results.problem.request.places else say("warning.given")
        ends = {"start": place(way.start), "end": place(way.end)}
        yield say("warning.range", link=results.linkage.driver.link, groups=groups, **ends) + given
    for dead in results.dead:
        yield say("warning.dead", place=place(dead.place), group=dead.group, margin=f"{dead.margin:.1e}")
    for k, number in enumerate(results.numbers):
        for title, lost in motion.missing.items():
            if lost[k]:
                gap = motion.placements[list(motion.missing).index(title)].gap[k]
                short = f"{units.from_si(float(gap), LENGTH):.6g} {units.symbol(LENGTH)}"
                yield say("warning.missing", number=number, place=place(float(motion.q[k])), group=title, gap=short)
        for title, dead_here in motion.dead.items():
            if dead_here[k]:
                yield say("warning.dead_here", number=number, place=place(float(motion.q[k])), group=title)
    stopped = [n for k, n in enumerate(results.numbers) if not np.isfinite(motion.rate[k])]
    if stopped:
        yield say("warning.stopped", link=results.linkage.driver.link, number=stopped[0])
    for dyad, at in zip(motion.dyads, motion.placements, strict=True):
        margin = np.where(motion.moving, at.margin, np.inf)
        if margin.size and np.min(margin) < NEAR:
            k = int(np.argmin(margin))
            yield say(
                "warning.near", number=results.numbers[k], group=dyad.group.title, margin=f"{float(margin[k]):.2g}"
            )
    if results.lever is not None and not results.lever_holds:
        worst = np.where(motion.moving, results.lever.difference, 0.0)
        k = int(np.argmax(worst))
        yield say(
            "warning.lever", number=results.numbers[k], difference=f"{100 * float(worst[k]):.3g}",
            limit=f"{100 * results.problem.lever_limit:.3g}",
        )  # fmt: skip
