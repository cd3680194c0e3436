"""A drawing that stands on a large sheet beside others: how large it may be, and what becomes of it there."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from tmm_cli.drawing.paper.fonts import corners
from tmm_cli.drawing.paper.record import Area, Circle, Drawing, Line, Mark, Text
from tmm_cli.drawing.paper.writing import DARK, LINE, wrap
from tmm_cli.mechanics.numerics import Vector
from tmm_cli.mechanics.plans import LANDSCAPE, MARGIN, STRIP, extent, round_scale, sheet_scale

HEAD, NOTE = 4.2, 3.2  # mm: sizes of the letters of a heading and of what is noted below it
NARROW = 70.0  # mm: a heading is not broken into shorter lines
CLOSE = 1.5  # mm between places that stand for a line
LEAST_PAPER = 170.0  # mm: longest side of a paper that is asked for; what is on it cannot be smaller
AIR = 2.5  # mm between a heading and what is below it
MOST = 3  # lines of a heading, and of each note

Size = tuple[float, float]


@dataclass(frozen=True)
class Picture(Drawing):
    """A drawing with its heading, no larger than they are.

    longest: side (mm) that it was drawn for; figure: what of it grows with that (mm), None: all; mu: SI a millimetre,
    None where it is not to scale; stem: its name; title: its heading, also where it is not written.
    """

    longest: float = 0.0
    figure: Size | None = None
    mu: float | None = None
    stem: str = ""
    title: str = ""


@dataclass(frozen=True)
class Space:
    """longest: side (mm) of a figure that is to scale, or of the paper that is asked for; None: as it comes.

    most: width and height (mm) of the field of the sheet. written: headings and equations stand by the drawings; in a
    note its own text has them.
    """

    longest: float | None
    most: Size = (math.inf, math.inf)
    written: bool = True


_SPACE: ContextVar[Space | None] = ContextVar("space", default=None)


@contextmanager
def within(space: Space) -> Iterator[None]:
    """What is drawn meanwhile becomes pictures, without papers of their own."""
    token = _SPACE.set(space)
    try:
        yield
    finally:
        _SPACE.reset(token)


def on_large_sheet() -> bool:
    """Whether what is drawn now is to be a picture beside others."""
    return _SPACE.get() is not None


def written_here() -> bool:
    """Whether what is drawn now has its heading and its equations by it."""
    space = _SPACE.get()
    return space is None or space.written


def longest_for(usual: float) -> float:
    """The longest side (mm) of what is drawn now, where it would be this one."""
    space = _SPACE.get()
    return usual if space is None or space.longest is None else space.longest


def fits(width: float, height: float) -> bool:
    """Whether there is room on the sheet for what is so large (mm) and has a heading, if it is written."""
    return excess(width, height) <= 1.0


def excess(width: float, height: float) -> float:
    """How many times what is so large is larger than the room that there is for it."""
    space = _SPACE.get()
    if space is None:
        return 0.0
    heading = MOST * LINE * HEAD + AIR if space.written else 0.0
    return max(width / space.most[0], (height + heading) / space.most[1])


def paper_for(points: Sequence[complex], pad: float, paper: Size | None) -> tuple[Size, float]:
    """The paper (mm) for points (SI), or one like that which is asked for, and the scale, SI a millimetre."""
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
) -> Picture:
    """What was drawn, cut out of its paper, below its title and notes."""
    drawn, heading = list(marks), title if written_here() else ""
    low, high = extremes(drawn)
    room = max((high - low).real, NARROW)
    y = high.imag + AIR
    for text, size, bold in reversed([(heading, HEAD, True), *((note, NOTE, False) for note in notes)]):
        for line in reversed(wrap(text, size, room, MOST, bold=bold)):
            drawn.append(Text(complex(low.real, y + LINE * size / 2), line, size, DARK, bold=bold))
            y += LINE * size
    low, high = extremes(drawn)
    moved = sorted((mark.moved(-low) for mark in drawn), key=lambda mark: mark.z)
    return Picture(((high - low).real, (high - low).imag), tuple(moved), longest, figure, mu, title=title)


def extremes(marks: Iterable[Mark]) -> tuple[complex, complex]:
    """Corners of the box about marks, mm."""
    places = [place for mark in marks for place in mark_corners(mark)] or [0j]
    xs, ys = [z.real for z in places], [z.imag for z in places]
    return complex(min(xs), min(ys)), complex(max(xs), max(ys))


def mark_corners(mark: Mark) -> Sequence[complex]:
    """Places between which a mark lies, mm."""
    match mark:
        case Line():
            return mark.places
        case Area():
            return mark.corners
        case Circle():
            return [mark.centre + mark.radius * way for way in (1, 1j, -1, -1j)]
        case Text():
            return corners(mark)


def covering(marks: Iterable[Mark]) -> Vector:
    """Places close together on lines and in texts, mm."""
    found = [np.zeros(0, complex)]
    for mark in marks:
        low, high = extremes([mark])
        if isinstance(mark, Line):
            found += [a + (b - a) * np.linspace(0, 1, 2 + int(abs(b - a) / CLOSE)) for a, b in pairwise(mark.places)]
        elif isinstance(mark, Text):
            size = high - low
            across, up = (np.linspace(0, length, 2 + int(length / CLOSE)) for length in (size.real, size.imag))
            found.append((low + across[:, None] + 1j * up).ravel())
        else:
            found.append(np.array([low, high, (low + high) / 2]))
    return np.concatenate(found)
