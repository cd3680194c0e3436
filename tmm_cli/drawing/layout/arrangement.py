"""Large sheets of a project: the drawings are made as large as possible, arranged on pages and written as files."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from importlib.util import find_spec
from itertools import accumulate, islice, product, repeat

from tmm_cli.drawing.formats import FORMATS, WITH_PAGES, JobRunner, missing_character_notes, run_in_process
from tmm_cli.drawing.layout.contents import (
    CONTENTS,
    SUBJECTS,
    DrawingSource,
    SheetChoice,
    choose_positions,
    reading_order,
)
from tmm_cli.drawing.layout.packing import (
    TITLE_BLOCK_SIZES,
    PackingField,
    Size,
    TitleBlockTexts,
    arrange_boxes,
    frame_corners,
    pack_boxes,
    sheet_frame,
    spread_boxes,
    title_block,
)
from tmm_cli.drawing.layout.page_filling import (
    DRAWING_GAP,
    FLAT_HEIGHTS,
    FULL_ENOUGH,
    PACKING_RULES,
    THIN_BELOW,
    Page,
    SheetPiece,
    add_gaps,
    equalize_letters,
    evenest_pages,
    fill_pages,
    grow_rooms,
    initial_rooms,
    packs_in_order,
    page_area,
    share_out_pages,
    shrink_rooms,
    tidier_rooms,
)
from tmm_cli.drawing.paper import LEAST_PAPER, Drawing, PictureSpace, SheetPicture, drawing_within
from tmm_cli.language import _
from tmm_cli.mechanics.analysis import Results
from tmm_cli.problem import ProblemError, parse_names

PAPERS = {"A1": (841.0, 594.0), "A2": (594.0, 420.0), "A3": (420.0, 297.0)}
FRAME_GAP = 6.0  # mm between the frame and the drawings
LETTER_LIMITS = (0.85, 1.6)  # smallest and largest letters of a table, relative to the usual ones
FULL_SIZE_POSITIONS = 1.5  # with more positions the drawings of each position become smaller
SMALLEST_SHARE = 0.45  # of the usual size: the least they become
NOTABLE_GROWTH = 1.1  # growth that justifies drawing again
SHRINK_SHARE = 0.75  # factor for drawings that became larger than expected
SHRINK_TRIES = 5  # of SHRINK_SHARE
GROWTH_ROUNDS = 3  # of enlarging what proves to have room
MOST_ROUNDS = 8  # while a page stays thin


@dataclass(frozen=True)
class LargeSheet(Drawing):
    """A large sheet with frame and title block.

    Attributes:
        pictures: the drawings on the sheet, each after the position of its lower left corner on the paper, mm.
    """

    pictures: tuple[tuple[complex, SheetPicture], ...] = ()


def large_sheets(
    choice: SheetChoice, paper: str, runner: JobRunner = run_in_process
) -> Iterator[tuple[str, LargeSheet]]:
    """Yield the large sheets of a project, as (stem of the file name, sheet), numbered from 1.

    The drawings are grouped by subject: structure, kinematics, forces, law of motion. If the drawings of a subject do
    not fit on one sheet, they continue on the next. The structure sheet is drawn on the smallest paper on which its
    drawings fit, because most of them are not to scale.

    Args:
        choice: results and the positions to be drawn.
        paper: largest paper size, a key of PAPERS.
        runner: draws the subjects, for example on several cores.

    Raises:
        ProblemError: A drawing does not fit on the paper.
    """
    problem = choice.results.problem
    smaller = [name for name in reversed(PAPERS) if PAPERS[name] <= PAPERS[paper]]
    jobs = [
        partial(_fit_smallest_paper, number, choice, [paper] if number else smaller) for number in range(len(SUBJECTS))
    ]
    arranged = list(runner(jobs))
    count = sum(len(pages) for *__, pages in arranged)
    sheets = [
        (subject, size, pictures, page) for subject, (size, pictures, pages) in enumerate(arranged) for page in pages
    ]
    for number, (subject, size, pictures, page) in enumerate(sheets, 1):
        field, name = drawing_field(size, problem.title_texts.block), SUBJECTS[subject][0]
        titles = TitleBlockTexts(problem.title_texts, problem.title, _(choice.title(subject)), number, count)
        stem = f"sheet-{number:0{len(str(count))}}-{name}"
        yield stem, frame_pictures([pictures[k] for k in page], field, size, titles)


def _fit_smallest_paper(
    number: int, choice: SheetChoice, papers: Sequence[str]
) -> tuple[Size, list[SheetPicture], list[Page]]:
    """Arrange the drawings of a subject on the first of the given paper sizes on which they fit on one page.

    If they fit on one page of no size, the last size is used. If much of the page remains empty, the next smaller paper
    size is tried too.

    Args:
        number: index of the subject in SUBJECTS.
        choice: results and the positions to be drawn.
        papers: paper sizes to be tried in turn, keys of PAPERS.

    Returns:
        Width and height of the paper (mm), the drawings, and for each page the indices of its drawings.
    """
    for paper in papers:
        size, pictures, pages = arrangement = _arrange_on_paper(paper, number, choice)
        if len(pages) < 2:
            break
    field = drawing_field(size, choice.results.problem.title_texts.block)
    smaller = next((name for name in PAPERS if PAPERS[name] < size), None)
    if smaller is None or len(pages) != 1 or _least_page_area((pictures, pages)) > FULL_ENOUGH * field.area:
        return arrangement
    tried = _arrange_on_paper(smaller, number, choice)
    return tried if len(tried[2]) == 1 else arrangement


def _arrange_on_paper(paper: str, number: int, choice: SheetChoice) -> tuple[Size, list[SheetPicture], list[Page]]:
    size = PAPERS[paper]
    return size, *_arrange_fullest(number, choice, size, drawing_field(size, choice.results.problem.title_texts.block))


def _arrange_fullest(
    number: int, choice: SheetChoice, paper: Size, field: PackingField
) -> tuple[list[SheetPicture], list[Page]]:
    """Arrange the drawings of a subject on pages so that no page remains largely empty.

    If one page does, the drawings are made again with a smaller greatest height, so that more of them fit side by side.
    """
    arrangement = _arrange_sheet(number, choice, paper, field, field.height - DRAWING_GAP)
    for high in (field.height - field.taken[1] - DRAWING_GAP, *(share * field.height for share in FLAT_HEIGHTS)):
        if _least_page_area(arrangement) > THIN_BELOW * field.area:
            break
        if any(picture.paper[1] > high for picture in arrangement[0]):
            flat = _arrange_sheet(number, choice, paper, field, high)
            arrangement = min(arrangement, flat, key=lambda picture: (len(picture[1]), -_least_page_area(picture)))
    return arrangement


def _least_page_area(arrangement: tuple[list[SheetPicture], list[Page]]) -> float:
    """Return the total area (mm²) of the drawings on the emptiest page."""
    pictures, pages = arrangement
    return min((page_area([picture.paper for picture in pictures], page) for page in pages), default=0.0)


def drawing_field(paper: Size, block: str) -> PackingField:
    """Return the field of a sheet in which drawings are packed: the area inside the frame, without the title block.

    The field extends to the right and downwards by DRAWING_GAP, because each drawing is packed with a gap of this width
    on its right and below it.

    Args:
        paper: width and height of the paper, mm.
        block: kind of title block, a key of TITLE_BLOCK_SIZES.
    """
    low, high = frame_corners(paper)
    room, taken = high - low - (2 * FRAME_GAP - DRAWING_GAP) * (1 + 1j), TITLE_BLOCK_SIZES[block]
    return PackingField(room.real, room.imag, (taken[0] - FRAME_GAP + DRAWING_GAP, taken[1] - FRAME_GAP + DRAWING_GAP))


def _arrange_sheet(
    number: int, choice: SheetChoice, paper: Size, field: PackingField, high: float
) -> tuple[list[SheetPicture], list[Page]]:
    """Make the drawings of a subject and distribute them over pages.

    Args:
        number: index of the subject in SUBJECTS.
        choice: results and the positions to be drawn.
        paper: width and height of the paper, mm.
        field: area of the paper for drawings.
        high: greatest height of a drawing, mm; tables that would be higher are broken into columns.

    Returns:
        The drawings, and for each page the indices of its drawings.
    """
    shrunk, most = max(paper) / max(PAPERS["A1"]), (field.width - DRAWING_GAP, high)
    requests = [(source, choice, most) for source in CONTENTS if source.sheet == number]
    parts = [_draw_first(*request, shrunk) for request in requests]
    lengths, all_pieces = (
        [len(source_pieces) for source_pieces in parts],
        [piece for source_pieces in parts for piece in source_pieces],
    )
    order = reading_order(
        (request[0], piece.drawn.stem)
        for request, source_pieces in zip(requests, parts, strict=True)
        for piece in source_pieces
    )
    pieces = [all_pieces[k] for k in order]

    def draw_again(rooms: Sequence[float]) -> list[SheetPiece]:
        """Make all drawings of the subject again, with these longest sides (mm)."""
        back = sorted(range(len(order)), key=order.__getitem__)
        old, new = [pieces[k] for k in back], [rooms[k] for k in back]
        starts = accumulate(lengths, initial=0)
        slices = [slice(start, start + length) for start, length in zip(starts, lengths, strict=False)]
        again = [
            _redraw(*request, old[own_slice], new[own_slice])
            for request, own_slice in zip(requests, slices, strict=True)
        ]
        redrawn = [piece for source_pieces in again for piece in source_pieces]
        return [redrawn[k] for k in order]

    rooms, pages = initial_rooms(pieces, field, shrunk)
    free = [k for k, piece in enumerate(pieces) if not piece.length]
    begin = shrink_rooms(pieces, rooms, SHRINK_SHARE, free)
    for wanted_rooms in (
        share_out_pages(pieces, begin, pages, field, shrunk)[0],
        grow_rooms(pieces, begin, pages, field, shrunk),
    ):
        larger = draw_again(wanted_rooms)
        held = fill_pages(_paper_sizes(larger), field)
        if held is not None and len(held) <= len(pages):
            pieces, pages = larger, held
            break
    else:  # a drawing became larger than expected
        large = list(range(len(pieces)))
        for __ in range(SHRINK_TRIES):
            rooms = shrink_rooms(pieces, rooms, SHRINK_SHARE, large)
            pieces = draw_again(rooms)
            large = [k for k in large if pack_boxes(add_gaps(_paper_sizes(pieces), [k]), field) is None]
            if not large:
                break
        pages = arrange_as_drawn([piece.drawn for piece in pieces], field)
    for number in range(MOST_ROUNDS):
        thin = _least_page_area(([piece.drawn for piece in pieces], pages)) < THIN_BELOW * field.area
        if number >= GROWTH_ROUNDS and not thin:
            break
        before = _drawn_lengths(pieces)
        rooms, pages = share_out_pages(pieces, before, pages, field, shrunk)
        if all(room <= (1.0 if thin else NOTABLE_GROWTH) * old for room, old in zip(rooms, before, strict=True)):
            break
        larger = draw_again(rooms)
        accepted = _accept_larger(pieces, larger, pages, field)
        pieces = [  # pieces without enough room are tried with half the growth
            request if request is new else replace(request, most=(old + room) / 2)
            for request, new, old, room in zip(accepted, larger, before, rooms, strict=True)
        ]
    pages = evenest_pages(_paper_sizes(pieces), pages, field)
    return [piece.drawn for piece in _tidy_pages(pieces, pages, field, draw_again)], pages


def _tidy_pages(
    pieces: list[SheetPiece],
    pages: Sequence[Page],
    field: PackingField,
    draw_again: Callable[[Sequence[float]], list[SheetPiece]],
) -> list[SheetPiece]:
    """Give the tables on each page equally large letters, and restore the reading order of its drawings.

    If the drawings of a page cannot be packed in reading order, some of them are made smaller.
    """
    for page in pages:
        tried = draw_again(equalize_letters(pieces, _drawn_lengths(pieces), page))
        if pack_boxes(add_gaps(_paper_sizes(tried), page), field) is not None:
            pieces = tried
        if packs_in_order(_paper_sizes(pieces), page, field):
            continue
        for tried in map(draw_again, islice(tidier_rooms(pieces, _drawn_lengths(pieces), page, field), SHRINK_TRIES)):
            sizes = _paper_sizes(tried)
            if page_area(sizes, page) > THIN_BELOW * field.area and packs_in_order(sizes, page, field):
                pieces = tried
                break
    return pieces


def _drawn_lengths(pieces: Sequence[SheetPiece]) -> list[float]:
    """Return for each drawing the longest side (mm) for which it was last made."""
    return [piece.drawn.longest or piece.usual for piece in pieces]


def _accept_larger(
    pieces: Sequence[SheetPiece], larger: Sequence[SheetPiece], pages: Sequence[Page], field: PackingField
) -> list[SheetPiece]:
    """Replace drawings by their larger versions, one after another, as long as they still fit on their page."""
    accepted = list(pieces)
    for page, (led, tidy, enough) in product(pages, PACKING_RULES):
        if page_area(_paper_sizes(accepted), page) < enough * field.area:
            for number in page:
                tried = [*accepted[:number], larger[number], *accepted[number + 1 :]]
                if pack_boxes(add_gaps(_paper_sizes(tried), page), field, led=led, tidy=tidy) is not None:
                    accepted = tried
    return accepted


def _paper_sizes(pieces: Sequence[SheetPiece]) -> list[Size]:
    return [piece.drawn.paper for piece in pieces]


def arrange_as_drawn(pictures: Sequence[SheetPicture], field: PackingField) -> list[Page]:
    """Distribute drawings over pages without changing their sizes.

    Returns:
        For each page the indices of its drawings.

    Raises:
        ProblemError: A drawing is larger than the page.
    """
    for picture in pictures:
        if pack_boxes(add_gaps([picture.paper], [0]), field) is None:
            text = _("drawing {name} is larger than the sheet")
            raise ProblemError(text.format(name=picture.stem), allowed=_("a larger paper size"))
    return fill_pages([picture.paper for picture in pictures], field) or []


def _draw_first(source: DrawingSource, choice: SheetChoice, most: Size, shrunk: float) -> list[SheetPiece]:
    """Make all drawings of one kind for the first time, at their usual size.

    Args:
        source: function that makes the drawings, with their usual size.
        choice: results and the positions to be drawn.
        most: width of the field, and greatest height of a drawing, mm.
        shrunk: longest side of the paper relative to that of A1.
    """
    number = len(getattr(choice, source.over)) if source.over else 1
    usual = source.usual and source.usual * max(
        SMALLEST_SHARE, min(1.0, math.sqrt(FULL_SIZE_POSITIONS / max(number, 1)))
    )
    pictures = _draw_source(source, choice, most, repeat(usual and usual * shrunk))
    if usual is None:
        least, largest = LETTER_LIMITS
        return [
            SheetPiece(
                picture, picture.longest / shrunk, least * picture.longest, largest * picture.longest, letters=True
            )
            for picture in pictures
        ]
    return [SheetPiece(picture, usual, 0.0 if picture.figure else LEAST_PAPER) for picture in pictures]


def _redraw(
    source: DrawingSource, choice: SheetChoice, most: Size, pieces: list[SheetPiece], rooms: Sequence[float]
) -> list[SheetPiece]:
    """Redraw all drawings of one kind if the longest side of at least one of them changes.

    Args:
        source: function that makes the drawings.
        choice: results and the positions to be drawn.
        most: width of the field, and greatest height of a drawing, mm.
        pieces: the drawings as they were made before.
        rooms: new longest side of each drawing, mm.
    """
    if all(math.isclose(piece.drawn.longest, room) for piece, room in zip(pieces, rooms, strict=True)):
        return pieces
    pictures = _draw_source(source, choice, most, rooms)
    return [replace(piece, drawn=picture) for piece, picture in zip(pieces, pictures, strict=True)]


def _draw_source(
    source: DrawingSource, choice: SheetChoice, most: Size, rooms: Iterable[float | None]
) -> list[SheetPicture]:
    """Make all drawings of one kind.

    rooms: longest side of each drawing, mm; None for its usual size.
    """
    drawings, pictures = iter(source.drawings(choice)), list[SheetPicture]()
    for room in rooms:
        with drawing_within(PictureSpace(room, most)):
            drawn = next(drawings, None)
        if drawn is None:
            break
        if isinstance(drawn[1], SheetPicture):
            pictures.append(replace(drawn[1], stem=drawn[0]))
    return pictures


def frame_pictures(
    pictures: Sequence[SheetPicture], field: PackingField, paper: Size, titles: TitleBlockTexts
) -> LargeSheet:
    """Arrange drawings on a sheet and add the frame and the title block."""
    sizes = [(picture.paper[0] + DRAWING_GAP, picture.paper[1] + DRAWING_GAP) for picture in pictures]
    corners = spread_boxes(arrange_boxes(sizes, field) or [], sizes, field)
    low, high = frame_corners(paper)
    corner = complex(low.real + FRAME_GAP, high.imag - FRAME_GAP)
    placed = [
        (corner + complex(x, -y - placed_picture.paper[1]), placed_picture)
        for (x, y), placed_picture in zip(corners, pictures, strict=True)
    ]
    marks = [mark for at, placed_picture in placed for mark in placed_picture.moved(at).marks]
    block = title_block(titles, complex(high.real, low.imag))
    return LargeSheet(paper, (*marks, sheet_frame(paper), *block), tuple(placed))


MOST_PLANS = 24  # positions with motion plans


def parse_formats(text: str) -> list[str]:
    """Parse a comma-separated list of file formats.

    Raises:
        ProblemError: A format is unknown, or the library for it is not installed.
    """
    names = parse_names(text, FORMATS, "--as", _("unknown drawing format"))
    if "dxf" in names and find_spec("ezdxf") is None:
        text = _("DXF files need the package ezdxf, which is not installed")
        raise ProblemError(text, allowed="pip install 'tmm-cli[cad]'")
    return names


def refuse_plans(count: int) -> None:
    """Refuse to draw motion plans for more than MOST_PLANS positions on large sheets.

    Raises:
        ProblemError: There are more positions.
    """
    if count > MOST_PLANS:
        raise ProblemError(
            _("too many positions: the motion plans on the sheet would be illegible"),
            found=str(count),
            allowed=_(
                "at most {most}; with --positions detail only the positions in positions.detail are drawn"
            ).format(most=MOST_PLANS),
        )


def large_sheet_files(
    results: Results,
    paper: str,
    formats: Sequence[str],
    say: Callable[[str], None],
    runner: JobRunner = run_in_process,
    *,
    all_positions: bool,
) -> Iterator[tuple[str, bytes]]:
    """Yield the files of the large sheets, as (file name, content). A PDF contains all sheets.

    Args:
        results: computed results.
        paper: largest paper size, a key of PAPERS.
        formats: names of file formats.
        say: called with notes for the user.
        runner: draws and writes, for example on several cores.
        all_positions: draw motion plans of all positions, not only of the detailed ones.

    Raises:
        ProblemError: There are too many motion plans, or a drawing does not fit on the paper.
    """
    choice = choose_positions(results, all_positions=all_positions)
    refuse_plans(len(choice.plans))
    if choice.moves and not choice.loaded:
        say(_("note: there are no weights and no loads, so the force analysis sheet is not drawn"))
    sheets = dict(large_sheets(choice, paper, runner))
    jobs: list[tuple[str, Callable[[], bytes]]] = []
    for name in formats:
        if name in WITH_PAGES:
            jobs.append((f"sheets.{name}", partial(WITH_PAGES[name], *sheets.values())))
        else:
            jobs += [(f"{stem}.{name}", partial(FORMATS[name], sheet)) for stem, sheet in sheets.items()]
    yield from zip((file for file, __ in jobs), runner([job for __, job in jobs]), strict=True)
    for note in missing_character_notes(text for sheet in sheets.values() for text in sheet.texts()):
        say(note)
