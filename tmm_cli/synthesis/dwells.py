"""k of an output that rests between its strokes: dwells belong to neither, as in tmm_cli.strokes."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from tmm_cli.vectors import Real

ROUNDS, PARTS = 9, 32  # of looking closer, and into how many parts each


def ratio(slope: Callable[[Real], Real], shares: Real) -> float | None:
    """The longer strokes over the shorter; None where nothing rests.

    slope: the output's first transfer function at shares of the cycle, exactly zero in a dwell; shares: all round it,
    at equal steps.
    """
    y, step = slope(shares), shares[1] - shares[0]
    moves = np.flatnonzero(y)
    after = np.roll(moves, -1)
    back = y[moves] * y[after] < 0
    last, first = moves[back], after[back]
    still = np.mod(first - last, len(y)) > 1
    if not np.any(still):
        return None
    sign = np.sign(y)
    ends = _edges(slope, np.append(shares[last], shares[first] - step), step, np.append(sign[last], 0 * sign[first]))
    stops, goes_on = np.split(ends, 2)
    goes_on = np.where(still, goes_on, stops)
    lengths = np.mod(np.roll(stops, -1) - goes_on, 1.0)
    forward = y[first] > 0
    rise, fall = float(lengths[forward].sum()), float(lengths[~forward].sum())
    return max(rise, fall) / min(rise, fall)


def _edges(slope: Callable[[Real], Real], low: Real, step: float, before: Real) -> Real:
    """Where a slope that has the sign `before` at low has it no more, at most a step farther on."""
    for _ in range(ROUNDS):
        there = low[:, None] + step * np.arange(PARTS + 1) / PARTS
        same = np.sign(slope(there.ravel())).reshape(there.shape) == before[:, None]
        low = there[np.arange(len(low)), np.maximum(np.argmin(same, axis=1) - 1, 0)]
        step /= PARTS
    return low
