"""The note as a Word document (DOCX) with editable formulas (OMML) and with Word's styles, captions and fields."""

from __future__ import annotations

import io
from collections.abc import Iterable, Sequence
from functools import partial
from html import escape
from typing import Any

from docx import Document
from docx.enum.style import WD_STYLE_TYPE
from docx.enum.table import WD_TABLE_ALIGNMENT
from docx.enum.text import WD_ALIGN_PARAGRAPH, WD_TAB_ALIGNMENT, WD_TAB_LEADER
from docx.opc.constants import RELATIONSHIP_TYPE
from docx.opc.packuri import PackURI
from docx.opc.part import Part
from docx.oxml import OxmlElement, parse_xml
from docx.oxml.ns import nsdecls, qn
from docx.shared import Length, Mm, Pt, RGBColor

from tmm_cli.drawing.formats import write_emf
from tmm_cli.drawing.paper import Drawing
from tmm_cli.language import _
from tmm_cli.mechanics.forces import Symbol
from tmm_cli.note import blocks
from tmm_cli.note.blocks import Block, Inline, Line, Note, Title
from tmm_cli.note.expression import ComputedQuantity, formula
from tmm_cli.note.formula_tree import (
    Brackets,
    Fraction,
    Letter,
    Lines,
    Node,
    Number,
    Power,
    Root,
    Row,
    Sign,
    Words,
    width,
)
from tmm_cli.note.subject import localise_figures

SPACES = nsdecls("w", "m", "r")
FONT = '<w:rPr><w:rFonts w:ascii="Cambria Math" w:hAnsi="Cambria Math"/></w:rPr>'
PLAIN, UPRIGHT, ITALIC = '<m:rPr><m:sty m:val="p"/></m:rPr>', "<m:rPr><m:nor/></m:rPr>", ""  # numbers, words, symbols
NOT_XML = dict.fromkeys((*range(9), 11, 12, *range(14, 32), *range(0xD800, 0xE000), 65534, 65535), "�")


def escape_xml(text: str) -> str:
    """Escape a text for XML. Characters that XML forbids are replaced."""
    return escape(text.translate(NOT_XML))


def inline_omml(node: Node, font_size: float = 0.0) -> str:
    """Return a formula within a line of text as OMML. font_size: in points; 0 for the size of the text."""
    omml = _omml(node)
    if font_size:
        omml = omml.replace(FONT, FONT.replace("</w:rPr>", f'<w:sz w:val="{round(2 * font_size)}"/></w:rPr>'))
    return f"<m:oMath {SPACES}>{omml}</m:oMath>"


def display_omml(node: Node) -> list[str]:
    """Return a displayed formula as OMML, one paragraph for each of its lines."""
    lines = node.lines if isinstance(node, Lines) else (node,)
    jc = '<m:oMathParaPr><m:jc m:val="left"/></m:oMathParaPr>'
    return [f"<m:oMathPara {SPACES}>{jc}{inline_omml(_add_empty_operand(line))}</m:oMathPara>" for line in lines]


def _add_empty_operand(line: Node) -> Node:
    """Put an empty operand before a line that begins with an equals sign. Some programs require an operand there."""
    return Row((Words("\u200b"), *line.nodes)) if isinstance(line, Row) and line.nodes[0] == Sign("=") else line


def _omml(node: Node) -> str:
    match node:
        case Number(text) | Sign(text):
            return _run(text)
        case Words(text):
            return _run(text, UPRIGHT)
        case Letter(symbol, vector, lines):
            omml = _symbol(symbol, vector)
            for _ in range(lines):
                omml = _bar(omml, "bot")
            return omml
        case Row(nodes) | Lines(nodes):
            return "".join(_omml(n) for n in nodes)
        case Fraction(over, under):
            return f"<m:f><m:num>{_omml(over)}</m:num><m:den>{_omml(under)}</m:den></m:f>"
        case Power(base, exponent):
            return f"<m:sSup><m:e>{_omml(base)}</m:e><m:sup>{_omml(exponent)}</m:sup></m:sSup>"
        case Root(radicand):
            return f'<m:rad><m:radPr><m:degHide m:val="1"/></m:radPr><m:deg/><m:e>{_omml(radicand)}</m:e></m:rad>'
        case Brackets(inside, opens, closes, bars):
            ends = {"begChr": "|" if bars else "(" if opens else "", "endChr": "|" if bars else ")" if closes else ""}
            marks = "".join(f'<m:{kind} m:val="{mark}"/>' for kind, mark in ends.items() if mark not in ("(", ")"))
            return f"<m:d>{f'<m:dPr>{marks}</m:dPr>' if marks else ''}<m:e>{_omml(inside)}</m:e></m:d>"


def _symbol(symbol: Symbol, vector: bool) -> str:
    letter = _run(symbol.letter, ITALIC)
    if vector:
        letter = _bar(letter, "top")
    base = f"<m:e>{letter}</m:e>"
    below = f"<m:sub>{_run(symbol.below, UPRIGHT)}</m:sub>" if symbol.below else ""
    above = f"<m:sup>{_run(symbol.above, ITALIC)}</m:sup>" if symbol.above else ""
    if below and above:
        return f"<m:sSubSup>{base}{below}{above}</m:sSubSup>"
    if below:
        return f"<m:sSub>{base}{below}</m:sSub>"
    return f"<m:sSup>{base}{above}</m:sSup>" if above else letter


def _bar(inside: str, place: str) -> str:
    return f'<m:bar><m:barPr><m:pos m:val="{place}"/></m:barPr><m:e>{inside}</m:e></m:bar>'


def _run(text: str, style: str = PLAIN) -> str:
    return f'<m:r>{style}{FONT}<m:t xml:space="preserve">{escape_xml(text)}</m:t></m:r>'


# Features of Word that python-docx does not offer: numbered headings, fields, bookmarks, EMF pictures.


LANGUAGES = {"en": "en-GB", "ru": "ru-RU", "sr": "sr-Latn-RS"}  # codes of Word, for its spelling checker
SERIF = "Times New Roman"
MARGINS = {"left_margin": 25, "right_margin": 10, "top_margin": 20, "bottom_margin": 20}  # mm
TEXT = 210 - 25 - 10  # mm, width of a line
EMU = 36000  # Word's drawing units per mm


def replace_forbidden(text: str) -> str:
    """Replace characters that XML forbids."""
    return text.translate(NOT_XML)


def prepare_document(document: Any, title: str, language: str) -> None:
    """Set paper, styles, page numbers and properties of a new document."""
    section = document.sections[0]
    section.page_width, section.page_height = Mm(210), Mm(297)
    for name, margin in MARGINS.items():
        setattr(section, name, Mm(margin))
    section.different_first_page_header_footer = True  # the title page has no number
    footer = section.footer.paragraphs[0]
    footer.alignment = WD_ALIGN_PARAGRAPH.CENTER
    add_field(footer, "PAGE", "2")
    properties = document.core_properties
    properties.title, properties.author, properties.comments = replace_forbidden(title)[:250], "", ""
    _set_styles(document, LANGUAGES[language])
    _number_headings(document)


def _set_styles(document: Any, language: str) -> None:
    styles = document.styles
    normal = _set_font(styles["Normal"], 12)
    normal.paragraph_format.space_after = Pt(4)
    (spoken,) = styles.element.xpath("w:docDefaults//w:lang")
    for kind in ("val", "eastAsia"):
        spoken.set(qn(f"w:{kind}"), language)
    for name, font_size, before, after in (("Heading 1", 16, 18, 8), ("Heading 2", 13, 12, 6), ("Heading 3", 12, 8, 4)):
        heading = _set_font(styles[name], font_size, bold=True)
        heading.paragraph_format.space_before, heading.paragraph_format.space_after = Pt(before), Pt(after)
    _set_font(styles["Caption"], 11).paragraph_format.alignment = WD_ALIGN_PARAGRAPH.CENTER
    _set_font(styles["Title"], 22, bold=True).paragraph_format.alignment = WD_ALIGN_PARAGRAPH.CENTER
    for border in styles["Title"].element.xpath(".//w:pBdr"):
        border.getparent().remove(border)
    for name in ("Formula", "Picture", "Table Text", "Contents Heading", "TOC 1", "TOC 2"):
        styles.add_style(name, WD_STYLE_TYPE.PARAGRAPH).base_style = normal
    formula = styles["Formula"].paragraph_format
    formula.left_indent = Mm(10)
    formula.tab_stops.add_tab_stop(Mm(TEXT), WD_TAB_ALIGNMENT.RIGHT)  # for formula numbers that a student may add
    picture = styles["Picture"].paragraph_format
    picture.alignment, picture.keep_with_next = WD_ALIGN_PARAGRAPH.CENTER, True
    table = styles["Table Text"]
    table.font.size = Pt(10)
    table.paragraph_format.space_before = table.paragraph_format.space_after = Pt(1.5)
    _set_font(styles["Contents Heading"], 16, bold=True)
    for level in (1, 2):
        entry = styles[f"TOC {level}"].paragraph_format
        entry.left_indent = Mm(6 * (level - 1))
        entry.tab_stops.add_tab_stop(Mm(TEXT), WD_TAB_ALIGNMENT.RIGHT, WD_TAB_LEADER.DOTS)


def _set_font(style: Any, font_size: float, *, bold: bool = False) -> Any:
    style.font.name, style.font.size, style.font.color.rgb = SERIF, Pt(font_size), RGBColor(0, 0, 0)
    style.font.bold, style.font.italic = bold, False
    fonts = style.element.get_or_add_rPr().get_or_add_rFonts()
    for name in [name for name in fonts.attrib if name.endswith("Theme")]:
        del fonts.attrib[name]  # a font of the theme would take precedence
    for script in ("hAnsi", "cs", "eastAsia"):
        fonts.set(qn(f"w:{script}"), SERIF)
    return style


def _number_headings(document: Any) -> None:
    """Make Word number the headings decimally: 2, 2.1."""
    numbering = document.part.numbering_part.element
    list_id = "90"
    levels = "".join(
        f'<w:lvl w:ilvl="{k}"><w:start w:val="1"/><w:numFmt w:val="decimal"/><w:pStyle w:val="Heading{k + 1}"/>'
        f'<w:lvlText w:val="{".".join(f"%{n + 1}" for n in range(k + 1))}"/><w:lvlJc w:val="left"/>'
        f'<w:pPr><w:ind w:left="0" w:firstLine="0"/></w:pPr></w:lvl>'
        for k in range(3)
    )
    kind = '<w:multiLevelType w:val="multilevel"/>'
    abstract = f'<w:abstractNum {nsdecls("w")} w:abstractNumId="{list_id}">{kind}{levels}</w:abstractNum>'
    numbering.insert(0, parse_xml(abstract))
    numbering.append(
        parse_xml(f'<w:num {nsdecls("w")} w:numId="{list_id}"><w:abstractNumId w:val="{list_id}"/></w:num>')
    )
    for k in range(3):
        numbered = document.styles[f"Heading {k + 1}"].element.get_or_add_pPr().get_or_add_numPr()
        numbered.get_or_add_ilvl().val = k
        numbered.get_or_add_numId().val = int(list_id)


def add_field(paragraph: Any, code: str, text: str, *, dirty: bool = False) -> None:
    """Add a Word field with its code and its displayed text. With `dirty`, Word updates it on opening the document."""
    _open_field(paragraph, code, dirty=dirty)
    paragraph.add_run(text)
    _add_field_mark(paragraph, "end")


def _open_field(paragraph: Any, code: str, *, dirty: bool) -> None:
    _add_field_mark(paragraph, "begin", dirty=dirty)
    text = OxmlElement("w:instrText", {qn("xml:space"): "preserve"})
    text.text = f" {code} "
    paragraph.add_run()._r.append(text)
    _add_field_mark(paragraph, "separate")


def _add_field_mark(paragraph: Any, kind: str, *, dirty: bool = False) -> None:
    attributes = {"w:fldCharType": kind} | ({"w:dirty": "true"} if dirty else {})
    paragraph.add_run()._r.append(OxmlElement("w:fldChar", {qn(name): value for name, value in attributes.items()}))


class WordParts:
    """Writer of bookmarks, pictures and the table of contents of a document. It numbers the bookmarks and pictures."""

    def __init__(self, document: Any) -> None:
        self.document = document
        self.marks = 0
        self.pictures = 0

    def add_bookmark(self, paragraph: Any, name: str, first: int) -> None:
        """Bookmark a paragraph from the child element with index `first` to its end."""
        self.marks += 1
        bookmark_id = {qn("w:id"): str(self.marks)}
        paragraph._p.insert(first, OxmlElement("w:bookmarkStart", bookmark_id | {qn("w:name"): name}))
        paragraph._p.append(OxmlElement("w:bookmarkEnd", bookmark_id))

    def add_picture(self, paragraph: Any, drawing: Drawing, share: float, alternative: str) -> None:
        """Add a drawing, reduced to the fraction `share` of its size, to a paragraph. alternative: alternative text."""
        self.pictures += 1
        uri = PackURI(f"/word/media/drawing{self.pictures}.emf")
        picture = Part(uri, "image/x-emf", write_emf(drawing), self.document.part.package)
        link = self.document.part.relate_to(picture, RELATIONSHIP_TYPE.IMAGE)
        wide, high = (round(side * share * EMU) for side in drawing.paper)
        extent = f'cx="{wide}" cy="{high}"'
        name = f'id="{self.pictures}" name="drawing {self.pictures}" descr="{escape_xml(alternative)}"'
        paragraph.add_run()._r.append(
            parse_xml(
                f'<w:drawing {nsdecls("w", "wp", "a", "pic", "r")}><wp:inline distT="0" distB="0" distL="0" distR="0">'
                f"<wp:extent {extent}/><wp:docPr {name}/><a:graphic>"
                f'<a:graphicData uri="http://schemas.openxmlformats.org/drawingml/2006/picture"><pic:pic><pic:nvPicPr>'
                f"<pic:cNvPr {name}/><pic:cNvPicPr/></pic:nvPicPr>"
                f'<pic:blipFill><a:blip r:embed="{link}"/><a:stretch><a:fillRect/></a:stretch></pic:blipFill>'
                f'<pic:spPr><a:xfrm><a:off x="0" y="0"/><a:ext {extent}/></a:xfrm><a:prstGeom prst="rect"><a:avLst/>'
                f"</a:prstGeom></pic:spPr></pic:pic></a:graphicData></a:graphic></wp:inline></w:drawing>"
            )
        )

    def add_contents(self, entries: Iterable[tuple[int, str, str]]) -> None:
        """Add the table of contents as a field that Word updates. entries: level, number and text of each heading."""
        paragraph = None
        for k, (level, number, text) in enumerate(entries):
            paragraph = self.document.add_paragraph(style=f"TOC {min(level, 2)}")
            if k == 0:
                _open_field(paragraph, 'TOC \\o "1-2" \\h \\z \\u', dirty=True)
            paragraph.add_run(f"{number} {text}\t")
            add_field(paragraph, f"PAGEREF _Toc{k + 1} \\h", "", dirty=True)
        if paragraph is not None:
            _add_field_mark(paragraph, "end")


def keep_on_page(row: Any, *, head: bool) -> None:
    """Prevent a page break within a table row. A heading row is also repeated on every page."""
    properties = row._tr.get_or_add_trPr()
    properties.append(OxmlElement("w:cantSplit"))
    if head:
        properties.append(OxmlElement("w:tblHeader"))


def add_title_page(document: Any, block: Title) -> None:
    """Add the title page."""

    def centred(text: str, before: Length | None = None) -> Any:
        paragraph = document.add_paragraph(replace_forbidden(text))
        paragraph.alignment, paragraph.paragraph_format.space_before = WD_ALIGN_PARAGRAPH.CENTER, before
        return paragraph

    centred(block.institution)
    centred(block.heading, Pt(170)).runs[0].font.size = Pt(15)
    document.add_paragraph(replace_forbidden(block.title), style="Title")
    for k, (role, name) in enumerate(block.people):
        line = document.add_paragraph(f"{replace_forbidden(role)}: {replace_forbidden(name) or '_' * 30}")
        line.paragraph_format.left_indent = Mm(80)
        line.paragraph_format.space_before = Pt(110 if k == 0 else 4)
    centred(block.foot, Pt(150))


# Styles, captions, fields and formulas are Word's own, so that a student can continue the document.


WHOLE = 13  # rows of the largest table that is not split between pages
ENDS = 3  # rows of a longer table that stay together at its beginning and end
HIGH = 225.0  # largest height of a picture (mm)
WIDE = 0.19  # width of a letter per point of font size (mm)


def docx(note: Note) -> bytes:
    """Return the note as a Word document."""
    writer = _DocxWriter(note)
    for block, following in zip(note.blocks, (*note.blocks[1:], None), strict=True):
        writer.write(
            block, leads=isinstance(following, blocks.Equation | ComputedQuantity | blocks.Items | blocks.Rows)
        )
    file = io.BytesIO()
    writer.document.save(file)
    return file.getvalue()


class _DocxWriter:
    def __init__(self, note: Note) -> None:
        self.note = note
        self.numbers = note.numbers()
        self.figures = partial(localise_figures, spoken=note.language)
        self.document: Any = Document()
        prepare_document(self.document, note.title, note.language)
        self.parts = WordParts(self.document)
        self.counted: dict[str, int] = {}

    def write(self, block: Block, *, leads: bool = False) -> None:
        """Add a block to the document. With `leads`, a paragraph stays on the same page as the block after it."""
        match block:
            case blocks.Heading(text, level):
                heading = self.document.add_heading(replace_forbidden(text), level)
                self.parts.add_bookmark(heading, f"_Toc{self._next_number('heading')}", 1)
            case blocks.Paragraph(line):
                paragraph = self._add_paragraph()
                paragraph.paragraph_format.keep_with_next = leads or None
                self._add_line(paragraph, line)
            case blocks.Items(lines):
                for line in lines:
                    self._add_line(self._add_paragraph("ListBullet"), line)
            case blocks.Equation(node):
                self._add_formula(display_omml(node))
            case ComputedQuantity():
                self._add_formula(display_omml(formula(block, self.figures)))
            case blocks.Rows():
                self._add_table(block)
            case blocks.Figure():
                self._add_figure(block)
            case blocks.Contents():
                self._add_paragraph("ContentsHeading").add_run(_("Contents"))
                headings = self.note.headings()
                self.parts.add_contents(
                    (heading.level, number, replace_forbidden(heading.text)) for number, heading in headings
                )
                self.document.add_page_break()
            case blocks.Title():
                add_title_page(self.document, block)
                self.document.add_page_break()
            case blocks.Sources(sources):
                for source in sources:
                    self._add_line(self._add_paragraph("ListNumber"), (source.text,))

    def _add_paragraph(self, style: str = "") -> Any:
        """Add a paragraph. style: identifier of a Word style; python-docx finds a style by its name only slowly."""
        paragraph = self.document.add_paragraph()
        paragraph._p.style = style or None
        return paragraph

    def _add_line(self, paragraph: Any, line: Line, **format: Any) -> None:
        for inline in line:
            self._add_inline(paragraph, inline, **format)

    def _add_inline(self, paragraph: Any, inline: Inline, font_size: float = 0.0, bold: bool = False) -> None:
        match inline:
            case str():
                run = paragraph.add_run(replace_forbidden(inline))
                run.bold = bold or None
                if font_size:
                    run.font.size = Pt(font_size)
            case blocks.Ref(key):
                add_field(paragraph, f"REF {self._bookmark_of(key)} \\h", self.numbers[key])
            case blocks.Link(key):
                paragraph.add_run(f"[{self.numbers[key]}]")
            case Symbol():
                paragraph._p.append(parse_xml(inline_omml(Letter(inline), font_size)))
            case _:
                paragraph._p.append(parse_xml(inline_omml(inline, font_size)))

    def _bookmark_of(self, key: str) -> str:
        """Return the bookmark for references to a table, figure or source."""
        return f"_Ref{list(self.numbers).index(key) + 1}"

    def _add_formula(self, lines: Sequence[str]) -> None:
        for k, line in enumerate(lines):
            paragraph = self._add_paragraph("Formula")
            paragraph.paragraph_format.keep_with_next = k < len(lines) - 1
            paragraph._p.append(parse_xml(line))

    def _add_caption(self, sentence: str, text: str, key: str, kind: str) -> Any:
        """Add a caption, the pattern `sentence` with its fields {number} and {text}, which Word numbers as a `kind`."""
        before, after = sentence.split("{number}")
        paragraph = self._add_paragraph("Caption")
        paragraph.add_run(before)
        first = len(paragraph._p)
        add_field(paragraph, f"SEQ {kind} \\* ARABIC", str(self._next_number(kind)))
        if key:
            self.parts.add_bookmark(paragraph, self._bookmark_of(key), first)
        paragraph.add_run(after.format(text=replace_forbidden(text)))
        return paragraph

    def _next_number(self, kind: str) -> int:
        self.counted[kind] = self.counted.get(kind, 0) + 1
        return self.counted[kind]

    def _add_table(self, block: blocks.Rows) -> None:
        caption = self._add_caption(_("Table {number}. {text}"), block.caption, block.key, "Table")
        caption.paragraph_format.keep_with_next = True
        caption.alignment = WD_ALIGN_PARAGRAPH.LEFT
        table = self.document.add_table(rows=0, cols=len(block.head), style="Table Grid")
        table.alignment = WD_TABLE_ALIGNMENT.CENTER
        font_size = 10.0 if len(block.head) <= 6 else 8.5
        widths = _column_widths(block, font_size * WIDE)
        for column, wide in zip(table.columns, widths, strict=True):
            column.width = Mm(wide)
        for number, cells in enumerate((block.head, *block.rows)):
            row = table.add_row()
            keep_on_page(row, head=number == 0)
            together = _stays_with_next(number, len(block.rows))
            for k, (cell, line) in enumerate(zip(row.cells, cells, strict=True)):
                cell.width = Mm(widths[k])
                paragraph = cell.paragraphs[0]
                paragraph._p.style = "TableText"
                if together:
                    paragraph.paragraph_format.keep_with_next = True
                if number and block.numeric[k]:
                    paragraph.alignment = WD_ALIGN_PARAGRAPH.RIGHT if k else WD_ALIGN_PARAGRAPH.CENTER
                self._add_line(paragraph, line, font_size=font_size, bold=number == 0)
        self._add_paragraph("TableText")

    def _add_figure(self, block: blocks.Figure) -> None:
        paragraph = self._add_paragraph("Picture")
        width, height = block.drawing.paper
        share = min(1.0, TEXT / width, HIGH / height)
        self.parts.add_picture(paragraph, block.drawing, share, block.caption)
        caption = self._add_caption(_("Figure {number}. {text}"), block.caption, block.key, "Figure")
        caption.paragraph_format.space_after = Pt(12)


def _stays_with_next(number: int, rows: int) -> bool:
    """Return True if a table row (0 is the heading) must stay on the same page as the next row.

    Short tables are not split. In longer ones a few rows stay together at the beginning and at the end.
    """
    return number < rows and (rows <= WHOLE or number < ENDS or number > rows - ENDS)


def _count_letters(line: Line) -> float:
    """Estimate the width of a cell in letters. Capital letters count more."""
    capitals = sum(letter.isupper() for inline in line if isinstance(inline, str) for letter in inline)
    return 0.3 * capitals + sum(
        width(Letter(inline) if isinstance(inline, Symbol) else Words(inline) if isinstance(inline, str) else inline)
        for inline in line
        if not isinstance(inline, blocks.Ref | blocks.Link)
    )


def _column_widths(block: blocks.Rows, letter: float) -> list[float]:
    """Return the widths of the columns (mm), narrowed to fit the page, if possible without breaking words."""
    columns = list(zip(block.head, *block.rows, strict=True))
    whole = [letter * (3 + max(map(_count_letters, column))) for column in columns]
    least = [
        min(wide, letter * (3 + max(map(_longest_word, column)))) for column, wide in zip(columns, whole, strict=True)
    ]
    room = (TEXT - sum(least)) / (sum(whole) - sum(least) or 1.0)
    return [low + max(0.0, min(1.0, room)) * (wide - low) for low, wide in zip(least, whole, strict=True)]


def _longest_word(line: Line) -> float:
    """Estimate the width of the longest word of a cell, in letters."""
    words = [word for inline in line if isinstance(inline, str) for word in inline.split(" ")]
    formulas = (inline for inline in line if not isinstance(inline, str))
    return max([_count_letters((word,)) for word in (*words, *formulas)], default=0.0)
