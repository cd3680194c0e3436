"""How far the driver goes, what stops it, and where strokes end."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
from higher import PROBLEMS
from models import PROBLEMS as FILES, results_of

from tmm_cli import solve
from tmm_cli.mechanics.groups import RISE_LAWS
from tmm_cli.problem import build_problem, read_text
from tmm_cli.reports import tables

UNITS = {"length": "mm", "angle": "deg"}


def test_the_group_that_stops_the_driver_is_named():
    """A parallelogram that could go on to 90 deg carries a lever whose rod ends its way before."""
    results = results_of(
        {
            "tmm": 1,
            "units": UNITS,
            "points": {"O": [0, 0], "P": [0, 120]},
            "links": {
                "1": {"points": ["O", "A"], "length": 400},
                "2": {"points": {"P": [0, 0], "B": [400, 0], "D": [300, 0]}},
                "3": {"points": {"A": [0, 0], "B": [0, 120], "C": [-20, 190]}},
                "4": {"points": ["D", "E"], "length": 100},
                "5": {"points": ["C", "E"], "length": 60},
            },
            "driver": {"link": "1", "speed": 1},
            "sketch": {"at": 0, "B": [400, 120], "C": [380, 190], "D": [300, 120], "E": [320, 200]},
            "positions": {"at": [0]},
        },
        "kinematics",
    )
    assert {limit.group for limit in results.driver_range.limits} == {"II(4,5)"}


def test_a_dwell_at_the_end_of_a_stroke_makes_no_strokes_of_rounding():
    """Where the rod is the radius of curvature of the pin's path, the speed of the ram has a threefold zero."""
    results = results_of(
        {
            "tmm": 1,
            "units": UNITS,
            "points": {"O": [0, 0]},
            "guides": {"y": {"through": "O", "angle": 90}},
            "links": {
                "1": {"points": ["O", "A"], "length": 100},
                "2": {"points": {"A": [0, 0], "P": [0, -40]}},
                "3": {"points": ["P", "D"], "length": 180**2 / 60},
                "4": {"points": ["D"], "slides": {"on": "y"}},
            },
            "gears": {"ring": {"between": ["0", "2"], "carrier": "1", "radii": [150, 50], "inner": True}},
            "driver": {"link": "1", "speed": 1},
            "sketch": {"at": 90, "P": [0, 140], "D": [0, -400]},
        },
        "kinematics",
    )
    assert len(results.strokes.strokes) == 2
    top, bottom = sorted(stroke.start for stroke in results.strokes.strokes)
    assert math.degrees(top) - 90 < 1e-9
    assert abs(math.degrees(bottom) - 270) < 0.2
    assert abs(results.strokes.travel - 0.2) < 1e-15


@pytest.mark.parametrize(
    ("cam", "output", "turns", "start"),
    [
        ("flat follower", "2", "ccw", -50),
        ("flat follower", "4", "cw", 77.3),
        ("swinging follower", "2", "cw", 0),
        ("swinging follower", "4", "ccw", 77.3),
    ],
)
def test_dwells_of_a_cam_are_no_part_of_the_strokes_between_them(cam, output, turns, start):
    """Rise over 120 deg, dwell over 60, return over 100, dwell over 80; whichever way the cam turns the rise is slower.

    Turned the other way the cam has its second dwell after what was the rise.
    """
    text = PROBLEMS[cam].replace("output: 4", f"output: {output}").replace("speed: 60 rpm", f"speed: 1, turns: {turns}")
    text = text.replace("    follower: 2\n", f"    follower: 2\n    start: {start}\n")
    text = text.replace("at: 0 deg", f"at: {start} deg")
    strokes = solve(build_problem(read_text(text, "cam.yaml")), "kinematics").strokes
    assert strokes.k == pytest.approx(1.2, rel=1e-12)
    found = [math.degrees(x) for stroke in strokes.strokes for x in (stroke.length, stroke.rest)]
    assert found == pytest.approx([120, 60, 100, 80] if turns == "ccw" else [120, 80, 100, 60], abs=1e-9)
    assert [stroke.working for stroke in strokes.strokes] == [True, False]
    begins = start if turns == "ccw" else start + 120
    assert math.remainder(strokes.strokes[0].start - math.radians(begins), 2 * math.pi) == pytest.approx(0, abs=1e-12)


def test_a_dwell_within_the_rise_makes_one_stroke_of_it_and_one_at_the_top_is_told_in_the_table():
    law = "[{over: 60, rise: 20, law: linear}, {over: 30}, {over: 50, rise: 20}, {over: 20}, {over: 200, rise: -40}]"
    text = PROBLEMS["flat follower"]
    old = text[text.index("[{over: 120") : text.index("\ndriver")]
    results = solve(build_problem(read_text(text.replace(old, law).replace("output: 4", "output: 2"), "cam.yaml")))
    back, forth = results.strokes.strokes
    assert [math.degrees(x) for x in (back.length, forth.length)] == pytest.approx([200, 140], abs=1e-9)
    assert (back.run, forth.run) == pytest.approx((-0.04, 0.04), abs=1e-15)
    quality = next(table for table in tables(results) if table.name == "quality")
    told = dict(zip(quality.columns[0].values, quality.columns[1].values, strict=True))
    assert told["dwell after the return stroke"] == pytest.approx(20, abs=1e-9)
    assert "dwell after the working stroke" not in told


@pytest.mark.parametrize("dwell", [0, 20])
def test_the_strokes_of_a_cam_of_constant_velocities_end_at_its_hard_impacts(dwell):
    law = f"[{{over: 160, rise: 20, law: linear}}, {{over: {dwell}}}, {{over: {200 - dwell}, rise: -20, law: linear}}]"
    text = PROBLEMS["flat follower"]
    old = text[text.index("[{over: 120") : text.index("\ndriver")]
    text = text.replace(old, law.replace("{over: 0}, ", "")).replace("output: 4", "output: 2")
    back, forth = solve(build_problem(read_text(text, "cam.yaml")), "kinematics").strokes.strokes
    assert [math.degrees(s.length) for s in (back, forth)] == pytest.approx([200 - dwell, 160], abs=1e-9)
    assert math.degrees(forth.rest) == pytest.approx(dwell, abs=1e-9)
    assert (back.run, forth.run) == pytest.approx((-0.02, 0.02), abs=1e-15)


def flat_follower(law, **keys):
    """The cam with a flat follower by another law, the follower alone as output."""
    text = PROBLEMS["flat follower"].replace("output: 4", "output: 2")
    text = text.replace(text[text.index("law: [{over: 120") : text.index("\ndriver")], f"law: {law}")
    for old, new in {"speed": "speed: 60 rpm", "at": "at: 0 deg", "count": "count: 12"}.items():
        text = text.replace(new, keys.get(old, new))
    return solve(build_problem(read_text(text, "cam.yaml")), "kinematics")


@pytest.mark.parametrize("shape", RISE_LAWS)
def test_a_cam_turned_clockwise_moves_its_follower_as_its_mirror_image_does_where_pieces_meet_too(shape):
    """Where the acceleration jumps it is that of the piece which then begins, whichever way the cam turns."""
    own, image = (
        f"{{over: {over}, rise: 20, law: {shape}}}, {{over: 120}}, {{over: {then}, rise: -20, law: {shape}}}"
        for over, then in ((60, 90), (90, 60))
    )
    drawn = flat_follower(f"[{own}, {{over: 90}}]", speed="speed: 1, turns: cw").motion.centre("2")
    other = flat_follower(f"[{{over: 90}}, {image}]", speed="speed: 1").motion.centre("2")
    assert np.max(np.abs(drawn.v - other.v)) < 1e-15 and np.max(np.abs(drawn.a - other.a)) < 1e-13
    rises = 0.02 * abs(RISE_LAWS[shape](0.0)[2]) / math.radians(90) ** 2
    assert abs(other.a[3]) == pytest.approx(rises, rel=1e-12, abs=1e-15)


@pytest.mark.parametrize("start", [0, -359.5, 77.3, 1234.5])
@pytest.mark.parametrize("turns", ["ccw", "cw"])
@pytest.mark.parametrize("shape", ["linear", "parabolic", "cosine"])
def test_a_stroke_of_a_cam_begins_with_the_speed_and_the_acceleration_of_its_piece(shape, turns, start):
    """Both may jump there, and it is not left to rounding on which side of the jump the first position lies."""
    law = f"[{{over: 120, rise: 20, law: {shape}}}, {{over: 120, rise: -20, law: {shape}}}, {{over: 120}}]"
    follower = flat_follower(
        f"{law}\n    start: {start}",
        speed=f"speed: 1, turns: {turns}",
        at=f"at: {start} deg",
        count="count: 12, from: working stroke",
    ).motion.centre("2")
    __, first, second = (abs(float(x)) for x in RISE_LAWS[shape](0.0))
    for n in (0, 4):  # both strokes
        assert abs(follower.v[n]) == pytest.approx(0.02 * first / math.radians(120), abs=1e-14)
        assert abs(follower.a[n]) == pytest.approx(0.02 * second / math.radians(120) ** 2, abs=1e-13)
    assert abs(follower.a[8]) < 1e-13  # the dwell


def test_the_useful_resistance_of_a_working_stroke_does_not_act_in_its_dwell():
    strokes = solve(build_problem(read_text(PROBLEMS["flat follower"], "cam.yaml")), "kinematics").strokes
    assert strokes.share(np.radians([10, 110, 130, 170, 190, 300, 350]), 1).tolist() == [True] * 2 + [False] * 5


def test_a_stroke_over_places_asked_for_on_both_sides_of_a_gap_is_that_of_both_ways():
    text = (FILES / "crank-slider.yaml").read_text(encoding="utf-8").replace("l: 220", "l: 50")
    text = text.replace("at: 60 deg, B: [245, 0]", "at: 20 deg, B: [100, 0]").replace(
        "inertia: 0.006", "inertia: 0.0001"
    )
    text = re.sub(r"^positions: .*$", "positions: {at: [0, 20, 90, 180]}", text, flags=re.M)
    (travel,) = solve(build_problem(read_text(text, "two-ways"))).travels
    assert travel.high == pytest.approx(0.11)  # at 0 deg, 60 + 50 mm
    # dead where the rod is across the guide: to where it is known, in steps of the driver
    assert -math.sqrt(0.06**2 - 0.05**2) <= travel.low < -0.03
