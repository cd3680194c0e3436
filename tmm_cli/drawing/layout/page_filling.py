"""How large the drawings of a sheet are made: at round scales, in their usual proportion, as large as fits."""

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
LEAST_SHARE = 0.6  # of its usual size: what would be smaller comes on a further sheet
FILL_STEP = 1.05  # steps in which pages may become fuller than the average one
SCALE_RATIOS = (1.25, 1.6, 2.0)  # how many times finer than a round scale factor the next one is
GROWTH_STEP = 1.04  # by which a drawing without a scale is made larger
ROOM_TOLERANCE = 1.2  # of its room a figure may take, or the next round scale would make it much smaller
POINT_SIZE = 1e-6  # mm: a figure of this size has none
ENOUGH_FILLED = 0.74  # of a page: then nothing more is made larger
FLAT_HEIGHTS = (0.62, 0.5)  # of the height of a page: drawings that find room beside one another
FULL_ENOUGH = 0.6  # of a page: what a teacher takes
THIN_BELOW = 0.63  # of a page: with less something else is tried
# whether the first one is in the corner and all are in their order, and of how much of a page it is given up
PACKING_RULES = (
    (True, True, ENOUGH_FILLED),
    (False, True, THIN_BELOW),
    (True, False, THIN_BELOW),
    (False, False, THIN_BELOW),
)
SHRINK_SHARES = (0.93, 0.86, 0.78, 0.7, 0.62)  # of their rooms: drawings for which a page can be in order
LETTER_RATIO = 1.08  # times larger than those of another table of its page the letters of one may be
EVEN_ENOUGH = 0.68  # of every page: then pieces are shared out in no further way
MOST_GROWTH = 3.0  # of its usual size: nothing is made larger
SIZES_TRIED = 60  # that are tried from the largest to the least
MOST_PAGES = 40  # of one sheet at most
PARTITIONS_TRIED = 8  # ways to divide the pieces among pages that are compared
MOST_PARTITIONS = 2000  # with more possible ways none is tried


@dataclass(frozen=True)
class SheetPiece:
    """A drawing; the room (mm, its longest side) that is usual for it, the least and the largest."""

    drawn: SheetPicture
    usual: float
    least: float = 0.0
    most: float = math.inf
    letters: bool = False  # it is a table: as large as its letters

    @property
    def length(self) -> float:
        """The longest side of the figure, SI; none where there is no scale."""
        longest = max(self.drawn.figure or (0.0,))
        return longest * self.drawn.mu if longest > POINT_SIZE and self.drawn.mu else 0.0

    def fitted(self, room: float) -> float:
        """What a drawing takes of a room (mm): at a round scale its figure is shorter."""
        return self.length / round_scale(self.length, 0.0, room, room) if self.length else room

    def about(self, room: float) -> float:
        """The same, a little larger than the room where the round scale wants that."""
        return self.fitted(ROOM_TOLERANCE * room) if self.length else room

    def larger(self, room: float) -> float:
        """The next room in which it becomes larger."""
        if not self.length:
            return GROWTH_STEP * room
        return next(
            room * step
            for step in SCALE_RATIOS
            if step == SCALE_RATIOS[-1] or self.fitted(room * step) > 0.99 * room * step
        )

    def size(self, room: float) -> Size:
        """Its size (mm) in another room: letters stay as large as they are."""
        (width, height), figure, factor = self.drawn.paper, self.drawn.figure, room / (self.drawn.longest or 1.0)
        if figure is None:
            return width * factor, height * factor
        return width + (factor - 1) * figure[0], height + (factor - 1) * figure[1]


Page = list[int]  # numbers of pieces


def initial_rooms(pieces: Sequence[SheetPiece], field: PackingField, shrunk: float) -> tuple[list[float], list[Page]]:
    """A room for each piece, and which pieces stand on which page.

    shrunk: of the usual sizes, what suits the format. As few pages as hold everything in a legible size. Raises
    ProblemError where the format is too small.
    """
    few, found = MOST_PAGES, None
    for share in size_shares():
        rooms = [piece.about(min(max(share * shrunk * piece.usual, piece.least), piece.most)) for piece in pieces]
        pages = fill_pages(sizes_in_rooms(pieces, rooms), field)
        if pages is not None and len(pages) < few:
            few, found = len(pages), (rooms, pages)
        if found is not None and share < LEAST_SHARE:
            break
    if found is None:
        raise ProblemError(_("a drawing is larger than the sheet at its least size"), allowed=_("a larger format"))
    return found


def shrink_rooms(
    pieces: Sequence[SheetPiece], rooms: Sequence[float], share: float, which: Container[int]
) -> list[float]:
    """Rooms so much smaller for these pieces, but not below their least."""
    return [
        piece.fitted(max(share * room, min(room, piece.least))) if k in which else room
        for k, (piece, room) in enumerate(zip(pieces, rooms, strict=True))
    ]


def size_shares() -> Iterator[float]:
    """Of the usual size, from what is more to what is hardly legible."""
    yield from (1.3 * 0.95**k for k in range(SIZES_TRIED))


def sizes_in_rooms(pieces: Sequence[SheetPiece], rooms: Sequence[float]) -> list[Size]:
    """The sizes of the pieces in these rooms."""
    return [piece.size(room) for piece, room in zip(pieces, rooms, strict=True)]


def add_gaps(sizes: Sequence[Size], page: Page) -> list[Size]:
    """Sizes of these pieces with the gap that each has to its right and below it."""
    return [(sizes[k][0] + DRAWING_GAP, sizes[k][1] + DRAWING_GAP) for k in page]


def fill_pages(sizes: Sequence[Size], field: PackingField) -> list[Page] | None:
    """As few pages as hold the pieces, about equally full; None where a piece alone does not fit.

    The pieces stay in their order unless fewer pages hold them where some stand earlier.
    """
    fewest, back = _fill_in_order(sizes, field, math.inf), False
    if fewest is None or len(fewest) < 2:
        return fewest
    closer = _fill_in_order(sizes, field, math.inf, back=True)
    if closer is not None and len(closer) < len(fewest):
        fewest, back = closer, True
    return _fill_evenly(sizes, field, len(fewest), back=back)


def _fill_evenly(sizes: Sequence[Size], field: PackingField, count: int, *, back: bool) -> list[Page] | None:
    """So many pages, of which none is much fuller than it must be."""
    most = page_area(sizes, [*range(len(sizes))]) / count
    while True:
        pages = _fill_in_order(sizes, field, most, back=back)
        if (pages is not None and len(pages) <= count) or most > field.area:
            return pages
        most *= FILL_STEP


def page_partitions(sizes: Sequence[Size], pages: list[Page], field: PackingField) -> Iterator[list[Page]]:
    """These pages, then as many others: in the order of the pieces, the most even ones first, then in another one."""
    yield pages
    every, count = range(len(sizes)), len(pages)
    if count < 2 or math.comb(len(sizes) - 1, count - 1) > MOST_PARTITIONS:
        return

    @cache
    def held(start: int, end: int) -> bool:
        page = [*every[start:end]]
        return page_area(sizes, page) <= field.area and pack_boxes(add_gaps(sizes, page), field) is not None

    found = ([0, *cuts, len(sizes)] for cuts in combinations(every[1:], count - 1))
    others = [[[*every[start:end]] for start, end in pairwise(cuts)] for cuts in found]
    others.sort(key=lambda way: max(page_area(sizes, page) for page in way))
    yield from islice((way for way in others if all(held(page[0], page[-1] + 1) for page in way)), PARTITIONS_TRIED)
    mixed = _fill_evenly(sizes, field, count, back=True)
    if mixed is not None and len(mixed) == count:
        yield mixed


def evenest_pages(sizes: Sequence[Size], pages: list[Page], field: PackingField) -> list[Page]:
    """So many pages, of which the emptiest one is as full as can be."""
    return max(
        page_partitions(sizes, pages, field), key=lambda way: min((page_area(sizes, page) for page in way), default=0.0)
    )


def page_area(sizes: Sequence[Size], page: Page) -> float:
    """What the pieces of a page take, mm²."""
    return sum(sizes[k][0] * sizes[k][1] for k in page)


def _fill_in_order(sizes: Sequence[Size], field: PackingField, most: float, *, back: bool = False) -> list[Page] | None:
    """Pages filled one after the other, each with no more than so much; back: what follows may be on earlier ones."""
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
    pieces: Sequence[SheetPiece], given: Sequence[float], pages: list[Page], field: PackingField, shrunk: float
) -> tuple[list[float], list[Page]]:
    """Larger rooms, and so many pages as there are, shared out so that the emptiest one is as full as can be."""
    best, most = (list(given), pages), -1.0

    def better(found: Iterable[list[Page]], enough: float) -> bool:
        """Whether the emptiest page became fuller in one of these ways."""
        nonlocal best, most
        before = most
        for way in found:
            rooms = grow_rooms(pieces, given, way, field, shrunk)
            sizes = sizes_in_rooms(pieces, rooms)
            least = min((page_area(sizes, page) for page in way), default=0.0)
            if least > most:
                best, most = (rooms, way), least
            if least > enough * field.area:
                break
        return most > before

    better(page_partitions(sizes_in_rooms(pieces, given), pages, field), EVEN_ENOUGH)
    while most < THIN_BELOW * field.area and better(
        pages_with_moved_piece(sizes_in_rooms(pieces, given), best[1], field), THIN_BELOW
    ):
        pass
    return best


def pages_with_moved_piece(sizes: Sequence[Size], pages: list[Page], field: PackingField) -> Iterator[list[Page]]:
    """Pages where the emptiest one has one piece more from another one, perhaps in exchange for one of its own."""
    thin = min(range(len(pages)), key=lambda number: page_area(sizes, pages[number]), default=0)
    for other, page in enumerate(pages):
        for piece, back in product(page if other != thin else (), (None, *pages[thin])):
            way = list(pages)
            way[thin] = sorted([*(k for k in pages[thin] if k != back), piece])
            way[other] = sorted([*(k for k in page if k != piece), *(() if back is None else (back,))])
            if way[other] and all(pack_boxes(add_gaps(sizes, way[n]), field) is not None for n in (thin, other)):
                yield way


def packs_in_order(sizes: Sequence[Size], page: Page, field: PackingField) -> bool:
    """Whether the pieces of a page can stand in their order, the first one in its corner."""
    return pack_boxes(add_gaps(sizes, page), field, led=True, tidy=True) is not None


def tidier_rooms(
    pieces: Sequence[SheetPiece], given: Sequence[float], page: Page, field: PackingField
) -> Iterator[list[float]]:
    """Rooms in which a drawing or two, or all tables, are so much smaller that the page is in order and full enough."""
    tables = [k for k in page if pieces[k].letters]
    single = [tables, *([k] for k in page if k not in tables)]
    for share, which in product(SHRINK_SHARES, [*single, *([*a, *b] for a, b in combinations(single, 2))]):
        rooms = shrink_rooms(pieces, given, share, which)
        sizes = sizes_in_rooms(pieces, rooms)
        if page_area(sizes, page) > THIN_BELOW * field.area and packs_in_order(sizes, page, field):
            yield rooms


def grow_rooms(
    pieces: Sequence[SheetPiece], given: Sequence[float], pages: Sequence[Page], field: PackingField, shrunk: float
) -> list[float]:
    """Larger rooms while all fits on its page, first for those pieces that are farthest below their usual size.

    The pieces stay in their order and the first one in the corner, unless too much of the page were left empty for
    that. Letters of tables stay about alike.
    """
    rooms = list(given)
    for page, (led, tidy, enough) in product(pages, PACKING_RULES):
        growing = set(page)
        while growing and page_area(sizes_in_rooms(pieces, rooms), page) < enough * field.area:
            number = min(growing, key=lambda k: (rooms[k] / pieces[k].usual, k))
            piece, before = pieces[number], rooms[number]
            rooms[number] = piece.larger(before)
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
    """The rooms with those of a page's tables made smaller whose letters are larger than those of another one."""
    return [min(room, letter_limit(pieces, rooms, page, k)) if k in page else room for k, room in enumerate(rooms)]


def letter_limit(pieces: Sequence[SheetPiece], rooms: Sequence[float], page: Page, number: int) -> float:
    """The largest room for a piece beside tables, if it is one: its letters are hardly larger than theirs."""
    if not pieces[number].letters:
        return math.inf
    others = [rooms[k] / pieces[k].usual for k in page if pieces[k].letters and k != number]
    return LETTER_RATIO * min(others, default=math.inf) * pieces[number].usual
