"""Texts with indices: a^n_BA is written in pieces, letters below and above the line, so that every format has them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import lru_cache

from tmm_cli.drawing.paper import fonts
from tmm_cli.language import signed, typeset
from tmm_cli.mechanics.forces import Symbol

Words = str | Symbol | tuple[str | Symbol, ...]

INDEX_SIZE = 0.68  # size of indices
INDEX_BELOW, INDEX_ABOVE = -0.30, 0.36  # how far their middle is off that of the letter


def split_symbols(words: Words) -> tuple[str | Symbol, ...]:
    """Texts and symbols, one after another, with printed signs."""
    several = words if isinstance(words, tuple) else (words,)
    return tuple(signed(typeset(part)) if isinstance(part, str) else part for part in several)


def plain_text(words: Words) -> str:
    """In one line: a^n_BA."""
    return "".join(
        part
        if isinstance(part, str)
        else part.letter + (f"^{part.above}" if part.above else "") + (f"_{part.below}" if part.below else "")
        for part in split_symbols(words)
    )


def placed_pieces(words: Words, size: float) -> Iterator[tuple[complex, str, float]]:
    """Pieces of a text of this size: how far each is off the left end of the whole, its letters, and their size."""
    at = 0.0
    for part in split_symbols(words):
        if isinstance(part, str):
            yield complex(at), part, size
        else:
            yield complex(at), part.letter, size
            foot, small = at + fonts.text_width(part.letter, size), INDEX_SIZE * size
            for text, off in ((part.below, INDEX_BELOW), (part.above, INDEX_ABOVE)):
                if text:
                    yield complex(foot, off * size), text, small
        at += script_width(part, size)


@lru_cache(10_000)
def script_width(words: Words, size: float) -> float:
    """Width of a text, in the unit of its size."""
    return sum(
        fonts.text_width(part, size)
        if isinstance(part, str)
        else fonts.text_width(part.letter, size)
        + INDEX_SIZE * max(fonts.text_width(part.below, size), fonts.text_width(part.above, size))
        for part in split_symbols(words)
    )


@lru_cache(1000)
def wrap_symbols(words: Words, size: float, most: float, hanging: str = "") -> tuple[Words, ...]:
    """Lines that are no wider than this, broken at spaces; all but the first begin with `hanging`.

    The last word, which may be a unit, is not parted from the one before it.
    """
    lines: list[Words] = []
    line: list[str | Symbol] = []
    wide = 0.0
    *tokens, before, last = ((), (), *_split_at_spaces(words))
    for token in (*tokens, (*before, *last)):
        own = script_width(token, size)
        if line and wide + own > most:
            lines.append(_join_texts(line))
            line, wide = [hanging], script_width(hanging, size)
        line += token
        wide += own
    return (*lines, _join_texts(line))


def _join_texts(line: Iterable[str | Symbol]) -> tuple[str | Symbol, ...]:
    """The same with texts that follow one another in one."""
    found: list[str | Symbol] = []
    for part in line:
        if found and isinstance(part, str) and isinstance(found[-1], str):
            found[-1] += part
        else:
            found.append(part)
    return tuple(found)


def _split_at_spaces(words: Words) -> Iterator[tuple[str | Symbol, ...]]:
    """What stands between two spaces, each with the space before it."""
    token: list[str | Symbol] = []
    for part in split_symbols(words):
        first, *others = part.split(" ") if isinstance(part, str) else [part]
        token.append(first)
        for other in others:
            yield tuple(token)
            token = [f" {other}"]
    yield tuple(token)
