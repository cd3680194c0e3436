"""What is on the sheet of all positions: numbers at the driver and the output, ends of its way, stroke, lengths."""

from __future__ import annotations

import re
from functools import cache

import numpy as np
import pytest
from bank import moved, solved
from hypothesis import given, strategies as st
from test_commands import ROOT

from tmm_cli import solve
from tmm_cli.drawing.paper import TICK_LENGTH, AreaMark, LineMark, TextMark, spread_intervals, text_corners
from tmm_cli.drawing.sheets import (
    detailed_drawings,
    draw_all_positions,
    draw_position,
    extreme_states,
    output_extremes,
    output_path,
    scale_ratio,
)
from tmm_cli.mechanics.plans import drawing_area
from tmm_cli.mechanics.quantities import LENGTH
from tmm_cli.problem import build_problem, read_text


@cache
def sheet_of(name):
    results = moved(name)
    ((__, sheet),) = draw_all_positions(results)
    return results, sheet


def numbers(sheet):
    """Marks of positions on the sheet, those of one place taken apart."""
    return [n for text in sheet.texts() if re.fullmatch(r"[\dk′, ]+", text) for n in text.split(", ")]


def scale(sheet):
    (found,) = [m[1] for m in (re.match(r" = (\S+) m/mm", text) for text in sheet.texts()) if m]
    return float(found)


@pytest.mark.parametrize("name", ["shaper", "course-2", "course-3", "six-bar", "crank-rocker", "press-class-iii"])
def test_each_position_is_numbered_at_the_crank_and_at_the_output(name):
    results, sheet = sheet_of(name)
    found = numbers(sheet)
    links = list(results.linkage.moving)  # their numbers are on the sheet too
    for number in map(str, results.numbers):
        assert found.count(number) - (number in links) >= 2
    assert found.count("k") == 2


@pytest.mark.parametrize("name", ["shaper", "course-1", "course-3", "six-bar", "crank-slider-offset", "two-strokes"])
def test_the_dimension_of_the_stroke_measures_it(name):
    results, sheet = sheet_of(name)
    stroke = results.strokes.travel
    assert f"H = {results.problem.units.from_si(stroke, LENGTH):.4g} mm" in sheet.texts()
    heads = [
        max(mark.corners, key=lambda z, m=mark: abs(z - sum(m.corners) / 3)) for mark in dimensions(sheet, AreaMark)
    ]
    assert len(heads) == 2
    assert abs(heads[1] - heads[0]) * scale(sheet) == pytest.approx(stroke, rel=1e-9)


def dimensions(sheet, kind):
    return [mark for mark in sheet.marks if isinstance(mark, kind) and mark.layer == "dimensions"]


@pytest.mark.parametrize(("name", "swing"), [("crank-rocker", "ψ = 47.39 deg"), ("slotted-lever", "ψ = 38.94 deg")])
def test_the_swing_of_a_rocker_is_marked(name, swing):
    assert swing in sheet_of(name)[1].texts()


@pytest.mark.parametrize("name", ["shaper", "course-3", "crank-rocker", "two-strokes"])
def test_ends_of_the_way_are_extremes_of_the_output(name):
    results, __ = sheet_of(name)
    track, ends = output_path(results), output_extremes(results)
    there, everywhere = track.places(extreme_states(results, ends)), track.places(results.motion)
    size = max(abs(p - q) for p in there for q in there)
    assert all(abs(p - q) < size * (1 + 1e-9) for p in everywhere for q in there)
    assert ends[0].mark == "0" and all(e.mark == str(e.mark) for e in ends)
    assert len({end.mark for end in ends}) == len(results.strokes.strokes)


def test_ticks_of_a_slider_are_where_it_is():
    results, sheet = sheet_of("shaper")
    mu, motion = scale(sheet), results.motion
    ticks = [
        m for m in sheet.marks if isinstance(m, LineMark) and abs(abs(m.places[-1] - m.places[0]) - TICK_LENGTH) < 1e-9
    ]
    at = sorted(m.places[0].real * mu for m in ticks)
    places = motion.named("E").x.real.tolist()
    places[7] = extreme_states(results, output_extremes(results)).spot("E")[1].real  # on paper 7 and k are one place
    assert np.diff(at) == pytest.approx(np.diff(sorted(places)), abs=1e-9)


def test_paths_of_centres_of_mass_are_dashed_too():
    __, sheet = sheet_of("shaper")
    dashed = [mark for mark in sheet.marks if isinstance(mark, LineMark) and mark.style == "--"]
    mu = scale(sheet)
    (pivot,) = [mark.centre for mark in sheet.marks if getattr(mark, "radius", 0) == 1.3 and near_o(sheet, mark)]
    radius = 0.3 * 0.11  # of S1
    circles = [m for m in dashed if all(abs(abs(z - pivot) * mu - radius) < 1e-9 for z in m.places)]
    assert circles


def near_o(sheet, mark):
    """Whether a hinge is the middle of the crank's circle: the only one about which dots of positions stand."""
    dots = [m.centre for m in sheet.marks if getattr(m, "radius", 0) == 0.5]
    away = [abs(dot - mark.centre) for dot in dots]
    return max(away) - min(away) < 1e-6


def test_lengths_have_the_names_of_the_file_s_parameters():
    texts = sheet_of("crank-slider-offset")[1].texts()
    assert texts[texts.index("OA") : texts.index("OA") + 3] == ["OA", "r", "50"]
    assert texts[texts.index("AB") : texts.index("AB") + 3] == ["AB", "l", "190"]
    assert texts[texts.index("distance of guide x from O") :][1:3] == ["e", "40"]
    texts = sheet_of("crank-rocker")[1].texts()
    assert texts[texts.index("OD") : texts.index("OD") + 3] == ["OD", "l4", "400"]
    texts = sheet_of("planetary-dwell-press")[1].texts()  # a wheel in a ring of five times its radius
    wheels = [texts[k + 1 : k + 3] for k, text in enumerate(texts) if text == "r"]
    assert wheels == [["0", "125"], ["2", "25"]]
    texts = sheet_of("shaper")[1].texts()  # parameters are called like lengths
    assert texts[texts.index("CD") : texts.index("CD") + 2] == ["CD", "650"]
    assert texts[texts.index("distance of guide x from O") + 1] == "270"


@pytest.mark.parametrize("name", ["shaper", "course-1", "course-2", "course-3", "course-4", "six-bar", "excavator"])
def test_the_scale_is_one_of_the_standard_and_the_figure_uses_the_field(name):
    __, sheet = sheet_of(name)
    mu = scale(sheet)
    assert 1000 * mu in (1, 2, 2.5, 4, 5, 10, 15, 20, 25, 40, 50, 75, 100)
    assert f", {scale_ratio(mu)}" in sheet.texts()
    low, high = drawing_area(sheet.paper)
    places = np.array(
        [z for m in sheet.marks if isinstance(m, LineMark) and m.layer != "frame" and m.z < 6 for z in m.places]
    )
    assert max(np.ptp(places.real) / (high - low).real, np.ptp(places.imag) / (high - low).imag) > 0.6


def test_scales_of_a_drawing():
    assert [scale_ratio(mu) for mu in (0.004, 0.015, 0.001, 0.0005)] == ["1:4", "1:15", "1:1", "2:1"]


@given(st.lists(st.tuples(st.floats(0, 50), st.floats(0.1, 9)), min_size=1, max_size=12))
def test_numbers_that_would_touch_stand_apart_and_others_stay(pairs):
    pairs = sorted(pairs)
    wanted, sizes = zip(*pairs, strict=True)
    found = spread_intervals(wanted, sizes)
    for k in range(1, len(found)):
        assert found[k] - found[k - 1] >= (sizes[k] + sizes[k - 1]) / 2 - 1e-9
    if all(wanted[k] - wanted[k - 1] > (sizes[k] + sizes[k - 1]) / 2 for k in range(1, len(found))):
        assert found == pytest.approx(wanted)


@pytest.mark.parametrize("name", ["shaper", "two-strokes", "press-class-iii", "course-3"])
def test_numbers_beside_the_way_do_not_cover_one_another(name):
    __, sheet = sheet_of(name)
    texts = [m for m in sheet.marks if isinstance(m, TextMark) and re.fullmatch(r"[\dk′, ]+", m.text) and m.size < 3]
    boxes = [(text_corners(m)[0], text_corners(m)[2]) for m in texts]
    for n, (low, high) in enumerate(boxes):
        for other_low, other_high in boxes[:n]:
            across = min(high.real, other_high.real) - max(low.real, other_low.real)
            up = min(high.imag, other_high.imag) - max(low.imag, other_low.imag)
            assert min(across, up) < 0.3


def test_the_way_of_a_point_or_of_a_coupler_is_told_in_words():
    """Its ends lie on a curve, not on a line or about a pivot."""
    text = (ROOT / "problems" / "six-bar.yaml").read_text(encoding="utf-8")
    results = solve(build_problem(read_text(text.replace("output: 5", "output: K"), "x.yaml")), "kinematics")
    ((__, sheet),) = draw_all_positions(results)
    assert f"H = {1000 * results.strokes.travel:.4g} mm" in sheet.texts()
    assert not dimensions(sheet, AreaMark)


def test_numbers_of_the_working_stroke_stand_outside_and_the_sheet_says_so():
    __, sheet = sheet_of("shaper")
    assert "outer numbers: positions of the working stroke" in sheet.texts()
    (stroke,) = [mark for mark in sheet.marks if isinstance(mark, TextMark) and mark.text.startswith("H = ")]
    # H is dimensioned beyond the outer numbers; 3 is in the working stroke, 9 in the idle one
    outer, inner = (
        min(
            abs(mark.at.imag - stroke.at.imag)
            for mark in sheet.marks
            if isinstance(mark, TextMark) and mark.text == text
        )
        for text in "39"
    )
    assert outer < inner - 4


@pytest.mark.parametrize("name", ["shaper", "press-class-iii", "lifting-boom", "planetary-dwell-press"])
def test_a_position_under_its_loads_fills_its_sheet(name):
    here = detailed_drawings(solved(name))[0]
    ((__, sheet),) = draw_position(here)
    marks = np.concatenate([np.ravel(m.places) for m in sheet.marks if isinstance(m, LineMark) and m.layer != "frame"])
    marks = marks[np.isfinite(marks)]
    low, high = drawing_area(sheet.paper)
    used = [np.ptp(part) / room for part, room in ((marks.real, (high - low).real), (marks.imag, (high - low).imag))]
    assert max(used) > 0.5 and max(used) <= 1
