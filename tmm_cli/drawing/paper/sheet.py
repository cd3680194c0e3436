"""A sheet of paper with true scales, on which lines, areas, arrows, texts, labels and hatching are drawn."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace

import numpy as np

from tmm_cli.drawing.paper.blocks import NoteBlock, PaperLayout, TableRow, free_block_position, least_covering_block
from tmm_cli.drawing.paper.boxes import box_about, stretches_outside, text_squares, widen
from tmm_cli.drawing.paper.labels import Label, place_labels, text_extent as label_extent
from tmm_cli.drawing.paper.occupied_area import TEXT_AIR, OccupiedArea
from tmm_cli.drawing.paper.picture import (
    bounding_corners,
    choose_paper,
    fits_sheet,
    longest_for,
    on_large_sheet,
    points_covered,
    render_picture,
)
from tmm_cli.drawing.paper.record import (
    ARROWHEAD_LENGTH,
    POINT,
    Align,
    AreaMark,
    CircleMark,
    Drawing,
    Layer,
    LineMark,
    Mark,
    Style,
    TextMark,
)
from tmm_cli.drawing.paper.texts import ALIGN_SHARE, DARK_COLOUR, Words, fit_one_line, placed_pieces, script_width
from tmm_cli.language import numeral, spelt
from tmm_cli.mechanics.forces import Symbol
from tmm_cli.mechanics.numerics import unit
from tmm_cli.mechanics.plans import MARGIN, PAD, STRIP, drawing_area, extent
from tmm_cli.mechanics.quantities import Dimension
from tmm_cli.problem import UnitSystem, typeset_unit

THIN_COLOUR = "#8a8a8a"
LOAD_COLOUR = "#b3261e"
INERTIA_COLOUR = "#1f4e9c"
REACTION_COLOUR = "#1d7a3a"
GREY_COLOUR = "#c4c4c4"
NAME_COLOUR = "#7a3d99"  # of links, lines and angles
VECTOR_COLOURS = {
    "absolute": DARK_COLOUR,
    "relative": "#5a5a5a",
    "normal": REACTION_COLOUR,
    "tangential": REACTION_COLOUR,
    "coriolis": LOAD_COLOUR,
    "sliding": INERTIA_COLOUR,
    "load": LOAD_COLOUR,
    "inertia": INERTIA_COLOUR,
    "reaction": REACTION_COLOUR,
    "inner": NAME_COLOUR,
}
GREY_TEXT = "#505050"  # of titles of columns
HATCH_DEPTHS = (0.9, 1.7)  # mm: depths of two lines that represent hatching for label placement
CURVE_EDGE = 4.0  # mm inside the edge of the field: curves are cut there


class DrawingSheet:
    """A sheet of paper that is being drawn on. Positions on paper are in mm.

    Attributes:
        mu: scale, SI units per mm.
        origin: position of the origin of SI coordinates on the paper, mm.
        canvas: field for the drawing, with the lines and texts it already contains.
        marks: marks drawn so far.
        labels: labels that are not placed yet.
        block: notes and table to be placed at the end.
    """

    def __init__(
        self,
        title: str,
        caption: str,
        points: Iterable[complex] = (),
        *,
        pad: float = PAD,
        paper: tuple[float, float] | None = None,
        room: PaperLayout | None = None,
    ) -> None:
        """Begin a sheet. Its size and scale follow from points to be shown, a paper size or a finished layout.

        Args:
            title: title of the project.
            caption: subject of the drawing.
            points: points (SI) that must be on the sheet; they determine scale and orientation.
            pad: clearance around the points, mm.
            paper: width and height (mm) of a sheet whose scale is set later.
            room: layout chosen beforehand; `points`, `pad` and `paper` are then ignored.
        """
        finite = [p for p in points if np.isfinite(p)] or [0j]
        __, across, up, middle = extent(finite)
        self.caption, self.remarks = caption, list[str]()
        self.paper, self.mu = (room.paper, room.mu) if room else choose_paper(finite, pad, paper)
        self.free = room.free if room else paper is not None
        self.figure = room.figure if room else None if paper else (across / self.mu, up / self.mu)
        self.canvas = OccupiedArea(*drawing_area(self.paper))
        self.origin = (self.canvas.low + self.canvas.high) / 2 - middle / self.mu
        if room is not None:
            self.origin = room.origin
        self.marks: list[Mark] = []
        self.faint: list[int] = []  # indices of marks that texts interrupt
        self.parts: list[tuple[str, slice]] = []  # bodies with their marks
        self.layer: Layer = "frame"
        self.labels: list[Label] = []
        self.block = NoteBlock()
        if not on_large_sheet():
            self._write_strip(title)
        self.layer = "construction"

    def _write_strip(self, title: str) -> None:
        """Write title and caption above the drawing."""
        width, height = self.paper
        edge = 1j * (height - MARGIN - STRIP + 5)
        self.line([MARGIN + edge, width - MARGIN + edge], DARK_COLOUR, 0.6, blocks=False)
        shortened, size = fit_one_line(title, 12 * POINT, width - 2 * MARGIN, bold=True)
        self.text(complex(MARGIN, height - MARGIN - 2), shortened, size / POINT, weight="bold")
        shortened, size = fit_one_line(self.caption, 9 * POINT, width - 2 * MARGIN)
        self.text(complex(MARGIN, height - MARGIN - 8), shortened, size / POINT, colour="#404040")

    def on(self, value: complex) -> complex:
        """Convert a point from SI units to paper, mm."""
        return self.origin + value / self.mu

    @property
    def field(self) -> tuple[complex, complex]:
        """Lower left and upper right corner (mm) of the field outside which curves and guides are cut off."""
        return self.canvas.low + CURVE_EDGE * (1 + 1j), self.canvas.high - CURVE_EDGE * (1 + 1j)

    @contextmanager
    def on_layer(self, layer: Layer) -> Iterator[None]:
        """Assign all marks drawn in this context to a layer of the drawing."""
        before, self.layer = self.layer, layer
        yield
        self.layer = before

    @contextmanager
    def part(self, name: str) -> Iterator[None]:
        """Assign all marks drawn in this context to a body that an animation moves.

        A body is a link, a sliding block or a load element such as a spring.
        """
        first = len(self.marks)
        yield
        self.parts.append((name, slice(first, len(self.marks))))

    def text(
        self,
        at: complex,
        text: Words,
        size: float,
        *,
        colour: str = DARK_COLOUR,
        weight: str = "normal",
        ha: Align = "left",
        style: str = "normal",
        turn: float = 0.0,
    ) -> None:
        """Write a text.

        Args:
            at: left end, middle or right end of the text (according to `ha`), at half the height of its letters, mm.
            text: the text; it is never interpreted as markup or mathematics.
            size: font size, points.
            colour: colour of the letters.
            weight: "normal" or "bold".
            ha: alignment.
            style: "normal" or "italic".
            turn: rotation about `at`, counterclockwise, deg.
        """
        bold, italic, along = weight == "bold", style == "italic", complex(unit(np.radians(turn)))
        plain = isinstance(text, str)
        start = complex(at) if plain else at - ALIGN_SHARE[ha] * script_width(text, size * POINT) * along
        for off, letters, letter_size in placed_pieces(text, size * POINT):
            line = "".join(letter if letter.isprintable() else " " for letter in letters)
            if line.strip():
                align: Align = ha if plain else "left"
                self.marks.append(TextMark(start + off * along, line, letter_size, colour, align, bold, italic, turn))
        wide, high = label_extent(text, size)
        middle = complex(at) + (0.5 - ALIGN_SHARE[ha]) * (wide - 0.6) * along
        squares = text_squares(middle, along, wide, high) if turn else []
        self.canvas.boxes += [box_about(place, high, high) for place in squares] or [box_about(middle, wide, high)]

    def label(
        self, text: Words, anchor: complex, size: float = 9, colour: str = DARK_COLOUR, style: str = "normal"
    ) -> None:
        """Request a label for a point (mm). Its position is chosen after everything else has been drawn."""
        if np.isfinite(anchor):
            self.labels.append(Label(text, anchor, size, colour, style))

    def line(
        self,
        points: Sequence[complex],
        colour: str = DARK_COLOUR,
        width: float = 1.0,
        style: Style = "-",
        z: float = 3,
        *,
        blocks: bool = True,
        faint: bool = False,
    ) -> None:
        """Draw a polyline through points (mm). Points that are not finite interrupt it.

        Args:
            points: points, mm.
            colour: colour of the line.
            width: width, points.
            style: line style.
            z: marks with larger z are drawn over those with smaller z.
            blocks: True if labels must not cover it.
            faint: True if labels may cover it; it is then interrupted.
        """
        for stretch in finite_stretches(points):
            if faint:
                self.faint.append(len(self.marks))
            self.marks.append(LineMark(stretch, colour, width * POINT, style, self.layer, z))
            if faint or blocks:
                (self.canvas.faint if faint else self.canvas.solid).path(stretch)

    def area(
        self,
        corners: Sequence[complex],
        face: str,
        edge: str = DARK_COLOUR,
        width: float = 1.0,
        z: float = 2.0,
        *,
        blocks: bool = True,
    ) -> None:
        """Draw a filled polygon.

        Args:
            corners: corners, mm.
            face: colour of the area.
            edge: colour of the outline, or "none".
            width: width of the outline, points.
            z: marks with larger z are drawn over those with smaller z.
            blocks: True if labels must not cover the outline.
        """
        outline = None if edge == "none" else edge
        self.marks.append(AreaMark(tuple(map(complex, corners)), face, outline, width * POINT, self.layer, z))
        if blocks:
            self.canvas.path([*corners, corners[0]])

    def circle(
        self, at: complex, radius: float, face: str = "white", edge: str = DARK_COLOUR, width: float = 1.0, z: float = 6
    ) -> None:
        """Draw a filled circle about a point (mm); nothing if the point is not finite."""
        if np.isfinite(at):
            self.marks.append(CircleMark(complex(at), radius, face, edge, width * POINT, self.layer, z))
            self.canvas.spot(at, radius)

    def arrow(self, start: complex, end: complex, colour: str = DARK_COLOUR, width: float = 1.2, z: float = 5) -> None:
        """Draw an arrow between two points (mm).

        A short arrow has a smaller head, and a very short one is drawn as a dot.
        """
        length = abs(end - start)
        if not np.isfinite(length) or length < 0.15:
            self.circle(end, 0.5, colour, colour, 0.3, z)
            return
        along = (end - start) / length
        head = min(ARROWHEAD_LENGTH, 0.6 * length)
        neck = end - head * along
        side = 1j * along * head * 0.27
        with self.on_layer("vectors" if self.layer == "construction" else self.layer):
            self.line([start, neck + 0.3 * head * along], colour, width, z=z)
            self.area([end, neck + side, neck - side], colour, "none", z=z)

    def note(self, text: Words) -> None:
        """Add a line to the note block, e.g. a scale factor."""
        self.block.notes.append(text)

    def table(self, rows: Iterable[TableRow], numbers: int) -> None:
        """Put a table below the notes. Its last `numbers` columns are aligned right."""
        self.block.rows, self.block.numbers = list(rows), numbers

    def finish(self) -> Drawing:
        """Place the note block and the labels, and return the finished drawing.

        On a large sheet the drawing is cropped and has its caption as a heading.
        """
        self.draw_note_block()
        self.place_requested_labels()
        self._interrupt_faint_lines()
        if on_large_sheet():
            longest = max(self.figure or self.paper)
            if self.free and self.figure:
                longest = longest_for(longest)
            mu = None if self.free else self.mu
            return render_picture(self.marks, self.caption, longest, self.figure, mu, self.remarks)
        return Drawing.of(self.paper, self.marks)

    def _interrupt_faint_lines(self) -> None:
        """Interrupt faint lines where texts cover them."""
        boxes = widen(np.array(self.canvas.boxes), TEXT_AIR)
        for number in reversed(self.faint):
            mark = self.marks[number]
            assert isinstance(mark, LineMark)
            self.marks[number : number + 1] = [
                replace(mark, places=stretch) for stretch in stretches_outside(mark.places, boxes)
            ]
        self.faint.clear()

    def place_requested_labels(self) -> None:
        """Place the requested labels in the current field of the sheet."""
        for placed in place_labels(self.canvas, self.labels):
            label = placed.label
            self.text(placed.middle, label.text, label.size, colour=label.colour, ha="center", style=label.style)
            if placed.leader:
                self.line(placed.leader, THIN_COLOUR, 0.5, z=1.1, faint=True)
        self.labels.clear()

    def text_along(self, at: complex, text: str, size: float, along: complex) -> None:
        """Write a text along a unit vector, with its middle at a point (mm). It is never upside down."""
        turn = float(np.degrees(np.angle(along)))
        turn -= 180 * np.round(turn / 180) if abs(abs(turn) - 90) > 1e-6 else turn - 90
        self.text(at, text, size, ha="center", turn=turn)

    def draw_note_block(self) -> None:
        """Draw the note block where it covers least of the drawing."""
        if not self.block.notes and not self.block.rows:
            return
        if on_large_sheet():
            shape, at = free_block_position(
                self.block, *bounding_corners(self.marks), points_covered(self.marks), fits_sheet
            )
        else:
            crowd = np.concatenate([self.canvas.line_points, self.canvas.faint.points(), self.canvas.text_points])
            shape, at = least_covering_block(self.block, self.canvas.low, self.canvas.high, crowd)
        wide, high = complex(shape.size.real), 1j * shape.size.imag
        self.area([at, at + wide, at + shape.size, at + high], "white", THIN_COLOUR, 0.6, 8, blocks=False)
        for start, end in shape.lines:
            self.line([at + start, at + end], THIN_COLOUR, 0.5, z=8.5, blocks=False)
        for block_text in shape.texts:
            colour = GREY_TEXT if block_text.head else DARK_COLOUR
            self.text(
                at + block_text.at,
                block_text.words,
                block_text.size,
                colour=colour,
                ha="right" if block_text.right else "left",
            )
        self.canvas.boxes.append((at.real, (at + wide).real, at.imag, (at + high).imag))
        self.block = NoteBlock()


def finite_stretches(points: Sequence[complex]) -> Iterator[tuple[complex, ...]]:
    """Yield the parts of a polyline between points that are not finite."""
    array = np.asarray(points, complex)
    finite = np.isfinite(array)
    for stretch in [array] if finite.all() else np.split(array, np.flatnonzero(~finite)):  # most polylines are finite
        kept = stretch[np.isfinite(stretch)]
        if len(kept) > 1:
            yield tuple(kept.tolist())


def draw_hatching(sheet: DrawingSheet, start: complex, end: complex, outward: complex) -> None:
    """Draw hatching on the outer side of a line of the frame. Labels do not cover it.

    Args:
        sheet: sheet to draw on.
        start, end: ends of the line, mm.
        outward: unit vector to the outer side.
    """
    along = (end - start) / abs(end - start)
    number = int(abs(end - start) / 2.0)
    with sheet.on_layer("supports"):
        for k in range(number):
            foot = start + along * (k + 0.5) * abs(end - start) / number
            sheet.line([foot, foot + 1.7 * outward - 1.2 * along], THIN_COLOUR, 0.6, z=2.4, blocks=False)
    for depth in HATCH_DEPTHS:
        sheet.canvas.line(start + depth * outward, end + depth * outward)


def divide_into_cells(
    low: complex, high: complex, columns: int, rows: int, gap: float
) -> tuple[complex, list[tuple[complex, complex]]]:
    """Divide a field into equal cells.

    Args:
        low, high: lower left and upper right corner of the field, mm.
        columns, rows: numbers of columns and rows.
        gap: distance between cells, mm.

    Returns:
        Width + i height of a cell (mm), and lower left and upper right corner of each cell, row by row from the top.
    """
    size = complex(((high - low).real + gap) / columns - gap, ((high - low).imag + gap) / rows - gap)
    step = size + gap * (1 + 1j)
    starts = [
        complex(low.real + column * step.real, high.imag + gap - (row + 1) * step.imag)
        for row in range(rows)
        for column in range(columns)
    ]
    return size, [(start, start + size) for start in starts]


def leave_field(inner: complex, outer: complex, low: complex, high: complex) -> complex:
    """Return the point at which a segment leaves a field.

    Args:
        inner: end of the segment inside the field, mm.
        outer: other end of the segment, mm. If it lies inside the field too, it is returned.
        low, high: lower left and upper right corner of the field, mm.
    """
    span, share = outer - inner, 1.0
    for at, step, least, most in (
        (inner.real, span.real, low.real, high.real),
        (inner.imag, span.imag, low.imag, high.imag),
    ):
        if abs(step) > 1e-12:
            share = min(share, ((most if step > 0 else least) - at) / step)
    return inner + max(share, 0.0) * span


def scale_words(symbol: str, mu: float, unit: str) -> tuple[Symbol, str]:
    """Return the text of a scale factor, e.g. "μ_l = 0.005 m/mm"."""
    return Symbol("μ", symbol), f" = {numeral(mu, '.10g')} {spelt(unit)}"


def with_unit(words: str, dimension: Dimension, units: UnitSystem) -> str:
    """Append the unit of a quantity to its name, e.g. "v_B, m/s"."""
    return ", ".join(piece for piece in (words, typeset_unit(units.spelt(dimension))) if piece)


def file_safe_name(name: str) -> str:
    """Replace characters that are not safe in a file name by underscores."""
    return "".join(c if c.isalnum() or c in "-_" else "_" for c in name)
