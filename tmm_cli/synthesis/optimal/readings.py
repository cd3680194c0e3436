"""Reading quantities off values at places: ranges, distances of paths, shares of strokes; for many variants."""

from __future__ import annotations

from functools import reduce
from itertools import product

import numpy as np

from tmm_cli.vectors import Real

MOST_SUMS = 200  # of which the largest counts
SIDE = 0.3  # of its range: a lower peak so far below the highest one is no rival


def swept(angles: Real) -> Real:
    """The range of angles that are told within -pi..pi and lie nearer than pi to the next ones; (variants,)."""
    turns = np.rint(np.diff(angles, axis=1) / (2 * np.pi))
    whole = angles.copy()
    whole[:, 1:] -= 2 * np.pi * np.cumsum(turns, axis=1)
    found: Real = np.max(whole, axis=1) - np.min(whole, axis=1)
    return found


def longest(run: Real, travel: Real, *, turns: bool) -> Real:
    """The longest stroke of a closed curve that goes to and fro several times, (variants,); travel: its whole range.

    turns: it is an angle that is told within -pi..pi.
    """
    step = np.diff(run, axis=1, append=run[:, :1])
    step = (step + np.pi) % (2 * np.pi) - np.pi if turns else step
    stroke, best = np.zeros(len(run)), np.zeros(len(run))
    for k in range(2 * run.shape[1]):  # twice round, for the stroke that goes on over the end
        one = step[:, k % run.shape[1]]
        stroke = np.where(stroke * one >= 0, stroke + one, one)
        best = np.maximum(best, np.abs(stroke))
    return np.minimum(best, travel)


def ends_of(slope: Real) -> Real:
    """How often a curve turns back in a cycle, (variants,); what rests may count twice."""
    sign = np.sign(slope)
    found: Real = np.sum(sign != np.roll(sign, 1, axis=1), axis=1)
    return found


def apart_squared(x: Real, y: Real, point: complex) -> Real:
    """The square of the distance of places from a point."""
    found: Real = (x - point.real) ** 2 + (y - point.imag) ** 2
    return found


def nearest(x: Real, y: Real, wanted: Real, *, closed: bool = True) -> Real:
    """Distances of a polygon (variants, corners) from points, (variants, points).

    Of the corner that is nearest, and of the sides that meet there.
    """
    x, y = np.ascontiguousarray(x), np.ascontiguousarray(y)
    square, rows, corners = (x * x + y * y) / 2, np.arange(len(x)), x.shape[1]
    near, work, other = np.empty((len(wanted), len(x)), dtype=int), np.empty_like(x), np.empty_like(x)
    for k, w in zip(near, wanted, strict=True):  # half the square of the distance, but for w^2, is least there
        np.multiply(x, w.real, out=work)
        np.subtract(square, work, out=work)
        np.multiply(y, w.imag, out=other)
        np.subtract(work, other, out=work)
        np.argmin(work, axis=1, out=k)
    wx, wy = np.real(wanted)[:, None], np.imag(wanted)[:, None]
    px, py = x[rows, near] - wx, y[rows, near] - wy
    best = px * px + py * py
    after = np.where(near + 1 == corners, 0 if closed else near, near + 1)
    for beside in (near - 1 if closed else np.maximum(near - 1, 0), after):
        sx, sy = x[rows, beside] - wx - px, y[rows, beside] - wy - py
        with np.errstate(all="ignore"):
            share = np.minimum(np.maximum(-(px * sx + py * sy) / (sx * sx + sy * sy), 0), 1)
        best = np.fmin(best, (px + share * sx) ** 2 + (py + share * sy) ** 2)
    found: Real = np.sqrt(best).T
    return found


def sums(parts: list[list[Real]]) -> Real:
    """Sums of one quantity of each part, in all ways, (variants, sums): the largest is the sum of the largest ones.

    Where that were too many the largest of a part stands for it.
    """
    kept = [list(part) for part in parts if part]
    while np.prod([len(part) for part in kept]) > MOST_SUMS:
        longest = max(kept, key=len)
        longest[:] = [reduce(np.maximum, longest)]
    return np.stack([np.sum(some, axis=0) for some in product(*kept)], axis=1)


def forward_share(slope: Real) -> Real:
    """Share of the time it moves in which a curve rises, from its slope at equal steps; in a dwell that is zero."""
    after = np.roll(slope, -1, axis=1)
    up, down = np.maximum(slope, 0) + np.maximum(after, 0), np.maximum(-slope, 0) + np.maximum(-after, 0)
    with np.errstate(all="ignore"):
        share = up / (up + down)
        rests = up + down == 0
        if not np.any(rests):
            found: Real = np.mean(share, axis=1)
        else:
            found = np.sum(np.where(rests, 0.0, share), axis=1) / np.sum(~rests, axis=1)
    return found


def ratio_of(share: Real) -> Real:
    """k from the share of one of two strokes: the longer over the shorter."""
    with np.errstate(all="ignore"):
        found: Real = np.maximum(share, 1 - share) / np.minimum(share, 1 - share)
    return found


def peaks_of(y: Real, most: int, closed: bool) -> list[int]:
    """The highest peaks of a curve, on a closed cycle or between two ends, which may be peaks too."""
    before, after = np.roll(y, 1), np.roll(y, -1)
    if not closed:
        before[0] = after[-1] = -np.inf
    found = np.flatnonzero((y >= before) & (y > after))
    if not found.size:
        return [int(np.argmax(y))]
    found = found[np.argsort(-y[found], kind="stable")][:most]
    return [int(k) for k in found if not y[k] < np.max(y) - SIDE * np.ptp(y)]  # some are kept where not all is known
