"""Stage: the output of the mechanism, its strokes, which of them is the working one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from tmm_cli.groups.base import Kernel
from tmm_cli.linkage import FRAME, Linkage, Load, Request, Slide
from tmm_cli.motion import Law, Motion, move, towards
from tmm_cli.quality import SCAN, Range
from tmm_cli.roots import roots
from tmm_cli.structure.assur import Group
from tmm_cli.vectors import Real

RESTS = 1e-12  # of the longest run: a run below that is rounding
DWELL = 1e-6  # rad: about a mere end of a stroke rounding makes a speed of zero over less than that


@dataclass(frozen=True)
class Stroke:
    """One way of the output: driver from `start` on by `length` in its sense; output from `low` by `run` (signed).

    rest: how far the driver goes on in the dwell after it (a follower on the round of its cam), before the next stroke.
    """

    start: float
    length: float
    low: float
    run: float
    working: bool
    rest: float = 0.0


@dataclass(frozen=True)
class Strokes:
    """Strokes of the output link in a turn of the driver, beginning with the working one; empty when it has none.

    kind: the output slides (m), or swings (rad). k is the time of the working strokes over that of the idle ones at
    constant speed, without the dwells between them. rule: why that stroke is the working one. cycle: how far the
    driver goes until they repeat (rad).
    """

    link: str
    kind: str
    strokes: tuple[Stroke, ...]
    rule: str
    cycle: float = 2 * np.pi

    @property
    def working(self) -> tuple[Stroke, ...]:
        return tuple(s for s in self.strokes if s.working)

    @property
    def travel(self) -> float:
        """Stroke H (m) or swing psi (rad)."""
        return max((abs(s.run) for s in self.strokes), default=0.0)

    @property
    def k(self) -> float:
        """Coefficient of change of mean speed."""
        idle = sum(s.length for s in self.strokes if not s.working)
        return sum(s.length for s in self.working) / idle if idle else float("nan")

    def share(self, q: Real, sense: int) -> Real:
        """Whether each place of the driver lies in a working stroke; its first position does, its last does not."""
        inside = np.zeros(np.shape(q), dtype=bool)
        for stroke in self.working:
            way = np.mod(sense * (q - stroke.start) + 1e-9, self.cycle) - 1e-9
            inside = inside | (way < stroke.length - 1e-9)
        return inside


def output_link(linkage: Linkage, groups: tuple[Group, ...]) -> str | None:
    """The output: named in the file, or the last link that is joined to the frame and not a driver or its cylinder."""
    if linkage.output is not None:
        return linkage.output.link
    driving = {link for driver in linkage.drivers for link in (driver.link, driver.base)}
    for group in reversed(groups):
        held = [link for link in group.links if linkage.slides_on_frame(link) or linkage.hinged_to_frame(link)]
        held = [link for link in held if link not in driving] or held
        if held:
            return next((link for link in held if linkage.slides_on_frame(link)), held[0])
    return None


def output_run(motion: Motion, link: str) -> tuple[Real, Real, Real]:
    """Run of the output (m, or its angle in rad) and its first and second transfer functions."""
    slide = _guide(motion.linkage, link)
    if slide is not None:
        sliding = motion.slide(slide)
        return sliding.run, sliding.first, sliding.second
    turning = motion.link(link)
    return turning.angle, turning.first, turning.second


def output_place(motion: Motion, link: str) -> Real:
    """Run of the output (m, or its angle in rad) alone."""
    slide = _guide(motion.linkage, link)
    return motion.angle(link) if slide is None else motion.run(slide)


def output_slope(motion: Motion, link: str) -> Real:
    """First transfer function of the output alone."""
    slide = _guide(motion.linkage, link)
    return motion.first[link].w if slide is None else motion.slope(slide)


def _guide(linkage: Linkage, link: str) -> Slide | None:
    """The sliding pair of a link on the frame."""
    return next((s for s in linkage.slides if {s.carrier, s.runner} == {FRAME, link}), None)


@dataclass(frozen=True)
class Travel:
    """How far an output goes between two ends of the driver that were asked for: run (m or rad) and driver's place."""

    link: str
    kind: str
    low: float
    high: float
    low_at: float
    high_at: float


def find_travel(linkage: Linkage, kernels: tuple[Kernel, ...], asked: Real, link: str) -> Travel | None:
    """Extremes of an output over the places asked for, found between them; for drivers that do not turn fully."""
    kind = "slide" if linkage.slides_on_frame(link) else "swing"
    law = Law(0.0, 1.0, 0.0, 1)
    q = np.linspace(np.min(asked), np.max(asked), SCAN + 1)
    moved = move(linkage, kernels, q, law, 1)  # all groups: it goes only where the whole linkage can
    run, slope = output_place(moved, link), output_slope(moved, link)
    q, run, slope = q[moved.placed], run[moved.placed], slope[moved.placed]
    if len(q) < 2:
        return None
    run = np.unwrap(run) if kind == "swing" else run
    change = np.flatnonzero(slope[:-1] * slope[1:] < 0)
    if change.size:
        upto = towards(kernels, [link])
        ends = roots(lambda x: output_slope(move(linkage, upto, x, law, 1), link), q[change], q[change + 1])
        there = output_place(move(linkage, upto, ends, law, 0), link)
        if kind == "swing":
            there = there + 2 * np.pi * np.round((run[change] - there) / (2 * np.pi))
        q, run = np.concatenate([q, ends]), np.concatenate([run, there])
    low, high = int(np.argmin(run)), int(np.argmax(run))
    return Travel(link, kind, float(run[low]), float(run[high]), float(q[low]), float(q[high]))


def find_strokes(
    linkage: Linkage, kernels: tuple[Kernel, ...], way: Range, resists: float = 0.0, link: str | None = None
) -> Strokes | None:
    """Strokes of an output over the driver's way; None when it is not joined to the frame.

    link: the main output when left out. resists: sign of the output's run against which the useful resistance acts, 0
    when it tells nothing. The working stroke is the slower one; when both last equally long, the one that is resisted;
    then the one that runs forward.
    """
    link = link or output_link(linkage, tuple(d.group for d in kernels))
    if link is None or not (linkage.slides_on_frame(link) or linkage.hinged_to_frame(link)):
        return None
    kind = "slide" if linkage.slides_on_frame(link) else "swing"
    if not way.full:
        return Strokes(link, kind, (), "")
    sense = linkage.driver.sense
    law = Law(way.start, 1.0, 0.0, 1)
    kernels = towards(kernels, [link])
    q = np.linspace(way.start, way.end, SCAN * way.turns + 1)
    # one step more: at the seam of the scan rounding may hide the end of a stroke
    q = np.append(q, q[-1] + (q[1] - q[0]))
    cycle = 2 * np.pi * way.turns

    def slope_at(x: Real) -> Real:
        return output_slope(move(linkage, kernels, x, law, 1), link)

    slope = slope_at(q)
    moves = np.flatnonzero(slope)
    if way.full and moves.size and moves[0] > 0:  # a dwell at the seam is not to be cut in two
        q = q + (q[moves[0]] - q[0])
        slope = slope_at(q)
    turns, rests = _stops(slope_at, q, slope, sense) if way.full else (np.zeros(0), np.zeros(0))
    turns = np.mod(turns, cycle)
    turns = np.where(cycle - turns < 1e-12, 0.0, turns)
    order = np.argsort(turns)
    turns, rests = turns[order], rests[order]
    again = np.diff(turns, append=turns[:1] + cycle) < 1e-9  # found at both ends of the scan
    rest_before = dict(zip(turns[~again].tolist(), rests[~again].tolist(), strict=True))
    turns = turns[~again][::sense]
    turns = _ends(linkage, kernels, turns, cycle, (link, kind))
    if turns.size < 2:
        return Strokes(link, kind, (), "")
    lengths = np.mod(sense * (np.roll(turns, -1) - turns), cycle)
    runs = _runs(linkage, kernels, turns, lengths, link, kind)
    rests = np.roll([rest_before.get(float(t), 0.0) for t in turns], -1)
    lengths = lengths - rests
    lows = output_place(move(linkage, kernels, turns, law, 0), link)
    forward, back = lengths[runs > 0].sum(), lengths[runs < 0].sum()
    direction, rule = _working(linkage, forward, back, resists)
    strokes = [
        Stroke(float(t), float(n), float(s), float(r), bool(np.sign(r) == direction), float(rest))
        for t, n, s, r, rest in zip(turns, lengths, lows, runs, rests, strict=True)
    ]
    if not any(s.working for s in strokes):  # the output stands still but for rounding
        return Strokes(link, kind, (), "")
    first = max((i for i, s in enumerate(strokes) if s.working), key=lambda i: (round(strokes[i].length, 9), -i))
    return Strokes(link, kind, tuple(strokes[first:] + strokes[:first]), rule, cycle)


def _stops(slope_at: Callable[[Real], Real], q: Real, slope: Real, sense: int) -> tuple[Real, Real]:
    """Where the output turns back: the driver's places from which it goes the other way, and the dwells before them.

    slope: the output's first transfer function at the places q, which rise; it is exactly zero in a dwell, and jumps
    from one sign to the other, without passing zero, at a change point, which is no end of a stroke.
    """
    moves = np.flatnonzero(slope)
    back = slope[moves[:-1]] * slope[moves[1:]] < 0
    if not np.any(back):
        return np.zeros(0), np.zeros(0)
    last, first = moves[:-1][back], moves[1:][back]
    stops = goes_on = roots(slope_at, q[last], q[last + 1])
    still = first > last + 1
    if np.any(still):
        goes_on = stops.copy()
        goes_on[still] = roots(slope_at, q[first[still] - 1], q[first[still]])
    rests = goes_on - stops
    rests[rests < DWELL] = 0.0
    ends = np.where((rests > 0) & (sense < 0), stops, goes_on)
    true = (rests > 0) | (np.abs(slope_at(ends)) < 1e-6 * np.nanmax(np.abs(slope)))
    return ends[true], rests[true]


def _ends(linkage: Linkage, kernels: tuple[Kernel, ...], turns: Real, cycle: float, output: tuple[str, str]) -> Real:
    """Ends of strokes, without those that only rounding makes.

    Where the output all but rests, its rounded speed may change sign over and over: such places are one end, in their
    middle, or none when the output goes on the same way after them.
    """
    if turns.size < 2:
        return turns
    sense = linkage.driver.sense
    lengths = np.mod(sense * (np.roll(turns, -1) - turns), cycle)
    runs = _runs(linkage, kernels, turns, lengths, *output)
    moves = np.abs(runs) > RESTS * np.max(np.abs(runs), initial=0.0)
    if bool(np.all(moves)) or not bool(np.any(moves)):
        return turns
    first = int(np.argmax(moves)) + 1  # the place after a true stroke
    order = np.roll(np.arange(len(turns)), -first)
    kept: list[float] = []
    before, at, way = runs[first - 1], float(turns[order[0]]), 0.0
    for k in order:
        if not moves[k]:
            way += lengths[k]
            continue
        if np.sign(runs[k]) != np.sign(before):
            kept.append(np.mod(at + sense * way / 2, cycle))
        before, at, way = runs[k], float(turns[(k + 1) % len(turns)]), 0.0
    return np.sort(np.array(kept))[::sense]


def _working(linkage: Linkage, forward: float, back: float, resists: float) -> tuple[int, str]:
    asked = linkage.output.working if linkage.output else "auto"
    if asked != "auto":
        return (1 if asked == "forward" else -1), "as the file says"
    if abs(forward - back) > 1e-9:
        return (1 if forward > back else -1), "the slower one"
    if resists:
        return int(np.sign(resists)), "the one that the load resists"
    return 1, "the forward one"


def _runs(linkage: Linkage, kernels: tuple[Kernel, ...], turns: Real, lengths: Real, link: str, kind: str) -> Real:
    """How far the output goes in each stroke (an angle is followed through, so that it may pass 180 degrees)."""
    law = Law(0.0, 1.0, 0.0, 1)
    places = turns[:, None] + linkage.driver.sense * lengths[:, None] * np.linspace(0, 1, 65)
    run = output_place(move(linkage, kernels, places.ravel(), law, 0), link).reshape(places.shape)
    if kind == "swing":
        run = np.unwrap(run, axis=1)
    return run[:, -1] - run[:, 0]


def resisted(linkage: Linkage, link: str | None) -> float:
    """The sign of the output's run that the loads of the working stroke resist; 0 when they tell nothing."""
    for slide in linkage.slides:
        if {slide.carrier, slide.runner} == {FRAME, link}:
            along = np.exp(1j * slide.direction)
            if slide.runner == FRAME:
                along = -along
            push = sum((x.force.real * along.real + x.force.imag * along.imag) * _mean(x) for x in linkage.loads
                       if x.link == link and x.working_stroke_only)  # fmt: skip
            return -float(np.sign(push))
    turn = sum(x.moment * _mean(x) for x in linkage.loads if x.link == link and x.working_stroke_only)
    return -float(np.sign(turn))


def _mean(load: Load) -> float:
    return float(np.mean(load.table.values)) if load.table else 1.0


def places(request: Request, way: Range, strokes: Strokes | None, sense: int) -> Real:
    """The driver's places that are asked for (rad or m); position 0 is the zero.

    On a limited way the positions are the middles of equal parts, since at its very ends velocities are lost; over the
    stroke of a driver they go from end to end.
    """
    if request.places:
        return np.array(request.places)
    steps = np.arange(request.count)
    if way.full:
        start = request.start
        if start == "working stroke":
            start = strokes.strokes[0].start if strokes and strokes.strokes else way.start + np.pi
        return start + sense * (2 * np.pi * way.turns * steps / request.count)
    share = steps / max(request.count - 1, 1) if way.inclusive else (steps + 0.5) / request.count
    if sense < 0:
        share = 1 - share
    return way.start + (way.end - way.start) * share
