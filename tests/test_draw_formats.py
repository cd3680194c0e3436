"""A drawing is a record of primitives in millimetres; every format is written from it."""

import io
import multiprocessing
import os
import re
import subprocess
import sys
from xml.etree import ElementTree

import pytest
from fontTools import ttLib
from PIL import Image
from pypdf import PdfReader

from tmm_cli.drawing.formats import FORMATS, subset_font, write_pdf
from tmm_cli.drawing.paper import (
    AreaMark,
    CircleMark,
    Drawing,
    LineMark,
    TextMark,
    font_file,
    load_font,
    missing_characters,
    text_corners,
    text_width,
)

LINE = LineMark((20 + 30j, 120 + 30j), "#b3261e", 0.5, layer="links")
TRIANGLE = AreaMark((20 + 60j, 60 + 60j, 40 + 90j), "#1f4e9c", None, 0.0)
MARKS = (LINE, TRIANGLE, CircleMark(150 + 70j, 8, "white", "#1a1a1a", 0.4))
HOSTILE = ["x" * 10_000, "שלום عربي", "\U0001f600 \ue000", "$\\frac{1}{0}$", "%%c \\P {\\f", "\x00\x1b"]


def drawn(*texts):
    return Drawing.of((200.0, 100.0), [*MARKS, *texts])


def test_what_covers_others_comes_last():
    high, low = LineMark((0j, 1j), "#000000", 1, z=5), LineMark((0j, 1j), "#000000", 1, z=1)
    assert Drawing.of((10, 10), [high, low]).marks == (low, high)


def test_a_drawing_is_moved_with_all_its_marks():
    moved = drawn(TextMark(50 + 50j, "A", 4, "#000000")).moved(10 - 5j)
    assert {mark.at for mark in moved.marks if isinstance(mark, TextMark)} == {60 + 45j}
    assert LINE.moved(10 - 5j) in moved.marks


def test_a_millimetre_of_a_picture_is_as_many_points_as_its_resolution_says():
    picture = Image.open(io.BytesIO(FORMATS["png"](drawn())))
    scale = picture.info["dpi"][0] / 25.4
    assert picture.size == (round(200 * scale), round(100 * scale))
    assert picture.getpixel((round(70 * scale), round(70 * scale)))[0] > 150  # the red line, 30 mm above the lower edge
    assert picture.getpixel((round(40 * scale), round(30 * scale))) == (0x1F, 0x4E, 0x9C)


def test_svg_is_in_millimetres_and_its_text_is_text():
    root = ElementTree.fromstring(FORMATS["svg"](drawn(TextMark(50 + 50j, "<b>&A", 4, "#000000", "center", turn=30))))
    assert (root.get("width"), root.get("viewBox")) == ("200mm", "0 0 200 100")
    space = "{http://www.w3.org/2000/svg}"
    assert [line.get("points") for line in root.iter(f"{space}polyline")] == ["20,70 120,70"]
    assert [text.text for text in root.iter(f"{space}text")] == ["<b>&A"]


def test_a_length_in_a_pdf_is_true_and_its_font_is_in_it():
    (page,) = PdfReader(io.BytesIO(FORMATS["pdf"](drawn(TextMark(50 + 50j, "Сила R₃₄", 4, "#000000"))))).pages
    assert [float(side) * 25.4 / 72 for side in page.mediabox[2:]] == pytest.approx([200, 100], abs=1e-3)
    found = re.search(rb"([\d.]+) ([\d.]+) m\s+([\d.]+) ([\d.]+) l\s+S", page.get_contents().get_data())
    assert [float(n) * 25.4 / 72 for n in found.groups()] == pytest.approx([20, 30, 120, 30], abs=1e-3)
    assert "Сила R₃₄" in page.extract_text()
    assert any("/FontFile2" in str(font.get_object()) for font in _descriptors(page))


def test_letters_that_look_alike_are_found_in_a_pdf_as_what_they_are():
    words = "A\u0410 \u00b5\u03bc"  # Latin and Cyrillic, micro and Greek
    (page,) = PdfReader(io.BytesIO(FORMATS["pdf"](drawn(TextMark(50 + 50j, words, 4, "#000000", turn=90))))).pages
    assert words in page.extract_text()


def test_letters_of_a_font_that_is_cut_down_keep_their_outlines_also_those_made_of_parts():
    face, letters = load_font(), "Aй\u00c9\u1eaf"
    whole = ttLib.TTFont(font_file())
    data = subset_font(str(font_file()), [0, *(face.get_char_index(ord(letter)) for letter in letters)])
    small = ttLib.TTFont(io.BytesIO(data), checkChecksums=2)
    for number, letter in enumerate(letters, 1):
        before, after = whole.getBestCmap()[ord(letter)], small.getGlyphOrder()[number]
        shapes = [
            every["glyf"][name].getCoordinates(every["glyf"]) for every, name in ((whole, before), (small, after))
        ]
        assert list(shapes[0][0]) == list(shapes[1][0]) and shapes[0][1] == shapes[1][1]
        assert whole["hmtx"][before] == small["hmtx"][after]


def _descriptors(page):
    for one in page["/Resources"]["/Font"].values():
        own = one.get_object()
        for part in own.get("/DescendantFonts", [own]):
            yield part.get_object()["/FontDescriptor"]


def test_several_drawings_are_pages_of_one_file():
    assert len(PdfReader(io.BytesIO(write_pdf(drawn(), drawn(), drawn()))).pages) == 3


def test_the_same_drawing_gives_the_same_bytes_in_every_process():
    code = (
        "import hashlib; from tests.test_draw_formats import *; "
        "text = TextMark(50 + 50j, 'A', 4, '#000000'); "
        "print({kind: hashlib.sha256(written(drawn(text))).hexdigest() for kind, written in FORMATS.items()})"
    )
    told = [
        subprocess.run(
            [sys.executable, "-c", code], capture_output=True, text=True, env=os.environ | {"PYTHONHASHSEED": seed}
        )
        for seed in "14"
    ]
    assert told[0].stdout == told[1].stdout != ""


@pytest.mark.parametrize("kind", FORMATS)
@pytest.mark.parametrize("text", HOSTILE)
def test_any_text_is_drawn_and_none_comes_alive(kind, text):
    assert FORMATS[kind](drawn(TextMark(50 + 50j, text, 4, "#000000")))


def test_the_box_of_a_text_is_as_wide_as_its_letters_and_turns_with_it():
    low, end, __, left = text_corners(TextMark(50 + 50j, "AB", 10, "#000000", "center"))
    assert end - low == pytest.approx(text_width("AB", 10)) and (low + end) / 2 == pytest.approx(50 + 45j)
    assert left - low == pytest.approx(10j)
    low, end, *__ = text_corners(TextMark(50 + 50j, "AB", 10, "#000000", turn=90))
    assert end - low == pytest.approx(1j * text_width("AB", 10))


def test_characters_that_the_font_lacks_are_told():
    assert missing_characters("A₃τ Я") == set() and missing_characters("A\U0001f980") == {"\U0001f980"}


def test_thin_upright_letters_are_as_dark_wherever_they_fall_between_pixels():
    def ink(at):
        picture = Image.open(io.BytesIO(FORMATS["png"](Drawing.of((20.0, 20.0), [TextMark(at, "l", 2.0, "#000000")]))))
        return sum(255 - value for value in picture.convert("L").tobytes())

    found = [ink(10 + 10j + 0.03 * k) for k in range(8)]
    assert min(found) > 0.9 * max(found) > 0


RUSSIAN = [chr(k) for k in (*range(0x21, 0x7F), *range(0x410, 0x450), *range(0x391, 0x3A2), *range(0x3B1, 0x3CA))]


def advances(slant):
    return [load_font(*slant).load_char(ord(letter)).linearHoriAdvance for letter in RUSSIAN]


@pytest.mark.skipif("fork" not in multiprocessing.get_all_start_methods(), reason="there are no forked processes here")
@pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")
def test_forked_processes_read_letters_at_one_time_as_one_process_does():
    """The fonts are open before the processes begin, as when a second file is drawn."""
    slants = [(bold, italic) for bold in (False, True) for italic in (False, True)]
    alone = [advances(slant) for slant in slants]
    with multiprocessing.get_context("fork").Pool(4) as pool:
        found = pool.map(advances, slants * 8, chunksize=1)
    assert found == alone * 8
