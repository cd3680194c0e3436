"""Linkages of the bank that no reference knows: every number by an independent route, every property from theory."""

from __future__ import annotations

import cmath
import math
from dataclasses import replace

import numpy as np
import pytest
from bank import NAMES, problem, solved
from models import PROBLEMS, file_of
from multibody import compared

from tmm_cli import load, solve
from tmm_cli.mechanics.analysis import results_at, with_driver
from tmm_cli.mechanics.forces import collect_loads, solve_reactions
from tmm_cli.mechanics.groups import DriverMotion
from tmm_cli.mechanics.kinematics import compute_motion
from tmm_cli.mechanics.structure import analyse_structure
from tmm_cli.problem import build_problem, read_text
from tmm_cli.synthesis import redrive

FORMULAS = {
    "positioner": "I(1,2) -> II(1,2,3) -> II(4,5), II(1,2,3) -> II(6,7)",
    "clamp": "I(0,1) -> II(2,3) -> II(4,5), II(2,3) -> II(6,7)",
    "hanger": "I(0,1) -> II(2,3) -> II(4,5)",
    "two-strokes": "I(0,1) -> II(2,3) -> II(4,5)",
    "engine-four": "I(0,1) -> II(2,3), I(0,1) -> II(4,5), I(0,1) -> II(6,7), I(0,1) -> II(8,9)",
    "press-class-iii": "I(0,1) -> III(2,5,6,7) -> II(3,4)",
    "shaking-screen": "I(0,1) -> III(2,3,4,5)",
    "class-iv": "I(0,1) -> IV(2,3,4,5)",
    "cardan-gear": "I(0,1) -> II(2) -> II(4,3)",
    "planetary-dwell-press": "I(0,1) -> II(2) -> II(3,4)",
    "tilter": "I(0,1) -> II(2) -> II(3,4) -> II(5)",
    "gear-doubling": "I(0,1) -> II(2,3) -> II(4) -> II(5,6) -> II(7,8)",
    "gear-straight-line": "I(0,1) -> II(2) -> II(3,4)",
    "summing-lever": "I(0,1) -> II(2) -> III(3,4,5,6)",
    "cam-lever": "I(0,1) -> II(2) -> II(3,4)",
    "valve-drive": "I(0,1) -> II(2) -> II(3,4)",
    "rack-doubling": "I(0,1) -> II(2,3) -> II(4) -> II(5)",
    "five-bar": "I(0,1) + I(0,4) -> II(2,3)",
    "excavator": "I(2,3) -> II(1,2,3), I(5,6) + II(1,2,3) -> II(4,5,6), I(8,9) + II(4,5,6) -> II(7,8,9)",
    "loader": "I(4,5) -> III(1,2,3,4,5)",
}
SHARES = (0.07, 0.31, 0.58, 0.86)  # of the driver's way: off the round places of the file


@pytest.fixture(params=[name for name in NAMES if name in FORMULAS])
def results(request):
    return solved(request.param)


def along(results, shares=SHARES):
    """The same results at places over the whole of what the file asks for."""
    way = results.closely(101)
    return results_at(results, way[0] + (way[-1] - way[0]) * np.array(shares))


def turned(results, link):
    return np.unwrap(results.motion.link(link).angle)


def by_cosines(a, b, opposite):
    """The angle between two sides of a triangle, deg."""
    return math.degrees(math.acos((a * a + b * b - opposite * opposite) / (2 * a * b)))


# every linkage, by independent routes


@pytest.mark.parametrize("name", FORMULAS)
def test_formula_of_structure(name):
    structure = analyse_structure(problem(name).linkage)
    assert structure.formula == FORMULAS[name]
    assert structure.mobility == len(structure.drivers)


def test_everything_agrees_with_lagrange_multipliers(results):
    there = along(results, SHARES[1:2])
    assert np.all(there.motion.moving)
    worst = compared(there.linkage, there.structure, there.motion, there.reactions, range(1), results.strokes)
    assert max(worst.values()) < 1e-12, worst


def test_powers_balance_and_the_lever_agrees_with_the_force_plan(results):
    assert np.all(results.motion.moving)
    assert np.max(np.abs(results.energy.balance)) < 1e-12
    assert np.max(results.lever.difference) < 1e-12


def test_backwards_in_time_velocities_turn_round_and_forces_stay(results):
    springs = tuple(replace(spring, damping=0.0) for spring in results.linkage.elements)
    it = replace(results.linkage, elements=springs)
    motion = replace(results.motion, linkage=it)
    back = replace(
        it,
        driver=replace(it.driver, sense=-it.driver.sense),
        others=tuple(replace(d, sense=-d.sense) for d in it.others),
    )
    start = it.sketch.at if it.others else results.start
    law = DriverMotion(start, it.driver.rate, 0.0, -it.driver.sense)
    other = compute_motion(back, results.kernels, motion.q, law)
    for link in it.moving:
        one, two = motion.centre(link), other.centre(link)
        assert np.max(np.abs(one.v + two.v)) <= 1e-12 * np.max(np.abs(one.v), initial=1e-3)
        assert np.max(np.abs(one.a - two.a)) <= 1e-12 * np.max(np.abs(one.a), initial=1e-3)
    loads = collect_loads(motion, results.strokes)
    given = {x.name: x for x in loads if x.kind == "load" and x.name in {y.name for y in it.loads}}
    again = tuple(given.get(x.name, x) for x in collect_loads(other, results.strokes))
    one, two = solve_reactions(motion, results.structure, loads), solve_reactions(other, results.structure, again)
    largest = max(np.max(np.abs(r.force)) for r in one.all)
    for first, second in zip(one.all, two.all, strict=True):
        assert np.max(np.abs(first.force - second.force)) < 1e-12 * largest
    for first, second in zip(one.balances, two.balances, strict=True):
        assert np.max(np.abs(first.generalized - second.generalized)) < 1e-12 * max(
            largest, np.max(np.abs(first.generalized))
        )


# the property of each


def test_positioner_turns_its_bell_crank_by_the_law_of_cosines():
    results = solved("positioner")
    arm = 180 - np.degrees(turned(results, "3"))
    assert arm == pytest.approx([by_cosines(250, 150, 1000 * s) for s in results.motion.q], abs=1e-12)


def test_clamp_meets_symmetrically_and_presses_harder_and_harder():
    results = solved("clamp")
    e, f = results.motion.named("E"), results.motion.named("F")
    assert np.max(np.abs(e.x + f.x)) < 1e-15
    oc, ob = 60, 80
    root = math.sqrt(160**2 - (oc * math.sin(math.radians(150))) ** 2)
    slope = -oc * math.sin(math.radians(150)) / ob * (1 + oc * math.cos(math.radians(150)) / root)
    assert e.first[3].real == pytest.approx(slope, abs=1e-14)
    assert 1 / (-2 * slope) == pytest.approx(1.992, abs=5e-4)
    assert np.all(np.diff(np.abs(e.first)) < 0)


def test_hanger_carries_its_own_weight_and_keeps_the_shelf_level():
    results = solved("balanced-hanger")
    q = results.motion.q
    assert results.reactions.balance.moment == pytest.approx(20 * np.cos(q), abs=1e-12)
    assert np.max(np.abs(results.motion.link("3").angle)) < 1e-14
    assert np.all(results.motion.link("5").first > 1)


def test_two_double_strokes_a_turn():
    results = solved("two-strokes")
    half = 200 * math.sin(math.radians(30))
    stroke = 200 + 300 - 200 * math.cos(math.radians(30)) - math.sqrt(300**2 - half**2)
    assert [abs(s.run) * 1000 for s in results.strokes.strokes] == pytest.approx([stroke] * 4, abs=1e-11)
    assert stroke == pytest.approx(43.952, abs=5e-4)


def test_engine_leaves_only_even_harmonics_of_inertia():
    results = solved("engine-four")
    force = sum(load.force for load in results.loads if load.kind == "inertia" and load.link != "1")
    assert force[0].imag == pytest.approx(4 * 0.6 * 0.04 * (100 * math.pi) ** 2 * 40 / 140, rel=1e-14)
    half = len(force) // 2
    assert np.max(np.abs(force[:half] - force[half:])) < 1e-12 * np.max(np.abs(force))  # repeats twice a turn
    harmonics = np.fft.fft(force.imag) / len(force)
    assert np.max(np.abs(harmonics[1::2])) < 1e-12 * np.max(np.abs(harmonics))


def test_press_goes_down_at_a_nearly_constant_speed():
    results = solved("press-class-iii")
    zone = results_at(results, np.radians(np.linspace(44.5, 169.5, 251)))
    speed = zone.motion.named("D").v.imag
    middle = (np.max(speed) + np.min(speed)) / 2
    assert middle == pytest.approx(-0.2985, abs=1e-4)
    assert np.max(np.abs(speed - middle)) < 0.04 * abs(middle)


def test_shaking_screen_translates_as_the_end_of_a_crank_rocker():
    results = solved("shaking-screen")
    assert np.max(np.abs(results.motion.link("3").omega)) < 1e-12 * results.motion.rate[0]
    assert np.max(np.abs(results.motion.link("3").angle)) < 1e-14
    frame = math.hypot(210, 180)
    swing = by_cosines(frame, 180, 260) - by_cosines(frame, 180, 140)
    assert math.degrees(results.strokes.travel) == pytest.approx(swing, abs=1e-11)
    assert swing == pytest.approx(39.24, abs=5e-3)


def meet(a, b, c, d):
    """Where the lines ab and cd meet."""
    u, v = b - a, d - c
    return a + u * ((c - a).real * v.imag - (c - a).imag * v.real) / (u.real * v.imag - u.imag * v.real)


def test_class_iv_ratio_by_instant_centres():
    results = solved("class-iv")
    for k in range(len(results.motion.q)):
        o, g, a, b, c, d, e = (complex(results.motion.named(p).x[k]) for p in "OGABCDE")
        relative = meet(b, d, c, e)
        common = meet(a, relative, o, g)
        ratio = ((common - o) / (common - g)).real
        assert results.motion.link("4").first[k] == pytest.approx(ratio, abs=1e-11)


def test_class_iv_is_one_of_class_iii_when_driven_from_the_other_end():
    problem = load(str(PROBLEMS / "class-iv.yaml"))
    assert analyse_structure(problem.linkage).mechanism_class == 4
    assert analyse_structure(with_driver(problem.linkage, "4")).formula == "I(0,4) -> III(1,2,3,5)"


def test_cardan_gear_draws_an_exact_straight_line():
    results = results_at(solved("cardan-gear"), np.linspace(0, 2 * np.pi, 73))
    motion = results.motion
    p, q, rate = motion.named("P"), motion.q, motion.rate[0]
    assert np.max(np.abs(p.x.imag)) < 1e-14
    assert p.x.real == pytest.approx(0.12 * np.cos(q), abs=1e-15)
    assert p.v.real == pytest.approx(-0.12 * rate * np.sin(q), abs=1e-14)
    stone = motion.slide(next(s for s in motion.linkage.slides if s.runner == "4"))
    assert np.max(np.abs(stone.run)) < 1e-14
    assert np.max(np.abs(stone.v)) < 1e-13
    m_b = solved("cardan-gear").reactions.balance.moment[3]
    assert m_b == pytest.approx(
        7.5 * (0.12 * 4 * math.pi) ** 2 / 2 + 1.5 * 9.81 * 0.06 * math.cos(math.pi / 4), abs=1e-12
    )


def test_planetary_press_dwells_where_its_rod_is_the_radius_of_curvature():
    results = solved("three-lobes")
    d = results.motion.named("D")
    assert math.degrees(results.motion.q[12]) == pytest.approx(270)
    assert abs(d.v[12]) < 1e-14
    assert abs(d.a[12]) < 1e-13
    assert results.strokes.travel == pytest.approx(0.2, abs=1e-15)
    assert len(results.strokes.strokes) == 2
    dwell = results_at(results, np.radians(np.linspace(234.4, 305.6, 101))).motion.named("D").x.imag
    assert np.max(dwell) - np.min(dwell) < 0.001 * 0.2
    # Willis, with the ring at rest: (omega_2 - omega_1)/(0 - omega_1) = 3
    assert results.motion.link("2").first == pytest.approx(-2.0, abs=1e-14)


def test_planet_on_a_rocker_turns_by_twice_the_swing():
    results = solved("planet-on-rocker")
    assert math.degrees(results.strokes.travel) == pytest.approx(90, abs=1e-12)
    assert results.motion.link("4").first == pytest.approx(2 * results.motion.link("3").first, abs=1e-14)
    part = turned(results, "4")
    assert math.degrees(abs(part[12] - part[0])) == pytest.approx(180, abs=1e-11)
    assert results.strokes.k == pytest.approx(1, abs=1e-12)


def test_a_toothed_sector_doubles_the_strokes():
    results = solved("sector-and-wheel")
    stroke = 50 + 170 - math.sqrt(170**2 - 50**2)
    assert [abs(s.run) * 1000 for s in results.strokes.strokes] == pytest.approx([stroke] * 4, abs=1e-11)
    assert stroke == pytest.approx(57.519, abs=5e-4)
    assert results.motion.link("4").first == pytest.approx(-3 * results.motion.link("3").first, abs=1e-14)
    wheel = turned(results_at(results, results.closely(721)), "4")
    assert math.degrees(np.max(wheel) - np.min(wheel)) == pytest.approx(180, abs=0.01)


def test_geared_cranks_draw_an_exact_straight_line():
    results = solved("gear-straight-line")
    c = results_at(results, results.closely(73)).motion.named("C")
    assert np.max(np.abs(c.x.real)) < 1e-14
    assert np.max(np.abs(c.v.real)) < 1e-14
    root = math.sqrt(120**2 - 50**2)
    c = results.motion.named("C")
    assert 1000 * c.x[3].imag == pytest.approx(30 + root, abs=1e-11)
    assert c.v[3].imag == pytest.approx(-2 * math.pi * 0.03 * 50 / root, abs=1e-14)


@pytest.mark.parametrize("ratio", ["teeth: [100, 40]", "teeth: [61, 53]", "ratio: sqrt(2)"])
def test_a_wheel_on_a_rocker_comes_back_in_every_turn_whatever_its_ratio(ratio):
    """The sector only swings, so that its wheel is back when it is; of wheels that go round teeth would tell."""
    text = file_of("sector-and-wheel").read_text(encoding="utf-8")
    results = solve(
        build_problem(read_text(text.replace("teeth: [120, 40], module: 2", ratio), "rocker.yaml")), "kinematics"
    )
    assert (results.driver_range.full, results.driver_range.turns, results.driver_range.repeats) == (True, 1, True)
    run = results_at(results, results.driver_range.start + 2 * np.pi * np.arange(4)).motion.named("F").x
    assert np.max(np.abs(run - run[0])) < 1e-14


def test_summing_lever_repeats_after_three_turns_only():
    results = solved("summing-lever")
    assert results.driver_range.turns == 3
    q = results.start + 2 * np.pi * np.arange(4)
    run = results_at(results, q).motion.named("E").x.imag
    assert run[3] == pytest.approx(run[0], abs=1e-14)
    assert min(abs(run[1] - run[0]), abs(run[2] - run[0])) > 0.001
    assert results.motion.link("2").first == pytest.approx(-2 / 3, abs=1e-15)
    # the lever adds both cranks by halves, but for the slant of rods and lever
    m = results.motion
    harmonic = (m.named("A").x.imag + m.named("B").x.imag) / 2 + 0.25
    assert np.max(np.abs(m.named("E").x.imag - harmonic)) < 0.1 * results.strokes.travel


def test_cam_lever_rests_in_the_dwells_and_peaks_half_way():
    results = solved("cam-lever")
    slider, lever = results.motion.named("C"), results.motion.link("2").first
    resting = [4, 5, 6, 10, 11, 0]
    assert np.max(np.abs(slider.v[resting])) == 0
    assert np.max(np.abs(slider.a[resting])) < 1e-12
    assert lever[[2, 8]] == pytest.approx([15 / 8 * 20 / 110, -2 * 20 / 110], abs=1e-14)


def test_flat_follower_touches_its_slope_away_from_the_cams_axis():
    results = solved("valve-drive")
    contact = results.reactions.of("cam")
    slope = 15 / 8 * 12 / math.radians(50)
    assert 1000 * contact.at[[2, 6]].real == pytest.approx([slope, -slope], abs=1e-12)
    assert slope == pytest.approx(25.783, abs=5e-4)
    force = results_at(results, results.closely(361)).reactions.of("cam").onto("2")
    assert np.all(force.imag > 0)


def test_rack_goes_twice_as_far():
    results = solved("rack-doubling")
    rack, slider = results.motion.named("R"), results.motion.named("C")
    assert np.max(np.abs(rack.v - 2 * slider.v)) < 1e-15
    assert np.max(np.abs(rack.a - 2 * slider.a)) < 1e-14
    assert np.ptp(rack.x.real) == pytest.approx(0.2, abs=1e-15)
    fixed, moving = results.reactions.of("fixed"), results.reactions.of("moving")
    # along the guide the wheel's own inertia is all that tells the two racks' forces apart from being equal
    spin = 0.0005 * results.motion.link("4").epsilon / 0.03
    assert np.abs(fixed.onto("4").real - moving.onto("4").real) == pytest.approx(np.abs(spin), abs=1e-12)


def test_five_bar_with_both_cranks_upright():
    results = solved("five-bar")
    c, root = results.motion.named("C"), math.sqrt(180**2 - 100**2)
    assert 1000 * c.x[3] == pytest.approx(complex(100, 60 + root), abs=1e-11)
    one, two = 0.06 * 2 * math.pi, 0.06 * 4 * math.pi
    assert c.v[3] == pytest.approx(complex((two - one) / 2, -(two + one) / 2 * 100 / root), abs=1e-14)
    assert results.driver_range.turns == 1


def test_excavator_by_cosines():
    results = solved("excavator")
    m = results.motion
    near, far = math.hypot(1300, 500), abs(complex(2400, 0) - complex(1300, 500))
    for k in range(len(m.q)):
        boom, stick, bucket = (m.drives[link].value[k] * 1000 for link in ("3", "6", "9"))
        arm = by_cosines(600, 900, boom)
        assert math.degrees(m.link("1").angle[k]) == pytest.approx(arm - 20, abs=1e-11)
        p = {x: 1000 * complex(m.named(x).x[k]) for x in "ONEQUFV"}
        assert abs(p["N"] - p["O"]) == pytest.approx(near, abs=1e-10)
        at_stick = math.degrees(cmath.phase((p["N"] - p["E"]) / (p["Q"] - p["E"])))
        assert abs(at_stick) == pytest.approx(by_cosines(far, 400, stick), abs=1e-10)
        at_bucket = math.degrees(cmath.phase((p["U"] - p["F"]) / (p["V"] - p["F"])))
        assert abs(at_bucket) == pytest.approx(by_cosines(math.hypot(1100, 250), 320, bucket), abs=1e-10)
    assert math.degrees(m.link("1").angle[0]) == pytest.approx(70, abs=1e-11)


def test_loader_angle_by_cosines():
    results = solved("loader")
    between = np.degrees(results.motion.link("2").angle - results.motion.link("1").angle)
    expected = [by_cosines(240, 180, 1000 * s) for s in results.motion.q]
    assert between == pytest.approx(expected, abs=1e-11)
    assert between[2] == pytest.approx(90, abs=1e-11)


def test_a_tabulated_load_acts_on_near_dead_positions_too(tmp_path):
    """One degree from where l = r + 0.01 mm is all but dead, numbers are extended, and the table is read with them."""
    text = (PROBLEMS / "crank-slider.yaml").read_text(encoding="utf-8")
    text = text.replace("l: 220", "l: 60.01").replace("B: [245, 0]", "B: [60, 0]")
    text = text.replace("{count: 12, from: working stroke, detail: [10]}", "{at: [89, 29]}")
    (tmp_path / "near-dead.yaml").write_text(text, encoding="utf-8")
    results = solve(load(str(tmp_path / "near-dead.yaml")))
    assert results.motion.finer is not None
    gas = next(a for a in results.loads if a.name == "gas")
    assert gas.force[1] == pytest.approx(-(900 + (29 - 20) / (40 - 20) * (200 - 900)), rel=1e-14)
    assert gas.force[0] == 0
    assert results.lever_holds


def test_another_driver_leaves_out_what_hangs_on_that_of_the_file():
    engine = load(PROBLEMS / "four-stroke-engine.yaml")
    other = redrive(engine, "3")
    assert engine.dynamics is not None and other.dynamics is None and other.linkage.turns == 1
    assert [own.name for own in other.linkage.loads] == ["rings"]
    assert solve(other, "structure").structure.formula == "I(0,3) -> II(1,2)"
