"""The convex hull of places on paper."""

from __future__ import annotations

import numpy as np


def outline(places: list[complex]) -> list[complex]:
    """The convex hull; the two ends when all lie on a line."""
    places = list(dict.fromkeys(complex(round(p.real, 6), round(p.imag, 6)) for p in places if np.isfinite(p)))
    if len(places) < 3:
        return places or [complex(np.nan, np.nan)]
    ordered = sorted(places, key=lambda p: (p.real, p.imag))

    def half(points: list[complex]) -> list[complex]:
        chain: list[complex] = []
        for p in points:
            while len(chain) > 1 and ((chain[-1] - chain[-2]).conjugate() * (p - chain[-1])).imag <= 1e-3:
                chain.pop()
            chain.append(p)
        return chain[:-1]

    return half(ordered) + half(ordered[::-1])
