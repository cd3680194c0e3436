"""Friction that locks, springs wound too far, loads that drive, tables too short or not closed, demands, the lever."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tmm_cli.analysis.pipeline import Results, at_positions
from tmm_cli.forces.applied import Applied
from tmm_cli.forces.given import in_window, table_argument
from tmm_cli.forces.springs import twisted
from tmm_cli.kinematics.motion import Motion
from tmm_cli.language import _, numeral
from tmm_cli.linkage import Load, LoadTable
from tmm_cli.quantities import FORCE, MOMENT
from tmm_cli.results.reports.synthesis import missed
from tmm_cli.results.table import with_unit
from tmm_cli.results.warnings.motion import driver_place
from tmm_cli.synthesis.check import measured_on
from tmm_cli.tolerances import SAME_PLACE, SAME_RATIO
from tmm_cli.vectors import dot

CLOSELY = 720  # places a turn at which a torsion spring's angle is followed


def locked_positions(results: Results) -> Iterable[str]:
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


def wound_springs(results: Results) -> Iterable[str]:
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
            ).format(spring=spring.name, place=driver_place(results, float(motion.q[jumps[0]])))


def driving_loads(results: Results) -> Iterable[str]:
    """Loads of the working stroke that help the motion all through it."""
    motion, working = results.motion, _of_working_stroke(results)
    assert motion is not None
    for load in results.loads:
        if load.kind == "load" and load.name in working and _drives(motion, load):
            yield _(
                "load {load} acts along the motion in the whole working stroke: it drives and does not resist"
            ).format(load=load.name)


def short_tables(results: Results) -> Iterable[str]:
    """Tables of loads that end before the motion does."""
    for load in results.linkage.loads if results.loads else ():
        if load.table is not None and _short(results, load, load.table):
            yield _(
                "the table of load {load} does not reach as far as the {against} goes: its end value is held"
            ).format(load=load.name, against=_(load.table.against))


def open_tables(results: Results) -> Iterable[str]:
    """In steady running: tables of loads that end otherwise than they begin."""
    for load in results.linkage.loads if results.steady is not None else ():
        if load.table is not None and _jumps_at_the_end(results, load.table):
            first, last = (
                with_unit(results.problem.units, value, FORCE if load.force else MOMENT)
                for value in (load.table.values[0], load.table.values[-1])
            )
            yield _(
                "the table of load {load} does not close over the cycle: it begins with {first} and ends with {last}, "
                "and the load jumps there; with the same value in both rows it would not"
            ).format(load=load.name, first=first, last=last)


def without_strokes(results: Results) -> Iterable[str]:
    """Loads of a working stroke that there is not."""
    for name in _of_working_stroke(results) if results.strokes is None or not results.strokes.strokes else ():
        yield _(
            "load {load} is one of the working stroke, but there are no whole strokes on this way of "
            "the driver: it acts always"
        ).format(load=name)


def _of_working_stroke(results: Results) -> list[str]:
    return [load.name for load in results.linkage.loads if load.working_stroke_only]


def _drives(motion: Motion, load: Applied) -> bool:
    """Whether a load helps the motion at every position where it acts: it should resist."""
    power = dot(load.force, motion.point(load.link, load.at).v) + load.moment * motion.link(load.link).omega
    crank = motion.linkage.driver.kind == "turn"
    reach = max((kernel.size for kernel in motion.kernels), default=1.0) if crank else 1.0
    # at the ends of a stroke the speed is only rounding, and its sign says nothing
    most = np.abs(motion.rate) * (np.abs(load.force) * reach + np.abs(load.moment))
    acting = motion.moving & (np.abs(power) > 1e-6 * most)
    return bool(np.any(acting)) and bool(np.all(power[acting] > 0))


def _short(results: Results, load: Load, table: LoadTable) -> bool:
    """Whether a load acts beyond the first or last argument of its table."""
    motion = results.motion
    assert motion is not None
    acting = motion.placed
    if load.working_stroke_only and results.strokes is not None and results.strokes.strokes:
        acting = acting & results.strokes.share(motion.q, results.linkage.driver.sense)
    if load.window is not None:
        acting = acting & in_window(load.window, motion.q, results.linkage)
    if not np.any(acting):
        return False
    argument = table_argument(table, motion, results.strokes)[acting]
    first, last = table.arguments[0], table.arguments[-1]
    slack = 1e-6 * (last - first)
    return bool(np.any((argument < first - slack) | (argument > last + slack)))


def _jumps_at_the_end(results: Results, table: LoadTable) -> bool:
    """Whether a table against the crank, between whose rows one goes evenly, ends otherwise than it begins."""
    rows, cycle = table.arguments, 2 * np.pi * results.linkage.turns
    whole = abs(float(rows[-1]) - float(rows[0]) - cycle) < SAME_PLACE
    jump = abs(float(table.values[-1]) - float(table.values[0]))
    largest = max(abs(float(value)) for value in table.values)
    return table.against != "stroke" and table.between == "linear" and whole and jump > SAME_RATIO * largest


def unmet_demands(results: Results) -> Iterable[str]:
    """What a synthesis was asked and did not do."""
    return missed(measured_on(results), results.problem.units)


def lever_apart(results: Results) -> Iterable[str]:
    """A lever that does not agree with the force plan."""
    motion = results.motion
    if results.lever is None or results.lever_holds or motion is None:
        return
    worst = np.where(motion.moving & ~results.locked, results.lever.difference, 0.0)
    k = int(np.argmax(worst))
    yield _(
        "the lever differs from the force plan by {difference} % at position {number}, more than the limit of {limit} %"
    ).format(
        number=results.numbers[k], difference=numeral(100 * float(worst[k]), ".3g"),
        limit=numeral(100 * results.problem.lever_limit, ".3g"),
    )  # fmt: skip
