"""Mechanisms over parameters: each point is the mechanism of that file, borders are where mechanics has them."""

import csv
import json
import math
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import minimize_scalar
from test_commands import tmm
from test_loads import MACHINE

from tmm_cli.batch import Task
from tmm_cli.drawing.paper import contour_lines, hatch_polygons, region_polygons
from tmm_cli.mechanics.analysis import results_at
from tmm_cli.problem import ProblemError, apply_settings, build_any_problem, read_file, read_text
from tmm_cli.sweep import (
    APART,
    LIMIT,
    REFUSED,
    STOPS,
    WORKS,
    SweptMechanisms,
    read_axes,
    read_shown,
    refuse_points,
    run_sweep,
    sweep_sheets,
)
from tmm_cli.synthesis import measures, solve

ROOT = Path(__file__).parents[1]
PROBLEMS = ROOT / "problems"
TURN = 2 * np.pi


def sweep(file, over, show=()):
    tree = read_file(str(PROBLEMS / f"{file}.yaml"))
    mechanisms = SweptMechanisms(tree, read_axes(Task(tree), over), show)
    return run_sweep(mechanisms)


def one_by_one(file, settings):
    """What a run of the file with other parameters finds."""
    return solve(build_any_problem(apply_settings(read_file(str(PROBLEMS / f"{file}.yaml")), settings)))


def largest(read, results):
    """Over the cycle: about the highest of many places, and on either side of the ends of the strokes."""

    def size(q):
        return np.abs(read(results_at(results, np.atleast_1d(q))))

    ends = [s.start for s in results.strokes.strokes] if results.strokes else []
    beside = [end + away for end in ends for away in (-1e-10, 1e-10)]
    q = np.sort(results.closely(2001))
    values = size(q)
    best = np.clip(np.argmax(values) + np.array([-1, 1]), 0, len(q) - 1)
    found = minimize_scalar(lambda x: -size(x)[0], bounds=tuple(q[best]), method="bounded", options={"xatol": 1e-9})
    return float(max(-found.fun, *values, *size(np.array([q[0], *beside]))))


@pytest.mark.parametrize(
    ("file", "over", "setting", "reaction"),
    [
        ("six-bar", "OA=80..120:5", "OA={:g}", ("BF", "R_34")),
        ("shaper", "n1=60..90:4", "n1={:g} rpm", ("D", "R_34")),
        ("shaper", "CD=600..700:3", "CD={:g}", ("D", "R_34")),
    ],
)
def test_each_point_is_the_mechanism_of_a_file_with_that_parameter(file, over, setting, reaction):
    found = sweep(file, [over], ["H,k,pressure,M_b", reaction[1], "omega_3"])
    assert found.taped
    for point, state, values in zip(found.points, found.state, found.values, strict=True):
        results = one_by_one(file, [setting.format(point[0])])
        force = next(r for r in results.reactions.all if {r.by, r.on} == {"3", "4"})
        alone = [
            measures.output_stroke(results),
            measures.time_ratio(results),
            measures.largest_pressure_angle(results),
            largest(lambda r: r.reactions.balance.moment, results),
            largest(lambda r, pair=force.pair.name: r.reactions.of(pair).force, results),
            largest(lambda r: r.motion.link("3").omega, results),
        ]
        assert values[:3] == pytest.approx(alone[:3], rel=1e-12)
        assert values[3:] == pytest.approx(alone[3:], rel=1e-9)
        assert (state == LIMIT) == any(not one.holds for one in results.pressure)


def test_the_peak_of_a_load_that_jumps_is_its_value_beside_the_jump():
    """Scotch yoke of r = 50 mm, F = 1000 N from 100 to 200 deg: M_b = F r sin(phi) is largest as F begins."""
    text = """tmm: 1
units: {length: mm, angle: deg}
parameters: {F: 1000}
points: {O: [0, 0]}
guides: {x: {through: [0, 0]}}
links:
  1: {points: [O, A], length: 50}
  2: {points: [A], slides: {on: 3, through: B, angle: 90}}
  3: {points: [B], slides: {on: x}}
driver: {link: 1, speed: 1 rad/s, turns: ccw}
gravity: 0
loads: {P: {on: 3, at: B, force: [F, 0], when: [100, 200]}}
positions: {count: 4}
"""
    tree = read_text(text, "x.yaml")
    found = run_sweep(SweptMechanisms(tree, read_axes(Task(tree), ["F=1000..2000:2"]), ["M_b"]))
    peak = 50 * np.sin(np.radians(100))
    assert found.values[:, 0] == pytest.approx([peak, 2 * peak], rel=1e-9)


@pytest.mark.parametrize(("file", "over"), [("press-class-iii", "OA=84..86:2"), ("cylinder", "AB=240..260:2")])
def test_what_no_tape_holds_is_solved_by_the_ordinary_stages(file, over):
    found = sweep(file, [over])
    assert not found.taped and set(found.state) <= {WORKS, LIMIT}
    name = "M_b" if any(one.name == "M_b" for one in found.shown) else "F_b"
    k = next(k for k, one in enumerate(found.shown) if one.name == name)
    results = one_by_one(file, [f"{found.axes[0].name}={found.points[0, 0]:g}"])
    peak = largest(lambda r: r.reactions.balance.generalized, results)
    assert found.values[0, k] == pytest.approx(peak, rel=1e-9)


def test_the_peak_of_the_balancing_moment_is_that_of_the_cycle_and_not_of_the_positions():
    """Crank-slider without masses under F = 1000 N: M_b = F v_B / omega, its peak by the formula of the slider."""
    text = MACHINE.replace("length: 50", "length: r").replace("tmm: 1", "tmm: 1\nparameters: {r: 50}")
    tree = read_text(text + "gravity: 0\nloads: {F: {on: 3, force: [1000, 0]}}\npositions: {count: 5}\n", "x.yaml")
    found = run_sweep(SweptMechanisms(tree, read_axes(Task(tree), ["r=20..80:4"]), ["M_b,v_B,x_B,phi_1,phi_2"]))
    assert found.taped
    omega, rod = 2 * np.pi, 0.15
    for (radius,), values in zip(found.points / 1000, found.values, strict=True):

        def arm(phi, radius=radius):
            beta = np.arcsin(radius * np.sin(phi) / rod)
            return radius * np.sin(phi + beta) / np.cos(beta)

        peak = -minimize_scalar(lambda phi: -arm(phi), (0.5, 1.3, 1.6), method="golden", tol=1e-14).fun
        right = [1000 * peak, omega * peak, 2 * radius, TURN, 2 * np.arcsin(radius / rod)]
        assert values == pytest.approx(right, rel=1e-12)


def test_positions_of_30_deg_miss_the_peak_of_the_shaper():
    tree = read_file(str(PROBLEMS / "shaper.yaml"))
    found = run_sweep(SweptMechanisms(tree, read_axes(Task(tree), ["OC=350..360:2"]), ["M_b"]))
    results = one_by_one("shaper", ["OC=350"])
    assert found.values[0, 0] == pytest.approx(largest(lambda r: r.reactions.balance.moment, results), rel=1e-9)
    assert found.values[0, 0] == pytest.approx(328.9, abs=0.05)
    assert np.max(np.abs(results.reactions.balance.moment)) == pytest.approx(300.9, abs=0.05)


def test_the_crank_of_a_four_bar_stops_to_turn_where_grashof_has_it():
    # l1 + l4 = l2 + l3 beyond the frame of 400 mm: l1 = 350 + 250 - 400; the rocker's limit of 45 deg is met before
    found = sweep("crank-rocker", ["l1=20..320:41"], ["psi"])
    last = found.marks[-1]
    assert (last.before, last.after) == (LIMIT, STOPS)
    assert last.at[0] == pytest.approx(200.0, rel=1e-12)
    # crank along the frame: the transmission angle between links 2 and 3, by the cosine theorem, is 45 deg
    across = math.sqrt(350**2 + 250**2 - 2 * 350 * 250 * math.cos(math.radians(45)))
    assert found.marks[0].at[0] == pytest.approx(400 - across, rel=1e-12)


def test_an_offset_slider_stops_to_turn_and_then_to_assemble():
    # the rod of 190 mm reaches the guide while r + e is shorter; at the sketch (60 deg) while e - r sin 60 deg is
    found = sweep("crank-slider-offset", ["e=0..160:17"], ["H"])
    borders = {mark.after: mark.at[0] for mark in found.marks}
    assert borders[STOPS] == pytest.approx(140.0, rel=1e-12)
    assert found.state[-1] == APART
    assert borders[APART] == pytest.approx(190 - 50 * math.sin(math.radians(60)), rel=1e-12)


def test_numbers_that_no_file_may_have_are_marked_and_no_error():
    found = sweep("crank-rocker", ["l1=-20..20:5"], ["psi"])
    assert found.state.tolist() == [REFUSED, REFUSED, REFUSED, WORKS, WORKS]
    assert found.why[0] == "a length cannot be negative"
    assert np.all(np.isnan(found.values[:3])) and np.all(np.isfinite(found.values[3:]))


def test_over_two_parameters_each_line_is_a_sweep_over_one():
    both = sweep("crank-rocker", ["l1=60..180:3", "l4=300..500:3"], ["psi,k,M_b"])
    assert both.shape == (3, 3)
    for row, l1 in enumerate(both.axes[0].values):
        tree = apply_settings(read_file(str(PROBLEMS / "crank-rocker.yaml")), [f"l1={l1:g}"])
        mechanisms = SweptMechanisms(tree, read_axes(Task(tree), ["l4=300..500:3"]), ["psi,k,M_b"])
        one = run_sweep(mechanisms)
        here = slice(3 * row, 3 * row + 3)
        assert both.state[here].tolist() == one.state.tolist()
        assert np.allclose(both.values[here], one.values, rtol=1e-12, equal_nan=True)
    edges = [mark for mark in both.marks if STOPS in (mark.before, mark.after)]
    assert edges
    for mark in edges:  # of the four lengths the shortest and the longest are as long as the two others
        lengths = sorted([*mark.at, 350.0, 250.0])
        assert lengths[0] + lengths[3] == pytest.approx(lengths[1] + lengths[2], rel=1e-9)


def test_a_double_crank_goes_but_its_output_has_no_swing():
    # the frame of 100 mm is the shortest link, and 100 + 350 < 300 + 250: the crank turns, and so does link 3
    turning = sweep("crank-rocker", ["l4=100..400:2", "l1=100..300:2"], ["psi"])
    (row,) = np.flatnonzero(np.all(turning.points == [100, 300], axis=1))
    assert turning.state[row] in (WORKS, LIMIT) and np.isnan(turning.values[row, 0])
    assert turning.why[row] == "this mechanism has no working stroke"


def test_an_output_that_turns_back_more_often_is_still_told():
    # the toggle of the press passes its straight position twice with a longer crank: four strokes in a turn
    found = sweep("toggle-press", ["OA=35..60:2"], ["H,M_b"])
    strokes = one_by_one("toggle-press", ["OA=60"])
    assert len(strokes.strokes.strokes) == 4
    assert found.values[1, 0] == pytest.approx(strokes.strokes.travel, rel=1e-12)


@pytest.mark.parametrize(
    ("over", "message"),
    [
        (
            ["OB=1..2"],
            ("--over OB=1..2: no parameter has this name\n  found:   'OB'\n  allowed: OA, OC, CD, DE, n1"),
        ),
        (
            ["OA"],
            (
                "--over OA: expected the name of a parameter, two bounds and optionally the number of values\n"
                "  found:   'OA'\n"
                "  allowed: --over OA=80..120:41"
            ),
        ),
        (
            ["OA=90..80"],
            (
                "--over OA=90..80: the first bound must be smaller than the second\n"
                "  found:   'OA=90..80'\n"
                "  allowed: --over OA=80..120:41"
            ),
        ),
        (
            ["OA=80..90:1"],
            (
                "--over OA=80..90:1: the number of values must be a whole number in the allowed range\n"
                "  found:   '1'\n"
                "  allowed: 2 to 1000000"
            ),
        ),
        (
            ["n1=60..80 kg"],
            "--over n1=60..80 kg: expected here: an angular speed\n  found:   'n1=60..80 kg'\n"
            "  allowed: an angular speed, e.g. 82 rpm or 8.6 rad/s",
        ),
        (["OA=8..9", "OA=80..90"], "--over OA=80..90: this parameter is given twice\n  found:   'OA'"),
    ],
)
def test_a_range_that_cannot_be_is_refused(over, message):
    task = Task(read_file(str(PROBLEMS / "shaper.yaml")))
    with pytest.raises(ProblemError) as refused:
        read_axes(task, over)
    assert str(refused.value) == message


def test_a_parameter_that_the_file_computes_of_others_is_swept_by_bare_numbers():
    file = ROOT / "problems" / "shaper.yaml"
    task = Task(apply_settings(read_file(file), ["DE=2*OA - 10"]))
    (axis,) = read_axes(task, ["DE=100..200:3"])
    assert axis.values.tolist() == [100, 150, 200] and (axis.unit, axis.dimension, axis.factor) == ("", None, 1)


def test_the_nearest_quantity_is_proposed():
    task = Task(read_file(str(PROBLEMS / "crank-rocker.yaml")))
    with pytest.raises(ProblemError) as refused:
        read_shown(task, ["psi,presure"])
    assert str(refused.value).splitlines()[:2] == [
        "--show psi,presure: there is no quantity with this name",
        "  found:   'presure'",
    ]
    assert refused.value.near == "pressure"
    assert [one.name for one in read_shown(task, ["v_K, a of K,omega_3"])] == ["v of K", "a of K", "omega of 3"]


def test_more_mechanisms_than_a_minute_has_room_for_are_refused_before_they_start():
    problem = Task(read_file(str(PROBLEMS / "six-bar.yaml"))).problem
    refuse_points(problem, 1_000_000, peaks=False, taped=True, cores=1)
    with pytest.raises(ProblemError, match="too many mechanisms"):
        refuse_points(problem, 1_000_000, peaks=False, taped=False, cores=1)


def test_a_contour_joins_the_places_of_equal_value():
    x, y = np.meshgrid(np.arange(9.0), np.arange(7.0), indexing="ij")
    (line,) = contour_lines(x + 2 * y, 7.5)
    assert np.allclose(line.real + 2 * line.imag, 7.5) and len(line) > 5
    (ring,) = contour_lines((x - 4) ** 2 + (y - 3) ** 2, 4.5)
    assert ring[0] == ring[-1]


def test_hatching_stays_in_its_region_and_goes_on_from_piece_to_piece():
    inside = np.add.outer(np.arange(6), np.arange(6)) >= 5
    pieces = list(region_polygons(inside, lambda one, other: 0.5))
    lines = hatch_polygons(pieces, 0.7)
    assert all(min(a.real + a.imag, b.real + b.imag) >= 4.5 - 1e-9 for a, b in lines)
    area = sum(abs(b - a) for a, b in lines) * 0.7
    assert area == pytest.approx(25 - 4.5**2 / 2, rel=0.08)


def test_the_command_writes_what_it_shows(tmp_path):
    done = tmm(
        "sweep",
        "problems/crank-rocker.yaml",
        "--over",
        "l1=100..220:7",
        "--show",
        "psi,M_b",
        "--set",
        "w1=20 rad/s",
        "-o",
        tmp_path,
    )
    assert done.returncode == 0, done.stderr
    assert "mechanisms to solve: 7, all together" in done.stderr
    folder = tmp_path / "crank-rocker-sweep"
    with (folder / "sweep.csv").open(encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    record = json.loads((folder / "result.json").read_text(encoding="utf-8"))
    assert record["format"] == 1 and record["files"] == ["borders.csv", "sweep.csv", "sweep.png", "sweep.svg"]
    assert (
        [float(row["l1"]) for row in rows] == record["parameters"][0]["values"] == [100, 120, 140, 160, 180, 200, 220]
    )
    assert [row["mechanism"] for row in rows] == ["works"] * 3 + ["limit"] * 2 + ["stops"] * 2
    psi = record["quantities"][0]
    assert (psi["name"], psi["unit"]) == ("psi", "rad")
    assert float(rows[0]["psi, deg"]) == pytest.approx(math.degrees(psi["values"][0]), rel=1e-12)
    assert psi["values"][-1] is None and rows[-1]["psi, deg"] == ""
    results = one_by_one("crank-rocker", ["l1=120", "w1=20 rad/s"])
    assert float(rows[1]["M_b, N*m"]) == pytest.approx(largest(lambda r: r.reactions.balance.moment, results), rel=1e-9)
    assert record["borders"][-1]["at"] == pytest.approx([200.0], rel=1e-12)


def test_a_sheet_a_quantity_over_two_parameters_and_one_for_all_over_one():
    two = sweep("crank-rocker", ["l1=60..240:7", "l4=300..500:5"], ["psi,k"])
    assert [name for name, __ in sweep_sheets("", two, Task(read_file(str(PROBLEMS / "shaper.yaml"))).units)] == [
        "sweep-psi",
        "sweep-k",
    ]
    one = sweep("crank-rocker", ["l1=60..240:7"], ["psi,k"])
    ((name, drawing),) = sweep_sheets("", one, Task(read_file(str(PROBLEMS / "shaper.yaml"))).units)
    assert name == "sweep" and {"feasible", "no full rotation"} <= set(drawing.texts())


def test_a_sweep_shows_the_velocity_that_the_table_of_the_cycle_names_by_its_link():
    tree = read_file(str(PROBLEMS / "shaper.yaml"))
    values = run_sweep(SweptMechanisms(tree, read_axes(Task(tree), ["OC=350..360:2"]), ["v_5,a_5,v_E,a_E"])).values
    assert values[:, :2] == pytest.approx(values[:, 2:], rel=1e-9)


def test_the_headings_of_the_boundaries_of_a_sweep_stay_in_files(tmp_path):
    assert tmm("sweep", PROBLEMS / "shaper.yaml", "--over", "OA=80..120:9", "-o", tmp_path).returncode == 0
    heads = (tmp_path / "shaper-sweep" / "borders.csv").read_text(encoding="utf-8").splitlines()[0]
    assert heads == "OA,before,after,why"
