"""Intermittent motion: wheels that a link takes along on some strokes, against formulas of triangles, and refusals."""

from __future__ import annotations

import json
import math
import subprocess
import sys

import numpy as np
import pytest
from bank import drawn, moved
from models import PROBLEMS, solved_text
from test_commands import tmm

from tmm_cli.problem import ProblemError, build_problem, read_text
from tmm_cli.reports import shown_properties, tables, to_json

SLOTS = (PROBLEMS / "slotted/intermittent.yaml").read_text(encoding="utf-8")
RATCHET = (PROBLEMS / "gear-lever/ratchet-feed.yaml").read_text(encoding="utf-8")
ROCKER = (PROBLEMS / "crank-rocker.yaml").read_text(encoding="utf-8").split("shows:")[0]
CAM = (PROBLEMS / "cam-lever.yaml").read_text(encoding="utf-8").split("shows:")[0]


def wheels(text, block=""):
    """The wheels of a file; block: put at its end."""
    own = f"{text}intermittent: {block}\n" if block else text
    return solved_text(own, "kinematics").wheels


def wheel(text, block=""):
    (one,) = wheels(text, block)
    return one


def refusal(text, block=""):
    with pytest.raises(ProblemError) as caught:
        wheels(text, block)
    return str(caught.value)


# a flange with slots: eccentric e, rod of two equal arms, whose upper end slides on the shaft's axis


def flange(q, z, arm=120.0):
    """Angle of the flange by the stone in its slot, at shaft angles q."""
    e = arm * math.tan(math.pi / (2 * z))
    x, y = 2 * e * np.cos(q), e * np.sin(q) - np.sqrt(arm**2 - (e * np.cos(q)) ** 2)
    return np.arctan2(y, x)


@pytest.mark.parametrize("z", range(3, 9))
def test_a_turn_of_the_shaft_turns_the_flange_by_one_slot(z):
    found = wheel(SLOTS.replace("z: 5", f"z: {z}"))
    driven, stands = found.parts
    assert driven.ride.driven and not stands.ride.driven
    assert abs(found.turn) == pytest.approx(2 * math.pi / z, abs=1e-12)
    assert driven.ride.start == pytest.approx(math.pi / (2 * z), abs=1e-9)
    assert driven.ride.way == pytest.approx(math.pi - math.pi / z, abs=1e-9)
    assert found.standing == pytest.approx((z + 1) / (2 * z), abs=1e-9)
    assert found.cycles == z
    assert found.shock == 0
    q = driven.ride.start + driven.ways
    assert driven.angles == pytest.approx(flange(q, z) - flange(q[0], z), abs=1e-12)
    assert np.all(stands.angles == driven.angles[-1]) and stands.step == 0
    assert found.time(driven=True) + found.time(driven=False) == pytest.approx(1.0, abs=1e-14)  # 60 rpm


def test_its_largest_speed_and_acceleration_are_those_of_the_formula():
    found, rate = wheel(SLOTS), 2 * math.pi
    q, h = np.linspace(found.parts[0].ride.start, found.parts[0].ride.end, 20001), 1e-4
    far = [flange(q + k * h, 5) for k in (-2, -1, 0, 1, 2)]
    omega = rate * (far[0] - 8 * far[1] + 8 * far[3] - far[4]) / (12 * h)
    epsilon = rate**2 * (-far[0] + 16 * far[1] - 30 * far[2] + 16 * far[3] - far[4]) / (12 * h * h)
    assert found.omega == pytest.approx(np.max(np.abs(omega)), rel=1e-8)
    assert found.epsilon == pytest.approx(np.max(np.abs(epsilon)), rel=1e-6)


def test_clockwise_it_goes_the_other_way():
    one, other = wheel(SLOTS), wheel(SLOTS.replace("speed: n1", "speed: n1, turns: cw").replace("backward", "forward"))
    assert other.turn == pytest.approx(-one.turn, abs=1e-12)
    assert other.standing == pytest.approx(0.6, abs=1e-9) and other.shock == 0
    assert other.parts[0].ride.sense == -1


# a ratchet: rod l from the crosshead at (x, h) to the rocker's pin at the radius R


def rocker(x, radius, rod=320.0, h=80.0):
    """Angle of the rocker by the law of cosines."""
    far = math.hypot(x, h)
    return math.atan2(h, x) - math.acos((radius**2 + far**2 - rod**2) / (2 * radius * far))


def test_two_settings_step_by_turns_and_the_shaft_stands_on_both_return_strokes():
    found, ends = moved("gear-lever/ratchet-feed").wheels[0], (-397.6138276043, -241.4402949608)
    steps = [rocker(ends[1], radius) - rocker(ends[0], radius) for radius in (100, 125)]
    assert [part.ride.driven for part in found.parts] == [True, False, True, False]
    assert [part.setting for part in found.parts] == [0, 0, 1, 1]
    assert [part.step for part in found.parts] == pytest.approx([steps[0], 0, steps[1], 0], abs=1e-12)
    assert math.degrees(found.turn) == pytest.approx(-180, abs=1e-9)
    assert (found.standing, found.cycles) == (0.5, 2)
    assert [
        round(1e3 * place, 9) for part in found.parts for place in (part.ride.start, part.ride.end)
    ] == pytest.approx([ends[0], ends[1], ends[1], ends[0]] * 2)
    assert sum(part.time for part in found.parts) == pytest.approx(4 * 0.1561735326435 / 0.2)
    # the crosshead stops at once: so does the shaft
    slopes = [(rocker(x + 1e-3, r) - rocker(x - 1e-3, r)) / 2e-3 * 200 for r in (100, 125) for x in ends]
    assert found.jumps == pytest.approx([slopes[0], -slopes[1], slopes[2], -slopes[3]], rel=1e-6)
    assert found.shock == pytest.approx(-slopes[0], rel=1e-6)


def test_the_other_sense_is_taken_on_the_way_back():
    found = wheel(RATCHET.replace("when: backward, settings: [{}, {R: 125}]", "when: forward").split("shows:")[0])
    stands, driven = found.parts
    assert not stands.ride.driven and driven.ride.driven and driven.ride.sense == -1
    step = rocker(-397.6138276043, 100) - rocker(-241.4402949608, 100)
    assert driven.step == pytest.approx(step, abs=1e-12) and step > 0
    assert driven.omegas[0] > 0


def test_a_link_that_turns_back_within_the_stroke_is_cut_there():
    """The rocker's dead position lies within the crank's stroke: the wheel goes as far on the way there as back."""
    text = ROCKER.replace("turns: ccw}", "stroke: [0, 300]}").replace(
        "positions: {count: 12, from: working stroke,", "positions: {count: 12,"
    )
    found = wheel(text, "{w: {moves_with: 3, when: forward}}")
    assert len(found.driven) == 3 and all(part.step > 0 for part in found.driven)
    q = np.radians(np.linspace(0, 300, 200001))
    a = 100 * np.exp(1j * q)
    span = np.abs(400 - a)
    turned = np.angle(a - 400) - np.arccos((250**2 + span**2 - 350**2) / (2 * 250 * span))
    change = np.diff(np.unwrap(turned))
    assert found.turn == pytest.approx(
        np.sum(np.abs(change)), abs=1e-8
    )  # forward on the way there, backward on that back
    assert found.cycles is None


# cranks that turn fully


def test_on_a_rocker_it_steps_by_the_swing_without_shock():
    one, other = wheels(ROCKER, "{w: {moves_with: 3, when: forward}, v: {moves_with: 3, when: backward}}")
    ends = [math.acos((250**2 + 400**2 - (350 + s * 100) ** 2) / (2 * 250 * 400)) for s in (-1, 1)]
    assert one.turn == pytest.approx(ends[1] - ends[0], abs=1e-12) == -other.turn
    assert one.shock == other.shock == 0
    assert one.standing + other.standing == pytest.approx(1, abs=1e-12)


def test_dwells_of_a_cam_are_standing_too():
    found = wheel(CAM, "{w: {moves_with: 2, when: forward}}")
    assert found.turn == pytest.approx(math.radians(20), abs=1e-12)
    assert found.standing == pytest.approx(250 / 360, abs=1e-7)
    assert [part.ride.driven for part in found.parts] == [True, False]
    assert found.parts[0].ride.start == pytest.approx(math.radians(5), abs=1e-6)
    assert found.cycles == 18


def test_times_are_told_at_constant_speed_alone():
    found = wheel(
        ROCKER.replace("speed: w1", "speed: w1, acceleration: 1 rad/s^2"), "{w: {moves_with: 3, when: forward}}"
    )
    assert math.isnan(found.time(driven=True)) and found.omega > 0
    assert to_json(solved_text(ROCKER, "kinematics")).get("intermittent") is None


# what is shown


def test_properties_read_the_wheels():
    for name in ("slotted/intermittent", "gear-lever/ratchet-feed"):
        assert all(one.met for one in shown_properties(moved(name)))
    steps = [math.degrees(one.value) for one in shown_properties(moved("gear-lever/ratchet-feed"))[:3]]
    assert steps == pytest.approx([102.681135, 77.318865, 180], abs=1e-6)


def test_one_run_tells_tables_course_json_and_a_drawing(tmp_path):
    done = tmm("kinematics", PROBLEMS / "gear-lever/ratchet-feed.yaml", "-o", tmp_path)
    assert done.returncode == 0
    assert "Intermittent motion: values per cycle" in done.stdout and "2: R = 125" in done.stdout
    folder = tmp_path / "ratchet-feed"
    course = (folder / "intermittent-course.csv").read_text(encoding="utf-8").splitlines()
    assert course[0] == 'wheel,"way of the driver, mm","angle, deg","omega, rad/s","epsilon, rad/s^2"'
    (found,) = json.loads((folder / "result.json").read_text(encoding="utf-8"))["intermittent"]
    assert found["settings"] == [{}, {"R": "125"}] and len(found["parts"]) == 4
    assert "intermittent-shaft" in drawn("gear-lever/ratchet-feed")


def test_the_drawing_names_the_parts_and_the_speeds_at_jumps():
    texts = drawn("gear-lever/ratchet-feed")["intermittent-shaft"].texts()
    assert texts.count("wheel driven") == texts.count("wheel at rest") == 2
    assert {"−2.996", "−1.963", "−2.143"} <= set(texts)


def test_tables_come_with_their_notes():
    found = {table.name: table for table in tables(moved("gear-lever/ratchet-feed"))}
    assert any("impact" in note for note in found["intermittent-cycle"].notes)
    assert "reverse instantly" in found["intermittent"].notes[0]
    assert "turn back" not in {t.name: t for t in tables(moved("slotted/intermittent"))}["intermittent"].notes[0]


def test_nothing_of_it_is_imported_for_other_files():
    program = """if True:
        import sys
        from tmm_cli import load, solve
        from tmm_cli.reports.result_json import to_json
        from tmm_cli.reports.register import tables
        results = solve(load("problems/crank-rocker.yaml"))
        to_json(results), tables(results)
        print(*sorted(m for m in sys.modules if m.startswith("tmm_cli.") and "intermittent" in m))
    """
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=PROBLEMS.parent, capture_output=True, text=True, check=True
    )
    assert not done.stdout.strip()


# refusals

CASES = {
    "no such link": (
        "moves_with: 3",
        "moves_with: 7",
        "7",
        "intermittent.shaft.moves_with: there is no moving link of that name\n  found:   '7'\n  allowed: 1, 2, 3",
    ),
    "a link that does not turn on the frame": (
        "moves_with: 3",
        "moves_with: 2",
        "2, when",
        (
            "intermittent.shaft.moves_with: the link that moves the wheel must be hinged to the frame\n"
            "  found:   '2'\n"
            "  allowed: 3"
        ),
    ),
    "another word": (
        "when: backward",
        "when: back",
        "back,",
        (
            "intermittent.shaft.when: this value is not allowed here\n"
            "  found:   'back'\n"
            "  allowed: forward, backward, working stroke, idle stroke\n"
            "  did you mean 'backward'?"
        ),
    ),
    "strokes of an output where the driver goes there and back": (
        "when: backward",
        "when: working stroke",
        "working stroke, settings",
        (
            "intermittent.shaft.when: this mechanism has no working stroke\n"
            "  allowed: forward, backward, or another output link, one that has strokes"
        ),
    ),
    "unknown parameter": (
        "R: 125}]}",
        "RR: 125}]}",
        "RR: 125",
        (
            "intermittent.shaft.settings[1].RR: no parameter has this name\n"
            "  found:   'RR'\n"
            "  allowed: R, l, h, xA, xB, v\n"
            "  did you mean 'R'?"
        ),
    ),
    "a setting that does not fit": (
        "R: 125}]}",
        "R: -125}]}",
        "{R: -125",
        "intermittent.shaft.settings[1]: a length cannot be negative\n  found:   'R'\n  allowed: more than zero",
    ),
    "a setting that is no arithmetic": (
        "R: 125}]}",
        "R: 125 apples}]}",
        "125 apples",
        "intermittent.shaft.settings[1].R: unknown unit\n  found:   'apples'\n  allowed: e.g. mm, deg, rpm, kg, N, N*m",
    ),
    "a setting that cannot be assembled": (
        "R: 125}]}",
        "R: 700}]}",
        "{R: 700",
        (
            "intermittent.shaft.settings[1]: group II(2,3) cannot be assembled when the driver coordinate is "
            "-319.527 mm\n"
            "  found:   the loop does not close: the gap is 50.6103 mm\n"
            "  allowed: lengths with which the links can be joined, or another driver coordinate"
        ),
    ),
    "no cycle": (
        "speed: v, stroke: [xA, xB]",
        "speed: v",
        "shaft: {moves",
        (
            "intermittent.shaft: intermittent motion is computed over a cycle, but this driver has no "
            "cycle\n"
            "  allowed: a crank that rotates fully, or a driver with a stroke that the mechanism can "
            "complete; driver: {stroke: [0, 100]}"
        ),
    ),
    "a name that is taken": (
        "shaft: {moves",
        "3: {moves",
        "3: {moves",
        ("intermittent.3: this name is already in use\n  found:   '3'"),
    ),
}


@pytest.mark.parametrize("old, new, part, message", CASES.values(), ids=CASES)
def test_one_message_at_its_place(old, new, part, message):
    text = RATCHET.replace(old, new, 1)
    assert text != RATCHET
    at = text.index(part, text.index("intermittent:\n"))
    place = f"{text.count(chr(10), 0, at) + 1}:{at - text.rfind(chr(10), 0, at)}"
    assert refusal(text) == f"x.yaml:{place}: {message}"


def test_a_link_that_goes_round_never_lets_go():
    found = refusal(SLOTS.replace("moves_with: 4, when: working stroke", "moves_with: 1, when: forward"))
    assert (
        "this link never reverses its rotation, so the wheel would never come to rest\n"
        "  found:   '1'\n"
        "  allowed: a link that swings (a rocker)"
    ) in found


def test_the_block_is_read_without_its_settings_in_double_doubles():
    problem = build_problem(read_text(RATCHET, "x.yaml"))
    assert problem.wheels[0].settings[1].linkage is not None
    assert problem.extended().wheels == ()
