"""What the texts of a drawing cover: other texts, lines, rims of circles, heads of arrows; by how many millimetres.

A text covers what the box of its letters' ink meets. What lies under a filled field on which it is written is hidden,
and so not covered. Nothing here is shared with the code that puts labels where they are.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np

from tmm_cli.drawing.paper import (
    BASELINE_SHARE,
    FONT_UNITS,
    AreaMark,
    CircleMark,
    Drawing,
    LineMark,
    TextMark,
    load_font,
    replace_missing,
    text_corners as box_of,
)

TOUCH = 0.05  # mm: less than a thin line is wide


@dataclass(frozen=True)
class Covered:
    """A text, what it covers (`text`, `head` or `line`), how it looks, and by how much, mm."""

    text: str
    kind: str
    what: str
    depth: float
    at: complex

    def __str__(self) -> str:
        place = f"({self.at.real:.0f}, {self.at.imag:.0f})"
        return f"{self.text!r} at {place} covers {self.kind} {self.what} by {self.depth:.2f} mm"


def covered(drawing: Drawing) -> list[Covered]:
    """All pairs of a text and what it covers."""
    texts = [mark for mark in drawing.marks if isinstance(mark, TextMark)]
    if not texts:
        return []
    boxes, found = np.array([ink(text) for text in texts]), []
    seen = ~_hidden(drawing, boxes)
    for first, second, depth in _meeting(boxes, boxes, 0.0):
        if first < second:
            found.append(Covered(texts[first].text, "text", texts[second].text, depth, texts[first].at))
    for kind, numbers, corners, widths in _inked(drawing):
        deepest: dict[tuple[int, int], float] = {}
        for row, column, depth in _meeting(boxes, corners, widths / 2):
            pair = row, int(numbers[column])
            deepest[pair] = max(deepest.get(pair, 0.0), depth)
        for (row, number), depth in deepest.items():
            if seen[row, number]:
                found.append(Covered(texts[row].text, kind, repr(drawing.marks[number])[:60], depth, texts[row].at))
    for row, number, depth in _rims(drawing, boxes):
        if seen[row, number]:
            found.append(Covered(texts[row].text, "line", "rim of a circle", depth, texts[row].at))
    return found


@cache
def _reach(letter: str, bold: bool, italic: bool) -> tuple[float, float]:
    low, high = load_font(bold, italic).load_char(ord(replace_missing(letter))).bbox[1::2]
    return low / 64 / FONT_UNITS, high / 64 / FONT_UNITS


def ink(mark: TextMark) -> tuple[complex, complex, complex, complex]:
    """Corners of the box that holds the letters themselves: no higher and no lower than they are, mm."""
    reaches = [_reach(letter, mark.bold, mark.italic) for letter in mark.text if letter != " "]
    low, high = min(low for low, __ in reaches), max(high for __, high in reaches)
    first, last, *__ = box_of(mark)
    up = 1j * cmath.rect(mark.size, math.radians(mark.turn))
    base = (0.5 - BASELINE_SHARE) * up
    return first + base + low * up, last + base + low * up, last + base + high * up, first + base + high * up


def _meeting(boxes: Any, figures: Any, width: Any) -> list[tuple[int, int, float]]:
    """Boxes and convex figures (each: number, corners) that meet: box, figure, by how much they would have to be moved
    to be free of each other, of all ways at right angles to a side of either. width: about the figures."""
    apart = np.zeros((len(boxes), len(figures)), bool)
    for part in (np.real, np.imag):
        apart |= part(boxes).min(1)[:, None] > part(figures).max(1) + width
        apart |= part(boxes).max(1)[:, None] < part(figures).min(1) - width
    first, second = np.nonzero(~apart)
    one, other = boxes[first], figures[second]
    least = np.full(len(first), np.inf)
    for shape in (one, other):
        for k in range(shape.shape[1]):
            side = np.roll(shape, -1, 1)[:, k] - shape[:, k]
            normal = (1j * side / np.maximum(np.abs(side), 1e-9))[:, None]
            a, b = (normal.conj() * one).real, (normal.conj() * other).real
            depth = np.minimum(a.max(1) - b.min(1), b.max(1) - a.min(1))
            least = np.where(np.abs(side) > 1e-9, np.minimum(least, depth), least)
    least = least + np.broadcast_to(width, len(figures))[second]
    return [(int(first[k]), int(second[k]), float(least[k])) for k in np.flatnonzero(least > TOUCH)]


def _inked(drawing: Drawing) -> list[tuple[str, Any, Any, Any]]:
    """Segments of lines and outlines, and heads of arrows: numbers of their marks, corners, widths."""
    segments: list[tuple[int, complex, complex, float]] = []
    heads: list[tuple[int, tuple[complex, ...]]] = []
    for number, mark in enumerate(drawing.marks):
        if isinstance(mark, LineMark):
            segments += [(number, a, b, mark.width) for a, b in pairwise(mark.places)]
        elif isinstance(mark, AreaMark):
            if mark.edge is not None:
                around = pairwise((*mark.corners, mark.corners[0]))
                segments += [(number, a, b, mark.width) for a, b in around]
            elif len(mark.corners) == 3:
                heads.append((number, mark.corners))
    found = []
    if segments:
        numbers, starts, ends, widths = (np.array(part) for part in zip(*segments, strict=True))
        found.append(("line", numbers, np.stack([starts, ends], 1), widths))
    if heads:
        numbers, corners = np.array([n for n, __ in heads]), np.array([c for __, c in heads])
        found.append(("head", numbers, corners, np.zeros(len(heads))))
    return found


def _rims(drawing: Drawing, boxes: Any) -> list[tuple[int, int, float]]:
    """Boxes that meet the rims of circles: box, number of the mark, depth."""
    circles = [(n, m.centre, m.radius + m.width / 2) for n, m in enumerate(drawing.marks) if isinstance(m, CircleMark)]
    if not circles:
        return []
    numbers, centres, radii = (np.array(part) for part in zip(*circles, strict=True))
    along = boxes[:, 1] - boxes[:, 0]
    places = (centres - boxes.mean(1)[:, None]) * (along.conj() / np.abs(along))[:, None]
    wide, high = np.abs(along)[:, None] / 2, np.abs(boxes[:, 3] - boxes[:, 0])[:, None] / 2
    off = np.hypot(np.maximum(np.abs(places.real) - wide, 0), np.maximum(np.abs(places.imag) - high, 0))
    farthest = np.hypot(np.abs(places.real) + wide, np.abs(places.imag) + high)
    depth = np.minimum(radii - off, farthest - radii)
    return [(int(r), int(numbers[c]), float(depth[r, c])) for r, c in np.argwhere(depth > TOUCH)]


def _hidden(drawing: Drawing, boxes: Any) -> Any:
    """Whether a mark is hidden from a text, by a filled field about the text that was drawn over the mark."""
    hidden = np.zeros((len(boxes), len(drawing.marks)), bool)
    for number, mark in enumerate(drawing.marks):
        if isinstance(mark, AreaMark):
            corners = np.array(mark.corners)
            sides = np.roll(corners, -1) - corners
            off = (sides.conj()[:, None, None] * (boxes[None] - corners[:, None, None])).imag
            inside = np.all(off > 0, (0, 2)) | np.all(off < 0, (0, 2))
            hidden[inside, :number] = True
    return hidden
