"""Warnings about motion: driver range, dead positions, single runs, redundant constraints, slots, pressure angles,
cams.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, cast

import numpy as np

from tmm_cli.language import _, numeral
from tmm_cli.mechanics.analysis import Results
from tmm_cli.mechanics.assembly import sketch_deviations
from tmm_cli.mechanics.groups import ClosedFormSolver, DriverMotion
from tmm_cli.mechanics.kinematics import compute_motion
from tmm_cli.mechanics.quantities import ANGLE, LENGTH, SPEED, coordinate_dimension
from tmm_cli.reports.table import with_unit

if TYPE_CHECKING:
    from tmm_cli.mechanics.dynamics import DriveProfile


MOST_POSITIONS = 100  # that cannot be reached, each with its own words
NAMED_POSITIONS = 12  # positions that are named in one sentence
SAME_END = 1e-6  # of a run: a table of its drive that begins or ends nearer to an end of the run reaches it
SKETCH_DEVIATION = 0.15  # a sketched point farther off than this share of the linkage's size is worth a word


def format_driver_coordinate(results: Results, q: float) -> str:
    """Return a driver coordinate as text in the unit of the file."""
    units, measure = results.problem.units, coordinate_dimension(results.linkage.driver.kind)
    return f"{numeral(round(units.from_si(q, measure), 5) + 0.0, '.8g')} {units.spelt(measure)}"


def limited_driver(results: Results) -> Iterable[str]:
    """Warn of a driver that does not rotate fully, with its range, the reason, and the effect on the positions."""
    driver_range, driver, request = results.driver_range, results.linkage.driver, results.problem.request
    assert driver_range is not None
    start, end = (
        format_driver_coordinate(results, driver_range.start),
        format_driver_coordinate(results, driver_range.end),
    )
    groups = ", ".join(dict.fromkeys(limit.group for limit in driver_range.limits if limit.group))
    sentences = []
    if groups and driver.kind == "turn":
        text = _(
            "input link {link} cannot make a full turn: it moves only from {start} to {end}, where it reaches "
            "a dead position of {groups}"
        )
        sentences.append(text.format(link=driver.link, start=start, end=end, groups=groups))
    if any(limit.driver for limit in driver_range.limits):
        text = _("input link {link} moves only from {start} to {end}, where it slows down and stops")
        sentences.append(text.format(link=driver.link, start=start, end=end))
    for sentence in sentences:
        if request.places:
            yield sentence
        elif isinstance(request.start, str) or not request.start:
            yield _("{what}; the results cover only this range").format(what=sentence)
        else:
            yield _(
                "{what}; the results cover only this range, and positions.from ({start}) is not used, because it "
                "requires full rotation"
            ).format(what=sentence, start=format_driver_coordinate(results, request.start))


def far_from_sketch(results: Results) -> Iterable[str]:
    """Warn of points that the sketch of the file places far from their computed positions."""
    linkage = results.linkage
    sketch_motion = compute_motion(
        linkage, results.kernels, np.array([linkage.sketch.at]), DriverMotion(0.0, 1.0, 0.0, 1), 0
    )
    for point, off in sketch_deviations(linkage, sketch_motion.poses).items():
        if off > SKETCH_DEVIATION:
            yield _(
                "in the sketch, point {point} is {share} % of the mechanism's size away from its computed position "
                "for the driver at {place}: is sketch.at correct?"
            ).format(point=point, share=f"{100 * off:.0f}", place=format_driver_coordinate(results, linkage.sketch.at))


def dead_positions(results: Results) -> Iterable[str]:
    """Warn of dead positions and change points within the range of the driver."""
    closed = {kernel.group.title for kernel in results.kernels if isinstance(kernel, ClosedFormSolver)}
    for dead in results.dead:
        text = (
            _(
                "change point of {group} in the cycle at {place} (margin {margin}): here the group can change to "
                "another assembly; the results continue smoothly, as in a running machine (for the other branch: "
                "`change points: keep side`)"
            )
            if dead.passed and dead.group in closed
            else _(
                "dead position of {group} in the cycle at {place} (margin {margin}): here the group can pass to "
                "the branch of another assembly; the results follow the smooth branch"
            )
            if dead.passed
            else _(
                "dead position of {group} in the cycle at {place} (margin {margin}): velocities and forces become "
                "infinite here, and the group can continue on two branches; the results are for the assembly of "
                "the sketch"
            )
        )
        yield text.format(
            place=format_driver_coordinate(results, dead.place), group=dead.group, margin=numeral(dead.margin, ".2g")
        )


def unreached_positions(results: Results) -> Iterable[str]:
    """Warn of requested positions that cannot be assembled, are dead positions or are change points."""
    motion, units = results.motion, results.problem.units
    assert motion is not None
    unreached = np.flatnonzero(~motion.placed | np.any([*motion.dead.values(), ~motion.placed], axis=0))
    for k in unreached[:MOST_POSITIONS]:
        number, place = results.numbers[k], format_driver_coordinate(results, float(motion.q[k]))
        for at, (group, lost) in zip(motion.placements, motion.missing.items(), strict=True):
            if lost[k]:
                gap = with_unit(units, float(at.residual[k]), LENGTH)
                yield _(
                    "position {number} ({place}): group {group} cannot be assembled; its points remain {gap} apart"
                ).format(number=number, place=place, group=group, gap=gap)
        for group, dead in motion.dead.items():
            if dead[k] and motion.limits is not None and motion.limits[k]:
                yield _(
                    "position {number} ({place}): {group} passes a change point "
                    "smoothly; velocities and accelerations "
                    "are limit values, reactions have no limit there"
                ).format(number=number, place=place, group=group)
            elif dead[k]:
                yield _(
                    "position {number} ({place}): group {group} is in a dead position; velocities and forces are "
                    "undefined"
                ).format(number=number, place=place, group=group)
    if len(unreached) > MOST_POSITIONS:
        yield _("... and further positions that cannot be reached or are dead positions: {count}").format(
            count=len(unreached) - MOST_POSITIONS
        )


def stopped_driver(results: Results) -> Iterable[str]:
    """Warn of positions that the driver does not reach, because it stops or its run ends before them."""
    motion = results.motion
    assert motion is not None
    stopped = np.flatnonzero(~np.isfinite(motion.rate))
    if stopped.size:
        numbers = [str(results.numbers[k]) for k in stopped[:NAMED_POSITIONS]] + ["..."] * (
            stopped.size > NAMED_POSITIONS
        )
        text = _(
            "driver {link} slows down and stops: it does not reach positions {numbers}, so there are no "
            "velocities and forces in them"
        )
        if results.single is not None and results.single.run.ending != "standstill":
            text = _(
                "the run of driver {link} ends before positions {numbers}, so there are no velocities and forces "
                "in them"
            )
        yield text.format(link=results.linkage.driver.link, numbers=", ".join(numbers))


def opposite_run(results: Results) -> Iterable[str]:
    """Warn if a single run moves the driver in the direction opposite to the one in the file."""
    single, driver = results.single, results.linkage.driver
    if single is None or single.sense == driver.sense:
        return
    ends = (single.first, single.first + single.sense * single.machine.length)
    first, last = (format_driver_coordinate(results, end) for end in ends)
    if driver.kind == "turn":
        yield _(
            "the run goes from {first} to {last}, {sense}, which is not the direction of driver {link}: write "
            "`turns: {turns}` for this driver, or exchange `from` and `to`"
        ).format(
            first=first,
            last=last,
            link=driver.link,
            turns="ccw" if single.sense > 0 else "cw",
            sense=_("counterclockwise") if single.sense > 0 else _("clockwise"),
        )
        return
    speed = f"{'-' if single.sense < 0 else ''}{with_unit(results.problem.units, driver.rate, SPEED)}"
    yield _(
        "the run goes from {first} to {last}, opposite to the speed of driver {link}: write `speed: "
        "{speed}` for this driver, or exchange `from` and `to`"
    ).format(first=first, last=last, link=driver.link, speed=speed)


def short_drive(results: Results) -> Iterable[str]:
    """Warn of a table of the driving moment that does not cover the whole single run, so that its end values are used
    there.
    """
    single = results.single
    if single is None or len(single.task.edges or single.task.way_edges) < 2:
        return
    drive = cast("DriveProfile", single.task.drive)
    by_time = drive.against == "time"
    reached = float(single.run.time[-1]) if by_time else float(single.run.way[-1])
    first, last = drive.arguments[0], drive.arguments[-1]
    measure = coordinate_dimension(results.linkage.driver.kind)

    def argument(value: float) -> str:
        return f"{numeral(value, '.6g')} s" if by_time else with_unit(results.problem.units, value, measure)

    if first > SAME_END * reached and drive.values[0] != 0:
        yield _(
            "the table of the driving moment or force begins at {first}: before that, its first value is used; "
            "add a row at 0"
        ).format(first=argument(first))
    if reached - last > SAME_END * reached and drive.values[-1] != 0:
        yield _(
            "the table of the driving moment or force ends at {last}: its last value is used up to {reached}, "
            "the end of the run; add a row there"
        ).format(last=argument(last), reached=argument(reached))


def near_dead(results: Results) -> Iterable[str]:
    """Warn of each Assur group that comes near a dead position; name the position in which it comes nearest."""
    motion = results.motion
    assert motion is not None
    for kernel, at in zip(motion.kernels, motion.placements, strict=True):
        margin = np.where(motion.moving, at.margin, np.inf)
        if margin.size and np.min(margin) < kernel.near:
            k = int(np.argmin(margin))
            yield _(
                "position {number} is near a dead position of {group}: the sine of the transmission angle is only "
                "{margin}"
            ).format(number=results.numbers[k], group=kernel.group.title, margin=numeral(float(margin[k]), ".2g"))


def unrepeated_cycle(results: Results) -> Iterable[str]:
    """Warn if the motion was not found to repeat after any number of crank revolutions."""
    if results.driver_range is not None and not results.driver_range.repeats:
        yield _("no number of turns was found after which the motion repeats: only one turn is shown")


def passive_pairs(results: Results) -> Iterable[str]:
    """Warn of pairs with redundant constraints."""
    for passive in results.structure.passive:
        i, j = passive.links
        yield _(
            "pair {pair} between links {i} and {j} has redundant constraints: the mechanism moves only if its "
            "dimensions are exact, and the reactions of links {among} are statically indeterminate (the "
            "smallest possible ones are given)"
        ).format(pair=passive.pair, i=i, j=j, among=", ".join(passive.among))


def left_slots(results: Results) -> Iterable[str]:
    """Warn of sliding blocks that leave their slots."""
    units, driver_range = results.problem.units, results.driver_range
    assert driver_range is not None
    cycle = driver_range.end - driver_range.start
    for excess in results.slots:
        slide, driver_ranges = excess.slide, []
        for start, end in excess.ways:
            first = start % cycle if driver_range.full else start
            text = _("from {start} to {end}")
            if end - start >= cycle * (1 - 1e-9):
                text = _("in all positions")
            elif start == end:
                text = _("at {start}")
            driver_ranges.append(
                text.format(
                    start=format_driver_coordinate(results, first),
                    end=format_driver_coordinate(results, first + end - start),
                )
            )
        if driver_ranges:
            yield _(
                "link {runner} leaves its slot {slot} in link {carrier} (length {length}): it moves up to {far} "
                "beyond {point} (driver {ways}); lengthen the slot, or write `slides: {{..., unbounded: true}}` if "
                "this is intended"
            ).format(
                runner=slide.runner,
                slot="".join(slide.ends or ()),
                carrier=slide.carrier,
                point=excess.point,
                length=with_unit(units, excess.length, LENGTH),
                far=with_unit(units, excess.far, LENGTH),
                ways=", ".join(driver_ranges),
            )


def excessive_pressure_angles(results: Results) -> Iterable[str]:
    """Warn of pressure angles above the limit of the file, or above the usual limit.

    The usual limit is applied only if a synthesis found the linkage without a requirement on the pressure angle.
    """
    units, limits_set = results.problem.units, results.problem.limits_set
    chosen = results.driver_range is not None and results.driver_range.full and _chosen_freely(results)
    if not (chosen or any(limits_set)):
        return
    for pressure in results.pressure:
        in_file = limits_set[0 if pressure.slides else 1]
        if pressure.holds or not (chosen or in_file):
            continue
        largest, allowed = (with_unit(units, angle, ANGLE, 4) for angle in (pressure.largest, pressure.allowed))
        text = (
            _("the pressure angle on link {link} reaches {largest}; the limit in the file is {allowed}")
            if in_file
            else _(
                "the pressure angle on link {link} reaches {largest}; usually at most {allowed} is allowed (to set "
                "another limit, write checks: {{{check}: ...}})"
            )
        )
        check = "pressure_sliding" if pressure.slides else "pressure_turning"
        yield text.format(link=pressure.link, largest=largest, allowed=allowed, check=check)


def _chosen_freely(results: Results) -> bool:
    """Return True if a synthesis found the linkage without a requirement on its pressure angle."""
    synthesis = results.problem.synthesis
    if synthesis is None:
        return False
    demands = [d for d in synthesis.outcome.demands if d.asked or synthesis.task == "optimal"]
    return not any(d.of == "pressure" for d in demands)


def cam_impacts(results: Results) -> Iterable[str]:
    """Warn of cam laws with a discontinuous follower velocity."""
    units = results.problem.units
    for mesh in results.linkage.meshes:
        jumps = mesh.law.jumps() if mesh.law is not None else ()
        if jumps:
            angles = ", ".join(numeral(units.from_si(a, ANGLE), ".6g") for a in jumps)
            yield _(
                "by the law of motion of cam {cam}, the speed of follower {follower} jumps (cam angle {places}). "
                "This is a hard impact: the acceleration there is infinite and is not in the tables"
            ).format(cam=mesh.i, follower=mesh.j, places=f"{angles} {units.spelt(ANGLE)}")
