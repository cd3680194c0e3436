"""Large sheets: everything stands on them to scale, nothing overlaps, a millimetre is a millimetre."""

from __future__ import annotations

import functools
import io
import re
from itertools import combinations

import numpy as np
import pytest
from bank import solved
from covering import covered
from hypothesis import given, settings
from hypothesis import strategies as st
from pypdf import PdfReader
from test_commands import ROOT, SHAPER, tmm

from tmm_cli.draw import sheets
from tmm_cli.draw.formats import FORMATS
from tmm_cli.draw.formats.dxf import plain
from tmm_cli.draw.layout.contents import chosen
from tmm_cli.draw.layout.files import files_of_sheets
from tmm_cli.draw.layout.large import PAPERS, field_of, framed, large_sheets
from tmm_cli.draw.layout.packing import Field, pack, spread
from tmm_cli.draw.layout.title_block import SIZES, Titles, inner
from tmm_cli.draw.paper.drawing import Circle, Drawing, Line, Text
from tmm_cli.draw.paper.fonts import corners
from tmm_cli.draw.paper.writing import cut, wrap
from tmm_cli.draw.sheets.mechanism import detailed
from tmm_cli.draw.symbols.scene import Scene
from tmm_cli.plans.record import ROUND
from tmm_cli.problem.build import build
from tmm_cli.problem.errors import ProblemError
from tmm_cli.problem.reader import read_text

SINE = ROOT / "problems" / "sine.yaml"
COURSES = ["shaper", "course-1", "course-2", "course-3", "course-4"]
PRECISE = 0.01  # mm


@functools.cache
def drawn(name, paper="A1", every=False):
    return dict(large_sheets(chosen(solved(name), every=every), paper))


def boxes(sheet):
    """Lower left and upper right corners of what stands on a sheet."""
    return [(at, at + complex(*one.paper)) for at, one in sheet.pictures]


def apart(one, other):
    (low, high), (other_low, other_high) = one, other
    return (
        low.real >= other_high.real or other_low.real >= high.real
        or low.imag >= other_high.imag or other_low.imag >= high.imag
    )  # fmt: skip


@given(st.lists(st.tuples(st.floats(10, 300), st.floats(10, 200)), min_size=1, max_size=12))
@settings(max_examples=60, deadline=None)
def test_packed_boxes_are_in_the_field_beside_the_title_block_and_do_not_overlap(sizes):
    field = Field(816.0, 584.0, (185.0, 55.0))
    places = pack(sizes, field)
    if places is None:
        return
    for arrangement in (places, spread(places, sizes, field)):
        found = [(complex(x, y), complex(x + w, y + h)) for (x, y), (w, h) in zip(arrangement, sizes, strict=True)]
        taken = (complex(816 - 185, 584 - 55), 816 + 584j)
        slack = 1e-6 * (1 + 1j)
        assert all(low.real >= 0 and low.imag >= 0 for low, __ in found)
        assert all(high.real <= 816 + 1e-6 and high.imag <= 584 + 1e-6 for __, high in found)
        assert all(apart((low + slack, high - slack), taken) for low, high in found)
        assert all(apart((a + slack, b - slack), other) for (a, b), other in combinations(found, 2))


@pytest.mark.parametrize(
    ("name", "paper"),
    [*((name, "A1") for name in COURSES), *((name, "A3") for name in ("shaper", "course-4", "loader"))],
)
def test_sheets_are_full_and_nothing_on_them_overlaps(name, paper):
    for stem, sheet in drawn(name, paper).items():
        low, high = inner(sheet.paper)
        block = complex(high.real - SIZES["gost"][0], low.imag), complex(high.real, low.imag + SIZES["gost"][1])
        free = (high - low).real * (high - low).imag - SIZES["gost"][0] * SIZES["gost"][1]
        found = boxes(sheet)
        assert all(apart(one, other) for one, other in combinations([*found, block], 2)), stem
        assert all(a.real >= low.real and a.imag >= low.imag for a, __ in found), stem
        assert all(b.real <= high.real and b.imag <= high.imag for __, b in found), stem
        used = sum((b - a).real * (b - a).imag for a, b in found)
        assert used >= 0.6 * free, (stem, used / free)


@pytest.mark.parametrize("name", COURSES)
def test_each_large_sheet_begins_in_its_upper_left_corner_with_what_a_course_begins_with(name):
    for stem, first in (("sheet-0", "structure"), ("sheet-1", "mechanism"), ("sheet-2", "position")):
        sheet = drawn(name)[stem]
        low, high = inner(sheet.paper)
        at, picture = sheet.pictures[0]
        assert picture.stem.startswith(first)
        assert abs(at + 1j * picture.paper[1] - complex(low.real, high.imag)) < 10


@pytest.mark.parametrize("name", COURSES)
def test_no_text_of_a_large_sheet_covers_another_one_a_head_of_an_arrow_or_a_line(name):
    for stem, sheet in drawn(name).items():
        found = [pair for __, one in sheet.pictures for pair in covered(one)]
        block = complex(sheet.paper[0] - 5 - SIZES["gost"][0], 5 + SIZES["gost"][1])
        titles = [m for m in sheet.marks if isinstance(m, Text) and m.at.real > block.real and m.at.imag < block.imag]
        lines = [mark for mark in sheet.marks if isinstance(mark, Line) and mark.layer == "frame"]
        assert titles
        assert not [f"{stem}: {pair}" for pair in [*found, *covered(Drawing(sheet.paper, (*lines, *titles)))]]


def test_what_has_no_scale_is_on_the_smallest_format_that_holds_it():
    papers = {stem: sheet.paper for stem, sheet in drawn("shaper").items()}
    assert papers == {"sheet-0": PAPERS["A3"], "sheet-1": PAPERS["A1"], "sheet-2": PAPERS["A1"]}


@pytest.mark.parametrize("name", COURSES)
def test_scales_are_round(name):
    for sheet in drawn(name).values():
        for __, one in sheet.pictures:
            if one.mu is not None:
                assert any(one.mu / 10 ** np.floor(np.log10(one.mu * 1.000001)) == pytest.approx(f) for f in ROUND)


def test_every_drawing_of_a_run_stands_on_a_large_sheet():
    kinds = {one.stem.partition("-")[0] for sheet in drawn("shaper").values() for __, one in sheet.pictures}
    run = {stem.partition("-")[0] for stem, one in sheets(solved("shaper")) if isinstance(one, Drawing)}
    assert len(run) > 8 and run <= kinds


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


@pytest.mark.parametrize("name", COURSES)
@pytest.mark.parametrize(("kind", "places_of"), [("pdf", pdf_places), ("dxf", dxf_places)])
def test_a_named_segment_measures_what_its_scale_says(name, kind, places_of):
    results = solved(name)
    sheet = drawn(name)["sheet-1"]
    lines = Drawing(sheet.paper, tuple(mark for mark in sheet.marks if not isinstance(mark, Text)))  # letters cost time
    places = places_of(FORMATS[kind](lines))
    ((at, picture),) = [(at, one) for at, one in sheet.pictures if one.stem == "mechanism"]
    high = at + complex(*picture.paper)
    places = places[(places.real > at.real) & (places.real < high.real)]
    places = places[(places.imag > at.imag) & (places.imag < high.imag)]
    scene = Scene(results.linkage, results.structure, results.motion.poses, detailed(results)[0].k)
    for link in results.linkage.moving:
        for first, last in combinations(results.linkage.links[link].points, 2):
            wanted = (scene.point(last) - scene.point(first)) / picture.mu
            off = np.abs(places[None, :] - places[:, None] - wanted)
            assert off.min() < PRECISE, (link, first, last)


HOSTILE = {
    "student": "%%c \\P {\\fArial;x} $\\frac{1}{0}$ <b>", "group": "x" * 200, "teacher": "שלום עربي", "code": 17,
    "department": "Кафедра теории механизмов и машин \U0001f600 " * 3,
}  # fmt: skip


@pytest.mark.parametrize("block", ["gost", "plain"])
def test_texts_of_the_title_block_stay_in_it_whatever_they_are(block):
    texts = ", ".join(f"{key}: {value!r}" for key, value in HOSTILE.items())
    text = SHAPER.read_text(encoding="utf-8") + f"sheet: {{{texts}, block: {block}}}\n"
    problem = build(read_text(text, "x.yaml"))
    titles = Titles(problem.title_texts, "$x$ " * 50, "Forces", "2b", 7)
    sheet = framed([], field_of(PAPERS["A3"], block), PAPERS["A3"], titles)
    __, high = inner(sheet.paper)
    low = complex(high.real - SIZES[block][0], 5)
    end = complex(high.real, 5 + SIZES[block][1])
    written = [corners(mark) for mark in sheet.marks if isinstance(mark, Text) and _within(mark.at, low, end)]
    assert len(written) > 8
    assert all(_within(corner, low - 0.01, end + 0.01) for one in written for corner in one)
    assert all(FORMATS[kind](sheet) for kind in FORMATS)


def _within(place, low, high):
    return low.real <= place.real <= high.real and low.imag <= place.imag <= high.imag


@pytest.mark.parametrize("given", ["x" * 201, "[1]", "true"])
def test_a_text_of_the_title_block_that_is_none_is_refused(given):
    text = SHAPER.read_text(encoding="utf-8") + f"sheet: {{student: {given}}}\n"
    with pytest.raises(ProblemError) as refused:
        build(read_text(text, "x.yaml"))
    assert refused.value.path == ("sheet", "student")


def test_a_text_is_cut_where_its_cell_ends():
    assert cut("short", 3.0, 50.0) == "short"
    assert cut("x" * 10_000, 3.0, 20.0).endswith("…")
    lines = wrap("one two three four five six seven eight nine ten", 3.0, 20.0, 2)
    assert len(lines) == 2 and lines[-1].endswith("…")


def test_no_code_of_dxf_comes_alive():
    text = pytest.importorskip("ezdxf.tools.text")
    for words in ("%%c", "50%", "a^Ib", "%%%%d", "\\U+0041", "\\M+5ABCD"):
        shown = text.plain_text(plain(words)).replace("\N{HAIR SPACE}", "")
        assert shown == words


def test_a_dxf_has_layers_millimetres_and_cyrillic_letters_and_no_errors():
    ezdxf = pytest.importorskip("ezdxf")
    sheet = drawn("shaper")["sheet-2"]
    words = Text(100 + 100j, "Ползун, µ = 0,5 Н/мм", 3.5, "#1a1a1a")
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
    assert {"sheet-0.dxf", "sheet-1.dxf", "sheet-2.dxf", "sheet-0.svg"} <= written
    (tmp_path / "sine" / "sheet-9.svg").write_bytes(b"of an earlier run")
    assert tmm("sheets", SINE, "--as", "svg", "-o", tmp_path).returncode == 0
    assert not (tmp_path / "sine" / "sheet-9.svg").exists() and (tmp_path / "sine" / "sheet-0.dxf").exists()


def test_an_unknown_format_and_a_missing_library_are_said_in_a_line(tmp_path, monkeypatch):
    done = tmm("sheets", SHAPER, "--as", "dwg", "-o", tmp_path)
    assert done.returncode == 2 and "dwg" in done.stderr and "dxf" in done.stderr
    monkeypatch.setattr("tmm_cli.draw.layout.files.find_spec", lambda name: None)
    done = tmm("sheets", SHAPER, "--as", "dxf", "-o", tmp_path)
    assert done.returncode == 2 and "pip install 'tmm-cli[cad]'" in done.stderr
    assert not list(tmp_path.iterdir())


def test_plans_of_all_positions_go_on_on_further_sheets():
    pages = drawn("sine", "A3", every=True)
    assert {"sheet-1", "sheet-1a"} & set(pages)
    stems = [one.stem for sheet in pages.values() for __, one in sheet.pictures]
    assert {f"velocity-{number:02d}" for number in solved("sine").numbers} <= set(stems)
    assert field_of(PAPERS["A3"], "gost").area > 0
    assert not [
        mark for sheet in pages.values() for mark in sheet.marks if isinstance(mark, Circle) and mark.radius < 0
    ]


def test_a_pdf_has_a_page_for_every_sheet():
    written = dict(files_of_sheets(solved("sine"), "A3", ["pdf", "svg"], lambda note: None, every=False))
    pages = PdfReader(io.BytesIO(written["sheets.pdf"])).pages
    assert len(pages) == len(written) - 1
    assert [float(side) * 25.4 / 72 for side in pages[0].mediabox[2:]] == pytest.approx([420, 297], abs=1e-3)
    assert "Sheet 0" in pages[0].extract_text()


@pytest.mark.parametrize(("name", "paper"), [("cylinder", "A1"), ("hanger", "A3"), ("positioner", "A3")])
def test_drawings_of_which_nothing_or_only_text_is_large_end_the_layout(name, paper):
    assert all(sheet.pictures for sheet in drawn(name, paper).values())
