"""Places of the driver where loads jump or bend: sums over the way are exact between them."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np

from tmm_cli.analysis.mechanism import Mechanism
from tmm_cli.forces.given import motion_on_base, setting_off
from tmm_cli.groups.sequence import DriverMotion, towards
from tmm_cli.kinematics.driver_range import SCAN
from tmm_cli.kinematics.motion import Motion, move
from tmm_cli.kinematics.output import OutputCurve
from tmm_cli.linkage import Load, LoadTable
from tmm_cli.roots import roots
from tmm_cli.tolerances import SAME_PLACE
from tmm_cli.vectors import Real, dot


def jumps(mechanism: Mechanism) -> Iterable[float]:
    """Places of a crank that turns fully (rad), in any order and turn."""
    linkage = mechanism.linkage
    sense, cycle = linkage.driver.sense, 2 * np.pi * linkage.turns
    again = range(max(1, mechanism.driver_range.turns // linkage.turns))
    strokes = mechanism.strokes.strokes if mechanism.strokes else ()
    first = strokes[0].start if strokes else linkage.sketch.at
    for stroke in strokes:
        yield from (stroke.start, stroke.start + sense * stroke.length)
    for load in linkage.loads:
        if load.window is not None:
            yield from (place + cycle * k for place in load.window for k in again)
        if load.table is not None and load.table.against == "stroke":
            yield from _rows_of_strokes(mechanism, load.table)
        elif load.table is not None:
            by_angle = load.table.against == "crank angle"
            begin, way = (0.0, 1) if by_angle else (first, sense)
            yield from (begin + way * row + cycle * k for row in (*load.table.arguments, 0.0) for k in again)
        if load.resists:
            yield from _turns_back(mechanism, load)


def _rows_of_strokes(mechanism: Mechanism, table: LoadTable) -> Iterable[float]:
    """Where the output comes to the rows of a table against its stroke."""
    linkage, strokes = mechanism.linkage, mechanism.strokes
    if strokes is None or not strokes.strokes:
        return
    curve = OutputCurve(linkage, towards(mechanism.kernels, [linkage.output_carrier(strokes.link)]), strokes.link)
    first = strokes.strokes[0]
    for stroke in strokes.strokes:
        middle = stroke.low + stroke.run / 2
        for row in table.arguments:
            wanted = first.low + (first.run if table.shares else np.sign(first.run)) * row
            # at the ends themselves the output rests: rounding would put the row a little beside them
            if abs(wanted - middle) < abs(stroke.run) * (0.5 - SAME_PLACE):
                end = stroke.start + linkage.driver.sense * stroke.length
                yield float(roots(_missed(curve, wanted, middle), np.array([stroke.start]), np.array([end]))[0])


def _missed(curve: OutputCurve, wanted: float, middle: float) -> Callable[[Real], Real]:
    """How far the output is from a place; an angle is counted about the middle of its stroke."""

    def missed(q: Real) -> Real:
        place = curve.place(q)
        if curve.swings:
            place = middle + np.angle(np.exp(1j * (place - middle)))
        return place - wanted

    return missed


def _turns_back(mechanism: Mechanism, load: Load) -> Iterable[float]:
    """Where what a friction resists turns back."""
    linkage, whole = mechanism.linkage, mechanism.driver_range
    law = DriverMotion(whole.start, 1.0, 0.0, linkage.driver.sense)

    def moved(q: Real, order: int) -> Motion:
        return move(linkage, mechanism.kernels, q, law, order)

    q = np.linspace(whole.start, whole.end, SCAN * whole.turns + 1)
    half = (q[1] - q[0]) / 2  # a place of the scan may be the end itself: a little beyond it there is no doubt
    along, turning = setting_off(load, moved(q, 2))
    if load.force:
        back = np.flatnonzero(dot(along[1:], along[:-1]) < 0)
        before = along[back]
        yield from roots(
            lambda places: dot(motion_on_base(load, moved(places, 1))[0], before), q[back], q[back + 1] + half
        ).tolist()
    if load.moment:
        back = np.flatnonzero(turning[1:] * turning[:-1] < 0)
        yield from roots(lambda places: motion_on_base(load, moved(places, 1))[1], q[back], q[back + 1] + half).tolist()
