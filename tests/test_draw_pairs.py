"""Drawings and plans of wheels, racks, cams, cylinders, springs, several drivers and groups of high class."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from higher import PROBLEMS

from tmm_cli import solve
from tmm_cli.drawing.paper import DrawingSheet, LineMark
from tmm_cli.drawing.run import all_sheets
from tmm_cli.drawing.symbols import (
    BARREL_HALF_WIDTH,
    CIRCLE_ANGLES,
    Cylinder,
    MechanismScene,
    contact_point,
    draw_elements,
    higher_pair_outline,
    outline_extent,
)
from tmm_cli.mechanics.forces import Symbol
from tmm_cli.mechanics.numerics import cross, dot
from tmm_cli.mechanics.plans import acceleration_plan, force_plans, lever_plan, plan_letters, velocity_plan
from tmm_cli.problem import build_problem, read_text

WHEELS = ["gear", "inner", "planet", "rack"]
CAMS = ["flat follower", "swinging follower"]


@cache
def solved(name):
    return solve(build_problem(read_text(PROBLEMS[name], f"{name}.yaml")))


@cache
def drawn(name):
    """Every sheet of a problem."""
    return dict(all_sheets(solved(name)))


def scene(results, k):
    return MechanismScene(results.linkage, results.structure, results.motion.poses, k)


def shaped(name, k):
    results = solved(name)
    return higher_pair_outline(scene(results, k), results.linkage.meshes[0])


@pytest.mark.parametrize("name", PROBLEMS)
def test_nothing_lies_outside_of_the_sheets_in_millimetres(name):
    found = drawn(name)
    assert {"structure", "groups", "mechanism", "position", "velocity"} <= {stem.split("-0")[0] for stem in found}
    for stem, figure in found.items():
        width, height = figure.paper
        for line in (mark for mark in figure.marks if isinstance(mark, LineMark)):
            assert all(0 < place.real < width and 0 < place.imag < height for place in line.places), (stem, line)


@pytest.mark.parametrize("name", ["gear", "two cranks", "cylinder"])
def test_every_sheet_is_made(name):
    stems = {stem.split("-0")[0] for stem in drawn(name)}
    assert {"structure", "groups", "mechanism", "diagrams", "reactions", "energy"} <= stems


@pytest.mark.parametrize("name", WHEELS)
@pytest.mark.parametrize("k", [0, 5])
def test_pitch_circles_touch_in_the_pitch_point_on_the_line_of_axes(name, k):
    found = shaped(name, k)
    for disc in found.discs:
        assert abs(found.pitch - disc.centre) == pytest.approx(disc.radius)
        assert dot(found.along, found.pitch - disc.centre) == pytest.approx(0, abs=1e-12)  # a common tangent
    if name == "rack":
        slide = solved(name).linkage.slides[0]
        assert abs(cross(found.along, solved(name).motion.slide(slide).u[k])) < 1e-12  # along the guide
    else:
        one, other = found.discs
        rings = [disc.ring for disc in found.discs]
        inner = name in ("inner", "planet")
        assert abs(one.centre - other.centre) == pytest.approx(
            abs(one.radius - other.radius) if inner else one.radius + other.radius
        )
        assert rings == [False, False] if not inner else sorted(rings) == [False, True]
        assert not inner or (one if one.ring else other).radius == max(one.radius, other.radius)


@pytest.mark.parametrize("name", WHEELS)
def test_both_wheels_have_one_velocity_in_the_pitch_point(name):
    results = solved(name)
    motion, mesh = results.motion, results.linkage.meshes[0]
    pitch = shaped(name, 3).pitch
    speeds = []
    for link in (mesh.i, mesh.j):
        pose = motion.poses[link]
        local = (pitch - pose.x[3]) / pose.z[3]
        speeds.append(motion.point(link, local).v[3])
    assert speeds[0] == pytest.approx(speeds[1])
    assert velocity_plan(motion, 3).ends[mesh.name] == pytest.approx(speeds[0])


@pytest.mark.parametrize("k", range(12))
def test_the_disk_of_a_cam_lies_under_its_flat_follower_and_touches_it_where_the_force_acts(k):
    results, found = solved("flat follower"), shaped("flat follower", k)
    assert found.true
    heights = dot(1j, found.disk - found.axis)  # the follower moves upwards
    face = found.face[0].imag - found.axis.imag
    assert np.max(heights) == pytest.approx(face, abs=2e-5)
    assert face == pytest.approx(results.motion.named("A").x[k].imag)  # at the follower's running point
    assert np.min(np.abs(found.disk - found.touch)) < 1.5e-3  # the disk is a curve of 361 points
    reaction = results.reactions.of("c")
    assert found.touch.real == pytest.approx(reaction.at[k].real, abs=1e-9)
    low, high = sorted(p.real for p in found.face)
    assert low < found.touch.real < high


def test_the_disk_turns_with_its_cam():
    first, later = (shaped("flat follower", k) for k in (0, 3))
    points = np.linspace(0, 360, 13).astype(int)
    for point in (first.disk[points] - first.axis) * 1j:  # a quarter of a turn later
        assert np.min(np.abs(later.disk - later.axis - point)) < 1e-6


@pytest.mark.parametrize("k", range(12))
def test_the_roller_of_a_swinging_follower_rolls_on_the_disk(k):
    results, found = solved("swinging follower"), shaped("swinging follower", k)
    assert not found.true  # only a sign: the file gives the law alone
    centre = found.face[0]
    assert np.min(np.abs(found.disk - centre)) == pytest.approx(found.roller, rel=0.01)
    pivot, end = found.stem
    arm = np.angle((end - pivot) / np.exp(1j * results.motion.link("2").angle[k]))
    first = shaped("swinging follower", 0)
    same = np.angle((first.stem[1] - first.stem[0]) / np.exp(1j * results.motion.link("2").angle[0]))
    assert arm == pytest.approx(same)  # the arm is a part of the follower


def test_a_flat_face_that_no_convex_cam_could_have_is_only_a_sign():
    text = PROBLEMS["flat follower"].replace("offset: 60", "offset: 5")
    text = text.replace("B: [0, 140]", "B: [0, 85]").replace("D: [120, 230]", "D: [120, 175]")
    results = solve(build_problem(read_text(text.replace("C: [40, 230]", "C: [40, 165]"), "x.yaml")))
    found = higher_pair_outline(scene(results, 0), results.linkage.meshes[0])
    assert not found.true
    turns = np.unwrap(np.angle(np.diff(found.disk[::6])))
    assert np.all(np.diff(turns) < 0.05) or np.all(np.diff(turns) > -0.05)  # convex all the same


def test_wheels_far_larger_than_the_mechanism_do_not_decide_its_scale():
    found = shaped("inner", 0)  # radii 60 and 120 mm, axes 60 mm apart
    assert len(outline_extent([found], 1.0)) == 2 * len(CIRCLE_ANGLES)
    large = replace(found, discs=tuple(replace(disc, radius=disc.radius + 0.1) for disc in found.discs))
    assert len(outline_extent([large], 0.0)) == len(CIRCLE_ANGLES) and len(outline_extent([large], 0.08)) == 2 * len(
        CIRCLE_ANGLES
    )


def test_a_group_of_one_wheel_is_drawn_as_large_as_the_wheel():
    results = solved("inner")
    here = scene(results, 2)
    wheel = shaped("inner", 2).discs[0]
    places = np.array(here.extent(["1"]))
    for way in (1, 1j, -1, -1j):
        assert np.abs(places - wheel.centre - wheel.radius * way).min() < 1e-12


@pytest.mark.parametrize("name", [*WHEELS, *CAMS])
def test_a_higher_pair_is_named_where_the_links_touch(name):
    results = solved(name)
    here = scene(results, 2)
    pair = next(p for p in results.structure.pairs if not p.lower)
    assert here.at(pair) == pytest.approx(contact_point(shaped(name, 2)))


def test_a_piston_stays_in_its_cylinder_and_goes_with_its_rod():
    results = solved("cylinder")
    slide = results.linkage.slides[0]
    runs = results.motion.slide(slide).run
    runs_of_piston = []
    sheet = DrawingSheet("t", "c", [0j, 0.5 + 0.3j])
    for k in range(len(runs)):
        here = scene(results, k)
        found, along = Cylinder.of(sheet, here, slide), here.along(slide)
        length, run, end = (dot(along, place - found.back) for place in (found.front, found.piston, found.end))
        assert 0 < run < length - BARREL_HALF_WIDTH / 2
        assert end > length + BARREL_HALF_WIDTH  # the rod comes out of it
        assert all(abs(cross(along, place - found.back)) < 1e-9 for place in (found.front, found.piston, found.end))
        assert found.end == pytest.approx(sheet.on(results.motion.named("A").x[k]))
        runs_of_piston.append(run)
    assert np.all(np.diff(runs_of_piston) > 0)


def test_a_spring_is_drawn_from_end_to_end():
    results = solved("cylinder")
    sheet = DrawingSheet("t", "c", [0j, 0.6 + 0.3j])
    place = scene(results, 4).place
    draw_elements(sheet, scene(results, 4))
    zigzag = max((mark.places for mark in sheet.marks if isinstance(mark, LineMark)), key=len)
    ends = [sheet.on(place("0", 0.52 - 0.12j)), sheet.on(place("3", 0.2 + 0j))]
    assert [zigzag[0], zigzag[-1]] == pytest.approx(ends)
    assert [label.text for label in sheet.labels] == ["s"]


@pytest.mark.parametrize("name", PROBLEMS)
def test_every_force_polygon_closes_with_teeth_springs_friction_and_drivers(name):
    results = solved(name)
    links = []
    for k in np.flatnonzero(results.motion.moving):
        for plan in force_plans(results.reactions, int(k)):
            polygon = [v for v in plan.plan.vectors if v.kind != "inner"]
            longest = max(abs(v.value) for v in polygon)
            for one, after in zip(polygon, [*polygon[1:], polygon[0]], strict=True):
                assert abs(one.end - after.start) <= 1e-9 * longest, plan
            links += plan.links
    assert set(links) == set(results.linkage.moving)


def test_a_driver_between_two_plans_is_in_both_of_them():
    """Piston 2 is driven along crank 1: the cylinder's force stands in the plan of 2 and, reversed, in that of 1."""
    results = solve(build_problem(read_text(TELESCOPE, "telescope.yaml")))
    names = {plan.links: [v.name for v in plan.plan.vectors] for plan in force_plans(results.reactions, 1)}
    assert "Fb₂" in names["2",] and "F′b₂" in names["1",]
    for plan in force_plans(results.reactions, 1):
        last = [v for v in plan.plan.vectors if v.kind != "inner"][-1]
        assert abs(last.end) < 1e-9 * plan.plan.size


TELESCOPE = """tmm: 1
points: {O: [0, 0]}
links:
  1: {points: {O: [0, 0], A: [100, 0]}}
  2: {points: [B], slides: {on: 1, along: OA}}
driver:
  - {link: 1, speed: 30 rpm}
  - {link: 2, on: 1, speed: 0.1 m/s, at: 150}
sketch: {at: 0 deg, B: [150, 0]}
masses: {1: {mass: 2 kg, centre: A}, 2: {mass: 3 kg}}
positions: {at: [0 deg, 30 deg, 60 deg]}
"""


@pytest.mark.parametrize("name", PROBLEMS)
def test_normal_and_tangential_parts_lead_from_end_to_end(name):
    motion = solved(name).motion
    k = int(np.flatnonzero(motion.moving)[1])
    plan = acceleration_plan(motion, k)
    ends = list(plan.ends.values())
    parts = [v for v in plan.vectors if v.kind != "absolute"]
    for first, second in zip(parts[::2], parts[1::2], strict=True):
        assert first.end == second.start
        for end in (first.start, second.end):
            assert min(abs(end - e) for e in ends) < 1e-9 * plan.size, (first.symbol, second.symbol)


def test_under_a_piston_the_parts_start_where_the_cylinder_is_hinged_to_a_moving_link():
    motion = solved("two cylinders").motion
    plan = acceleration_plan(motion, 3)
    normal = next(v for v in plan.vectors if v.symbol == Symbol("a", "D5C", "n"))
    tangential = next(v for v in plan.vectors if v.symbol == Symbol("a", "D5C", "τ"))
    assert normal.start == pytest.approx(plan.ends["c"])
    assert tangential.end == pytest.approx(plan.ends["d5"])
    arm = motion.named("D").x[3] - motion.named("C").x[3]
    assert normal.value == pytest.approx(-(motion.link("5").omega[3] ** 2) * arm)


def test_a_point_p_is_not_the_pole():
    motion = solved("rack").motion
    assert plan_letters(motion.linkage)["P"] == "p′"
    plan = velocity_plan(motion, 2)
    assert plan.ends["p"] == 0 and plan.ends["p′"] == pytest.approx(motion.named("P").v[2])
    lever = lever_plan(motion, solved("rack").reactions, solved("rack").lever, 2)
    assert lever.ends["p"] == 0 and lever.ends["p′"] == pytest.approx(-1j * motion.named("P").first[2])


def test_the_lever_of_several_drivers_says_what_its_sum_is_of():
    figure = drawn("two cranks")["lever-02"]
    told = " ".join(figure.texts()).replace("−", "-")
    balance = {b.driver.link: b.moment[2] for b in solved("two cranks").reactions.balances}
    assert f"Mb₁ = {balance['1']:.6g} N·m" in told and "Mb₁ -2·Mb₄" in told
    assert f"= {balance['1'] - 2 * balance['4']:.6g} N·m" in told


def test_in_a_cycle_of_several_turns_positions_of_one_place_share_a_label():
    told = drawn("gear")["mechanism"].texts()
    assert "4, 16" in told and "4" in told  # the second is the ram's number
