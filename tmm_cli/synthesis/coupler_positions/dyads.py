"""Dyads AB and DC of a four-bar that guides its coupler, from given quantities or as the best pair on Burmester's
curves.

The search uses the parts of the curves on which the links have a reasonable length. For AB the link must also reach the
positions in order while it rotates in one direction. Samples are taken along these parts at about equal distances, and
all pairs of samples are rated. Every pair that is better than its neighbours is a starting point; pairs with a defect
are included, because feasible pairs may lie in a narrow strip between samples. All starting points are improved
together. For the best of them the best DC is then found for every AB, because the best transmission angle often lies on
a ridge where two positions of the mechanism are equally unfavourable.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any, Final

import numpy as np

from tmm_cli.language import N_, _
from tmm_cli.mechanics.numerics import SAME_POINTS, find_minima
from tmm_cli.synthesis.coupler_positions.burmester import (
    SIDES,
    CouplerPoses,
    CouplerPositionsTask,
    DyadData,
    Dyads,
    GuidanceQuality,
    circle_centre,
    dyads_by_rotation,
    point_at_distance,
    rate_guidance,
    unit_vector,
)
from tmm_cli.synthesis.coupler_positions.curve import (
    CurveSamples,
    DyadCurve,
    GivenDyad,
    burmester_curve,
    sample_parts,
    scan_curve,
)
from tmm_cli.synthesis.four_bar import extreme_cosine
from tmm_cli.synthesis.record import Infeasible

COUNT: Final = 400  # approximate number of samples on a curve
STARTS, ROUNDS = 160, 24  # pairs that are improved together, and rounds
LAST: Final = 5  # best pairs, refined separately
APART, REACH = 0.05, 2.0  # in samples: distance of distinct pairs; search interval around each


@dataclass(frozen=True)
class LinkLimits:
    """Limits of the link lengths in the search (m).

    Attributes:
        shortest: least length of every link.
        link, frame, coupler: greatest length of AB and DC, of the frame, and of the coupler.
        outside: function that returns the distance of pivots from the allowed rectangle (m); None for no rectangle.
    """

    shortest: float
    link: float
    frame: float
    coupler: float
    outside: Callable[[Any], Any] | None = None


def best_on_curves(
    poses: CouplerPoses, size: float, limits: LinkLimits, given_dyads: dict[str, Dyads], loose: bool = False
) -> tuple[Dyads, Dyads, float] | None:
    """Return the best dyads AB and DC on Burmester's curves, and their rating.

    Args:
        poses: the four positions.
        size: characteristic length of the task (m).
        limits: limits of the link lengths.
        given_dyads: dyads that are already determined, by name (AB, DC).
        loose: True if the positions need not belong to the same assembly.

    Returns:
        Dyad AB, dyad DC and rating. The rating is the smallest transmission angle (rad), or a negative number if the
        four-bar has a defect or the length of coupler or frame is unreasonable. None if no link has a reasonable
        length.
    """
    whole = burmester_curve(poses)
    scans = scan_curve(whole, size)

    def rows(name: str, order: CouplerPoses | None) -> CurveSamples | None:
        source = GivenDyad(given_dyads[name]) if name in given_dyads else whole
        return _sample_sensible(poses, source, scans, size, limits, order)

    first, second = rows("AB", None if loose else poses), rows("DC", None)
    if first is None and not loose:
        first = rows("AB", None)
    if first is None or second is None:
        return None

    def score(x: Any, y: Any) -> Any:
        return rate_pairs(poses, first.at(x), second.at(y), limits, loose)

    table = score(np.arange(len(first.t))[:, None], np.arange(len(second.t))[None, :])
    x, y = _find_local_peaks(table, first, second)
    x, y, value = _improve_pairs(score, x, y, first, second)
    x, y, value = _refine_best(score, x, y, value, first, second)
    at = int(np.argmax(value))
    return first.at(x[at : at + 1])[0], second.at(y[at : at + 1])[0], float(value[at])


def _sample_sensible(
    poses: CouplerPoses,
    source: DyadCurve,
    scans: list[Any],
    size: float,
    limits: LinkLimits,
    order: CouplerPoses | None,
) -> CurveSamples | None:
    def good(dyads: Dyads) -> Any:
        with np.errstate(all="ignore"):
            b = poses.on_frame(dyads.pin)
            length = np.abs(b[..., 0] - dyads.pivot)
            sound = (length >= limits.shortest) & (length <= limits.link)
            if limits.outside is not None:
                sound &= limits.outside(dyads.pivot) <= 0
            if order is None:
                return sound
            steps = np.mod(np.diff(np.angle(b - np.asarray(dyads.pivot)[..., None]), axis=-1), 2 * np.pi)
            turn = steps.sum(-1)
            return sound & ((turn < 2 * np.pi) | (turn > 2 * np.pi * (steps.shape[-1] - 1)))

    return sample_parts(source, scans, good, size, COUNT)


def rate_pairs(poses: CouplerPoses, first: Dyads, second: Dyads, limits: LinkLimits, loose: bool = False) -> Any:
    """Return the rating of the four-bars formed by dyads AB and DC.

    It is the smallest transmission angle (rad) from the first to the last position. If the four-bar is not feasible, it
    is a negative number, the lower the further the four-bar is from being feasible.

    Args:
        poses: required positions of the coupler.
        first, second: dyads AB and DC, arrays that can be broadcast together.
        limits: limits of the link lengths.
        loose: True if the positions need not belong to the same assembly.
    """
    b, c = (np.asarray(poses.on_frame(x.pin), complex) for x in (first, second))
    a, d = (np.asarray(x.pivot, complex) for x in (first, second))
    with np.errstate(all="ignore"):
        l1, l3 = np.abs(b[..., 0] - a), np.abs(c[..., 0] - d)
        turned = np.mod(np.diff(np.angle(b - a[..., None]), axis=-1), 2 * np.pi)
        l2, l4 = np.abs(np.asarray(first.pin - second.pin, complex)), np.abs(a - d)
        start = np.angle((b[..., 0] - a) / (d - a))
        sines = ((c - b) * np.conj(c - d[..., None])).imag / (l2 * l3)[..., None]
        branch = 0.0 if loose else np.maximum(0, -np.maximum(sines.min(-1), -sines.max(-1)))
        value: Any = -np.inf
        for steps in (turned, turned - 2 * np.pi):
            rotation = steps.sum(-1)
            worst, __ = extreme_cosine(
                (l1, l2, l3, l4), start + np.minimum(rotation, 0), start + np.maximum(rotation, 0)
            )
            back = np.maximum(0, np.abs(rotation) - 2 * np.pi + 1e-12)
            wrong = branch + np.maximum(0, worst - 1) + (0 if loose else back)
            value = np.maximum(value, np.where(wrong > 0, -wrong, np.arccos(np.minimum(worst, 1))))
        unfair: Any = 0.0
        for x, longest in ((l2, limits.coupler), (l4, limits.frame)):
            unfair = unfair + np.maximum(0, np.log(limits.shortest / x)) + np.maximum(0, np.log(x / longest))
        value = np.where(unfair > 0, np.minimum(value, 0) - unfair, value)
    return np.where(np.isfinite(value), value, -99.0)


def _find_local_peaks(table: Any, first: CurveSamples, second: CurveSamples) -> tuple[Any, Any]:
    """Return the indices of the pairs of samples that are at least as good as their neighbours, best first.

    Neighbours are the next samples on the same parts of both curves.
    """
    top = np.ones(table.shape, bool)
    for axis, rows in enumerate((first, second)):
        values, peak = np.moveaxis(table, axis, 0), np.moveaxis(top, axis, 0)
        same = (rows.low[1:] == rows.low[:-1])[:, None]
        peak[:-1] &= ~same | (values[:-1] >= values[1:])
        peak[1:] &= ~same | (values[1:] >= values[:-1])
    x, y = np.nonzero(top)
    order = np.argsort(-table[x, y], kind="stable")[:STARTS]
    return x[order].astype(float), y[order].astype(float)


def _improve_pairs(score: Any, x: Any, y: Any, first: CurveSamples, second: CurveSamples) -> tuple[Any, Any, Any]:
    """Improve all starting points (pairs of dyads) together.

    In each round the pairs on a small grid around each point are rated, and the best one becomes the next point. The
    grid shrinks when the best pair is not at its edge.
    """
    shifts = np.linspace(-1.5, 1.5, 7)
    ends = [(rows.low[at.astype(int)], rows.high[at.astype(int)]) for rows, at in ((first, x), (second, y))]
    step = np.ones(len(x))
    for __ in range(ROUNDS):
        near = [
            np.clip(at[:, None] + step[:, None] * shifts, low[:, None], high[:, None])
            for at, (low, high) in zip((x, y), ends, strict=True)
        ]
        table = score(near[0][:, :, None], near[1][:, None, :]).reshape(len(x), -1)
        at = np.argmax(table, axis=1)
        row, column = at // 7, at % 7
        pick = np.arange(len(x))
        x, y, value = near[0][pick, row], near[1][pick, column], table[pick, at]
        inner = (np.abs(row - 3) < 3) & (np.abs(column - 3) < 3)
        step = np.where(inner, step * 0.5, step)
    return x, y, value


def _refine_best(
    score: Any, x: Any, y: Any, value: Any, ab_samples: CurveSamples, dc_samples: CurveSamples
) -> tuple[Any, Any, Any]:
    """Refine the best pairs of dyads that differ clearly from one another.

    The rating is maximised over the dyads AB; for each AB the best dyad DC is used.
    """
    kept: list[int] = []
    for k in np.argsort(-value, kind="stable").tolist():
        if len(kept) < LAST and all(abs(x[k] - x[m]) + abs(y[k] - y[m]) > APART for m in kept):
            kept.append(k)
    (low, high), (first, last) = (_limit_search(rows, at[kept]) for rows, at in ((ab_samples, x), (dc_samples, y)))

    def of_best(x: Any) -> tuple[Any, Any]:
        """Return the best DC for each AB, with the rating multiplied by -1.

        x: indices of AB on its curve; they may contain the starting points several times over.
        """
        again = len(x) // len(kept)
        return find_minima(lambda y: -score(np.resize(x, len(y)), y), np.tile(first, again), np.tile(last, again))

    x, bad = find_minima(lambda x: of_best(x)[1], low, high)
    return x, of_best(x)[0], -bad


def _limit_search(rows: CurveSamples, at: Any) -> tuple[Any, Any]:
    """Return the lower and the upper end of the search interval around each sample index.

    The interval does not extend beyond the part of the curve to which the sample belongs.
    """
    sample = at.astype(int)
    return np.maximum(at - REACH, rows.low[sample]), np.minimum(at + REACH, rows.high[sample])


# Dyads AB and DC of a four-bar for 2, 3 or 4 coupler positions: from given data, or the best on a curve.


FINE: Final = 1440  # rotations scanned for the pivot nearest to a point
SHORTEST, LONGEST = 0.15, 2.0  # lengths of the links considered, over the size of the task
FAR: Final = 100.0  # over the size: dyads for a given rotation must not extend further
SURE: Final = 1e-6  # rad: a smaller transmission angle is a change point, which no four-bar passes
ROOM: Final = 0.9  # of the box size: frame of a parallelogram
DEFECTS: Final = (  # by their numbers in GuidanceQuality
    N_("none: all positions belong to one assembly and are reached in order"),
    N_("branch defect: some positions belong to the other assembly of the four-bar"),
    N_("order defect: AB does not reach the positions in order while rotating in one direction"),
    N_("circuit defect: AB locks between the positions"),
)
POLE_REASON: Final = N_(
    "point {point} is at rest between these positions, relative to the frame or to the coupler: it is "
    "the pole of the displacement. Choose another point"
)
NO_LINKS: Final = N_(
    "no link with its ends on Burmester's curves has a reasonable length (0.15 to 2 times the largest "
    "distance between the positions)"
)


def find_dyads(task: CouplerPositionsTask) -> tuple[Dyads, Dyads, GuidanceQuality]:
    """Find the dyads AB and DC that satisfy the task.

    Returns:
        Dyad AB, dyad DC and the quality of the four-bar.

    Raises:
        Infeasible: no four-bar satisfies the task, or it has a defect that the task does not accept.
    """
    first, second = solve_both_dyads(task)
    if not min(abs(first.pivot - second.pivot), abs(first.pin - second.pin)) > SAME_POINTS * task.size:
        raise Infeasible(_find_given_key(task, "DC"), _("AB and DC have a common pin or pivot: this is not a four-bar"))
    rating = rate_guidance(task.poses, first, second)
    if rating.defect and not task.keep:
        raise Infeasible("positions", DEFECTS[int(rating.defect)], search=_search_is_quick(task))
    return first, second, rating


def _search_is_quick(task: CouplerPositionsTask) -> bool:
    """Return False if a dyad must be searched for on Burmester's curves.

    The search for the nearest feasible value, which tries many values, would then take too long.
    """
    return len(task.places) < 4 or len(task.sides) == 2 or task.still


def _find_given_key(task: CouplerPositionsTask, name: str) -> str:
    """Return the key of the file that specifies a link (pin, pivot, turn or near); `positions` if none is given."""
    side = task.sides.get(name, DyadData())
    keys = {name[1]: side.pin, name[0]: side.pivot, f"{name}_turn": side.turn, f"{name[0]}_near": side.near}
    return next((key for key, value in keys.items() if value is not None), "positions")


def solve_both_dyads(task: CouplerPositionsTask) -> tuple[Dyads, Dyads]:
    """Return the dyads AB and DC for any number of positions. Raises Infeasible."""
    if len(task.places) < 4:
        return solve_dyad(task, "AB"), solve_dyad(task, "DC")
    if task.still:
        return parallelogram_dyads(task)
    specified = given_dyads(task)
    return (specified["AB"], specified["DC"]) if len(specified) == 2 else best_dyads(task, specified)


def solve_dyad(task: CouplerPositionsTask, name: str) -> Dyads:
    """Return the dyad AB or DC for two or three positions. Raises Infeasible."""
    side, poses = task.sides[name], task.poses
    pin_given = side.pin is not None
    point = name[1] if pin_given else name[0]
    given_point = side.pin if pin_given else side.pivot
    points = poses.on_frame(given_point) if pin_given else poses.in_plane(given_point)
    if np.max(np.abs(np.diff(points))) <= (1 if len(points) == 3 else 2) * SAME_POINTS * task.size:
        raise Infeasible(point, _(POLE_REASON).format(point=point))
    if len(points) == 3:
        other_end = circle_centre(points)
        if not np.isfinite(other_end) or abs(other_end - points[0]) > task.size / SAME_POINTS:
            reason = _(
                "the three positions of {point} lie on a straight line: the other end of the link would be "
                "infinitely far away"
            )
            raise Infeasible(point, reason.format(point=point))
    else:
        if not side.length > abs(points[1] - points[0]) / 2:
            raise Infeasible(name, _("link {name} is too short to reach both positions").format(name=name))
        other_end = point_at_distance(points, side.length, SIDES[side.side])
    fixed = np.asarray(given_point, np.clongdouble)
    return Dyads(other_end, fixed) if pin_given else Dyads(fixed, other_end)


def given_dyads(task: CouplerPositionsTask) -> dict[str, Dyads]:
    """Return the specified dyads for four positions, by name (AB, DC).

    A dyad is specified by its rotation from position 1 to 2, or by a point near its pivot.

    Raises:
        Infeasible: no link of reasonable length satisfies the specification.
    """
    dyads = {
        name: dyads_by_rotation(task.poses, np.asarray(side.turn, np.longdouble), side.branch)
        if side.near is None
        else nearest_dyad(task, name)
        for name, side in task.sides.items()
    }
    for name, candidate in dyads.items():
        if not are_sensible(task, candidate):
            reason = _(
                "no link of reasonable length rotates by this angle from position 1 to 2: as the angle approaches "
                "the rotation of the coupler, the links become infinitely long"
            )
            raise Infeasible(f"{name}_turn", reason, search=_search_is_quick(task))
    return dyads


def nearest_dyad(task: CouplerPositionsTask, name: str) -> Dyads:
    """Return the dyad for four positions whose pivot on the centre-point curve is nearest to the required point.

    Raises:
        Infeasible: no dyad has a reasonable length.
    """
    target = complex(task.sides[name].near)

    def away(turns: Any, branch: int) -> Any:
        dyads = dyads_by_rotation(task.poses, np.asarray(turns, np.longdouble), branch)
        distance = np.abs(np.asarray(dyads.pivot, complex) - target)
        return np.where(are_sensible(task, dyads) & np.isfinite(distance), distance, np.inf)

    grid = -np.pi + 2 * np.pi * (np.arange(FINE) + 0.5) / FINE
    step, minima = grid[1] - grid[0], []
    for branch in (0, 1):
        turn = float(grid[int(np.argmin(away(grid, branch)))])
        turn, distance = find_minima(partial(away, branch=branch), turn - step, turn + step)
        minima.append((distance, turn, branch))
    distance, turn, branch = min(minima)
    if not np.isfinite(distance):
        raise Infeasible(f"{name[0]}_near", NO_LINKS, search=_search_is_quick(task))
    return dyads_by_rotation(task.poses, np.asarray(turn, np.longdouble), branch)


def are_sensible(task: CouplerPositionsTask, dyads: Dyads) -> Any:
    """Return True for each dyad that exists, whose ends are not far from position 1 and whose length is not zero."""
    with np.errstate(all="ignore"):
        reach = np.maximum(np.abs(dyads.pivot - task.poses.places[0]), np.abs(dyads.pin))
        length = np.abs(task.poses.on_frame(dyads.pin)[..., 0] - dyads.pivot)
        return (reach < FAR * task.size) & np.isfinite(length) & (length > SAME_POINTS * task.size)


def best_dyads(task: CouplerPositionsTask, specified: dict[str, Dyads]) -> tuple[Dyads, Dyads]:
    """Return the dyads on Burmester's curves that give the best transmission angle, without defects if possible.

    Args:
        task: required positions.
        specified: dyads that the task determines, by name (AB, DC).

    Raises:
        Infeasible: no links of reasonable length exist, or none have their pivots inside the rectangle.
    """
    first, size = task.poses.places[0], task.size
    frame = max((float(abs(dyad.pivot - first)) for dyad in specified.values()), default=0.0)
    coupler = max((float(abs(dyad.pin)) for dyad in specified.values()), default=0.0)
    box = None if task.within is None else task.outside
    bounds = LinkLimits(SHORTEST * size, LONGEST * size, LONGEST * size + frame, LONGEST * size + coupler, box)
    for loose in (False, True):  # loose: accept positions on different assemblies as a last resort
        rated = best_on_curves(task.poses, size, bounds, specified, loose)
        if rated is None or rated[2] > SURE:
            break
    if rated is not None:
        frame, coupler = float(abs(rated[0].pivot - rated[1].pivot)), float(abs(rated[0].pin - rated[1].pin))
        if bounds.shortest <= min(frame, coupler) and frame <= bounds.frame and coupler <= bounds.coupler:
            return rated[:2]
    if task.within is not None:
        reason = _(
            "the box contains no two pivots for which links, frame and coupler have reasonable lengths. Enlarge the box"
        )
        raise Infeasible("pivots_within", reason, search=False)
    raise Infeasible("positions", NO_LINKS, search=_search_is_quick(task))


def parallelogram_dyads(task: CouplerPositionsTask) -> tuple[Dyads, Dyads]:
    """Return the dyads of a parallelogram linkage for four positions with equal angles of the coupler.

    The origin P of the coupler must move on a circle, and both cranks are equal and parallel to its radius. The frame
    AD is free; it is taken perpendicular to the cranks in the middle of their range.

    Raises:
        Infeasible: the four points P do not lie on a circle.
    """
    origins, angles = task.poses.places, task.poses.angles
    centres = [circle_centre(np.delete(origins, out)) for out in range(4)]
    middle = min(centres, key=lambda z: float(np.nan_to_num(abs(z), nan=np.inf)))
    arms = origins - middle
    radius = abs(arms[0])
    if not (np.isfinite(radius) and radius < FAR * task.size):
        reason = _(
            "the coupler does not rotate and its positions lie on a straight line: the links would be infinitely long"
        )
        raise Infeasible("positions", reason, search=False)
    if np.max(np.abs(np.abs(arms) - radius)) > SAME_POINTS * radius:
        reason = _(
            "the coupler does not rotate, so all its points move on equal circles, but position 4 is not on "
            "the circle through positions 1 to 3"
        )
        raise Infeasible(("positions", 3), reason, search=False)
    turn = float(np.angle(complex(arms[1] / arms[0])))
    for name, side in task.sides.items():
        if side.turn is not None and abs(np.exp(1j * (float(side.turn) - turn)) - 1) > SAME_POINTS:
            reason = _(
                "the coupler does not rotate, so both links must rotate through the same angle: the angle between "
                "positions 1 and 2, measured on the circle through all positions"
            )
            raise Infeasible(f"{name}_turn", reason, (turn, "angle", 0))
    steps = np.mod(np.angle(np.asarray(arms[1:] / arms[:-1], complex)), 2 * np.pi)
    rotation = min(float(steps.sum()), float((steps - 2 * np.pi).sum()), key=abs)
    frame = 1j * arms[0] / radius * np.exp(0.5j * rotation) * min(radius, task.size)
    if task.within is not None:
        low, high = task.within
        frame *= min(1.0, ROOM * min(abs((high - low).real), abs((high - low).imag)) / float(abs(frame)))
        middles = [(low + high) / 2 + sign * frame / 2 for sign in (-1, 1)]
    else:
        middles = [middle + sign * frame / 2 for sign in (-1, 1)]
    pivots = [
        task.sides[name].near if name in task.sides and task.sides[name].near is not None else at
        for name, at in zip(("AB", "DC"), middles, strict=True)
    ]
    first, second = (
        Dyads(a, (a - middle) * unit_vector(-angles[0])) for a in (np.asarray(a, np.clongdouble) for a in pivots)
    )
    return first, second
