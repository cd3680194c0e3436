"""A guide along two points of a moving link ends in them: a stone that goes beyond is warned of, unless it is meant."""

import math

import pytest
from test_commands import tmm

from tmm_cli import load, solve

LEVER = """tmm: 1
units: {{length: mm, angle: deg}}
parameters: {{OA: {oa}, OC: 350, CD: {cd}}}
points: {{O: [0, 0], C: [0, -OC]}}
links:
  1: {{points: [O, A], length: OA}}
  2: {{points: [A], slides: {{on: 3, {guide}}}}}
  3: {{points: [C, D], length: CD}}
driver: {{link: 1, speed: 60 rpm}}
sketch: {{at: 30, D: [100, 100]}}
{positions}
"""


def file(folder, cd=490, oa=150, guide="along: CD", positions=""):
    path = folder / "x.yaml"
    path.write_text(LEVER.format(cd=cd, oa=oa, guide=guide, positions=positions))
    return path


def test_a_stone_beyond_the_end_of_its_slot_is_warned_of_with_lengths_and_places(tmp_path):
    ended = tmm("kinematics", file(tmp_path))
    assert ended.returncode == 0
    # OC + OA = 500; CA = CD where sin(phi) = (CD^2 - OA^2 - OC^2)/(2 OA OC)
    start = math.degrees(math.asin((490**2 - 150**2 - 350**2) / (2 * 150 * 350)))
    assert ended.stderr.endswith(
        "warning: link 2 leaves its slot CD in link 3 (length 490 mm): it moves up to 10 mm beyond D "
        "(driver from 64.91966 deg to 115.08034 deg); lengthen the slot, or write `slides: {..., "
        "unbounded: true}` if this is intended\n"
    )
    [excess] = [e for e in solve(load(str(tmp_path / "x.yaml"))).slots if e.ways]
    assert excess.far == pytest.approx(0.010, rel=1e-12)
    assert excess.ways[0] == pytest.approx((math.radians(start), math.pi - math.radians(start)), rel=1e-12)


@pytest.mark.parametrize(("place", "seen"), [(0, "[190, 100]"), (180, "[-190, 100]"), (270, "[0, 140]")])
def test_the_seam_of_the_cycle_does_not_cut_the_way_beyond_in_two(tmp_path, place, seen):
    path = file(tmp_path)
    path.write_text(path.read_text().replace("at: 30, D: [100, 100]", f"at: {place}, D: {seen}"))
    [excess] = [e for e in solve(load(str(path))).slots if e.ways]
    [(start, end)] = excess.ways
    assert math.degrees(end - start) == pytest.approx(115.08034 - 64.91966, abs=1e-5)


def test_between_the_positions_it_is_seen_too(tmp_path):
    """The stone is beyond D only between two of twelve positions."""
    path = file(tmp_path, cd=499.9, positions="positions: {count: 12, from: 15}")
    assert "beyond D" in tmm("kinematics", path).stderr


@pytest.mark.parametrize("guide", ["along: CD, unbounded: true", "through: C, angle: 0"])
def test_a_slot_that_goes_on_is_not_warned_of(tmp_path, guide):
    assert "slot" not in tmm("kinematics", file(tmp_path, guide=guide)).stderr


def test_a_slot_that_reaches_is_not_warned_of(tmp_path):
    assert "slot" not in tmm("kinematics", file(tmp_path, cd=500)).stderr
    assert solve(load(str(tmp_path / "x.yaml"))).slots[1].far == 0
    assert "slot" not in tmm("kinematics", file(tmp_path, cd=501)).stderr


def test_a_stone_on_the_other_side_of_the_first_point_is_beyond_it_everywhere(tmp_path):
    path = file(tmp_path, guide="along: DC", cd=150)
    path.write_text(path.read_text().replace("D: [100, 100]", "D: [-44, -493]"))
    assert "up to 500 mm beyond C (driver in all positions)" in tmm("kinematics", path).stderr


def test_a_driven_cylinder_is_bounded_by_its_stroke_and_not_by_its_drawing():
    for name in ("cylinder", "excavator"):
        assert solve(load(f"problems/{name}.yaml"), "kinematics").slots == ()
