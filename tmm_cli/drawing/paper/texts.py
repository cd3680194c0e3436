"""Texts on paper: widths and outlines of letters, symbols with indices, line breaks, texts in cells of a table."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable, Iterator
from functools import cache, lru_cache
from io import BytesIO
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.ft2font import FT2Font
from numpy.typing import NDArray

from tmm_cli.drawing.paper.record import Align, TextMark
from tmm_cli.language import signed, typeset
from tmm_cli.mechanics.forces import Symbol

FONT_FAMILY = "DejaVu Sans"
ALIGN_SHARE = {"left": 0.0, "center": 0.5, "right": 1.0}  # anchor, as a share of the width
BASELINE_SHARE = 0.265  # of the font size: from the baseline to half the height of the letters
MISSING_GLYPH = "\u25a1"  # replaces characters that the font lacks
FONT_UNITS = 1000  # the size at which advances are read


def font_file(bold: bool = False, italic: bool = False) -> Path:
    """Return the path of the font file for this weight and slant."""
    ending = ("Bold" if bold else "") + ("Oblique" if italic else "")
    return Path(mpl.get_data_path(), "fonts", "ttf", f"DejaVuSans-{ending}.ttf" if ending else "DejaVuSans.ttf")


@cache
def load_font(bold: bool = False, italic: bool = False) -> FT2Font:
    """Load the whole font file of this weight and slant into memory.

    If the file stayed open, forked processes would share its read position.
    """
    font = FT2Font(BytesIO(font_file(bold, italic).read_bytes()))
    font.set_size(FONT_UNITS, 72)
    return font


@cache
def _letter(letter: str, bold: bool, italic: bool) -> tuple[float, NDArray[Any], NDArray[Any]]:
    """Return the advance width, outline and matplotlib path codes of a letter at font size 1.

    The points of the outline are x + iy, measured from the left end of the baseline.
    """
    glyph = load_font(bold, italic).load_char(ord(replace_missing(letter)))
    points, codes = load_font(bold, italic).get_path()
    return float(glyph.linearHoriAdvance) / 65536 / FONT_UNITS, (points[:, 0] + 1j * points[:, 1]) / FONT_UNITS, codes


def letter_advance(letter: str, bold: bool = False, italic: bool = False) -> float:
    """Return the advance width of a letter, as a fraction of the font size."""
    return _letter(letter, bold, italic)[0]


@lru_cache(10_000)
def _unit_width(text: str, bold: bool, italic: bool) -> float:
    return sum(letter_advance(letter, bold, italic) for letter in text)


def text_width(text: str, size: float, *, bold: bool = False, italic: bool = False) -> float:
    """Return the width of a line of text, in the unit of the font size."""
    return size * _unit_width(text, bold, italic)


@lru_cache(1000)
def glyph_outline(text: str, *, bold: bool = False, italic: bool = False) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return the outline and the matplotlib path codes of a text at font size 1.

    The points of the outline are x + iy, measured from the left end of the baseline.
    """
    along, points, codes = 0.0, [], []
    for letter in text:
        advance, letter_points, its_codes = _letter(letter, bold, italic)
        points.append(letter_points + along)
        codes.append(its_codes)
        along += advance
    return np.concatenate(points), np.concatenate(codes)


def text_start(mark: TextMark) -> complex:
    """Return the left end of a text at half the height of its letters, mm."""
    left = ALIGN_SHARE[mark.align] * text_width(mark.text, mark.size, bold=mark.bold, italic=mark.italic)
    return mark.at - left * cmath.rect(1, math.radians(mark.turn))


def baseline(mark: TextMark) -> tuple[complex, complex]:
    """Return the left end of the baseline of a text (mm) and the unit vector along it."""
    along = cmath.rect(1, math.radians(mark.turn))
    return text_start(mark) - 1j * BASELINE_SHARE * mark.size * along, along


def text_corners(mark: TextMark) -> tuple[complex, complex, complex, complex]:
    """Return the corners of a text's box (mm), counterclockwise from the lower left."""
    along = cmath.rect(1, math.radians(mark.turn))
    low = text_start(mark) - 0.5j * mark.size * along
    end = low + text_width(mark.text, mark.size, bold=mark.bold, italic=mark.italic) * along
    up = 1j * mark.size * along
    return low, end, end + up, low + up


@cache
def _font_letters() -> frozenset[int]:
    return frozenset(load_font().get_charmap())


def replace_missing(text: str) -> str:
    """Replace each character that is missing in the font by a box."""
    available = _font_letters()
    return "".join(letter if ord(letter) in available else MISSING_GLYPH for letter in text)


def missing_characters(text: str) -> set[str]:
    """Return the characters of a text that are missing in the font."""
    available = _font_letters()
    return {letter for letter in text if ord(letter) not in available}


Words = str | Symbol | tuple[str | Symbol, ...]

INDEX_SIZE = 0.68  # size of indices
INDEX_BELOW, INDEX_ABOVE = -0.30, 0.36  # of the font size: offset of the middle of an index


def split_symbols(words: Words) -> tuple[str | Symbol, ...]:
    """Split a text into plain strings and symbols with indices, with typographic minus signs in the strings."""
    several = words if isinstance(words, tuple) else (words,)
    return tuple(signed(typeset(piece)) if isinstance(piece, str) else piece for piece in several)


def plain_text(words: Words) -> str:
    """Write a text as a plain string, with indices as in a^n_BA."""
    return "".join(
        piece
        if isinstance(piece, str)
        else piece.letter + (f"^{piece.above}" if piece.above else "") + (f"_{piece.below}" if piece.below else "")
        for piece in split_symbols(words)
    )


def placed_pieces(words: Words, size: float) -> Iterator[tuple[complex, str, float]]:
    """Yield the pieces of a text with indices, as (offset from the left end, letters, font size)."""
    at = 0.0
    for piece in split_symbols(words):
        if isinstance(piece, str):
            yield complex(at), piece, size
        else:
            yield complex(at), piece.letter, size
            foot, small = at + text_width(piece.letter, size), INDEX_SIZE * size
            for text, off in ((piece.below, INDEX_BELOW), (piece.above, INDEX_ABOVE)):
                if text:
                    yield complex(foot, off * size), text, small
        at += script_width(piece, size)


@lru_cache(10_000)
def script_width(words: Words, size: float) -> float:
    """Return the width of a text with indices, in the unit of the font size."""
    return sum(
        text_width(piece, size)
        if isinstance(piece, str)
        else text_width(piece.letter, size)
        + INDEX_SIZE * max(text_width(piece.below, size), text_width(piece.above, size))
        for piece in split_symbols(words)
    )


@lru_cache(1000)
def wrap_symbols(words: Words, size: float, most: float, hanging: str = "") -> tuple[Words, ...]:
    """Break a text with indices at spaces into lines no wider than `most`.

    The last word, which may be a unit, stays on one line with the word before it.

    hanging: indent of all lines but the first.
    """
    lines: list[Words] = []
    line: list[str | Symbol] = []
    wide = 0.0
    *tokens, before, last = ((), (), *_split_at_spaces(words))
    for token in (*tokens, (*before, *last)):
        token_width = script_width(token, size)
        if line and wide + token_width > most:
            lines.append(_join_texts(line))
            line, wide = [hanging], script_width(hanging, size)
        line += token
        wide += token_width
    return (*lines, _join_texts(line))


def _join_texts(line: Iterable[str | Symbol]) -> tuple[str | Symbol, ...]:
    """Join consecutive strings into one."""
    joined: list[str | Symbol] = []
    for piece in line:
        if joined and isinstance(piece, str) and isinstance(joined[-1], str):
            joined[-1] += piece
        else:
            joined.append(piece)
    return tuple(joined)


def _split_at_spaces(words: Words) -> Iterator[tuple[str | Symbol, ...]]:
    """Yield the words of a text, each with the space before it."""
    token: list[str | Symbol] = []
    for piece in split_symbols(words):
        first, *others = piece.split(" ") if isinstance(piece, str) else [piece]
        token.append(first)
        for other in others:
            yield tuple(token)
            token = [f" {other}"]
    yield tuple(token)


DARK_COLOUR = "#1a1a1a"
ELLIPSIS = "…"
LEAST_TEXT_SHARE = 0.75  # of the font size: a text is reduced to this before it is cut
CELL_GAP = 0.8  # mm between a text and the lines of its cell
NARROWING = 0.01  # of the font size: a trial width is this much less than the longest line
LINE_SPACING = 1.25  # of the font size


def cut_text(text: str, size: float, room: float, *, bold: bool = False) -> str:
    """Shorten a text so that it is no wider than `room` mm. An ellipsis shows where it is cut."""
    text = text[: max(int(8 * room / size), 1)]  # no letter of a line is narrower on average; measuring takes time
    if text_width(text, size, bold=bold) <= room:
        return text
    low, high = 0, len(text)
    while high - low > 1:
        middle = (low + high) // 2
        fits = text_width(text[:middle].rstrip() + ELLIPSIS, size, bold=bold) <= room
        low, high = (middle, high) if fits else (low, middle)
    return text[:low].rstrip() + ELLIPSIS


def wrap_text(text: str, size: float, room: float, most: int, *, bold: bool = False) -> list[str]:
    """Break a text into at most `most` lines of about equal length, no wider than `room` mm.

    If the text is too long, its last line is cut.
    """
    lines = narrower = _fill_lines(text, size, room, most, bold)
    while 1 < len(narrower) == len(lines) and " ".join(narrower) == " ".join(lines):
        lines = narrower
        room = max(text_width(line, size, bold=bold) for line in lines) - NARROWING * size
        narrower = _fill_lines(text, size, room, most, bold)
    return lines


def _fill_lines(text: str, size: float, room: float, most: int, bold: bool) -> list[str]:
    """Break a text into at most `most` lines, each as long as possible."""
    lines: list[str] = []
    left = text.split()
    while left and len(lines) < most - 1:
        count = 1
        while count < len(left) and text_width(" ".join(left[: count + 1]), size, bold=bold) <= room:
            count += 1
        lines.append(cut_text(" ".join(left[:count]), size, room, bold=bold))
        left = left[count:]
    return [*lines, cut_text(" ".join(left), size, room, bold=bold)] if left else lines


def cell_text(
    text: str, low: complex, high: complex, size: float, align: Align = "center", *, lines: int = 1, bold: bool = False
) -> list[TextMark]:
    """Return a text for a cell of a table. If it is too long, its font is reduced; if this is not enough, it is cut.

    Args:
        text: the text.
        low, high: lower left and upper right corner of the cell, mm.
        size: font size, mm.
        align: horizontal alignment.
        lines: largest number of lines.
        bold: True for bold letters.
    """
    room = (high - low).real - 2 * CELL_GAP
    smaller = next(
        (s for s in (size, 0.87 * size, LEAST_TEXT_SHARE * size) if _fits_cell(text, s, room, lines, bold)),
        LEAST_TEXT_SHARE * size,
    )
    fitted = wrap_text(text, smaller, room, lines, bold=bold)
    x = low.real + CELL_GAP + ALIGN_SHARE[align] * room
    top = (low + high).imag / 2 + LINE_SPACING * smaller * (len(fitted) - 1) / 2
    anchors = [complex(x, top - LINE_SPACING * smaller * k) for k in range(len(fitted))]
    return [TextMark(at, line, smaller, DARK_COLOUR, align, bold) for at, line in zip(anchors, fitted, strict=True)]


def fit_one_line(text: str, size: float, room: float, *, bold: bool = False) -> tuple[str, float]:
    """Fit a text into one line of `room` mm. If it is too long, its font is reduced; if this is not enough, it is cut.

    Returns:
        The text, and its font size.
    """
    words = " ".join(text.split())
    smaller = (
        max(min(1.0, room / max(text_width(words[: int(8 * room / size)], size, bold=bold), room)), LEAST_TEXT_SHARE)
        * size
    )
    return cut_text(words, smaller, room, bold=bold), smaller


def _fits_cell(text: str, size: float, room: float, lines: int, bold: bool) -> bool:
    words = " ".join(text.split())[: int(8 * room * lines / size) + 1]
    fitted = wrap_text(words, size, room, lines, bold=bold)
    return " ".join(fitted) == words
