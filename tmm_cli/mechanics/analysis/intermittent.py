"""Intermittent motion: a wheel that a link drives while the link moves in one sense, and that rests otherwise.

A ratchet, a one-way clutch, or a pin in the slots of a disk couples the wheel to the link. The detent that
holds the wheel at rest is not modelled.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import groupby
from operator import attrgetter
from typing import Literal

import numpy as np

from tmm_cli.mechanics.analysis.mechanism import Inputs, Mechanism
from tmm_cli.mechanics.assembly import analyse_mobile_structure
from tmm_cli.mechanics.errors import LinkageError, MissingStrokesError, NoCycleError, SettingError
from tmm_cli.mechanics.groups import DriverMotion, GroupSolver, LawOfMotion, solvers_towards
from tmm_cli.mechanics.kinematics import (
    SCAN,
    DriverRange,
    LinkMotion,
    OutputCurve,
    Strokes,
    compute_motion,
    find_strokes,
    measure_runs,
)
from tmm_cli.mechanics.linkage import Linkage
from tmm_cli.mechanics.numerics import SAME_DRIVER_POSITION, SHOCKLESS, WHOLE_TURNS, Real, find_minima, find_roots

DrivenWhen = Literal["forward", "backward", "working stroke", "idle stroke"]


@dataclass(frozen=True)
class WheelSetting:
    """Adjustment of the mechanism that applies in some cycles, such as a changed crank length.

    Attributes:
        values: changed parameters, as written in the file.
        linkage: linkage with these parameters; None for that of the file.
    """

    values: Mapping[str, str] = field(default_factory=dict)
    linkage: Linkage | None = None


@dataclass(frozen=True)
class WheelTask:
    """Wheel (or shaft, or disk) that a coaxial link drives intermittently.

    Attributes:
        name: name of the wheel.
        link: driving link, which rotates about the same pivot on the frame.
        when: when the link drives the wheel: while it rotates forward (counterclockwise) or backward, or in the working
            or return strokes of the output link.
        settings: settings of the mechanism. The first one applies in the first cycle of the driver, the second one in
            the second, and so on; after the last one the first one applies again.
    """

    name: str
    link: str
    when: DrivenWhen
    settings: tuple[WheelSetting, ...] = (WheelSetting(),)


# Parts of a cycle in which the link drives the wheel, and parts in which the wheel rests.


MOTION_SAMPLES = 181  # positions computed in each part in which the wheel is driven
MOST_CYCLES = 1000  # largest number of cycles searched for a whole number of revolutions of the wheel


@dataclass(frozen=True)
class OneWayMotion:
    """Part of a cycle in which the driving link of a wheel does not reverse.

    Attributes:
        start: driver coordinate at the beginning, rad or m.
        way: distance covered by the driver, rad or m.
        sense: sense of motion of the driver, +1 or -1.
        driven: True if the link drives the wheel in this part.
    """

    start: float
    way: float
    sense: int
    driven: bool

    @property
    def end(self) -> float:
        return self.start + self.sense * self.way


@dataclass(frozen=True)
class WheelMotion:
    """Motion of the wheel in one part of the cycle.

    Attributes:
        ride: the part of the cycle.
        setting: index of the setting.
        time: duration, s; nan if the speed of the driver is not constant.
        ways: distance covered by the driver since the beginning of the cycle, rad or m.
        angles, omegas, epsilons: rotation (rad), angular velocity (rad/s) and acceleration (rad/s2) of the
            wheel at these distances.
        omega, epsilon: largest magnitudes of the two over the whole part.
    """

    ride: OneWayMotion
    setting: int
    time: float
    ways: Real
    angles: Real
    omegas: Real
    epsilons: Real
    omega: float = 0.0
    epsilon: float = 0.0

    @property
    def step(self) -> float:
        return float(self.angles[-1] - self.angles[0])


@dataclass(frozen=True)
class IntermittentMotion:
    """Motion of an intermittently driven wheel while each of its settings applies for one cycle of the driver.

    Attributes:
        task: the wheel, its driving link and its settings.
        parts: parts of these cycles, one after another. In each of them the link drives the wheel, or the wheel rests.
    """

    task: WheelTask
    parts: tuple[WheelMotion, ...]

    @property
    def driven(self) -> tuple[WheelMotion, ...]:
        return tuple(motion for motion in self.parts if motion.ride.driven)

    @property
    def turn(self) -> float:
        """Total rotation of the wheel in the cycles of all settings, rad."""
        return sum(motion.step for motion in self.parts)

    def of_setting(self, number: int) -> float:
        """Return the rotation of the wheel (rad) in the cycle in which one of the settings applies."""
        return sum(motion.step for motion in self.parts if motion.setting == number)

    @property
    def way(self) -> float:
        """Total distance covered by the driver in the cycles of all settings, rad; for a sliding driver m, forward and
        back.
        """
        return sum(motion.ride.way for motion in self.parts)

    @property
    def standing(self) -> float:
        """Fraction of the driver travel during which the wheel rests."""
        return sum(motion.ride.way for motion in self.parts if not motion.ride.driven) / self.way

    def time(self, *, driven: bool) -> float:
        """Return the total time (s) during which the wheel is driven, or during which it rests."""
        return sum(motion.time for motion in self.parts if motion.ride.driven == driven)

    @cached_property
    def cycles(self) -> int | None:
        """Number of passes through all settings after which the wheel has made a whole number of revolutions.

        None if the wheel does not rotate, or if the number exceeds MOST_CYCLES.
        """
        turns = np.arange(1, MOST_CYCLES + 1) * self.turn / (2 * np.pi)
        whole = np.abs(turns - np.round(turns)) < WHOLE_TURNS
        return int(np.argmax(whole)) + 1 if self.turn and bool(np.any(whole)) else None

    @property
    def omega(self) -> float:
        """Largest angular velocity of the wheel, rad/s."""
        return float(np.max([motion.omega for motion in self.driven], initial=0.0))

    @property
    def epsilon(self) -> float:
        """Largest angular acceleration while the wheel is driven, rad/s2."""
        return float(np.max([motion.epsilon for motion in self.driven], initial=0.0))

    @cached_property
    def jumps(self) -> tuple[float, ...]:
        """Jump of the wheel's angular velocity at the beginning of each part, rad/s.

        The part before the first one is the last one.
        """
        before = (self.parts[-1], *self.parts[:-1])
        jumps = [float(motion.omegas[0] - last.omegas[-1]) for last, motion in zip(before, self.parts, strict=True)]
        return tuple(0.0 if abs(jump) <= SHOCKLESS * self.omega else jump for jump in jumps)

    @property
    def shock(self) -> float:
        """Largest jump of the wheel's angular velocity, rad/s; zero if it never jumps."""
        return float(np.max(np.abs(self.jumps)))


def one_way_motions_of_rotation(task: WheelTask, strokes: Strokes, sense: int, start: float) -> list[OneWayMotion]:
    """Divide the cycle of a fully rotating driver into parts in which the driving link of a wheel does not reverse.

    The first part is the first to begin at or after the driver coordinate `start`.

    Args:
        task: the wheel.
        strokes: strokes of the link that drives the wheel, or of the output link if `task.when` refers to its strokes.
        sense: sense of rotation of the driver, +1 or -1.
        start: driver coordinate of position 0, rad.
    """
    if task.when in ("forward", "backward"):
        chosen = [s.run > 0 if task.when == "forward" else s.run < 0 for s in strokes.strokes]
    else:
        chosen = [s.working == (task.when == "working stroke") for s in strokes.strokes]
    motions = []
    for stroke, driven in zip(strokes.strokes, chosen, strict=True):
        distance = (
            float(np.mod(sense * (stroke.start - start) + SAME_DRIVER_POSITION, strokes.cycle)) - SAME_DRIVER_POSITION
        )
        first = start + sense * distance
        motions.append(OneWayMotion(first, stroke.length, sense, driven))
        if stroke.rest:
            motions.append(OneWayMotion(first + sense * stroke.length, stroke.rest, sense, driven=False))
    return _join_rests(sorted(motions, key=lambda ride: sense * ride.start))


def one_way_motions_of_stroke(
    linkage: Linkage, kernels: Sequence[GroupSolver], task: WheelTask, driver_range: DriverRange
) -> list[OneWayMotion]:
    """Divide the stroke of a driver, forward and back, into parts in which the driving link of a wheel does not
    reverse.
    """
    sense, curve = linkage.driver.sense, OutputCurve(linkage, solvers_towards(kernels, [task.link]), task.link)
    q = np.linspace(driver_range.start, driver_range.end, SCAN + 1)
    slope = curve.slope(q)
    moves = np.flatnonzero(slope)
    back = slope[moves[:-1]] * slope[moves[1:]] < 0
    low, high = moves[:-1][back], moves[1:][back]
    turns = find_roots(curve.slope, q[low], q[high]) if low.size else q[:0]
    inside = (turns - q[0] > SAME_DRIVER_POSITION) & (q[-1] - turns > SAME_DRIVER_POSITION)
    ends = np.concatenate([q[:1], turns[inside], q[-1:]])[::sense]
    driving_sense = 1 if task.when == "forward" else -1
    motions = []
    for direction, reversals in ((sense, ends), (-sense, ends[::-1])):
        __, runs = measure_runs(curve, reversals[:-1], np.diff(reversals))
        lengths = np.abs(np.diff(reversals))
        motions += [
            OneWayMotion(float(first), float(length), direction, bool(run * driving_sense > 0))
            for first, length, run in zip(reversals, lengths, runs, strict=False)
        ]
    return _join_rests(motions)


def wheel_motions(
    linkage: Linkage,
    kernels: Sequence[GroupSolver],
    link: str,
    rides: Sequence[OneWayMotion],
    law: LawOfMotion,
    setting: int,
    before: Sequence[WheelMotion],
) -> list[WheelMotion]:
    """Compute the motion of the wheel during one-way motions with one setting.

    A driver that moves back and forth has the same speed at a coordinate in both directions.

    Args:
        linkage: linkage of the setting.
        kernels: its group solvers.
        link: the link that drives the wheel.
        rides: the one-way motions.
        law: law of motion of the driver.
        setting: index of the setting.
        before: motion of the wheel with the settings before this one; distances and angles are counted on from
            it.
    """
    travel, angle = (float(before[-1].ways[-1]), float(before[-1].angles[-1])) if before else (0.0, 0.0)
    rate = law.rate if isinstance(law, DriverMotion) and law.acceleration == 0 else float("nan")
    upto, sense = solvers_towards(kernels, [link]), linkage.driver.sense

    def turning(q: Real) -> LinkMotion:
        return compute_motion(linkage, upto, q, law).link(link)

    motions = []
    for ride in rides:
        distances = np.linspace(0, ride.way, MOTION_SAMPLES if ride.driven else 2)
        coordinates, back = ride.start + ride.sense * distances, ride.sense * sense
        angles = omegas = epsilons = np.zeros(len(distances))
        omega = epsilon = 0.0
        if ride.driven:
            rotation = turning(coordinates)
            angles, omegas, epsilons = np.unwrap(rotation.angle), back * rotation.omega, rotation.epsilon
            omega = _largest_value(lambda q: np.abs(turning(q).omega), coordinates)
            epsilon = _largest_value(lambda q: np.abs(turning(q).epsilon), coordinates)
        time = ride.way / rate if rate else float("nan")
        angles = angle + (angles - angles[0])
        motions.append(WheelMotion(ride, setting, time, travel + distances, angles, omegas, epsilons, omega, epsilon))
        travel, angle = travel + ride.way, float(angles[-1])
    return motions


def _join_rests(rides: Sequence[OneWayMotion]) -> list[OneWayMotion]:
    """Join consecutive one-way motions in which the driver keeps its direction.

    They are joined only if the wheel is driven in all of them, or rests in all of them.
    """
    joined: list[OneWayMotion] = []
    for (driven, sense), group in groupby(rides, attrgetter("driven", "sense")):
        first, *others = group
        joined.append(OneWayMotion(first.start, first.way + sum(ride.way for ride in others), sense, driven))
    return joined


def _largest_value(magnitude: Callable[[Real], Real], coordinates: Real) -> float:
    """Return the largest value of a function over closely spaced driver coordinates, refined between them."""
    values = magnitude(coordinates)
    if not bool(np.all(np.isfinite(values))):
        return float("nan")
    best = int(np.argmax(values))
    low, high = sorted((coordinates[max(best - 1, 0)], coordinates[min(best + 1, len(coordinates) - 1)]))
    return max(float(values[best]), -float(find_minima(lambda q: -magnitude(q), low, high)[1]))


# Intermittent motion: each wheel over the cycles of all its settings.


LawOf = Callable[[Linkage], LawOfMotion]  # law of motion of the driver of a linkage


def compute_intermittent(mechanism: Mechanism, start: float, law_of: LawOf) -> tuple[IntermittentMotion, ...]:
    """Compute the motion of all wheels of the file, beginning at the driver coordinate `start`.

    Args:
        mechanism: the mechanism with its wheels.
        start: driver coordinate of position 0, rad or m.
        law_of: function that returns the law of motion of the driver for a linkage.

    Raises:
        NoCycleError: the driver has no cycle.
        MissingStrokesError: the link or the output has no strokes.
        SettingError: with one of the settings the linkage cannot be assembled or moved.
    """
    return tuple(_wheel_cycle(mechanism, task, start, law_of) for task in mechanism.inputs.wheels)


def _wheel_cycle(mechanism: Mechanism, task: WheelTask, start: float, law_of: LawOf) -> IntermittentMotion:
    parts: list[WheelMotion] = []
    for number, setting in enumerate(task.settings):
        variant, linkage = mechanism, setting.linkage
        try:
            if linkage is not None:
                variant = Mechanism(Inputs(linkage), analyse_mobile_structure(linkage))
            rides = _one_way_motions(variant, task, start)
            parts += wheel_motions(
                variant.linkage, variant.kernels, task.link, rides, law_of(variant.linkage), number, parts
            )
        except LinkageError as error:
            if linkage is None:
                raise
            raise SettingError(("intermittent", task.name, "settings", number), error) from None
    return IntermittentMotion(task, tuple(parts))


def _one_way_motions(mechanism: Mechanism, task: WheelTask, start: float) -> list[OneWayMotion]:
    linkage, driver_range, block = mechanism.linkage, mechanism.driver_range, ("intermittent", task.name)
    by_link = task.when in ("forward", "backward")
    if driver_range.full and driver_range.repeats:
        strokes = mechanism.strokes
        if by_link:
            strokes = find_strokes(linkage, mechanism.kernels, driver_range, link=task.link)
        if strokes is None or not strokes.strokes:
            raise MissingStrokesError(task.link, (*block, "moves_with" if by_link else "when"))
        return one_way_motions_of_rotation(task, strokes, linkage.driver.sense, start)
    if driver_range.full or not driver_range.inclusive or linkage.others:
        raise NoCycleError(block)
    if not by_link:
        raise MissingStrokesError(task.link, (*block, "when"))
    return one_way_motions_of_stroke(linkage, mechanism.kernels, task, driver_range)
