"""Flywheels of engines whose turning moment is given by triangles and sines, with answers to their printed digits.

R. S. Khurmi, J. K. Gupta, Theory of Machines, 14th ed., Eurasia 2009, ch. 16: examples 16.6, 16.7 (p. 578), 16.8
(p. 580), 16.9 (p. 582), 16.11 (p. 585), 16.12 (p. 587), 16.13 (p. 589); answers without the roundings on the way, as
the Python companion to the book computes them (FOSSEE, Theory_Of_Machines, ch16). Of three of them a problem file is
run, whose rods weigh nothing; the others are moments over the crank's angle.
"""

import numpy as np
import pytest
from test_loads import MACHINE

from tmm_cli import solve
from tmm_cli.mechanics.dynamics import SteadyTask, find_steady_running as running, reduce_machine
from tmm_cli.problem import build_any_problem, read_text

TURN = 2 * np.pi
RPM = np.pi / 30


def steady(speed, tail):
    text = MACHINE.replace("speed: 60 rpm", f"speed: {speed}") + f"gravity: 0\n{tail}"
    return solve(build_any_problem(read_text(text, "x.yaml"))).running.steady


def extremes(found):
    """Where the crank is slowest and quickest, degrees."""
    way = np.linspace(0, found.machine.length, 20001)
    speed = found.law.speed(way)
    return np.degrees(way[[np.argmin(speed), np.argmax(speed)]])


def test_two_triangles_in_a_turn():
    """2000 N m at 80 deg and 1500 N m on the way back, 100 rpm within 1.5 %, radius of gyration 1.75 m: 197.3 kg."""
    found = steady(
        "100 rpm",
        """dynamics: {delta: 0.015}
loads: {m: {on: 1, moment: {against: crank angle,
  table: [[0, 0], [80, 2000], [180, 0], [270, 1500], [360, 0]]}}}
""",
    )
    assert found.law.flywheel / 1.75**2 == pytest.approx(197.3, abs=0.05)
    assert -found.moment == pytest.approx(875)
    slow, quick = extremes(found)
    assert slow == pytest.approx(35, abs=0.05) and quick == pytest.approx(136.25, abs=0.05)


def test_four_strokes_of_which_one_expands_and_one_compresses():
    """20 kW at 300 rpm within 4 %; expansion works three times as much as compression takes: 255.4 kg m2."""
    work = 20_000 / 2.5
    peaks = {name: 2 * part * work / np.pi for name, part in (("expansion", 1.5), ("compression", -0.5))}
    taken, given = (f"{peaks[name]:.15g}" for name in ("compression", "expansion"))
    rows = f"[0, 0], [180, 0], [270, {taken}], [360, 0], [450, {given}], [540, 0], [720, 0]"
    found = steady(
        "300 rpm",
        f"""cycle: 2 turns
dynamics: {{delta: 0.04}}
loads: {{m: {{on: 1, moment: {{against: crank angle, table: [{rows}]}}}}}}
""",
    )
    assert found.law.flywheel == pytest.approx(255.4, abs=0.05)
    assert -found.moment * 2 * np.pi * 5 == pytest.approx(20_000)


def test_an_engine_and_a_machine_of_sines():
    """5000 + 600 sin 2q against 5000 + 500 sin q N m, 500 kg on 0.4 m at 150 rpm.

    1204 N m, 6.1 %, 3.46 and -12.2 rad/s2; splines through moments every 5 degrees.
    """
    angles = range(0, 361, 5)
    rows = ", ".join(f"[{a}, {5000 + 600 * np.sin(2 * np.radians(a)):.15g}]" for a in angles)
    against = ", ".join(f"[{a}, {-5000 - 500 * np.sin(np.radians(a)):.15g}]" for a in angles)
    found = steady(
        "150 rpm",
        f"""dynamics: {{flywheel: {{inertia: 80}}}}
loads:
  engine: {{on: 1, moment: {{against: crank angle, between: smooth, table: [{rows}]}}}}
  machine: {{on: 1, moment: {{against: crank angle, between: smooth, table: [{against}]}}}}
""",
    )
    assert 100 * found.delta == pytest.approx(6.1, abs=0.05)
    low, high = found.speeds
    assert 80 * (high**2 - low**2) / 2 == pytest.approx(1204, abs=0.5)
    way = np.linspace(0, 2 * np.pi, 20001)
    gain = found.law.acceleration(way)
    assert np.max(gain[way < np.pi]) == pytest.approx(3.46, abs=0.005)
    assert np.min(gain) == pytest.approx(-12.2, abs=0.05)
    assert np.degrees(way[np.argmin(gain)]) == pytest.approx(127.6, abs=0.05)


def machine(moment, edges):
    """From a moment (N m) by the crank's angle (rad), that of a load negative; edges: where it bends or jumps."""
    return reduce_machine(lambda x: (0 * x, 0 * x, moment(x)), edges)


def polygon(*corners):
    """Through corners (angle in rad, moment)."""
    angles, moments = zip(*corners, strict=True)
    return machine(lambda x: np.interp(x, angles, moments), angles)


def test_example_16_6_a_machine_with_a_cycle_of_three_turns():
    load = polygon((0, -750), (np.pi, -3000), (3 * np.pi, -3000), (4 * np.pi, -750), (6 * np.pi, -750))
    found = running(load, SteadyTask(250 * RPM, flywheel=500 * 0.6**2))
    assert found.moment * 250 * RPM == pytest.approx(49_087, abs=1)  # W
    assert found.delta == pytest.approx(0.072, abs=5e-4)


def test_example_16_8_page_580_three_cylinders():
    def moment(x):
        turns = [np.mod(x - k * TURN / 3, TURN) for k in range(3)]
        return sum(np.interp(turn, [0, np.pi / 3, np.pi, TURN], [0, 90, 0, 0]) for turn in turns)

    found = running(machine(moment, np.arange(7) * np.pi / 3), SteadyTask(600 * RPM, flywheel=12 * 0.08**2))
    assert -found.moment * 600 * RPM == pytest.approx(4240, abs=5)  # W
    assert found.delta == pytest.approx(0.04, abs=5e-3)
    x = np.linspace(0, TURN, 721)[:-1]
    assert found.law.acceleration(x).max() == pytest.approx(292, abs=1.5)  # the book rounds 22.5 / 0.0768 = 292.97 down


def test_example_16_11_page_585_an_engine_by_a_formula():
    engine = machine(lambda x: 20_000 + 9500 * np.sin(2 * x) - 5700 * np.cos(2 * x), [0, TURN])
    found = running(engine, SteadyTask(180 * RPM, 0.01))
    assert -found.moment * 180 * RPM == pytest.approx(377_000, rel=1e-3)
    assert found.law.flywheel == pytest.approx(3121, rel=1e-3)
    assert found.law.acceleration(np.array([np.pi / 4]))[0] == pytest.approx(3.044, rel=2e-3)


def test_example_16_13_page_589_three_cranks():
    engine = machine(lambda x: 5000 + 1500 * np.sin(3 * x), [0, TURN])
    found = running(engine, SteadyTask(300 * RPM, flywheel=1000.0))
    assert -found.moment * 300 * RPM == pytest.approx(157_100, abs=50)  # W
    assert found.delta == pytest.approx(0.001, abs=5e-5)


TWO_TRIANGLES = (
    "loads: {m: {on: 1, moment: {against: crank angle, table: [[0, 0], [90, 100], [270, -100], [360, 0]]}}}\n"
)


def test_the_inertia_of_a_crank_is_subtracted_from_the_first_group_of_mertsalov():
    """Two triangles of 100 N m gain 50 pi J; at 5 rad/s and delta = 0.02 the first group has 100 pi kg m2."""
    crank = 300.0
    found = steady(
        "5 rad/s",
        f"masses: {{1: {{mass: 0, inertia: {crank}, centre: O}}}}\ndynamics: {{delta: 0.02}}\n" + TWO_TRIANGLES,
    )
    assert found.machine.constant == pytest.approx(crank, rel=1e-12)
    assert found.first_group == pytest.approx(100 * np.pi, rel=1e-12)
    assert found.mertsalov == pytest.approx(100 * np.pi - crank, rel=1e-11)
    assert found.law.flywheel == pytest.approx(100 * np.pi - crank, rel=1e-11)  # exact too: nothing else moves
    assert found.errors[1] == pytest.approx(0, abs=1e-10)


def test_mertsalov_takes_the_mean_speed_for_the_links_of_variable_ratio_only():
    """Crank-slider r = 50, l = 150 mm: the energy of rod and slider at 5 rad/s, on a grid; the crank is constant."""
    crank, rod, rod_inertia, slider, mean, delta = 0.4, 30.0, 0.2, 80.0, 5.0, 0.1
    found = steady(
        f"{mean} rad/s",
        f"masses: {{1: {{mass: 7, inertia: {crank}, centre: O}}, 2: {{mass: {rod}, inertia: {rod_inertia}, centre: A}},"
        f" 3: {{mass: {slider}, centre: B}}}}\ndynamics: {{delta: {delta}}}\n{TWO_TRIANGLES}",
    )
    r, length = 0.05, 0.15
    phi = np.linspace(0, TURN, 400_001)
    beta = np.arcsin(r * np.sin(phi) / length)
    turned = -r * np.cos(phi) / (length * np.cos(beta))  # omega_2 / omega_1
    slid = -r * np.sin(phi + beta) / np.cos(beta)  # v_B / omega_1
    second = rod * r**2 + rod_inertia * turned**2 + slider * slid**2
    moment = np.interp(phi, np.radians([0, 90, 270, 360]), [0, 100, -100, 0])
    work = np.concatenate([[0], np.cumsum((moment[1:] + moment[:-1]) / 2 * np.diff(phi))])
    rest = work - second * mean**2 / 2
    group = np.ptp(rest) / (delta * mean**2)
    # the rod's mass is at A, but its rotation makes its reduced inertia vary: it is of the second group
    assert found.machine.constant == pytest.approx(crank, rel=1e-12)
    assert found.first_group == pytest.approx(group, rel=1e-8)
    assert found.mertsalov == pytest.approx(group - crank, rel=1e-8)
    exact = found.law.flywheel
    assert found.errors[1] == pytest.approx((group - crank) / exact - 1, rel=1e-6)
    assert abs(found.errors[1]) < 0.1


def test_gears_on_the_frame_are_of_the_first_group():
    """Gear 2 turns half as fast as gear 1: J_c = J_1 + J_2 / 4."""
    text = """tmm: 1
units: {length: mm, angle: deg}
points: {O: [0, 0], C: [90, 0]}
links: {1: {points: {O: [0, 0], A: [20, 0]}}, 2: {points: {C: [0, 0], D: [30, 0]}}}
gears: {g: {between: [1, 2], radii: [30, 60]}}
driver: {link: 1, speed: 5 rad/s, turns: ccw}
sketch: {at: 0, D: [120, 0]}
masses: {1: {mass: 0, inertia: 3, centre: O}, 2: {mass: 0, inertia: 8, centre: C}}
gravity: 0
dynamics: {delta: 0.02}
"""
    found = solve(build_any_problem(read_text(text + TWO_TRIANGLES, "x.yaml"))).running.steady
    assert found.machine.constant == pytest.approx(3 + 8 / 4, rel=1e-12)
    assert found.mertsalov == pytest.approx(100 * np.pi - 5, rel=1e-11)
