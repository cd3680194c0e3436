"""The loads of the task: what they are tabulated against, where they act, and what resists a motion."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np

from tmm_cli.forces.applied import Applied
from tmm_cli.kinematics.motion import Motion, moving_parts
from tmm_cli.kinematics.output import output_place
from tmm_cli.kinematics.strokes import Strokes
from tmm_cli.linkage import FRAME, Linkage, Load, LoadTable
from tmm_cli.tolerances import SAME_PLACE, SEAM
from tmm_cli.vectors import Real, Vector, cross, pi

BEFORE_END = 1e-3  # of the stroke: a table that ends before its end by less is rounded
BEYOND_END = 0.02  # of the stroke: likewise beyond it


def given_loads(motion: Motion, strokes: Strokes | None) -> Iterable[Applied]:
    """The loads of the task, each with its opposite on the other link if that moves.

    Those of working strokes act always where there are none.
    """
    for load in motion.linkage.loads:
        size = _size(load, motion, strokes)
        along: Vector | float = motion.poses[load.link].z if load.follows else 1.0
        turning: Real | float = 1.0
        if load.resists:
            velocity, turned = setting_off(load, motion)
            along, turning = -velocity, -turned
        force, moment = load.force * size * along, load.moment * size * turning
        yield Applied(load.name, "load", load.link, load.at, force, moment, load.name)
        if load.base != FRAME:
            yield _opposite(load, motion, force, moment)


def _size(load: Load, motion: Motion, strokes: Strokes | None) -> Real:
    """What its force and moment are multiplied by."""
    size = np.ones(np.shape(motion.q))
    if load.table is not None:
        size = load.table(table_argument(load.table, motion, strokes))
    return size if acts_always(load, strokes) else np.where(acts(load, motion.q, motion.linkage, strokes), size, 0.0)


def acts(load: Load, q: Real, linkage: Linkage, strokes: Strokes | None) -> Real:
    """True at the positions of the driver in which a load acts, which is always if there are no strokes."""
    if load.window is not None:
        return in_window(load.window, q, linkage)
    if acts_always(load, strokes):
        return np.ones(np.shape(q), dtype=bool)
    assert strokes is not None
    return strokes.of_link(load.stroke_link).share(q, linkage.driver.sense)


def acts_always(load: Load, strokes: Strokes | None) -> bool:
    """True if a load acts at all positions: it is limited neither to a window nor to working strokes that there are."""
    if load.window is not None:
        return False
    return not load.working_stroke_only or strokes is None or not strokes.of_link(load.stroke_link).strokes


def _opposite(load: Load, motion: Motion, force: Vector, moment: Real) -> Applied:
    """What the other link has of it: at the point that both share, or along the same line."""
    name, points = f"{load.name}'", motion.linkage.links[load.base].points
    if load.point in points:
        return Applied(name, "load", load.base, points[load.point], -force, -moment, name)
    arm = motion.poses[load.link].at(load.at) - motion.poses[load.base].x
    return Applied(name, "load", load.base, 0j, -force, -moment - cross(arm, force), name)


def setting_off(load: Load, motion: Motion) -> tuple[Vector, Real]:
    """Direction in which the point of a load moves, and the sense in which its link turns, as its base sees them.

    In an end of its way a thing has the direction in which it sets off from there; what stays at rest has none: 0.
    """
    largest = motion.largest
    velocity, spin = motion_on_base(load, motion)
    velocity, spin = moving_parts(velocity, largest.speed), moving_parts(spin, largest.speed / largest.size)
    if motion.order > 1:
        pose, other = motion.poses[load.link], motion.second[load.base]
        arm, far = load.at * pose.z, pose.at(load.at) - motion.poses[load.base].x
        second = motion.second[load.link]
        gain = second.at(arm, motion.first[load.link].w) - other.at(far, motion.first[load.base].w)
        velocity = np.where(velocity == 0, moving_parts(gain, largest.acceleration), velocity)
        spin = np.where(spin == 0, moving_parts(second.e - other.e, largest.acceleration / largest.size), spin)
    length = np.abs(velocity)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(length > 0, velocity / length, 0j), np.sign(spin)


def motion_on_base(load: Load, motion: Motion) -> tuple[Vector, Real]:
    """Velocity of the point of a load and turning of its link on the base, in units of the driver's motion."""
    sense = np.where(motion.rate == 0, motion.linkage.driver.sense, np.sign(motion.rate))
    pose, first, base = motion.poses[load.link], motion.first[load.link], motion.first[load.base]
    far = pose.at(load.at) - motion.poses[load.base].x
    return sense * (first.at(load.at * pose.z) - base.at(far)), sense * (first.w - base.w)


def in_window(window: tuple[float, float], q: Real, linkage: Linkage) -> Real:
    """Whether each place of the crank lies between two angles of it; that which is come to first does, the last not."""
    low, high = window
    first = low if linkage.driver.sense > 0 else high
    cycle = 2 * np.pi * linkage.turns
    gone = np.mod(linkage.driver.sense * (q - first) + SAME_PLACE, cycle) - SAME_PLACE
    inside: Real = gone < np.mod(high - low, cycle) - SAME_PLACE
    return inside


def table_argument(table: LoadTable, motion: Motion, strokes: Strokes | None) -> Real:
    """What a load is tabulated against: run of a link from where its working stroke starts, or the crank.

    A run is in m or rad, or a share of the working stroke.
    """
    driver = motion.linkage.driver
    if table.against == "crank angle":
        return _turned(motion.q, 2 * motion.linkage.turns * pi(motion.q))
    first = strokes.strokes[0] if strokes and strokes.strokes else None
    if table.against == "crank turn":
        start = first.start if first else motion.linkage.sketch.at
        cycle = strokes.cycle if strokes else 2 * np.pi * motion.linkage.turns
        return _turned(driver.sense * (motion.q - start), cycle)
    assert strokes is not None
    strokes = strokes.of_link(table.stroke_link)
    first = strokes.strokes[0]
    run: Real = output_place(motion, strokes.link) - first.low
    if strokes.kind == "swing":
        turns = np.round((run - first.run / 2) / (2 * np.pi))
        run = run - 2 * pi(run) * turns
    worked: Real = run / first.run if table.shares else run * np.sign(first.run)
    return worked


def reach_of_tables(linkage: Linkage, strokes: Strokes | None) -> Iterator[tuple[Load, Any, Any]]:
    """Each load tabulated against the stroke in lengths or angles, its last row and the stroke (m or rad).

    Both are arrays (variants, 1) where the linkage is one of many variants.
    """
    for load in () if strokes is None else linkage.loads:
        assert strokes is not None
        if load.table is not None and load.table.against == "stroke" and not load.table.shares:
            for stroke in strokes.of_link(load.table.stroke_link).strokes[:1]:
                yield load, load.table.arguments[-1], np.abs(stroke.run)


def ends_with_stroke(last: Any, stroke: Any) -> Any:
    """Whether the last row of a table is at the end of the stroke, neither before nor beyond it."""
    return (last >= (1 - BEFORE_END) * stroke) & (last <= (1 + BEYOND_END) * stroke)


def _turned(angle: Real, cycle: Real | float) -> Real:
    """An angle within its cycle. A table may jump from its end to its beginning: rounding does not take a place there
    to the other side."""
    seam = SEAM * (1 + np.abs(angle))
    return np.mod(angle + seam, cycle) - seam
