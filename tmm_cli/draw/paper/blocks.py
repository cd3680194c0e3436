"""Blocks of notes and tables on a sheet, and where there is room for them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from tmm_cli.draw.paper.drawing import POINT
from tmm_cli.draw.paper.script import Words, width
from tmm_cli.vectors import Vector

NOTE, CELL = 9.0, 8.0  # points
LINE, ROW = 5.0, 4.3  # mm from a note, and from a row of a table, to the next
EDGE, GUTTER, APART = 2.0, 3.0, 6.0  # mm: inside the frame, between columns, between parts side by side
CLEAR = 4.0  # mm about a block that are free
STEPS = 12  # places along an edge that are tried for a block
PARTS = 4  # of one table side by side, at most


@dataclass(frozen=True)
class Row:
    """Cells of a row of a table; `head`: they are titles of columns."""

    cells: tuple[Words, ...]
    head: bool = False


@dataclass(frozen=True)
class Written:
    """A text of a block; `at`: its left or right end, off the block's lower left corner, mm."""

    at: complex
    words: Words
    size: float
    right: bool = False
    head: bool = False


@dataclass(frozen=True)
class Shape:
    """A block in one of its shapes: its size, texts and lines, mm."""

    size: complex
    texts: tuple[Written, ...]
    lines: tuple[tuple[complex, complex], ...]


@dataclass
class Block:
    """Notes, and a table under them; `numbers`: its last columns, which stand flush right."""

    notes: list[Words] = field(default_factory=list)
    rows: list[Row] = field(default_factory=list)
    numbers: int = 1

    def shapes(self) -> Iterator[Shape]:
        """From the highest on; in others the table goes on beside itself."""
        for parts in range(1, 1 + min(PARTS, max(1, len(self.rows) // 4))):
            yield self._shape(parts)

    def _shape(self, parts: int) -> Shape:
        columns = [
            max(width(cell, CELL * POINT) for cell in column)
            for column in zip(*(r.cells for r in self.rows), strict=True)
        ]
        across = sum(columns) + GUTTER * max(len(columns) - 1, 0)
        beside = list(split(self.rows, parts))
        wide = max([width(note, NOTE * POINT) for note in self.notes] + [len(beside) * (across + APART) - APART])
        rows = max((len(part) for part in beside), default=0)
        under = LINE * len(self.notes)
        size = complex(wide + 2 * EDGE, EDGE + under + ROW * rows + (1.0 if rows and under else 0.0))
        texts = [Written(complex(EDGE, size.imag - 3.5 - LINE * k), note, NOTE) for k, note in enumerate(self.notes)]
        lines = []
        for number, part in enumerate(beside):
            left = EDGE + number * (across + APART)
            for k, row in enumerate(part):
                y = ROW * (rows - k - 0.5) + EDGE / 2
                texts += list(self._cells(row, complex(left, y), columns))
                if row.head:
                    lines.append((complex(left, y - ROW / 2), complex(left + across, y - ROW / 2)))
        return Shape(size, tuple(texts), tuple(lines))

    def _cells(self, row: Row, at: complex, columns: Sequence[float]) -> Iterator[Written]:
        first = len(columns) - self.numbers
        for number, (cell, wide) in enumerate(zip(row.cells, columns, strict=True)):
            right = number >= first
            yield Written(at + wide if right else at, cell, CELL, right, row.head)
            at += wide + GUTTER


def split(rows: Sequence[Row], parts: int) -> Iterator[list[Row]]:
    """Rows in parts about equally long; titles are repeated above what goes on beside."""
    each = math.ceil(len(rows) / parts)
    head: list[Row] = []
    for start in range(0, len(rows), each or 1):
        part = list(rows[start : start + each])
        yield part if part[0].head else [*head, *part]
        head = [row for row in (*head, *part) if row.head][-1:]


def corners(low: complex, high: complex, size: complex) -> Vector:
    """Places for a block in a field, of its lower left corner: corners of the field, then along its edges."""
    room = high - low - size
    if min(room.real, room.imag) < 0:
        return np.zeros(0, complex)
    steps = np.linspace(1, 0, STEPS)
    return low + np.concatenate([
        room.real * np.array([1, 0, 1, 0]) + 1j * room.imag * np.array([0, 0, 1, 1]),
        *(room.real * steps + 1j * y for y in (0, room.imag)),
        *(x + 1j * room.imag * steps for x in (room.real, 0)),
    ])  # fmt: skip


def covered(crowd: Vector, at: Vector, size: complex, about: Vector | float = CLEAR) -> Vector:
    """How many points of what is drawn a block would cover, or come near (mm), at each place."""
    off = crowd[None, :] - at[:, None] - size / 2
    near = (np.abs(off.real) < size.real / 2 + about) & (np.abs(off.imag) < size.imag / 2 + about)
    found: Vector = np.count_nonzero(near, axis=1)
    return found


def roomiest(block: Block, low: complex, high: complex, crowd: Vector) -> tuple[Shape, complex]:
    """The shape and the place of a block in a field in which it covers the least."""
    best: tuple[int, Shape, complex] | None = None
    for shape in block.shapes():
        places = corners(low, high, shape.size)
        counts = covered(crowd, places, shape.size)
        if len(places) and (best is None or counts.min() < best[0]):
            best = int(counts.min()), shape, complex(places[counts.argmin()])
    if best is None:  # larger than the field in each of its shapes
        return next(block.shapes()), low
    return best[1:]


def nearest_free(
    block: Block, low: complex, high: complex, crowd: Vector, fits: Callable[[float, float], bool]
) -> tuple[Shape, complex]:  # fmt: skip
    """The shape and the place of a block in the box about a drawing where it covers nothing, or below or beside it.

    fits: whether there is room for a drawing of this width and height (mm).
    """
    found: list[tuple[bool, float, Shape, complex]] = []
    for shape in block.shapes():
        places = corners(low, high, shape.size)
        free = places[covered(crowd, places, shape.size) == 0] if len(places) else places
        size = high - low
        if len(free):
            return shape, complex(free[0])
        below = complex(max(size.real, shape.size.real), size.imag + CLEAR + shape.size.imag)
        found.append(
            (not fits(below.real, below.imag), below.real * below.imag, shape, low - 1j * (CLEAR + shape.size.imag))
        )
        beside = complex(size.real + CLEAR + shape.size.real, max(size.imag, shape.size.imag))
        at = complex(high.real + CLEAR, high.imag - shape.size.imag)
        found.append((not fits(beside.real, beside.imag), beside.real * beside.imag, shape, at))
    *__, shape, at = min(found, key=lambda one: one[:2])
    return shape, at
