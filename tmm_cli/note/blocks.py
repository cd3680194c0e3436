"""Blocks of a note, one after another, which each format writes in its own way. All texts are data."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

from tmm_cli.drawing.paper import Drawing
from tmm_cli.language import filled
from tmm_cli.mechanics.forces import Symbol
from tmm_cli.note.expression import ComputedQuantity
from tmm_cli.note.formula_tree import Node


@dataclass(frozen=True)
class Ref:
    """Reference to the number of a figure or a table by its key."""

    key: str


@dataclass(frozen=True)
class Link:
    """Citation of a source by its key, printed as [2]."""

    key: str


Inline = str | Symbol | Node | Ref | Link
Line = tuple[Inline, ...]


@dataclass(frozen=True)
class Heading:
    """Heading of a chapter (level 1) or a section (level 2); formats number it: 3.2."""

    text: str
    level: int = 1


@dataclass(frozen=True)
class Paragraph:
    """Paragraph of text with symbols and short formulas."""

    line: Line


@dataclass(frozen=True)
class Items:
    """Bulleted list."""

    lines: tuple[Line, ...]


@dataclass(frozen=True)
class Equation:
    """Formula on a line of its own."""

    node: Node


@dataclass(frozen=True)
class Rows:
    """Table of text cells with its column headings; numeric columns are right-aligned."""

    caption: str
    head: tuple[Line, ...]
    rows: tuple[tuple[Line, ...], ...]
    key: str = ""

    @cached_property
    def numeric(self) -> list[bool]:
        """For each column, True if its cells are numbers or dashes and at least one is a number."""
        columns = [[row[k] for row in self.rows] for k in range(len(self.head))]
        return [all(map(_is_number, cells)) and any(map(_has_digits, cells)) for cells in columns]


@dataclass(frozen=True)
class Figure:
    """Drawing with its caption, reduced to the text width if it is wider."""

    caption: str
    drawing: Drawing
    key: str = ""


@dataclass(frozen=True)
class Contents:
    """Table of contents; the block after it starts a new page."""


@dataclass(frozen=True)
class Title:
    """Title page: its lines from top to bottom."""

    institution: str
    heading: str
    title: str
    people: tuple[tuple[str, str], ...]
    foot: str


@dataclass(frozen=True)
class Source:
    """Entry of the list of references."""

    key: str
    text: str


@dataclass(frozen=True)
class Sources:
    """List of references."""

    sources: tuple[Source, ...]


Block = Heading | Paragraph | Items | Equation | ComputedQuantity | Rows | Figure | Contents | Title | Sources


@dataclass(frozen=True)
class Note:
    """Explanatory note: its blocks in order, its language, and its title for the properties of the file."""

    title: str
    language: str
    blocks: tuple[Block, ...]

    def headings(self) -> list[tuple[str, Heading]]:
        """Return the headings with their decimal numbers: 2, 2.1, 2.2."""
        count: list[int] = []
        found = []
        for block in self.blocks:
            if isinstance(block, Heading):
                count = [*count, *[0] * block.level][: block.level]
                count[-1] += 1
                found.append((".".join(map(str, count)), block))
        return found

    def numbers(self) -> dict[str, str]:
        """Return the numbers of tables, figures and sources by key; each kind is numbered through the whole note."""
        counted: dict[type, int] = {}
        found: dict[str, str] = {}
        for block in self.blocks:
            if isinstance(block, Figure | Rows):
                counted[type(block)] = counted.get(type(block), 0) + 1
                if block.key:
                    found[block.key] = str(counted[type(block)])
        sources = [s for block in self.blocks if isinstance(block, Sources) for s in block.sources]
        return found | {source.key: str(number) for number, source in enumerate(sources, 1)}


def paragraph(*line: Inline) -> Paragraph:
    """Return a paragraph of texts and symbols in a row."""
    return Paragraph(line)


def cells(*parts: Inline | Line) -> tuple[Line, ...]:
    """Return a table row from texts, symbols and lines."""
    return tuple(part if isinstance(part, tuple) else (part,) for part in parts)


def join_inline(parts: Iterable[Inline | Line], between: str = ", ") -> Line:
    """Join texts and symbols into one line with a separator."""
    return tuple(one for k, line in enumerate(cells(*parts)) for one in ((between, *line) if k else line))


def bulleted_list(lines: Sequence[Line]) -> Items:
    """Return a bulleted list with a semicolon after each item and a full stop after the last."""
    last = len(lines) - 1
    return Items(tuple((*each, "." if k == last else ";") for k, each in enumerate(lines)))


def refer_to_blocks(one: str, two: str, more: str, keys: Sequence[str]) -> Paragraph:
    """Return the sentence for one, two or more keys; it refers to {first} and {last} of them."""
    return write_sentence((one, two, more)[min(len(keys), 3) - 1], first=Ref(keys[0]), last=Ref(keys[-1]))


def write_sentence(sentence: str, **parts: Inline | Line) -> Paragraph:
    """Return a paragraph from a translated sentence, with its fields filled by texts, symbols or references."""
    return Paragraph(filled(sentence, **parts))


def write_table(sentence: str, rows: Rows, **parts: Inline | Line) -> Iterable[Block]:
    """Yield a sentence that refers to a table by {table}, then the table."""
    yield write_sentence(sentence, table=Ref(rows.key), **parts)
    yield rows


def _is_number(cell: Line) -> bool:
    text = "".join(part if isinstance(part, str) else "x" for part in cell)
    return not text.strip("0123456789.,−-–— ·⁰¹²³⁴⁵⁶⁷⁸⁹⁻")


def _has_digits(cell: Line) -> bool:
    return any(isinstance(part, str) and any(map(str.isdigit, part)) for part in cell)
