"""What a note is made of: blocks one after another, which each format writes in its own way. All texts are data."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

from tmm_cli.drawing.paper import Drawing
from tmm_cli.language import filled
from tmm_cli.mechanics.forces import Symbol
from tmm_cli.note.expression import Found
from tmm_cli.note.formula_tree import Node


@dataclass(frozen=True)
class Ref:
    """The number of a figure or a table, by its key."""

    key: str


@dataclass(frozen=True)
class Link:
    """A place of the literature list, by its key: [2]."""

    key: str


Inline = str | Symbol | Node | Ref | Link
Line = tuple[Inline, ...]


@dataclass(frozen=True)
class Heading:
    """Of a chapter (level 1) or a section (2); formats number them: 3.2."""

    text: str
    level: int = 1


@dataclass(frozen=True)
class Paragraph:
    """Sentences with symbols and small formulas in them."""

    line: Line


@dataclass(frozen=True)
class Items:
    """A list with dots."""

    lines: tuple[Line, ...]


@dataclass(frozen=True)
class Equation:
    """A formula on a line of its own."""

    node: Node


@dataclass(frozen=True)
class Rows:
    """A table of texts. head: of its columns; numeric columns stand at the right."""

    caption: str
    head: tuple[Line, ...]
    rows: tuple[tuple[Line, ...], ...]
    key: str = ""

    @cached_property
    def numeric(self) -> list[bool]:
        """Of each column, whether it has figures only, and dashes where there are none."""
        columns = [[row[k] for row in self.rows] for k in range(len(self.head))]
        return [all(map(_is_number, cells)) and any(map(_has_digits, cells)) for cells in columns]


@dataclass(frozen=True)
class Figure:
    """A drawing with its caption; it is as wide as the text, or smaller if it is."""

    caption: str
    drawing: Drawing
    key: str = ""


@dataclass(frozen=True)
class Contents:
    """The table of contents stands here; what follows begins a page."""


@dataclass(frozen=True)
class Title:
    """The title page: lines from its top to its bottom, by their weight."""

    institution: str
    heading: str
    title: str
    people: tuple[tuple[str, str], ...]
    foot: str


@dataclass(frozen=True)
class Source:
    """A place of the literature list."""

    key: str
    text: str


@dataclass(frozen=True)
class Sources:
    """The literature list."""

    sources: tuple[Source, ...]


Block = Heading | Paragraph | Items | Equation | Found | Rows | Figure | Contents | Title | Sources


@dataclass(frozen=True)
class Note:
    """A note: its blocks in order, the language it is in, and its title as the properties of a file have it."""

    title: str
    language: str
    blocks: tuple[Block, ...]

    def headings(self) -> list[tuple[str, Heading]]:
        """With their decimal numbers: 2, 2.1, 2.2."""
        count: list[int] = []
        found = []
        for block in self.blocks:
            if isinstance(block, Heading):
                count = [*count, *[0] * block.level][: block.level]
                count[-1] += 1
                found.append((".".join(map(str, count)), block))
        return found

    def numbers(self) -> dict[str, str]:
        """Of tables and figures by their keys: each kind is counted through the note."""
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
    """Of texts and symbols one after another."""
    return Paragraph(line)


def cells(*parts: Inline | Line) -> tuple[Line, ...]:
    """Of a row of a table."""
    return tuple(part if isinstance(part, tuple) else (part,) for part in parts)


def listed(parts: Iterable[Inline | Line], between: str = ", ") -> Line:
    """One after another."""
    return tuple(one for k, line in enumerate(cells(*parts)) for one in ((between, *line) if k else line))


def listed_below(lines: Sequence[Line]) -> Items:
    """One below the other, a stop after the last one and a semicolon after each other one."""
    last = len(lines) - 1
    return Items(tuple((*each, "." if k == last else ";") for k, each in enumerate(lines)))


def several(one: str, two: str, more: str, keys: Sequence[str]) -> Paragraph:
    """A sentence that refers to one table or figure by {first}, to two by {first} and {last}, or to all from..to."""
    return said((one, two, more)[min(len(keys), 3) - 1], first=Ref(keys[0]), last=Ref(keys[-1]))


def said(sentence: str, **parts: Inline | Line) -> Paragraph:
    """A paragraph of such a sentence."""
    return Paragraph(filled(sentence, **parts))


def tabled(sentence: str, rows: Rows, **parts: Inline | Line) -> Iterable[Block]:
    """A sentence that refers to a table by {table}, and the table."""
    yield said(sentence, table=Ref(rows.key), **parts)
    yield rows


def _is_number(cell: Line) -> bool:
    text = "".join(part if isinstance(part, str) else "x" for part in cell)
    return not text.strip("0123456789.,−-–— ·⁰¹²³⁴⁵⁶⁷⁸⁹⁻")


def _has_digits(cell: Line) -> bool:
    return any(isinstance(part, str) and any(map(str.isdigit, part)) for part in cell)
