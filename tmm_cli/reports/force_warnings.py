"""Warnings about forces: self-locking, loads and their tables, synthesis requirements, Zhukovsky lever."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from tmm_cli.language import _, numeral
from tmm_cli.mechanics.analysis import Results, motion_at_positions
from tmm_cli.mechanics.forces import (
    AppliedLoad,
    always_acts,
    ends_with_stroke,
    is_acting,
    problem_loads,
    table_argument,
    table_lengths,
)
from tmm_cli.mechanics.kinematics import Motion
from tmm_cli.mechanics.linkage import Linkage, Load, LoadTable
from tmm_cli.mechanics.numerics import NO_WORK, SAME_DRIVER_POSITION, SAME_RATIO, Real, dot
from tmm_cli.mechanics.quantities import ANGLE, FORCE, MOMENT
from tmm_cli.problem import UnitSystem
from tmm_cli.reports.force_tables import describe_locked_ranges
from tmm_cli.reports.input_load_tables import argument_dimension
from tmm_cli.reports.synthesis_tables import unmet_demand_sentences
from tmm_cli.reports.table import with_unit
from tmm_cli.synthesis import measure_problem

WORK_POSITIONS = 120  # positions a turn at which the power of a load is compared with zero


def locked_positions(results: Results) -> Iterable[str]:
    """Warn of ranges in which friction locks the mechanism, including ranges between the positions."""
    ranges = describe_locked_ranges(results)
    if ranges:
        yield _(
            "friction locks the mechanism {ranges}; no forces are computed there. Reduce the coefficients of "
            "friction, or choose another input link"
        ).format(ranges="; ".join(ranges))


def driving_loads(results: Results) -> Iterable[str]:
    """Warn of working-stroke loads that act in the direction of motion, or do no work, throughout the stroke."""
    loads = [load for load in results.linkage.loads if load.working_stroke_only and not load.resists]
    if not loads or results.reactions is None:
        return
    turns = results.driver_range.turns if results.driver_range else 1
    motion = motion_at_positions(results, results.closely(WORK_POSITIONS * turns + 1))
    acting = list(problem_loads(motion, results.strokes))
    for load in loads:
        its = [applied for applied in acting if applied.name in (load.name, f"{load.name}'")]
        power, largest = _load_power(motion, its)
        works = np.abs(power) > NO_WORK * largest
        if np.any(works) and np.all(power[works] > 0):
            yield _driving_load_text(results, load)
        elif not np.any(works) and np.any(largest > 0):
            yield _idle_load_text(results, load, motion, its[0])


def _load_power(motion: Motion, acting: Iterable[AppliedLoad]) -> tuple[Real, Real]:
    """Return the total power of the loads (W), and an upper limit of it at this speed of the driver, both (positions,).

    Both are zero at positions without velocities.
    """
    crank = motion.linkage.driver.kind == "turn"
    reach = max((kernel.size for kernel in motion.kernels), default=1.0) if crank else 1.0
    power = largest = np.zeros(np.shape(motion.q))
    for load in acting:
        work = dot(load.force, motion.point(load.link, load.at).v) + load.moment * motion.link(load.link).omega
        power = power + np.where(motion.moving, work, 0.0)
        largest = largest + np.abs(motion.rate) * (np.abs(load.force) * reach + np.abs(load.moment))
    return power, np.where(motion.moving, largest, 0.0)


def _driving_load_text(results: Results, load: Load) -> str:
    strokes = results.strokes
    if strokes is None or not strokes.working:
        return _(
            "load {load} acts in the direction of motion during the whole working stroke. Reverse its sign"
        ).format(load=load.name)
    other = "backward" if strokes.working[0].run > 0 else "forward"
    link = results.linkage.output_point(strokes.link) or strokes.link
    text = _(
        "load {load} acts in the direction of motion during the whole working stroke. Reverse its sign, or choose the "
        "other stroke: {output}"
    ).format(load=load.name, output=f"output: {{link: {link}, working: {other}}}")
    working = strokes.of_link(load.stroke_link).working
    if load.table is None or load.table.key != "pressure" or len(working) != 1:
        return text
    start = working[0].start
    low, high = np.degrees(sorted((start, start + results.linkage.driver.sense * working[0].length)))
    turns = np.floor(high / 360) * 360  # a window that begins before the zero begins at a negative angle
    low, high = np.floor((low - turns) * 1000) / 1000, np.ceil((high - turns) * 1000) / 1000  # holds both ends
    window = f"when: [{low:.10g} deg, {high:.10g} deg]"
    return _("{text}. For an engine, in which the gas drives the piston, write {window}").format(
        text=text, window=window
    )


def _idle_load_text(results: Results, load: Load, motion: Motion, applied: AppliedLoad) -> str:
    """Return the warning about a load that does no work, with a proposed direction of the load.

    The proposed direction is opposite to the velocity of the point of application where this velocity is largest.
    """
    velocity = np.where(motion.moving, motion.point(load.link, load.at).v, 0j)
    acting = motion.moving & (np.abs(applied.force) > 0)
    k = int(np.argmax(np.where(acting, np.abs(velocity), -1.0)))
    if not np.any(acting):
        return _(
            "load {load} does no work in the working stroke: link {link} does not rotate. Give a force instead "
            "of a moment"
        ).format(load=load.name, link=load.link)
    if not abs(velocity[k]):
        return _(
            "load {load} does no work in the working stroke: its point is at rest. Give a link or a point that moves"
        ).format(load=load.name)
    turned = motion.poses[load.link].z[k] if load.follows else 1.0
    angle = round(float(np.angle(-velocity[k] / turned)), 6) + 0.0  # no signed zero
    written = f"angle: {results.problem.units.format_value(angle, ANGLE, 4)}"
    if load.table is None:
        written = f"force: {{size: {results.problem.units.format_value(abs(load.force), FORCE)}, {written}}}"
    return _(
        "load {load} does no work in the working stroke: its force is perpendicular to the motion of its "
        "point. Direct it against the motion: {written}"
    ).format(load=load.name, written=written)


def short_tables(results: Results) -> Iterable[str]:
    """Warn of load tables that do not cover the whole motion during which the load acts."""
    for load in results.linkage.loads if results.loads else ():
        if load.table is not None and _ends_early(results, load, load.table):
            sentence = _(
                "the table of load {load} does not cover the whole range of its argument ({against}): beyond its "
                "first and last row, the value of that row is used"
            ).format(load=load.name, against=_(load.table.against))
            if load.table.against == "stroke" and not load.table.shares:
                sentence = _(
                    "{slip}; rows in fractions of the stroke (against: share of stroke) cover any stroke"
                ).format(slip=sentence)
            yield sentence


def long_tables(results: Results) -> Iterable[str]:
    """Warn of load tables that extend beyond the stroke."""
    units = results.problem.units
    for load, last, stroke in table_lengths(results.linkage, results.strokes) if results.loads else ():
        assert load.table is not None
        if last > stroke and not ends_with_stroke(last, stroke):
            measure = argument_dimension(results.linkage, load.table)
            yield _(
                "the table of load {load} extends to {last}, but the stroke is {stroke}: its last rows are never "
                "reached. Is the unit correct? Rows in fractions of the stroke (against: share of stroke) fit any "
                "stroke"
            ).format(load=load.name, last=with_unit(units, last, measure), stroke=with_unit(units, stroke, measure))


def warn_of_load_tables(
    linkage: Linkage, units: UnitSystem, reach: Mapping[str, Sequence[tuple[float, float]]]
) -> Iterable[str]:
    """Yield warnings about load tables that do not end with the stroke in some of many variants of a mechanism.

    Args:
        linkage: linkage of any variant.
        units: units of the file.
        reach: by the name of each load, a pair for each variant: the last argument of the table and the stroke (m or
            rad).
    """
    for load in linkage.loads:
        lasts, strokes = np.array(reach.get(load.name) or np.zeros((0, 2))).T
        apart = ~ends_with_stroke(lasts, strokes)
        if load.table is not None and np.any(apart):
            measure = argument_dimension(linkage, load.table)
            yield _(
                "the table of load {load} does not end with the stroke in {apart} of {count} mechanisms: its last "
                "row is for {last}, the strokes are from {least} to {largest}. Rows in fractions of the stroke "
                "(against: share of stroke) fit any stroke"
            ).format(
                load=load.name,
                apart=np.count_nonzero(apart),
                count=len(apart),
                last=with_unit(units, lasts[apart][0], measure),
                least=with_unit(units, np.min(strokes), measure),
                largest=with_unit(units, np.max(strokes), measure),
            )


def open_tables(results: Results) -> Iterable[str]:
    """Warn of load tables whose first and last values differ although the motion repeats in every cycle (steady
    running).
    """
    for load in results.linkage.loads if results.steady is not None else ():
        if load.table is not None and _jumps_at_cycle_end(results, load.table):
            first, last = (
                with_unit(results.problem.units, value, FORCE if load.force else MOMENT)
                for value in (load.table.values[0], load.table.values[-1])
            )
            yield _(
                "the table of load {load} has different values at the beginning ({first}) and at the end ({last}) "
                "of the cycle, so the load jumps there; give the same value in both rows to avoid this"
            ).format(load=load.name, first=first, last=last)


def loads_without_strokes(results: Results) -> Iterable[str]:
    """Warn of loads of the working stroke if the range of the driver contains no complete stroke."""
    for load in results.linkage.loads:
        if load.working_stroke_only and always_acts(load, results.strokes):
            yield _(
                "load {load} is specified for the working stroke, but the driver's range contains no complete "
                "stroke: the load acts at all positions"
            ).format(load=load.name)


def _ends_early(results: Results, load: Load, table: LoadTable) -> bool:
    """Return True if a load acts before the first or after the last row of its table."""
    motion = results.motion
    assert motion is not None
    acting = motion.placed & is_acting(load, motion.q, results.linkage, results.strokes)
    if not np.any(acting):
        return False
    argument = table_argument(table, motion, results.strokes)[acting]
    first, last = table.arguments[0], table.arguments[-1]
    slack = 1e-6 * (last - first)
    return bool(np.any((argument < first - slack) | (argument > last + slack)))


def _jumps_at_cycle_end(results: Results, table: LoadTable) -> bool:
    """Return True if a load table for a whole cycle of the crank ends with another value than it begins with.

    Only tables with linear interpolation are concerned.
    """
    rows, cycle = table.arguments, 2 * np.pi * results.linkage.turns
    whole = abs(float(rows[-1]) - float(rows[0]) - cycle) < SAME_DRIVER_POSITION
    jump = abs(float(table.values[-1]) - float(table.values[0]))
    largest = max(abs(float(value)) for value in table.values)
    return table.against != "stroke" and table.between == "linear" and whole and jump > SAME_RATIO * largest


def unmet_demands(results: Results) -> Iterable[str]:
    """Warn of requirements of the synthesis that are not met."""
    return unmet_demand_sentences(measure_problem(results), results.problem.units)


def lever_disagreement(results: Results) -> Iterable[str]:
    """Warn if the Zhukovsky lever and the force plan give different balancing loads."""
    motion = results.motion
    if results.lever is None or results.lever_holds or motion is None:
        return
    worst = np.where(motion.moving & ~results.locked, results.lever.difference, 0.0)
    k = int(np.argmax(worst))
    yield _(
        "the Zhukovsky lever differs from the force plan by {difference} % at position {number}; the limit is {limit} %"
    ).format(
        number=results.numbers[k],
        difference=numeral(100 * float(worst[k]), ".3g"),
        limit=numeral(100 * results.problem.lever_limit, ".3g"),
    )
