"""What is written beneath a drawing: equations in lines, and small tables that flow side by side in columns."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from tmm_cli.draw.drawing import POINT
from tmm_cli.draw.labels import Ground
from tmm_cli.draw.mechanism import Position
from tmm_cli.draw.script import Words, width, wrapped
from tmm_cli.draw.sheet import DARK, GREY_TEXT, THIN, Sheet
from tmm_cli.plans.record import LANDSCAPE, PORTRAIT, extent, ground_of, round_scale

TEXT, LINE, ROW = 8.0, 4.6, 4.2  # points of letters; mm of a line, of a row
SPACE, GAP, ABOVE = 2.6, 5.0, 3.0  # mm between columns, between tables, above all of it
PAD, LEAST = 11.0, 12.0  # mm about the drawing, for labels; what is smaller is not made smaller still
MOST = 0.5  # of a sheet: more than this is written on another one
HANGING = " " * 8
PAPERS = (LANDSCAPE, PORTRAIT)


@dataclass(frozen=True)
class Table:
    """A head and rows, all of one length."""

    head: tuple[str, ...]
    rows: Sequence[tuple[Words, ...]]

    @property
    def widths(self) -> list[float]:
        """Of its columns, mm."""
        columns = zip(self.head, *self.rows, strict=True)
        return [max(width(words, TEXT * POINT) for words in column) + SPACE for column in columns]


@dataclass(frozen=True)
class Beneath:
    """Lines (wrapped as needed), and tables below them."""

    lines: Sequence[Words] = ()
    tables: Sequence[Table] = ()

    def height(self, across: float) -> float:
        """What it takes of a sheet whose field is so wide, mm."""
        rows = self._rows(across)
        return ABOVE + LINE * len(self._wrapped(across)) + (ROW * (rows + 1.5) if rows else 0.0)

    def put(self, sheet: Sheet, low: complex, across: float) -> None:
        """Write it; low: the lower left corner of the field."""
        top = low + 1j * (self.height(across) - ABOVE)
        for words in self._wrapped(across):
            sheet.text(top - 1j * LINE / 2, words, TEXT)
            top -= 1j * LINE
        rows = self._rows(across)
        top -= 0.5j * ROW
        for table in (t for t in self.tables if t.rows):
            own = math.ceil(len(table.rows) / math.ceil(len(table.rows) / rows))
            for first in range(0, len(table.rows), own):
                _column(sheet, top, table, table.rows[first : first + own])
                top += sum(table.widths) + GAP

    def _wrapped(self, across: float) -> list[Words]:
        return [line for words in self.lines for line in wrapped(words, TEXT * POINT, across, HANGING)]

    def _rows(self, across: float) -> int:
        """Rows of the longest column at which all columns fit side by side."""
        tables = [table for table in self.tables if table.rows]
        most = max((len(table.rows) for table in tables), default=0)
        for rows in range(min(most, 3), most):
            wide = sum(math.ceil(len(t.rows) / rows) * (sum(t.widths) + GAP) for t in tables) - GAP
            if wide <= across:
                return rows
        return most


def _column(sheet: Sheet, top: complex, table: Table, rows: Sequence[tuple[Words, ...]]) -> None:
    """Some rows of a table under its head."""
    for number, row in enumerate((table.head, *rows)):
        at = top - 1j * ROW * (number + (0.4 if number == 0 else 0.7))
        for words, wide in zip(row, table.widths, strict=True):
            sheet.text(at, words, TEXT, colour=GREY_TEXT if number == 0 else DARK)
            at += wide
    sheet.line([top - 1j * ROW, top - 1j * ROW + sum(table.widths) - SPACE], THIN, 0.6, blocks=False)


def above(
    here: Position, title: str, places: Sequence[tuple[complex, complex]], beneath: Callable[[float], Beneath],
    **words: str,
) -> tuple[Sheet, Sheet | None]:  # fmt: skip
    """A sheet for a drawing with what is written beneath it; on a sheet of its own where that is much.

    places: those of the drawing (SI), each with how far it goes on from there on paper (mm). beneath: at a scale, SI a
    millimetre. The paper is upright or not as the drawing is larger then.
    """
    upright = _field(PORTRAIT)
    apart = beneath(1.0).height(upright.real) > MOST * upright.imag
    kept = (lambda mu: Beneath()) if apart else beneath
    found = [(_scale(paper, places, kept), paper) for paper in PAPERS]
    (mu, middle), paper = min(found, key=lambda one: (one[0][0], one[1][1]))
    (low, high), across = ground_of(paper), _field(paper).real
    name, subject = here.results.problem.title, title.format(caption=here.caption, **words)
    sheet, written = Sheet(name, subject, paper=paper), kept(mu)
    written.put(sheet, low, across)
    sheet.ground = Ground(low + 1j * written.height(across), high)
    sheet.mu = mu
    sheet.origin = (sheet.ground.low + sheet.ground.high) / 2 - middle
    if not apart:
        return sheet, None
    further, written = Sheet(name, subject, paper=PORTRAIT), beneath(mu)
    written.put(further, ground_of(PORTRAIT)[1] - upright.real - 1j * written.height(upright.real), upright.real)
    return sheet, further


def _field(paper: tuple[float, float]) -> complex:
    low, high = ground_of(paper)
    return high - low


def _scale(
    paper: tuple[float, float], places: Sequence[tuple[complex, complex]], beneath: Callable[[float], Beneath]
) -> tuple[float, complex]:
    """The least round scale (SI a millimetre) at which all fits on paper, and the middle of the drawing there, mm."""
    field = _field(paper)
    size, across, up, __ = extent([place for place, __ in places])
    mu = round_scale(across, up, field.real, field.imag)
    while True:
        room = field - 2 * PAD * (1 + 1j) - 1j * beneath(mu).height(field.real)
        _, across, up, middle = extent([place / mu + away for place, away in places])
        if (across <= room.real and up <= room.imag) or size / mu < LEAST:
            return mu, middle
        mu = round_scale(1.01 * mu, 0.0, 1.0, 1.0)
