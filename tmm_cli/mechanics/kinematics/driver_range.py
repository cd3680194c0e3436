"""Range of the driver, dead positions within it, and travel of sliding blocks beyond the ends of their guides."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from tmm_cli.mechanics.assembly import assembly_reserve, refine_dead_positions
from tmm_cli.mechanics.groups import (
    AccumulatedAngles,
    ClosedFormSolver,
    DriverMotion,
    GroupSolver,
    LinkStates,
    link_states,
    slider_search_range,
    solvers_towards,
)
from tmm_cli.mechanics.linkage import Linkage, Slide
from tmm_cli.mechanics.numerics import CAME_BACK, DEAD, END_OF_SLOT, Real, find_minima, find_roots
from tmm_cli.mechanics.structure import MOST_TURNS, turns_of_cycle

SCAN = 1440  # samples per turn of the first scan, which is refined
PARTS = 64  # parts into which an interval is divided at once
ALMOST = 1e-5  # fraction of the range of the trace: nearer to infinity a group cannot be solved


@dataclass(frozen=True)
class DriverLimit:
    """A limit of the driver coordinate.

    Attributes:
        place: the limit (rad or m).
        group: title of the group that stops the driver; empty if no group does.
        driver: name of the first driver if it comes to rest there because it decelerates, which is possible with
            several drivers only; otherwise empty.
    """

    place: float
    group: str
    driver: str = ""


@dataclass(frozen=True)
class DriverRange:
    """Range of the driver about the position of the sketch (rad, or m for a slider).

    Attributes:
        start, end: ends of the range.
        full: True if the driver can make full turns. The range is then one cycle.
        limits: limits that stop the driver.
        turns: number of turns after which the mechanism repeats.
        repeats: False if no such number was found.
        inclusive: True if both ends are the ends of the stroke of the driver, and not dead positions.
    """

    start: float
    end: float
    full: bool
    limits: tuple[DriverLimit, ...] = ()
    turns: int = 1
    repeats: bool = True
    inclusive: bool = False


@dataclass(frozen=True)
class DeadPosition:
    """A dead position: velocities of a group are indeterminate.

    Attributes:
        place: driver coordinate (rad or m).
        group: title of the group.
        margin: margin of the group there; see Placement.
        passed: True if the group passes the position smoothly. The sign of its determinant may change there.
    """

    place: float
    group: str
    margin: float
    passed: bool = False


def find_range(linkage: Linkage, kernels: tuple[GroupSolver, ...]) -> DriverRange:
    """Find the range of the driver about the sketch; its limits are accurate to the last bit.

    If the file gives the stroke of the driver, the range does not exceed the stroke.
    """
    driver_range = _range_about_sketch(linkage, kernels)
    stroke = linkage.driver.stroke
    if stroke is None:
        return driver_range
    low, high = stroke
    if not driver_range.full:
        low, high = max(driver_range.start, low), min(driver_range.end, high)
    kept = tuple(limit for limit in driver_range.limits if low <= limit.place <= high)
    return DriverRange(low, high, False, kept, inclusive=(low, high) == stroke)


def _range_about_sketch(linkage: Linkage, kernels: tuple[GroupSolver, ...]) -> DriverRange:
    at, turns = linkage.sketch.at, linkage.driver.kind == "turn"
    cycle = cycle_turns(linkage, kernels) if turns else 1
    number = cycle or 1
    half = np.pi * number if turns else slider_search_range(linkage)
    low, high = _search_interval(kernels, at, half)
    steps = np.linspace(low, high, round(SCAN * number * (high - low) / (2 * half)) + 1)
    # np.unique would import masked arrays, which takes longer than the rest of this stage
    steps = np.sort(steps if np.any(steps == 0.0) else np.append(steps, 0.0))
    side = [np.sign(p.det[0]) for p in link_states(linkage, kernels, np.array([at]), 0).placements]
    scan = link_states(linkage, kernels, at + steps, 0)
    steps = np.sort(
        np.concatenate([steps, *(_nearly_lost(linkage, kernels, scan, n) - at for n in range(len(kernels)))])
    )
    lost = _is_lost(link_states(linkage, kernels, at + steps, 0), side)
    stopped = _stops_before(linkage, at + steps)
    if not bool(np.any(lost)) and not bool(np.any(stopped)):
        back = cycle is not None and (not turns or _returns_after_cycle(linkage, kernels, at, half))
        return DriverRange(at - half, at + half, turns, turns=number, repeats=back)
    blocked = np.flatnonzero(np.any(lost, axis=0) | stopped)
    middle = int(np.argmin(np.abs(steps)))

    def limit(index: int, towards: int) -> DriverLimit:
        good, bad = at + steps[index - towards], at + steps[index]
        first = kernels[int(np.argmax(lost[:, index]))]
        for end in _trace_limits(first):  # accurate to the last bit for a traced group
            if min(good, bad) <= end <= max(good, bad):
                return DriverLimit(end, first.group.title)
        while True:
            between = np.linspace(good, bad, PARTS + 1)[1:-1]
            between = between[(between != good) & (between != bad)]
            if not between.size:
                break
            gone = np.any(_is_lost(link_states(linkage, kernels, between, 0), side), axis=0) | _stops_before(
                linkage, between
            )
            blocked_samples = np.flatnonzero(gone)
            samples = np.array([good, *between, bad])
            first_blocked = int(blocked_samples[0]) + 1 if blocked_samples.size else len(samples) - 1
            good, bad = samples[first_blocked - 1], samples[first_blocked]
        if stopped[index]:
            return DriverLimit(float(good), "", linkage.driver.link)
        return DriverLimit(_at_infinity(first, float(good), towards), first.group.title)

    below, above = blocked[blocked < middle], blocked[blocked > middle]
    first = limit(int(below[-1]), -1) if below.size else None
    last = limit(int(above[0]), 1) if above.size else None
    around = turns and cycle is not None
    if around and first is None and last is not None:  # the blocked interval contains the end of the scan
        first = limit_a_cycle_away(last, blocked, steps, (at, 2 * half), limit)
    if around and last is None and first is not None:
        last = limit_a_cycle_away(first, blocked, steps, (at, 2 * half), limit)
    start = first.place if first else at - half
    end = last.place if last else at + half
    return DriverRange(start, end, False, tuple(x for x in (first, last) if x))


def _stops_before(linkage: Linkage, q: Real) -> Real:
    """Return True where the first of several drivers comes to rest before it reaches the driver coordinate q."""
    lead = linkage.driver
    if not linkage.others:
        return np.zeros(np.shape(q), dtype=bool)
    law = DriverMotion(linkage.sketch.at, lead.rate, lead.acceleration, lead.sense)
    return ~np.isfinite(law.time(q))


def _returns_after_cycle(linkage: Linkage, kernels: tuple[GroupSolver, ...], at: float, half: float) -> bool:
    """Return True if all links are in the same position after a cycle. For example, a rack driven by a gear is not."""
    motion = link_states(linkage, kernels, np.array([at, at + 2 * half]), 0)
    size = max((kernel.size for kernel in kernels), default=1.0)
    moved = [max(abs(np.diff(pose.x)[0]) / size, abs(np.diff(pose.z)[0])) for pose in motion.poses.values()]
    return bool(max(moved) < CAME_BACK)


def _at_infinity(kernel: GroupSolver, place: float, towards: int) -> float:
    """Return the driver coordinate at which links of a traced group reach infinity, if `place` is close to it.

    Positions just before it cannot be solved. Otherwise `place` is returned.
    """
    trace = kernel.followed
    end = (0, -1)[towards > 0]
    if trace is None or not trace.lost[end]:
        return place
    infinite, last = float(trace.q[end]), float(trace.q[end - towards])
    close = abs(infinite - place) < ALMOST * float(trace.q[-1] - trace.q[0])
    return infinite if close or abs(infinite - place) < abs(infinite - last) else place


def _search_interval(kernels: tuple[GroupSolver, ...], at: float, half: float) -> tuple[float, float]:
    """Return the interval to examine, relative to the sketch.

    It is a cycle, or longer if the trace of a group extends further.
    """
    low, high = -half, half
    for kernel in kernels:
        trace = kernel.followed
        if trace is not None and not trace.closed and True not in trace.open_ends:
            low, high = min(low, 1.001 * (trace.q[0] - at)), max(high, 1.001 * (trace.q[-1] - at))
    return float(low), float(high)


def _trace_limits(kernel: GroupSolver) -> tuple[float, ...]:
    """Return the driver coordinates at which the trace of a group ends because a limit of the driver is reached."""
    trace = kernel.followed
    if trace is None or trace.closed:
        return ()
    return tuple(float(q) for q, limit in zip((trace.q[0], trace.q[-1]), trace.limits, strict=True) if limit)


def link_rotations(linkage: Linkage, kernels: tuple[GroupSolver, ...]) -> dict[str, int]:
    """Return, by name of the link, its revolutions per revolution of the driver.

    Only links on whose full turns gears depend are included; their angles are accumulated through full turns.
    """
    rotations = {}
    for kernel in kernels:
        winding = kernel.winding if isinstance(kernel, ClosedFormSolver) else None
        if isinstance(winding, AccumulatedAngles) and winding.closed:
            turns = (winding.q[-1] - winding.q[0]) / (2 * np.pi)
            for link, angles in winding.angles.items():
                rotations[link] = round(float((angles[-1] - angles[0]) / (2 * np.pi) / turns))
    return rotations


def cycle_turns(linkage: Linkage, kernels: tuple[GroupSolver, ...]) -> int | None:
    """Return the number of driver turns after which loads, gears, drivers and groups all repeat.

    None if they never do, or only after more than MOST_TURNS turns.
    """
    turns = turns_of_cycle(linkage, link_rotations(linkage, kernels))
    for kernel in kernels:
        trace = kernel.followed
        if trace is not None and trace.closed and turns is not None:
            turns = math.lcm(turns, round((trace.q[-1] - trace.q[0]) / (2 * np.pi)))
        change_points = kernel.way if isinstance(kernel, ClosedFormSolver) else None
        if (
            change_points is not None
            and change_points.cycle is not None
            and len(change_points.places) % 2
            and turns is not None
        ):
            turns = math.lcm(turns, round(change_points.cycle / np.pi))
    if turns is not None:
        turns = math.lcm(turns, linkage.turns)
    return turns if turns is not None and turns <= MOST_TURNS else None


def _nearly_lost(linkage: Linkage, kernels: tuple[GroupSolver, ...], scan: LinkStates, number: int) -> Real:
    """Find the driver coordinates, between the samples of a scan, at which a group is nearest to losing its assembly.

    number: index of the group.
    """
    residual = np.where(np.isfinite(scan.placements[number].residual), scan.placements[number].residual, -np.inf)
    inner = residual[1:-1]
    # between two samples it rises by little more than from one sample to the next
    with np.errstate(invalid="ignore"):
        rise = np.maximum(inner - residual[:-2], inner - residual[2:])
    close = (
        np.flatnonzero((inner >= residual[:-2]) & (inner > residual[2:]) & (inner < 0) & (inner + 2 * rise >= 0)) + 1
    )
    step = scan.q[1] - scan.q[0]
    to_spare = partial(assembly_reserve, linkage, solvers_towards(kernels, kernels[number].group.links))
    narrow: Real = find_minima(to_spare, scan.q[close] - step, scan.q[close] + step)[0]
    return narrow


def _is_lost(motion: LinkStates, side: list[float]) -> Real:
    """Return True where the linkage cannot have the assembly of the sketch, shape (groups, positions).

    Either the group cannot be assembled there, or it can but lies beyond a dead position, which the opposite sign of
    the determinant shows. In the latter case two guides have become parallel in between, and their intersection has
    passed through infinity.
    """
    lost = [
        motion.missing[kernel.group.title] | (np.sign(at.det) * kernel.side(motion.q) == -sign)
        for kernel, at, sign in zip(motion.kernels, motion.placements, side, strict=True)
    ]
    return np.array(lost) if lost else np.zeros((0, len(motion.q)), dtype=bool)


def limit_a_cycle_away(
    known_limit: DriverLimit,
    blocked: Real,
    steps: Real,
    about: tuple[float, float],
    limit: Callable[[int, int], DriverLimit],
) -> DriverLimit | None:
    """Find the second limit of the driver if all blocked driver coordinates lie on one side of the sketch.

    The other end of the blocked interval, moved by one cycle, is then the second limit.

    Args:
        known_limit: the first limit.
        blocked: indices of the samples that the driver cannot reach.
        steps: samples of the driver coordinate, relative to the sketch.
        about: driver coordinate of the sketch, and length of the cycle.
        limit: function that locates a limit, given the index of a blocked sample and the direction towards it.

    Returns:
        The limit; None if the blocked coordinates extend to the end of the examined interval.
    """
    at, cycle = about
    sense = -1 if known_limit.place > at else 1
    index = int(blocked[-1 if known_limit.place > at else 0])
    if index in (0, len(steps) - 1):
        return None
    other = limit(index, sense)
    return DriverLimit(other.place + sense * cycle, other.group)


def find_dead_positions(
    linkage: Linkage, kernels: tuple[GroupSolver, ...], driver_range: DriverRange
) -> tuple[DeadPosition, ...]:
    """Find the dead positions inside the range of the driver.

    The limits of the range are dead positions too, but are not included.
    """
    q = np.linspace(driver_range.start, driver_range.end, SCAN * driver_range.turns + 1)
    motion = link_states(linkage, kernels, q, 0)
    dead_positions = []
    for number, dyad in enumerate(kernels):
        at = motion.placements[number]
        margin = np.where(motion.placed | at.dead, at.margin, np.inf)
        inner = margin[1:-1]
        with np.errstate(invalid="ignore"):  # no dead position where the margin cannot fall so much between two samples
            reach = inner - 2 * np.maximum(margin[:-2] - inner, margin[2:] - inner) < DEAD
        low = np.flatnonzero((inner <= margin[:-2]) & (inner < margin[2:]) & (inner < 0.1) & reach) + 1
        candidates = list(q[low])
        steps = q[1] - q[0]
        if driver_range.full and margin[0] < 0.1 and margin[0] < margin[1] and margin[0] <= margin[-2]:
            candidates.append(q[0])
        upto = solvers_towards(kernels, dyad.group.links)
        passed = _passed_dead_positions(linkage, upto, driver_range)
        dead_positions += passed
        away = [
            p for p in candidates if all(abs(_driver_distance(p, o.place, driver_range)) > 2 * steps for o in passed)
        ]
        narrowest = find_minima(partial(_last_margin, linkage, upto), np.array(away) - steps, np.array(away) + steps)
        for best, left in zip(*narrowest, strict=True):
            if left < DEAD and (driver_range.full or driver_range.start + steps < best < driver_range.end - steps):
                best = float(refine_dead_positions(linkage, upto, np.array([best]), steps)[0])
                passive = getattr(dyad, "passive", False)  # the redundant constraints guide it through
                dead_positions.append(DeadPosition(best, dyad.group.title, left, passive))
    return tuple(sorted(dead_positions, key=lambda d: d.place))


def _passed_dead_positions(
    linkage: Linkage, upto: tuple[GroupSolver, ...], driver_range: DriverRange
) -> list[DeadPosition]:
    """Return the dead positions inside the range that the last group passes smoothly.

    They are known from its trace or from its change points.
    """
    last, title = upto[-1], upto[-1].group.title
    trace, change_points = last.followed, last.way if isinstance(last, ClosedFormSolver) else None
    if trace is not None and trace.dead.size:
        coordinates = trace.dead_within(driver_range.start, driver_range.end)
    elif change_points is not None:
        coordinates = change_points.within(driver_range.start, driver_range.end)
    else:
        return []
    left = _last_margin(linkage, upto, coordinates) if coordinates.size else coordinates
    return [DeadPosition(float(q), title, float(margin), True) for q, margin in zip(coordinates, left, strict=True)]


def _driver_distance(q: float, other_q: float, driver_range: DriverRange) -> float:
    """Return the difference of two driver coordinates, reduced by full cycles if the driver makes full turns."""
    cycle = driver_range.end - driver_range.start
    return q - other_q - cycle * round((q - other_q) / cycle) if driver_range.full else q - other_q


def _last_margin(linkage: Linkage, kernels: tuple[GroupSolver, ...], q: Real) -> Real:
    """Return the margin of the last group to its dead positions; zero where the linkage cannot be assembled."""
    motion = link_states(linkage, kernels, q, 0)
    return np.where(motion.placed, motion.placements[-1].margin, 0.0)


# Travel of sliding blocks relative to the ends of their guides, over the whole range of the driver.
#
# A guide through two points of a moving link ends at them. The extremes between the samples of a scan are found too; a
# driven cylinder has its stroke instead.


@dataclass(frozen=True)
class SlotExcess:
    """Largest travel of a sliding block beyond one end of its guide, or its closest approach to this end.

    Attributes:
        slide: prismatic pair of the block.
        point: name of the end of the guide.
        length: length of the guide (m).
        far: largest distance of the block beyond the end (m); negative if it stays before the end.
        place: driver coordinate at which this occurs (rad or m).
        ways: intervals of the driver coordinate in which the block is beyond the end.
    """

    slide: Slide
    point: str
    length: float
    far: float
    place: float
    ways: tuple[tuple[float, float], ...]


def find_slot_excess(
    linkage: Linkage, kernels: tuple[GroupSolver, ...], driver_range: DriverRange, requested: Sequence[float]
) -> tuple[SlotExcess, ...]:
    """Find how far sliding blocks travel beyond the ends of their guides.

    Args:
        linkage: the linkage.
        kernels: solvers of its groups.
        driver_range: range of the driver.
        requested: requested driver coordinates. If the driver cannot make full turns, only the range between the first
            and the last of them is examined.

    Returns:
        The excess at both ends of every guide of limited length.
    """
    driven = {driver.joint for driver in linkage.drivers if driver.kind == "slide"}
    slides = [slide for slide in linkage.slides if slide.ends is not None and slide.name not in driven]
    if not slides:
        return ()
    start, end = driver_range.start, driver_range.end
    if len(requested) and not driver_range.full:
        start, end = max(start, float(np.min(requested))), min(end, float(np.max(requested)))
    q = np.linspace(start, end, SCAN * driver_range.turns + 1)
    scan = link_states(linkage, kernels, q, 0)
    results = []
    for slide in slides:
        upto = solvers_towards(kernels, (slide.carrier, slide.runner))
        run, placed_q = scan.run(slide)[scan.placed], q[scan.placed]
        for point, forward in zip(slide.ends or (), (-1.0, 1.0), strict=True):
            if placed_q.size > 1:
                results.append(
                    _SegmentEnd(linkage, upto, slide, point, forward).excess(placed_q, run, driver_range.full)
                )
    return tuple(results)


@dataclass(frozen=True)
class _SegmentEnd:
    """One end of a guide of limited length. `forward` is +1 for the end at its last point, -1 for that at its first
    point.
    """

    linkage: Linkage
    kernels: tuple[GroupSolver, ...]
    slide: Slide
    point: str
    forward: float

    @property
    def length(self) -> float:
        first, last = (self.linkage.local(self.slide.carrier, name) for name in self.slide.ends or ())
        return abs(last - first)

    def beyond(self, run: Real) -> Real:
        """Return the distance (m) of the sliding block beyond the end, for displacements `run` along the guide."""
        return run - self.length if self.forward > 0 else -run

    def at(self, q: Real) -> Real:
        return self.beyond(link_states(self.linkage, self.kernels, q, 0).run(self.slide))

    def excess(self, q: Real, run: Real, full: bool) -> SlotExcess:
        """Find the largest travel of the sliding block beyond the end.

        Args:
            q: driver coordinates of samples.
            run: displacements of the block along the guide (m) at q.
            full: True if q covers a full cycle.
        """
        far = self.beyond(run)
        k = int(np.argmax(far))
        low, high = q[max(k - 1, 0)], q[min(k + 1, len(q) - 1)]
        place, short = find_minima(lambda places: -self.at(places), low, high)
        most = 0.0 if abs(short) <= END_OF_SLOT * self.length else -short
        ways = (self.ways(q, far, full) or ((place, place),)) if most > 0 else ()
        return SlotExcess(self.slide, self.point, self.length, most, place, ways)

    def ways(self, q: Real, far: Real, full: bool) -> tuple[tuple[float, float], ...]:
        """Return the intervals of the driver coordinate in which the block is beyond the end.

        In a full cycle the last interval may extend into the next cycle.
        """
        out = far > 0
        change = np.flatnonzero(out[:-1] != out[1:])
        crossings = find_roots(self.at, q[change], q[change + 1]) if change.size else np.zeros(0)
        leaves, returns = list(crossings[~out[change]]), list(crossings[out[change]])
        if out[0] and full and leaves:
            returns = [*returns[1:], returns[0] + q[-1] - q[0]]
        elif out[0]:
            leaves = [q[0], *leaves]
        if len(leaves) > len(returns):
            returns.append(q[-1])
        return tuple((float(a), float(b)) for a, b in zip(leaves, returns, strict=True))
