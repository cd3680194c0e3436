"""The note as a file of Word: its styles, fields and formulas are Word's own, and texts are data."""

import io
import re
import zipfile
from xml.etree import ElementTree

import pytest

from tmm_cli.drawing.paper import Drawing, LineMark, TextMark
from tmm_cli.mechanics.forces import Symbol
from tmm_cli.note import (
    FORMATS,
    ComputedQuantity,
    Contents,
    Equation,
    Figure,
    Function,
    Heading,
    Leaf,
    Letter,
    Note,
    Ref,
    Rows,
    Source,
    Sources,
    Sum,
    Title,
    paragraph,
    row,
)

docx = pytest.importorskip("docx")

W = "{http://schemas.openxmlformats.org/wordprocessingml/2006/main}"
M = "{http://schemas.openxmlformats.org/officeDocument/2006/math}"
HOSTILE = '{ TOC \\o "1-9" } <w:r>&amp;\x00\x0b HYPERLINK "http://x" \u202eright to left\u202c =1+1 ' + "x" * 10_000
# children of these elements of OMML in the order of ECMA-376, part 1, 22.1.2
ORDER = {
    "f": ("fPr", "num", "den"),
    "sSup": ("sSupPr", "e", "sup"),
    "sSub": ("sSubPr", "e", "sub"),
    "sSubSup": ("sSubSupPr", "e", "sub", "sup"),
    "rad": ("radPr", "deg", "e"),
    "bar": ("barPr", "e"),
    "d": ("dPr", "e"),
    "dPr": ("begChr", "sepChr", "endChr"),
    "oMathPara": ("oMathParaPr", "oMath"),
}


def leaf(letter, value, below="", above=""):
    return Leaf(Symbol(letter, below, above), value)


TERMS = tuple((1, leaf("G", 100.0 + k, str(k)) * leaf("h", 0.01 * k, str(k))) for k in range(1, 12))
MOMENTS = Sum(TERMS) / leaf("l", 0.65, "CD")
SIDES = leaf("R", 3.0, "34", "n") ** 2 + leaf("R", 4.0, "34", "τ") ** 2
FORCE = ComputedQuantity(Symbol("R", "34"), Function("sqrt", SIDES), 5.0, "N")
WIDE = ComputedQuantity(Symbol("R", "34", "τ"), MOMENTS, sum((100.0 + k) * 0.01 * k for k in range(1, 12)) / 0.65, "N")
TURNED = ComputedQuantity(Symbol("x"), 2 * Function("cos", Leaf(Symbol("φ"), 1.0471975511965976, angle=True)), 1.0, "m")
DRAWING = Drawing(
    (80.0, 60.0),
    (
        LineMark((0j, 40 + 30j), "#000000", 0.3),
        LineMark((0j, 80j), "#000000", 0.3, "--"),
        TextMark(10 + 10j, "Ползун", 4.0, "#000000"),
    ),
)
NOTE = Note(
    "Crank shaper",
    "ru",
    (
        Title("University", "Course project", HOSTILE, (("student", "Петров"),), "2026"),
        Contents(),
        Heading("Forces"),
        Heading(HOSTILE, 2),
        paragraph("Velocity ", Symbol("v", "B"), " in figure ", Ref("plan"), ", table ", Ref("v"), ". ", HOSTILE),
        Equation(row(Letter(Symbol("v", "B"), True, 1), "=", Letter(Symbol("v", "A"), True, 2))),
        FORCE,
        WIDE,
        TURNED,
        Figure("Velocity plan", DRAWING, "plan"),
        Figure(HOSTILE, DRAWING),
        Rows(
            "Velocities", (("position",), (Symbol("v", "B"),)), tuple(((str(k),), (f"0,{k}",)) for k in range(12)), "v"
        ),
        Heading("References"),
        Sources((Source("a", "И. И. Артоболевский, Теория механизмов и машин"),)),
    ),
)


@pytest.fixture(scope="module")
def file():
    return FORMATS["docx"](NOTE)


@pytest.fixture(scope="module")
def body(file):
    return ElementTree.fromstring(zipfile.ZipFile(io.BytesIO(file)).read("word/document.xml"))


def test_every_part_is_well_formed(file):
    package = zipfile.ZipFile(io.BytesIO(file))
    assert package.testzip() is None
    for name in package.namelist():
        if name.endswith((".xml", ".rels")):
            ElementTree.fromstring(package.read(name))


def test_styles_are_those_of_word(file):
    read = docx.Document(io.BytesIO(file))
    styles = [p.style.name for p in read.paragraphs]
    assert {"Title", "Heading 1", "Heading 2", "Caption", "List Number"} <= set(styles)
    headings = [p.text for p in read.paragraphs if p.style.name == "Heading 1"]
    assert headings == ["Forces", "References"]
    levels = read.styles["Heading 2"].element.find(f"{W}pPr/{W}numPr/{W}ilvl").get(f"{W}val")
    assert levels == "1"  # of the list that numbers them: 1, 1.1
    assert read.core_properties.title == "Crank shaper"
    assert 'w:lang w:val="ru-RU"' in zipfile.ZipFile(io.BytesIO(file)).read("word/styles.xml").decode()


def test_contents_captions_and_references_are_fields_that_word_counts(body):
    codes = [" ".join(code.text.split()) for code in body.iter(f"{W}instrText")]
    own = r'(TOC \\o "1-2" \\h \\z \\u|PAGEREF _Toc\d+ \\h|SEQ (Figure|Table) \\\* ARABIC|REF _Ref\d+ \\h)'
    assert all(re.fullmatch(own, code) for code in codes)  # and none that a text brings
    assert sum(code.startswith("SEQ") for code in codes) == 3 and sum(code.startswith("REF") for code in codes) == 2
    marks = {mark.get(f"{W}name") for mark in body.iter(f"{W}bookmarkStart")}
    assert {code.split()[1] for code in codes if code.split()[0] in ("REF", "PAGEREF")} <= marks
    kinds = [mark.get(f"{W}fldCharType") for mark in body.iter(f"{W}fldChar")]
    assert kinds.count("begin") == kinds.count("separate") == kinds.count("end") == len(codes)


def test_formulas_are_those_of_word(body):
    formulas = ["".join(text.text for text in formula.iter(f"{M}t")) for formula in body.iter(f"{M}oMath")]
    assert "vB" in formulas  # in a line of text
    assert any(f.startswith("x=2·cosφ=2·cos60°=1") for f in formulas)
    force = next(f for f in body.iter(f"{M}oMath") if len(list(f.iter(f"{M}rad"))) == 2)
    assert [len(list(force.iter(f"{M}{kind}"))) for kind in ("sSubSup", "sSup", "sSub")] == [2, 4, 1]
    for element in body.iter():
        order = ORDER.get(element.tag.removeprefix(M))
        if order and element.tag.startswith(M):
            places = [order.index(child.tag.removeprefix(M)) for child in element]
            assert places == sorted(places)


def test_a_wide_formula_stands_on_several_lines(body):
    lines = ["".join(text.text for text in line.iter(f"{M}t")) for line in body.iter(f"{M}oMath")]
    start = next(k for k, line in enumerate(lines) if line.startswith("R34τ="))
    own = lines[start : start + 5]
    assert max(len(line) for line in own) < 110
    assert any(line.startswith("\u200b=") for line in own) and any(line.startswith("+") for line in own)


def test_drawings_are_vectors(file):
    package = zipfile.ZipFile(io.BytesIO(file))
    pictures = [package.read(name) for name in package.namelist() if name.startswith("word/media/")]
    assert len(pictures) == 2 and all(picture[40:44] == b" EMF" for picture in pictures)


def test_heads_of_tables_stand_on_every_page_and_numbers_after_the_first_at_the_right(file):
    table = docx.Document(io.BytesIO(file)).tables[-1]
    assert table.rows[0]._tr.trPr.find(f"{W}tblHeader") is not None
    assert [cell.text for cell in table.rows[3].cells] == ["2", "0,2"]
    assert [str(cell.paragraphs[0].alignment) for cell in table.rows[3].cells] == ["CENTER (1)", "RIGHT (2)"]


def test_texts_are_data(file):
    read = docx.Document(io.BytesIO(file))
    shown = HOSTILE.replace("\x00", "�").replace("\x0b", "�")
    assert shown in [p.text for p in read.paragraphs]  # the title
    assert any(p.text.endswith(shown) for p in read.paragraphs if p.style.name == "Caption")
    assert not list(read.element.body.iter(f"{W}hyperlink"))


def test_no_row_of_a_long_table_stands_alone_on_a_page():
    rows = tuple(((str(k),),) for k in range(24))
    file = FORMATS["docx"](Note("Long", "en", (Rows("Positions", (("position",),), rows),)))
    (table,) = docx.Document(io.BytesIO(file)).tables
    kept = [bool(row.cells[0].paragraphs[0].paragraph_format.keep_with_next) for row in table.rows]
    assert [number for number, with_next in enumerate(kept) if with_next] == [0, 1, 2, 22, 23]
    assert len(kept) == 25, "with its heading"


def test_the_title_of_the_page_is_that_of_the_problem(file):
    titles = [p.text for p in docx.Document(io.BytesIO(file)).paragraphs if p.style.name == "Title"]
    assert len(titles) == 1 and "Course project" not in titles[0]
