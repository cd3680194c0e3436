"""Burmester's curves of four positions, with a parameter along which they are smooth, and their sampling.

The closure condition d2 e^(i b2) + d3 e^(i b3) + d4 e^(i b4) = d2 + d3 + d4 of the rotations (see `dyads_by_rotation`)
is that of a four-bar. If its link b2 rotates fully, the solutions form one loop for each branch, with the parameter b2.
If b2 rocks, they form one or two loops with b2 = middle + half cos(t); the branch is the sign of sin(t), so that t
passes smoothly from one branch to the other. If three positions have equal angles, the pins lie on a circle.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from tmm_cli.mechanics.numerics import bisect
from tmm_cli.synthesis.coupler_positions.burmester import (
    EXACT,
    CouplerPoses,
    Dyads,
    circle_centre,
    dyads_by_rotation,
    equal_angles,
    unit_vector,
)

APART: Final = 0.03  # relative distance of neighbours above which midpoints are inserted
FIRST, ROUNDS = 512, 9  # initial steps of a loop, and rounds of inserting midpoints
HALVINGS: Final = 60  # bisections for the ends of a part
HALF: Final = np.longdouble("1.57079632679489661923132169163975144")  # a right angle
FULL: Final = 4 * HALF


@dataclass(frozen=True)
class RotationLoops:
    """Burmester's curves as loops, with the rotation b2 of a link from position 1 to 2 as the parameter.

    Attributes:
        poses: the four positions.
        middle, half: middle and half range of b2 in each loop (rad), shape (loops,); half is nan if b2 rotates fully.
        branch: branch (0 or 1) of each loop in which b2 rotates fully, shape (loops,).
    """

    poses: CouplerPoses
    middle: Any
    half: Any
    branch: Any

    def at(self, loop: Any, t: Any) -> Dyads:
        """Return the dyads at parameters t (0 to 2 pi) of loops.

        loop: indices of the loops; `loop` and `t` are arrays that can be broadcast together.
        """
        t = np.asarray(t, EXACT)
        middle, half, branch = (np.asarray(x)[loop] for x in (self.middle, self.half, self.branch))
        turns = np.isnan(half)
        turn = np.where(turns, t, middle + np.where(turns, 0, half) * np.cos(t))
        return dyads_by_rotation(self.poses, turn, np.where(turns, branch, np.sin(t) < 0), ends=True)

    def __len__(self) -> int:
        return len(self.middle)


@dataclass(frozen=True)
class PinCircle:
    """Circle on which the pins lie if three of the four positions have equal angles.

    In these three positions all links AB of the circle are parallel and of equal length.

    Attributes:
        poses: the four positions.
        of: index of one of the positions with equal angles.
        arm: vector from the pivot to the pin in this position (complex, m).
        middle, radius: centre (complex, m) and radius (m) of the circle in the plane's axes.
    """

    poses: CouplerPoses
    of: int
    arm: Any
    middle: Any
    radius: Any

    def at(self, _: Any, t: Any) -> Dyads:
        pin = self.middle + self.radius * unit_vector(t)
        return Dyads(self.poses.places[self.of] + pin * unit_vector(self.poses.angles[self.of]) - self.arm, pin)

    def __len__(self) -> int:
        return 1


@dataclass(frozen=True)
class GivenDyad:
    """A dyad that the task determines, with the interface of a curve: it is the only dyad on the curve."""

    dyad: Dyads

    def at(self, _: Any, t: Any) -> Dyads:
        return Dyads(*(np.broadcast_to(np.asarray(x), np.shape(t)) for x in (self.dyad.pivot, self.dyad.pin)))

    def __len__(self) -> int:
        return 1


DyadCurve = RotationLoops | PinCircle | GivenDyad


@dataclass(frozen=True)
class CurveSamples:
    """Samples of a curve at about equal distances. The samples of all parts of the curve are stored one part after
    another.

    Attributes:
        curve: the sampled curve.
        t, loop: parameter and loop of each sample, shape (samples,).
        low, high: indices of the first and the last sample of the same part, shape (samples,).
    """

    curve: DyadCurve
    t: Any
    loop: Any
    low: Any
    high: Any

    def at(self, x: Any) -> Dyads:
        """Return the dyads at sample indices x. For a fractional index the parameter of the curve is interpolated."""
        lower = np.minimum(np.floor(x).astype(int), len(self.t) - 1)
        beyond = np.minimum(lower + 1, len(self.t) - 1)
        return self.curve.at(self.loop[lower], self.t[lower] + (x - lower) * (self.t[beyond] - self.t[lower]))


def burmester_curve(poses: CouplerPoses) -> DyadCurve:
    """Return Burmester's curves (centre points and circle points) of four positions whose angles are not all equal."""
    for odd in range(4):
        rest = [k for k in range(4) if k != odd]
        if equal_angles(poses.angles[rest]):
            return _find_pin_circle(poses, rest, odd)
    *__, d2, _, size3, size4, total = poses.loop
    over, about = 2 * np.abs(total * d2), np.abs(total) ** 2 + np.abs(d2) ** 2
    toward = np.angle(total * np.conj(d2))
    with np.errstate(all="ignore"):
        high, low = ((about - (size3 + sign * size4) ** 2) / over for sign in (-1, 1))
    if not over > 0 or (high >= 1 and low <= -1):
        rows = [(EXACT(0), EXACT(np.nan), branch) for branch in (0, 1)]
    elif high >= 1:
        rows = [(toward, np.arccos(min(low, EXACT(1))), 0)]
    elif low <= -1:
        rows = [(toward + 2 * HALF, 2 * HALF - np.arccos(high), 0)]
    else:
        near, far = np.arccos(high), np.arccos(low)
        rows = [(toward + side * (near + far) / 2, (far - near) / 2, 0) for side in (-1, 1)]
    middle, half, branch = (np.array(x) for x in zip(*rows, strict=True))
    return RotationLoops(poses, middle.astype(EXACT), half.astype(EXACT), branch)


def _find_pin_circle(poses: CouplerPoses, equal: list[int], odd: int) -> PinCircle:
    """Return the circle of pins for four positions, of which those in `equal` have the same angle and `odd` has another
    one.

    The distance |AB| must be the same in the position `odd`. So the pin m satisfies |c + m g| = |arm|, with constants c
    and g.
    """
    first = equal[0]
    arm = poses.places[first] - circle_centre(poses.places[equal])
    turned = unit_vector(poses.angles[[first, odd]])
    g = turned[1] - turned[0]
    return PinCircle(poses, first, arm, -(poses.places[odd] - poses.places[first] + arm) / g, np.abs(arm / g))


def scan_curve(curve: DyadCurve, size: float) -> list[Any]:
    """Return the parameters t of samples around every loop, more closely spaced where neighbouring dyads differ
    more.

    Args:
        curve: Burmester's curve.
        size: characteristic length of the task (m).
    """
    return [] if isinstance(curve, GivenDyad) else [_scan_loop(curve, loop, size) for loop in range(len(curve))]


def sample_parts(
    curve: DyadCurve, scans: list[Any], good: Callable[[Dyads], Any], size: float, count: int
) -> CurveSamples | None:
    """Sample the parts of a curve on which the dyads are acceptable; the ends of the parts are found by bisection.

    Args:
        curve: Burmester's curve.
        scans: parameters around every loop (see `scan_curve`).
        good: function that returns True for each acceptable dyad.
        size: characteristic length of the task (m).
        count: approximate number of samples on all parts.

    Returns:
        The samples; None if no dyad is acceptable.
    """
    if isinstance(curve, GivenDyad):
        return CurveSamples(curve, np.zeros(1), *np.zeros((3, 1), dtype=int))
    rows = []
    for loop, t in enumerate(scans):
        is_good = good(curve.at(loop, t))
        starts, ends = (np.flatnonzero(x) for x in (is_good[1:] & ~is_good[:-1], is_good[:-1] & ~is_good[1:]))
        inside, outside = np.concatenate([t[starts + 1], t[ends]]), np.concatenate([t[starts], t[ends + 1]])
        edges, __ = bisect(lambda at, loop=loop: good(curve.at(loop, at)), inside, outside, HALVINGS)  # type: ignore[misc]
        low, high = np.split(edges, [len(starts)])
        low = np.concatenate([t[:1] if is_good[0] else t[:0], low])
        high = np.concatenate([high, t[-1:] if is_good[-1] else t[:0]])
        for a, b in zip(low, high, strict=True):
            inner = np.concatenate([[a], t[(t > a) & (t < b)], [b]])
            path_length = np.cumsum(np.concatenate([[0], _compute_relative_gaps(curve.at(loop, inner), size)]))
            rows.append((loop, inner, np.asarray(path_length, float)))
    total = sum(path_length[-1] for _, _, path_length in rows)
    samples = []
    for loop, inner, path_length in rows:
        n = int(np.ceil(count * path_length[-1] / total)) + 3 if total > 0 else 3
        even = np.interp(np.linspace(0, path_length[-1], n), path_length, np.asarray(inner - inner[0], float))
        t = inner[0] + even.astype(EXACT)
        t[-1] = inner[-1]
        samples.append((loop, t))
    if not samples:
        return None
    counts = [len(t) for __, t in samples]
    ends = np.cumsum(counts)
    loops = np.repeat([loop for loop, __ in samples], counts)
    first, last = np.repeat(ends - counts, counts), np.repeat(ends - 1, counts)
    return CurveSamples(curve, np.concatenate([t for __, t in samples]), loops, first, last)


def _scan_loop(curve: RotationLoops | PinCircle, loop: int, size: float) -> Any:
    def wide(t: Any) -> Any:
        dyads = curve.at(loop, t)
        near = np.abs(dyads.pivot - curve.poses.places[0]) + np.abs(dyads.pin) < 8 * size
        return (near[1:] | near[:-1]) & ~(_compute_relative_gaps(dyads, size) < APART) & (np.diff(t) > 1e-12)

    return refine_parameters(wide, FIRST, ROUNDS)


def refine_parameters(wide: Callable[[Any], Any], first: int, rounds: int) -> Any:
    """Return parameters around a loop (0 to 2 pi): equal steps, of which those that are too wide are halved repeatedly.

    Args:
        wide: function that returns True for each step that is too wide.
        first: number of equal steps.
        rounds: number of rounds in which midpoints of wide steps are inserted.
    """
    t = FULL * np.linspace(0, 1, first + 1, dtype=EXACT)
    for _ in range(rounds):
        too_wide = wide(t)
        if not np.any(too_wide):
            break
        t = np.sort(np.concatenate([t, ((t[1:] + t[:-1]) / 2)[too_wide]]))
    return t


def _compute_relative_gaps(dyads: Dyads, size: float) -> Any:
    """Return the distances between neighbouring dyads of an array, divided by the characteristic length of the task."""
    with np.errstate(all="ignore"):
        return (np.abs(np.diff(dyads.pivot)) + np.abs(np.diff(dyads.pin))) / size


# Burmester's curves as lines for drawings, dense where they bend, and the extent of their sheet.


FIRST_STEPS: Final = 720  # initial steps of a loop
BENDING_ROUNDS: Final = 24  # rounds of inserting midpoints in long steps and bends
DRAWN_APART: Final = 0.01  # relative to the size of the mechanism, or to the distance from it
BEND: Final = 0.05  # rad: smallest visible corner
SHORT: Final = 2e-4  # relative: corners between shorter steps are not visible
CLOSE: Final = 1e-15  # of a revolution: smallest difference of parameters
BREAK: Final = 0.1  # relative: neighbours further apart lie on both sides of infinity
FAR: Final = 4.0  # sizes of the mechanism: curves are followed to this distance, beyond the sheet
AROUND: Final = 0.3  # sizes of the four-bar: margin of the curves' sheet
RETURN: Final = 1.5  # sizes of the four-bar: a curve that returns from within this distance is shown whole

Places = tuple[complex, ...]


def burmester_lines(poses: CouplerPoses, about: Sequence[complex]) -> tuple[list[Places], list[Places]]:
    """Return the centre-point curve, and the circle-point curve in position 1, as lines near the mechanism.

    Args:
        poses: the four positions.
        about: points of the mechanism (complex, m).

    Returns:
        Lines of both curves (complex, m); empty if all angles are equal.
    """
    if equal_angles(poses.angles):
        return [], []
    curve, box = burmester_curve(poses), np.array(about)
    middle = complex(box.real.max() + box.real.min(), box.imag.max() + box.imag.min()) / 2
    size = float(max(np.ptp(box.real), np.ptp(box.imag)))

    def pivots(loop: int, t: Any) -> Any:
        return (np.asarray(curve.at(loop, t).pivot, complex) - middle) / size

    def pins(loop: int, t: Any) -> Any:
        return (np.asarray(poses.on_frame(curve.at(loop, t).pin)[..., 0], complex) - middle) / size

    kinds = pivots, pins
    rows = [[tuple((middle + size * piece).tolist()) for piece in _split_pieces(curve, at)] for at in kinds]
    return rows[0], rows[1]


def _split_pieces(curve: DyadCurve, at: Callable[[int, Any], Any]) -> Iterator[Any]:
    """Yield the pieces of a curve that lie in the drawn area. A loop without gaps is one piece.

    Here lengths are divided by the size of the mechanism, and the origin is the middle of the mechanism.
    """
    for loop in range(len(curve)):
        with np.errstate(all="ignore"):
            points = _sample_densely(lambda t, loop=loop: at(loop, t))  # type: ignore[misc]
            broken = ~(np.abs(np.diff(points)) < BREAK * np.maximum(1, np.abs(points[1:])))
            broken |= ~(_is_near(points[1:]) | _is_near(points[:-1]))
        pieces = [piece for piece in np.split(points, np.flatnonzero(broken) + 1) if len(piece) > 1]
        if len(pieces) > 1 and not (broken[0] or broken[-1]):  # the loop starts inside a piece
            pieces = [np.concatenate([pieces[-1], pieces[0][1:]]), *pieces[1:-1]]
        yield from pieces


def _sample_densely(at: Callable[[Any], Any]) -> Any:
    """Return points along a closed curve, spaced closely enough for a drawing."""

    def wide(t: Any) -> Any:
        points = at(t)
        steps, reach = np.diff(points), np.maximum(1, np.abs(points))
        too_wide = ~(np.abs(steps) < DRAWN_APART * np.minimum(reach[1:], reach[:-1]))
        bends = np.abs(np.angle(steps[1:] / steps[:-1])) > BEND
        seen = np.abs(steps) > SHORT
        too_wide[1:] |= bends & seen[1:]
        too_wide[:-1] |= bends & seen[:-1]
        return too_wide & (_is_near(points[1:]) | _is_near(points[:-1])) & (np.diff(t) > CLOSE * FULL)

    points = at(refine_parameters(wide, FIRST_STEPS, BENDING_ROUNDS))
    return points[np.isfinite(points)]


def _is_near(points: Any) -> Any:
    return np.isfinite(points) & (np.abs(points.real) < FAR) & (np.abs(points.imag) < FAR)


def sheet_extent(bar: Sequence[complex], curves: Sequence[Places]) -> Places:
    """Return two opposite corners of the area shown on the sheet of Burmester's curves (complex, m).

    The area contains the four-bar and the curves near it. A piece of a curve that leaves the area and returns is
    included as well if it does not go far beyond.
    """
    corners = np.array(bar)
    low, high = (complex(f(corners.real), f(corners.imag)) for f in (np.min, np.max))
    size = max((high - low).real, (high - low).imag)
    held = [corners]
    for line in curves:
        z = np.array(line)
        off = np.maximum.reduce([low.real - z.real, z.real - high.real, low.imag - z.imag, z.imag - high.imag]) / size
        held.append(z[off < AROUND])
        closed = abs(z[0] - z[-1]) < BREAK * size
        cuts = np.flatnonzero((off[1:] < AROUND) != (off[:-1] < AROUND)) + 1
        runs = np.split(np.arange(len(z)), cuts)
        for number, run in enumerate(runs):
            ends = number in (0, len(runs) - 1)
            if np.max(off[run]) < RETURN and (closed or not ends) and len(runs) > 1:
                held.append(z[run])
    all_points = np.concatenate(held)
    return tuple(complex(f(all_points.real), f(all_points.imag)) for f in (np.min, np.max))
