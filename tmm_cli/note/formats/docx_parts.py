"""Parts of a file of Word for which python-docx has no call: numbered styles, fields, bookmarks, pictures."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from docx.enum.style import WD_STYLE_TYPE
from docx.enum.text import WD_ALIGN_PARAGRAPH, WD_TAB_ALIGNMENT, WD_TAB_LEADER
from docx.opc.constants import RELATIONSHIP_TYPE
from docx.opc.packuri import PackURI
from docx.opc.part import Part
from docx.oxml import OxmlElement, parse_xml
from docx.oxml.ns import nsdecls, qn
from docx.shared import Length, Mm, Pt, RGBColor

from tmm_cli.draw.formats.emf import emf
from tmm_cli.draw.paper.drawing import Drawing
from tmm_cli.note.blocks import Title
from tmm_cli.note.formats.omml import NOT_XML, data

LANGUAGES = {"en": "en-GB", "ru": "ru-RU", "sr": "sr-Latn-RS"}  # as Word calls them, for its spelling
SERIF = "Times New Roman"
MARGINS = {"left_margin": 25, "right_margin": 10, "top_margin": 20, "bottom_margin": 20}  # mm
TEXT = 210 - 25 - 10  # mm, width of a line
EMU = 36000  # a millimetre


def plain(text: str) -> str:
    """A text as data: what XML forbids is replaced."""
    return text.translate(NOT_XML)


def prepared(document: Any, title: str, language: str) -> None:
    """Paper, styles, numbers of pages and properties of a new file."""
    section = document.sections[0]
    section.page_width, section.page_height = Mm(210), Mm(297)
    for name, size in MARGINS.items():
        setattr(section, name, Mm(size))
    section.different_first_page_header_footer = True  # the title page has no number
    footer = section.footer.paragraphs[0]
    footer.alignment = WD_ALIGN_PARAGRAPH.CENTER
    field(footer, "PAGE", "2")
    properties = document.core_properties
    properties.title, properties.author, properties.comments = plain(title)[:250], "", ""
    _styles(document, LANGUAGES[language])
    _numbers(document)


def _styles(document: Any, language: str) -> None:
    styles = document.styles
    normal = _font(styles["Normal"], 12)
    normal.paragraph_format.space_after = Pt(4)
    (spoken,) = styles.element.xpath("w:docDefaults//w:lang")
    for kind in ("val", "eastAsia"):
        spoken.set(qn(f"w:{kind}"), language)
    for name, size, before, after in (("Heading 1", 16, 18, 8), ("Heading 2", 13, 12, 6), ("Heading 3", 12, 8, 4)):
        heading = _font(styles[name], size, bold=True)
        heading.paragraph_format.space_before, heading.paragraph_format.space_after = Pt(before), Pt(after)
    _font(styles["Caption"], 11).paragraph_format.alignment = WD_ALIGN_PARAGRAPH.CENTER
    _font(styles["Title"], 22, bold=True).paragraph_format.alignment = WD_ALIGN_PARAGRAPH.CENTER
    for border in styles["Title"].element.xpath(".//w:pBdr"):
        border.getparent().remove(border)
    for name in ("Formula", "Picture", "Table Text", "Contents Heading", "TOC 1", "TOC 2"):
        styles.add_style(name, WD_STYLE_TYPE.PARAGRAPH).base_style = normal
    formula = styles["Formula"].paragraph_format
    formula.left_indent = Mm(10)
    formula.tab_stops.add_tab_stop(Mm(TEXT), WD_TAB_ALIGNMENT.RIGHT)  # for numbers that a student gives them
    picture = styles["Picture"].paragraph_format
    picture.alignment, picture.keep_with_next = WD_ALIGN_PARAGRAPH.CENTER, True
    table = styles["Table Text"]
    table.font.size = Pt(10)
    table.paragraph_format.space_before = table.paragraph_format.space_after = Pt(1.5)
    _font(styles["Contents Heading"], 16, bold=True)
    for level in (1, 2):
        entry = styles[f"TOC {level}"].paragraph_format
        entry.left_indent = Mm(6 * (level - 1))
        entry.tab_stops.add_tab_stop(Mm(TEXT), WD_TAB_ALIGNMENT.RIGHT, WD_TAB_LEADER.DOTS)


def _font(style: Any, size: float, *, bold: bool = False) -> Any:
    style.font.name, style.font.size, style.font.color.rgb = SERIF, Pt(size), RGBColor(0, 0, 0)
    style.font.bold, style.font.italic = bold, False
    fonts = style.element.get_or_add_rPr().get_or_add_rFonts()
    for name in [name for name in fonts.attrib if name.endswith("Theme")]:
        del fonts.attrib[name]  # a theme's font would stand before this one
    for script in ("hAnsi", "cs", "eastAsia"):
        fonts.set(qn(f"w:{script}"), SERIF)
    return style


def _numbers(document: Any) -> None:
    """Decimal numbers of the headings: 2, 2.1."""
    numbering = document.part.numbering_part.element
    own = "90"
    levels = "".join(
        f'<w:lvl w:ilvl="{k}"><w:start w:val="1"/><w:numFmt w:val="decimal"/><w:pStyle w:val="Heading{k + 1}"/>'
        f'<w:lvlText w:val="{".".join(f"%{n + 1}" for n in range(k + 1))}"/><w:lvlJc w:val="left"/>'
        f'<w:pPr><w:ind w:left="0" w:firstLine="0"/></w:pPr></w:lvl>'
        for k in range(3)
    )
    kind = '<w:multiLevelType w:val="multilevel"/>'
    abstract = f'<w:abstractNum {nsdecls("w")} w:abstractNumId="{own}">{kind}{levels}</w:abstractNum>'
    numbering.insert(0, parse_xml(abstract))
    numbering.append(parse_xml(f'<w:num {nsdecls("w")} w:numId="{own}"><w:abstractNumId w:val="{own}"/></w:num>'))
    for k in range(3):
        numbered = document.styles[f"Heading {k + 1}"].element.get_or_add_pPr().get_or_add_numPr()
        numbered.get_or_add_ilvl().val = k
        numbered.get_or_add_numId().val = int(own)


def field(paragraph: Any, code: str, shown: str, *, dirty: bool = False) -> None:
    """A field of Word: its code, and what it shows; dirty: until Word opens the file and counts."""
    _open(paragraph, code, dirty=dirty)
    paragraph.add_run(shown)
    _mark(paragraph, "end")


def _open(paragraph: Any, code: str, *, dirty: bool) -> None:
    _mark(paragraph, "begin", dirty=dirty)
    text = OxmlElement("w:instrText", {qn("xml:space"): "preserve"})
    text.text = f" {code} "
    paragraph.add_run()._r.append(text)
    _mark(paragraph, "separate")


def _mark(paragraph: Any, kind: str, *, dirty: bool = False) -> None:
    told = {"w:fldCharType": kind} | ({"w:dirty": "true"} if dirty else {})
    paragraph.add_run()._r.append(OxmlElement("w:fldChar", {qn(name): value for name, value in told.items()}))


class Parts:
    """What is counted through a file: bookmarks and pictures."""

    def __init__(self, document: Any) -> None:
        self.document = document
        self.marks = 0
        self.pictures = 0

    def marked(self, paragraph: Any, name: str, first: int) -> None:
        """A bookmark about all of a paragraph from its child number `first` on."""
        self.marks += 1
        own = {qn("w:id"): str(self.marks)}
        paragraph._p.insert(first, OxmlElement("w:bookmarkStart", own | {qn("w:name"): name}))
        paragraph._p.append(OxmlElement("w:bookmarkEnd", own))

    def picture(self, paragraph: Any, drawing: Drawing, share: float, told: str) -> None:
        """A drawing at a share of its size; told: what it is, for those who can't see it."""
        self.pictures += 1
        uri = PackURI(f"/word/media/drawing{self.pictures}.emf")
        part = Part(uri, "image/x-emf", emf(drawing), self.document.part.package)
        link = self.document.part.relate_to(part, RELATIONSHIP_TYPE.IMAGE)
        wide, high = (round(side * share * EMU) for side in drawing.paper)
        size = f'cx="{wide}" cy="{high}"'
        name = f'id="{self.pictures}" name="drawing {self.pictures}" descr="{data(told)}"'
        paragraph.add_run()._r.append(parse_xml(
            f'<w:drawing {nsdecls("w", "wp", "a", "pic", "r")}><wp:inline distT="0" distB="0" distL="0" distR="0">'
            f"<wp:extent {size}/><wp:docPr {name}/><a:graphic>"
            f'<a:graphicData uri="http://schemas.openxmlformats.org/drawingml/2006/picture"><pic:pic><pic:nvPicPr>'
            f"<pic:cNvPr {name}/><pic:cNvPicPr/></pic:nvPicPr>"
            f'<pic:blipFill><a:blip r:embed="{link}"/><a:stretch><a:fillRect/></a:stretch></pic:blipFill>'
            f'<pic:spPr><a:xfrm><a:off x="0" y="0"/><a:ext {size}/></a:xfrm><a:prstGeom prst="rect"><a:avLst/>'
            f"</a:prstGeom></pic:spPr></pic:pic></a:graphicData></a:graphic></wp:inline></w:drawing>"
        ))  # fmt: skip

    def contents(self, entries: Iterable[tuple[int, str, str]]) -> None:
        """The table of contents: a field that Word fills anew, with its entries: level, number, text."""
        paragraph = None
        for k, (level, number, text) in enumerate(entries):
            paragraph = self.document.add_paragraph(style=f"TOC {min(level, 2)}")
            if k == 0:
                _open(paragraph, 'TOC \\o "1-2" \\h \\z \\u', dirty=True)
            paragraph.add_run(f"{number} {text}\t")
            field(paragraph, f"PAGEREF _Toc{k + 1} \\h", "", dirty=True)
        if paragraph is not None:
            _mark(paragraph, "end")


def unbroken(row: Any, *, head: bool) -> None:
    """A row of a table that stays on one page; a head stands on every page."""
    properties = row._tr.get_or_add_trPr()
    properties.append(OxmlElement("w:cantSplit"))
    if head:
        properties.append(OxmlElement("w:tblHeader"))


def title_page(document: Any, block: Title) -> None:
    """From top to bottom of the page."""

    def centred(text: str, before: Length | None = None) -> Any:
        paragraph = document.add_paragraph(plain(text))
        paragraph.alignment, paragraph.paragraph_format.space_before = WD_ALIGN_PARAGRAPH.CENTER, before
        return paragraph

    centred(block.institution)
    centred(block.heading, Pt(170)).runs[0].font.size = Pt(15)
    document.add_paragraph(plain(block.title), style="Title")
    for k, (role, name) in enumerate(block.people):
        line = document.add_paragraph(f"{plain(role)}: {plain(name) or '_' * 30}")
        line.paragraph_format.left_indent = Mm(80)
        line.paragraph_format.space_before = Pt(110 if k == 0 else 4)
    centred(block.foot, Pt(150))
