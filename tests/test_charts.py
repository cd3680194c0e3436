"""Diagrams: every axis at a round scale, curves broken where a load begins or ends, legends that cover no curve."""

import math
import re
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from bank import moved
from higher import PROBLEMS
from models import DATA
from test_commands import ROOT, SHAPER

from tmm_cli import load, solve
from tmm_cli.drawing.paper import (
    LEAST_PANEL_HEIGHT,
    LEGEND_SAMPLE,
    POINT,
    ChartCurve,
    CircleMark,
    CommonAxis,
    CurveJump,
    DrawingSheet,
    LineMark,
    Panel,
    PictureSpace,
    PlotContent,
    TextMark,
    axis_extent,
    draw_chart,
    drawing_within,
    equal_scales,
    logarithmic_axis,
    round_axis,
    round_up,
    text_corners,
    vertical_axis,
)
from tmm_cli.drawing.sheets import CURVE_COLOURS, draw_diagrams
from tmm_cli.mechanics.plans import LANDSCAPE
from tmm_cli.problem import build_problem, read_text


def shaper(*changes):
    text = SHAPER.read_text(encoding="utf-8")
    for old, new in changes:
        text = re.sub(old, new, text)
    return solve(build_problem(read_text(text, "shaper.yaml")))


@cache
def drawn(name):
    problem = (
        build_problem(read_text(PROBLEMS[name], "x.yaml")) if name in PROBLEMS else load(f"{ROOT}/problems/{name}.yaml")
    )
    return dict(draw_diagrams(solve(problem)))


def curves(drawing):
    """Polylines of quantities, from the highest panel down."""
    found = [m for m in drawing.marks if isinstance(m, LineMark) and m.width == pytest.approx(1.3 * POINT)]
    return [line for line in found if len(line.places) > 2]


def scale(drawing, symbol):
    """A scale factor as it is written on a sheet."""
    texts = drawing.texts()
    after = next(k + 1 for k, text in enumerate(texts) if text == symbol and texts[k - 1] == "μ")
    return float(re.fullmatch(r" = (\S+) .*", texts[after])[1])


@pytest.mark.parametrize(("low", "high"), [(-3.7, 12.1), (0, 0.0042), (1e5, 1.02e5), (-900, -3), (5, 5), (0, 0)])
def test_an_axis_has_a_round_scale_holds_its_values_and_numbers_that_stand_apart(low, high):
    axis = vertical_axis(low, high, 40, 60)
    assert round_up(axis.mu) == pytest.approx(axis.mu)
    assert np.all((axis.on([low, high]) >= 40) & (axis.on([low, high]) <= 100))
    places = [axis.on(value) for value, __ in axis.ticks(6)]
    assert len(places) > 2 and min(np.diff(places)) >= 6 - 1e-9


def test_a_turn_of_the_crank_ends_its_axis_and_is_numbered_by_angles():
    axis = round_axis(0, 360, 20, 170, degrees=True)
    assert (axis.mu, axis.length) == (2.5, 144)
    assert [text for __, text in axis.ticks(11)] == [str(30 * k) for k in range(13)]


def test_a_logarithmic_axis_has_whole_powers_of_ten_and_keeps_zero_at_its_end():
    axis = logarithmic_axis(0.004, 20, 10, 50)
    assert [text for __, text in axis.ticks(6)] == ["1e-3", "1e-2", "1e-1", "1", "1e1", "1e2"]
    assert axis.on([0.0, 1e-3, 100]) == pytest.approx([10, 10, 60])


def test_a_path_is_drawn_to_one_scale_both_ways():
    both = vertical_axis(0, 100, 20, 200), vertical_axis(0, 30, 20, 100)
    x, y = equal_scales(both, [(0, 100), (0, 30)])
    assert x.mu == y.mu and x.on(50) == 120 and y.on(15) == 70


def test_a_curve_measures_what_the_scales_say():
    drawing = drawn("shaper")["diagrams"]
    run = curves(drawing)[0]
    heights = [place.imag for place in run.places]
    results = moved("shaper")
    assert np.ptp(heights) * scale(drawing, "s") == pytest.approx(results.strokes.travel, rel=1e-6)
    assert abs(run.places[-1].real - run.places[0].real) * scale(drawing, "φ") == pytest.approx(360)


def test_positions_are_numbered_beside_degrees_and_the_strokes_named():
    texts = drawn("shaper")["diagrams"].texts()
    assert {*map(str, range(13)), "30", "360", "working stroke", "return stroke"} <= set(texts)
    assert "a of link 5, m/s²" in texts and "balancing moment, N·m" in texts


def test_strokes_of_a_cycle_of_two_turns_are_counted_and_not_said_to_work_by_turns():
    texts = drawn("four-stroke-engine")["diagrams"].texts()
    assert [text for text in texts if text.startswith("stroke")] == [f"stroke {number}" for number in (1, 2, 3, 4)]


def test_a_stroke_in_which_position_0_lies_has_one_number_at_both_ends():
    engine = load(f"{ROOT}/problems/four-stroke-engine.yaml")
    late = solve(replace(engine, request=replace(engine.request, start=math.radians(90.0))))
    texts = dict(draw_diagrams(late))["diagrams"].texts()
    assert [text for text in texts if text.startswith("stroke")] == [f"stroke {number}" for number in (1, 2, 3, 4, 1)]


def test_the_border_of_the_strokes_stands_where_the_output_turns_back():
    drawing = drawn("shaper")["diagrams"]
    borders = {round(m.places[0].real, 6) for m in drawing.marks if isinstance(m, LineMark) and m.style == "-."}
    run = curves(drawing)[0]
    lowest = min(run.places, key=lambda place: place.imag)
    assert list(borders) == pytest.approx([lowest.real], abs=0.5)


def test_a_load_of_the_working_stroke_leaves_a_gap_in_the_balancing_moment_with_both_values():
    results = shaper(
        (r"  F: .*", "  brake: {on: 1, moment: -120, when: working stroke}"), (r"from: working stroke, ", "")
    )
    drawing = dict(draw_diagrams(results))["diagrams"]
    moment = [line for line in curves(drawing) if line.places[0].imag < 100]
    ends = [place for line in moment for place in (line.places[0], line.places[-1])]
    inner = sorted(ends, key=lambda place: place.real)[1:-1]
    assert len(moment) == 3
    mu = scale(drawing, "M")
    assert [abs(b.imag - a.imag) * mu for a, b in zip(inner[::2], inner[1::2], strict=True)] == pytest.approx(
        [120, 120], abs=0.1
    )
    rings = [m for m in drawing.marks if isinstance(m, CircleMark) and m.face == "white"]
    assert len(rings) == 4 and {"116.6", "123.4"} <= set(drawing.texts())


@pytest.mark.parametrize("stem", ["diagrams", "reactions", "energy", "pressure"])
def test_diagrams_show_the_whole_cycle_of_several_turns(stem):
    drawing = drawn("gear")[stem]
    ends = [(line.places[0], line.places[-1]) for line in curves(drawing)]
    first, last = min(start.real for start, __ in ends), max(end.real for __, end in ends)
    assert (last - first) * scale(drawing, "φ") == pytest.approx(720)
    whole = [(start, end) for start, end in ends if end.real - start.real == last - first]
    assert all(end.imag == pytest.approx(start.imag, abs=1e-6) for start, end in whole)


def test_every_output_and_every_driver_has_its_curve():
    texts = drawn("two cranks")["diagrams-link-3"].texts()
    assert {"angle of link 3, deg", "ω of 3, rad/s", "ε of 3, rad/s²"} <= set(texts)
    assert {"Mb₁", "Mb₄"} <= set(drawn("two cranks")["diagrams"].texts())


def test_no_text_of_a_chart_covers_a_curve():
    for name in ("shaper", "gear", "two cranks"):
        for stem, drawing in drawn(name).items():
            places = np.concatenate([line.places for line in curves(drawing)])
            for text in (mark for mark in drawing.marks if isinstance(mark, TextMark)):
                low, __, high, __ = text_corners(text)
                inside = (places.real > low.real) & (places.real < high.real)
                inside &= (places.imag > low.imag) & (places.imag < high.imag)
                assert not inside.any(), (name, stem, text)


def test_a_panel_of_many_curves_has_a_legend_of_several_rows_above_it():
    sheet = DrawingSheet("title", "caption", paper=LANDSCAPE)
    x = np.linspace(0, 10, 5)
    every = [
        ChartCurve(x, k * x, f"a curve with a long name, number {k}", CURVE_COLOURS[k % len(CURVE_COLOURS)])
        for k in range(9)
    ]
    (panel,) = draw_chart(
        sheet, [PlotContent("value, N", every)], CommonAxis(round_axis(0, 10, *axis_extent(sheet)), "time, s")
    )
    named = [m for m in sheet.marks if isinstance(m, TextMark) and m.text.startswith("a curve")]
    assert len(named) == 9 and len({round(m.at.imag, 3) for m in named}) > 1
    assert all(m.at.imag > panel.y.end and text_corners(m)[1].real < LANDSCAPE[0] for m in named)
    lines = [m for m in sheet.finish().marks if isinstance(m, LineMark)]
    assert sum(m.places[0].imag > panel.y.end and abs(m.places[-1] - m.places[0]) == LEGEND_SAMPLE for m in lines) == 9


def test_panels_that_a_sheet_is_too_low_for_go_to_further_sheets():
    """A radial engine of seven cylinders has 22 reactions; the field of a note is half as high as a page."""
    results = solve(load(DATA / "radial-seven.yaml"))
    with drawing_within(PictureSpace(170, (165, 235), written=False)):
        sheets = dict(draw_diagrams(results))
    named = [sheet.texts() for stem, sheet in sheets.items() if re.fullmatch(r"reactions(-\d)?", stem)]
    entries = [text for texts in named for text in texts if re.fullmatch(r"R.*\(.*\)", text)]
    assert len(entries) == len(set(entries)) == len(results.structure.pairs) == 22
    for stem, sheet in sheets.items():
        low = min(mark.places[0].imag for mark in curves(sheet)), stem
        assert low > (0, "")


def test_a_legend_that_leaves_no_height_for_its_panel_is_cut():
    sheet = DrawingSheet("title", "caption", paper=LANDSCAPE)
    x = np.linspace(0, 10, 5)
    every = [ChartCurve(x, k * x, f"a curve with a long name, number {k}") for k in range(200)]
    over = CommonAxis(round_axis(0, 10, *axis_extent(sheet)), "time, s")
    (panel,) = draw_chart(sheet, [PlotContent("value, N", every)], over)
    assert panel.y.length >= LEAST_PANEL_HEIGHT
    assert 50 < sum(isinstance(m, TextMark) and m.text.startswith("a curve") for m in sheet.marks) < 200


def test_values_that_there_are_not_interrupt_a_curve():
    sheet = DrawingSheet("title", "caption", paper=LANDSCAPE)
    ys = [1, 2, math.nan, 3, 4]
    draw_chart(
        sheet,
        [PlotContent("y", [ChartCurve(np.arange(5.0), ys)])],
        CommonAxis(round_axis(0, 4, *axis_extent(sheet)), "x"),
    )
    drawn_lines = [m for m in sheet.marks if isinstance(m, LineMark) and m.width == pytest.approx(1.3 * POINT)]
    assert [len(line.places) for line in drawn_lines] == [2, 2]


def test_a_jump_without_its_values_written_has_no_line_to_a_text():
    sheet = DrawingSheet("T", "S", paper=LANDSCAPE)
    panel = Panel(sheet, round_axis(0, 1, 40, 100), vertical_axis(0, 1, 40, 100))
    panel.fill(PlotContent("F", [], [CurveJump(0.5, (0.2, 0.8), ("", "0.8"))]))
    assert [label.text for label in sheet.labels] == ["0.8"]


def test_a_reaction_jumps_where_friction_turns_about_within_a_stroke():
    """At 108 deg the rocker of the shaper swings past its upright and link 4 turns back in the hinge D."""

    def jumps(sheet):
        lines = [m.places for m in sheet.marks if isinstance(m, LineMark) and m.style == "-." and len(m.places) == 2]
        (border,) = {round(start.real, 3) for start, end in lines if abs(start.real - end.real) < 1e-6}
        rings = {round(m.centre.real, 1) for m in sheet.marks if isinstance(m, CircleMark) and m.face == "white"}
        return {x for x in rings if x < max(rings) - 2 and abs(x - border) > 2}

    rubbed = shaper((r"\Z", "\nfriction: {coefficient: 0.12, radius: 20 mm}\n"))
    assert not jumps(drawn("shaper")["reactions"])
    assert len(jumps(dict(draw_diagrams(rubbed))["reactions"])) == 1
