"""Texts in cells: broken between words, and cut, where their measured width is more than there is room for."""

from __future__ import annotations

from tmm_cli.drawing.paper.fonts import SHARE, width
from tmm_cli.drawing.paper.record import Align, Text

DARK = "#1a1a1a"
CUT = "…"
LEAST = 0.75  # of its size: a text is made that much smaller before it is cut
GAP = 0.8  # mm between a text and the lines of its cell
SHORTER = 0.01  # of the size: by how much a room in which the longest line has no place is narrower than that
LINE = 1.25  # of the size: from line to line


def cut(text: str, size: float, room: float, *, bold: bool = False) -> str:
    """As much of a text as the room (mm) has place for."""
    text = text[: max(int(8 * room / size), 1)]  # no letter of a line is narrower on average; measuring takes time
    if width(text, size, bold=bold) <= room:
        return text
    low, high = 0, len(text)
    while high - low > 1:
        middle = (low + high) // 2
        fits = width(text[:middle].rstrip() + CUT, size, bold=bold) <= room
        low, high = (middle, high) if fits else (low, middle)
    return text[:low].rstrip() + CUT


def wrap(text: str, size: float, room: float, most: int, *, bold: bool = False) -> list[str]:
    """A text in lines that fit the room (mm), at most so many and about equally long; the last one is cut."""
    found = narrower = _wrapped(text, size, room, most, bold)
    while 1 < len(narrower) == len(found) and " ".join(narrower) == " ".join(found):
        found = narrower
        room = max(width(line, size, bold=bold) for line in found) - SHORTER * size
        narrower = _wrapped(text, size, room, most, bold)
    return found


def _wrapped(text: str, size: float, room: float, most: int, bold: bool) -> list[str]:
    """Lines each as long as there is room for."""
    lines: list[str] = []
    left = text.split()
    while left and len(lines) < most - 1:
        count = 1
        while count < len(left) and width(" ".join(left[: count + 1]), size, bold=bold) <= room:
            count += 1
        lines.append(cut(" ".join(left[:count]), size, room, bold=bold))
        left = left[count:]
    return [*lines, cut(" ".join(left), size, room, bold=bold)] if left else lines


def written(
    text: str, low: complex, high: complex, size: float, align: Align = "center", *, lines: int = 1, bold: bool = False
) -> list[Text]:
    """A text in the middle of a cell with these corners (mm), smaller or cut where it is too long for it."""
    room = (high - low).real - 2 * GAP
    smaller = next((s for s in (size, 0.87 * size, LEAST * size) if _fits(text, s, room, lines, bold)), LEAST * size)
    found = wrap(text, smaller, room, lines, bold=bold)
    x = low.real + GAP + SHARE[align] * room
    top = (low + high).imag / 2 + LINE * smaller * (len(found) - 1) / 2
    places = [complex(x, top - LINE * smaller * k) for k in range(len(found))]
    return [Text(at, line, smaller, DARK, align, bold) for at, line in zip(places, found, strict=True)]


def in_a_line(text: str, size: float, room: float, *, bold: bool = False) -> tuple[str, float]:
    """A text on one line of this room (mm) and its size, smaller or cut where it is too long for it."""
    words = " ".join(text.split())
    smaller = max(min(1.0, room / max(width(words[: int(8 * room / size)], size, bold=bold), room)), LEAST) * size
    return cut(words, smaller, room, bold=bold), smaller


def _fits(text: str, size: float, room: float, lines: int, bold: bool) -> bool:
    words = " ".join(text.split())[: int(8 * room * lines / size) + 1]
    found = wrap(words, size, room, lines, bold=bold)
    return " ".join(found) == words
