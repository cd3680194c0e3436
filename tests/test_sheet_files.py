"""Large sheets as files: a length measures what its scale says, texts stay data, every format has every sheet."""

from __future__ import annotations

import io
import re
from itertools import combinations

import numpy as np
import pytest
from bank import solved
from big_sheets import about
from pypdf import PdfReader
from test_commands import ROOT, SHAPER, tmm

from tmm_cli.drawing.formats import FORMATS, escape_codes
from tmm_cli.drawing.layout import (
    PAPERS,
    TITLE_BLOCK_SIZES,
    TitleBlockTexts,
    drawing_field,
    frame_corners,
    frame_pictures,
    large_sheet_files,
)
from tmm_cli.drawing.paper import Drawing, TextMark, text_corners
from tmm_cli.drawing.sheets import detailed_drawings
from tmm_cli.drawing.symbols import MechanismScene
from tmm_cli.problem import ProblemError, build_problem, read_text

SINE = ROOT / "problems" / "sine.yaml"
PRECISE = 0.01  # mm


def pdf_places(data):
    """Corners of all paths, and the middles of closed curves, mm."""
    (page,) = PdfReader(io.BytesIO(data)).pages
    found, path = [], []
    number = rb"(-?[\d.]+)"
    for line in page.get_contents().get_data().split(b"\n"):
        pairs = [complex(float(x), float(y)) for x, y in re.findall(number + b" " + number, line)]
        if re.search(rb"[\d.] [mlc]$", line):
            path += pairs
            found += [] if line.endswith(b"c") else pairs
        elif path and re.search(rb"^(h|S|s|f|b|B|h .*)", line):
            xs, ys = [z.real for z in path], [z.imag for z in path]
            found.append(complex(max(xs) + min(xs), max(ys) + min(ys)) / 2)
            path = []
    return np.array(found) * 25.4 / 72


def dxf_places(data):
    """Ends of lines, corners of polylines and middles of circles, mm."""
    ezdxf = pytest.importorskip("ezdxf")
    found = []
    for one in ezdxf.read(io.StringIO(data.decode())).modelspace():
        if one.dxftype() == "LINE":
            found += [one.dxf.start, one.dxf.end]
        elif one.dxftype() == "CIRCLE":
            found.append(one.dxf.center)
        elif one.dxftype() == "LWPOLYLINE":
            found += list(one.get_points("xy"))
    return np.array([complex(x, y) for x, y, *__ in found])


@pytest.mark.parametrize("name", ["shaper", "course-2"])  # a slotted lever with a dyad RRP; RPP and RPR
@pytest.mark.parametrize(("kind", "places_of"), [("pdf", pdf_places), ("dxf", dxf_places)])
def test_a_named_segment_measures_what_its_scale_says(name, kind, places_of):
    results = solved(name)
    sheet = about(name, "kinematics")
    lines = Drawing(
        sheet.paper, tuple(mark for mark in sheet.marks if not isinstance(mark, TextMark))
    )  # letters cost time
    places = places_of(FORMATS[kind](lines))
    ((at, picture),) = [(at, one) for at, one in sheet.pictures if one.stem == "mechanism"]
    high = at + complex(*picture.paper)
    places = places[(places.real > at.real) & (places.real < high.real)]
    places = places[(places.imag > at.imag) & (places.imag < high.imag)]
    scene = MechanismScene(results.linkage, results.structure, results.motion.poses, detailed_drawings(results)[0].k)
    for link in results.linkage.moving:
        for first, last in combinations(results.linkage.links[link].points, 2):
            wanted = (scene.point(last) - scene.point(first)) / picture.mu
            off = np.abs(places[None, :] - places[:, None] - wanted)
            assert off.min() < PRECISE, (link, first, last)


HOSTILE = {
    "student": "%%c \\P {\\fArial;x} $\\frac{1}{0}$ <b>",
    "group": "x" * 200,
    "teacher": "שלום עربي",
    "code": 17,
    "department": "Кафедра теории механизмов и машин \U0001f600 " * 3,
}


@pytest.mark.parametrize("block", ["gost", "plain"])
def test_texts_of_the_title_block_stay_in_it_whatever_they_are(block):
    texts = ", ".join(f"{key}: {value!r}" for key, value in HOSTILE.items())
    text = SHAPER.read_text(encoding="utf-8") + f"sheet: {{{texts}, block: {block}}}\n"
    problem = build_problem(read_text(text, "x.yaml"))
    titles = TitleBlockTexts(problem.title_texts, "$x$ " * 50, "Forces", 2, 7)
    sheet = frame_pictures([], drawing_field(PAPERS["A3"], block), PAPERS["A3"], titles)
    __, high = frame_corners(sheet.paper)
    low = complex(high.real - TITLE_BLOCK_SIZES[block][0], 5)
    end = complex(high.real, 5 + TITLE_BLOCK_SIZES[block][1])
    written = [text_corners(mark) for mark in sheet.marks if isinstance(mark, TextMark) and _within(mark.at, low, end)]
    assert len(written) > 8
    assert all(_within(corner, low - 0.01, end + 0.01) for one in written for corner in one)
    assert all(FORMATS[kind](sheet) for kind in FORMATS)


def _within(place, low, high):
    return low.real <= place.real <= high.real and low.imag <= place.imag <= high.imag


@pytest.mark.parametrize("given", ["x" * 201, "[1]", "true"])
def test_a_text_of_the_title_block_that_is_none_is_refused(given):
    text = SHAPER.read_text(encoding="utf-8") + f"sheet: {{student: {given}}}\n"
    with pytest.raises(ProblemError) as refused:
        build_problem(read_text(text, "x.yaml"))
    assert refused.value.path == ("sheet", "student")


def test_no_code_of_dxf_comes_alive():
    text = pytest.importorskip("ezdxf.tools.text")
    for words in ("%%c", "50%", "a^Ib", "%%%%d", "\\U+0041", "\\M+5ABCD"):
        shown = text.plain_text(escape_codes(words)).replace("\N{HAIR SPACE}", "")
        assert shown == words


def test_a_dxf_has_layers_millimetres_and_cyrillic_letters_and_no_errors():
    ezdxf = pytest.importorskip("ezdxf")
    sheet = about("shaper", "forces")
    words = TextMark(100 + 100j, "Ползун, µ = 0,5 Н/мм", 3.5, "#1a1a1a")
    document = ezdxf.read(io.StringIO(FORMATS["dxf"](Drawing(sheet.paper, (*sheet.marks, words))).decode()))
    audit = document.audit()
    assert not audit.errors and not audit.fixes
    assert document.header["$INSUNITS"] == 4
    used = {one.dxf.layer for one in document.modelspace()}
    assert {"frame", "links", "supports", "construction", "vectors", "dimensions", "text"} >= used
    assert {"frame", "links", "supports", "vectors", "text"} <= used
    assert words.text in {one.dxf.text for one in document.modelspace().query("TEXT")}


def test_the_command_writes_a_file_a_sheet_and_format(tmp_path):
    done = tmm("sheets", SINE, "--format", "A2", "--as", "svg,dxf", "-o", tmp_path)
    assert done.returncode == 0, done.stderr
    written = {path.name for path in (tmp_path / "sine").iterdir()}
    assert {"sheet-1-structure.dxf", "sheet-2-kinematics.dxf", "sheet-3-forces.dxf", "sheet-1-structure.svg"} <= written
    (tmp_path / "sine" / "sheet-9.svg").write_bytes(b"of an earlier run")
    assert tmm("sheets", SINE, "--as", "svg", "-o", tmp_path).returncode == 0
    assert not (tmp_path / "sine" / "sheet-9.svg").exists() and (tmp_path / "sine" / "sheet-1-structure.dxf").exists()


def test_an_unknown_format_and_a_missing_library_are_said_in_a_line(tmp_path, monkeypatch):
    done = tmm("sheets", SHAPER, "--as", "dwg", "-o", tmp_path)
    assert done.returncode == 2 and "dwg" in done.stderr and "dxf" in done.stderr
    monkeypatch.setattr("tmm_cli.drawing.layout.arrangement.find_spec", lambda name: None)
    done = tmm("sheets", SHAPER, "--as", "dxf", "-o", tmp_path)
    assert done.returncode == 2 and "pip install 'tmm-cli[cad]'" in done.stderr
    assert not list(tmp_path.iterdir())


def test_a_pdf_has_a_page_for_every_sheet():
    written = dict(large_sheet_files(solved("sine"), "A3", ["pdf", "svg"], lambda note: None, all_positions=False))
    pages = PdfReader(io.BytesIO(written["sheets.pdf"])).pages
    assert len(pages) == len(written) - 1
    assert [float(side) * 25.4 / 72 for side in pages[0].mediabox[2:]] == pytest.approx([420, 297], abs=1e-3)
    assert "Sheet 1" in pages[0].extract_text()


def test_where_nothing_acts_there_is_no_sheet_of_forces():
    said = []
    names = [
        name for name, __ in large_sheet_files(solved("log-generator"), "A3", ["svg"], said.append, all_positions=False)
    ]
    assert names == ["sheet-1-structure.svg", "sheet-2-kinematics.svg"]
    assert said == ["note: there are no weights and no loads, so the force analysis sheet is not drawn"]
