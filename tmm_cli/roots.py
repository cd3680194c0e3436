"""Roots and least values of functions that are computed at many places at once."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from tmm_cli.vectors import Real

HALVINGS = 60  # from a step of a scan to the last bit


def roots(function: Callable[[Real], Real], low: Real, high: Real) -> Real:
    """Roots between places where a function has different signs, by halving all intervals at once."""
    sign_low = np.sign(function(low))
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        same = np.sign(function(middle)) == sign_low
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    return (low + high) / 2


def least(function: Callable[[Real], Real], low: float, high: float) -> tuple[float, float]:
    """Place and value of the least of a function with one minimum: nine places at once, the best third kept."""
    for _ in range(HALVINGS // 2):
        places = np.linspace(low, high, 9)
        best = int(np.argmin(function(places)))
        low, high = places[max(best - 1, 0)], places[min(best + 1, 8)]
    middle = np.array([(low + high) / 2])
    return float(middle[0]), float(function(middle)[0])
