"""The table Checks of a run: what, of what, where, number, limit, ok or warn; in result.json and as CSV too."""

import json
import math

import pytest
from bank import solved
from test_commands import tmm

from tmm_cli.reports import tables

MECHANISM = """tmm: 1
units: {{length: mm, angle: deg}}
points: {{O: [0, 0], C: [0, -350]}}
guides: {{x: {{through: [0, 150]}}}}
links:
  1: {{points: [O, A], length: 150}}
  2: {{points: [A], slides: {{on: 3, along: CD}}}}
  3: {{points: [C, D], length: {cd}}}
  4: {{points: [D, E], length: 200}}
  5: {{points: [E], slides: {{on: x}}}}
driver: {{link: 1, speed: 60 rpm}}
sketch: {{at: 0, D: [200, 140], E: [390, 150]}}
masses: {{5: {{mass: 20 kg}}}}
loads:
  F: {{on: 5, force: [1000, 0]{when}}}
output: 5
positions: {{{positions}}}
{more}
"""


def run(folder, cd=520, when="", positions="count: 12", more=""):
    (folder / "x.yaml").write_text(MECHANISM.format(cd=cd, when=when, positions=positions, more=more))
    ended = tmm("run", "x.yaml", "--no-drawings", cwd=folder)
    assert ended.returncode == 0, ended.stderr
    result = json.loads((folder / "outputs" / "x" / "result.json").read_text())
    return ended.stdout, {(c["check"], c["of"]): c for c in result["checks"]}


def test_the_table_stands_at_the_end_of_a_run_and_in_a_file(tmp_path):
    (tmp_path / "x.yaml").write_text(MECHANISM.format(cd=490, when="", positions="count: 12", more=""))
    ended = tmm("run", "x.yaml", "--no-drawings", cwd=tmp_path)
    assert ended.returncode == 0
    last = ended.stdout[ended.stdout.index("Checks\n" if "Checks\n" in ended.stdout else "Checks ") :]
    rows = [line.split("  ") for line in last.splitlines()]
    assert [
        cell.strip()
        for cell in next(r for r in rows if "position of the sliding block in its slot" in r[0])
        if cell.strip()
    ] == [
        "position of the sliding block in its slot",
        "link 2 in slot CD of link 3",
        "10 mm beyond D",
        "ends of the slot",
        "90 deg",
        "outside the limit",
    ]
    lines = (tmp_path / "outputs" / "x" / "checks.csv").read_text().splitlines()
    assert lines[0] == "check,of,found,limit,driver at,verdict"
    assert "stone in its slot,link 2 in slot CD of link 3,10 mm beyond D,its ends,90 deg,warn" in lines


def test_a_stone_that_stays_says_what_is_left(tmp_path):
    slot = run(tmp_path)[1]["slot", "A'"]
    assert slot["holds"] is True
    assert slot["value"] == pytest.approx(-0.020, rel=1e-9)
    assert slot["at"] == pytest.approx(math.pi / 2, abs=1e-6)


def test_a_load_that_resists_in_one_stroke_and_drives_in_the_other_is_warned_of(tmp_path):
    shown, found = run(tmp_path)
    load = found["load", "F"]
    assert load["holds"] is False
    assert load["value"] == pytest.approx(1000 * 2 * 0.520 * 150 / 350, rel=1e-3)  # F H, H = 2 CD OA/OC
    assert "drives in" in shown


def test_a_load_of_the_working_stroke_is_none_of_these(tmp_path):
    assert ("load", "F") not in run(tmp_path, when=", when: working stroke")[1]


def test_a_load_that_turns_with_its_link_and_only_resists_is_fine(tmp_path):
    (tmp_path / "y.yaml").write_text(
        "tmm: 1\nunits: {length: mm}\npoints: {O: [0, 0], D: [300, 0]}\nlinks:\n  1: {points: [O, A], length: 50}\n"
        "  2: {points: [A, B], length: 250}\n  3: {points: [D, B], length: 200}\n"
        "driver: {link: 1, speed: 60 rpm}\nsketch: {at: 90 deg, B: [230, 190]}\n"
        "loads: {M: {on: 1, moment: -5 N*m}}\noutput: 3\n"
    )
    result = json.loads(tmm("forces", "y.yaml", "--json", cwd=tmp_path).stdout)
    [load] = [c for c in result["checks"] if c["check"] == "load"]
    assert load["holds"] is True


def test_pressure_angles_have_their_limits_there(tmp_path):
    found = run(tmp_path)[1]["pressure", "5"]
    assert (found["holds"], found["limit"]) == (True, pytest.approx(math.radians(30)))
    tight = run(tmp_path, more="checks: {pressure_sliding: 1 deg}")[1]["pressure", "5"]
    assert (tight["holds"], tight["limit"]) == (False, pytest.approx(math.radians(1)))


def test_nearness_to_a_change_point_is_found_between_the_positions(tmp_path):
    """A four-bar whose links are 1 um short of a change point, which is not at one of its positions."""
    (tmp_path / "y.yaml").write_text(
        "tmm: 1\nunits: {length: mm}\npoints: {O: [0, 0], D: [200, 0]}\nlinks:\n  1: {points: [O, A], length: 50}\n"
        "  2: {points: [A, B], length: 180}\n  3: {points: [D, B], length: 70.001}\n"
        "driver: {link: 1, speed: 60 rpm}\nsketch: {at: 90 deg, B: [170, 60]}\npositions: {from: 10 deg}\n"
    )
    result = json.loads(tmm("forces", "y.yaml", "--json", cwd=tmp_path).stdout)
    [near] = [c for c in result["checks"] if c["check"] == "near dead"]
    assert near["holds"] is False
    assert near["value"] < 0.02
    assert math.cos(near["at"]) == pytest.approx(-1, abs=1e-6)


def test_a_place_that_is_zero_but_for_rounding_is_told_as_zero():
    results = solved("planet-on-rocker")
    assert abs(results.pressure[0].place) < 1e-12, "rad"
    table = next(table for table in tables(results) if table.name == "checks")
    places = dict(zip(table.columns[0].values, table.columns[4].values, strict=True))
    assert places["pressure angle"] == "0 deg"
