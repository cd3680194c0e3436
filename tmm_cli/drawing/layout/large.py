"""The large sheets of a project: drawings made as large as fits, put beside one another, framed."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import accumulate, islice, product, repeat

from tmm_cli.drawing.formats import Way, here
from tmm_cli.drawing.layout.contents import CONTENTS, SUBJECTS, Choice, Source, neighbours
from tmm_cli.drawing.layout.packing import SIZES, Field, Size, Titles, arranged, frame, inner, pack, spread, title_block
from tmm_cli.drawing.layout.pieces import (
    FLAT,
    FULL,
    GAP,
    STRICT,
    THIN,
    Page,
    Piece,
    area,
    begun,
    eased,
    evenest,
    filled,
    grown,
    lettered,
    ordered,
    shared,
    spaced,
    tidier,
)
from tmm_cli.drawing.paper import LEAST_PAPER, Drawing, Picture, Space, within
from tmm_cli.language import _
from tmm_cli.problem import ProblemError

PAPERS = {"A1": (841.0, 594.0), "A2": (594.0, 420.0), "A3": (420.0, 297.0)}
EDGE = 6.0  # mm between the frame and what is drawn
LETTERS = (0.85, 1.6)  # of a table, to how they come: the smallest and the largest
MANY, SMALLEST = 1.5, 0.45  # positions beyond which drawings of each are smaller, and how much smaller at most
NOTABLE = 1.1  # times larger: it is drawn again
EASED = 0.75  # of its room: so much smaller something is tried where it became larger than thought
TRIES = 5  # of that
ROUNDS, MORE = 3, 8  # of making larger what there proves to be room for; where a page stays thin


@dataclass(frozen=True)
class LargeSheet(Drawing):
    """A framed sheet; pictures: what stands on it, each with its lower left corner (mm)."""

    pictures: tuple[tuple[complex, Picture], ...] = ()


def large_sheets(choice: Choice, paper: str, way: Way = here) -> Iterator[tuple[str, LargeSheet]]:
    """Every sheet with its file's stem, numbered from 1; what does not fit on one goes on on the next. way: who draws.

    That of the structure, which has no scale, is on the smallest format that holds it.
    """
    problem = choice.results.problem
    smaller = [name for name in reversed(PAPERS) if PAPERS[name] <= PAPERS[paper]]
    jobs = [partial(_smallest, number, choice, [paper] if number else smaller) for number in range(len(SUBJECTS))]
    found = list(way(jobs))
    count = sum(len(pages) for *__, pages in found)
    every = [(subject, size, pictures, page) for subject, (size, pictures, pages) in enumerate(found) for page in pages]
    for number, (subject, size, pictures, page) in enumerate(every, 1):
        field, name = field_of(size, problem.title_texts.block), SUBJECTS[subject][0]
        titles = Titles(problem.title_texts, problem.title, _(choice.title(subject)), number, count)
        stem = f"sheet-{number:0{len(str(count))}}-{name}"
        yield stem, framed([pictures[k] for k in page], field, size, titles)


def _smallest(number: int, choice: Choice, papers: Sequence[str]) -> tuple[Size, list[Picture], list[Page]]:
    """The drawings of a sheet on the first of these formats that holds them on one page, or else on the last one; where
    they leave that thin, on the next smaller one that holds them so.
    """
    for paper in papers:
        size, pictures, pages = found = _on(paper, number, choice)
        if len(pages) < 2:
            break
    field = field_of(size, choice.results.problem.title_texts.block)
    smaller = next((name for name in PAPERS if PAPERS[name] < size), None)
    if smaller is None or len(pages) != 1 or _thinnest((pictures, pages)) > FULL * field.area:
        return found
    tried = _on(smaller, number, choice)
    return tried if len(tried[2]) == 1 else found


def _on(paper: str, number: int, choice: Choice) -> tuple[Size, list[Picture], list[Page]]:
    size = PAPERS[paper]
    return size, *_fullest(number, choice, size, field_of(size, choice.results.problem.title_texts.block))


def _fullest(number: int, choice: Choice, paper: Size, field: Field) -> tuple[list[Picture], list[Page]]:
    """The drawings of a sheet; where a page stays thin, once more, high ones as high as is free above the titles, or
    lower.
    """
    found = _sheet(number, choice, paper, field, field.height - GAP)
    for high in (field.height - field.taken[1] - GAP, *(share * field.height for share in FLAT)):
        if _thinnest(found) > THIN * field.area:
            break
        if any(one.paper[1] > high for one in found[0]):
            flat = _sheet(number, choice, paper, field, high)
            found = min(found, flat, key=lambda one: (len(one[1]), -_thinnest(one)))
    return found


def _thinnest(found: tuple[list[Picture], list[Page]]) -> float:
    """What is drawn on the emptiest page, mm²."""
    pictures, pages = found
    return min((area([one.paper for one in pictures], page) for page in pages), default=0.0)


def field_of(paper: Size, block: str) -> Field:
    """What is free for drawings, each with the gap to its right and below it."""
    low, high = inner(paper)
    room, taken = high - low - (2 * EDGE - GAP) * (1 + 1j), SIZES[block]
    return Field(room.real, room.imag, (taken[0] - EDGE + GAP, taken[1] - EDGE + GAP))


def _sheet(number: int, choice: Choice, paper: Size, field: Field, high: float) -> tuple[list[Picture], list[Page]]:
    """All drawings of a sheet, and which of them stand on which of its pages.

    high: how high a drawing becomes if it can be folded, mm.
    """
    shrunk, most = max(paper) / max(PAPERS["A1"]), (field.width - GAP, high)
    asked = [(source, choice, most) for source in CONTENTS if source.sheet == number]
    parts = [_first(*one, shrunk) for one in asked]
    lengths, every = [len(part) for part in parts], [piece for part in parts for piece in part]
    order = neighbours((one[0], piece.drawn.stem) for one, part in zip(asked, parts, strict=True) for piece in part)
    pieces = [every[k] for k in order]

    def drawn(rooms: Sequence[float]) -> list[Piece]:
        """The same pieces in other rooms, source by source."""
        back = sorted(range(len(order)), key=order.__getitem__)
        old, new = [pieces[k] for k in back], [rooms[k] for k in back]
        starts = accumulate(lengths, initial=0)
        slices = [slice(start, start + length) for start, length in zip(starts, lengths, strict=False)]
        again = [_again(*one, old[own], new[own]) for one, own in zip(asked, slices, strict=True)]
        found = [piece for part in again for piece in part]
        return [found[k] for k in order]

    rooms, pages = begun(pieces, field, shrunk)
    free = [k for k, piece in enumerate(pieces) if not piece.length]
    begin = eased(pieces, rooms, EASED, free)
    for wanted in (shared(pieces, begin, pages, field, shrunk)[0], grown(pieces, begin, pages, field, shrunk)):
        larger = drawn(wanted)
        held = filled(_sizes(larger), field)
        if held is not None and len(held) <= len(pages):
            pieces, pages = larger, held
            break
    else:  # something became larger than thought
        large = list(range(len(pieces)))
        for __ in range(TRIES):
            rooms = eased(pieces, rooms, EASED, large)
            pieces = drawn(rooms)
            large = [k for k in large if pack(spaced(_sizes(pieces), [k]), field) is None]
            if not large:
                break
        pages = fitting([piece.drawn for piece in pieces], field)
    for number in range(MORE):
        thin = _thinnest(([piece.drawn for piece in pieces], pages)) < THIN * field.area
        if number >= ROUNDS and not thin:
            break
        before = _rooms(pieces)
        rooms, pages = shared(pieces, before, pages, field, shrunk)
        if all(room <= (1.0 if thin else NOTABLE) * old for room, old in zip(rooms, before, strict=True)):
            break
        larger = drawn(rooms)
        found = _taken(pieces, larger, pages, field)
        pieces = [  # what had no room is tried half as much larger
            one if one is new else replace(one, most=(old + room) / 2)
            for one, new, old, room in zip(found, larger, before, rooms, strict=True)
        ]
    pages = evenest(_sizes(pieces), pages, field)
    return [piece.drawn for piece in _tidied(pieces, pages, field, drawn)], pages


def _tidied(
    pieces: list[Piece], pages: Sequence[Page], field: Field, drawn: Callable[[Sequence[float]], list[Piece]]
) -> list[Piece]:
    """The same with letters of about one size on each page; smaller ones where that brings a page into its order."""
    for page in pages:
        tried = drawn(lettered(pieces, _rooms(pieces), page))
        if pack(spaced(_sizes(tried), page), field) is not None:
            pieces = tried
        if ordered(_sizes(pieces), page, field):
            continue
        for tried in map(drawn, islice(tidier(pieces, _rooms(pieces), page, field), TRIES)):
            sizes = _sizes(tried)
            if area(sizes, page) > THIN * field.area and ordered(sizes, page, field):
                pieces = tried
                break
    return pieces


def _rooms(pieces: Sequence[Piece]) -> list[float]:
    """What they were drawn for, mm."""
    return [piece.drawn.longest or piece.usual for piece in pieces]


def _taken(pieces: Sequence[Piece], larger: Sequence[Piece], pages: Sequence[Page], field: Field) -> list[Piece]:
    """Those of the larger pieces for which there really is room, one after the other."""
    found = list(pieces)
    for page, (led, tidy, enough) in product(pages, STRICT):
        if area(_sizes(found), page) < enough * field.area:
            for number in page:
                tried = [*found[:number], larger[number], *found[number + 1 :]]
                if pack(spaced(_sizes(tried), page), field, led=led, tidy=tidy) is not None:
                    found = tried
    return found


def _sizes(pieces: Sequence[Piece]) -> list[Size]:
    return [piece.drawn.paper for piece in pieces]


def fitting(pictures: Sequence[Picture], field: Field) -> list[Page]:
    """Pages for drawings as they are. Raises ProblemError where one is larger than the field."""
    for one in pictures:
        if pack(spaced([one.paper], [0]), field) is None:
            raise ProblemError(_("{name} is larger than the sheet").format(name=one.stem), allowed=_("a larger format"))
    return filled([one.paper for one in pictures], field) or []


def _first(source: Source, choice: Choice, most: Size, shrunk: float) -> list[Piece]:
    """The drawings of a source as large as usual."""
    number = len(getattr(choice, source.over)) if source.over else 1
    usual = source.usual and source.usual * max(SMALLEST, min(1.0, math.sqrt(MANY / max(number, 1))))
    pictures = _drawn(source, choice, most, repeat(usual and usual * shrunk))
    if usual is None:
        least, largest = LETTERS
        return [
            Piece(one, one.longest / shrunk, least * one.longest, largest * one.longest, letters=True)
            for one in pictures
        ]
    return [Piece(one, usual, 0.0 if one.figure else LEAST_PAPER) for one in pictures]


def _again(source: Source, choice: Choice, most: Size, pieces: list[Piece], rooms: Sequence[float]) -> list[Piece]:
    """The same in other rooms, where they are other ones."""
    if all(math.isclose(piece.drawn.longest, room) for piece, room in zip(pieces, rooms, strict=True)):
        return pieces
    pictures = _drawn(source, choice, most, rooms)
    return [replace(piece, drawn=picture) for piece, picture in zip(pieces, pictures, strict=True)]


def _drawn(source: Source, choice: Choice, most: Size, rooms: Iterable[float | None]) -> list[Picture]:
    """The drawings of a source, each in its room."""
    every, found = iter(source.drawings(choice)), list[Picture]()
    for room in rooms:
        with within(Space(room, most)):
            drawn = next(every, None)
        if drawn is None:
            break
        if isinstance(drawn[1], Picture):
            found.append(replace(drawn[1], stem=drawn[0]))
    return found


def framed(pictures: Sequence[Picture], field: Field, paper: Size, titles: Titles) -> LargeSheet:
    """A sheet with these pictures on its field."""
    sizes = [(picture.paper[0] + GAP, picture.paper[1] + GAP) for picture in pictures]
    places = spread(arranged(sizes, field) or [], sizes, field)
    low, high = inner(paper)
    corner = complex(low.real + EDGE, high.imag - EDGE)
    placed = [(corner + complex(x, -y - one.paper[1]), one) for (x, y), one in zip(places, pictures, strict=True)]
    marks = [mark for at, one in placed for mark in one.moved(at).marks]
    block = title_block(titles, complex(high.real, low.imag))
    return LargeSheet(paper, (*marks, frame(paper), *block), tuple(placed))
