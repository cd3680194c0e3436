"""Texts in cells: broken between words, and cut, where their measured width is more than there is room for."""

from __future__ import annotations

from tmm_cli.drawing.paper.fonts import ALIGN_SHARE, text_width
from tmm_cli.drawing.paper.record import Align, TextMark

DARK_COLOUR = "#1a1a1a"
ELLIPSIS = "…"
LEAST_TEXT_SHARE = 0.75  # of its size: a text is made that much smaller before it is cut
CELL_GAP = 0.8  # mm between a text and the lines of its cell
NARROWING = 0.01  # of the size: by how much a room in which the longest line has no place is narrower than that
LINE_SPACING = 1.25  # of the size: from line to line


def cut_text(text: str, size: float, room: float, *, bold: bool = False) -> str:
    """As much of a text as the room (mm) has place for."""
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
    """A text in lines that fit the room (mm), at most so many and about equally long; the last one is cut."""
    found = narrower = _fill_lines(text, size, room, most, bold)
    while 1 < len(narrower) == len(found) and " ".join(narrower) == " ".join(found):
        found = narrower
        room = max(text_width(line, size, bold=bold) for line in found) - NARROWING * size
        narrower = _fill_lines(text, size, room, most, bold)
    return found


def _fill_lines(text: str, size: float, room: float, most: int, bold: bool) -> list[str]:
    """Lines each as long as there is room for."""
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
    """A text in the middle of a cell with these corners (mm), smaller or cut where it is too long for it."""
    room = (high - low).real - 2 * CELL_GAP
    smaller = next(
        (s for s in (size, 0.87 * size, LEAST_TEXT_SHARE * size) if _fits_cell(text, s, room, lines, bold)),
        LEAST_TEXT_SHARE * size,
    )
    found = wrap_text(text, smaller, room, lines, bold=bold)
    x = low.real + CELL_GAP + ALIGN_SHARE[align] * room
    top = (low + high).imag / 2 + LINE_SPACING * smaller * (len(found) - 1) / 2
    places = [complex(x, top - LINE_SPACING * smaller * k) for k in range(len(found))]
    return [TextMark(at, line, smaller, DARK_COLOUR, align, bold) for at, line in zip(places, found, strict=True)]


def fit_one_line(text: str, size: float, room: float, *, bold: bool = False) -> tuple[str, float]:
    """A text on one line of this room (mm) and its size, smaller or cut where it is too long for it."""
    words = " ".join(text.split())
    smaller = (
        max(min(1.0, room / max(text_width(words[: int(8 * room / size)], size, bold=bold), room)), LEAST_TEXT_SHARE)
        * size
    )
    return cut_text(words, smaller, room, bold=bold), smaller


def _fits_cell(text: str, size: float, room: float, lines: int, bold: bool) -> bool:
    words = " ".join(text.split())[: int(8 * room * lines / size) + 1]
    found = wrap_text(words, size, room, lines, bold=bold)
    return " ".join(found) == words
