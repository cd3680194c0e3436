"""The coefficient k of change of mean speed: from the angle theta between the extreme cranks, and of any curve.

k of a curve is found closely: strokes end where the slope of the output changes its sign. Dwells, in which the slope is
exactly zero, belong to no stroke; where the output all but rests rounding gives the slope one sign and the other, and
the middle of such places is one end. Both as in tmm_cli.kinematics.strokes.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from tmm_cli.roots import bisect
from tmm_cli.vectors import Real


def theta_of(k: Any) -> Any:
    """The angle theta between the extreme cranks, from k."""
    k = np.asarray(k)
    return np.pi * (k - 1) / (k + 1)


def k_of(theta: Any) -> Any:
    """The coefficient k from theta."""
    return (np.pi + theta) / (np.pi - theta)


def ratio(slope: Callable[[Real], Real], shares: Real) -> float:
    """The longer strokes over the shorter; nan where there are none.

    slope: the output's first transfer function at shares of the cycle; shares: all round it, at equal steps.
    """
    y, step = slope(shares), shares[1] - shares[0]
    moves = np.flatnonzero(y)
    after = np.roll(moves, -1)
    back = y[moves] * y[after] < 0
    last, first = moves[back], after[back]
    if not last.size:
        return float("nan")
    still = np.mod(first - last, len(y)) > 1
    before, on = np.sign(y[last]), np.sign(y[first])
    stops = _edges(slope, shares[last], step, before)
    goes_on = 1.0 - _edges(lambda s: slope(1.0 - s), 1.0 - shares[first], step, on)
    middle = stops + (np.mod(goes_on - stops + 0.5, 1.0) - 0.5) / 2
    stops, goes_on = np.where(still, stops, middle), np.where(still, goes_on, middle)
    lengths = np.mod(np.roll(stops, -1) - goes_on, 1.0)
    forward = on > 0
    rise, fall = float(lengths[forward].sum()), float(lengths[~forward].sum())
    return max(rise, fall) / min(rise, fall)


def _edges(slope: Callable[[Real], Real], low: Real, step: float, before: Real) -> Real:
    """Where a slope that has the sign `before` at low has it no more, at most a step farther on."""
    return bisect(lambda shares: np.sign(slope(shares)) == before, low, low + step)[0]
