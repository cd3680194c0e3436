"""Drawings that are placed beside others on a large sheet, or in a note. They have a heading instead of a frame."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from tmm_cli.drawing.paper.record import AreaMark, CircleMark, Drawing, LineMark, Mark, TextMark
from tmm_cli.drawing.paper.texts import DARK_COLOUR, LINE_SPACING, text_corners, wrap_text
from tmm_cli.mechanics.numerics import Vector
from tmm_cli.mechanics.plans import LANDSCAPE, MARGIN, STRIP, extent, round_scale, sheet_scale

HEADING_SIZE, REMARK_SIZE = 4.2, 3.2  # mm: letters of a heading and of the remarks below it
LEAST_HEADING_WIDTH = 70.0  # mm: a heading is not broken into shorter lines
POINT_SPACING = 1.5  # mm between sample points of a line
LEAST_PAPER = 170.0  # mm: least longest side of a requested paper; its contents cannot be reduced further
HEADING_GAP = 2.5  # mm between a heading and what is below it
MOST_LINES = 3  # of a heading, and of each note

Size = tuple[float, float]


@dataclass(frozen=True)
class SheetPicture(Drawing):
    """A drawing with its heading, cropped to its contents.

    Attributes:
        longest: longest side (mm) for which it was drawn.
        figure: width and height (mm) of the part that grows with `longest`; None: the whole drawing.
        mu: scale, SI units per mm; None if it is not to scale.
        stem: stem of its file name.
        title: its heading, even where headings are not written.
    """

    longest: float = 0.0
    figure: Size | None = None
    mu: float | None = None
    stem: str = ""
    title: str = ""


@dataclass(frozen=True)
class PictureSpace:
    """Space for a drawing on a large sheet or in an explanatory note.

    Attributes:
        longest: longest side (mm) of the figure if it is to scale, otherwise of the paper; None: the usual size.
        most: width and height (mm) of the area for drawings on the sheet.
        written: True if the drawing includes its heading and equations; False if they are in the text of the note.
    """

    longest: float | None
    most: Size = (math.inf, math.inf)
    written: bool = True


_PICTURE_SPACE: ContextVar[PictureSpace | None] = ContextVar("space", default=None)


@contextmanager
def drawing_within(space: PictureSpace) -> Iterator[None]:
    """Make all drawings in this context for a large sheet or a note, so that they fit into the given space.

    Outside such a context each drawing becomes a sheet of its own.
    """
    token = _PICTURE_SPACE.set(space)
    try:
        yield
    finally:
        _PICTURE_SPACE.reset(token)


def on_large_sheet() -> bool:
    """Return True if drawings are currently made for a large sheet or a note, and not as sheets of their own."""
    return _PICTURE_SPACE.get() is not None


def writes_equations() -> bool:
    """Return True if the current drawing is to include its heading and equations."""
    space = _PICTURE_SPACE.get()
    return space is None or space.written


def longest_for(usual: float) -> float:
    """Return the longest side (mm) required of the current drawing; `usual` if no size is required."""
    space = _PICTURE_SPACE.get()
    return usual if space is None or space.longest is None else space.longest


def fits_sheet(width: float, height: float) -> bool:
    """Return True if a drawing of this size (mm), with its heading, fits on the current sheet."""
    return excess_factor(width, height) <= 1.0


def excess_factor(width: float, height: float) -> float:
    """Return the size of a drawing, with its heading, relative to the available space.

    If it exceeds 1, the drawing does not fit. It is 0 for a drawing that becomes a sheet of its own.
    """
    space = _PICTURE_SPACE.get()
    if space is None:
        return 0.0
    heading = MOST_LINES * LINE_SPACING * HEADING_SIZE + HEADING_GAP if space.written else 0.0
    return max(width / space.most[0], (height + heading) / space.most[1])


def choose_paper(points: Sequence[complex], pad: float, paper: Size | None) -> tuple[Size, float]:
    """Choose the paper size (mm) and the scale (SI units per mm) of a drawing.

    Args:
        points: points that must be on the drawing, SI units.
        pad: clearance around them, mm.
        paper: required paper size, mm; None for any size.
    """
    if not on_large_sheet():
        best, mu = sheet_scale(points, pad)
        return paper or best, mu
    if paper is not None:
        factor = max(longest_for(max(paper)), LEAST_PAPER) / max(paper)
        return (factor * paper[0], factor * paper[1]), 1.0
    longest = longest_for(max(LANDSCAPE))
    __, across, up, ___ = extent(points)
    mu, edge = round_scale(across, up, longest, longest), 2 * (MARGIN + pad)
    return (across / mu + edge, up / mu + edge + STRIP), mu


def render_picture(
    marks: Iterable[Mark],
    title: str,
    longest: float,
    figure: Size | None = None,
    mu: float | None = None,
    notes: Sequence[str] = (),
) -> SheetPicture:
    """Crop a drawing to its marks and put its title and notes above it.

    Args:
        marks: marks of the drawing.
        title: heading.
        longest: longest side (mm) for which it was drawn.
        figure: width and height (mm) of the part that grows with `longest`; None: all of it.
        mu: scale, SI units per mm; None if it is not to scale.
        notes: lines below the heading.
    """
    drawn, heading = list(marks), title if writes_equations() else ""
    low, high = bounding_corners(drawn)
    room = max((high - low).real, LEAST_HEADING_WIDTH)
    y = high.imag + HEADING_GAP
    for text, size, bold in reversed([(heading, HEADING_SIZE, True), *((note, REMARK_SIZE, False) for note in notes)]):
        for line in reversed(wrap_text(text, size, room, MOST_LINES, bold=bold)):
            drawn.append(TextMark(complex(low.real, y + LINE_SPACING * size / 2), line, size, DARK_COLOUR, bold=bold))
            y += LINE_SPACING * size
    low, high = bounding_corners(drawn)
    moved = sorted((mark.moved(-low) for mark in drawn), key=lambda mark: mark.z)
    return SheetPicture(((high - low).real, (high - low).imag), tuple(moved), longest, figure, mu, title=title)


def bounding_corners(marks: Iterable[Mark]) -> tuple[complex, complex]:
    """Return the lower left and upper right corners of marks, mm."""
    points = [place for mark in marks for place in mark_corners(mark)] or [0j]
    xs, ys = [z.real for z in points], [z.imag for z in points]
    return complex(min(xs), min(ys)), complex(max(xs), max(ys))


def mark_corners(mark: Mark) -> Sequence[complex]:
    """Return points (mm) whose convex hull contains the mark."""
    match mark:
        case LineMark():
            return mark.places
        case AreaMark():
            return mark.corners
        case CircleMark():
            return [mark.centre + mark.radius * direction for direction in (1, 1j, -1, -1j)]
        case TextMark():
            return text_corners(mark)


def points_covered(marks: Iterable[Mark]) -> Vector:
    """Return closely spaced points (mm) along the lines and in the texts of a drawing."""
    points = [np.zeros(0, complex)]
    for mark in marks:
        low, high = bounding_corners([mark])
        if isinstance(mark, LineMark):
            points += [
                a + (b - a) * np.linspace(0, 1, 2 + int(abs(b - a) / POINT_SPACING)) for a, b in pairwise(mark.places)
            ]
        elif isinstance(mark, TextMark):
            size = high - low
            across, up = (np.linspace(0, length, 2 + int(length / POINT_SPACING)) for length in (size.real, size.imag))
            points.append((low + across[:, None] + 1j * up).ravel())
        else:
            points.append(np.array([low, high, (low + high) / 2]))
    return np.concatenate(points)
