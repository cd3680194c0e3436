"""Bad input: one clear error, exit code 2, nothing written, no traceback. Messages are exact."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from models import PARALLELOGRAM
from test_commands import ROOT, tmm

from tmm_cli import load, solve
from tmm_cli.problem import ProblemError, build_problem, read_text

SHAPER = (ROOT / "problems" / "shaper.yaml").read_text(encoding="utf-8")
FIVE_BAR = """tmm: 1
points: {O: [0, 0], D: [300, 0]}
links:
  1: {points: [O, A], length: 100}
  2: {points: [A, B], length: 200}
  3: {points: [B, C], length: 200}
  4: {points: [C, D], length: 100}
driver: {link: 1, speed: 1 rad/s}
"""


def refusal(text):
    """The message for a file's text."""
    with pytest.raises(ProblemError) as caught:
        solve(build_problem(read_text(text, "x.yaml")))
    return str(caught.value)


def changed(old, new):
    assert old in SHAPER
    return SHAPER.replace(old, new, 1)


def place(text, part, after=0):
    """line:column of a part of a text."""
    at = text.index(part) + after
    return f"{text.count(chr(10), 0, at) + 1}:{at - text.rfind(chr(10), 0, at)}"


CASES = {
    "unknown key": (
        "length: OA}",
        "lenght: OA}",
        "lenght",
        "links.1.lenght: unknown key\n  found:   'lenght'\n  allowed: name, points, length, also, slides\n"
        "  did you mean 'length'?",
    ),
    "unknown key for one that must be there": (
        "1: {name: crank, points",
        "1: {name: crank, pionts",
        "pionts",
        "links.1.pionts: unknown key\n  found:   'pionts'\n  allowed: name, points, length, also, slides\n"
        "  did you mean 'points'?",
    ),
    "length where an angle is wanted": (
        "{at: 30 deg",
        "{at: 30 mm",
        "30 mm",
        "sketch.at: expected here: an angle\n  found:   '30 mm', a length (30 mm)\n"
        "  allowed: an angle, e.g. 30 deg or 0.5 rad",
    ),
    "missing length": (
        "points: [D, E], length: DE",
        "points: [D, E]",
        "4: {name: rod",
        "links.4.length: the length of this link is missing\n  allowed: length: the distance from D to E",
    ),
    "point named nowhere else": (
        "points: [D, E], length: DE",
        "points: [D, EE], length: DE",
        "EE]",
        (
            "links.4.points[1]: this point is not used anywhere else\n"
            "  found:   'EE'\n"
            "  allowed: a point shared with another link or the frame; give a point that forms no pair under "
            "`also`, with its coordinates\n"
            "  did you mean 'E'?"
        ),
    ),
    "guide that does not exist": (
        "slides: {on: x}",
        "slides: {on: xx}",
        "xx}",
        (
            "links.5.slides.on: there is no guide or link of that name\n"
            "  found:   'xx'\n"
            "  allowed: guides: x; links: 0, 1, 2, 3, 4, 5\n"
            "  did you mean 'x'?"
        ),
    ),
    "negative mass": (
        "mass: 22 kg",
        "mass: -22 kg",
        "-22 kg",
        "masses.3.mass: a mass cannot be negative\n  found:   '-22 kg'\n  allowed: zero or more",
    ),
    "decimal comma": (
        "DE: 210",
        "DE: 21,5",
        "21,5",
        "parameters.DE: decimal comma: write 21.5\n  found:   '21,5'\n"
        "  allowed: a decimal point; a list is written [21, 5]",
    ),
    "not a number": (
        "DE: 210",
        "DE: .nan",
        ".nan",
        ("parameters.DE: the number must be finite\n  found:   '.nan'\n  allowed: a finite number"),
    ),
    "infinity": (
        "DE: 210",
        "DE: .inf",
        ".inf",
        ("parameters.DE: the number must be finite\n  found:   '.inf'\n  allowed: a finite number"),
    ),
    "YAML 1.1: yes is a word": (
        "turns: ccw",
        "turns: yes",
        "yes}",
        ("driver.turns: this value is not allowed here\n  found:   'yes'\n  allowed: ccw, cw"),
    ),
    "sketch that fits no assembly": (
        "E: [0.23*CD + DE, 270]",
        "E: [900, 270]",
        "[900",
        (
            "sketch.E: the sketch does not match any assembly of the mechanism\n"
            "  found:   [900, 270]\n"
            "  allowed: about [358.443, 270] when the driver coordinate is 30 deg"
        ),
    ),
    "sketch that does not decide": (
        ", E: [0.23*CD + DE, 270]",
        "",
        "sketch:",
        (
            "sketch: the sketch does not determine the assembly of group II(4,5); to see all assemblies, run "
            "tmm kinematics x.yaml --assemblies\n"
            "  allowed: add one of these to the sketch for the driver coordinate 30 deg: E: [358.443, 270] or "
            "[-60.7845, 270]; 4: -3.47591 deg or -176.524 deg"
        ),
    ),
    "lengths that do not reach": (
        "DE: 210",
        "DE: 2",
        "30 deg",
        (
            "sketch.at: group II(4,5) cannot be assembled when the driver coordinate is 30 deg\n"
            "  found:   the loop does not close: the gap is 10.7321 mm\n"
            "  allowed: lengths with which the links can be joined, or another driver coordinate"
        ),
    ),
    "driver on the frame": (
        "driver: {link: 1",
        "driver: {link: 0",
        "0, speed",
        "driver.link: there is no link of that name\n  found:   '0'\n  allowed: 1, 2, 3, 4, 5",
    ),
    "position beyond the last": (
        "detail: [3]",
        "detail: [37]",
        "37]",
        ("positions.detail[0]: there is no position with this number\n  found:   37\n  allowed: 0 to 11"),
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_one_error_with_its_place_what_was_found_and_what_is_allowed(case):
    old, new, at, message = CASES[case]
    text = changed(old, new)
    assert refusal(text) == f"x.yaml:{place(text, at)}: {message}"


def test_mobility_above_one_names_the_loose_links():
    assert refusal(FIVE_BAR) == (
        "x.yaml:5:3: links.2: the mobility is not 1: these links are not sufficiently constrained: "
        "2, 3, 4\n"
        "  found:   W = 3*4 - 2*5 = 2\n"
        "  allowed: W = 1, the number of drivers"
    )


def test_a_hinge_that_the_frame_lacks_is_named():
    """O is on the crank alone, or C on the slotted link alone: their places on the frame were forgotten."""
    text = changed("points: {O: [0, 0], C: [0, -OC]}", "points: {C: [0, -OC]}")
    assert refusal(text) == (
        f"x.yaml:{place(text, '1, speed')}: driver.link: link 1 has no suitable pair with link 0\n"
        "  found:   '1'\n  allowed: 3, 5, for a hinge on the frame, write points: {O: [x, y]}"
    )
    text = changed("points: {O: [0, 0], C: [0, -OC]}", "points: {O: [0, 0]}")
    assert refusal(text) == (
        f"x.yaml:{place(text, '2: {name: stone')}: links.2: the mobility is not 1: "
        "these links are not sufficiently constrained: 2, 3, 4, 5\n"
        "  found:   W = 3*5 - 2*6 = 3\n  allowed: W = 1, the number of drivers; "
        "point C belongs only to link 3; for a hinge on the frame write points: {C: [x, y]}"
    )


def test_mobility_below_one_names_the_over_held_links():
    text = changed("5: {name: ram, points: [E]", "5: {name: ram, points: {E: [0, 0], C: [300, 300]}")
    assert refusal(text) == (
        f"x.yaml:{place(text, '5: {name: ram')}: links.5: the mobility is not 1: pair x adds redundant constraints\n"
        "  found:   W = 3*5 - 2*8 = -1; links with redundant constraints: 0, 5\n  allowed: W = 1"
    )


def test_a_truss_cannot_be_driven():
    text = FIVE_BAR.replace("  3: {points: [B, C], length: 200}\n  4: {points: [C, D], length: 100}\n", "")
    text = text.replace("points: [A, B], length: 200", "points: [A, D], length: 200")
    assert refusal(text) == (
        "x.yaml:6:16: driver.link: link 1 cannot be a driver: pairs or other drivers already "
        "determine its motion\n"
        "  found:   W = 3*2 - 2*3 = 0; links with redundant constraints: 0, 1, 2\n"
        "  allowed: W = 1"
    )


def test_a_link_joined_to_nothing():
    text = FIVE_BAR + "masses: {}\n"
    text = text.replace("driver:", "  5: {points: [Q, W], length: 5}\ndriver:")
    assert refusal(text) == (
        "x.yaml:8:3: links.5: this link is not joined to any other link\n"
        "  found:   Q, W\n"
        "  allowed: a point shared with another link or the frame, or `slides`"
    )


@pytest.mark.parametrize(
    "text, message",
    [
        ("", ("x.yaml: the file is empty\n  allowed: keys with values, such as 'tmm: 1'")),
        (SHAPER.replace("  4: {name", "  3: {name"), "links.3: this key occurs twice"),
        (SHAPER.replace("  4: {name", "\t4: {name"), "a tab is used for indentation"),
        ("a: &a [x, x]\nb: [*a, *a]\n", "x.yaml:1:4: a: YAML aliases (* and &) are not allowed in a problem file"),
        ("[" * 100_000, "too many nested levels"),
        ("tmm: 1\nlinks: !!python/object:os.system {}\n", "tag"),
    ],
)
def test_files_that_are_no_problem_files(text, message):
    assert message in refusal(text)


def test_leading_zeros_times_of_day_and_the_key_on_are_what_they_look_like():
    assert build_problem(read_text(changed("DE: 210", "DE: 0210"), "x.yaml")).linkage.links["4"].points["E"] == 0.21
    assert "this is not a valid arithmetic expression" in refusal(changed("DE: 210", "DE: 12:30"))


def test_a_50_mb_file_is_refused_without_being_read(tmp_path):
    file = tmp_path / "big.yaml"
    with file.open("wb") as stream:
        stream.truncate(50_000_000)
    done = tmm("run", file, "-o", tmp_path / "out")
    assert (done.returncode, done.stdout) == (2, "")
    assert (
        done.stderr
        == f"error: {file}: the file is too large\n  found:   50000000 bytes\n  allowed: at most 1000000 bytes\n"
    )


def test_nothing_is_written(tmp_path):
    file = tmp_path / "bad.yaml"
    text = changed("DE: 210", "DE: 2")
    file.write_text(text, encoding="utf-8")
    done = tmm("run", file, "-o", tmp_path / "out")
    assert done.returncode == 2
    assert f"\nerror: {file}:{place(text, '30 deg')}: sketch.at: " in done.stderr
    assert not (tmp_path / "out").exists()
    told = tmm("forces", file, "--json")
    assert told.returncode == 2
    assert '"path": [\n   "sketch",\n   "at"\n  ]' in told.stdout


def test_a_crank_that_cannot_turn_fully_gives_its_range_and_results_there(tmp_path):
    text = PARALLELOGRAM.replace("[A, B], length: 300", "[A, B], length: 120").replace(
        "[D, B], length: 100", "[D, B], length: 150"
    )
    text = text.replace("B: [350, 86]", "B: [170, 70]")
    file = tmp_path / "rocker.yaml"
    file.write_text(text, encoding="utf-8")
    done = tmm("forces", file)
    assert done.returncode == 0
    assert (
        "input link 1 cannot make a full turn: it moves only from -63.14933 deg to 63.14933 deg, "
        "where it reaches a dead position of II(2,3); the results cover only this range"
    ) in done.stderr
    results = solve(load(str(file)))
    assert bool(results.motion.moving.all())  # all twelve positions lie inside the range
    # the limit by the law of cosines: A and D are as far apart as links 2 and 3 reach
    limit = math.acos((100**2 + 300**2 - 270**2) / (2 * 100 * 300))
    assert abs(results.driver_range.end - limit) < 1e-7 and abs(results.driver_range.start + limit) < 1e-7


def test_a_dead_position_inside_the_cycle_is_reported_and_its_neighbours_computed(tmp_path):
    file = tmp_path / "parallelogram.yaml"
    file.write_text(PARALLELOGRAM, encoding="utf-8")
    done = tmm("forces", file)
    assert done.returncode == 0
    assert (
        "position 6 (180 deg): II(2,3) passes a change point smoothly; velocities and accelerations are "
        "limit values, reactions have no limit there"
    ) in done.stderr
    results = solve(load(str(file)))
    assert [k for k in range(12) if not results.motion.moving[k]] == [0, 6]
    assert len(results.dead) == 2


def test_names_cannot_leave_the_output_folder_or_run_in_a_spreadsheet(tmp_path):
    folder = tmp_path / "in"
    folder.mkdir()
    file = folder / "...yaml"
    text = changed("title: Crank shaper, variant 7", "title: '=cmd() $x^2$ <script>'")
    file.write_text(text.replace("name: crank", "name: '=1+1'"), encoding="utf-8")
    out = tmp_path / "out"
    assert tmm("run", file, "-o", out, "--no-drawings").returncode == 0
    assert {p.name for p in tmp_path.iterdir()} == {"in", "out"}
    assert [p.is_dir() for p in out.iterdir()] == [True]
    links = next(out.iterdir()) / "links.csv"
    assert "'=1+1" in links.read_text(encoding="utf-8")
    assert isinstance(folder, Path)
