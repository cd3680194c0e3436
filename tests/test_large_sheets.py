"""Large sheets: everything stands on them to scale, nothing overlaps, a millimetre is a millimetre."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
from bank import problem, solved
from big_sheets import COURSES, about, apart, boxes, drawn, free, used
from covering import covered
from hypothesis import given, settings, strategies as st

from tmm_cli import solve
from tmm_cli.drawing.layout import (
    PAPERS,
    TITLE_BLOCK_SIZES,
    PackingField,
    choose_positions,
    drawing_field,
    frame_corners,
    large_sheets,
    pack_boxes,
    spread_boxes,
)
from tmm_cli.drawing.paper import CircleMark, Drawing, LineMark, TextMark, cut_text, wrap_text
from tmm_cli.drawing.run import all_sheets
from tmm_cli.mechanics.plans import ROUND_SCALES


@given(st.lists(st.tuples(st.floats(10, 300), st.floats(10, 200)), min_size=1, max_size=12))
@settings(max_examples=30)
def test_packed_boxes_are_in_the_field_beside_the_title_block_and_do_not_overlap(sizes):
    field = PackingField(816.0, 584.0, (185.0, 55.0))
    places = pack_boxes(sizes, field)
    if places is None:
        return
    for arrangement in (places, spread_boxes(places, sizes, field)):
        found = [(complex(x, y), complex(x + w, y + h)) for (x, y), (w, h) in zip(arrangement, sizes, strict=True)]
        taken = (complex(816 - 185, 584 - 55), 816 + 584j)
        slack = 1e-6 * (1 + 1j)
        assert all(low.real >= 0 and low.imag >= 0 for low, __ in found)
        assert all(high.real <= 816 + 1e-6 and high.imag <= 584 + 1e-6 for __, high in found)
        assert all(apart((low + slack, high - slack), taken) for low, high in found)
        assert all(apart((a + slack, b - slack), other) for (a, b), other in combinations(found, 2))


@pytest.mark.parametrize(
    ("name", "paper"),
    [
        *((name, "A1") for name in (*COURSES, "log-generator", "cylinder")),
        ("four-positions", "A2"),
        *((name, "A3") for name in ("shaper", "loader", "tangent", "hanger", "positioner")),
    ],
)
def test_sheets_are_full_and_nothing_on_them_overlaps(name, paper):
    """On the cylinder's, the hanger's and the positioner's, drawings of which nothing or only text is large end it."""
    for stem, sheet in drawn(name, paper).items():
        low, high = frame_corners(sheet.paper)
        block = (
            complex(high.real - TITLE_BLOCK_SIZES["gost"][0], low.imag),
            complex(high.real, low.imag + TITLE_BLOCK_SIZES["gost"][1]),
        )
        found = boxes(sheet)
        assert all(apart(one, other) for one, other in combinations([*found, block], 2)), stem
        assert all(a.real >= low.real and a.imag >= low.imag for a, __ in found), stem
        assert all(b.real <= high.real and b.imag <= high.imag for __, b in found), stem
        assert used(sheet) >= 0.6 * free(sheet), (stem, used(sheet) / free(sheet))


@pytest.mark.parametrize("name", COURSES)
def test_each_large_sheet_begins_in_its_upper_left_corner_with_what_a_course_begins_with(name):
    for subject, first in (("structure", "structure"), ("kinematics", "mechanism"), ("forces", "position")):
        sheet = about(name, subject)
        low, high = frame_corners(sheet.paper)
        at, picture = sheet.pictures[0]
        assert picture.stem.startswith(first)
        assert abs(at + 1j * picture.paper[1] - complex(low.real, high.imag)) < 10


@pytest.mark.parametrize("name", COURSES)
def test_no_text_of_a_large_sheet_covers_another_one_a_head_of_an_arrow_or_a_line(name):
    for stem, sheet in drawn(name).items():
        found = [pair for __, one in sheet.pictures for pair in covered(one)]
        block = complex(sheet.paper[0] - 5 - TITLE_BLOCK_SIZES["gost"][0], 5 + TITLE_BLOCK_SIZES["gost"][1])
        titles = [
            m for m in sheet.marks if isinstance(m, TextMark) and m.at.real > block.real and m.at.imag < block.imag
        ]
        lines = [mark for mark in sheet.marks if isinstance(mark, LineMark) and mark.layer == "frame"]
        assert titles
        assert not [f"{stem}: {pair}" for pair in [*found, *covered(Drawing(sheet.paper, (*lines, *titles)))]]


def test_what_has_no_scale_is_on_the_smallest_format_that_holds_it():
    papers = {stem: sheet.paper for stem, sheet in drawn("shaper").items()}
    names = ["sheet-1-structure", "sheet-2-kinematics", "sheet-3-forces"]
    assert papers == dict(zip(names, (PAPERS["A3"], PAPERS["A1"], PAPERS["A1"]), strict=True))


@pytest.mark.parametrize("name", COURSES)
def test_what_follows_stands_to_the_right_or_below_of_what_comes_before(name):
    for stem, sheet in drawn(name).items():
        corners_of = [(one.stem, at.real, -at.imag - one.paper[1]) for at, one in sheet.pictures]
        back = [
            (a, b)
            for (a, *first), (b, *then) in combinations(corners_of, 2)
            if then[0] <= first[0] and then[1] <= first[1]
        ]
        assert not back, stem


def test_each_group_stands_beside_its_force_plan_in_solving_order():
    stems = [one.stem for __, one in about("shaper", "forces").pictures]
    assert stems == [
        "position-03",
        "group-loads-03-links-4-5",
        "forces-03-links-4-5",
        "group-loads-03-links-2-3",
        "forces-03-links-2-3",
        "group-loads-03-link-1",
        "forces-03-link-1",
        "lever-03",
        "table-forces-03",
        "table-balance",
    ]


@pytest.mark.parametrize("name", COURSES)
def test_letters_of_the_tables_of_a_sheet_differ_by_a_tenth_at_most(name):
    for stem, sheet in drawn(name).items():
        tables = [one for __, one in sheet.pictures if one.stem.startswith("table")]
        sizes = [
            max(mark.size for mark in one.marks if isinstance(mark, TextMark) and _in_a_cell(mark, one))
            for one in tables
        ]
        assert max(sizes) <= 1.1 * min(sizes), (stem, sizes)


def _in_a_cell(mark, table):
    """Whether a text stands between the lines of a table; headings and notes stand above them."""
    return mark.at.imag < max(place.imag for line in table.marks if isinstance(line, LineMark) for place in line.places)


def test_sheets_count_from_one_and_say_structure_where_nothing_is_synthesised():
    titles = {
        name: [{mark.text for mark in sheet.marks if isinstance(mark, TextMark)} for sheet in drawn(name).values()]
        for name in ("shaper", "log-generator")
    }
    for texts in titles.values():
        for number, written in enumerate(texts, 1):
            assert {f"Sheet {number}", f"Sheets {len(texts)}"} <= written
    assert "Structure" in titles["shaper"][0]
    assert "Structure and synthesis" in titles["log-generator"][0]


@pytest.mark.parametrize("name", COURSES)
def test_scales_are_round(name):
    for sheet in drawn(name).values():
        for __, one in sheet.pictures:
            if one.mu is not None:
                assert any(
                    one.mu / 10 ** np.floor(np.log10(one.mu * 1.000001)) == pytest.approx(f) for f in ROUND_SCALES
                )


def test_every_drawing_of_a_run_stands_on_a_large_sheet():
    kinds = {one.stem.partition("-")[0] for sheet in drawn("shaper").values() for __, one in sheet.pictures}
    run = {stem.partition("-")[0] for stem, one in all_sheets(solved("shaper")) if isinstance(one, Drawing)}
    assert len(run) > 8 and run <= kinds


def test_a_text_is_cut_where_its_cell_ends():
    assert cut_text("short", 3.0, 50.0) == "short"
    assert cut_text("x" * 10_000, 3.0, 20.0).endswith("…")
    lines = wrap_text("one two three four five six seven eight nine ten", 3.0, 20.0, 2)
    assert len(lines) == 2 and lines[-1].endswith("…")


def test_plans_of_all_positions_go_on_on_further_sheets():
    sine = problem("sine")
    results = solve(replace(sine, request=replace(sine.request, count=6)))
    pages = dict(large_sheets(choose_positions(results, all_positions=True), "A3"))
    assert sum(name.endswith("kinematics") for name in pages) > 1
    stems = [one.stem for sheet in pages.values() for __, one in sheet.pictures]
    assert {f"velocity-{number:02d}" for number in results.numbers} <= set(stems)
    assert drawing_field(PAPERS["A3"], "gost").area > 0
    assert not [
        mark for sheet in pages.values() for mark in sheet.marks if isinstance(mark, CircleMark) and mark.radius < 0
    ]
