"""Blocks of a note (headings, paragraphs, formulas, tables, figures), which each format writes in its own way.

The texts of blocks are plain data: no format interprets them as markup.
"""

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
    """Reference to a figure or a table by its key; printed as its number."""

    key: str


@dataclass(frozen=True)
class Link:
    """Citation of a source by its key, printed as [2]."""

    key: str


Inline = str | Symbol | Node | Ref | Link
Line = tuple[Inline, ...]


@dataclass(frozen=True)
class Heading:
    """Heading of a chapter (level 1) or a section (level 2). The format adds its decimal number, e.g. 3.2."""

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
    """Formula that is printed on a line of its own."""

    node: Node


@dataclass(frozen=True)
class Rows:
    """Table with a caption and column headings.

    Attributes:
        caption: text after the number of the table.
        head: headings of the columns.
        rows: cells, row by row.
        key: key for references; empty if no sentence refers to the table.
    """

    caption: str
    head: tuple[Line, ...]
    rows: tuple[tuple[Line, ...], ...]
    key: str = ""

    @cached_property
    def numeric(self) -> list[bool]:
        """For each column, True if its cells are numbers or dashes, at least one of them a number."""
        columns = [[row[k] for row in self.rows] for k in range(len(self.head))]
        return [all(map(_is_number, cells)) and any(map(_has_digits, cells)) for cells in columns]


@dataclass(frozen=True)
class Figure:
    """Drawing with its caption. Formats reduce a drawing that is wider than the text."""

    caption: str
    drawing: Drawing
    key: str = ""


@dataclass(frozen=True)
class Contents:
    """Table of contents. The next block starts a new page."""


@dataclass(frozen=True)
class Title:
    """Title page.

    Attributes:
        institution: institution and department, at the top.
        heading: kind of the work, e.g. explanatory note.
        title: title of the project.
        people: roles (student, group, teacher) and names; an empty name is printed as a blank line.
        foot: text at the foot of the page.
    """

    institution: str
    heading: str
    title: str
    people: tuple[tuple[str, str], ...]
    foot: str


@dataclass(frozen=True)
class Source:
    """Entry in the list of references."""

    key: str
    text: str


@dataclass(frozen=True)
class Sources:
    """List of references."""

    sources: tuple[Source, ...]


Block = Heading | Paragraph | Items | Equation | ComputedQuantity | Rows | Figure | Contents | Title | Sources


@dataclass(frozen=True)
class Note:
    """Explanatory note.

    Attributes:
        title: title, for the properties of the file.
        language: code of the language, e.g. en.
        blocks: contents of the note, in order.
    """

    title: str
    language: str
    blocks: tuple[Block, ...]

    def headings(self) -> list[tuple[str, Heading]]:
        """Return the headings with their decimal numbers: 2, 2.1, 2.2."""
        count: list[int] = []
        numbered = []
        for block in self.blocks:
            if isinstance(block, Heading):
                count = [*count, *[0] * block.level][: block.level]
                count[-1] += 1
                numbered.append((".".join(map(str, count)), block))
        return numbered

    def numbers(self) -> dict[str, str]:
        """Return the printed numbers of tables, figures and sources by key. Each kind is numbered separately."""
        counted: dict[type, int] = {}
        numbers: dict[str, str] = {}
        for block in self.blocks:
            if isinstance(block, Figure | Rows):
                counted[type(block)] = counted.get(type(block), 0) + 1
                if block.key:
                    numbers[block.key] = str(counted[type(block)])
        sources = [s for block in self.blocks if isinstance(block, Sources) for s in block.sources]
        return numbers | {source.key: str(number) for number, source in enumerate(sources, 1)}


def paragraph(*line: Inline) -> Paragraph:
    """Return a paragraph that consists of these texts and symbols."""
    return Paragraph(line)


def cells(*row: Inline | Line) -> tuple[Line, ...]:
    """Return a table row from its cells. Each cell is a text, a symbol, or a sequence of texts and symbols."""
    return tuple(cell if isinstance(cell, tuple) else (cell,) for cell in row)


def join_inline(parts: Iterable[Inline | Line], between: str = ", ") -> Line:
    """Join texts and symbols into one line with a separator."""
    return tuple(inline for k, line in enumerate(cells(*parts)) for inline in ((between, *line) if k else line))


def bulleted_list(lines: Sequence[Line]) -> Items:
    """Return a bulleted list with a semicolon after each item and a full stop after the last."""
    last = len(lines) - 1
    return Items(tuple((*each, "." if k == last else ";") for k, each in enumerate(lines)))


def refer_to_blocks(one: str, two: str, more: str, keys: Sequence[str]) -> Paragraph:
    """Return a sentence that refers to one or more tables or figures.

    Args:
        one: sentence for one key, with the field {first}.
        two: sentence for two keys, with the fields {first} and {last}.
        more: sentence for three or more keys, with the same fields.
        keys: keys of the tables or figures; not empty.
    """
    return write_sentence((one, two, more)[min(len(keys), 3) - 1], first=Ref(keys[0]), last=Ref(keys[-1]))


def write_sentence(sentence: str, **parts: Inline | Line) -> Paragraph:
    """Return a paragraph from a translated sentence whose fields are replaced by texts, symbols or references."""
    return Paragraph(filled(sentence, **parts))


def write_table(sentence: str, rows: Rows, **parts: Inline | Line) -> Iterable[Block]:
    """Yield a sentence that refers to a table by its field {table}, then the table."""
    yield write_sentence(sentence, table=Ref(rows.key), **parts)
    yield rows


def _is_number(cell: Line) -> bool:
    text = "".join(inline if isinstance(inline, str) else "x" for inline in cell)
    return not text.strip("0123456789.,−-–— ·⁰¹²³⁴⁵⁶⁷⁸⁹⁻")


def _has_digits(cell: Line) -> bool:
    return any(isinstance(inline, str) and any(map(str.isdigit, inline)) for inline in cell)
