"""Every mechanism found by a synthesis is judged: pressure and transmission angle, crank rotation, branch and order."""

from __future__ import annotations

import json

import numpy as np
import pytest
from test_commands import ROOT, tmm

from tmm_cli import load, solve

UNITS = "tmm: 1\nunits: {length: mm, angle: deg}\n"
UNUSABLE = (
    "warning: this is no usable mechanism: its smallest transmission angle is 0.3295 deg; with less than 5 deg it does "
    "not move under load"
)


def synthesised(tmp_path, task, *options):
    (tmp_path / "x.yaml").write_text(f"{UNITS}synthesis: {{{task}}}\n")
    done = tmm("synthesis", tmp_path / "x.yaml", *options)
    assert done.returncode == 0
    return done


def test_a_crank_slider_that_nearly_locks_is_shown_with_the_warning_that_it_is_not_usable(tmp_path):
    done = synthesised(tmp_path, "task: crank-slider, stroke: 120, k: 1.9, ratio: 3.5")
    assert UNUSABLE in done.stderr
    assert "at least 60" in done.stdout
    assert "at most 30" in done.stdout


@pytest.mark.parametrize(
    ("task", "warned"),
    [
        ("task: crank-slider, stroke: 120, k: 1.08, ratio: 3.5", ""),
        ("task: crank-slider, stroke: 120, k: 1.2, ratio: 3.5", "usually at most 30 deg is allowed"),
        ("task: crank-slider, stroke: 120, k: 1.2, pressure: 50", ""),  # the task states its limit
        ("task: four-bar-by-k, l3: 100, psi1: 120, psi2: 60, k: 1.4", "usually at most 45 deg is allowed"),
        ("task: shaper, stroke: 300, k: 1.5, OC: 350, DE: 210", ""),
        (
            "task: coupler-positions, positions: [[57.8,0.7,13.2],[92.7,0.8,23.6],[135.1,23.2,43.7],[177.9,49.7,68.5]]",
            "usually at most 45 deg is allowed",
        ),
    ],
)
def test_the_pressure_angle_is_compared_with_the_limits_of_a_run(tmp_path, task, warned):
    quality = json.loads(synthesised(tmp_path, task, "--json").stdout)["quality"]
    assert quality["pressure"] + quality["transmission"] == pytest.approx(np.pi / 2, rel=1e-14)
    done = synthesised(tmp_path, task)
    assert warned in done.stderr
    assert ("warning: " in done.stderr) == bool(warned)
    for row in ("smallest transmission angle", "input link rotates fully", "all positions in one assembly"):
        assert row in done.stdout


def test_the_judged_pressure_angle_is_that_of_the_mechanism():
    results = solve(load("problems/press-synthesis.yaml"))
    (pressure,) = results.pressure
    quality = results.problem.synthesis.outcome.quality
    assert quality.pressure == pytest.approx(pressure.largest, rel=1e-12)
    assert quality.crank == results.driver_range.full


@pytest.mark.parametrize("k", [1.5, 1.6, 1.9])
def test_the_sketch_follows_from_the_geometry_found(tmp_path, k):
    text = (ROOT / "problems/press-synthesis.yaml").read_text().replace("k: 1.08", f"k: {k}")
    (tmp_path / "x.yaml").write_text(text)
    done = tmm("synthesis", tmp_path / "x.yaml")
    assert done.returncode == 0, done.stderr
    assert "the assembly nearest to the sketch was taken" in done.stdout
    results = solve(load(tmp_path / "x.yaml"))
    assert results.strokes.travel == pytest.approx(0.12, rel=1e-12)
    assert results.strokes.k == pytest.approx(k, rel=1e-12)


def test_the_solution_is_shown_before_the_linkage_of_the_file_refuses_it(tmp_path):
    text = (ROOT / "problems/press-synthesis.yaml").read_text().replace("length: AB}", "length: AB - 300}")
    (tmp_path / "x.yaml").write_text(text)
    done = tmm("synthesis", tmp_path / "x.yaml")
    assert done.returncode == 2
    assert "58.80621953" in done.stdout
    assert "smallest transmission angle" in done.stdout
    assert "links.2.length: " in done.stderr


@pytest.mark.parametrize("limit", [20, 40, 60, 85])  # beyond 44 deg the ram would reverse before the lever
def test_the_pressure_angle_of_a_shaper_is_at_most_the_one_given(tmp_path, limit):
    task = f"task: shaper, stroke: 400, k: 3, frame_ratio: 0.3, pressure: {limit} deg"
    done = synthesised(tmp_path, task)
    pressure = np.degrees(json.loads(synthesised(tmp_path, task, "--json").stdout)["quality"]["pressure"])
    assert pressure == pytest.approx(min(limit, 44), rel=1e-12)
    assert ("the rod was taken longer" in done.stdout) == (limit > 44)


def test_the_distance_of_a_pivot_from_a_point_on_its_arc_is_zero(tmp_path):
    task = "task: four-bar-by-k, l3: 100, psi1: 120, psi2: 60, k: 1.2"
    (tmp_path / "level.yaml").write_text(f"{UNITS}synthesis: {{{task}, choose: supports level}}\n")
    found = json.loads(tmm("synthesis", tmp_path / "level.yaml", "--json").stdout)["parameters"]
    near = f"[{1000 * found['xA']!r}, {1000 * found['yA']!r}]"
    rows = json.loads(synthesised(tmp_path, f"{task}, near: {near}", "--json").stdout)["found"]
    (distance,) = (row["value"] for row in rows if row["quantity"] == "distance of A from the required point")
    assert distance == 0
