"""Drawings of the law of motion: the energy-mass diagram with its tangents, what goes over the cycle, what jumps."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from bank import drawn as sheets_of, problem, solved
from covering import covered
from formulas import formulas
from models import DATA
from scipy.integrate import cumulative_trapezoid
from test_commands import tmm

from tmm_cli import load, solve
from tmm_cli.drawing.layout import CONTENTS, choose_positions
from tmm_cli.drawing.paper import (
    DARK_COLOUR,
    INERTIA_COLOUR,
    LOAD_COLOUR,
    REACTION_COLOUR,
    CircleMark,
    LineMark,
    TextMark,
)
from tmm_cli.drawing.sheets import draw_law_of_motion, draw_single_run, visible_stretches
from tmm_cli.language import spoken
from tmm_cli.mechanics.dynamics import LinearMotor, RimFlywheel, SteadyTask
from tmm_cli.mechanics.linkage import Load
from tmm_cli.note import html, note
from tmm_cli.note.dynamics import reduced_model as words
from tmm_cli.reports import input_data_tables

THIN = 0.05  # mm: less than half of a line
TASKS = {  # of another way each: found for a constant moment, far from zero inertia, given, none at all, by a motor
    ("shaper", "constant"): SteadyTask(8.6, 1 / 30),
    ("engine-four", "far"): SteadyTask(314.0, 1 / 30),
    ("double-crank", "clockwise"): SteadyTask(7.0, 0.02),
    ("six-bar", "given"): SteadyTask(20.0, flywheel=3.0, size=RimFlywheel(7200.0, 0.2, 0.1)),
    ("engine-four", "none"): SteadyTask(314.0),
    ("shaper", "motor"): SteadyTask(9.0, 0.05, LinearMotor(2000.0, 9.5), ratio=4.0),
}


@cache
def running(name, kind):
    """A problem of the bank with a law of motion."""
    return solve(replace(problem(name), dynamics=TASKS[name, kind]))


@cache
def drawn(name, kind):
    return dict(draw_law_of_motion(running(name, kind)))


def curve(sheet, colour, style="-"):
    """The line of this look that rises most, mm; one with corners rather than a straight one."""
    lines = [m for m in sheet.marks if isinstance(m, LineMark) and m.colour == colour and m.style == style]
    return np.array(max(lines, key=lambda line: (len(line.places) > 2, np.ptp(np.imag(line.places)))).places)


def written(sheet):
    return "\n".join(mark.text for mark in sheet.marks if isinstance(mark, TextMark))


CASES = pytest.mark.parametrize("case", TASKS, ids="-".join)


@CASES
def test_tangents_touch_the_diagram_from_above_and_from_below(case):
    sheet = drawn(*case)["energy-mass"]
    diagram = curve(sheet, DARK_COLOUR)
    for colour, side in ((LOAD_COLOUR, 1), (INERTIA_COLOUR, -1)):
        start, *__, end = curve(sheet, colour, "--")
        above = side * ((start - diagram) * np.conj(1j * (end - start) / abs(end - start))).real
        assert above.min() == pytest.approx(0, abs=THIN)
        point = next(
            m.centre for m in sheet.marks if isinstance(m, CircleMark) and m.edge == colour and m.face == "white"
        )
        assert np.abs(diagram - point).min() < 0.5 + THIN
        assert ((point - start) * np.conj(1j * (end - start) / abs(end - start))).real == pytest.approx(0, abs=THIN)


@CASES
def test_slopes_of_tangents_are_half_of_the_squares_of_the_speeds_at_the_printed_scale(case):
    sheet, steady = drawn(*case)["energy-mass"], running(*case).steady.steady
    energy, inertia = (float(re.search(rf" = (\S+) {unit}/mm", written(sheet))[1]) for unit in ("J", r"\(kg·m²\)"))
    printed = [float(text) for text in re.findall(r" = (\S+)°", written(sheet))]
    for colour, speed, angle in zip((LOAD_COLOUR, INERTIA_COLOUR), reversed(steady.speeds), printed, strict=True):
        start, *__, end = curve(sheet, colour, "--")
        slope = (end - start).imag / (end - start).real
        assert slope * energy / inertia == pytest.approx(speed**2 / 2, rel=1e-9)
        assert math.degrees(math.atan(slope)) == pytest.approx(angle, rel=1e-3)


@CASES
def test_the_segment_between_them_tells_the_flywheel(case):
    sheet, steady = drawn(*case)["energy-mass"], running(*case).steady.steady
    text = written(sheet)
    a, b = (curve(sheet, colour, "--")[0] for colour in (LOAD_COLOUR, INERTIA_COLOUR))
    assert float(re.search(r"ab = (\S+) mm", text)[1]) == pytest.approx(abs(a - b), rel=1e-3, abs=1e-6)
    if not steady.law.flywheel:
        assert "kg·m²" not in text.partition("ab")[2]
        return
    mu = float(re.search(r" = (\S+) \(kg·m²\)/mm", text)[1])
    ways = [np.diff(curve(sheet, colour, "--"))[0] for colour in (LOAD_COLOUR, INERTIA_COLOUR)]
    upper, lower = (way.imag / way.real for way in ways)
    begins = float((re.search(r" − ([\d.e-]+)$", text, re.M) or [0, 0])[1])
    found = abs(a - b) * mu / (upper - lower) - begins
    assert found == pytest.approx(steady.law.flywheel, rel=1e-6)
    assert float(re.search(r" = (\S+) kg·m²$", text, re.M)[1]) == pytest.approx(found, rel=1e-3)


@CASES
def test_all_moments_together_do_no_work_over_the_cycle(case):
    sheet = drawn(*case)["law-moments"]
    work = curve(sheet, INERTIA_COLOUR, "-.")
    assert work[0].imag == pytest.approx(work[-1].imag, abs=THIN)
    assert np.ptp(work.imag) > 1


@CASES
def test_nothing_is_covered_on_these_sheets(case):
    assert not [f"{stem}: {pair}" for stem, sheet in drawn(*case).items() for pair in covered(sheet)]


def test_a_load_that_jumps_is_drawn_as_a_jump():
    shaper = problem("shaper")
    brake = Load("brake", "1", moment=-80.0, when="working stroke")
    loaded = replace(shaper, linkage=replace(shaper.linkage, loads=(*shaper.linkage.loads, brake)), extended=None)
    sheet = dict(draw_law_of_motion(solve(replace(loaded, dynamics=SteadyTask(8.6, 1 / 30)))))["law-moments"]
    steps = [np.diff(line.places) for line in sheet.marks if isinstance(line, LineMark) and len(line.places) > 20]
    steep = [step for every in steps for step in every if abs(step.real) < 0.01 and abs(step.imag) > 1]
    rings = [m for m in sheet.marks if isinstance(m, CircleMark) and m.face == "white"]
    assert not steep and len(rings) > 2


def test_a_file_without_the_block_has_none_of_it():
    assert not [stem for stem in sheets_of("sine") if stem.startswith(("law", "energy-mass"))]
    choice = choose_positions(solved("sine"), all_positions=False)
    assert not [found for source in CONTENTS if source.sheet == 3 for found in source.drawings(choice)]
    assert "Law of motion" not in html(note(solved("sine"), drawn=False)).decode()


@CASES
def test_formulas_of_the_chapter_give_what_they_say(case):
    page = html(note(running(*case), drawn=False)).decode()
    assert "Law of motion" in page
    read = formulas(page)
    assert len(read) > 20 and all(one.true for one in read)


def test_a_single_run_is_drawn_from_its_beginning_to_its_end():
    """The press of the bank, braked: what works and energy leave is nothing, the blow begins with a jump."""
    press = problem("press-single-run")
    results = solve(replace(press, dynamics=replace(press.dynamics, brake=5.0)))
    run = results.single.run
    sheet = dict(draw_single_run(results))["single-run"]
    assert not covered(sheet) and not list(draw_law_of_motion(results))
    energy = curve(sheet, REACTION_COLOUR, ":")
    mu = float(re.search(r" = (\S+) J/mm", written(sheet))[1])
    assert (energy[-1] - energy[0]).imag * mu == pytest.approx(run.kinetic[-1] - run.kinetic[0], abs=mu * THIN)
    page = html(note(results, drawn=False)).decode()
    assert "the brake" in page and all(one.true for one in formulas(page))


def test_letters_of_the_law_of_motion_are_those_of_the_course():
    for language, letters in (("en", "Md Jf ωm"), ("ru", "Mд Jм ωср"), ("sr", "Mp Jz ωsr")):
        with spoken(language):
            assert " ".join(one.plain for one in (words.DRIVING, words.FLYWHEEL, words.MEAN)) == letters
    assert words.FLYWHEEL.primed.letter == "J′"


def test_the_data_of_the_motor_are_told():
    (table,) = (one for one in input_data_tables(problem("shaper-motor")) if one.name == "machine")
    rows = dict(zip(table.columns[0].values, table.columns[1].values, strict=True))
    assert rows["breakdown torque"] == "281.358 N*m"  # 2.2 * 7.35 N m * 17.4
    assert rows["synchronous speed"] == "9.02757 rad/s"  # 1500 rpm / 17.4
    assert rows["slip at breakdown torque"] == "0.1941"  # (1 - 1430/1500) (2.2 + (2.2^2 - 1)^0.5)


@pytest.mark.parametrize(("name", "told"), [("shaper", False), ("shaper-motor", True)])
def test_what_balances_is_told_from_what_drives_where_there_is_a_flywheel(name, told):
    assert ("The flywheel is not counted as a link" in html(note(solved(name), drawn=False)).decode()) == told


def test_a_flywheel_of_links_without_inertia_is_found_on_the_axis_of_energy(tmp_path):
    """With J = 0 the energy-mass diagram is a segment of the axis of energy, as long as the work of all moments varies.

    The triangles have the peaks 2000 and 1500 N*m and each lasts half a turn, so the driving moment is 875 N*m; the
    flywheel is the variation of work divided by delta omega^2.
    """
    results = solve(load(DATA / "two-triangles.yaml"))
    phi = np.radians([0, 80, 180, 260, 360])
    torque = np.array([0.0, 2000, 0, 1500, 0])
    places = np.linspace(0, 2 * np.pi, 720_001)
    work = cumulative_trapezoid(np.interp(places, phi, torque) - 875.0, places, initial=0.0)  # 875 = (2000 + 1500) / 4
    sheet = dict(draw_law_of_motion(results))["energy-mass"]
    ends = [curve(sheet, colour, "--")[0] for colour in (LOAD_COLOUR, INERTIA_COLOUR)]
    mu = float(re.search(r" = (\S+) J/mm", written(sheet))[1])
    assert abs(ends[0] - ends[1]) * mu == pytest.approx(np.ptp(work), rel=1e-6)
    assert (ends[0] - ends[1]).real == 0
    inertia = np.ptp(work) / (0.015 * (100 * np.pi / 30) ** 2)
    assert results.steady.steady.law.flywheel == pytest.approx(inertia, rel=1e-6)
    assert f"{inertia:.4g} kg·m²" in written(sheet)
    for command in ("run", "note", "sheets"):
        assert tmm(command, DATA / "two-triangles.yaml", "-o", tmp_path).returncode == 0


def test_panels_that_paper_does_not_show_apart_are_one_stretch_or_a_jump():
    """Of a way of 2, 0.001 is the finest: four panels of 0.0002 are a jump, six of 0.0005 a stretch."""
    jump, slope = 0.5 + 0.0002 * np.arange(5), 1.5 + 0.0005 * np.arange(7)
    lows, highs = visible_stretches(np.concatenate([[0, 0.25], jump, [1.0], slope, [2.0]]))
    assert lows == pytest.approx([0, 0.25, 0.5008, 1.0, 1.5, 1.503])
    assert highs == pytest.approx([0.25, 0.5, 1.0, 1.5, 1.503, 2.0])
    assert [len(part) for part in visible_stretches(np.linspace(0, 1, 10_001))] == [1, 1]


def test_rows_a_thousandth_of_a_millimetre_apart_are_drawn_as_a_jump(tmp_path):
    """The law of motion has 2 000 panels in that row; each was a jump whose values wanted a place on the sheet."""
    results = solve(load(DATA / "steep-table.yaml"))
    assert len(results.steady.steady.law.energy.edges) > 1000
    sheet = dict(draw_law_of_motion(results))["law-moments"]
    assert max(len(mark.places) for mark in sheet.marks if isinstance(mark, LineMark)) < 2000
    jumps = [mark for mark in sheet.marks if isinstance(mark, CircleMark) and mark.face == "white"]
    assert 0 < len(jumps) < 20
    for command in ("run", "note", "sheets"):
        assert tmm(command, DATA / "steep-table.yaml", "-o", tmp_path).returncode == 0
