"""The note as DOCX: styles, captions, fields and formulas are Word's own, so that a student goes on writing in it."""

from __future__ import annotations

import io
from collections.abc import Sequence
from functools import partial
from typing import Any

from docx import Document
from docx.enum.table import WD_TABLE_ALIGNMENT
from docx.enum.text import WD_ALIGN_PARAGRAPH
from docx.oxml import parse_xml
from docx.shared import Mm, Pt

from tmm_cli.language import _
from tmm_cli.note import blocks
from tmm_cli.note.blocks import Block, Inline, Line, Note
from tmm_cli.note.breaking import formula, width
from tmm_cli.note.context import figures
from tmm_cli.note.expression import Found
from tmm_cli.note.formats.docx_parts import TEXT, Parts, field, plain, prepared, title_page, unbroken
from tmm_cli.note.formats.omml import display, omath
from tmm_cli.note.math import Letter, Words
from tmm_cli.plans.record import Symbol

WHOLE = 13  # rows of a table that is not parted between pages
ENDS = 3  # rows of a longer one that stay together at its beginning and at its end
HIGH = 225.0  # mm, of a picture at most
WIDE = 0.19  # mm, of a letter, a point of its size


def docx(note: Note) -> bytes:
    """A file of Word."""
    writer = _Writer(note)
    for block, following in zip(note.blocks, (*note.blocks[1:], None), strict=True):
        writer.write(block, leads=isinstance(following, blocks.Equation | Found | blocks.Items | blocks.Rows))
    file = io.BytesIO()
    writer.document.save(file)
    return file.getvalue()


class _Writer:
    def __init__(self, note: Note) -> None:
        self.note = note
        self.numbers = note.numbers()
        self.figures = partial(figures, spoken=note.language)
        self.document: Any = Document()
        prepared(self.document, note.title, note.language)
        self.parts = Parts(self.document)
        self.counted: dict[str, int] = {}

    def write(self, block: Block, *, leads: bool = False) -> None:
        """leads: what follows is on the same page as a paragraph's end."""
        match block:
            case blocks.Heading(text, level):
                heading = self.document.add_heading(plain(text), level)
                self.parts.marked(heading, f"_Toc{self._next('heading')}", 1)
            case blocks.Paragraph(line):
                paragraph = self._paragraph()
                paragraph.paragraph_format.keep_with_next = leads or None
                self._line(paragraph, line)
            case blocks.Items(lines):
                for line in lines:
                    self._line(self._paragraph("ListBullet"), line)
            case blocks.Equation(node):
                self._formula(display(node))
            case Found():
                self._formula(display(formula(block, self.figures)))
            case blocks.Rows():
                self._rows(block)
            case blocks.Figure():
                self._figure(block)
            case blocks.Contents():
                self._paragraph("ContentsHeading").add_run(_("Contents"))
                headings = self.note.headings()
                self.parts.contents((heading.level, number, plain(heading.text)) for number, heading in headings)
                self.document.add_page_break()
            case blocks.Title():
                title_page(self.document, block)
                self.document.add_page_break()
            case blocks.Sources(sources):
                for source in sources:
                    self._line(self._paragraph("ListNumber"), (source.text,))

    def _paragraph(self, style: str = "") -> Any:
        """style: its identifier; to find it by its name takes longer than all the rest."""
        paragraph = self.document.add_paragraph()
        paragraph._p.style = style or None
        return paragraph

    def _line(self, paragraph: Any, line: Line, **format: Any) -> None:
        for part in line:
            self._inline(paragraph, part, **format)

    def _inline(self, paragraph: Any, part: Inline, size: float = 0.0, bold: bool = False) -> None:
        match part:
            case str():
                run = paragraph.add_run(plain(part))
                run.bold = bold or None
                if size:
                    run.font.size = Pt(size)
            case blocks.Ref(key):
                field(paragraph, f"REF {self._mark(key)} \\h", self.numbers[key])
            case blocks.Link(key):
                paragraph.add_run(f"[{self.numbers[key]}]")
            case Symbol():
                paragraph._p.append(parse_xml(omath(Letter(part), size)))
            case _:
                paragraph._p.append(parse_xml(omath(part, size)))

    def _mark(self, key: str) -> str:
        """The bookmark of a number that is referred to."""
        return f"_Ref{list(self.numbers).index(key) + 1}"

    def _formula(self, lines: Sequence[str]) -> None:
        for k, line in enumerate(lines):
            paragraph = self._paragraph("Formula")
            paragraph.paragraph_format.keep_with_next = k < len(lines) - 1
            paragraph._p.append(parse_xml(line))

    def _caption(self, sentence: str, text: str, key: str, kind: str) -> Any:
        """Its number is a field that Word counts; sentence: with {number} and {text}."""
        before, after = sentence.split("{number}")
        paragraph = self._paragraph("Caption")
        paragraph.add_run(before)
        first = len(paragraph._p)
        field(paragraph, f"SEQ {kind} \\* ARABIC", str(self._next(kind)))
        if key:
            self.parts.marked(paragraph, self._mark(key), first)
        paragraph.add_run(after.format(text=plain(text)))
        return paragraph

    def _next(self, kind: str) -> int:
        self.counted[kind] = self.counted.get(kind, 0) + 1
        return self.counted[kind]

    def _rows(self, block: blocks.Rows) -> None:
        caption = self._caption(_("Table {number}. {text}"), block.caption, block.key, "Table")
        caption.paragraph_format.keep_with_next = True
        caption.alignment = WD_ALIGN_PARAGRAPH.LEFT
        table = self.document.add_table(rows=0, cols=len(block.head), style="Table Grid")
        table.alignment = WD_TABLE_ALIGNMENT.CENTER
        size = 10.0 if len(block.head) <= 6 else 8.5
        widths = _widths(block, size * WIDE)
        for column, wide in zip(table.columns, widths, strict=True):
            column.width = Mm(wide)
        for number, cells in enumerate((block.head, *block.rows)):
            row = table.add_row()
            unbroken(row, head=number == 0)
            together = _with_next(number, len(block.rows))
            for k, (cell, line) in enumerate(zip(row.cells, cells, strict=True)):
                cell.width = Mm(widths[k])
                paragraph = cell.paragraphs[0]
                paragraph._p.style = "TableText"
                if together:
                    paragraph.paragraph_format.keep_with_next = True
                if number and block.numeric[k]:
                    paragraph.alignment = WD_ALIGN_PARAGRAPH.RIGHT if k else WD_ALIGN_PARAGRAPH.CENTER
                self._line(paragraph, line, size=size, bold=number == 0)
        self._paragraph("TableText")

    def _figure(self, block: blocks.Figure) -> None:
        paragraph = self._paragraph("Picture")
        width, height = block.drawing.paper
        share = min(1.0, TEXT / width, HIGH / height)
        self.parts.picture(paragraph, block.drawing, share, block.caption)
        caption = self._caption(_("Figure {number}. {text}"), block.caption, block.key, "Figure")
        caption.paragraph_format.space_after = Pt(12)


def _with_next(number: int, rows: int) -> bool:
    """Whether a row (the heading is 0) is on the page of the next: short tables are whole, no end of others alone."""
    return number < rows and (rows <= WHOLE or number < ENDS or number > rows - ENDS)


def _letters(line: Line) -> float:
    """About how wide a cell is, in letters; a capital is wider than a small one."""
    capitals = sum(letter.isupper() for part in line if isinstance(part, str) for letter in part)
    return 0.3 * capitals + sum(
        width(Letter(part) if isinstance(part, Symbol) else Words(part) if isinstance(part, str) else part)
        for part in line if not isinstance(part, blocks.Ref | blocks.Link)
    )  # fmt: skip


def _widths(block: blocks.Rows, letter: float) -> list[float]:
    """Of columns, mm: as wide as their cells, or less where the page is not so wide, but no word is broken."""
    columns = list(zip(block.head, *block.rows, strict=True))
    whole = [letter * (3 + max(map(_letters, column))) for column in columns]
    least = [min(wide, letter * (3 + max(map(_longest, column)))) for column, wide in zip(columns, whole, strict=True)]
    room = (TEXT - sum(least)) / (sum(whole) - sum(least) or 1.0)
    return [low + max(0.0, min(1.0, room)) * (wide - low) for low, wide in zip(least, whole, strict=True)]


def _longest(line: Line) -> float:
    """The longest word of a cell, in letters."""
    words = [word for part in line if isinstance(part, str) for word in part.split(" ")]
    return max([_letters((part,)) for part in (*words, *(p for p in line if not isinstance(p, str)))], default=0.0)
