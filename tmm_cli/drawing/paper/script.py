"""Texts with indices: a^n_BA is written in pieces, letters below and above the line, so that every format has them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import lru_cache

from tmm_cli.drawing.paper import fonts
from tmm_cli.language import signed, typeset
from tmm_cli.mechanics.forces import Symbol

Words = str | Symbol | tuple[str | Symbol, ...]

SMALL = 0.68  # size of indices
BELOW, ABOVE = -0.30, 0.36  # how far their middle is off that of the letter


def parts(words: Words) -> tuple[str | Symbol, ...]:
    """Texts and symbols, one after another, with printed signs."""
    several = words if isinstance(words, tuple) else (words,)
    return tuple(signed(typeset(part)) if isinstance(part, str) else part for part in several)


def plain(words: Words) -> str:
    """In one line: a^n_BA."""
    return "".join(
        part
        if isinstance(part, str)
        else part.letter + (f"^{part.above}" if part.above else "") + (f"_{part.below}" if part.below else "")
        for part in parts(words)
    )


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
        at += script_width(part, size)


@lru_cache(10_000)
def script_width(words: Words, size: float) -> float:
    """Width of a text, in the unit of its size."""
    return sum(
        fonts.width(part, size)
        if isinstance(part, str)
        else fonts.width(part.letter, size) + SMALL * max(fonts.width(part.below, size), fonts.width(part.above, size))
        for part in parts(words)
    )


@lru_cache(1000)
def wrapped(words: Words, size: float, most: float, hanging: str = "") -> tuple[Words, ...]:
    """Lines that are no wider than this, broken at spaces; all but the first begin with `hanging`.

    The last word, which may be a unit, is not parted from the one before it.
    """
    lines: list[Words] = []
    line: list[str | Symbol] = []
    wide = 0.0
    *tokens, before, last = ((), (), *_tokens(words))
    for token in (*tokens, (*before, *last)):
        own = script_width(token, size)
        if line and wide + own > most:
            lines.append(_joined(line))
            line, wide = [hanging], script_width(hanging, size)
        line += token
        wide += own
    return (*lines, _joined(line))


def _joined(line: Iterable[str | Symbol]) -> tuple[str | Symbol, ...]:
    """The same with texts that follow one another in one."""
    found: list[str | Symbol] = []
    for part in line:
        if found and isinstance(part, str) and isinstance(found[-1], str):
            found[-1] += part
        else:
            found.append(part)
    return tuple(found)


def _tokens(words: Words) -> Iterator[tuple[str | Symbol, ...]]:
    """What stands between two spaces, each with the space before it."""
    token: list[str | Symbol] = []
    for part in parts(words):
        first, *others = part.split(" ") if isinstance(part, str) else [part]
        token.append(first)
        for other in others:
            yield tuple(token)
            token = [f" {other}"]
    yield tuple(token)
