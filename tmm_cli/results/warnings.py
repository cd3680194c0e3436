"""What the user should know besides the numbers: limited range, dead positions, nearness to them, failed checks."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tmm_cli.analysis.pipeline import Results, at_positions
from tmm_cli.analysis.spatial_chain import ChainResults
from tmm_cli.assembly.sketch import sketch_deviations
from tmm_cli.forces.applied import Applied
from tmm_cli.forces.given import in_window, table_argument
from tmm_cli.forces.springs import twisted
from tmm_cli.groups.base import Closed
from tmm_cli.groups.sequence import DriverMotion
from tmm_cli.kinematics.motion import Motion, move
from tmm_cli.language import _, numeral
from tmm_cli.linkage import Load, LoadTable
from tmm_cli.quantities import ANGLE, FORCE, LENGTH, MOMENT, place_dimension
from tmm_cli.results.reports.synthesis import missed
from tmm_cli.results.table import with_unit
from tmm_cli.synthesis.check import measured_on
from tmm_cli.tolerances import SAME_PLACE, SAME_RATIO
from tmm_cli.vectors import dot

CLOSELY = 720  # places a turn at which a torsion spring's angle is followed
MOST_POSITIONS = 100  # that cannot be reached, each with its own words
FEW = 12  # positions that are named in one sentence
SKETCH = 0.15  # a sketched point farther off than this share of the linkage's size is worth a word


def warnings(results: Results | ChainResults, *, checked: bool = True) -> Iterable[str]:
    """One sentence each, in the units of the file. checked: also of what the table of checks has with its number."""
    if isinstance(results, ChainResults) or results.motion is None or results.driver_range is None:
        return
    yield from _range(results)
    yield from _sketch(results)
    yield from _dead(results)
    yield from _unreached(results, results.motion)
    yield from _near(results, results.motion)
    yield from _passive(results)
    if not results.driver_range.repeats:
        yield _("no number of turns was found after which all repeats: of the cycle, one turn is shown")
    if checked:
        yield from _slots(results)
        yield from _pressure(results)
    yield from _locked(results)
    yield from _twisted(results)
    yield from _impacts(results)
    yield from _loads(results, results.motion)
    yield from missed(measured_on(results), results.problem.units)
    if checked:
        yield from _lever(results, results.motion)


def _place(results: Results, q: float) -> str:
    """A place of the driver."""
    units, measure = results.problem.units, place_dimension(results.linkage.driver.kind)
    return f"{numeral(round(units.from_si(q, measure), 5) + 0.0, '.8g')} {units.spelt(measure)}"


def _range(results: Results) -> Iterable[str]:
    """Where the driver does not go all the way round, what stops it, and what that does to the positions."""
    driver_range, driver, request = results.driver_range, results.linkage.driver, results.problem.request
    assert driver_range is not None
    start, end = _place(results, driver_range.start), _place(results, driver_range.end)
    groups = ", ".join(dict.fromkeys(limit.group for limit in driver_range.limits if limit.group))
    said = []
    if groups and driver.kind == "turn":
        text = _(
            "driving link {link} cannot turn fully: it can go from {start} to {end}; there {groups} "
            "comes to its dead position"
        )
        said.append(text.format(link=driver.link, start=start, end=end, groups=groups))
    if any(limit.driver for limit in driver_range.limits):
        text = _("driving link {link} goes from {start} to {end} only: it slows down and stops there")
        said.append(text.format(link=driver.link, start=start, end=end))
    for what in said:
        if request.places:
            yield what
        elif isinstance(request.start, str) or not request.start:
            yield _("{what}; results are given for that range").format(what=what)
        else:
            yield _(
                "{what}; results are given for that range; positions.from ({start}) is for a driver that turns fully"
            ).format(what=what, start=_place(results, request.start))


def _sketch(results: Results) -> Iterable[str]:
    """Points that are sketched far from where they are."""
    linkage = results.linkage
    there = move(linkage, results.kernels, np.array([linkage.sketch.at]), DriverMotion(0.0, 1.0, 0.0, 1), 0)
    for point, off in sketch_deviations(linkage, there.poses).items():
        if off > SKETCH:
            yield _(
                "in the sketch {point} is {share} % of the mechanism's size from its place with the "
                "driver at {place}: is sketch.at right?"
            ).format(point=point, share=f"{100 * off:.0f}", place=_place(results, linkage.sketch.at))


def _dead(results: Results) -> Iterable[str]:
    closed = {kernel.group.title for kernel in results.kernels if isinstance(kernel, Closed)}
    for dead in results.dead:
        text = (
            _(
                "change point of {group} inside the cycle at {place} (margin {margin}): there the group may go over "
                "into another assembly; the results go smoothly through, as a machine that runs does (the other: "
                "`change points: keep side`)"
            )
            if dead.passed and dead.group in closed
            else _(
                "dead position of {group} inside the cycle at {place} (margin {margin}): there the group "
                "may leave its way for that of another assembly; the results go on along the smooth one"
            )
            if dead.passed
            else _(
                "dead position of {group} inside the cycle at {place} (margin {margin}): velocities and "
                "forces grow without bound there, and the group may leave it either way; the results "
                "keep to the side of the sketch"
            )
        )
        yield text.format(place=_place(results, dead.place), group=dead.group, margin=numeral(dead.margin, ".2g"))


def _unreached(results: Results, motion: Motion) -> Iterable[str]:
    """Positions that have no numbers."""
    units = results.problem.units
    unreached = np.flatnonzero(~motion.placed | np.any([*motion.dead.values(), ~motion.placed], axis=0))
    for k in unreached[:MOST_POSITIONS]:
        number, place = results.numbers[k], _place(results, float(motion.q[k]))
        for at, (group, lost) in zip(motion.placements, motion.missing.items(), strict=True):
            if lost[k]:
                gap = with_unit(units, float(at.residual[k]), LENGTH)
                yield _("position {number} ({place}): {group} cannot be assembled, {gap} short").format(
                    number=number, place=place, group=group, gap=gap
                )
        for group, dead in motion.dead.items():
            if dead[k]:
                yield _(
                    "position {number} ({place}): {group} is in its dead position; no velocities and forces"
                ).format(number=number, place=place, group=group)
    if len(unreached) > MOST_POSITIONS:
        yield _("... and {count} positions more that cannot be reached or are dead").format(
            count=len(unreached) - MOST_POSITIONS
        )
    stopped = np.flatnonzero(~np.isfinite(motion.rate))
    if stopped.size:
        said = [str(results.numbers[k]) for k in stopped[:FEW]] + ["..."] * (stopped.size > FEW)
        text = _(
            "driver {link} slows down and stops on its way: no velocities and forces in positions {numbers}, which "
            "it does not come to"
        )
        if results.single is not None and results.single.run.ending != "standstill":
            text = _(
                "the run of driver {link} ends before positions {numbers}: no velocities and forces there, as it does "
                "not come to them"
            )
        yield text.format(link=results.linkage.driver.link, numbers=", ".join(said))


def _near(results: Results, motion: Motion) -> Iterable[str]:
    """The position of each group that is nearest to a dead one, if it is near."""
    for kernel, at in zip(motion.kernels, motion.placements, strict=True):
        margin = np.where(motion.moving, at.margin, np.inf)
        if margin.size and np.min(margin) < kernel.near:
            k = int(np.argmin(margin))
            yield _(
                "position {number} is near a dead position of {group}: sine of the transmission angle {margin}"
            ).format(number=results.numbers[k], group=kernel.group.title, margin=numeral(float(margin[k]), ".2g"))


def _passive(results: Results) -> Iterable[str]:
    for passive in results.structure.passive:
        i, j = passive.links
        yield _(
            "pair {pair} holds link {j} on link {i} where it would be without it: this works with "
            "exact dimensions only, and the reactions of links {among} are indeterminate (given: the "
            "least ones)"
        ).format(pair=passive.pair, i=i, j=j, among=", ".join(passive.among))


def _slots(results: Results) -> Iterable[str]:
    """Stones that leave the segment of their guide."""
    units, driver_range = results.problem.units, results.driver_range
    assert driver_range is not None
    cycle = driver_range.end - driver_range.start
    for excess in results.slots:
        slide, ways = excess.slide, []
        for start, end in excess.ways:
            first = start % cycle if driver_range.full else start
            way = _("from {start} to {end}")
            if end - start >= cycle * (1 - 1e-9):
                way = _("everywhere")
            elif start == end:
                way = _("at {start}")
            ways.append(way.format(start=_place(results, first), end=_place(results, first + end - start)))
        if ways:
            yield _(
                "link {runner} leaves its slot {slot} of link {carrier}, which is {length} long: it is up to {far} "
                "beyond {point} (driver {ways}); a longer slot, or slides: {{..., unbounded: true}} where it is meant"
            ).format(
                runner=slide.runner, slot="".join(slide.ends or ()), carrier=slide.carrier, point=excess.point,
                length=with_unit(units, excess.length, LENGTH), far=with_unit(units, excess.far, LENGTH),
                ways=", ".join(ways),
            )  # fmt: skip


def _pressure(results: Results) -> Iterable[str]:
    """Pressure angles beyond what the file allows, or what is usual where a synthesis chose them freely."""
    units, limits_set = results.problem.units, results.problem.limits_set
    chosen = results.driver_range is not None and results.driver_range.full and _chosen_freely(results)
    if not (chosen or any(limits_set)):
        return
    for pressure in results.pressure:
        said = limits_set[0 if pressure.slides else 1]
        if pressure.holds or not (chosen or said):
            continue
        largest, allowed = (with_unit(units, angle, ANGLE, 4) for angle in (pressure.largest, pressure.allowed))
        text = (
            _("the pressure angle on link {link} comes to {largest}, the file allows {allowed}")
            if said
            else _(
                "the pressure angle on link {link} comes to {largest}; usual is at most {allowed} "
                "(another limit: checks: {{{check}: ...}})"
            )
        )
        check = "pressure_sliding" if pressure.slides else "pressure_turning"
        yield text.format(link=pressure.link, largest=largest, allowed=allowed, check=check)


def _chosen_freely(results: Results) -> bool:
    """Whether a synthesis found the linkage, and was asked nothing about its pressure angle."""
    found = results.problem.synthesis
    if found is None:
        return False
    asked = [d for d in found.outcome.demands if d.asked or found.task == "optimal"]
    return not any(d.of == "pressure" for d in asked)


def _locked(results: Results) -> Iterable[str]:
    """Where friction locks the mechanism, by the pair that rubs most."""
    if results.friction is None or not np.any(results.friction.locked):
        return
    lost, most = np.flatnonzero(results.friction.locked), results.friction.pair
    places = []
    for name in dict.fromkeys(most[k] for k in lost):
        numbers = [str(results.numbers[k]) for k in lost if most[k] == name]
        pair = results.structure.pair(name)
        text = (
            _("in position {numbers}, most of all in pair {pair} of links {i} and {j}")
            if len(numbers) == 1
            else _("in positions {numbers}, most of all in pair {pair} of links {i} and {j}")
        )
        places.append(text.format(numbers=", ".join(numbers), pair=name, i=pair.i, j=pair.j))
    yield _("the mechanism locks itself by friction: {places}; no forces are given there").format(
        places="; ".join(places)
    )


def _twisted(results: Results) -> Iterable[str]:
    """Torsion springs that come to half a turn from their free angle."""
    springs = [s for s in results.linkage.springs if s.turns]
    if not springs or results.reactions is None:
        return
    turns = results.driver_range.turns if results.driver_range else 1
    motion = at_positions(results, results.closely(CLOSELY * turns + 1), 0)
    for spring in springs:
        with np.errstate(invalid="ignore"):
            jumps = np.flatnonzero(np.abs(np.diff(twisted(spring, motion))) > np.pi)
        if jumps.size:
            yield _(
                "torsion spring {spring} is turned by more than half a turn from its free angle at "
                "{place}: its moment jumps there, as angles are counted within half a turn"
            ).format(spring=spring.name, place=_place(results, float(motion.q[jumps[0]])))


def _impacts(results: Results) -> Iterable[str]:
    """Cams whose law has jumps of the follower's speed."""
    units = results.problem.units
    for mesh in results.linkage.meshes:
        jumps = mesh.law.jumps() if mesh.law is not None else ()
        if jumps:
            places = ", ".join(numeral(units.from_si(a, ANGLE), ".6g") for a in jumps)
            yield _(
                "the law of cam {cam} lets the speed of follower {follower} jump ({places} of the cam): "
                "a hard impact, the acceleration there is not finite and is not in the tables"
            ).format(cam=mesh.i, follower=mesh.j, places=f"{places} {units.spelt(ANGLE)}")


def _loads(results: Results, motion: Motion) -> Iterable[str]:
    """Loads that drive, tables that are too short, and working strokes that there are not."""
    loads = results.linkage.loads
    working = [load.name for load in loads if load.working_stroke_only]
    for load in results.loads:
        if load.kind == "load" and load.name in working and _drives(motion, load):
            yield _(
                "load {load} acts along the motion in the whole working stroke: it drives and does not resist"
            ).format(load=load.name)
    for given in loads:
        if given.table is not None and _short_table(results, motion, given):
            yield _(
                "the table of load {load} does not reach as far as the {against} goes: its end value is held"
            ).format(load=given.name, against=_(given.table.against))
    for given in loads if results.steady is not None else ():
        if given.table is not None and _jumps_at_the_end(results, given.table):
            first, last = (
                with_unit(results.problem.units, value, FORCE if given.force else MOMENT)
                for value in (given.table.values[0], given.table.values[-1])
            )
            yield _(
                "the table of load {load} does not close over the cycle: it begins with {first} and ends with {last}, "
                "and the load jumps there; with the same value in both rows it would not"
            ).format(load=given.name, first=first, last=last)
    for name in working if results.strokes is None or not results.strokes.strokes else ():
        yield _(
            "load {load} is one of the working stroke, but there are no whole strokes on this way of "
            "the driver: it acts always"
        ).format(load=name)


def _drives(motion: Motion, load: Applied) -> bool:
    """Whether a load helps the motion at every position where it acts: it should resist."""
    power = dot(load.force, motion.point(load.link, load.at).v) + load.moment * motion.link(load.link).omega
    crank = motion.linkage.driver.kind == "turn"
    reach = max((kernel.size for kernel in motion.kernels), default=1.0) if crank else 1.0
    # at the ends of a stroke the speed is only rounding, and its sign says nothing
    most = np.abs(motion.rate) * (np.abs(load.force) * reach + np.abs(load.moment))
    acting = motion.moving & (np.abs(power) > 1e-6 * most)
    return bool(np.any(acting)) and bool(np.all(power[acting] > 0))


def _short_table(results: Results, motion: Motion, load: Load) -> bool:
    """Whether a load acts beyond the first or last argument of its table."""
    if load.table is None or not results.loads:
        return False
    acting = motion.placed
    if load.working_stroke_only and results.strokes is not None and results.strokes.strokes:
        acting = acting & results.strokes.share(motion.q, results.linkage.driver.sense)
    if load.window is not None:
        acting = acting & in_window(load.window, motion.q, results.linkage)
    if not np.any(acting):
        return False
    argument = table_argument(load.table.against, motion, results.strokes)[acting]
    first, last = load.table.arguments[0], load.table.arguments[-1]
    slack = 1e-6 * (last - first)
    return bool(np.any((argument < first - slack) | (argument > last + slack)))


def _jumps_at_the_end(results: Results, table: LoadTable) -> bool:
    """Whether a table against the crank, between whose rows one goes evenly, ends otherwise than it begins."""
    rows, cycle = table.arguments, 2 * np.pi * results.linkage.turns
    whole = abs(float(rows[-1]) - float(rows[0]) - cycle) < SAME_PLACE
    jump = abs(float(table.values[-1]) - float(table.values[0]))
    largest = max(abs(float(value)) for value in table.values)
    return table.against != "stroke" and table.between == "linear" and whole and jump > SAME_RATIO * largest


def _lever(results: Results, motion: Motion) -> Iterable[str]:
    if results.lever is None or results.lever_holds:
        return
    worst = np.where(motion.moving & ~results.locked, results.lever.difference, 0.0)
    k = int(np.argmax(worst))
    yield _(
        "the lever differs from the force plan by {difference} % at position {number}, more than the limit of {limit} %"
    ).format(
        number=results.numbers[k], difference=numeral(100 * float(worst[k]), ".3g"),
        limit=numeral(100 * results.problem.lever_limit, ".3g"),
    )  # fmt: skip
