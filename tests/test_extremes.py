"""Extreme places and largest forces against what a finer grid has, and against strokes."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from test_commands import tmm

from tmm_cli import load, solve
from tmm_cli.drawing.sheets import draw_reaction_hodographs
from tmm_cli.mechanics.analysis import results_at, with_extremes

PROBLEMS = Path(__file__).parents[1] / "problems"


@cache
def found(name, stage):
    results = with_extremes(solve(load(PROBLEMS / f"{name}.yaml"), stage))
    return results, {(one.kind, one.name): one for one in results.extremes}


@pytest.mark.parametrize("name", ["crank-slider", "six-bar", "shaper", "crossed-slots"])
def test_the_largest_reaction_is_the_largest_on_a_fine_grid(name):
    results, told = found(name, "forces")
    fine = results_at(results, results.closely(20001)).reactions
    for reaction in fine.all:
        size, one = np.abs(reaction.force), told.get(("R", reaction.pair.name))
        if one is not None:
            rounding = 1e-12 * np.nanmax(size)
            assert one.low - rounding <= np.nanmin(size) and np.nanmax(size) <= one.high + rounding
            assert one.high == pytest.approx(np.nanmax(size), rel=1e-3)


@pytest.mark.parametrize("name", ["crank-slider", "six-bar", "shaper"])
def test_what_is_told_is_there_where_it_is_told(name):
    results, told = found(name, "forces")
    for place in ("low", "high"):
        ones = [one for one in told.values() if one.kind == "R"]
        there = results_at(results, np.array([getattr(one, f"{place}_at") for one in ones])).reactions
        for k, one in enumerate(ones):
            size = np.abs(there.of(one.name).force[k])
            assert size == pytest.approx(getattr(one, place), abs=1e-9 * one.high)


def test_the_output_goes_as_far_as_its_stroke():
    results, told = found("shaper", "kinematics")
    assert told["s", "x"].high - told["s", "x"].low == pytest.approx(results.strokes.travel, rel=1e-12)


def test_couplers_and_stones_have_extremes_and_a_crank_has_no_angle():
    __, told = found("six-bar", "kinematics")
    assert ("angle", "2") in told and ("angle", "1") not in told
    __, told = found("shaper", "kinematics")
    stone = told["s", "A'"]
    assert (stone.low, stone.high) == pytest.approx((0.24, 0.46))  # m: OC -+ OA
    assert np.degrees([stone.low_at, stone.high_at]) % 360 == pytest.approx([270, 90], abs=1e-3)


def test_extremes_and_hodographs_stand_beside_a_whole_run(tmp_path):
    run = tmm("run", PROBLEMS / "crank-slider.yaml", "--no-drawings", "-o", tmp_path)
    whole = {path.name for path in tmp_path.glob("*/*")}
    shown = tmm("forces", PROBLEMS / "crank-slider.yaml", "--extremes", "-o", tmp_path)
    drawn = tmm("forces", PROBLEMS / "crank-slider.yaml", "--hodographs", "-o", tmp_path)
    assert (run.returncode, shown.returncode, drawn.returncode) == (0, 0, 0)
    assert "R in pair A" in shown.stdout and "extremes.csv" not in whole
    names = {path.name for path in tmp_path.glob("*/*")}
    assert whole <= names  # nothing of it went
    assert {"extremes.csv", "hodograph-A.svg", "reaction-A.svg", "hodograph-x.svg"} <= names


def test_hodographs_stand_in_axes_that_turn_with_each_link_and_in_polar_axes():
    results, __ = found("crank-slider", "forces")
    drawn = dict(draw_reaction_hodographs(results))
    assert {"hodograph-A", "hodograph-A-link-1", "hodograph-A-link-2", "polar-A", "reaction-A"} <= drawn.keys()
    assert "hodograph-x-link-3" not in drawn  # a slider does not turn
