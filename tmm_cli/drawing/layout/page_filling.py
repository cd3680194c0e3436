"""Sizes of the drawings on a large sheet, and their distribution over pages.

Drawings get round scales and become as large as the pages permit. The longest side (mm) that is allotted to a drawing
is called its room. As scales are round, a drawing may be shorter than its room.
"""

from __future__ import annotations

import math
from collections.abc import Container, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import combinations, islice, pairwise, product

from tmm_cli.drawing.layout.packing import PackingField, Size, pack_boxes
from tmm_cli.drawing.paper import SheetPicture
from tmm_cli.language import _
from tmm_cli.mechanics.plans import round_scale
from tmm_cli.problem import ProblemError

DRAWING_GAP = 7.0  # mm between two drawings
LEAST_SHARE = 0.6  # of the usual size: smaller drawings move to a further sheet
FILL_STEP = 1.05  # factor by which the limit of a page is raised above the average
SCALE_RATIOS = (1.25, 1.6, 2.0)  # ratios of neighbouring round scales
GROWTH_STEP = 1.04  # growth of a drawing without scale in one step
ROOM_TOLERANCE = 1.2  # of its room that a figure may take, because the next round scale is much smaller
POINT_SIZE = 1e-6  # mm: a smaller figure is a point and has no scale
ENOUGH_FILLED = 0.74  # of a page: drawings grow no further
FLAT_HEIGHTS = (0.62, 0.5)  # of the height of a page: lower limits of height, so that drawings fit side by side
FULL_ENOUGH = 0.6  # of a page: full enough to hand in
THIN_BELOW = 0.63  # of a page: with less, other arrangements are tried
# first piece in the corner, pieces in order; share of a page above which the rule is applied no further
PACKING_RULES = (
    (True, True, ENOUGH_FILLED),
    (False, True, THIN_BELOW),
    (True, False, THIN_BELOW),
    (False, False, THIN_BELOW),
)
SHRINK_SHARES = (0.93, 0.86, 0.78, 0.7, 0.62)  # of their rooms: reductions that may let a page pack in order
LETTER_RATIO = 1.08  # largest ratio of letter sizes of tables on one page
EVEN_ENOUGH = 0.68  # of every page: no further partition is tried
MOST_GROWTH = 3.0  # of the usual size: nothing grows beyond it
SIZES_TRIED = 60  # relative sizes tried, from the largest down
MOST_PAGES = 40  # of one sheet
PARTITIONS_TRIED = 8  # ways to divide the pieces among pages that are compared
MOST_PARTITIONS = 2000  # with more possible ways none is tried


@dataclass(frozen=True)
class SheetPiece:
    """A drawing whose size can be changed by allotting it a longer or shorter longest side (its room, mm).

    Attributes:
        drawn: the drawing in its present size.
        usual: usual length allotted to the longest side, mm.
        least: smallest length allotted to the longest side, mm.
        most: greatest length allotted to the longest side, mm.
        letters: True for a table, whose size follows from the size of its letters.
    """

    drawn: SheetPicture
    usual: float
    least: float = 0.0
    most: float = math.inf
    letters: bool = False  # a table, whose size follows from its letters

    @property
    def length(self) -> float:
        """Longest side of the depicted figure in SI units; 0 if it is not to scale."""
        longest = max(self.drawn.figure or (0.0,))
        return longest * self.drawn.mu if longest > POINT_SIZE and self.drawn.mu else 0.0

    def fitting_length(self, room: float) -> float:
        """Return the length (mm) of the longest side at the largest round scale at which it does not exceed `room`.

        A drawing that is not to scale can take any size, so its longest side is then `room`.
        """
        return self.length / round_scale(self.length, 0.0, room, room) if self.length else room

    def round_length(self, room: float) -> float:
        """Return the length (mm) of the longest side at a round scale at which it is close to `room`.

        It may exceed `room` slightly. If the drawing is not to scale, it equals `room`.
        """
        return self.fitting_length(ROOM_TOLERANCE * room) if self.length else room

    def next_room(self, room: float) -> float:
        """Return the next larger length (mm) that can be allotted to the longest side.

        For a drawing to scale, it is a length at which the next larger round scale fits.
        """
        if not self.length:
            return GROWTH_STEP * room
        return next(
            room * step
            for step in SCALE_RATIOS
            if step == SCALE_RATIOS[-1] or self.fitting_length(room * step) > 0.99 * room * step
        )

    def size(self, room: float) -> Size:
        """Return width and height (mm) of the drawing if its longest side is `room`.

        Only the figure changes its size; texts around it keep theirs.
        """
        (width, height), figure, factor = self.drawn.paper, self.drawn.figure, room / (self.drawn.longest or 1.0)
        if figure is None:
            return width * factor, height * factor
        return width + (factor - 1) * figure[0], height + (factor - 1) * figure[1]


Page = list[int]  # numbers of pieces


def initial_rooms(pieces: Sequence[SheetPiece], field: PackingField, shrunk: float) -> tuple[list[float], list[Page]]:
    """Choose the sizes of the drawings so that as few pages as possible are needed and all drawings are legible.

    Args:
        pieces: the drawings.
        field: area of a page for drawings.
        shrunk: longest side of the paper relative to that of A1.

    Returns:
        Longest side of each drawing (mm), and for each page the indices of its drawings.

    Raises:
        ProblemError: A drawing does not fit on the paper even at its smallest size.
    """
    few, best = MOST_PAGES, None
    for share in size_shares():
        rooms = [
            piece.round_length(min(max(share * shrunk * piece.usual, piece.least), piece.most)) for piece in pieces
        ]
        pages = fill_pages(sizes_in_rooms(pieces, rooms), field)
        if pages is not None and len(pages) < few:
            few, best = len(pages), (rooms, pages)
        if best is not None and share < LEAST_SHARE:
            break
    if best is None:
        text = _("a drawing does not fit on the sheet even at its smallest size")
        raise ProblemError(text, allowed=_("a larger paper size"))
    return best


def shrink_rooms(
    pieces: Sequence[SheetPiece], rooms: Sequence[float], share: float, chosen: Container[int]
) -> list[float]:
    """Return the longest sides (mm) of all drawings after making the chosen ones smaller.

    Their longest sides are multiplied by `share`, but not reduced below the smallest permitted length.
    """
    return [
        piece.fitting_length(max(share * room, min(room, piece.least))) if k in chosen else room
        for k, (piece, room) in enumerate(zip(pieces, rooms, strict=True))
    ]


def size_shares() -> Iterator[float]:
    """Yield fractions of the usual size of a drawing, from 1.3 down to a size at which it is hardly legible."""
    yield from (1.3 * 0.95**k for k in range(SIZES_TRIED))


def sizes_in_rooms(pieces: Sequence[SheetPiece], rooms: Sequence[float]) -> list[Size]:
    """Return the width and height (mm) of each drawing if its longest side is the length in `rooms`."""
    return [piece.size(room) for piece, room in zip(pieces, rooms, strict=True)]


def add_gaps(sizes: Sequence[Size], page: Page) -> list[Size]:
    """Return the sizes of the drawings on a page, each enlarged by the gap on its right and below it."""
    return [(sizes[k][0] + DRAWING_GAP, sizes[k][1] + DRAWING_GAP) for k in page]


def fill_pages(sizes: Sequence[Size], field: PackingField) -> list[Page] | None:
    """Distribute drawings over as few pages as possible, which are about equally full.

    The order of the drawings is kept, unless fewer pages suffice when some drawings are moved to an earlier page.

    Returns:
        For each page the indices of its drawings; None if a drawing does not fit on an empty page.
    """
    fewest, back = _fill_in_order(sizes, field, math.inf), False
    if fewest is None or len(fewest) < 2:
        return fewest
    closer = _fill_in_order(sizes, field, math.inf, back=True)
    if closer is not None and len(closer) < len(fewest):
        fewest, back = closer, True
    return _fill_evenly(sizes, field, len(fewest), back=back)


def _fill_evenly(sizes: Sequence[Size], field: PackingField, count: int, *, back: bool) -> list[Page] | None:
    """Distribute drawings over `count` pages that are about equally full.

    The area to which pages are filled is raised in small steps until `count` pages suffice.
    """
    most = page_area(sizes, [*range(len(sizes))]) / count
    while True:
        pages = _fill_in_order(sizes, field, most, back=back)
        if (pages is not None and len(pages) <= count) or most > field.area:
            return pages
        most *= FILL_STEP


def page_partitions(sizes: Sequence[Size], pages: list[Page], field: PackingField) -> Iterator[list[Page]]:
    """Yield ways to distribute the drawings over the same number of pages as in `pages`.

    The first is `pages` itself. Then come other distributions that keep the order of the drawings, the most even ones
    first, and at last one that changes their order.
    """
    yield pages
    numbers, count = range(len(sizes)), len(pages)
    if count < 2 or math.comb(len(sizes) - 1, count - 1) > MOST_PARTITIONS:
        return

    @cache
    def held(start: int, end: int) -> bool:
        page = [*numbers[start:end]]
        return page_area(sizes, page) <= field.area and pack_boxes(add_gaps(sizes, page), field) is not None

    cut_lists = ([0, *cuts, len(sizes)] for cuts in combinations(numbers[1:], count - 1))
    others = [[[*numbers[start:end]] for start, end in pairwise(cuts)] for cuts in cut_lists]
    others.sort(key=lambda partition: max(page_area(sizes, page) for page in partition))
    yield from islice(
        (partition for partition in others if all(held(page[0], page[-1] + 1) for page in partition)), PARTITIONS_TRIED
    )
    mixed = _fill_evenly(sizes, field, count, back=True)
    if mixed is not None and len(mixed) == count:
        yield mixed


def evenest_pages(sizes: Sequence[Size], pages: list[Page], field: PackingField) -> list[Page]:
    """Return the most even distribution of the drawings over the same number of pages as in `pages`.

    It is the one in which the emptiest page has the largest area of drawings.
    """
    return max(
        page_partitions(sizes, pages, field),
        key=lambda partition: min((page_area(sizes, page) for page in partition), default=0.0),
    )


def page_area(sizes: Sequence[Size], page: Page) -> float:
    """Return the total area (mm²) of the drawings on a page."""
    return sum(sizes[k][0] * sizes[k][1] for k in page)


def _fill_in_order(sizes: Sequence[Size], field: PackingField, most: float, *, back: bool = False) -> list[Page] | None:
    """Fill pages one after another, each up to an area of `most` mm².

    Args:
        sizes: widths and heights of the drawings, mm.
        field: area of a page for drawings.
        most: greatest total area of the drawings on a page, mm².
        back: True if a drawing may also be placed on an earlier page.

    Returns:
        For each page the indices of its drawings; None if a drawing does not fit on an empty page.
    """
    pages: list[Page] = []
    for number in range(len(sizes)):
        for page in pages if back else pages[-1:]:
            longer = [*page, number]
            if page_area(sizes, longer) <= most and pack_boxes(add_gaps(sizes, longer), field) is not None:
                page.append(number)
                break
        else:
            if pack_boxes(add_gaps(sizes, [number]), field) is None:
                return None
            pages.append([number])
    return pages


def share_out_pages(
    pieces: Sequence[SheetPiece], start_rooms: Sequence[float], pages: list[Page], field: PackingField, shrunk: float
) -> tuple[list[float], list[Page]]:
    """Enlarge the drawings and redistribute them so that the emptiest page is as full as possible.

    Returns:
        Longest side of each drawing (mm), and for each page the indices of its drawings.
    """
    best, most = (list(start_rooms), pages), -1.0

    def improve(partitions: Iterable[list[Page]], enough: float) -> bool:
        """Try distributions and return True if the emptiest page of one of them is fuller than in the best one so far.

        The search ends when the emptiest page is filled beyond the fraction `enough`.
        """
        nonlocal best, most
        before = most
        for partition in partitions:
            rooms = grow_rooms(pieces, start_rooms, partition, field, shrunk)
            sizes = sizes_in_rooms(pieces, rooms)
            least = min((page_area(sizes, page) for page in partition), default=0.0)
            if least > most:
                best, most = (rooms, partition), least
            if least > enough * field.area:
                break
        return most > before

    improve(page_partitions(sizes_in_rooms(pieces, start_rooms), pages, field), EVEN_ENOUGH)
    while most < THIN_BELOW * field.area and improve(
        pages_with_moved_piece(sizes_in_rooms(pieces, start_rooms), best[1], field), THIN_BELOW
    ):
        pass
    return best


def pages_with_moved_piece(sizes: Sequence[Size], pages: list[Page], field: PackingField) -> Iterator[list[Page]]:
    """Yield distributions in which a drawing is moved to the emptiest page.

    In some of them a drawing of that page is moved to the other page in exchange.
    """
    thin = min(range(len(pages)), key=lambda number: page_area(sizes, pages[number]), default=0)
    for other, page in enumerate(pages):
        for piece, back in product(page if other != thin else (), (None, *pages[thin])):
            partition = list(pages)
            partition[thin] = sorted([*(k for k in pages[thin] if k != back), piece])
            partition[other] = sorted([*(k for k in page if k != piece), *(() if back is None else (back,))])
            if partition[other] and all(
                pack_boxes(add_gaps(sizes, partition[n]), field) is not None for n in (thin, other)
            ):
                yield partition


def packs_in_order(sizes: Sequence[Size], page: Page, field: PackingField) -> bool:
    """Return True if the drawings of a page fit in reading order with the first of them in the upper left corner."""
    return pack_boxes(add_gaps(sizes, page), field, led=True, tidy=True) is not None


def tidier_rooms(
    pieces: Sequence[SheetPiece], start_rooms: Sequence[float], page: Page, field: PackingField
) -> Iterator[list[float]]:
    """Yield longest sides (mm) of all drawings with which a page can be packed in reading order and stays full.

    For this, one or two drawings, or all tables of the page, are made smaller.
    """
    tables = [k for k in page if pieces[k].letters]
    single = [tables, *([k] for k in page if k not in tables)]
    for share, chosen in product(SHRINK_SHARES, [*single, *([*a, *b] for a, b in combinations(single, 2))]):
        rooms = shrink_rooms(pieces, start_rooms, share, chosen)
        sizes = sizes_in_rooms(pieces, rooms)
        if page_area(sizes, page) > THIN_BELOW * field.area and packs_in_order(sizes, page, field):
            yield rooms


def grow_rooms(
    pieces: Sequence[SheetPiece],
    start_rooms: Sequence[float],
    pages: Sequence[Page],
    field: PackingField,
    shrunk: float,
) -> list[float]:
    """Enlarge the drawings as long as they fit on their pages, and return their longest sides (mm).

    Drawings that are smallest relative to their usual size grow first. On each page the drawings keep their order, and
    the first one stays in the upper left corner, unless too much of the page would stay empty. The letters of tables
    stay about equally large.
    """
    rooms = list(start_rooms)
    for page, (led, tidy, enough) in product(pages, PACKING_RULES):
        growing = set(page)
        while growing and page_area(sizes_in_rooms(pieces, rooms), page) < enough * field.area:
            number = min(growing, key=lambda k: (rooms[k] / pieces[k].usual, k))
            piece, before = pieces[number], rooms[number]
            rooms[number] = piece.next_room(before)
            sizes = sizes_in_rooms(pieces, rooms)
            most = min(MOST_GROWTH * shrunk * piece.usual, piece.most, letter_limit(pieces, rooms, page, number))
            if (
                not before < rooms[number] <= most
                or pack_boxes(add_gaps(sizes, page), field, led=led, tidy=tidy) is None
            ):
                rooms[number] = before
                growing.discard(number)
    return rooms


def equalize_letters(pieces: Sequence[SheetPiece], rooms: Sequence[float], page: Page) -> list[float]:
    """Return the longest sides (mm) of all drawings after making the tables of one page smaller.

    They are made smaller until their letters are about equally large.
    """
    return [min(room, letter_limit(pieces, rooms, page, k)) if k in page else room for k, room in enumerate(rooms)]


def letter_limit(pieces: Sequence[SheetPiece], rooms: Sequence[float], page: Page, number: int) -> float:
    """Return the greatest length (mm) of a table's longest side at which its letters match those of other tables.

    Its letters may then be at most slightly larger than the smallest letters of the other tables on the same page. If
    there are no other tables, or if the drawing is not a table, there is no limit (infinity).
    """
    if not pieces[number].letters:
        return math.inf
    others = [rooms[k] / pieces[k].usual for k in page if pieces[k].letters and k != number]
    return LETTER_RATIO * min(others, default=math.inf) * pieces[number].usual
