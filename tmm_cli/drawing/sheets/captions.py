"""Captions of drawings: equations below a drawing, and small tables below it or on its right."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from tmm_cli.drawing.paper import (
    DARK_COLOUR,
    GREY_TEXT,
    POINT,
    THIN_COLOUR,
    DrawingSheet,
    OccupiedArea,
    PaperLayout,
    Words,
    excess_factor,
    fits_sheet,
    longest_for,
    on_large_sheet,
    script_width,
    wrap_symbols,
)
from tmm_cli.drawing.sheets.mechanism import Position
from tmm_cli.mechanics.plans import LANDSCAPE, PORTRAIT, drawing_area, extent, round_scale

CAPTION_TEXT = 8.0  # points
CAPTION_LINE, CAPTION_ROW = 4.6, 4.2  # mm: heights of a line and of a row of a table
COLUMN_SPACE, TABLE_GAP = 2.6, 5.0  # mm between columns, and between tables
CAPTION_GAP = 3.0  # mm between the drawing and its caption
DRAWING_PAD = 11.0  # mm about the drawing, for labels
LEAST_DRAWING = 12.0  # mm: a smaller drawing is not reduced further
LABEL_ROOM = 8.0  # mm that labels may extend beyond that
MOST_CAPTION_SHARE = 0.5  # of a sheet: a longer caption gets a sheet of its own
CAPTION_WIDTHS = (
    110.0,
    150.0,
    200.0,
    260.0,
    330.0,
)  # mm: widths that are tried for a caption on a large sheet
OWN_SHEET_GROWTH = 2.5  # times: growth of a drawing that justifies a sheet without the caption
HANGING_INDENT = " " * 8
SHEET_PAPERS = (LANDSCAPE, PORTRAIT)


@dataclass(frozen=True)
class CaptionTable:
    """A small table: column headings, and rows with one cell for each of them."""

    head: tuple[str, ...]
    rows: Sequence[tuple[Words, ...]]

    @property
    def size(self) -> complex:
        """Width + i height of the table, mm, if it is not broken into parts."""
        return complex(sum(self.widths), CAPTION_ROW * (len(self.rows) + 1.5))

    @cached_property
    def widths(self) -> list[float]:
        """Widths of the columns, mm."""
        columns = zip(self.head, *self.rows, strict=True)
        return [max(script_width(words, CAPTION_TEXT * POINT) for words in column) + COLUMN_SPACE for column in columns]


@dataclass(frozen=True)
class DrawingCaption:
    """Text and tables that accompany a drawing.

    Attributes:
        lines: lines of text below the drawing; they are wrapped.
        tables: tables below the text.
        aside: True if the tables are stacked on the right of the drawing instead.
    """

    lines: Sequence[Words] = ()
    tables: Sequence[CaptionTable] = ()
    aside: bool = False

    def space_left(self, low: complex, high: complex) -> complex:
        """Return width + i height (mm) of the space for a drawing that its caption leaves in a field.

        The height is negative if the caption alone is too large for the field.
        """
        lines = CAPTION_GAP + CAPTION_LINE * len(self._wrapped((high - low).real))
        if not self.aside:
            rows = self._rows((high - low).real)
            return high - low - 1j * (lines + (CAPTION_ROW * (rows + 1.5) if rows else 0.0))
        sizes = [table.size for table in self.tables if table.rows]
        room = high - low - 1j * lines - (max((size.real for size in sizes), default=0.0) + TABLE_GAP)
        return room if sum(size.imag for size in sizes) <= room.imag else complex(room.real, -1.0)

    def write(self, sheet: DrawingSheet, low: complex, high: complex) -> None:
        """Write the caption into a field, given by its lower left and upper right corner (mm)."""
        room, across = self.space_left(low, high), (high - low).real
        top = low + 1j * (CAPTION_LINE * len(self._wrapped(across)))
        if not self.aside:
            top = complex(low.real, high.imag - room.imag - CAPTION_GAP)
        for words in self._wrapped(across):
            sheet.text(top - 1j * CAPTION_LINE / 2, words, CAPTION_TEXT)
            top -= 1j * CAPTION_LINE
        rows = self._rows(across)
        top = complex(low.real + room.real + TABLE_GAP, high.imag) if self.aside else top - 0.5j * CAPTION_ROW
        for table in (t for t in self.tables if t.rows):
            column_rows = len(table.rows)
            if not self.aside:
                column_rows = math.ceil(column_rows / math.ceil(column_rows / rows))
            for first in range(0, len(table.rows), column_rows):
                _write_column(sheet, top, table, table.rows[first : first + column_rows])
                top += -1j * table.size.imag if self.aside else table.size.real + TABLE_GAP

    def _wrapped(self, across: float) -> list[Words]:
        return [
            line for words in self.lines for line in wrap_symbols(words, CAPTION_TEXT * POINT, across, HANGING_INDENT)
        ]

    def _rows(self, across: float) -> int:
        """Return the smallest number of rows per part of a table at which all tables fit side by side.

        Longer tables are broken into parts of this number of rows. across: available width, mm.
        """
        tables = [table for table in self.tables if table.rows]
        most = max((len(table.rows) for table in tables), default=0)
        for rows in range(min(most, 3), most):
            wide = sum(math.ceil(len(t.rows) / rows) * (t.size.real + TABLE_GAP) for t in tables) - TABLE_GAP
            if wide <= across:
                return rows
        return most


def _write_column(sheet: DrawingSheet, top: complex, table: CaptionTable, rows: Sequence[tuple[Words, ...]]) -> None:
    """Write some rows of a table below its column headings."""
    for number, row in enumerate((table.head, *rows)):
        at = top - 1j * CAPTION_ROW * (number + (0.4 if number == 0 else 0.7))
        for words, wide in zip(row, table.widths, strict=True):
            sheet.text(at, words, CAPTION_TEXT, colour=GREY_TEXT if number == 0 else DARK_COLOUR)
            at += wide
    sheet.line(
        [top - 1j * CAPTION_ROW, top - 1j * CAPTION_ROW + sum(table.widths) - COLUMN_SPACE],
        THIN_COLOUR,
        0.6,
        blocks=False,
    )


def captioned_sheets(
    position: Position,
    title: str,
    points: Sequence[tuple[complex, complex]],
    beneath: Callable[[float], DrawingCaption],
    **words: str,
) -> tuple[DrawingSheet, DrawingSheet | None]:
    """Begin a sheet for a drawing of a position and write its caption. A long caption is written on a sheet of its own.

    The paper is upright or horizontal, and the tables are below the drawing or beside it, whichever permits the larger
    drawing.

    Args:
        position: the position that is drawn.
        title: title with the field {caption}, and further fields from `words`.
        points: points that must be on the sheet (SI units), each with an offset on paper (mm), which is the same at
            any scale.
        beneath: function that returns the caption for a scale (SI units per mm).
        words: values of further fields of the title.

    Returns:
        The sheet for the drawing, and the sheet with the caption or None.
    """
    name, subject = position.results.problem.title, title.format(caption=position.caption, **words)
    points = [(place, away) for place, away in points if np.isfinite(place + away)] or [(0j, 0j)]
    if on_large_sheet():
        return _captioned_sheet(name, subject, points, _large_sheet_layout(points, beneath)), None

    def with_tables_aside(mu: float) -> DrawingCaption:
        return replace(beneath(mu), aside=True)

    low, high = drawing_area(PORTRAIT)
    alone = _best_layout(points, lambda mu: DrawingCaption())
    best = _best_layout(points, beneath, with_tables_aside)
    if (
        best.mu < OWN_SHEET_GROWTH * alone.mu
        and beneath(1.0).space_left(low, high).imag > (1 - MOST_CAPTION_SHARE) * (high - low).imag
    ):
        return _captioned_sheet(name, subject, points, best), None
    written, further = beneath(alone.mu), DrawingSheet(name, subject, paper=PORTRAIT)
    written.write(further, low + 1j * written.space_left(low, high).imag, high)
    return _captioned_sheet(name, subject, points, alone), further


@dataclass(frozen=True)
class _CaptionedLayout:
    """Layout of a drawing with its caption.

    Attributes:
        paper: width and height of the paper, mm.
        mu: scale, SI units per mm.
        middle: middle of the drawing, measured from the origin of coordinates, mm.
        written: the caption.
    """

    paper: tuple[float, float]
    mu: float
    middle: complex
    written: DrawingCaption


def _best_layout(
    points: Sequence[tuple[complex, complex]], *captions: Callable[[float], DrawingCaption]
) -> _CaptionedLayout:
    """Return the layout in which the drawing is largest. Of several equally good layouts the first is taken."""
    return min(
        (_fit_layout(paper, points, caption_at) for caption_at in captions for paper in SHEET_PAPERS),
        key=lambda placed: placed.mu,
    )


def _large_sheet_layout(
    points: Sequence[tuple[complex, complex]], beneath: Callable[[float], DrawingCaption]
) -> _CaptionedLayout:
    """Return the layout of a drawing with its caption for a large sheet.

    The scale follows from the space allotted to the drawing. The paper is as small as drawing and caption permit.
    """
    longest = longest_for(max(LANDSCAPE))
    _, across, up, __ = extent([place for place, __ in points])
    mu = round_scale(across, up, longest, longest)
    written = beneath(mu)
    _, across, up, middle = extent([place / mu + away for place, away in points])
    most = 10 * longest
    low, edge = drawing_area((0.0, 0.0))

    def height(wide: float) -> float:
        return most - written.space_left(low, low + complex(wide, most)).imag

    sizes = [
        (wide, up + 2 * DRAWING_PAD + height(wide))
        for wide in (max(wide, across + 2 * DRAWING_PAD) for wide in CAPTION_WIDTHS)
    ]
    fitting = [(wide, high) for wide, high in sizes if fits_sheet(wide, high + LABEL_ROOM)]
    if fitting:
        wide, high = min(fitting, key=lambda size: size[0] * size[1])
    else:
        wide, high = min(sizes, key=lambda size: (excess_factor(size[0], size[1] + LABEL_ROOM), size[1]))
    paper = complex(wide, high) + low - edge
    return _CaptionedLayout((paper.real, paper.imag), mu, middle, written)


def _captioned_sheet(
    name: str, subject: str, points: Sequence[tuple[complex, complex]], placed: _CaptionedLayout
) -> DrawingSheet:
    low, high = drawing_area(placed.paper)
    _, across, up, __ = extent([place for place, __ in points])
    on = PaperLayout(placed.paper, placed.mu, 0j, (across / placed.mu, up / placed.mu))
    sheet, room = DrawingSheet(name, subject, room=on), placed.written.space_left(low, high)
    placed.written.write(sheet, low, high)
    sheet.canvas = OccupiedArea(complex(low.real, high.imag - room.imag), complex(low.real + room.real, high.imag))
    sheet.origin = (sheet.canvas.low + sheet.canvas.high) / 2 - placed.middle
    return sheet


def _fit_layout(
    paper: tuple[float, float], points: Sequence[tuple[complex, complex]], written: Callable[[float], DrawingCaption]
) -> _CaptionedLayout:
    """Return the layout with the largest drawing at a round scale that fits on the paper together with the caption."""
    low, high = drawing_area(paper)
    size, across, up, __ = extent([place for place, __ in points])
    mu = round_scale(across, up, (high - low).real, (high - low).imag)
    while True:
        room = written(mu).space_left(low, high) - 2 * DRAWING_PAD * (1 + 1j)
        _, across, up, middle = extent([place / mu + away for place, away in points])
        if (across <= room.real and up <= room.imag) or size / mu < LEAST_DRAWING:
            return _CaptionedLayout(paper, mu, middle, written(mu))
        mu = round_scale(1.01 * mu, 0.0, 1.0, 1.0)
