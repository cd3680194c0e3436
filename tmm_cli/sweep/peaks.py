"""Peaks of curves round a cycle, of many variants at once, between the places at which they are known."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from tmm_cli.synthesis.optimal.peaks import SIDE, peak
from tmm_cli.vectors import Real

WINDOW, SHARE = 17, 30  # places about a peak, and how many steps of them are one of the scan
SHIFTS = 12  # of a window whose largest value lies at its edge


def near_peaks(curve: Real, level: Real, where: Real) -> tuple[Real, Real]:
    """Peaks of closed curves (variants, places) that may reach a level (variants,) between two places: row and place.

    Between places a curve rises by no more than twice what it rises from one to the next. where: places that count.
    """
    before, after = np.roll(curve, 1, axis=1), np.roll(curve, -1, axis=1)
    with np.errstate(invalid="ignore"):
        rise = np.maximum(curve - before, curve - after)
        found = (curve >= before) & (curve > after) & (curve + 2 * rise >= level[:, None]) & where
    row, place = np.nonzero(found)
    return row, place


def peaks_between(curve: Callable[[Real], Real], q: Real, step: float, values: tuple[Real, Real, Real]) -> Real:
    """The peak of each of many curves about a place q of its own (peaks,), with its values before, there and after.

    curve: values at places (peaks, n), for every curve its own.
    """
    before, here, after = values
    bend = 2 * here - before - after
    with np.errstate(invalid="ignore", divide="ignore"):
        off = np.where(bend > 0, (after - before) / (2 * bend), 0.0)
    middle = q + step * np.clip(off, -1, 1)
    window = step / SHARE * np.arange(-(WINDOW // 2), WINDOW // 2 + 1)
    for _ in range(SHIFTS):
        there = curve(middle[:, None] + window)
        top = np.argmax(there, axis=1)
        edge = (top < SIDE) | (top >= WINDOW - SIDE)
        if not np.any(edge):
            break
        middle = np.where(edge, middle + window[top], middle)
    return np.maximum(here, peak(there))
