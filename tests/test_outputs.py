"""Any link or point may be an output: a coupler's angle, a stone's place along its slot, a point's x and y."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest
from test_commands import tmm

from tmm_cli import solve
from tmm_cli.mechanics.analysis import motion_at_positions
from tmm_cli.problem import ProblemError, build_problem, read_text

SIX_BAR, SHAPER, EXCAVATOR = (Path(f"problems/{name}.yaml") for name in ("six-bar", "shaper", "excavator"))


def with_outputs(path, *outputs):
    lines = path.read_text(encoding="utf-8").splitlines()
    kept = [line for line in lines if not line.startswith("output:")]
    return "\n".join([*kept, f"output: [{', '.join(outputs)}]"]) + "\n"


def strokes_of(text):
    results = solve(build_problem(read_text(text, "x.yaml")), "kinematics")
    return results, {s.link: s for s in (results.strokes, *results.further) if s is not None}


def ends(strokes):
    """The least and the greatest place of an output, and the driver's places there."""
    return sorted((s.low, s.start) for s in strokes.strokes)


def test_a_stone_goes_along_its_slot_from_the_difference_of_base_and_crank_to_their_sum():
    """OC = 350, OA = 110 mm, the crank turns about O and the lever about C below it."""
    __, found = strokes_of(with_outputs(SHAPER, "2"))
    (low, down), (high, up) = ends(found["2"])
    assert found["2"].kind == "slide"
    assert (low, high) == pytest.approx((0.240, 0.460), abs=1e-15)
    assert np.degrees((down, up)) % 360 == pytest.approx((270, 90), abs=1e-10)


def test_the_end_of_a_crank_goes_over_the_diameter_of_its_circle_both_ways():
    __, found = strokes_of(with_outputs(SHAPER, "A"))
    for axis, turns in (("A.x", (180, 0)), ("A.y", (270, 90))):
        (low, down), (high, up) = ends(found[axis])
        assert (low, high) == pytest.approx((-0.110, 0.110), abs=1e-15)
        off = np.degrees((down, up)) - turns
        assert (off + 180) % 360 - 180 == pytest.approx((0, 0), abs=1e-10)


def test_extremes_of_a_coupler_and_of_its_point_are_where_they_rest_and_nothing_is_beyond_them():
    results, found = strokes_of(with_outputs(SIX_BAR, "2", "K"))
    many = motion_at_positions(results, results.closely(7201))
    K = many.named("K").x
    for name, values in (("2", many.link("2").angle), ("K.x", K.real), ("K.y", K.imag)):
        (low, down), (high, up) = ends(found[name])
        assert low <= np.min(values) <= low + 1e-6 and high - 1e-6 <= np.max(values) <= high
        there = motion_at_positions(results, np.array([down, up]))
        velocity = {"2": there.link("2").first, "K.x": there.named("K").first.real, "K.y": there.named("K").first.imag}
        assert np.max(np.abs(velocity[name])) < 1e-14


def test_with_cylinders_the_extremes_lie_between_the_positions_asked():
    text = with_outputs(Path("problems/cylinder.yaml"), "2", "3")
    results = solve(build_problem(read_text(text, "x.yaml")), "kinematics")
    assert not results.driver_range.full
    for travel in results.travels:
        assert travel.low < travel.high
    assert [travel.link for travel in results.travels] == ["2", "3"]


def test_tables_and_result_json_say_them(tmp_path):
    file = tmp_path / "six.yaml"
    file.write_text(with_outputs(SIX_BAR, "2", "K"), encoding="utf-8")
    ran = tmm("run", file, "--no-drawings", "--digits", "-o", tmp_path / "out")
    assert ran.returncode == 0 and "travel of K.x" in ran.stdout and "swing angle ψ of link 2" in ran.stdout
    folder = next((tmp_path / "out").rglob("result.json")).parent
    written = json.loads((folder / "result.json").read_text(encoding="utf-8"))
    assert [written["output"]["link"], *(s["link"] for s in written["further_outputs"])] == ["2", "K.x", "K.y"]
    with (folder / "cycle.csv").open(encoding="utf-8-sig") as cycle:
        row = next(csv.DictReader(cycle))
    assert float(row["K.x, mm"]) / 1e3 == pytest.approx(written["kinematics"]["points"]["K"]["x"]["x"][0], rel=1e-9)
    assert {"v of K.x, m/s", "a of K.y, m/s^2", "angle of 2, deg"} <= set(row)


def test_of_an_output_that_turns_on_it_is_said_by_how_much():
    told = tmm("kinematics", "problems/double-crank.yaml").stdout
    assert "rotation of link 3 per cycle     360   deg" in told


def test_loads_in_the_working_stroke_of_a_coupler_are_understood():
    text = with_outputs(SIX_BAR, "4")
    results = solve(build_problem(read_text(text, "x.yaml")))
    assert results.strokes.link == "4" and results.start == results.strokes.strokes[0].start


def test_an_output_that_is_not_there_is_refused():
    with pytest.raises(ProblemError) as caught:
        build_problem(read_text(with_outputs(SIX_BAR, "Q"), "x.yaml"))
    assert str(caught.value).endswith(
        "output: there is no link or point of that name\n  found:   'Q'\n  allowed: 1, 2, 3, 4, 5, A, B, K, F"
    )
