"""What a file was understood to mean is said before anything is computed, and so is what is probably a slip."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from test_commands import tmm

from tmm_cli import load, solve
from tmm_cli.problem.build import build
from tmm_cli.problem.reader import read_text
from tmm_cli.results.understood import doubts, understood

SHAPER = Path(__file__).parent.parent / "problems" / "shaper.yaml"
TEXT = SHAPER.read_text(encoding="utf-8")


def told(*changes, say=doubts):
    """Sentences about the shaper with some of its text changed."""
    text = TEXT
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    return list(say(build(read_text(text, "shaper.yaml"))))


def test_units_driver_sizes_and_gravity_are_said_before_the_tables():
    done = tmm("structure", SHAPER)
    assert done.returncode == 0
    assert done.stderr.splitlines() == [
        "shaper: bare numbers: mm, deg, kg, N, N*m, kg*m^2; a bare speed: rad/s or m/s",
        "shaper: driver: link 1, 8.587 rad/s = 82 rpm, counterclockwise",
        "shaper: sizes: from 110 mm (OA) to 650 mm (CD); gravity 9.81 m/s^2 downwards",
    ]


@pytest.mark.parametrize("command", ["run", "kinematics", "forces", "explain", "synthesis"])
def test_every_command_says_it_and_keeps_its_results_clean(command, tmp_path):
    text = TEXT.replace("positions: {count: 12, from: working stroke, detail: [3]}", "positions: {at: [40]}")
    if command == "synthesis":
        text = (SHAPER.parent / "pump-synthesis.yaml").read_text(encoding="utf-8")
    file = tmp_path / "told.yaml"
    file.write_text(text, encoding="utf-8")
    more = ("--no-drawings", "-o", tmp_path) if command == "run" else ()
    done = tmm(command, file, *more, *(() if command == "explain" else ("--json",)))
    assert done.stderr.startswith("told: bare numbers: ") and "told: driver: link 1, " in done.stderr
    assert "bare numbers: " not in done.stdout
    assert command == "explain" or json.loads(done.stdout)


def test_a_bank_is_checked_without_it():
    done = tmm("check", SHAPER)
    assert (done.returncode, done.stderr) == (0, "1 problems, 0 differ\n")


def test_a_driver_is_said_in_turns_and_its_sense():
    assert told(("82 rpm", "70 rad/s"), say=understood)[1] == "driver: link 1, 70 rad/s = 668.5 rpm, counterclockwise"
    assert told(("turns: ccw", "turns: cw"), say=understood)[1] == "driver: link 1, 8.587 rad/s = 82 rpm, clockwise"


def test_a_file_without_slips_has_no_warning():
    assert told() == []


def test_a_bare_speed_beside_degrees_is_warned_of():
    assert told(("82 rpm", "70")) == [
        "the driver's speed has no unit and is taken as 70 rad/s = 668.5 rpm, counterclockwise, though angles are in "
        "deg: write `70 rad/s`, or `70 rpm` if turns a minute are meant"
    ]


def test_a_bare_speed_is_plain_where_the_file_says_its_unit():
    assert told(("82 rpm", "70"), ("angle: deg}", "angle: rad}")) == []
    assert told(("82 rpm", "70"), ("angle: deg}", "angle: deg, angular speed: rpm}")) == []


def test_a_speed_that_no_machine_has_is_warned_of():
    assert told(("82 rpm", "1e5 rad/s")) == []
    assert told(("82 rpm", "1e11 rad/s")) == [
        "the driver's speed, 1e+11 rad/s = 9.549e+11 rpm, counterclockwise, is more than machines have: "
        "is the unit right?"
    ]


def test_sizes_that_no_mechanism_has_are_warned_of():
    assert told(("OA: 110", "OA: 0.11"))[0] == "OA is 0.11 mm, less than 5 mm: is the unit right?"
    assert told(("CD: 650", "CD: 65 m")) == ["CD is 65000 mm, more than 50 m: is the unit right?"]


def test_an_inertia_too_large_for_its_link_is_warned_of():
    assert told(("inertia: 0.03", "inertia: 30")) == [
        "masses.4: the radius of gyration sqrt(I/m) is 2236.07 mm, more than the link itself (DE, 210 mm): "
        "are the units of inertia right?"
    ]


def test_a_large_body_whose_mass_is_put_in_its_only_point_is_warned_of():
    assert told((", centre: [60, -20]", "")) == [
        "masses.5: without a centre the mass is put in E, though its radius of gyration sqrt(I/m) is 131.559 mm: "
        "write centre: [x, y], or centre: E if that is meant"
    ]


def test_a_count_beside_places_is_warned_of_and_stands_in_the_results(tmp_path):
    file = tmp_path / "twice.yaml"
    file.write_text(TEXT.replace("count: 12, from: working stroke, detail: [3]", "count: 12, at: [40]"), "utf-8")
    warning = "positions: `count` is not used beside `at`, which gives the places one by one: remove one of them"
    done = tmm("kinematics", file, "--json")
    assert f"warning: twice: {warning}\n" in done.stderr
    assert json.loads(done.stdout)["warnings"][0] == warning


def test_a_parameter_may_be_set_beside_the_file():
    done = tmm("kinematics", SHAPER, "--set", "OA=120", "--set", "n1 = 2 * 30 rpm", "-p", "0", "--json")
    assert "shaper: in place of the file's: --set OA=120, --set n1 = 2 * 30 rpm\n" in done.stderr
    assert "shaper: driver: link 1, 6.283 rad/s = 60 rpm, counterclockwise\n" in done.stderr
    assert "sizes: from 120 mm (OA)" in done.stderr
    twin = build(read_text(TEXT.replace("OA: 110", "OA: 120").replace("82 rpm", "60 rpm"), "shaper.yaml"))
    (x,) = solve(twin, "kinematics", [0]).motion.named("E").x.real
    assert json.loads(done.stdout)["kinematics"]["points"]["E"]["x"]["x"] == pytest.approx([x], rel=1e-12)


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        ("CB=1", "parameters.CB: there is no parameter of that name\n  found:   'CB'\n  allowed: OA, OC, CD, DE, n1"),
        ("oa=1", "parameters.oa: there is no parameter of that name\n  found:   'oa'\n  allowed: OA, OC, CD, DE, n1\n"
         "  did you mean 'OA'?"),
        ("OA=12 mmm", "parameters.OA: unknown unit\n  found:   'mmm'\n  allowed: e.g. mm, deg, rpm, kg, N, N*m\n"
         "  did you mean 'mm'?"),
        ("OA=1,5", "parameters.OA: decimal comma: write 1.5\n  found:   '1,5'\n"
         "  allowed: a decimal point; a list is written [1, 5]"),
        ("OA", "a name and a value are wanted\n  allowed: --set OA=120"),
    ],
)  # fmt: skip
@pytest.mark.parametrize("command", ["run", "structure", "kinematics", "forces", "explain", "synthesis"])
def test_a_setting_is_refused_as_in_the_file(command, setting, message):
    done = tmm(command, SHAPER, "--set", setting)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == f"error: --set {setting}: {message}\n"


def test_a_parameter_is_set_once():
    done = tmm("structure", SHAPER, "--set", "OA=1", "--set", "OA=2")
    assert done.stderr.startswith("error: --set OA=2: parameters.OA: this is set twice\n")


@pytest.mark.parametrize("command", [(), ("run",), ("explain",), ("bench",), ("bench", "speed"), ("schema",)])
def test_a_short_h_asks_for_help(command):
    done = tmm(*command, "-h")
    assert (done.returncode, done.stdout) == (0, tmm(*command, "--help").stdout)


def test_explain_says_the_structure_in_sentences_for_a_note():
    told = tmm("explain", SHAPER).stdout
    assert told.splitlines()[1:7] == [
        "The mechanism has n = 5 moving links and p1 = 7 lower pairs (turning: 5, sliding: 2); by Chebyshev's formula "
        "its mobility is W = 3n − 2 p1 = 3·5 − 2·7 = 1.",
        "Link 1 (crank) is a driving link: 8.587 rad/s = 82 rpm, counterclockwise.",
        "The formula of structure is I(0,1) → II(2,3) → II(4,5); the mechanism is of class II.",
        "The group II(2,3) is of class II, order 2, type RPR; its outer pairs are A (link 1), C (frame).",
        "The group II(4,5) is of class II, order 2, type RRP; its outer pairs are D (link 3), x (frame).",
        "Positions, velocities and accelerations are found group by group in this order, reactions in the opposite "
        "one; the balancing moment acts on link 1, and Zhukovsky's lever checks it.",
    ]


def test_explain_keeps_the_table_of_places_for_those_who_ask():
    table = "What each stage computes, when it is asked for"
    assert table not in tmm("explain", SHAPER).stdout
    assert table in tmm("explain", SHAPER, "--verbose").stdout


def test_units_are_said_before_a_search_begins():
    task = load(str(SHAPER.parent / "crank-rocker-optimal.yaml"))
    assert next(iter(understood(task))).startswith("bare numbers: mm, deg")
    assert "whole" not in vars(task)  # nothing was looked for


def test_a_bare_speed_of_a_cylinder_is_warned_of_beside_millimetres():
    text = (SHAPER.parent / "cylinder.yaml").read_text(encoding="utf-8")
    text = text.replace("speed: v1", "speed: 40")
    assert list(doubts(build(read_text(text, "cylinder.yaml")))) == [
        "the driver's speed has no unit and is taken as 40 m/s, though lengths are in mm: "
        "write `40 m/s`, or `40 mm/s` if that is meant"
    ]


@pytest.mark.parametrize("command", [("kinematics", "--set", "Z=2"), ("sweep", "--over", "Z=1..3:2")])
def test_a_value_that_changes_nothing_is_warned_of(command, tmp_path):
    text = SHAPER.read_text(encoding="utf-8").replace("  n1: 82 rpm\n", "  n1: 82 rpm\n  Z: 5\n  Y: 2*Z + OA\n")
    warning = "parameter Z is used nowhere in the file, and its value changes nothing\n"
    for own, warned in (text, True), (text.replace("[100, 30]", "[Y, 30]"), False):
        (tmp_path / "own.yaml").write_text(own, encoding="utf-8")
        done = tmm(command[0], tmp_path / "own.yaml", *command[1:])
        assert done.returncode == 0 and (warning in done.stderr) == warned
