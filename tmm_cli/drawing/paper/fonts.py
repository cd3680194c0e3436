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

from tmm_cli.drawing.paper.record import Text

FAMILY = "DejaVu Sans"
SHARE = {"left": 0.0, "center": 0.5, "right": 1.0}  # of the width, from the left end to where a text is put
HALF = 0.265  # of the size: from the base line to the middle of the letters' height
BOX = "\u25a1"  # stands for what the font lacks
UNITS = 1000  # the size at which advances are read


def font_file(bold: bool = False, italic: bool = False) -> Path:
    """The file of the font of a weight and slant."""
    ending = ("Bold" if bold else "") + ("Oblique" if italic else "")
    return Path(mpl.get_data_path(), "fonts", "ttf", f"DejaVuSans-{ending}.ttf" if ending else "DejaVuSans.ttf")


@cache
def font(bold: bool = False, italic: bool = False) -> FT2Font:
    """The font of a weight and slant, read whole: forked processes would share the place in an open file."""
    found = FT2Font(BytesIO(font_file(bold, italic).read_bytes()))
    found.set_size(UNITS, 72)
    return found


@cache
def _letter(letter: str, bold: bool, italic: bool) -> tuple[float, NDArray[Any], NDArray[Any]]:
    """Of size 1: its advance, the places of its outline (x + iy, from its foot on), and matplotlib's codes of them."""
    glyph = font(bold, italic).load_char(ord(drawable(letter)))
    places, codes = font(bold, italic).get_path()
    return float(glyph.linearHoriAdvance) / 65536 / UNITS, (places[:, 0] + 1j * places[:, 1]) / UNITS, codes


def advance(letter: str, bold: bool = False, italic: bool = False) -> float:
    """How far on the next letter stands, of its size."""
    return _letter(letter, bold, italic)[0]


@lru_cache(10_000)
def _width(text: str, bold: bool, italic: bool) -> float:
    return sum(advance(letter, bold, italic) for letter in text)


def width(text: str, size: float, *, bold: bool = False, italic: bool = False) -> float:
    """Width of a line of text, in the unit of its size."""
    return size * _width(text, bold, italic)


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


def start(mark: Text) -> complex:
    """The left end of a text, at half the height of its letters, mm."""
    left = SHARE[mark.align] * width(mark.text, mark.size, bold=mark.bold, italic=mark.italic)
    return mark.at - left * cmath.rect(1, math.radians(mark.turn))


def foot(mark: Text) -> tuple[complex, complex]:
    """The left end of the base line of a text, mm, and the way along it."""
    along = cmath.rect(1, math.radians(mark.turn))
    return start(mark) - 1j * HALF * mark.size * along, along


def corners(mark: Text) -> tuple[complex, complex, complex, complex]:
    """Corners of the box of a text, from the lower left one on, mm."""
    along = cmath.rect(1, math.radians(mark.turn))
    low = start(mark) - 0.5j * mark.size * along
    end = low + width(mark.text, mark.size, bold=mark.bold, italic=mark.italic) * along
    up = 1j * mark.size * along
    return low, end, end + up, low + up


@cache
def _letters() -> frozenset[int]:
    return frozenset(font().get_charmap())


def drawable(text: str) -> str:
    """The text with boxes in the place of characters that the font lacks."""
    known = _letters()
    return "".join(letter if ord(letter) in known else BOX for letter in text)


def lacking(text: str) -> set[str]:
    """Characters for which the font has no letter: boxes stand for them."""
    known = _letters()
    return {letter for letter in text if ord(letter) not in known}
