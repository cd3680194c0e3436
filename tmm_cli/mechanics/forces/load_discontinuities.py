"""Driver coordinates at which loads jump or have a kink. Integrals are computed piecewise between them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

import numpy as np

from tmm_cli.mechanics.forces.loads import motion_direction, motion_on_base
from tmm_cli.mechanics.groups import DriverMotion, solvers_towards
from tmm_cli.mechanics.kinematics import SCAN, Motion, OutputCurve, compute_motion
from tmm_cli.mechanics.linkage import Load, LoadTable
from tmm_cli.mechanics.numerics import SAME_DRIVER_POSITION, Real, dot, find_roots

if TYPE_CHECKING:
    from tmm_cli.mechanics.analysis import Mechanism


def find_load_jumps(mechanism: Mechanism) -> Iterable[float]:
    """Yield the angles (rad) of a fully rotating crank at which loads jump or have a kink.

    The angles are not in order, and they are not reduced to one revolution.
    """
    linkage = mechanism.linkage
    sense, cycle = linkage.driver.sense, 2 * np.pi * linkage.turns
    main = mechanism.strokes
    for strokes in () if main is None else (main, *main.others):
        for stroke in strokes.strokes:
            yield from (stroke.start, stroke.start + sense * stroke.length)
    for load in linkage.loads:
        if load.window is not None:
            yield from (place + cycle * k for place in load.window for k in _load_cycles(mechanism))
        if load.table is not None:
            yield from _coordinates_of_arguments(mechanism, load.table, (*load.table.arguments, 0.0))
        if load.resists:
            yield from _find_reversals(mechanism, load)


def find_table_jumps(mechanism: Mechanism) -> Iterable[float]:
    """Yield the driver coordinates (rad) at which load tables jump.

    They are not in order, and they are not reduced to one revolution.
    """
    for load in mechanism.linkage.loads:
        if load.table is not None and load.table.jumps:
            rows = [load.table.arguments[k] for k in load.table.jumps]
            yield from _coordinates_of_arguments(mechanism, load.table, rows)


def _load_cycles(mechanism: Mechanism) -> range:
    """Return range(n) for a loop over the n repetitions of the loads in one cycle of the motion."""
    return range(max(1, mechanism.driver_range.turns // mechanism.linkage.turns))


def _coordinates_of_arguments(mechanism: Mechanism, table: LoadTable, arguments: Iterable[float]) -> Iterable[float]:
    """Yield the driver coordinates (rad) that correspond to the given arguments of a load table."""
    if table.against == "stroke":
        yield from _coordinates_in_strokes(mechanism, table, arguments)
        return
    linkage = mechanism.linkage
    begin, sense, cycle = 0.0, 1, 2 * np.pi * linkage.turns
    if table.against == "crank turn":
        strokes = mechanism.strokes.strokes if mechanism.strokes else ()
        begin, sense = strokes[0].start if strokes else linkage.sketch.at, linkage.driver.sense
    yield from (begin + sense * argument + cycle * k for argument in arguments for k in _load_cycles(mechanism))


def _coordinates_in_strokes(mechanism: Mechanism, table: LoadTable, arguments: Iterable[float]) -> Iterable[float]:
    """Yield the driver coordinates (rad) inside strokes at which the output link reaches the given arguments of a
    load table.
    """
    linkage, strokes = mechanism.linkage, mechanism.strokes
    strokes = strokes and strokes.of_link(table.stroke_link)
    if strokes is None or not strokes.strokes:
        return
    curve = OutputCurve(
        linkage, solvers_towards(mechanism.kernels, [linkage.output_carrier(strokes.link)]), strokes.link
    )
    first = strokes.strokes[0]
    for stroke in strokes.strokes:
        middle = stroke.low + stroke.run / 2
        for row in arguments:
            target = first.low + (first.run if table.shares else np.sign(first.run)) * row
            # rows at the ends of a stroke are left out: the output rests there, and rounding would shift them
            if abs(target - middle) < abs(stroke.run) * (0.5 - SAME_DRIVER_POSITION):
                end = stroke.start + linkage.driver.sense * stroke.length
                yield float(
                    find_roots(_distance_from_run(curve, target, middle), np.array([stroke.start]), np.array([end]))[0]
                )


def _distance_from_run(curve: OutputCurve, target: float, middle: float) -> Callable[[Real], Real]:
    """Return a function of the driver coordinates q that computes the output coordinate minus `target`.

    If the output is an angle, it is reduced to the revolution centred on `middle`, the middle of the stroke.
    """

    def missed(q: Real) -> Real:
        place = curve.place(q)
        if curve.swings:
            place = middle + np.angle(np.exp(1j * (place - middle)))
        return place - target

    return missed


def _find_reversals(mechanism: Mechanism, load: Load) -> Iterable[float]:
    """Yield the driver coordinates (rad) at which the motion that a load resists changes its direction."""
    linkage, whole = mechanism.linkage, mechanism.driver_range
    law = DriverMotion(whole.start, 1.0, 0.0, linkage.driver.sense)

    def moved(q: Real, order: int) -> Motion:
        return compute_motion(linkage, mechanism.kernels, q, law, order)

    q = np.linspace(whole.start, whole.end, SCAN * whole.turns + 1)
    half = (q[1] - q[0]) / 2  # a sample may be the reversal itself, so the bracket extends a little beyond it
    along, turning = motion_direction(load, moved(q, 2))
    if load.force:
        back = np.flatnonzero(dot(along[1:], along[:-1]) < 0)
        before = along[back]
        yield from find_roots(
            lambda coordinates: dot(motion_on_base(load, moved(coordinates, 1))[0], before), q[back], q[back + 1] + half
        ).tolist()
    if load.moment:
        back = np.flatnonzero(turning[1:] * turning[:-1] < 0)
        yield from find_roots(
            lambda coordinates: motion_on_base(load, moved(coordinates, 1))[1], q[back], q[back + 1] + half
        ).tolist()
