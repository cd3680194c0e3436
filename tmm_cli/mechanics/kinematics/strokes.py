"""Output of the mechanism: its displacement, transfer functions and strokes; driver coordinates of the positions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Protocol

import numpy as np

from tmm_cli.mechanics.groups import GroupSolver, LinkStates, link_states, solvers_towards
from tmm_cli.mechanics.kinematics.driver_range import SCAN, DriverRange
from tmm_cli.mechanics.kinematics.motion import LargestRates, Motion, zero_at_rest
from tmm_cli.mechanics.linkage import FRAME, Linkage, Load, Request
from tmm_cli.mechanics.numerics import (
    AT_EDGE_OF_CAM,
    BESIDE_END,
    NO_DWELL,
    NO_JUMP,
    RESTS,
    SAME_DRIVER_POSITION,
    SEAM,
    Real,
    Vector,
    find_roots,
)
from tmm_cli.mechanics.structure import output_link

PARTS = 64  # of a stroke, over which an angle is accumulated


def output_run(motion: Motion, link: str) -> tuple[Real, Real, Real]:
    """Return the displacement (m) or angle (rad) of the output, and its first and second derivatives.

    The derivatives are taken with respect to the driver coordinate (transfer functions).
    """
    slide = motion.linkage.output_guide(link)
    if slide is not None:
        sliding = motion.slide(slide)
        return sliding.run, sliding.first, sliding.second
    point = motion.linkage.output_point(link)
    if point is not None:
        moving = motion.named(point)
        return _coordinate(link, moving.x), _coordinate(link, moving.first), _coordinate(link, moving.second)
    turning = motion.link(link)
    return turning.angle, turning.first, turning.second


def output_coordinate(motion: LinkStates, link: str) -> Real:
    """Return the displacement (m) or angle (rad) of the output."""
    point = motion.linkage.output_point(link)
    if point is not None:
        return _coordinate(link, motion.spot(point))
    slide = motion.linkage.output_guide(link)
    return motion.angle(link) if slide is None else motion.run(slide)


def output_slope(motion: LinkStates, link: str) -> Real:
    """Return the derivative of the output displacement or angle with respect to the driver coordinate."""
    linkage = motion.linkage
    point = linkage.output_point(link)
    if point is not None:
        owner = linkage.owner(point)
        return _coordinate(link, motion.first[owner].at(linkage.local(owner, point) * motion.poses[owner].z))
    slide = linkage.output_guide(link)
    return motion.first[link].w if slide is None else motion.slope(slide)


def moving_slope(motion: LinkStates, link: str) -> Real:
    """Return the derivative of the output as `output_slope` does, but zero for variants whose output never moves.

    For an output at rest, the computed velocity and its sign are only rounding errors.
    """
    slope, rates = output_slope(motion, link), LargestRates.of(motion)
    largest = rates.speed / rates.size if motion.linkage.output_swings(link) else rates.speed
    moves = np.any(zero_at_rest(slope, largest), axis=-1, keepdims=True)
    return np.where(moves, slope, 0.0)


def _coordinate(output: str, vector: Vector) -> Real:
    """Return the x or the y component of a vector, as the name of the output says: x for K.x, y for K.y."""
    return vector.real if output.endswith(".x") else vector.imag


class StrokeCurve(Protocol):
    """Interface of an output as a function of the driver coordinate, as the search of strokes needs it; see
    OutputCurve.
    """

    @property
    def link(self) -> str: ...
    @property
    def swings(self) -> bool: ...
    @property
    def kind(self) -> str: ...
    def place(self, q: Real) -> Real: ...


@dataclass(frozen=True)
class OutputCurve:
    """An output as a function of the driver coordinate.

    Attributes:
        linkage: the linkage.
        kernels: solvers of the groups on which the output depends.
        link: name of the output: a link, or a coordinate of a point (K.x).
    """

    linkage: Linkage
    kernels: tuple[GroupSolver, ...]
    link: str

    @property
    def swings(self) -> bool:
        """True if the output rotates, False if it slides."""
        return self.linkage.output_swings(self.link)

    @property
    def kind(self) -> str:
        return "swing" if self.swings else "slide"

    def place(self, q: Real) -> Real:
        """Return the displacement (m) or the angle (rad, in -pi..pi) of the output."""
        return output_coordinate(link_states(self.linkage, self.kernels, q, 0), self.link)

    def slope(self, q: Real) -> Real:
        """Return the derivative of the output with respect to the driver coordinate."""
        return output_slope(link_states(self.linkage, self.kernels, q, 1), self.link)

    def moving_slope(self, q: Real) -> Real:
        """Return the derivative of the output; zero at all positions of a variant whose output stays at rest."""
        return moving_slope(link_states(self.linkage, self.kernels, q, 1), self.link)


def measure_runs(curve: StrokeCurve, starts: Real, lengths: Real) -> tuple[Real, Real]:
    """Measure how far an output moves in intervals of the driver coordinate.

    Angles are accumulated, so that they may pass 180 degrees.

    Args:
        curve: the output.
        starts: driver coordinates at which the intervals start, shape (..., intervals).
        lengths: lengths of the intervals with their sign, same shape.

    Returns:
        Coordinate of the output (m or rad) at the start of each interval, and its change over the interval.
    """
    shares = np.linspace(0, 1, PARTS + 1 if curve.swings else 2)
    samples = starts[..., None] + lengths[..., None] * shares
    run = curve.place(samples.reshape(*starts.shape[:-1], -1)).reshape(samples.shape)
    run = np.unwrap(run, axis=-1) if curve.swings else run
    return run[..., 0], run[..., -1] - run[..., 0]


@dataclass(frozen=True)
class OutputTravel:
    """Extreme positions of an output between two requested driver coordinates.

    Attributes:
        link: name of the output.
        kind: "slide" (m) or "swing" (rad).
        low, high: smallest and largest coordinate of the output.
        low_at, high_at: driver coordinates at which they occur.
    """

    link: str
    kind: str
    low: float
    high: float
    low_at: float
    high_at: float


def find_travel(linkage: Linkage, kernels: tuple[GroupSolver, ...], requested: Real, link: str) -> OutputTravel | None:
    """Find the extreme positions of an output, for a driver that cannot make full turns.

    requested: requested driver coordinates; the whole interval between them is examined.
    """
    curve = OutputCurve(linkage, solvers_towards(kernels, [linkage.output_carrier(link)]), link)
    q = np.linspace(np.min(requested), np.max(requested), SCAN + 1)
    moved = link_states(linkage, kernels, q, 1)  # all groups: the output moves only where the whole linkage can
    run, slope = output_coordinate(moved, link), output_slope(moved, link)
    before, after = moved.placed[:-1], moved.placed[1:]
    turning = (before & after & (slope[:-1] * slope[1:] < 0))[before]  # not across a gap in the range of the driver
    q, run = q[moved.placed], run[moved.placed]
    if len(q) < 2:
        return None
    run = np.unwrap(run) if curve.swings else run
    change = np.flatnonzero(turning)
    if change.size:
        ends = find_roots(curve.slope, q[change], q[change + 1])
        end_runs = curve.place(ends)
        if curve.swings:
            end_runs = end_runs + 2 * np.pi * np.round((run[change] - end_runs) / (2 * np.pi))
        q, run = np.concatenate([q, ends]), np.concatenate([run, end_runs])
    low, high = int(np.argmin(run)), int(np.argmax(run))
    return OutputTravel(link, curve.kind, float(run[low]), float(run[high]), float(q[low]), float(q[high]))


# Strokes of the output, and which of them is the working one.


@dataclass(frozen=True)
class Stroke:
    """One stroke of the output.

    Attributes:
        start: driver coordinate at which the stroke starts.
        length: travel of the driver during the stroke, in its sense of motion.
        low: coordinate of the output at the start (m or rad).
        run: displacement of the output, with its sign (m or rad).
        working: True for a working stroke, False for a return stroke.
        rest: travel of the driver while the output dwells after the stroke, e.g. a follower on the circular part of its
            cam; 0 without a dwell.
    """

    start: float
    length: float
    low: float
    run: float
    working: bool
    rest: float = 0.0


@dataclass(frozen=True)
class Strokes:
    """Strokes of an output in one cycle of the driver.

    Attributes:
        link: name of a link, or coordinate of a point (K.x).
        kind: "slide" (m) or "swing" (rad).
        strokes: the strokes, beginning with a working one; empty if the output has none.
        rule: rule by which the working stroke was chosen.
        cycle: travel of the driver after which the strokes repeat (rad).
        others: strokes of further links, on which loads depend.
    """

    link: str
    kind: str
    strokes: tuple[Stroke, ...]
    rule: str
    cycle: float = 2 * np.pi
    others: tuple[Strokes, ...] = ()

    def of_link(self, link: str) -> Strokes:
        """Return the strokes of a link on which loads depend; those of the main output if `link` is empty."""
        if link in ("", self.link):
            return self
        return next((other for other in self.others if other.link == link), Strokes(link, self.kind, (), ""))

    def changed(self, change: Callable[[Stroke], Stroke]) -> Strokes:
        """Return a copy in which the function `change` is applied to every stroke, also to those of the links in
        `others`.
        """
        strokes, others = map(change, self.strokes), (other.changed(change) for other in self.others)
        return replace(self, strokes=tuple(strokes), others=tuple(others))

    @property
    def working(self) -> tuple[Stroke, ...]:
        return tuple(s for s in self.strokes if s.working)

    @property
    def travel(self) -> float:
        """Stroke H (m) or swing angle ψ (rad) of the output."""
        return max((abs(s.run) for s in self.strokes), key=np.max, default=0.0)

    @property
    def k(self) -> float:
        """Time ratio k of working to return strokes at constant driver speed, dwells not counted; nan if undefined."""
        idle = sum(s.length for s in self.strokes if not s.working)
        return sum(s.length for s in self.working) / idle if idle else float("nan")

    def share(self, q: Real, sense: int) -> Real:
        """Return True where the driver coordinate q is in a working stroke, including its start but not its end.

        sense: sense of motion of the driver, +1 or -1.
        """
        inside = np.zeros(np.shape(q), dtype=bool)
        for stroke in self.working:
            gone = np.mod(sense * (q - stroke.start) + SAME_DRIVER_POSITION, self.cycle) - SAME_DRIVER_POSITION
            inside = inside | (gone < stroke.length - SAME_DRIVER_POSITION)
        return inside


def find_strokes(
    linkage: Linkage,
    kernels: tuple[GroupSolver, ...],
    driver_range: DriverRange,
    resists: float = 0.0,
    link: str | None = None,
) -> Strokes | None:
    """Find the strokes of an output over the cycle of the driver.

    If the file does not give the direction of the working stroke, the working stroke is the slower one: the one that
    takes the longer travel of the driver. If both take the same travel, it is the one that the load resists; if that is
    unknown too, it is the forward one.

    Args:
        linkage: the linkage.
        kernels: solvers of its groups.
        driver_range: range of the driver.
        resists: sign of the displacement of the output that the useful resistance opposes; 0 if unknown.
        link: the output; the main output if None.

    Returns:
        The strokes; None if the mechanism has no output.
    """
    link = link or output_link(linkage, tuple(d.group for d in kernels))
    if link is None:
        return None
    curve = OutputCurve(linkage, solvers_towards(kernels, [linkage.output_carrier(link)]), link)
    none = Strokes(link, curve.kind, (), "")
    if not driver_range.full:
        return none
    sense, cycle = linkage.driver.sense, 2 * np.pi * driver_range.turns
    q = np.linspace(driver_range.start, driver_range.end, SCAN * driver_range.turns + 1)
    # one extra step: at the ends of the scan rounding may hide the end of a stroke
    q = np.append(q, q[-1] + (q[1] - q[0]))
    slope = curve.moving_slope(q)
    if not np.any(slope):
        return none
    moves = np.flatnonzero(slope)
    if moves[0] > 0:  # a dwell at the ends of the scan must not be split
        q = q + (q[moves[0]] - q[0])
        slope = curve.slope(q)
    turns, rests = _find_reversals(curve, q, slope, sense)
    turns = np.mod(turns, cycle)
    turns = np.where(cycle - turns < SEAM, 0.0, turns)
    order = np.argsort(turns)
    turns, rests = turns[order], rests[order]
    again = np.diff(turns, append=turns[:1] + cycle) < SAME_DRIVER_POSITION  # found at both ends of the scan
    rest_before = dict(zip(turns[~again].tolist(), rests[~again].tolist(), strict=True))
    turns = _drop_rounding_reversals(curve, turns[~again][::sense], cycle, sense)
    if turns.size < 2:
        return none
    lengths = np.mod(sense * (np.roll(turns, -1) - turns), cycle)
    lows, runs = measure_runs(curve, turns, sense * lengths)
    rests = np.roll([rest_before.get(float(t), 0.0) for t in turns], -1)
    lengths = lengths - rests
    forward, back = lengths[runs > 0].sum(), lengths[runs < 0].sum()
    direction, rule = _working_direction(linkage.working_direction(link), forward, back, resists)
    strokes = [
        Stroke(float(t), float(n), float(s), float(r), bool(np.sign(r) == direction), float(rest))
        for t, n, s, r, rest in zip(turns, lengths, lows, runs, rests, strict=True)
    ]
    if not any(s.working for s in strokes):  # the output is at rest within rounding
        return none
    first = max((i for i, s in enumerate(strokes) if s.working), key=lambda i: (round(strokes[i].length, 9), -i))
    return Strokes(link, curve.kind, tuple(strokes[first:] + strokes[:first]), rule, cycle)


def _find_reversals(curve: OutputCurve, q: Real, slope: Real, sense: int) -> tuple[Real, Real]:
    """Find the driver coordinates at which the output reverses, and the lengths of the dwells before them.

    slope: derivative of the output at increasing driver coordinates q. In a dwell it is exactly zero. It may jump from
    one sign to the other with large values on both sides. At a change point such a jump does not end a stroke; at a
    hard impact of a cam it does.
    """
    moves = np.flatnonzero(slope)
    back = slope[moves[:-1]] * slope[moves[1:]] < 0
    if not np.any(back):
        return np.zeros(0), np.zeros(0)
    last, first = moves[:-1][back], moves[1:][back]
    stops = goes_on = find_roots(curve.slope, q[last], q[last + 1])
    still = first > last + 1
    if np.any(still):
        goes_on = stops.copy()
        goes_on[still] = find_roots(curve.slope, q[first[still] - 1], q[first[still]])
    rests = goes_on - stops
    rests[rests < NO_DWELL] = 0.0
    ends = np.where((rests > 0) & (sense < 0), stops, goes_on)
    sides = np.abs(curve.slope(ends + BESIDE_END * np.array([[-1], [0], [1]]))).min(axis=0)
    laws = [mesh.law for mesh in curve.linkage.meshes if mesh.law is not None]
    if laws:  # pieces start AT_EDGE_OF_CAM before their boundary; exactly there rounding would select the piece
        ends = ends + sense * AT_EDGE_OF_CAM
    impacts = any(law.jumps() for law in laws)
    true = impacts | (rests > 0) | (sides < NO_JUMP * np.nanmax(np.abs(slope)))
    return ends[true], rests[true]


def _drop_rounding_reversals(curve: OutputCurve, turns: Real, cycle: float, sense: int) -> Real:
    """Drop reversals of the output that are due to rounding.

    Where the output almost rests, its rounded velocity may change sign repeatedly. Such reversals are replaced by one
    in their middle, or by none if the output continues in the same direction after them.
    """
    if turns.size < 2:
        return turns
    lengths = np.mod(sense * (np.roll(turns, -1) - turns), cycle)
    __, runs = measure_runs(curve, turns, sense * lengths)
    moves = np.abs(runs) > RESTS * np.max(np.abs(runs), initial=0.0)
    if bool(np.all(moves)) or not bool(np.any(moves)):
        return turns
    first = int(np.argmax(moves)) + 1  # the reversal after a real stroke
    order = np.roll(np.arange(len(turns)), -first)
    kept: list[float] = []
    before, at, rested = runs[first - 1], float(turns[order[0]]), 0.0
    for k in order:
        if not moves[k]:
            rested += lengths[k]
            continue
        if np.sign(runs[k]) != np.sign(before):
            kept.append(np.mod(at + sense * rested / 2, cycle))
        before, at, rested = runs[k], float(turns[(k + 1) % len(turns)]), 0.0
    return np.sort(np.array(kept))[::sense]


def _working_direction(given_direction: str, forward: float, back: float, resists: float) -> tuple[int, str]:
    """Return the direction of the working stroke (+1 or -1), and the reason.

    forward, back: total lengths (rad of the driver) of the strokes in each direction.
    """
    if given_direction != "auto":
        return (1 if given_direction == "forward" else -1), "as the file says"
    if abs(forward - back) > SAME_DRIVER_POSITION:
        return (1 if forward > back else -1), "the slower one"
    if resists:
        return int(np.sign(resists)), "the one that the load resists"
    return 1, "the forward one"


def resisted_direction(linkage: Linkage, link: str | None) -> Any:
    """Return the direction of motion of the output (+1 or -1) that the loads of the working stroke resist.

    The result is 0 if the loads do not determine the direction. It has shape (variants, 1) if loads vary between
    variants.
    """
    for slide in linkage.slides:
        if {slide.carrier, slide.runner} == {FRAME, link}:
            along = np.exp(1j * slide.direction)
            if slide.runner == FRAME:
                along = -along
            push = sum(
                (x.force.real * along.real + x.force.imag * along.imag) * _mean_table_value(x)
                for x in linkage.loads
                if x.link == link and x.working_stroke_only
            )
            return -np.sign(push)
    moment = sum(x.moment * _mean_table_value(x) for x in linkage.loads if x.link == link and x.working_stroke_only)
    return -np.sign(moment)


def _mean_table_value(load: Load) -> Any:
    return sum(load.table.values) / len(load.table.values) if load.table else 1.0


def driver_positions(request: Request, driver_range: DriverRange, strokes: Strokes | None, sense: int) -> Real:
    """Return the driver coordinates (rad or m) of the requested positions; the first is position 0.

    In a limited range the positions are in the middles of equal parts, since velocities are undefined at its ends. Over
    the stroke of a driver they extend from end to end.
    """
    if request.places:
        return np.array(request.places)
    steps = np.arange(request.count)
    if driver_range.full:
        start = request.start
        if start == "working stroke":
            start = strokes.strokes[0].start if strokes and strokes.strokes else driver_range.start + np.pi
        return start + sense * (2 * np.pi * driver_range.turns * steps / request.count)
    share = steps / max(request.count - 1, 1) if driver_range.inclusive else (steps + 0.5) / request.count
    if sense < 0:
        share = 1 - share
    return driver_range.start + (driver_range.end - driver_range.start) * share
