"""Peaks and zeros between the places at which a quantity is known, many variants at once.

Seven neighbours on equal steps h determine a polynomial of degree 6, which is off by h^7 times the seventh derivative
over 7! and less; arrays are (variants, places).
"""

from __future__ import annotations

from collections.abc import Callable
from math import perm

import numpy as np

from tmm_cli.roots import least
from tmm_cli.vectors import Real

WINDOW = 33  # places about a peak
SIDE = 3  # neighbours on either side
FIT = np.linalg.inv(np.vander(np.arange(-SIDE, SIDE + 1.0), increasing=True)).T  # values @ FIT: coefficients
NEWTON = 6
RIVALS = 8  # highest places of what may jump
RIVAL = 0.3  # of its range: a lower peak so far below the highest one is no rival
FACTORS = [[float(perm(power, order)) for power in range(2 * SIDE + 1)] for order in range(3)]  # of derivatives


def _near(y: Real, k: Real) -> tuple[Real, Real]:
    middle = np.clip(k, SIDE, y.shape[1] - SIDE - 1)
    near = np.take_along_axis(y, middle[:, None] + np.arange(-SIDE, SIDE + 1), axis=1)
    return near @ FIT, middle


def value(c: Real, u: Real, order: int = 0) -> Real:
    """A derivative of the polynomials with coefficients c (..., 7) at u steps from their middles."""
    return _at(_derived(c, order), u)


def _derived(c: Real, order: int) -> list[Real]:
    """Coefficients of a derivative, that of the highest power first."""
    return [FACTORS[order][power] * c[..., power] for power in range(2 * SIDE, order - 1, -1)]


def _at(coefficients: list[Real], u: Real) -> Real:
    found, *rest = coefficients
    for coefficient in rest:
        found = found * u + coefficient
    return found


def peak(y: Real) -> Real:
    """The largest value within a window; (variants,)."""
    top, most = np.argmax(y, axis=1), np.max(y, axis=1)
    c, middle = _near(y, top)
    slopes, bends = _derived(c, 1), _derived(c, 2)
    u = np.zeros(len(y))
    with np.errstate(all="ignore"):
        for _ in range(NEWTON):
            bend, last = _at(bends, u), u
            u = np.minimum(np.maximum(u - np.where(bend < 0, _at(slopes, u) / bend, 0.0), -SIDE), SIDE)
            if np.array_equal(u, last):
                break
    found: Real = np.maximum(value(c, u), most)
    return np.where((middle == top) & (np.abs(u) < SIDE), found, most)


def zero(y: Real) -> Real:
    """Where in a window a quantity changes its sign, in steps from its first place; (variants,)."""
    c, middle = _near(y, np.argmin(np.abs(y), axis=1))
    u = np.zeros(len(y))
    with np.errstate(all="ignore"):
        for _ in range(NEWTON):
            step = value(c, u) / value(c, u, 1)
            u = np.clip(u - np.where(np.isfinite(step), step, 0.0), -SIDE, SIDE)
    return middle + u


def highest(curve: Callable[[Real], Real], scan: Real, *, closed: bool) -> float:
    """The largest value of a curve that may jump or bend sharply: closer and closer about its highest places.

    scan: shares of the way at equal steps; closed: the curve goes on after its end as at its beginning.
    """
    y = curve(scan)
    best, step = float(np.nanmax(y)), scan[1] - scan[0]
    middle = scan[peaks_of(y, RIVALS, closed)]
    ends = (middle - step, middle + step) if closed else (np.maximum(middle - step, 0), np.minimum(middle + step, 1))
    __, lowest = least(lambda shares: np.nan_to_num(-curve(shares), nan=np.inf), *ends)
    return max(best, -float(np.min(lowest)))


def peaks_of(y: Real, most: int, closed: bool) -> list[int]:
    """The highest peaks of a curve, on a closed cycle or between two ends, which may be peaks too."""
    before, after = np.roll(y, 1), np.roll(y, -1)
    if not closed:
        before[0] = after[-1] = -np.inf
    found = np.flatnonzero((y >= before) & (y > after))
    if not found.size:
        return [int(np.argmax(y))]
    found = found[np.argsort(-y[found], kind="stable")][:most]
    return [int(k) for k in found if not y[k] < np.max(y) - RIVAL * np.ptp(y)]  # some are kept where not all is known
