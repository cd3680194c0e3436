"""What a file was understood to mean is said before anything is computed, and so is what is probably a slip."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from bank import EVERY, problem
from test_commands import tmm

from tmm_cli import load, solve
from tmm_cli.problem import build_problem, read_text
from tmm_cli.reports import find_slips, summarise_file

SHAPER = Path(__file__).parent.parent / "problems" / "shaper.yaml"
TEXT = SHAPER.read_text(encoding="utf-8")


def told(*changes, say=find_slips):
    """Sentences about the shaper with some of its text changed."""
    text = TEXT
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    return list(say(build_problem(read_text(text, "shaper.yaml"))))


def test_units_driver_sizes_and_gravity_are_said_before_the_tables():
    done = tmm("structure", SHAPER)
    assert done.returncode == 0
    assert done.stderr.splitlines() == [
        ("shaper: units of numbers given without a unit: mm, deg, kg, N, N*m, kg*m^2; of speeds: rad/s or m/s"),
        "shaper: driver: link 1, 8.587 rad/s = 82 rpm, counterclockwise",
        (
            "shaper: lengths: from 110 mm (OA) to 650 mm (CD); masses from 1.5 kg (2) to 52 kg (5); "
            "forces 1500 N (F); gravity 9.81 m/s^2 downwards"
        ),
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
    assert (
        done.stderr.startswith("told: units of numbers given without a unit: ")
        and "told: driver: link 1, " in done.stderr
    )
    assert "units of numbers given without a unit: " not in done.stdout
    assert command == "explain" or json.loads(done.stdout)


def test_a_bank_is_checked_without_it():
    done = tmm("check", SHAPER)
    assert (done.returncode, done.stderr) == (0, "problems: 1, of which with differences: 0\n")


def test_a_driver_is_said_in_turns_and_its_sense():
    assert (
        told(("82 rpm", "70 rad/s"), say=summarise_file)[1] == "driver: link 1, 70 rad/s = 668.5 rpm, counterclockwise"
    )
    assert told(("turns: ccw", "turns: cw"), say=summarise_file)[1] == "driver: link 1, 8.587 rad/s = 82 rpm, clockwise"


def test_a_file_without_slips_has_no_warning():
    assert told() == []


def test_a_bare_speed_beside_degrees_is_warned_of():
    assert told(("82 rpm", "70")) == [
        (
            "the speed of the driver has no unit and is read as 70 rad/s = 668.5 rpm, counterclockwise, "
            "although angles are in deg: write `70 rad/s`, or `70 rpm` for revolutions per minute"
        )
    ]


def test_a_bare_speed_is_plain_where_the_file_says_its_unit():
    assert told(("82 rpm", "70"), ("angle: deg}", "angle: rad}")) == []
    assert told(("82 rpm", "70"), ("angle: deg}", "angle: deg, angular speed: rpm}")) == []


def test_a_speed_that_no_machine_has_is_warned_of():
    assert told(("82 rpm", "1e5 rad/s")) == []
    assert told(("82 rpm", "1e11 rad/s")) == [
        (
            "the speed of the driver, 1e+11 rad/s = 9.549e+11 rpm, counterclockwise, is higher than in real "
            "machines: is the unit correct?"
        )
    ]


def test_sizes_that_no_mechanism_has_are_warned_of():
    assert told(("OA: 110", "OA: 0.11"))[0] == "length OA is 0.11 mm, less than 5 mm: is the unit correct?"
    assert told(("CD: 650", "CD: 65 m")) == ["length CD is 65000 mm, more than 50 m: is the unit correct?"]


def test_an_inertia_too_large_for_its_link_is_warned_of():
    assert told(("inertia: 0.03", "inertia: 30")) == [
        (
            "masses.4: the radius of gyration sqrt(I/m) is 2236.07 mm, larger than the link itself (DE, 210 "
            "mm): is the unit of the moment of inertia correct?"
        )
    ]


def test_a_large_body_whose_mass_is_put_in_its_only_point_is_warned_of():
    assert told((", centre: [60, -20]", "")) == [
        (
            "masses.5: no centre is given, so the mass is placed at E, although its radius of gyration "
            "sqrt(I/m) is 131.559 mm: write centre: [x, y], or centre: E if that is intended"
        )
    ]


def test_a_count_beside_places_is_warned_of_and_stands_in_the_results(tmp_path):
    file = tmp_path / "twice.yaml"
    file.write_text(TEXT.replace("count: 12, from: working stroke, detail: [3]", "count: 12, at: [40]"), "utf-8")
    warning = "positions: `count` has no effect, because `at` lists the positions: remove one of them"
    done = tmm("kinematics", file, "--json")
    assert f"warning: twice: {warning}\n" in done.stderr
    assert json.loads(done.stdout)["warnings"][0] == warning


def test_a_parameter_may_be_set_beside_the_file():
    done = tmm("kinematics", SHAPER, "--set", "OA=120", "--set", "n1 = 2 * 30 rpm", "-p", "0", "--json")
    assert "shaper: values used instead of those in the file: --set OA=120, --set n1 = 2 * 30 rpm\n" in done.stderr
    assert "shaper: driver: link 1, 6.283 rad/s = 60 rpm, counterclockwise\n" in done.stderr
    assert "lengths: from 120 mm (OA)" in done.stderr
    twin = build_problem(read_text(TEXT.replace("OA: 110", "OA: 120").replace("82 rpm", "60 rpm"), "shaper.yaml"))
    (x,) = solve(twin, "kinematics", [0]).motion.named("E").x.real
    assert json.loads(done.stdout)["kinematics"]["points"]["E"]["x"]["x"] == pytest.approx([x], rel=1e-12)


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        ("CB=1", ("parameters.CB: no parameter has this name\n  found:   'CB'\n  allowed: OA, OC, CD, DE, n1")),
        (
            "oa=1",
            (
                "parameters.oa: no parameter has this name\n"
                "  found:   'oa'\n"
                "  allowed: OA, OC, CD, DE, n1\n"
                "  did you mean 'OA'?"
            ),
        ),
        (
            "OA=12 mmm",
            "parameters.OA: unknown unit\n  found:   'mmm'\n  allowed: e.g. mm, deg, rpm, kg, N, N*m\n"
            "  did you mean 'mm'?",
        ),
        (
            "OA=1,5",
            "parameters.OA: decimal comma: write 1.5\n  found:   '1,5'\n"
            "  allowed: a decimal point; a list is written [1, 5]",
        ),
        ("OA", ("expected a name and a value\n  allowed: --set OA=120")),
    ],
)
@pytest.mark.parametrize("command", ["run", "structure", "kinematics", "forces", "explain", "synthesis"])
def test_a_setting_is_refused_as_in_the_file(command, setting, message):
    done = tmm(command, SHAPER, "--set", setting)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == f"error: --set {setting}: {message}\n"


def test_a_parameter_is_set_once():
    done = tmm("structure", SHAPER, "--set", "OA=1", "--set", "OA=2")
    assert done.stderr.startswith("error: --set OA=2: parameters.OA: this parameter is set twice\n")


@pytest.mark.parametrize("command", [(), ("run",), ("explain",), ("bench",), ("bench", "speed"), ("schema",)])
def test_a_short_h_asks_for_help(command):
    done = tmm(*command, "-h")
    assert (done.returncode, done.stdout) == (0, tmm(*command, "--help").stdout)


def test_explain_says_the_structure_in_sentences_for_a_note():
    told = tmm("explain", SHAPER).stdout
    assert told.splitlines()[1:16] == [
        "The mechanism has n = 5 moving links and p1 = 7 lower pairs (revolute: 5, prismatic: 2); by Chebyshev's "
        "formula its mobility is W = 3n − 2 p1 = 3·5 − 2·7 = 1.",
        "With the pairs counted by class, W = 3n − 2 p5 − p4 = 3·5 − 2·7 − 0 = 1.",
        "The generalised formula W = Hn − sum((H − i) p_i) with H = 3 gives 3·5 − 2·7 − 1·0 = 1.",
        "Pairs, with their classes and codes: O 0-1 (5, 1в), C 0-3 (5, 1в), A 1-2 (5, 1в), D 3-4 (5, 1в), E 4-5 "
        "(5, 1в), A' 3-2 (5, 1п), x 0-5 (5, 1п).",
        "Link 1 (crank) is an input link: 8.587 rad/s = 82 rpm, counterclockwise.",
        "The structural formula is I(0,1) → II(2,3) → II(4,5); the mechanism is of class II.",
        (
            "Type of the kinematic chain and of the structure: closed, complex: the driver and several groups, "
            "groups of several types."
        ),
        "Number of independent loops K = p − n: 2.",
        (
            "The mechanism contains these basic mechanisms: slotted-link mechanism 0-1-2-3-0, "
            "crank-slider mechanism 0-3-4-5-0, "
            "six-bar: Watt II."
        ),
        "Motion of the links: 1: rotates about O; 2: plane motion; 3: rotates about C; 4: plane motion; 5: slides "
        "along guide x.",
        ("Group II(2,3) is of class II, order 2 and type RPR (ВПВ, 3); its external pairs are A (link 1), C (frame)."),
        "For group II(2,3), 3n − 2 p1 − p2 = 3·2 − 2·3 = 0.",
        ("Group II(4,5) is of class II, order 2 and type RRP (ВВП, 2); its external pairs are D (link 3), x (frame)."),
        "For group II(4,5), 3n − 2 p1 − p2 = 3·2 − 2·3 = 0.",
        (
            "Positions, velocities and accelerations are determined group by group in this order, reactions in "
            "the reverse order; the balancing moment acts on link 1, which is checked by the Zhukovsky lever."
        ),
    ]


def test_explain_keeps_the_table_of_places_for_those_who_ask():
    table = "What is computed in each stage that is requested"
    assert table not in tmm("explain", SHAPER).stdout
    assert table in tmm("explain", SHAPER, "--verbose").stdout


def test_units_are_said_before_a_search_begins():
    task = load(str(SHAPER.parent / "crank-rocker-optimal.yaml"))
    assert next(iter(summarise_file(task))).startswith("units of numbers given without a unit: mm, deg")
    assert "whole" not in vars(task)  # nothing was looked for


def test_a_bare_speed_of_a_cylinder_is_warned_of_beside_millimetres():
    text = (SHAPER.parent / "cylinder.yaml").read_text(encoding="utf-8")
    text = text.replace("speed: v1", "speed: 40")
    assert list(find_slips(build_problem(read_text(text, "cylinder.yaml")))) == [
        (
            "the speed of the driver has no unit and is read as 40 m/s, although lengths are in mm: write `40 "
            "m/s`, or `40 mm/s` if that is intended"
        )
    ]


@pytest.mark.parametrize("command", [("kinematics", "--set", "Z=2"), ("sweep", "--over", "Z=1..3:2")])
def test_a_value_that_changes_nothing_is_warned_of(command, tmp_path):
    text = SHAPER.read_text(encoding="utf-8").replace("  n1: 82 rpm\n", "  n1: 82 rpm\n  Z: 5\n  Y: 2*Z + OA\n")
    warning = "parameter Z is not used in the file; its value has no effect\n"
    for own, warned in (text, True), (text.replace("[100, 30]", "[Y, 30]"), False):
        (tmp_path / "own.yaml").write_text(own, encoding="utf-8")
        done = tmm(command[0], tmp_path / "own.yaml", *command[1:])
        assert done.returncode == 0 and (warning in done.stderr) == warned


DYNAMICS = """
dynamics:
  mean speed: {mean}
  delta: {delta}
  motor: {{kind: asynchronous, synchronous: {synchronous}, speed: {rated}, moment: 20, ratio: {ratio}}}
"""


def of_law(mean="82 rpm", delta="1/25", synchronous="1500 rpm", rated="1430 rpm", ratio="17.4", file=TEXT):
    """Sentences about the shaper with a motor."""
    law = DYNAMICS.format(mean=mean, delta=delta, synchronous=synchronous, rated=rated, ratio=ratio)
    return list(find_slips(build_problem(read_text(file + law, "shaper.yaml"))))


def test_masses_loads_and_pressures_are_said_before_the_tables():
    grams = told(("mass: 6 kg", "mass: 6 g"), say=summarise_file)[2]
    assert grams == (
        "lengths: from 110 mm (OA) to 650 mm (CD); masses from 0.006 kg (1) to 52 kg (5); forces "
        "1500 N (F); gravity 9.81 m/s^2 downwards"
    )
    loads = "  gas: {on: 5, bore: 50, pressure: {angle: 0, against: share of stroke, table: [[0, 0], [1, 2.5]]}}\n  M: "
    more = told(("loads:\n", f"loads:\n{loads}{{on: 3, moment: 7}}\n"), say=summarise_file)[2]
    assert "; forces from 1500 N (F) to 4908.74 N (gas); moments 7 N*m (M); pressures 2.5 MPa (gas); " in more


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        (
            {"mean": "8.6"},
            "mean speed has no unit and is read as 8.6 rad/s = 82.12 rpm, although angles are in deg: "
            "write `8.6 rad/s`, or `8.6 rpm`",
        ),
        (
            {"synchronous": "1500"},
            "motor.synchronous has no unit and is read as 1500 rad/s = 14324 rpm, although angles "
            "are in deg: write `1500 rad/s`, or `1500 rpm`",
        ),
        (
            {"rated": "143"},
            "motor.speed has no unit and is read as 143 rad/s = 1366 rpm, although angles are in deg: "
            "write `143 rad/s`, or `143 rpm`",
        ),
    ],
)
def test_bare_speeds_of_the_law_of_motion_are_warned_of(changes, key):
    assert of_law(**changes) == [f"dynamics.{key} for revolutions per minute"]
    assert of_law(**changes, file=TEXT.replace("angle: deg}", "angle: deg, angular speed: rad/s}")) == []


def test_a_bare_speed_of_a_linear_motor_and_of_a_run_is_warned_of():
    run = TEXT + "dynamics: {motor: {kind: linear, stall: 900, free: 20}, run: {from: 0, to: 90, speed: 5}}\n"
    (free, start) = find_slips(build_problem(read_text(run, "shaper.yaml")))
    assert free.startswith("dynamics.motor.free has no unit and is read as 20 rad/s = 191 rpm")
    assert start.startswith("dynamics.run.speed has no unit and is read as 5 rad/s = 47.75 rpm")


def test_bare_speeds_of_cylinders_and_of_their_runs_are_warned_of():
    boom = (SHAPER.parent / "boom-lift.yaml").read_text(encoding="utf-8").replace("to: 980,", "to: 980, speed: 40,")
    assert list(find_slips(build_problem(read_text(boom, "boom.yaml")))) == [
        (
            "dynamics.run.speed has no unit and is read as 40 m/s, although lengths are in mm: write `40 m/s`, "
            "or `40 mm/s` if that is intended"
        )
    ]
    digger = (SHAPER.parent / "excavator.yaml").read_text(encoding="utf-8").replace("speed: v2", "speed: 0.03")
    (doubt,) = find_slips(build_problem(read_text(digger, "excavator.yaml")))
    assert doubt == (
        "driver[1].speed has no unit and is read as 0.03 m/s, although lengths are in mm: write `0.03 "
        "m/s`, or `0.03 mm/s` if that is intended"
    )


@pytest.mark.parametrize("linked", [True, False])
def test_a_bare_speed_in_a_task_of_synthesis_is_warned_of(linked, tmp_path):
    text = (SHAPER.parent / "pump-synthesis.yaml").read_text(encoding="utf-8")
    text = text.replace("crank_speed: n1", "crank_speed: 150")
    if not linked:
        text = "tmm: 1\n" + next(line for line in text.splitlines(keepends=True) if line.startswith("synthesis"))
    (tmp_path / "pump.yaml").write_text(text, encoding="utf-8")
    done = tmm("synthesis", tmp_path / "pump.yaml", "--json")
    assert (
        "warning: pump: synthesis.crank_speed has no unit and is read as 150 rad/s = 1432 rpm, although "
        "angles are in deg: write `150 rad/s`, or `150 rpm` for revolutions per minute\n"
    ) in done.stderr


def test_a_mean_speed_beside_another_speed_of_the_driver_is_warned_of():
    assert of_law(mean="82.5 rpm") == []
    assert of_law(mean="82 rad/s") == [
        (
            "dynamics.mean speed is 82 rad/s = 783 rpm, but the speed of the driver is 8.587 rad/s = 82 rpm: "
            "the law of motion uses the mean speed; give only one of them, or equal values"
        )
    ]


def test_a_fluctuation_in_per_cent_twice_over_is_warned_of():
    assert of_law(delta="1/300") == of_law(delta="2.5 %") == []
    assert of_law(delta="0.025 %") == [
        (
            "dynamics.delta is 0.025 % = 1/4000; usual values are 1/5 to 1/300: write `0.025`, or `2.5 %`, if "
            "that is intended"
        )
    ]


def test_pressures_in_bare_pascals_are_warned_of():
    gas = "F: {on: 5, area: 100, pressure: {angle: 0, against: share of stroke, table: [[0, 8e5], [1, 4e5]]}, "
    load = "F: {on: 5, at: [100, 30], force: [1500, 0], "
    assert told((load, gas)) == [
        ("loads.F.pressure is 800000 MPa, more than 1000 MPa: is the unit correct? Write `800000 Pa` for pascals")
    ]
    assert told((load, gas.replace("8e5", "8e5 Pa").replace("4e5", "4 bar"))) == []
    text = (SHAPER.parent / "boom-lift.yaml").read_text(encoding="utf-8").replace("4.6 MPa", "4.6e5")
    (doubt,) = find_slips(build_problem(read_text(text, "boom.yaml")))
    assert doubt.startswith("dynamics.run.drive is 460000 MPa, more than 1000 MPa")


def test_keys_that_are_left_empty_are_no_slip():
    empty = ("at: [100, 30], force", "at: [100, 30], pressure: , force")
    law = "output: 5\ndynamics: {mean speed: , delta: , motor: , run: , flywheel: {inertia: 9}}"
    assert told(empty, ("output: 5", law)) == []
    assert told(empty, say=summarise_file)[2].endswith("forces 1500 N (F); gravity 9.81 m/s^2 downwards")


def test_an_inertia_far_too_small_for_its_link_is_warned_of():
    assert told(("inertia: 1.1", "inertia: 0.01")) == []
    assert told(("inertia: 1.1", "inertia: 1.1e-3")) == [
        (
            "masses.3: the radius of gyration sqrt(I/m) is 7.07107 mm, less than 1/50 of the link (CD, 650 "
            "mm): is the unit of the moment of inertia correct? For a uniform rod I = 0.775 kg*m^2"
        )
    ]


def test_cheeks_and_a_flywheel_are_no_slip_but_wrong_units_are():
    """A flywheel of 1 m and 200 kg on a crank of 110 mm has a radius of gyration of 350 mm."""
    assert told(("mass: 6 kg, inertia: 0.012", "mass: 200 kg, inertia: 25")) == []
    assert told(("inertia: 0.012", "inertia: 12000")) == [
        (
            "masses.1: the radius of gyration sqrt(I/m) is 44721.4 mm, larger than the link itself (OA, 110 "
            "mm): is the unit of the moment of inertia correct?"
        )
    ]


@pytest.mark.parametrize(
    ("old", "new", "key", "distance", "link", "share"),
    [
        ("centre: {on: CD, at: 0.5}", "centre: [24 m, 0]", "masses.3", "23350", "3", "CD"),
        ("at: [100, 30]", "at: [2 m, 0]", "loads.F", "2000", "5", ""),
        (
            "output: 5",
            "springs: {s: {between: [0, 4], at: [O, {on: DE, at: 10}], rate: 1, free: 9}}\noutput: 5",
            "springs.s",
            "1890",
            "4",
            "DE",
        ),
    ],
)
def test_places_farther_than_the_mechanism_is_long_are_warned_of(old, new, key, distance, link, share):
    end = f"; a fraction of the length is written {{on: {share}, at: 50 %}}" if share else ""
    assert told((old, new)) == [
        f"{key}: this point is at least {distance} mm from every point of link {link}, which is more than the size of "
        f"the mechanism (its largest link is CD, 650 mm): is the unit correct? A length without a unit is in mm{end}"
    ]


def test_no_file_of_the_bank_has_a_slip():
    for name in EVERY:
        assert list(find_slips(problem(name).whole)) == [], name


TWICE = """tmm: 1
points: {O: [0, 0]}
guides: {x: {through: [0, 0]}, y: {through: [0, 0]}}
links:
  1: {points: [O, A], length: 50}
  2: {points: [A, B], length: 150}
  3: {points: [B], slides: {on: x}}
  4: {points: [B], slides: {on: y}}
driver: {link: 1, speed: 60 rpm}
sketch: {at: 90, B: [140, 0]}
loads: {F: {on: 4, force: [-100, 0]}}
output: 3
"""
ONE_SLIDER = (
    "links 3 and 4 move as one slider: both contain point B and slide in the same direction on the "
    "frame. Remove one of them"
)


def test_a_slider_that_is_described_by_two_links_is_warned_of():
    for text in (
        TWICE,
        TWICE.replace("{on: y}", "{on: y, turned: 20}"),
        TWICE.replace("y: {through: [0, 0]}", "y: {through: [0, 0], angle: 180}"),
    ):
        assert list(find_slips(build_problem(read_text(text, "x.yaml")))) == [ONE_SLIDER]
    apart = TWICE.replace("4: {points: [B]", "4: {points: [C]").replace("[A, B], length: 150", "{A: 0, B: 0, C: 0}")
    apart = apart.replace("{A: 0, B: 0, C: 0}", "{A: [0, 0], B: [150, 0], C: [75, 40]}")
    assert not list(find_slips(build_problem(read_text(apart, "x.yaml"))))


def test_stones_of_one_hinge_in_slots_that_cross_are_no_slider_described_twice():
    text = TWICE.replace("y: {through: [0, 0]}", "y: {through: [100, 0], angle: 90}")
    assert not list(find_slips(build_problem(read_text(text, "x.yaml"))))
