"""What the user should know besides the numbers: limited range, dead positions, nearness to them, failed checks."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

import numpy as np

from tmm_cli.assembly import sketch_deviations
from tmm_cli.forces.springs import twisted
from tmm_cli.motion import Law, move
from tmm_cli.pipeline import Results, at_positions
from tmm_cli.problem.dimensions import ANGLE, LENGTH
from tmm_cli.results.synthesis import missed
from tmm_cli.vectors import dot
from tmm_cli.words import say

if TYPE_CHECKING:
    from tmm_cli.forces.applied import Applied
    from tmm_cli.forces.friction import Rubbed
    from tmm_cli.linkage import Load

CLOSELY = 720  # places a turn at which a torsion spring's angle is followed
MOST_POSITIONS = 100  # that cannot be reached, each with its own words
MOST_IMPACTS = 6  # jumps of one cam that are named
SKETCH = 0.15  # a sketched point farther off than this share of the linkage's size is worth a word


def warnings(results: Results) -> Iterable[str]:
    """One sentence each, in the units of the file."""
    motion, way = results.motion, results.way
    if motion is None or way is None:
        return
    units = results.problem.units
    measure = ANGLE if results.linkage.driver.kind == "turn" else LENGTH

    def place(q: float) -> str:
        return f"{round(units.from_si(q, measure), 5) + 0.0:.8g} {units.symbol(measure)}"

    request = results.problem.request
    given = "" if request.places else say("warning.given")
    if given and not isinstance(request.start, str) and request.start:
        given += say("warning.from", start=place(request.start))
    ends = {"link": results.linkage.driver.link, "start": place(way.start), "end": place(way.end)}
    groups = ", ".join(dict.fromkeys(limit.group for limit in way.limits if limit.group))
    if groups and results.linkage.driver.kind == "turn":
        yield say("warning.range", groups=groups, **ends) + given
    if any(limit.driver for limit in way.limits):
        yield say("warning.range_stopped", **ends) + given
    there = move(results.linkage, results.kernels, np.array([results.linkage.sketch.at]), Law(0.0, 1.0, 0.0, 1), 0)
    for point, off in sketch_deviations(results.linkage, there.poses).items():
        if off > SKETCH:
            yield say("warning.sketch", point=point, share=f"{100 * off:.0f}", place=place(results.linkage.sketch.at))
    for dead in results.dead:
        name = "warning.passed" if dead.passed else "warning.dead"
        yield say(name, place=place(dead.place), group=dead.group, margin=f"{dead.margin:.1e}")
    unreached = np.flatnonzero(~motion.placed | np.any([*motion.dead.values(), ~motion.placed], axis=0))
    for k in unreached[:MOST_POSITIONS]:
        number = results.numbers[k]
        for title, lost in motion.missing.items():
            if lost[k]:
                gap = motion.placements[list(motion.missing).index(title)].gap[k]
                short = f"{units.from_si(float(gap), LENGTH):.6g} {units.symbol(LENGTH)}"
                yield say("warning.missing", number=number, place=place(float(motion.q[k])), group=title, gap=short)
        for title, dead_here in motion.dead.items():
            if dead_here[k]:
                yield say("warning.dead_here", number=number, place=place(float(motion.q[k])), group=title)
    if len(unreached) > MOST_POSITIONS:
        yield say("warning.more", count=len(unreached) - MOST_POSITIONS)
    stopped = [n for k, n in enumerate(results.numbers) if not np.isfinite(motion.rate[k])]
    if stopped:
        yield say("warning.stopped", link=results.linkage.driver.link, number=stopped[0])
    for dyad, at in zip(motion.kernels, motion.placements, strict=True):
        margin = np.where(motion.moving, at.margin, np.inf)
        if margin.size and np.min(margin) < dyad.near:
            k = int(np.argmin(margin))
            yield say(
                "warning.near", number=results.numbers[k], group=dyad.group.title, margin=f"{float(margin[k]):.2g}"
            )
    for passive in results.structure.passive:
        i, j = passive.links
        yield say("warning.passive", pair=passive.pair, i=i, j=j, among=", ".join(passive.among))
    if not way.repeats:
        yield say("warning.cycle")
    chosen = way.full and _chosen_freely(results)
    for pressure in results.pressure if any(results.problem.limits_set) or chosen else ():
        said = results.problem.limits_set[0 if pressure.slides else 1]
        if (chosen or said) and not pressure.holds:
            largest, allowed = (f"{units.from_si(v, ANGLE):.6g} {units.symbol(ANGLE)}" for v in
                                (pressure.largest, pressure.allowed))  # fmt: skip
            words = "warning.pressure" if said else "warning.pressure_usual"
            key = "pressure_sliding" if pressure.slides else "pressure_turning"
            yield say(words, link=pressure.link, largest=largest, allowed=allowed, check=key)
    if results.friction is not None and np.any(results.friction.locked):
        yield say("warning.locked", places="; ".join(_locked(results, results.friction)))
    yield from _twisted(results, place)
    yield from _impacts(results)
    for load in results.loads:
        if load.kind == "load" and _drives(results, load):
            yield say("warning.drives", load=load.name)
    for tabled in results.linkage.loads:
        if tabled.table is not None and _short_table(results, tabled):
            yield say("warning.table", load=tabled.name, against=tabled.table.against)
    for asked in results.linkage.loads:
        if asked.working_stroke_only and (results.strokes is None or not results.strokes.strokes):
            yield say("warning.always", load=asked.name)
    if results.synthesis is not None:
        yield from missed(results.measured, units)
    if results.lever is not None and not results.lever_holds:
        worst = np.where(motion.moving & ~results.locked, results.lever.difference, 0.0)
        k = int(np.argmax(worst))
        yield say(
            "warning.lever", number=results.numbers[k], difference=f"{100 * float(worst[k]):.3g}",
            limit=f"{100 * results.problem.lever_limit:.3g}",
        )  # fmt: skip


def _chosen_freely(results: Results) -> bool:
    """Whether a synthesis found the linkage, and was asked nothing about its pressure angle."""
    found = results.synthesis
    if found is None:
        return False
    asked = [d for d in found.outcome.demands if d.asked or found.task == "optimal"]
    return not any(d.words.endswith(".pressure") for d in asked)


def _locked(results: Results, rubbed: Rubbed) -> Iterable[str]:
    """Where friction locks the mechanism, by the pair that rubs most."""
    lost = np.flatnonzero(rubbed.locked)
    for name in dict.fromkeys(rubbed.pair[k] for k in lost):
        numbers = [str(results.numbers[k]) for k in lost if rubbed.pair[k] == name]
        pair = results.structure.pair(name)
        yield say(
            "warning.locked_in", s="s" if len(numbers) > 1 else "", numbers=", ".join(numbers), pair=name,
            i=pair.i, j=pair.j,
        )  # fmt: skip


def _twisted(results: Results, place: Callable[[float], str]) -> Iterable[str]:
    """Torsion springs that come to half a turn from their free angle."""
    springs = [s for s in results.linkage.springs if s.turns]
    if not springs or results.reactions is None:
        return
    motion = at_positions(results, results.closely(CLOSELY * (results.way.turns if results.way else 1) + 1), 0)
    for spring in springs:
        with np.errstate(invalid="ignore"):
            jumps = np.flatnonzero(np.abs(np.diff(twisted(spring, motion))) > np.pi)
        if jumps.size:
            yield say("warning.twist", spring=spring.name, place=place(float(motion.q[jumps[0]])))


def _impacts(results: Results) -> Iterable[str]:
    """Cams whose law has jumps of the follower's speed."""
    units = results.problem.units
    for mesh in results.linkage.meshes:
        jumps = mesh.law.jumps() if mesh.law is not None else ()
        if jumps:
            places = ", ".join(f"{units.from_si(a, ANGLE):.6g}" for a in jumps[:MOST_IMPACTS])
            more = ", ..." if len(jumps) > MOST_IMPACTS else ""
            yield say("warning.impact", cam=mesh.i, follower=mesh.j, places=f"{places}{more} {units.symbol(ANGLE)}")


def _drives(results: Results, load: Applied) -> bool:
    """Whether a load of the working stroke helps the motion at every position where it acts: it should resist."""
    given = {x.name: x for x in results.linkage.loads}.get(load.name)
    motion = results.motion
    if given is None or not given.working_stroke_only or motion is None:
        return False
    power = dot(load.force, motion.point(load.link, load.at).v) + load.moment * motion.link(load.link).omega
    reach = max((d.size for d in results.kernels), default=1.0) if results.linkage.driver.kind == "turn" else 1.0
    # at the ends of a stroke the speed is only rounding, and its sign says nothing
    most = np.abs(motion.rate) * (np.abs(load.force) * reach + np.abs(load.moment))
    acting = motion.moving & (np.abs(power) > 1e-6 * most)
    return bool(np.any(acting)) and bool(np.all(power[acting] > 0))


def _short_table(results: Results, load: Load) -> bool:
    """Whether a load acts beyond the first or last argument of its table."""
    from tmm_cli.forces.loads import table_argument

    motion = results.motion
    if load.table is None or motion is None or not results.loads:
        return False
    acting = motion.placed
    if load.working_stroke_only and results.strokes is not None and results.strokes.strokes:
        acting = acting & results.strokes.share(motion.q, results.linkage.driver.sense)
    argument = table_argument(load.table.against, motion, results.strokes)[acting]
    first, last = load.table.arguments[0], load.table.arguments[-1]
    slack = 1e-6 * (last - first)
    return bool(np.any((argument < first - slack) | (argument > last + slack)))
