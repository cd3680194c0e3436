"""The four-bar of best transmission with both dyads on Burmester's curves, wherever on them it is.

Parts of the curves whose links are sensible (for AB: that turns one way through the positions) are laid out with places
about evenly apart, all pairs of places are compared, and every pair that is better than its neighbours is a start: a
pair with a defect too, for what is sound may be a strip between the places. Starts are improved together, the best of
them then by a search of the best DC for every AB: the best transmission is often on a ridge, where two places of the
mechanism are equally bad.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from tmm_cli.roots import least
from tmm_cli.synthesis.coupler_positions.burmester import Dyads, Poses
from tmm_cli.synthesis.coupler_positions.curve import Curve, One, Rows, curve, parts, scanned
from tmm_cli.synthesis.four_bar import sharpest

COUNT: Final = 400  # places on a curve, about
STARTS, ROUNDS = 160, 24  # pairs of places that are improved together, and for how many rounds
LAST: Final = 5  # the best of them, improved alone
APART, REACH = 0.05, 2.0  # steps between places: what differs; how far from them the best is looked for then


@dataclass(frozen=True)
class Limits:
    """Shortest and longest of the links, of the frame and of the coupler (m); how far pivots are outside a box (m)."""

    shortest: float
    link: float
    frame: float
    coupler: float
    outside: Callable[[Any], Any] | None = None


def best(
    poses: Poses, size: float, limits: Limits, given: dict[str, Dyads], loose: bool = False
) -> tuple[Dyads, Dyads, float] | None:  # fmt: skip
    """Dyads AB and DC and how good they are: the least transmission angle (rad), or less than zero where there is a
    defect, or the coupler or frame is not sensible. None where no link is sensible. loose: branches are not asked for.
    """
    whole = curve(poses)
    scans = scanned(whole, size)

    def rows(name: str, order: Poses | None) -> Rows | None:
        found = One(given[name]) if name in given else whole
        return _rows(poses, found, scans, size, limits, order)

    one, other = rows("AB", None if loose else poses), rows("DC", None)
    if one is None and not loose:
        one = rows("AB", None)
    if one is None or other is None:
        return None

    def score(x: Any, y: Any) -> Any:
        return scored(poses, one.at(x), other.at(y), limits, loose)

    table = score(np.arange(len(one.t))[:, None], np.arange(len(other.t))[None, :])
    x, y = _starts(table, one, other)
    x, y, value = _climbed(score, x, y, one, other)
    x, y, value = _finished(score, x, y, value, one, other)
    at = int(np.argmax(value))
    return one.at(x[at : at + 1])[0], other.at(y[at : at + 1])[0], float(value[at])


def _rows(
    poses: Poses, found: Curve, scans: list[Any], size: float, limits: Limits, order: Poses | None
) -> Rows | None:
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

    return parts(found, scans, good, size, COUNT)


def scored(poses: Poses, one: Dyads, other: Dyads, limits: Limits, loose: bool = False) -> Any:
    """Least transmission angles (rad) of four-bars (broadcast together) on the way through the positions; less than
    zero where that cannot be, and the less the farther it is from what can.
    """
    b, c = (np.asarray(poses.on_frame(x.pin), complex) for x in (one, other))
    a, d = (np.asarray(x.pivot, complex) for x in (one, other))
    with np.errstate(all="ignore"):
        l1, l3 = np.abs(b[..., 0] - a), np.abs(c[..., 0] - d)
        turned = np.mod(np.diff(np.angle(b - a[..., None]), axis=-1), 2 * np.pi)
        l2, l4 = np.abs(np.asarray(one.pin - other.pin, complex)), np.abs(a - d)
        start = np.angle((b[..., 0] - a) / (d - a))
        sines = ((c - b) * np.conj(c - d[..., None])).imag / (l2 * l3)[..., None]
        branch = 0.0 if loose else np.maximum(0, -np.maximum(sines.min(-1), -sines.max(-1)))
        value: Any = -np.inf
        for steps in (turned, turned - 2 * np.pi):
            way = steps.sum(-1)
            worst, __ = sharpest((l1, l2, l3, l4), start + np.minimum(way, 0), start + np.maximum(way, 0))
            back = np.maximum(0, np.abs(way) - 2 * np.pi + 1e-12)
            wrong = branch + np.maximum(0, worst - 1) + (0 if loose else back)
            value = np.maximum(value, np.where(wrong > 0, -wrong, np.arccos(np.minimum(worst, 1))))
        unfair: Any = 0.0
        for x, longest in ((l2, limits.coupler), (l4, limits.frame)):
            unfair = unfair + np.maximum(0, np.log(limits.shortest / x)) + np.maximum(0, np.log(x / longest))
        value = np.where(unfair > 0, np.minimum(value, 0) - unfair, value)
    return np.where(np.isfinite(value), value, -99.0)


def _starts(table: Any, one: Rows, other: Rows) -> tuple[Any, Any]:
    """Places (numbers) of pairs that are not worse than their neighbours on the same parts, the best first."""
    top = np.ones(table.shape, bool)
    for axis, rows in enumerate((one, other)):
        values, peak = np.moveaxis(table, axis, 0), np.moveaxis(top, axis, 0)
        same = (rows.low[1:] == rows.low[:-1])[:, None]
        peak[:-1] &= ~same | (values[:-1] >= values[1:])
        peak[1:] &= ~same | (values[1:] >= values[:-1])
    x, y = np.nonzero(top)
    order = np.argsort(-table[x, y], kind="stable")[:STARTS]
    return x[order].astype(float), y[order].astype(float)


def _climbed(score: Any, x: Any, y: Any, one: Rows, other: Rows) -> tuple[Any, Any, Any]:
    """Starts improved together: a small table round each, smaller where its middle is best."""
    shifts = np.linspace(-1.5, 1.5, 7)
    ends = [(rows.low[at.astype(int)], rows.high[at.astype(int)]) for rows, at in ((one, x), (other, y))]
    step = np.ones(len(x))
    for _ in range(ROUNDS):
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


def _finished(score: Any, x: Any, y: Any, value: Any, one: Rows, other: Rows) -> tuple[Any, Any, Any]:
    """The best places that differ, improved: of the best place of DC for every place of AB the best."""
    kept: list[int] = []
    for k in np.argsort(-value, kind="stable").tolist():
        if len(kept) < LAST and all(abs(x[k] - x[m]) + abs(y[k] - y[m]) > APART for m in kept):
            kept.append(k)
    (low, high), (first, last) = (_about(rows, at[kept]) for rows, at in ((one, x), (other, y)))

    def of_best(x: Any) -> tuple[Any, Any]:
        """The best places of DC for places of AB, those of all starts again and again; how bad they are."""
        again = len(x) // len(kept)
        return least(lambda y: -score(np.resize(x, len(y)), y), np.tile(first, again), np.tile(last, again))

    x, bad = least(lambda x: of_best(x)[1], low, high)
    return x, of_best(x)[0], -bad


def _about(rows: Rows, at: Any) -> tuple[Any, Any]:
    """Ends of the ways to both sides of places within which their peak is looked for."""
    here = at.astype(int)
    return np.maximum(at - REACH, rows.low[here]), np.minimum(at + REACH, rows.high[here])
