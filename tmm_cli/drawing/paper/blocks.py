"""Blocks of notes and tables on a sheet, and the choice of a scale at which figure and block fit on the paper."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import count

import numpy as np

from tmm_cli.drawing.paper.picture import longest_for, on_large_sheet
from tmm_cli.drawing.paper.record import POINT
from tmm_cli.drawing.paper.texts import Words, script_width
from tmm_cli.mechanics.numerics import Vector
from tmm_cli.mechanics.plans import LANDSCAPE, PORTRAIT, ROUND_SCALES, drawing_area, extent, round_scale

NOTE_SIZE, CELL_SIZE = 9.0, 8.0  # points
NOTE_LINE, TABLE_ROW = 5.0, 4.3  # mm: heights of a line of notes and of a row of a table
BLOCK_EDGE = 2.0  # mm between the frame of a block and its text
COLUMN_GAP = 3.0  # mm between columns
PART_GAP = 6.0  # mm between parts of a table side by side
BLOCK_CLEARANCE = 4.0  # mm kept free about a block
EDGE_STEPS = 12  # positions along an edge that are tried for a block
MOST_PARTS = 4  # of one table side by side


@dataclass(frozen=True)
class TableRow:
    """A row of a table.

    Attributes:
        cells: texts of the cells.
        head: True if they are column headings.
    """

    cells: tuple[Words, ...]
    head: bool = False


@dataclass(frozen=True)
class BlockText:
    """A text in a note block.

    Attributes:
        at: left end of the text, or its right end if `right` is set, measured from the lower left corner of the block,
            mm.
        words: the text.
        size: font size, points.
        right: True if the text is aligned right.
        head: True for a column heading.
    """

    at: complex
    words: Words
    size: float
    right: bool = False
    head: bool = False


@dataclass(frozen=True)
class BlockShape:
    """One possible layout of a note block.

    Attributes:
        size: width + i height of the block, mm.
        texts: texts with their positions.
        lines: ends of the lines below column headings, mm.
    """

    size: complex
    texts: tuple[BlockText, ...]
    lines: tuple[tuple[complex, complex], ...]


@dataclass
class NoteBlock:
    """Notes with a table below them.

    Attributes:
        notes: lines of notes.
        rows: rows of the table.
        numbers: number of columns, counted from the right, that are aligned right.
    """

    notes: list[Words] = field(default_factory=list)
    rows: list[TableRow] = field(default_factory=list)
    numbers: int = 1

    def shapes(self) -> Iterator[BlockShape]:
        """Yield the possible layouts of the block, the tallest first.

        In the first layout the table is in one piece. In the others it is broken into parts side by side.
        """
        for parts in range(1, 1 + min(MOST_PARTS, max(1, len(self.rows) // 4))):
            yield self._shape(parts)

    def _shape(self, parts: int) -> BlockShape:
        columns = [
            max(script_width(cell, CELL_SIZE * POINT) for cell in column)
            for column in zip(*(r.cells for r in self.rows), strict=True)
        ]
        across = sum(columns) + COLUMN_GAP * max(len(columns) - 1, 0)
        beside = list(split_rows(self.rows, parts))
        wide = max(
            [script_width(note, NOTE_SIZE * POINT) for note in self.notes]
            + [len(beside) * (across + PART_GAP) - PART_GAP]
        )
        rows = max((len(rows_beside) for rows_beside in beside), default=0)
        under = NOTE_LINE * len(self.notes)
        size = complex(wide + 2 * BLOCK_EDGE, BLOCK_EDGE + under + TABLE_ROW * rows + (1.0 if rows and under else 0.0))
        texts = [
            BlockText(complex(BLOCK_EDGE, size.imag - 3.5 - NOTE_LINE * k), note, NOTE_SIZE)
            for k, note in enumerate(self.notes)
        ]
        lines = []
        for number, rows_beside in enumerate(beside):
            left = BLOCK_EDGE + number * (across + PART_GAP)
            for k, row in enumerate(rows_beside):
                y = TABLE_ROW * (rows - k - 0.5) + BLOCK_EDGE / 2
                texts += list(self._cells(row, complex(left, y), columns))
                if row.head:
                    lines.append((complex(left, y - TABLE_ROW / 2), complex(left + across, y - TABLE_ROW / 2)))
        return BlockShape(size, tuple(texts), tuple(lines))

    def _cells(self, row: TableRow, at: complex, columns: Sequence[float]) -> Iterator[BlockText]:
        first = len(columns) - self.numbers
        for number, (cell, wide) in enumerate(zip(row.cells, columns, strict=True)):
            right = number >= first
            yield BlockText(at + wide if right else at, cell, CELL_SIZE, right, row.head)
            at += wide + COLUMN_GAP


def split_rows(rows: Sequence[TableRow], parts: int) -> Iterator[list[TableRow]]:
    """Split the rows of a table into parts of about equal length.

    Each part begins with the column headings that apply to its rows.
    """
    each = math.ceil(len(rows) / parts)
    head: list[TableRow] = []
    for start in range(0, len(rows), each or 1):
        rows_here = list(rows[start : start + each])
        yield rows_here if rows_here[0].head else [*head, *rows_here]
        head = [row for row in (*head, *rows_here) if row.head][-1:]


def block_positions(low: complex, high: complex, size: complex) -> Vector:
    """Return possible positions of the lower left corner of a block in a field.

    The corners of the field come first, then points along its edges.
    """
    room = high - low - size
    if min(room.real, room.imag) < 0:
        return np.zeros(0, complex)
    steps = np.linspace(1, 0, EDGE_STEPS)
    return low + np.concatenate(
        [
            room.real * np.array([1, 0, 1, 0]) + 1j * room.imag * np.array([0, 0, 1, 1]),
            *(room.real * steps + 1j * y for y in (0, room.imag)),
            *(x + 1j * room.imag * steps for x in (room.real, 0)),
        ]
    )


def count_covered(crowd: Vector, at: Vector, size: complex, about: Vector | float = BLOCK_CLEARANCE) -> Vector:
    """Count the points of a drawing that a block would cover at each possible position.

    Args:
        crowd: points of the drawing, mm.
        at: possible positions of the lower left corner of the block, (positions,), mm.
        size: width + i height of the block, mm.
        about: clearance to be kept around the block, mm; one value, or one for each point.
    """
    off = crowd[None, :] - at[:, None] - size / 2
    near = (np.abs(off.real) < size.real / 2 + about) & (np.abs(off.imag) < size.imag / 2 + about)
    counts: Vector = np.count_nonzero(near, axis=1)
    return counts


def least_covering_block(block: NoteBlock, low: complex, high: complex, crowd: Vector) -> tuple[BlockShape, complex]:
    """Choose the layout of a block and its position in a field so that it covers as few points as possible."""
    best: tuple[int, BlockShape, complex] | None = None
    for shape in block.shapes():
        positions = block_positions(low, high, shape.size)
        counts = count_covered(crowd, positions, shape.size)
        if len(positions) and (best is None or counts.min() < best[0]):
            best = int(counts.min()), shape, complex(positions[counts.argmin()])
    if best is None:  # every layout is larger than the field
        return next(block.shapes()), low
    return best[1:]


def free_block_position(
    block: NoteBlock, low: complex, high: complex, crowd: Vector, fits: Callable[[float, float], bool]
) -> tuple[BlockShape, complex]:
    """Choose the layout of a block and its position so that it covers nothing of the drawing.

    The block is placed in a free area inside the drawing; if there is none, below the drawing or on its right.

    Args:
        block: the block.
        low: lower left corner of the drawing, mm.
        high: upper right corner of the drawing, mm.
        crowd: points of the drawing, mm.
        fits: function that returns True if a drawing of this width and height (mm) fits on the sheet.
    """
    candidates: list[tuple[bool, float, BlockShape, complex]] = []
    for shape in block.shapes():
        positions = block_positions(low, high, shape.size)
        free = positions[count_covered(crowd, positions, shape.size) == 0] if len(positions) else positions
        size = high - low
        if len(free):
            return shape, complex(free[0])
        below = complex(max(size.real, shape.size.real), size.imag + BLOCK_CLEARANCE + shape.size.imag)
        candidates.append(
            (
                not fits(below.real, below.imag),
                below.real * below.imag,
                shape,
                low - 1j * (BLOCK_CLEARANCE + shape.size.imag),
            )
        )
        beside = complex(size.real + BLOCK_CLEARANCE + shape.size.real, max(size.imag, shape.size.imag))
        at = complex(high.real + BLOCK_CLEARANCE, high.imag - shape.size.imag)
        candidates.append((not fits(beside.real, beside.imag), beside.real * beside.imag, shape, at))
    *__, shape, at = min(candidates, key=lambda candidate: candidate[:2])
    return shape, at


# Scale selection: paper, scale and position at which a figure is largest and leaves room for notes and tables.


SHIFT_SHARES = (0.5, 0.0, 1.0, 0.25, 0.75)  # shares of the free width and height at which the figure is placed
FIGURE_SHIFTS = [complex(x, y) for x in SHIFT_SHARES for y in SHIFT_SHARES]
MOST_REDUCTION = 4.0  # times: how far a figure may be reduced to make room for a block
LINE_POINTS = 40  # sample points of a line


@dataclass
class FigureExtent:
    """Points that must be on the paper when a figure is drawn.

    Attributes:
        places: points of the figure, SI units.
        off: offset of each point on paper, mm; it is the same at any scale.
        about: clearance around each point, mm.
    """

    places: list[Vector] = field(default_factory=list)
    off: list[Vector] = field(default_factory=list)
    about: list[Vector] = field(default_factory=list)

    def spots(self, points: Sequence[complex] | Vector, about: float, off: complex = 0j) -> None:
        """Add points (SI units) to the figure, with a clearance and an offset (mm). Undefined points are ignored."""
        finite = np.asarray(points, complex)
        finite = finite[np.isfinite(finite)]
        self.places.append(finite)
        self.off.append(np.full(len(finite), off))
        self.about.append(np.full(len(finite), about))

    def line(self, start: complex, end: complex, about: float, off: complex = 0j) -> None:
        """Add a straight line between two points (SI units) to the figure, with a clearance and an offset (mm)."""
        self.spots(start + (end - start) * np.linspace(0, 1, LINE_POINTS), about, off)


@dataclass(frozen=True)
class PaperLayout:
    """Paper size and scale of a drawing.

    Attributes:
        paper: width and height of the paper, mm.
        mu: scale, SI units per mm.
        origin: position of the origin of coordinates on the paper, mm.
        figure: width and height of the part that is to scale, mm.
        free: True if the drawing has no scale.
    """

    paper: tuple[float, float]
    mu: float
    origin: complex
    figure: tuple[float, float] = (0.0, 0.0)
    free: bool = False


def choose_scale(figure: FigureExtent, block: NoteBlock, also: Sequence[float] = ()) -> PaperLayout:
    """Choose the paper size and the largest round scale at which a figure fits and its note block covers nothing of it.

    On a large sheet the scale follows from the space allotted to the drawing.

    Args:
        figure: points of the figure with their clearances.
        block: notes and table to be placed on the sheet.
        also: scales (SI units per mm) that are allowed besides the round ones.
    """
    points, off, about = (np.concatenate(arrays) for arrays in (figure.places, figure.off, figure.about))
    if on_large_sheet():
        return _tight_layout(points, off, about)
    sizes = [shape.size for shape in block.shapes()]
    alone: PaperLayout | None = None
    for mu in round_scales(extent(points.tolist())[0], also):
        at = points / mu + off
        low = complex((at.real - about).min(), (at.imag - about).min())
        size = complex((at.real + about).max(), (at.imag + about).max()) - low
        for paper in (LANDSCAPE, PORTRAIT) if size.real > size.imag else (PORTRAIT, LANDSCAPE):
            start, end = drawing_area(paper)
            free = end - start - size
            if min(free.real, free.imag) < 0:
                continue
            alone = alone or PaperLayout(paper, mu, start - low + free / 2)
            for shift in FIGURE_SHIFTS:
                origin = start - low + complex(shift.real * free.real, shift.imag * free.imag)
                for block_size in sizes:
                    spots = block_positions(start, end, block_size)
                    if len(spots) and not count_covered(at + origin, spots, block_size, about).all():
                        return PaperLayout(paper, mu, origin)
        if alone is not None and mu > MOST_REDUCTION * alone.mu:
            return alone
    raise AssertionError("some scale is large enough")


def _tight_layout(points: Vector, off: Vector, about: Vector) -> PaperLayout:
    """Return the layout of a drawing for a large sheet.

    Its scale is the largest round one at which the figure fits into the space allotted to it. The paper is no larger
    than the figure with its clearances.
    """
    longest = longest_for(max(LANDSCAPE))
    __, across, up, ___ = extent(points.tolist())
    mu = round_scale(across, up, longest, longest)
    at = points / mu + off
    low = complex((at.real - about).min(), (at.imag - about).min())
    size = complex((at.real + about).max(), (at.imag + about).max()) - low
    start, end = drawing_area((0.0, 0.0))
    paper = size + start - end
    return PaperLayout((paper.real, paper.imag), mu, start - low, (across / mu, up / mu))


def scaleless_layout(
    points: Sequence[complex], pad: float, least: float, below: Callable[[float], float] = lambda width: 0
) -> PaperLayout:
    """Return the layout for a large sheet of a drawing that is not to scale.

    Args:
        points: points of the drawing.
        pad: clearance around them, mm.
        least: smallest width of the paper, mm.
        below: function that returns the height (mm) to be kept free below the drawing for a given width of the paper.
    """
    size, across, up, __ = extent(list(points) or [0j])
    factor = longest_for(max(LANDSCAPE)) / (size or 1.0)
    low, high = drawing_area((0.0, 0.0))
    figure = max(factor * across, 1.0), max(factor * up, 1.0)  # a figure without width needs a scale too
    paper = complex(max(figure[0] + 2 * pad, least), figure[1] + 2 * pad + below(least)) + low - high
    return PaperLayout((paper.real, paper.imag), 1.0, 0j, figure, free=True)


def round_scales(size: float, also: Sequence[float]) -> Iterator[float]:
    """Yield round scales (SI units per mm) in ascending order, so that the figure becomes smaller from one to the next.

    At the first scale the figure is larger than any sheet.
    """
    least = size / max(LANDSCAPE)
    power = math.floor(math.log10(least)) if least > 0 and math.isfinite(least) else 0
    for n in count(power):
        decade = 10.0**n
        yield from sorted([f * decade for f in ROUND_SCALES[:-1]] + [mu for mu in also if decade <= mu < 10 * decade])
