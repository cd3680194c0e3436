"""Loads on the links: weights, inertia forces, load elements, and loads defined in the problem file."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from tmm_cli.mechanics.kinematics import ForwardMotion, Motion, Strokes, output_coordinate, zero_at_rest
from tmm_cli.mechanics.linkage import FRAME, Linkage, Load, LoadTable
from tmm_cli.mechanics.numerics import SAME_DRIVER_POSITION, SEAM, Real, Vector, cross, pi


@dataclass(frozen=True)
class AppliedLoad:
    """Load on a link: a force and a couple at every position.

    Attributes:
        name: name of the force.
        kind: origin of the load; "load" is one defined in the problem file, or of a load element.
        link: the loaded link.
        at: point of application in the axes of the link, m.
        force: force, N, shape (positions,).
        moment: couple, N m, shape (positions,).
        couple_name: name of the couple, if it differs from `name`.
        ambiguous: True if the name is also the symbol of another quantity (M3 is the inertia couple of link 3);
            formulas then show the name as a subscript.
        dissipates: True for a load of an element that takes energy and stores none.
    """

    name: str
    kind: Literal["weight", "inertia", "load", "friction"]
    link: str
    at: complex
    force: Vector
    moment: Real
    couple_name: str = ""
    ambiguous: bool = False
    dissipates: bool = False

    @property
    def has_force(self) -> bool:
        """True if the force differs from zero at some position; nan does not count."""
        return bool(np.any(np.abs(self.force) > 0))

    @property
    def has_moment(self) -> bool:
        return bool(np.any(np.abs(self.moment) > 0))


# Load elements.


def element_loads(motion: Motion, strokes: Strokes | None) -> Iterable[AppliedLoad]:
    """Yield the loads that springs and other load elements exert on the moving links that they join."""
    moving = motion.linkage.moving
    for element in motion.linkage.elements:
        for link, at, force, moment in element.wrenches(motion):
            if link in moving:
                name = element.name if link == element.j or element.j not in moving else f"{element.name}'"
                yield AppliedLoad(name, "load", link, at, force, moment, name, dissipates=element.dissipates)


# Loads of the problem file: their tables, the range in which they act, and loads that resist a motion.


BEFORE_END = 1e-3  # of the stroke: a table that ends earlier by less than this counts as complete (rounding)
BEYOND_END = 0.02  # of the stroke: tolerance for a table that ends later


def problem_loads(motion: Motion, strokes: Strokes | None) -> Iterable[AppliedLoad]:
    """Yield the loads defined in the problem file.

    If the load acts between two moving links, its reaction on the second link follows, equal and opposite.
    Loads restricted to working strokes act at all positions if the mechanism has no strokes.
    """
    for load in motion.linkage.loads:
        factor = _load_factor(load, motion, strokes)
        along: Vector | float = motion.poses[load.link].z if load.follows else 1.0
        turning: Real | float = 1.0
        if load.resists:
            velocity, rotation_sense = motion_direction(load, motion)
            along, turning = -velocity, -rotation_sense
        force, moment = load.force * factor * along, load.moment * factor * turning
        yield AppliedLoad(load.name, "load", load.link, load.at, force, moment, load.name)
        if load.base != FRAME:
            yield _opposite_load(load, motion, force, moment)


def _load_factor(load: Load, motion: Motion, strokes: Strokes | None) -> Real:
    """Compute the factor by which the force and the moment of a load are multiplied at every position.

    It is the value of the load's table, or 1 without a table, and zero at positions where the load does not act.
    """
    factor = np.ones(np.shape(motion.q))
    if load.table is not None:
        factor = load.table(table_argument(load.table, motion, strokes))
    return (
        factor
        if always_acts(load, strokes)
        else np.where(is_acting(load, motion.q, motion.linkage, strokes), factor, 0.0)
    )


def is_acting(load: Load, q: Real, linkage: Linkage, strokes: Strokes | None) -> Real:
    """Return True at the driver coordinates q at which a load acts.

    A load restricted to working strokes acts everywhere if the mechanism has no strokes.
    """
    if load.window is not None:
        return in_window(load.window, q, linkage)
    if always_acts(load, strokes):
        return np.ones(np.shape(q), dtype=bool)
    assert strokes is not None
    return strokes.of_link(load.stroke_link).share(q, linkage.driver.sense)


def always_acts(load: Load, strokes: Strokes | None) -> bool:
    """Return True if a load acts at all positions.

    That is, it is not restricted to a range of crank angles, nor to working strokes of a mechanism that has
    strokes.
    """
    if load.window is not None:
        return False
    return not load.working_stroke_only or strokes is None or not strokes.of_link(load.stroke_link).strokes


def _opposite_load(load: Load, motion: Motion, force: Vector, moment: Real) -> AppliedLoad:
    """Return the equal and opposite load on the other link, at a shared point or along the same line of action."""
    name, points = f"{load.name}'", motion.linkage.links[load.base].points
    if load.point in points:
        return AppliedLoad(name, "load", load.base, points[load.point], -force, -moment, name)
    arm = motion.poses[load.link].at(load.at) - motion.poses[load.base].x
    return AppliedLoad(name, "load", load.base, 0j, -force, -moment - cross(arm, force), name)


def motion_direction(load: Load, motion: Motion) -> tuple[Vector, Real]:
    """Compute the direction of the motion that a load resists.

    Where the motion begins from rest, it is the direction in which the motion starts.

    Returns:
        Unit vector of the velocity of the load's point, and sense of rotation of its link (+1 or -1), both relative to
        the load's base link. Each is zero if the point or the link stays at rest.
    """
    forward = motion.forward()
    largest = forward.largest
    velocity, spin = motion_on_base(load, motion, forward)
    velocity, spin = zero_at_rest(velocity, largest.speed), zero_at_rest(spin, largest.speed / largest.size)
    if motion.order > 1:
        rates, accels = forward.rates, forward.accels
        pose, other = motion.poses[load.link], accels[load.base]
        arm, far = load.at * pose.z, pose.at(load.at) - motion.poses[load.base].x
        second = accels[load.link]
        gain = second.at(arm, rates[load.link].w) - other.at(far, rates[load.base].w)
        velocity = np.where(velocity == 0, zero_at_rest(gain, largest.acceleration), velocity)
        spin = np.where(spin == 0, zero_at_rest(second.e - other.e, largest.acceleration / largest.size), spin)
    length = np.abs(velocity)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(length > 0, velocity / length, 0j), np.sign(spin)


def motion_on_base(load: Load, motion: Motion, forward: ForwardMotion | None = None) -> tuple[Vector, Real]:
    """Compute the direction in which a load's point moves and the sense in which its link rotates.

    Both are relative to the load's base link. They are returned as a velocity and an angular velocity, but only their
    direction and sign are meaningful: depending on how the motion was solved, they are derivatives with respect to
    time, or to the driver coordinate counted in the direction of motion.

    Args:
        load: the load.
        motion: poses of the links.
        forward: derivatives of the poses; default: those of `motion`.
    """
    forward = motion.forward() if forward is None else forward
    pose, rate, base = motion.poses[load.link], forward.rates[load.link], forward.rates[load.base]
    far = pose.at(load.at) - motion.poses[load.base].x
    return forward.sense * (rate.at(load.at * pose.z) - base.at(far)), forward.sense * (rate.w - base.w)


def in_window(window: tuple[float, float], q: Real, linkage: Linkage) -> Real:
    """Return True for driver coordinates q inside a window, an interval between two crank angles.

    The angle that the crank reaches first belongs to the window, the other does not.
    """
    low, high = window
    first = low if linkage.driver.sense > 0 else high
    cycle = 2 * np.pi * linkage.turns
    travel = np.mod(linkage.driver.sense * (q - first) + SAME_DRIVER_POSITION, cycle) - SAME_DRIVER_POSITION
    inside: Real = travel < np.mod(high - low, cycle) - SAME_DRIVER_POSITION
    return inside


def table_argument(table: LoadTable, motion: Motion, strokes: Strokes | None) -> Real:
    """Compute the argument of a load table at every position.

    It is a crank angle (rad), or the travel of the output link in its working stroke, in m or rad or as a
    fraction of the stroke.
    """
    driver = motion.linkage.driver
    if table.against == "crank angle":
        return _angle_in_cycle(motion.q, 2 * motion.linkage.turns * pi(motion.q))
    first = strokes.strokes[0] if strokes and strokes.strokes else None
    if table.against == "crank turn":
        start = first.start if first else motion.linkage.sketch.at
        cycle = strokes.cycle if strokes else 2 * np.pi * motion.linkage.turns
        return _angle_in_cycle(driver.sense * (motion.q - start), cycle)
    assert strokes is not None
    strokes = strokes.of_link(table.stroke_link)
    first = strokes.strokes[0]
    run: Real = output_coordinate(motion, strokes.link) - first.low
    if strokes.kind == "swing":
        turns = np.round((run - first.run / 2) / (2 * np.pi))
        run = run - 2 * pi(run) * turns
    worked: Real = run / first.run if table.shares else run * np.sign(first.run)
    return worked


def table_lengths(linkage: Linkage, strokes: Strokes | None) -> Iterator[tuple[Load, Any, Any]]:
    """Yield the loads that are tabulated against a stroke in m or rad.

    Yields:
        The load, the last argument of its table, and the stroke. The last two are arrays of shape (variants, 1) if the
        linkage represents many variants.
    """
    for load in () if strokes is None else linkage.loads:
        assert strokes is not None
        if load.table is not None and load.table.against == "stroke" and not load.table.shares:
            for stroke in strokes.of_link(load.table.stroke_link).strokes[:1]:
                yield load, load.table.arguments[-1], np.abs(stroke.run)


def ends_with_stroke(last: Any, stroke: Any) -> Any:
    """Return True where the last argument of a load table agrees with the end of the stroke, within the tolerances."""
    return (last >= (1 - BEFORE_END) * stroke) & (last <= (1 + BEYOND_END) * stroke)


def _angle_in_cycle(angle: Real, cycle: Real | float) -> Real:
    """Reduce an angle to the range of one cycle.

    A table may jump from its end to its beginning, and rounding must not decide which value applies. An angle just
    below the end of the range, within rounding, therefore becomes zero.
    """
    seam = SEAM * (1 + np.abs(angle))
    return np.mod(angle + seam, cycle) - seam


# All loads on the links: weights, inertia, load elements, loads of the problem file.


BALANCING = ("Mb", "M_b", "Fb", "F_b")  # symbols of the balancing moment and force


def collect_loads(motion: Motion, strokes: Strokes | None) -> tuple[AppliedLoad, ...]:
    """Return all loads on the moving links except friction, in the order of the links."""
    order = {name: k for k, name in enumerate(motion.linkage.links)}
    collected = [load for kind in LOAD_SOURCES for load in kind(motion, strokes)]
    symbols = {
        *BALANCING,
        *(name for load in collected if load.kind != "load" for name in (load.name, load.couple_name)),
    }
    collected = [
        replace(a, ambiguous=True) if a.kind == "load" and a.name.rstrip("'") in symbols else a for a in collected
    ]
    return tuple(sorted(collected, key=lambda a: order[a.link]))


def weights_and_inertia(motion: Motion, strokes: Strokes | None) -> Iterable[AppliedLoad]:
    """Yield the weight, the inertia force and the inertia couple of each link, at its centre of mass.

    Links without mass have none.
    """
    still = np.zeros(np.shape(motion.q))
    for name in motion.linkage.moving:
        link = motion.linkage.links[name]
        if np.any(link.mass != 0):
            weight = link.mass * motion.linkage.gravity + still
            yield AppliedLoad(f"G{name}", "weight", name, link.centre, weight, still)
        if np.any(link.mass != 0) or np.any(link.inertia != 0):
            inertia = -link.mass * motion.centre(name).a
            moment = -link.inertia * motion.link(name).epsilon
            yield AppliedLoad(f"U{name}", "inertia", name, link.centre, inertia, moment, f"M{name}")


LOAD_SOURCES = (
    weights_and_inertia,
    problem_loads,
    element_loads,
)  # each returns loads for a motion and its strokes
