"""Dimension lines and angles as on engineering drawings (GOST 2.307, ISO 129), and rulers with position numbers."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from tmm_cli.drawing.paper.boxes import box_about, boxes_about, distance_to_segment, text_squares
from tmm_cli.drawing.paper.labels import gather_coincident as in_place, text_extent
from tmm_cli.drawing.paper.sheet import GREY_TEXT, NAME_COLOUR, THIN_COLOUR, DrawingSheet
from tmm_cli.drawing.paper.texts import DARK_COLOUR
from tmm_cli.mechanics.numerics import Real, Vector, cross, dot

LINE_OFFSETS = (9.0, 12.0, 16.0, 20.0, 25.0, 30.0, 36.0)  # mm between a dimension line and the measured points
EXTENSION_OVERHANG = 1.8  # mm of an extension line beyond the dimension line
ARROWHEAD_ROOM = 3.0  # mm of a dimension line that are reserved for an arrowhead
DIMENSION_TEXT = 9.0  # points
LEAST_LENGTH = 0.4  # mm: shorter dimensions are not drawn
LARGEST_RADIUS = 45.0  # mm: largest radius of the arc of an angle
INNER_HEADS = 4.2  # arrowheads: shorter dimension lines have them outside the extension lines
LETTER_CLEARANCE = 6.0  # mm kept free about a lettered point for its letter
HEAD_SHARE = 0.25  # of the price of covering with a text: price of covering with an arrowhead
TEXT_POSITION_COSTS = {
    "before": 2.0,
    "after": 1.0,
    "low": 0.5,
    "high": 0.5,
    "wider": 6.0,
}  # price of each position of the text
TEXT_SHARES = {"middle": 0.5, "low": 0.3, "high": 0.7}  # of the length: positions of the text
UPRIGHT_BELOW = 0.3  # horizontal component of the direction of a nearly upright line


def draw_dimension(sheet: DrawingSheet, start: complex, end: complex, text: str, along: complex = 0j) -> None:
    """Draw a dimension line for the distance between two points, where it covers least of the drawing.

    Its text is above the line, or to the left of a vertical line. If the line is too short for that, the text is beyond
    one of its ends, or beside the line if it is nearly vertical.

    Args:
        sheet: sheet to draw on.
        start: first point, mm.
        end: second point, mm.
        text: text of the dimension.
        along: direction of measurement; 0 for the direction from start to end.
    """
    with sheet.on_layer("dimensions"):
        _draw_dimension(sheet, start, end, text, along)


def _draw_dimension(sheet: DrawingSheet, start: complex, end: complex, text: str, along: complex) -> None:
    span = end - start if along == 0 else along * float(dot(end - start, along)) / abs(along) ** 2
    length = abs(span)
    if length < LEAST_LENGTH:
        return
    u = span / length
    crowd = sheet.canvas.line_points
    width, height = text_extent(text, DIMENSION_TEXT)
    tail = 2 * ARROWHEAD_ROOM + 3 + width
    fits = length > 2 * ARROWHEAD_ROOM + 1 and length > width + 3
    inner = length > INNER_HEADS * ARROWHEAD_ROOM
    others = ("after", "before") + ("beside",) * (abs(u.real) < UPRIGHT_BELOW) + ("wider",) * inner
    stands = tuple(TEXT_SHARES) if fits else others

    def lines(side: complex, offset: float, stand: str) -> tuple[complex, complex, complex, complex]:
        """Return both ends of the dimension line, the middle of its text and the direction of the text.

        Args:
            side: unit vector from the measured points to the dimension line.
            offset: distance of the line from these points, mm.
            stand: name of the position of the text: beside the line, beyond its start or end, or a position along it.
        """
        foot = max(dot(z, side) for z in (start, end)) + offset
        first, last = (z + (foot - dot(z, side)) * side for z in (start, end))
        middle = first + TEXT_SHARES.get(stand, 0.5) * (last - first)
        if stand == "beside":
            return first, last, middle + np.sign(side.real) * (width / 2 + 1.0 + height / 2 * abs(u.real)), 1 + 0j
        if stand in ("after", "before"):
            reach = 2 * ARROWHEAD_ROOM + 1.5 + width / 2
            middle = last + u * reach if stand == "after" else first - u * reach
        return first, last, middle + (height / 2 + 0.7) * text_side(u), u

    def least(offset: float, stand: str) -> float:
        return 0.25 * offset + TEXT_POSITION_COSTS.get(stand, 0.0)

    def cost(side: complex, offset: float, stand: str) -> float:
        first, last, middle, v = lines(side, offset, stand)
        outer = 0.0 if inner else 2 * ARROWHEAD_ROOM
        low_run, high_run = (tail if stand == position else outer for position in ("before", "after"))
        stretch = first - (low_run + 1) * u, last + (high_run + 1) * u
        price = 4.0 * sum(distance_to_segment(z, *stretch) < LETTER_CLEARANCE for z in sheet.canvas.rivals)
        legs = [(z, foot + 2 * EXTENSION_OVERHANG * side) for z, foot in ((start, first), (end, last))]
        price += count_beside(crowd, *stretch, 1.5) + sheet.canvas.crossing_price([*legs, stretch])
        price += 0.5 * sum(count_beside(crowd, z + 4 * side, foot, 0.8) for z, foot in ((start, first), (end, last)))
        squares = np.array([*text_squares(middle, v, width, height), first, last])
        prices = sheet.canvas.price(boxes_about(squares, height, height))
        price += float(prices[:-2].sum() + HEAD_SHARE * prices[-2:].sum())
        return price + least(offset, stand)

    choices = [(1j * u * s, o, stand) for o in LINE_OFFSETS for s in (1, -1) for stand in stands]
    (side, offset, stand), price = choices[0], cost(*choices[0])
    for choice in choices[1:]:
        if least(*choice[1:]) < price and (total := cost(*choice)) < price:
            (side, offset, stand), price = choice, total
    first, last, middle, v = lines(side, offset, stand)
    for z, foot in ((start, first), (end, last)):
        if abs(foot - z) > 2.5:
            sheet.line([z + 2 * side, foot + EXTENSION_OVERHANG * side], THIN_COLOUR, 0.6, z=1.4, faint=True)
    if not inner:
        sheet.line([first, last], DARK_COLOUR, 0.6, z=4.5)
    backs = (
        (last, first) if inner else (first - 2 * ARROWHEAD_ROOM * u, last + 2 * ARROWHEAD_ROOM * u)
    )  # arrowheads of short lines point inwards from outside
    for back, tip in zip(backs, (first, last), strict=True):
        sheet.arrow(back, tip, DARK_COLOUR, 0.6, 4.5)
    if stand in ("after", "before"):  # the line continues under the text
        sheet.line([last, last + u * tail] if stand == "after" else [first, first - u * tail], DARK_COLOUR, 0.6, z=4.5)
    sheet.text_along(middle, text, DIMENSION_TEXT, v)


def text_side(u: complex) -> complex:
    """Return the normal of a line on the side of its text: above the line, or to the left of a vertical line."""
    turned = 1j * u
    return turned if turned.imag > 1e-6 or (abs(turned.imag) <= 1e-6 and turned.real < 0) else -turned


def count_beside(crowd: Vector, start: complex, end: complex, width: float) -> int:
    """Count the points of a drawing that lie beside a segment at a distance of at most `width`, on either side."""
    along = (end - start) / abs(end - start)
    run, off = dot(crowd - start, along), np.abs(cross(along, crowd - start))
    return int(np.count_nonzero((run > 0) & (run < abs(end - start)) & (off < width)))


def draw_angle(sheet: DrawingSheet, vertex: complex, first: complex, last: complex, name: str, *, right: bool) -> None:
    """Draw the arc of an angle with its name, or a right-angle mark.

    Args:
        sheet: sheet to draw on.
        vertex: vertex of the angle, mm.
        first, last: a point on each side of the angle, mm.
        name: name of the angle.
        right: True for a right-angle mark.
    """
    with sheet.on_layer("dimensions"):
        _draw_angle(sheet, vertex, first, last, name, right=right)


def _draw_angle(sheet: DrawingSheet, vertex: complex, first: complex, last: complex, name: str, *, right: bool) -> None:
    directions = [(z - vertex) / abs(z - vertex) for z in (first, last)]
    if right:
        corner = 5.4  # larger than a sliding block
        sheet.line(
            [vertex + corner * direction for direction in (directions[0], sum(directions), directions[1])],
            DARK_COLOUR,
            0.8,
            z=3.2,
        )
        return
    turn = float(np.angle(directions[1] / directions[0]))
    if abs(turn) * LARGEST_RADIUS < LEAST_LENGTH:
        return
    room = 0.85 * min(abs(first - vertex), abs(last - vertex))
    radius = float(min(max(9.0, 7.0 / abs(turn)), max(room, 6.0), LARGEST_RADIUS))
    angles = float(np.angle(directions[0])) + np.linspace(0, turn, 30)
    arc = [vertex + radius * complex(z) for z in np.exp(1j * angles)]
    sheet.line(arc, DARK_COLOUR, 0.7, z=2.6)
    for tail, tip in ((arc[8], arc[0]), (arc[-9], arc[-1])):
        if abs(turn) * radius > 7:
            sheet.arrow(tip + (tail - tip) / abs(tail - tip) * 2.2, tip, DARK_COLOUR, 0.5, 4.5)
    sheet.label(name, arc[len(arc) // 2], 9, NAME_COLOUR, "italic")


# Rulers with numbers of positions beside the path of an output, straight or about a pivot.


NUMBER_SIZE = 8.0  # points
TICK_LENGTH = 1.6  # mm
NUMBER_GAP = 0.7  # mm between a tick and its number, and between numbers
PATH_CLEARANCE = 5.6  # mm on both sides of the path, for boxes and rails
RULER_OFFSETS = (0.0, 5.0, 10.0, 15.0)  # mm
ARC_STEP = 1.0  # mm between points of a drawn arc


@dataclass(frozen=True)
class Ruler:
    """A line parallel to the straight or circular path of a point, beside which the numbers of positions are written.

    Attributes:
        base: point of a straight path from which lengths are measured, or centre of a circular path, mm.
        along: unit vector along a straight path, or from the centre of a circular path to the point from which lengths
            are measured.
        off: distance from the path (mm), positive to the left of a straight path or outside a circular one.
        radius: radius of a circular path, mm; 0 for a straight path.
    """

    base: complex
    along: complex
    off: float
    radius: float = 0.0

    def at(self, run: float, out: float = 0.0) -> complex:
        """Return a point of the ruler, mm.

        Args:
            run: length along the path, mm.
            out: distance of the point from the ruler, on the side away from the path, mm.
        """
        if self.radius == 0:
            return self.base + run * self.along + (self.off + out * self.side) * 1j * self.along
        return self.base + (self.radius + self.off + out * self.side) * self.along * cmath.rect(1, run / self.radius)

    @property
    def side(self) -> float:
        return float(np.sign(self.off))

    def path_point(self, run: float) -> complex:
        """Return the point of the path at the length `run` (mm) along it."""
        return replace(self, off=0.0).at(run)

    def away(self, points: Vector) -> Vector:
        """Return the distances of points from the path (mm), positive on the side of the ruler."""
        off = points - self.base
        if self.radius == 0:
            return self.side * np.asarray(dot(1j * self.along, off))
        return self.side * np.asarray(abs(off) - self.radius)

    def run(self, points: Vector | complex) -> Real:
        """Convert points on or near the path to lengths along it, mm."""
        off = points - self.base
        if self.radius == 0:
            return np.asarray(dot(self.along, off))
        return self.radius * np.asarray(np.angle(off / self.along))

    def out(self, run: float) -> complex:
        """Return the unit vector from the path to the ruler, at the length `run` (mm) along the path."""
        step = self.at(run, 1.0) - self.at(run)
        return step / abs(step)


@dataclass(frozen=True)
class RulerNumber:
    """Number of a position, written at a ruler.

    Attributes:
        run: length along the path at which the position is, mm.
        text: the number.
        outer: True if it is written on the side of the ruler away from the path.
        strong: True if it is highlighted, as an extreme position is.
    """

    run: float
    text: str
    outer: bool = True
    strong: bool = False


def fit_ruler(points: Sequence[complex], line: complex, pivot: complex | None) -> Ruler:
    """Return a ruler for the positions of a point on its path (mm).

    The path is a circle about `pivot` if this is given, otherwise a straight line in the direction `line`.
    """
    finite = [place for place in points if np.isfinite(place)]
    if pivot is None:
        middle = sum(finite) / len(finite)
        return Ruler(finite[0] + line * float(dot(line, middle - finite[0])), line, 1.0)
    angles = np.unwrap([cmath.phase(place - pivot) for place in finite])
    return Ruler(pivot, cmath.rect(1, float(angles.max() + angles.min()) / 2), 1.0, abs(finite[0] - pivot))


def numbers_height(ruler: Ruler, numbers: Sequence[RulerNumber]) -> float:
    """Return the greatest extent (mm) of the position numbers perpendicular to the ruler."""
    return max((number_height(ruler, number) for number in numbers), default=0.0)


def number_height(ruler: Ruler, number: RulerNumber) -> float:
    """Return the extent (mm) of a position number perpendicular to the ruler."""
    out, (wide, high) = ruler.out(number.run), text_extent(number.text, NUMBER_SIZE)
    return abs(out.real) * wide + abs(out.imag) * high


def number_width(ruler: Ruler, number: RulerNumber) -> float:
    """Return the extent (mm) of a position number along the ruler, with the gap to the next number."""
    out, (wide, high) = ruler.out(number.run), text_extent(number.text, NUMBER_SIZE)
    return min(wide / max(abs(out.imag), 1e-9), high / max(abs(out.real), 1e-9)) + NUMBER_GAP


def least_crowded_ruler(ruler: Ruler, numbers: Sequence[RulerNumber], lines: Vector) -> Ruler:
    """Choose the side of the path and the distance from it at which the ruler covers the fewest points.

    lines: points of the drawing, mm.
    """
    inner = numbers_height(ruler, [number for number in numbers if not number.outer])
    least = PATH_CLEARANCE + (inner + TICK_LENGTH + 2 * NUMBER_GAP if inner else 0.0)
    choices = [replace(ruler, off=side * (least + more)) for more in RULER_OFFSETS for side in (-1.0, 1.0)]
    return min(choices, key=lambda candidate: count_under_ruler(candidate, numbers, lines) + abs(candidate.off) / 3)


def ruler_reach(ruler: Ruler, numbers: Sequence[RulerNumber]) -> float:
    """Return the distance (mm) from the ruler to the far ends of the position numbers on its outer side."""
    return TICK_LENGTH + NUMBER_GAP + numbers_height(ruler, [number for number in numbers if number.outer])


def count_under_ruler(ruler: Ruler, numbers: Sequence[RulerNumber], lines: Vector) -> float:
    """Count the points of the drawing that a ruler with its numbers would cover.

    The result is infinite if the ruler lies inside a circular path and is too large for it.

    lines: points of the drawing, mm.
    """
    if ruler.radius and ruler.radius + ruler.off < ruler_reach(ruler, numbers) + PATH_CLEARANCE:
        return math.inf
    runs, coordinates, far = [number.run for number in numbers], ruler.run(lines), ruler.away(lines)
    inside = (coordinates > min(runs) - PATH_CLEARANCE) & (coordinates < max(runs) + PATH_CLEARANCE)
    inner = numbers_height(ruler, [number for number in numbers if not number.outer])
    inside &= (far > abs(ruler.off) - inner - TICK_LENGTH - NUMBER_GAP) & (
        far < abs(ruler.off) + ruler_reach(ruler, numbers)
    )
    return float(np.count_nonzero(inside))


def gather_numbers(numbers: Sequence[RulerNumber]) -> list[RulerNumber]:
    """Combine the numbers of coincident positions into one text, e.g. "0, 12".

    If one of these numbers is highlighted, the text is placed at its position.
    """
    gathered = []
    for __, coincident in in_place((complex(number.run, number.outer), number) for number in numbers):
        place = next((number for number in coincident if number.strong), coincident[0])
        gathered.append(replace(place, text=", ".join(number.text for number in coincident)))
    return gathered


def draw_ruler(sheet: DrawingSheet, ruler: Ruler, numbers: Sequence[RulerNumber]) -> None:
    """Draw a ruler with a tick and a number for each position. Numbers that would overlap are moved apart."""
    runs = [number.run for number in numbers]
    steps = max(2, int((max(runs) - min(runs)) / ARC_STEP)) if ruler.radius else 2
    sheet.line([ruler.at(float(run)) for run in np.linspace(min(runs), max(runs), steps)], THIN_COLOUR, 0.7, z=2.6)
    for outer in (True, False):
        row = sorted((n for n in numbers if n.outer == outer), key=lambda n: n.run)
        sign = 1.0 if outer else -1.0
        wide = [number_width(ruler, number) for number in row]
        for number, run in zip(row, spread_intervals([n.run for n in row], wide), strict=True):
            colour = DARK_COLOUR if number.strong else THIN_COLOUR
            foot, tip = ruler.at(number.run), ruler.at(number.run, sign * TICK_LENGTH)
            sheet.line([foot, tip], colour, 1.1 if number.strong else 0.7, z=2.6)
            middle = ruler.at(run, sign * (TICK_LENGTH + NUMBER_GAP + number_height(ruler, number) / 2))
            if abs(run - number.run) > 1.0:
                sheet.line([tip, ruler.at(run, sign * (TICK_LENGTH + NUMBER_GAP))], THIN_COLOUR, 0.4, z=2.6)
            colour = DARK_COLOUR if number.strong else GREY_TEXT
            if sheet.canvas.free(box_about(middle, *text_extent(number.text, NUMBER_SIZE))):
                sheet.text(middle, number.text, NUMBER_SIZE, colour=colour, ha="center")
            else:
                sheet.label(number.text, tip, NUMBER_SIZE, colour)


def spread_intervals(middles: Sequence[float], sizes: Sequence[float]) -> list[float]:
    """Move intervals apart so that they do not overlap.

    Args:
        middles: desired middles of the intervals, ascending.
        sizes: lengths of the intervals.

    Returns:
        Middles as near as possible to the desired ones.
    """
    heaps: list[tuple[float, list[int]]] = []  # start of each group of touching intervals, and the group
    for k in range(len(middles)):
        heap = [k]
        while True:
            ends = np.cumsum([0.0, *(sizes[n] for n in heap)])
            start = float(np.mean([middles[n] - sizes[n] / 2 - end for n, end in zip(heap, ends, strict=False)]))
            if not heaps or heaps[-1][0] + sum(sizes[n] for n in heaps[-1][1]) <= start + 1e-9:
                break
            heap = [*heaps.pop()[1], *heap]
        heaps.append((start, heap))
    spread = []
    for start, heap in heaps:
        for n in heap:
            spread.append(start + sizes[n] / 2)
            start += sizes[n]
    return spread
