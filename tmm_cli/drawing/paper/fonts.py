"""Letters of DejaVu Sans, the font that comes with matplotlib: how wide a text is, and its outlines."""

from __future__ import annotations

import cmath
import math
from functools import cache, lru_cache
from io import BytesIO
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.ft2font import FT2Font
from numpy.typing import NDArray

from tmm_cli.drawing.paper.record import TextMark

FONT_FAMILY = "DejaVu Sans"
ALIGN_SHARE = {"left": 0.0, "center": 0.5, "right": 1.0}  # of the width, from the left end to where a text is put
BASELINE_SHARE = 0.265  # of the size: from the base line to the middle of the letters' height
MISSING_GLYPH = "\u25a1"  # stands for what the font lacks
FONT_UNITS = 1000  # the size at which advances are read


def font_file(bold: bool = False, italic: bool = False) -> Path:
    """The file of the font of a weight and slant."""
    ending = ("Bold" if bold else "") + ("Oblique" if italic else "")
    return Path(mpl.get_data_path(), "fonts", "ttf", f"DejaVuSans-{ending}.ttf" if ending else "DejaVuSans.ttf")


@cache
def load_font(bold: bool = False, italic: bool = False) -> FT2Font:
    """The font of a weight and slant, read whole: forked processes would share the place in an open file."""
    found = FT2Font(BytesIO(font_file(bold, italic).read_bytes()))
    found.set_size(FONT_UNITS, 72)
    return found


@cache
def _letter(letter: str, bold: bool, italic: bool) -> tuple[float, NDArray[Any], NDArray[Any]]:
    """Of size 1: its advance, the places of its outline (x + iy, from its foot on), and matplotlib's codes of them."""
    glyph = load_font(bold, italic).load_char(ord(replace_missing(letter)))
    places, codes = load_font(bold, italic).get_path()
    return float(glyph.linearHoriAdvance) / 65536 / FONT_UNITS, (places[:, 0] + 1j * places[:, 1]) / FONT_UNITS, codes


def letter_advance(letter: str, bold: bool = False, italic: bool = False) -> float:
    """How far on the next letter stands, of its size."""
    return _letter(letter, bold, italic)[0]


@lru_cache(10_000)
def _unit_width(text: str, bold: bool, italic: bool) -> float:
    return sum(letter_advance(letter, bold, italic) for letter in text)


def text_width(text: str, size: float, *, bold: bool = False, italic: bool = False) -> float:
    """Width of a line of text, in the unit of its size."""
    return size * _unit_width(text, bold, italic)


@lru_cache(1000)
def glyph_outline(text: str, *, bold: bool = False, italic: bool = False) -> tuple[NDArray[Any], NDArray[Any]]:
    """Of a line of text of size 1: places from the left end of its base line on, and matplotlib's codes of them."""
    along, places, codes = 0.0, [], []
    for letter in text:
        advance, own, its_codes = _letter(letter, bold, italic)
        places.append(own + along)
        codes.append(its_codes)
        along += advance
    return np.concatenate(places), np.concatenate(codes)


def text_start(mark: TextMark) -> complex:
    """The left end of a text, at half the height of its letters, mm."""
    left = ALIGN_SHARE[mark.align] * text_width(mark.text, mark.size, bold=mark.bold, italic=mark.italic)
    return mark.at - left * cmath.rect(1, math.radians(mark.turn))


def baseline(mark: TextMark) -> tuple[complex, complex]:
    """The left end of the base line of a text, mm, and the way along it."""
    along = cmath.rect(1, math.radians(mark.turn))
    return text_start(mark) - 1j * BASELINE_SHARE * mark.size * along, along


def text_corners(mark: TextMark) -> tuple[complex, complex, complex, complex]:
    """Corners of the box of a text, from the lower left one on, mm."""
    along = cmath.rect(1, math.radians(mark.turn))
    low = text_start(mark) - 0.5j * mark.size * along
    end = low + text_width(mark.text, mark.size, bold=mark.bold, italic=mark.italic) * along
    up = 1j * mark.size * along
    return low, end, end + up, low + up


@cache
def _font_letters() -> frozenset[int]:
    return frozenset(load_font().get_charmap())


def replace_missing(text: str) -> str:
    """The text with boxes in the place of characters that the font lacks."""
    known = _font_letters()
    return "".join(letter if ord(letter) in known else MISSING_GLYPH for letter in text)


def missing_characters(text: str) -> set[str]:
    """Characters for which the font has no letter: boxes stand for them."""
    known = _font_letters()
    return {letter for letter in text if ord(letter) not in known}
