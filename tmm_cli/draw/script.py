"""Texts with indices: a^n_BA is written in pieces, letters below and above the line, so that every format has them."""

from __future__ import annotations

from collections.abc import Iterator

from tmm_cli.draw import fonts
from tmm_cli.plans.record import Symbol

Words = str | Symbol | tuple[str | Symbol, ...]

SMALL = 0.68  # size of indices
BELOW, ABOVE = -0.30, 0.36  # how far their middle is off that of the letter


def parts(words: Words) -> tuple[str | Symbol, ...]:
    """Texts and symbols, one after another."""
    return words if isinstance(words, tuple) else (words,)


def plain(words: Words) -> str:
    """In one line: a^n_BA."""
    return "".join(
        part if isinstance(part, str)
        else part.letter + (f"^{part.above}" if part.above else "") + (f"_{part.below}" if part.below else "")
        for part in parts(words)
    )  # fmt: skip


def pieces(words: Words, size: float) -> Iterator[tuple[complex, str, float]]:
    """Pieces of a text of this size: how far each is off the left end of the whole, its letters, and their size."""
    at = 0.0
    for part in parts(words):
        if isinstance(part, str):
            yield complex(at), part, size
        else:
            yield complex(at), part.letter, size
            foot, small = at + fonts.width(part.letter, size), SMALL * size
            for text, off in ((part.below, BELOW), (part.above, ABOVE)):
                if text:
                    yield complex(foot, off * size), text, small
        at += width(part, size)


def width(words: Words, size: float) -> float:
    """Width of a text, in the unit of its size."""
    return sum(
        fonts.width(part, size)
        if isinstance(part, str)
        else fonts.width(part.letter, size) + SMALL * max(fonts.width(part.below, size), fonts.width(part.above, size))
        for part in parts(words)
    )
