"""Plane geometry on paper: convex hull, axis-parallel boxes, distances to segments."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray


def convex_hull(places: list[complex]) -> list[complex]:
    """Return the corners of the convex hull; only the two ends if all points are collinear."""
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


# Boxes along the axes of the paper, many at once (an array of left, right, low, high; mm), and what is in them.


Box = tuple[float, float, float, float]  # left, right, low, high
Boxes = NDArray[Any]  # (number, 4)
LEAST_STEP = 1e-12  # mm, in the place of no way at all along an axis


def box_about(middle: complex, width: float, height: float) -> Box:
    """Return the box with this centre, width and height."""
    return middle.real - width / 2, middle.real + width / 2, middle.imag - height / 2, middle.imag + height / 2


def boxes_about(middles: NDArray[Any], width: float | NDArray[Any], height: float | NDArray[Any]) -> Boxes:
    """Return boxes with these centres, shape (boxes, 4); width and height may differ from box to box."""
    x, y = middles.real, middles.imag
    return np.stack([x - width / 2, x + width / 2, y - height / 2, y + height / 2], axis=1)


def widen(boxes: Boxes, air: float) -> Boxes:
    """Return the boxes enlarged by `air` on every side."""
    return boxes + air * np.array([-1, 1, -1, 1])


def text_squares(middle: complex, along: complex, width: float, height: float) -> list[complex]:
    """Return centres of squares that together cover a text of this width and height along a unit vector."""
    reach = max(width - height, 0.0) / 2
    return [middle + share * reach * along for share in np.linspace(-1, 1, max(2, math.ceil(width / height)))]


def nearest_in_boxes(boxes: Boxes, places: NDArray[Any]) -> NDArray[Any]:
    """Return the point of each box that is nearest to the corresponding one of `places`."""
    left, right, low, high = boxes.T
    found: NDArray[Any] = np.clip(places.real, left, right) + 1j * np.clip(places.imag, low, high)
    return found


def box_distances(boxes: Boxes, places: Sequence[complex] | NDArray[Any]) -> NDArray[Any]:
    """Return the distance of every point from every box, shape (boxes, points)."""
    z, (left, right, low, high) = np.asarray(places, complex), boxes.T[:, :, None]
    across = np.maximum(np.maximum(left - z.real, z.real - right), 0)
    found: NDArray[Any] = np.hypot(across, np.maximum(np.maximum(low - z.imag, z.imag - high), 0))
    return found


def lengths_inside(boxes: Boxes, starts: NDArray[Any], ends: NDArray[Any]) -> NDArray[Any]:
    """Return the length of every segment inside every box, shape (boxes, segments)."""
    if not len(boxes) or not len(starts):
        return np.zeros((len(boxes), len(starts)))
    first, last = shares_inside(boxes, starts, ends)
    found: NDArray[Any] = np.maximum(last - first, 0) * np.abs(ends - starts)
    return found


def shares_inside(boxes: Boxes, starts: NDArray[Any], ends: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return the parameters (0 to 1) at which every segment enters and leaves every box; exit < entry if it misses."""
    way = ends - starts
    left, right, low, high = boxes.T[:, :, None]
    first: Any = 0.0
    last: Any = 1.0
    for least, most, at, step in ((left, right, starts.real, way.real), (low, high, starts.imag, way.imag)):
        per = 1 / np.where(np.abs(step) < LEAST_STEP, LEAST_STEP, step)
        one, other = (least - at) * per, (most - at) * per
        first, last = np.maximum(first, np.minimum(one, other)), np.minimum(last, np.maximum(one, other))
    return first, last


def stretches_outside(places: Sequence[complex], boxes: Boxes) -> Iterator[tuple[complex, ...]]:
    """Yield the parts of a polyline that lie in none of the boxes."""
    z = np.asarray(places, complex)
    left, right, low, high = boxes.T
    across, up = (left < z.real.max()) & (right > z.real.min()), (low < z.imag.max()) & (high > z.imag.min())
    boxes = boxes[across & up]
    if not len(boxes):
        yield tuple(places)
        return
    starts, ways = z[:-1], np.diff(z)
    firsts, lasts = shares_inside(boxes, starts, starts + ways)
    stretch: list[complex] = []
    for k, (start, way) in enumerate(zip(starts.tolist(), ways.tolist(), strict=True)):
        met, free = np.flatnonzero(lasts[:, k] > firsts[:, k]), 0.0
        for first, last in sorted(zip(firsts[met, k].tolist(), lasts[met, k].tolist(), strict=True)):
            if first > free:
                yield (*(stretch or [start + free * way]), start + first * way)
            elif len(stretch) > 1:
                yield tuple(stretch)
            stretch, free = [], max(free, last)
        if free < 1:
            stretch = [*(stretch or [start + free * way]), start + way]
    if stretch:
        yield tuple(stretch)


def segments_cross(starts: NDArray[Any], ends: NDArray[Any], firsts: NDArray[Any], lasts: NDArray[Any]) -> NDArray[Any]:
    """Return whether each segment crosses each of the other ones, shape (segments, others)."""
    way, other = (ends - starts)[:, None], lasts - firsts

    def side(along: NDArray[Any], off: NDArray[Any]) -> NDArray[Any]:
        found: NDArray[Any] = (along.conj() * off).imag
        return found

    parted = side(way, firsts - starts[:, None]) * side(way, lasts - starts[:, None]) < 0
    back = side(other, starts[:, None] - firsts) * side(other, ends[:, None] - firsts) < 0
    found: NDArray[Any] = parted & back
    return found


def shared_areas(boxes: Boxes, others: Boxes) -> NDArray[Any]:
    """Return the area (mm²) that each box shares with each of the others, shape (boxes, others)."""
    left, right, low, high = boxes.T[:, :, None]
    across = np.minimum(right, others[:, 1]) - np.maximum(left, others[:, 0])
    up = np.minimum(high, others[:, 3]) - np.maximum(low, others[:, 2])
    found: NDArray[Any] = np.maximum(across, 0) * np.maximum(up, 0)
    return found


def distance_to_segment(place: complex, start: complex, end: complex) -> float:
    """Return the distance of a point from a line segment."""
    span = end - start
    share = ((place - start) * span.conjugate()).real / (abs(span) ** 2 or 1.0)
    return abs(place - start - min(max(share, 0.0), 1.0) * span)


def distances_to_segments(places: NDArray[Any], starts: NDArray[Any], ends: NDArray[Any]) -> NDArray[Any]:
    """Return the distance of every point from every line segment, shape (points, segments)."""
    span, off = ends - starts, places[:, None] - starts
    share = np.clip((off * span.conj()).real / np.maximum(np.abs(span) ** 2, LEAST_STEP), 0, 1)
    found: NDArray[Any] = np.abs(off - share * span)
    return found
