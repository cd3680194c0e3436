"""What is on the plans of velocities and accelerations: true lengths, names as courses have them, a table of values."""

from __future__ import annotations

import re
from functools import cache

import pytest
from bank import solved

from tmm_cli.drawing.paper import CircleMark, TextMark, plain_text, text_corners
from tmm_cli.drawing.sheets import detailed_drawings, draw_motion_plans, motion_plan_kinds, motion_plan_rows

NAMES = ("shaper", "course-3", "six-bar", "press-class-iii", "excavator", "cam-lever", "planetary-dwell-press")


@cache
def plans(name):
    """The first position in detail, and its two sheets with what they are of."""
    results = solved(name)
    here = detailed_drawings(results)[0]
    return here, [(sort, sheet) for sort, (__, sheet) in zip(motion_plan_kinds(), draw_motion_plans(here), strict=True)]


def scale(sheet):
    """The number of the scale factor that the sheet tells."""
    (found,) = [m[1] for m in (re.fullmatch(r" = (\S+) \((m/s|m/s²)\)/mm", t) for t in sheet.texts()) if m]
    return float(found)


@pytest.mark.parametrize("name", NAMES)
def test_points_of_a_plan_are_as_far_from_the_pole_as_the_scale_says(name):
    here, drawn = plans(name)
    for sort, sheet in drawn:
        mu, plan = scale(sheet), sort.plan(here.motion, here.k)
        spots = [mark.centre for mark in sheet.marks if isinstance(mark, CircleMark)]
        (pole,) = [mark.centre for mark in sheet.marks if isinstance(mark, CircleMark) and mark.radius == 0.9]
        for end in plan.ends.values():
            # letters that coincide on paper have one spot
            assert min(abs(pole + end / mu - spot) for spot in spots) < 0.5
        farthest = max(plan.ends.values(), key=abs)
        assert min(abs(pole + farthest / mu - spot) for spot in spots) < 1e-9


@pytest.mark.parametrize("name", NAMES)
def test_the_table_has_the_results_to_the_digits_it_shows(name):
    here, drawn = plans(name)
    motion, k = here.motion, here.k
    for sort, sheet in drawn:
        mu = scale(sheet)
        rows = motion_plan_rows(here, sort, sort.plan(motion, k), mu)
        found = {sign: row.cells for row in rows if not row.head for sign in plain_text(row.cells[0]).split(" = ")}
        for point in motion.linkage.moving_points:
            value = abs(getattr(motion.named(point), sort.letter)[k])
            _, segment, length, shown = found[f"{sort.letter}_{point}"]
            assert float(shown) == pytest.approx(value, rel=6e-4, abs=1e-9)
            assert float(length) == pytest.approx(value / mu, abs=0.051)
            assert (segment == "") == (float(shown) == 0)
        for link in motion.linkage.moving:
            value = getattr(motion.link(link), sort.what)[k]
            _, sense, _, shown = found.get(f"{'ω' if sort.letter == 'v' else 'ε'}_{link}", ("", "", "", "0"))
            assert float(shown) == pytest.approx(abs(value), rel=6e-4, abs=1e-9)
            assert sense == ("" if float(shown) == 0 else "ccw" if value > 0 else "cw")
        texts = sheet.texts()
        assert all(cell in texts for cells in found.values() for cell in cells[1:] if cell)


@pytest.mark.parametrize("name", NAMES)
def test_the_block_with_the_table_covers_nothing_of_the_plan(name):
    for __, sheet in plans(name)[1]:
        (scales,) = [mark for mark in sheet.marks if isinstance(mark, TextMark) and mark.text == "μ"]
        left, top = text_corners(scales)[0].real, text_corners(scales)[2].imag
        cells = [m for m in sheet.marks if isinstance(m, TextMark) and m.size == pytest.approx(8 * 25.4 / 72)]
        right, low = max(text_corners(m)[1].real for m in cells), min(text_corners(m)[0].imag for m in cells)
        for mark in sheet.marks:
            if isinstance(mark, CircleMark):
                inside = left < mark.centre.real < right and low < mark.centre.imag < top
                assert not inside


def test_parts_of_accelerations_have_their_indices_on_the_sheet():
    velocities, accelerations = (sheet for __, sheet in plans("shaper")[1])
    assert "AA3" in velocities.texts() and "ED" in velocities.texts()  # of v
    for index in ("AO", "DC", "ED", "A3C", "AA3"):
        assert accelerations.texts().count(index) >= 2  # beside its vector, and in the table
    assert {"n", "τ", "k", "r"} <= set(accelerations.texts())


def test_a_vector_too_short_to_be_seen_is_in_the_table_with_its_value():
    here, drawn = plans("shaper")
    sort, sheet = drawn[1]
    rows = {
        plain_text(row.cells[0]): row.cells
        for row in motion_plan_rows(here, sort, sort.plan(here.motion, here.k), scale(sheet))
    }
    assert float(rows["a^n_ED"][2]) < 4 and float(rows["a^n_ED"][3]) == pytest.approx(
        0.21 * here.motion.link("4").omega[3] ** 2, rel=1e-3
    )
    assert rows["a^τ_AO"][1:] == ("", "0", "0")


def test_a_stone_on_the_frame_s_pivot_is_measured_to_the_pole():
    here, ((sort, __), __) = plans("press-class-iii")
    (sliding,) = (v for v in sort.plan(here.motion, here.k).vectors if v.kind == "sliding")
    assert sliding.name == "g5p" and sliding.end == 0


def test_every_letter_of_a_segment_stands_on_the_plan():
    here, (__, (sort, sheet)) = plans("shaper")
    lettered = {letter for text in sheet.texts() for letter in text.split(", ")}
    assert {*sort.plan(here.motion, here.k).corners} <= lettered and "d, n₃" in sheet.texts()
