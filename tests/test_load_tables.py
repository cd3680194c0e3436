"""A table of a load goes no farther than what it is against: rows beyond the cycle are refused, not cut."""

import blocks
import numpy as np
import pytest
from fuzz import beyond
from test_commands import ROOT, tmm

from tmm_cli import load, solve
from tmm_cli.library import problem_of
from tmm_cli.problem.reader import read_text
from tmm_cli.results.given import given
from tmm_cli.results.warnings import warnings

CRANK_SLIDER = """tmm: 1
units: {{length: mm, angle: deg}}
points: {{O: [0, 0]}}
guides: {{x: {{through: [0, 0]}}}}
links:
  1: {{points: [O, A], length: 50}}
  2: {{points: [A, B], length: 150}}
  3: {{points: [B], slides: {{on: x}}}}
driver: {{link: 1, speed: 60 rpm, turns: cw}}
sketch: {{at: 90, B: [140, 0]}}
loads:
  gas: {{on: 3, force: {{angle: 180, against: {against}, table: {table}}}}}
output: 3
"""


def forces(tmp_path, **given):
    (tmp_path / "x.yaml").write_text(CRANK_SLIDER.format(**given))
    return tmm("forces", "x.yaml", "--json", cwd=tmp_path)


def test_rows_of_a_second_turn_are_refused_with_what_to_do(tmp_path):
    ended = forces(tmp_path, against="crank turn", table="[[0, 0], [180, 5 kN], [540, 2 kN], [720, 0]]")
    assert ended.returncode == 2
    assert ended.stderr.endswith(
        "\nerror: x.yaml:12:87: loads.gas.force.table[2][0]: this row is never reached: all repeats after 1 turn of "
        "the driver\n"
        "  found:   540 deg\n"
        "  allowed: 0 to 360 deg; a longer cycle of loads is told by cycle: 2 turns\n"
    )


@pytest.mark.parametrize("against", ["crank turn", "crank angle"])
def test_rows_below_zero_are_refused(tmp_path, against):
    ended = forces(tmp_path, against=against, table="[[-90, 0], [0, 5 kN]]")
    assert ended.returncode == 2
    assert "loads.gas.force.table[0][0]: this row is never reached" in ended.stderr
    assert "found:   -90" in ended.stderr


@pytest.mark.parametrize("against", ["crank turn", "crank angle"])
def test_a_table_up_to_the_end_of_the_cycle_is_taken(tmp_path, against):
    assert forces(tmp_path, against=against, table="[[0, 0], [90, 5 kN], [360, 0]]").returncode == 0


def test_a_table_against_the_stroke_may_reach_beyond_it(tmp_path):
    assert forces(tmp_path, against="stroke", table="[[0, 0], [500, 5 kN]]").returncode == 0


def test_a_driver_that_slides_has_no_crank_to_tabulate_against(tmp_path):
    table = "force: {angle: 0 deg, against: crank turn, table: [[0, 0], [1, 5]]}"
    (tmp_path / "x.yaml").write_text(blocks.CYLINDER.replace("force: [0, -100]", table))
    ended = tmm("forces", "x.yaml", cwd=tmp_path)
    assert ended.returncode == 2
    assert ended.stderr == (
        "error: x.yaml:12:58: loads.F.force.against: a table is against a crank, or the strokes that it gives: this "
        "driver slides\n"
        "  found:   crank turn\n"
        "  allowed: size: one value\n"
    )


def test_a_table_is_told_in_full_as_it_is_on_a_task_sheet():
    *_, told = given(load(str(ROOT / "problems/toggle-press.yaml")))
    rows = list(zip(*(column.values for column in told.columns), strict=True))
    assert rows == [("0 mm", "0 N"), ("30 mm", "0 N"), ("36 mm", "5000 N"), ("39.5 mm", "40000 N")]
    assert told.title == "press against the stroke" and told.notes == ("Its direction is 90 deg.",)


@pytest.mark.parametrize("against", ["crank angle", "crank turn"])
@pytest.mark.parametrize("turns", ["ccw", "cw"])
@pytest.mark.parametrize(
    "positions", ["{count: 12, from: 30}", "{count: 7, from: 360/7}", "{at: [360, -720, 1e5*360]}"]
)
def test_where_a_table_jumps_from_its_end_to_its_beginning_rounding_does_not_choose_the_side(against, turns, positions):
    table = "[[0, 260 N], [180, 100 N], [360, 0]]"
    text = CRANK_SLIDER.format(against=against, table=table).replace("turns: cw", f"turns: {turns}")
    results = solve(problem_of(read_text(f"{text}positions: {positions}\n", "x.yaml")))
    assert beyond(results) is None
    if against == "crank angle":
        at_zero = np.abs(np.sin(results.motion.q / 2)) < 1e-6
        assert results.reactions.of("B").force[at_zero].real == pytest.approx(260)


@pytest.mark.parametrize(("last", "told"), [(100, 1), (500, 0)])
def test_a_law_of_motion_tells_of_a_table_that_does_not_close(last, told):
    text = CRANK_SLIDER.format(against="crank angle", table=f"[[0, 500], [90, 800], [360, {last}]]")
    text += "masses: {3: {mass: 1}}\ndynamics: {flywheel: {inertia: 9}}\n"
    results = solve(problem_of(read_text(text, "x.yaml")))
    said = [one for one in warnings(results) if "begins with 500 N and ends with 100 N" in one]
    assert len(said) == told
