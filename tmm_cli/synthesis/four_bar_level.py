"""Pivots of a four-bar by k that stand as high as D, and the sound one nearest to a place."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np


def level_places(asked: Any) -> list[Any]:
    """Places w (see `four_bar_by_k`) of the pivots A = D + t, t real, from which C1C2 is seen under theta.

    With D in the origin, z = conj(C1 - t)(C2 - t): sin(theta) Re z = +- cos(theta) Im z, a quadratic in t: the line
    through D cuts each of both circles twice. Whether a place is admissible is not asked here.
    """
    l3, middle, half = asked.l3, (asked.psi1 + asked.psi2) / 2, (asked.psi2 - asked.psi1) / 2
    sine, cosine = np.sin(asked.theta), np.cos(asked.theta)
    across, rise = 2 * l3 * np.cos(middle) * np.cos(half), 2 * l3 * np.cos(middle) * np.sin(half)
    c1, c2 = (l3 * (np.cos(psi) + 1j * np.sin(psi)) for psi in (asked.psi1, asked.psi2))
    found = []
    for sign in (-1, 1):
        a, b = sine, sign * cosine * rise - sine * across
        c = l3 * l3 * (sine * np.cos(2 * half) - sign * cosine * np.sin(2 * half))
        inner = b * b - 4 * a * c
        if inner >= 0:
            larger = -(b + np.copysign(np.sqrt(inner), b)) / 2
            found += [larger / a] if a > 0 else []
            found += [c / larger] if larger != 0 else []
    return [(np.abs(c1 - t) + np.abs(c2 - t)) / (2 * l3 * np.abs(np.sin(half))) for t in found]


def nearest_sound(arcs: Sequence[Any], near: complex, limit: float) -> tuple[complex, float]:
    """The pivot nearest to a place of those with a largest pressure angle (rad) of `limit` or less, and its angle; the
    one of best transmission where there is none. arcs: what is found (arrays) along each arc.
    """
    a, pressure = (np.concatenate([np.atleast_1d(getattr(f, name)) for f in arcs]) for name in ("a", "pressure"))
    sound = pressure <= limit
    here = int(np.argmin(np.where(sound, np.abs(a - near), np.inf)) if np.any(sound) else np.argmin(pressure))
    return complex(a[here]), float(pressure[here])
