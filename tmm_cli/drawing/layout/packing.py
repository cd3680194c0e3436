"""Packing of boxes into the field of a sheet, and its frame and title block. All sizes are in mm."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations, islice
from random import Random

from tmm_cli.drawing.paper import DARK_COLOUR, LineMark, Mark, cell_text
from tmm_cli.language import _
from tmm_cli.problem import SheetTexts

Size = tuple[float, float]
SkylineStep = tuple[float, float, float]  # start, end, depth
RANDOM_ORDERS = 30  # random orders that are tried too (reproducible)
ORDER_SHIFT = 3.0  # most positions by which boxes are shifted in order
THOROUGH_ORDERS = 300  # random orders when the best arrangement is sought


@dataclass(frozen=True)
class PackingField:
    """A rectangular field for boxes, of which the lower right corner is occupied.

    Attributes:
        width, height: size of the field, mm.
        taken: width and height of the title block in the corner, mm.
    """

    width: float
    height: float
    taken: Size = (0.0, 0.0)

    @property
    def area(self) -> float:
        """Free area, mm²."""
        return self.width * self.height - self.taken[0] * self.taken[1]

    def depth(self, start: float, end: float) -> float:
        """Return the height (mm) that is free for a box.

        start, end: distances of the left and the right edge of the box from the left of the field, mm.
        """
        return self.height - (self.taken[1] if end > self.width - self.taken[0] + 1e-9 else 0.0)

    def holds(self, at: Size, size: Size) -> bool:
        """Return True if a box fits into the field.

        at: upper left corner of the box, given by its distances from the left and the top of the field, mm.
        """
        right, low = at[0] + size[0], at[1] + size[1]
        return right <= self.width + 1e-9 and low <= self.depth(at[0], right) + 1e-9


def pack_boxes(
    sizes: Sequence[Size], field: PackingField, *, led: bool = False, tidy: bool = False
) -> list[Size] | None:
    """Pack boxes into a field without overlaps.

    Args:
        sizes: widths and heights of the boxes, mm.
        field: field to pack them into.
        led: True to keep the first box in the upper left corner.
        tidy: True to keep the reading order: no box lies both above and to the left of an earlier one.

    Returns:
        Upper left corner of each box (distances from the left and the top), or None if no packing was found.
    """
    packings = _packings(sizes, field, RANDOM_ORDERS, led=led, tidy=tidy)
    return next((corners for corners in packings if not tidy or not _count_out_of_order(corners)), None)


def arrange_boxes(sizes: Sequence[Size], field: PackingField) -> list[Size] | None:
    """Pack boxes so that they are as nearly as possible in reading order.

    Returns:
        Upper left corner of each box (distances from the left and the top), or None if no packing was found.
    """
    for led in (True, False):
        packings = [
            corners
            for tidy in (True, False)
            for corners in _packings(sizes, field, THOROUGH_ORDERS, led=led, tidy=tidy)
        ]
        if packings:
            return min(packings, key=lambda corners: (_count_out_of_order(corners), _disorder(corners, sizes, field)))
    return None


def _packings(sizes: Sequence[Size], field: PackingField, mixed: int, *, led: bool, tidy: bool) -> Iterator[list[Size]]:
    """Yield packings that fit into the field, as the upper left corners of the boxes.

    Args:
        sizes: widths and heights of the boxes, mm.
        field: field to pack them into.
        mixed: number of random orders in which the boxes are placed.
        led: True to keep the first box in the upper left corner.
        tidy: True if the random orders differ only little from the order of `sizes`.
    """
    if sum(width * height for width, height in sizes) > field.area:
        return
    turned = PackingField(field.height, field.width, field.taken[::-1])
    for order in _orders(sizes, mixed, 1 if led else 0, tidy=tidy):
        corners = _place_in_order(sizes, order, field)
        if corners is not None:
            yield corners
        corners = _place_in_order([(height, width) for width, height in sizes], order, turned)
        if corners is not None:
            yield [(x, y) for y, x in corners]


def _count_out_of_order(corners: Sequence[Size]) -> int:
    """Count the pairs of boxes of which the later one lies both above and to the left of the earlier one."""
    return sum(late[0] <= early[0] and late[1] <= early[1] for early, late in combinations(corners, 2))


def _disorder(corners: Sequence[Size], sizes: Sequence[Size], field: PackingField) -> float:
    """Return a measure of how far an arrangement is from the reading order; 0 if it is in order."""
    middles = [
        (x + width / 2) / field.width + (y + height / 2) / field.height
        for (x, y), (width, height) in zip(corners, sizes, strict=True)
    ]
    return sum(
        (late - early) * max(middles[early] - middles[late], 0.0) for early, late in combinations(range(len(sizes)), 2)
    )


def _orders(sizes: Sequence[Size], mixed: int, kept: int, *, tidy: bool) -> Iterator[Sequence[int]]:
    """Yield orders in which boxes may be placed: as they are, from the largest to the smallest, then random ones.

    The first `kept` boxes come first in every order.
    """
    numbers = range(len(sizes))
    first, rest, chance = numbers[:kept], numbers[kept:], Random(len(sizes))
    yield numbers
    if tidy:
        for __ in range(mixed):
            near = {k: k + ORDER_SHIFT * chance.random() for k in rest}
            yield [*first, *sorted(rest, key=near.__getitem__)]
        return
    keys = (
        lambda k: -sizes[k][1],
        lambda k: -sizes[k][0] * sizes[k][1],
        lambda k: -sizes[k][0],
        lambda k: -sum(sizes[k]),
    )
    for key in keys:
        yield [*first, *sorted(rest, key=key)]
    yield from ([*first, *chance.sample(rest, len(rest))] for __ in range(mixed))


def _place_in_order(sizes: Sequence[Size], order: Sequence[int], field: PackingField) -> list[Size] | None:
    """Place boxes one after another, each as high up and then as far left as possible.

    Returns:
        Upper left corner of each box, or None if a box does not fit.
    """
    skyline: list[SkylineStep] = [(0.0, field.width, 0.0)]
    corners = [(0.0, 0.0)] * len(sizes)
    for k in order:
        width, height = sizes[k]
        highest, place = math.inf, 0.0
        for number, (start, __, ___) in enumerate(skyline):
            end = start + width
            if end > field.width + 1e-9:
                break
            top = _skyline_top(skyline, number, end, highest)
            if top < highest and top + height <= field.depth(start, end) + 1e-9:
                highest, place = top, start
        if highest == math.inf:
            return None
        corners[k] = (place, highest)
        skyline = _lower_skyline(skyline, place, place + width, highest + height)
    return corners


def _skyline_top(skyline: Sequence[SkylineStep], number: int, end: float, most: float) -> float:
    """Return how far below the top of the field a box must be placed so that it lies below all boxes placed so far.

    The skyline is the lower boundary of these boxes, a stepped line.

    Args:
        skyline: the skyline.
        number: index of the step of the skyline at which the left edge of the box is.
        end: distance of the right edge of the box from the left of the field.
        most: depth at which the search stops, because a higher place for the box is already known.
    """
    begin, top = skyline[number][0] + 1e-9, 0.0
    for left, right, down in islice(skyline, number, None):
        if left >= end - 1e-9:
            break
        if down > top and right > begin:
            if down >= most:
                return most
            top = down
    return top


def _lower_skyline(skyline: Sequence[SkylineStep], start: float, end: float, down: float) -> list[SkylineStep]:
    """Return the lower boundary of the boxes after one more box has been placed.

    Args:
        skyline: lower boundary of the boxes placed before, a stepped line.
        start, end: left and right edge of the new box.
        down: lower edge of the new box, measured from the top of the field.
    """
    steps: list[SkylineStep] = []
    for left, right, depth in skyline:
        if left < start - 1e-9:
            steps.append((left, min(right, start), depth))
        if left <= start + 1e-9 < right:
            steps.append((start, end, down))
        if right > end + 1e-9:
            steps.append((max(left, end), right, depth))
    return steps


def spread_boxes(corners: Sequence[Size], sizes: Sequence[Size], field: PackingField) -> list[Size]:
    """Distribute the free space of an arrangement evenly, first horizontally, then vertically.

    The horizontal coordinates of all boxes are multiplied by one factor, and the vertical ones by another, so the boxes
    still do not overlap.
    """
    for axis in (0, 1):
        low, high = 1.0, 4.0
        while high - low > 1e-4:
            factor = (low + high) / 2
            if all(field.holds(_stretch(at, axis, factor), size) for at, size in zip(corners, sizes, strict=True)):
                low = factor
            else:
                high = factor
        corners = [_stretch(at, axis, low) for at in corners]
    return list(corners)


def _stretch(at: Size, axis: int, factor: float) -> Size:
    return (at[0] * factor, at[1]) if axis == 0 else (at[0], at[1] * factor)


# The frame of a sheet and its title block: GOST 2.104, form 1 (185 x 55 mm), or a plain one.


LEFT_MARGIN, OTHER_MARGIN = 20.0, 5.0  # mm between the frame and the left edge of the paper, and the other edges
MAIN_LINE, THIN_LINE = 0.6, 0.25  # mm: main and thin lines
TITLE_BLOCK_SIZES = {"gost": (185.0, 55.0), "plain": (140.0, 32.0)}
SMALL_LETTERS, USUAL_LETTERS, LARGE_LETTERS = 2.8, 3.5, 5.0  # mm: font sizes


@dataclass(frozen=True)
class TitleBlockTexts:
    """Texts in the title block of a sheet.

    Attributes:
        texts: names and document codes from the problem file.
        title: title of the project.
        subject: subject of the sheet, e.g. "Kinematics".
        number: number of the sheet.
        count: number of sheets in the project.
    """

    texts: SheetTexts
    title: str
    subject: str
    number: int
    count: int


def sheet_frame(paper: tuple[float, float]) -> LineMark:
    """Return the frame line of a sheet."""
    low, high = frame_corners(paper)
    return _rectangle(low, high)


def frame_corners(paper: tuple[float, float]) -> tuple[complex, complex]:
    """Return the lower left and upper right corners of the frame."""
    return complex(LEFT_MARGIN, OTHER_MARGIN), complex(paper[0] - OTHER_MARGIN, paper[1] - OTHER_MARGIN)


def title_block(titles: TitleBlockTexts, corner: complex) -> Iterable[Mark]:
    """Return the lines and texts of the title block. corner: its lower right corner."""
    kind = titles.texts.block
    low = corner - TITLE_BLOCK_SIZES[kind][0]
    marks = _gost_block(titles) if kind == "gost" else _plain_block(titles)
    return [mark.moved(low) for mark in marks]


def _gost_block(titles: TitleBlockTexts) -> list[Mark]:
    texts = titles.texts
    marks: list[Mark] = [_rectangle(0j, 185 + 55j)]
    marks += _ruled_lines(
        "x", ((17, 0, 55), (40, 0, 55), (55, 0, 55), (65, 0, 55), (7, 30, 55), (135, 0, 40)), MAIN_LINE
    )
    marks += _ruled_lines("x", ((150, 20, 40), (167, 20, 40), (155, 15, 20)), MAIN_LINE)
    marks += _ruled_lines("x", ((140, 20, 35), (145, 20, 35)), THIN_LINE)
    marks += _ruled_lines(
        "y", ((30, 0, 65), (35, 0, 65), (40, 65, 185), (15, 65, 185), (35, 135, 185), (20, 135, 185)), MAIN_LINE
    )
    marks += _ruled_lines("y", [(y, 0, 65) for y in (5, 10, 15, 20, 25, 40, 45, 50)], THIN_LINE)
    heads = ((0, 7, _("Rev.")), (7, 17, _("Sheet")), (17, 40, _("Doc. No.")), (40, 55, _("Sign.")), (55, 65, _("Date")))
    for start, end, word in heads:
        marks += cell_text(word, complex(start, 30), complex(end, 35), SMALL_LETTERS)
    roles = (
        (25, _("Drawn"), texts.student),
        (20, _("Checked"), texts.teacher),
        (15, _("Tech. check"), ""),
        (5, _("Std. check"), ""),
        (0, _("Approved"), ""),
    )
    for low, role, name in roles:
        marks += cell_text(role, complex(0, low), complex(17, low + 5), SMALL_LETTERS, "left")
        marks += cell_text(name, complex(17, low), complex(40, low + 5), SMALL_LETTERS, "left")
    marks += cell_text(texts.code, 65 + 40j, 185 + 55j, 1.4 * LARGE_LETTERS)
    marks += cell_text(titles.title, 65 + 26j, 135 + 40j, LARGE_LETTERS, lines=2)
    marks += cell_text(titles.subject, 65 + 15j, 135 + 26j, USUAL_LETTERS, lines=2)
    for start, end, word in ((135, 150, _("Stage")), (150, 167, _("Mass")), (167, 185, _("Scale"))):
        marks += cell_text(word, complex(start, 35), complex(end, 40), SMALL_LETTERS)
    marks += cell_text(_("Sheet {number}").format(number=titles.number), 135 + 15j, 155 + 20j, SMALL_LETTERS)
    marks += cell_text(_("Sheets {count}").format(count=titles.count), 155 + 15j, 185 + 20j, SMALL_LETTERS)
    institution = " ".join(part for part in (texts.department, texts.group) if part)
    return [*marks, *cell_text(institution, 135 + 0j, 185 + 15j, USUAL_LETTERS, lines=3)]


def _plain_block(titles: TitleBlockTexts) -> list[Mark]:
    texts = titles.texts
    marks: list[Mark] = [_rectangle(0j, 140 + 32j)]
    marks += _ruled_lines("y", ((8, 0, 140), (16, 0, 140), (24, 0, 140)), THIN_LINE)
    marks += _ruled_lines("x", ((105, 16, 32), (85, 0, 16), (20, 0, 16), (105, 0, 16)), THIN_LINE)
    cells = (
        (0, 24, 105, titles.title),
        (105, 24, 140, texts.code),
        (0, 16, 105, titles.subject),
        (105, 16, 140, _("sheet {number} of {count}").format(number=titles.number, count=titles.count)),
        (0, 8, 20, _("Student")),
        (20, 8, 85, texts.student),
        (85, 8, 105, _("Group")),
        (105, 8, 140, texts.group),
        (0, 0, 20, _("Teacher")),
        (20, 0, 85, texts.teacher),
        (85, 0, 105, _("Department")),
        (105, 0, 140, texts.department),
    )
    for left, low, right, text in cells:
        marks += cell_text(text, complex(left, low), complex(right, low + 8), USUAL_LETTERS, "left", lines=2)
    return marks


def _rectangle(low: complex, high: complex) -> LineMark:
    across = (high - low).real
    return LineMark((low, low + across, high, high - across, low), DARK_COLOUR, MAIN_LINE, layer="frame", z=8.0)


def _ruled_lines(axis: str, positions: Sequence[tuple[float, float, float]], width: float) -> list[LineMark]:
    """Return parallel ruled lines of a title block.

    Args:
        axis: axis along which the positions of the lines are given, "x" or "y".
        positions: position, start and end of each line, mm.
        width: width of the lines, mm.
    """
    ends = [
        (complex(at, a), complex(at, b)) if axis == "x" else (complex(a, at), complex(b, at)) for at, a, b in positions
    ]
    return [LineMark(pair, DARK_COLOUR, width, layer="frame", z=8.0) for pair in ends]
