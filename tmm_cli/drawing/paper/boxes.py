"""Plane geometry on paper: convex hulls, axis-parallel boxes, line segments."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray


def convex_hull(corners: list[complex]) -> list[complex]:
    """Return the corners of the convex hull of points; for collinear points only the two ends."""
    corners = list(dict.fromkeys(complex(round(p.real, 6), round(p.imag, 6)) for p in corners if np.isfinite(p)))
    if len(corners) < 3:
        return corners or [complex(np.nan, np.nan)]
    ordered = sorted(corners, key=lambda p: (p.real, p.imag))

    def half(points: list[complex]) -> list[complex]:
        chain: list[complex] = []
        for p in points:
            while len(chain) > 1 and ((chain[-1] - chain[-2]).conjugate() * (p - chain[-1])).imag <= 1e-3:
                chain.pop()
            chain.append(p)
        return chain[:-1]

    return half(ordered) + half(ordered[::-1])


# Axis-parallel boxes as arrays (left, right, low, high; mm), and what lies in them.


Box = tuple[float, float, float, float]  # left, right, low, high
Boxes = NDArray[Any]  # (number, 4)
LEAST_STEP = 1e-12  # mm: replaces a zero component of a segment


def box_about(middle: complex, width: float, height: float) -> Box:
    """Return the box (left, right, low, high) with this centre, width and height."""
    return middle.real - width / 2, middle.real + width / 2, middle.imag - height / 2, middle.imag + height / 2


def boxes_about(middles: NDArray[Any], width: float | NDArray[Any], height: float | NDArray[Any]) -> Boxes:
    """Return boxes (left, right, low, high) with these centres, (boxes, 4). Widths and heights may differ."""
    x, y = middles.real, middles.imag
    return np.stack([x - width / 2, x + width / 2, y - height / 2, y + height / 2], axis=1)


def widen(boxes: Boxes, air: float) -> Boxes:
    """Return the boxes enlarged by `air` (mm) on each side."""
    return boxes + air * np.array([-1, 1, -1, 1])


def text_squares(middle: complex, along: complex, width: float, height: float) -> list[complex]:
    """Cover a slanted text with overlapping squares and return their centres.

    Args:
        middle: middle of the text, mm.
        along: unit vector along the text.
        width, height: width and height of the text, mm; the height is the side of the squares.
    """
    reach = max(width - height, 0.0) / 2
    return [middle + share * reach * along for share in np.linspace(-1, 1, max(2, math.ceil(width / height)))]


def nearest_in_boxes(boxes: Boxes, points: NDArray[Any]) -> NDArray[Any]:
    """Return for each point the point of the box with the same index that is nearest to it, (boxes,)."""
    left, right, low, high = boxes.T
    nearest: NDArray[Any] = np.clip(points.real, left, right) + 1j * np.clip(points.imag, low, high)
    return nearest


def box_distances(boxes: Boxes, points: Sequence[complex] | NDArray[Any]) -> NDArray[Any]:
    """Return the distance of every point from every box, shape (boxes, points)."""
    z, (left, right, low, high) = np.asarray(points, complex), boxes.T[:, :, None]
    across = np.maximum(np.maximum(left - z.real, z.real - right), 0)
    distances: NDArray[Any] = np.hypot(across, np.maximum(np.maximum(low - z.imag, z.imag - high), 0))
    return distances


def lengths_inside(boxes: Boxes, starts: NDArray[Any], ends: NDArray[Any]) -> NDArray[Any]:
    """Return the length of every segment inside every box, shape (boxes, segments)."""
    if not len(boxes) or not len(starts):
        return np.zeros((len(boxes), len(starts)))
    first, last = shares_inside(boxes, starts, ends)
    lengths: NDArray[Any] = np.maximum(last - first, 0) * np.abs(ends - starts)
    return lengths


def shares_inside(boxes: Boxes, starts: NDArray[Any], ends: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return where each segment enters and leaves each box, as two arrays (boxes, segments).

    The values are fractions of the length of the segment. If the segment misses the box, the second value is smaller
    than the first.
    """
    span = ends - starts
    left, right, low, high = boxes.T[:, :, None]
    first: Any = 0.0
    last: Any = 1.0
    for least, most, at, step in ((left, right, starts.real, span.real), (low, high, starts.imag, span.imag)):
        per = 1 / np.where(np.abs(step) < LEAST_STEP, LEAST_STEP, step)
        start_share, other = (least - at) * per, (most - at) * per
        first, last = (
            np.maximum(first, np.minimum(start_share, other)),
            np.minimum(last, np.maximum(start_share, other)),
        )
    return first, last


def stretches_outside(points: Sequence[complex], boxes: Boxes) -> Iterator[tuple[complex, ...]]:
    """Yield the parts of a polyline that lie outside all boxes."""
    z = np.asarray(points, complex)
    left, right, low, high = boxes.T
    across, up = (left < z.real.max()) & (right > z.real.min()), (low < z.imag.max()) & (high > z.imag.min())
    boxes = boxes[across & up]
    if not len(boxes):
        yield tuple(points)
        return
    starts, spans = z[:-1], np.diff(z)
    firsts, lasts = shares_inside(boxes, starts, starts + spans)
    stretch: list[complex] = []
    for k, (start, span) in enumerate(zip(starts.tolist(), spans.tolist(), strict=True)):
        met, free = np.flatnonzero(lasts[:, k] > firsts[:, k]), 0.0
        for first, last in sorted(zip(firsts[met, k].tolist(), lasts[met, k].tolist(), strict=True)):
            if first > free:
                yield (*(stretch or [start + free * span]), start + first * span)
            elif len(stretch) > 1:
                yield tuple(stretch)
            stretch, free = [], max(free, last)
        if free < 1:
            stretch = [*(stretch or [start + free * span]), start + span]
    if stretch:
        yield tuple(stretch)


def segments_cross(starts: NDArray[Any], ends: NDArray[Any], firsts: NDArray[Any], lasts: NDArray[Any]) -> NDArray[Any]:
    """Return for each segment and each other segment True if they cross, (segments, others).

    Args:
        starts, ends: ends of the segments.
        firsts, lasts: ends of the other segments.
    """
    span, other = (ends - starts)[:, None], lasts - firsts

    def side(along: NDArray[Any], off: NDArray[Any]) -> NDArray[Any]:
        cross_products: NDArray[Any] = (along.conj() * off).imag
        return cross_products

    parted = side(span, firsts - starts[:, None]) * side(span, lasts - starts[:, None]) < 0
    back = side(other, starts[:, None] - firsts) * side(other, ends[:, None] - firsts) < 0
    crossed: NDArray[Any] = parted & back
    return crossed


def shared_areas(boxes: Boxes, others: Boxes) -> NDArray[Any]:
    """Return the overlapping area (mm²) of each box with each of the other boxes, (boxes, others)."""
    left, right, low, high = boxes.T[:, :, None]
    across = np.minimum(right, others[:, 1]) - np.maximum(left, others[:, 0])
    up = np.minimum(high, others[:, 3]) - np.maximum(low, others[:, 2])
    areas: NDArray[Any] = np.maximum(across, 0) * np.maximum(up, 0)
    return areas


def distance_to_segment(place: complex, start: complex, end: complex) -> float:
    """Return the distance of a point from a line segment."""
    span = end - start
    share = ((place - start) * span.conjugate()).real / (abs(span) ** 2 or 1.0)
    return abs(place - start - min(max(share, 0.0), 1.0) * span)


def distances_to_segments(points: NDArray[Any], starts: NDArray[Any], ends: NDArray[Any]) -> NDArray[Any]:
    """Return the distance of every point from every line segment, shape (points, segments)."""
    span, off = ends - starts, points[:, None] - starts
    share = np.clip((off * span.conj()).real / np.maximum(np.abs(span) ** 2, LEAST_STEP), 0, 1)
    distances: NDArray[Any] = np.abs(off - share * span)
    return distances
