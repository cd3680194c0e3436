"""Contour lines of values on a grid, and hatching of regions of the grid."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
from contourpy import contour_generator
from numpy.typing import NDArray

from tmm_cli.mechanics.numerics import SAME_POINTS

CORNERS = ((0, 0), (1, 0), (1, 1), (0, 1))  # of a cell, counterclockwise
BorderShare = Callable[[tuple[int, int], tuple[int, int]], float]  # of the way to the next node


def contour_lines(values: NDArray[Any], level: float) -> list[NDArray[Any]]:
    """Return the lines on which values interpolated on a grid equal `level`.

    The points of the lines are grid coordinates, column + i row. There are no lines in cells with an undefined value.

    values: values at the grid nodes, (columns, rows); nan if undefined.
    """
    lines = contour_generator(z=np.ma.masked_invalid(values.T)).lines(level)
    return [points[:, 0] + 1j * points[:, 1] for points in map(np.asarray, lines)]


def region_borders(inside: NDArray[Any], share: BorderShare) -> list[NDArray[Any]]:
    """Return the outlines of a region of a grid as polylines. Their points are grid coordinates, column + i row.

    Args:
        inside: True at the grid nodes inside the region, (columns, rows).
        share: function that returns where the outline crosses the grid edge between two nodes, as a fraction of its
            length.
    """
    pieces = []
    for i, j in _mixed_cells(inside):
        crossed = [place for _, _, place in _crossings(inside, i, j, share)]
        pieces += [(crossed[k], crossed[k + 1]) for k in range(0, len(crossed), 2)]
    return _join_pieces(pieces)


def region_polygons(inside: NDArray[Any], share: BorderShare) -> Iterator[list[complex]]:
    """Yield polygons that together fill a region of a grid. Their corners are grid coordinates, column + i row.

    They are strips of whole cells, and parts of the cells that the outline crosses. The arguments are those of
    `region_borders`.
    """
    whole = inside[:-1, :-1] & inside[1:, :-1] & inside[1:, 1:] & inside[:-1, 1:]
    for j in range(whole.shape[1]):
        ends = np.flatnonzero(np.diff(np.concatenate([[False], whole[:, j], [False]])))
        for first, last in ends.reshape(-1, 2).tolist():
            yield [complex(first, j), complex(last, j), complex(last, j + 1), complex(first, j + 1)]
    for i, j in _mixed_cells(inside):
        crossed = {first_node: place for first_node, _, place in _crossings(inside, i, j, share)}
        corners: list[complex] = []
        for a, b in CORNERS:
            node = (i + a, j + b)
            corners += [complex(*node)] if inside[node] else []
            corners += [crossed[node]] if node in crossed else []
        yield corners


def hatch_polygons(pieces: Sequence[Sequence[complex]], pitch: float) -> list[tuple[complex, complex]]:
    """Return the ends of oblique hatching lines in polygons.

    The lines are `pitch` mm apart. Those of adjacent polygons are continuous.
    """
    along, across = np.exp(0.25j * np.pi), np.exp(0.75j * np.pi)
    spans: dict[int, list[tuple[float, float]]] = {}
    for piece in pieces:
        corners = np.asarray(piece) / along  # in these axes the hatching lines are horizontal
        heights = corners.imag
        for k in range(int(np.ceil(heights.min() / pitch)), int(np.floor(heights.max() / pitch)) + 1):
            crossings = []
            for corner, other in zip(corners, np.roll(corners, -1), strict=True):
                if (corner.imag <= k * pitch) != (other.imag <= k * pitch):
                    crossings.append(
                        float(corner.real + (other - corner).real * (k * pitch - corner.imag) / (other - corner).imag)
                    )
            crossings.sort()
            spans.setdefault(k, []).extend(zip(crossings[::2], crossings[1::2], strict=True))
    lines = []
    for k, intervals in spans.items():
        last: list[float] = []
        for start, end in sorted(intervals):
            if last and start <= last[1] + SAME_POINTS * pitch:
                last[1] = max(last[1], end)
                continue
            if last:
                lines.append((last[0] * along + k * pitch * across, last[1] * along + k * pitch * across))
            last = [start, end]
        if last:
            lines.append((last[0] * along + k * pitch * across, last[1] * along + k * pitch * across))
    return lines


def _mixed_cells(inside: NDArray[Any]) -> list[list[int]]:
    """Return column and row of each grid cell that the outline of the region crosses."""
    corners = [inside[i : i + inside.shape[0] - 1, j : j + inside.shape[1] - 1] for i, j in CORNERS]
    return np.argwhere(np.any(np.stack(corners) != corners[0], axis=0)).tolist()


def _crossings(
    above: NDArray[Any], i: int, j: int, share: BorderShare
) -> Iterator[tuple[tuple[int, int], tuple[int, int], complex]]:
    """Yield the sides of a grid cell that the outline crosses, as (first node, second node, point of intersection)."""
    for k, (a, b) in enumerate(CORNERS):
        c, d = CORNERS[(k + 1) % 4]
        first_node, other = (i + a, j + b), (i + c, j + d)
        if above[first_node] != above[other]:
            low, high = min(first_node, other), max(first_node, other)
            yield first_node, other, complex(*low) + share(low, high) * (complex(*high) - complex(*low))


def _join_pieces(pieces: Sequence[tuple[complex, complex]]) -> list[NDArray[Any]]:
    """Join line segments that have ends in common into polylines."""
    at: dict[complex, list[int]] = {}
    for n, piece in enumerate(pieces):
        for end in piece:
            at.setdefault(end, []).append(n)
    left, lines = set(range(len(pieces))), []
    starts = [n for piece_numbers in at.values() if len(piece_numbers) == 1 for n in piece_numbers]
    for first in [*starts, *range(len(pieces))]:
        if first not in left:
            continue
        left.discard(first)
        first_end, other = pieces[first]
        line = [other, first_end] if len(at[other]) == 1 else [first_end, other]
        while True:
            after = next((n for n in at[line[-1]] if n in left), None)
            if after is None:
                break
            left.discard(after)
            a, b = pieces[after]
            line.append(b if a == line[-1] else a)
        lines.append(np.array(line))
    return lines
