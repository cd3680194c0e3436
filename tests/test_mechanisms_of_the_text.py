"""Mechanisms built after the text of their figures: what each shows, computed by circles, vectors and virtual work."""

from __future__ import annotations

import math

import numpy as np
import pytest
from bank import solved
from models import PROBLEMS
from test_mechanisms import meet, shown, slope, unit

from tmm_cli import load, solve
from tmm_cli.problem import build_problem, read_text


def root(function, low, high):
    """Where a function that changes its sign between two places is zero, by halving."""
    sign = math.copysign(1, function(low))
    for _ in range(100):
        middle = (low + high) / 2
        low, high = (middle, high) if math.copysign(1, function(middle)) == sign else (low, middle)
    return (low + high) / 2


def changed(name, before, after):
    """A problem of the bank with another text in one place."""
    text = (PROBLEMS / f"{name}.yaml").read_text(encoding="utf-8")
    assert text.count(before) == 1
    return solve(build_problem(read_text(text.replace(before, after), name)))


def test_positioner_brings_both_jaws_together_on_one_axis():
    g, f, jaws = -250 + 0j, -200j, []
    for s in (240, 270):
        b = meet(0j, g, 150, s, -63 + 136j)
        c = 80 / 150 * b * -1j
        jaws.append([np.angle(meet(c, f, 190, 100, k) - f, deg=True) for k in (94 - 165j, -53 - 115j)])
    turns = [(after - before) % 360 for before, after in zip(*jaws, strict=True)]
    turns = [turn - 360 if turn > 180 else turn for turn in turns]
    assert np.degrees(shown("positioner")[1:]) == pytest.approx(turns, abs=1e-9)
    assert turns == pytest.approx([-9.83, 5.13], abs=0.005)  # the jaws turn towards one another


def test_hanger_keeps_the_shelf_level_and_its_pressure_shelf_outruns_it():
    q = -60 + 150j

    def pressure_shelf(phi):
        e = 200 * np.exp(1j * phi) + 40 - 60j
        f = meet(q, e, 250, 130, 180 + 60j)
        return q + (420 - 60j) * (f - q) / 250

    level, ratio = shown("hanger")
    assert level == pytest.approx(0, abs=1e-12)
    assert ratio == pytest.approx(abs(slope(pressure_shelf, 0.0)) / 200, rel=1e-9)
    assert ratio == pytest.approx(2.6237, abs=5e-5)


def test_spring_of_the_hanger_raises_it_empty_and_yields_to_the_part():
    balance = solved("hanger").reactions.balance.moment
    assert np.all(balance[1:] > 0)  # held back from 0 deg on
    assert np.all(changed("hanger", "force: [0, -60]", "force: [0, 0]").reactions.balance.moment < 0)


def test_slotted_link_driven_by_the_crank_turns_twice_as_far():
    r, angle = 80, math.radians(40)
    pivot = r / (2 * math.cos(angle))
    assert np.angle(r * np.exp(1j * angle) - pivot) == pytest.approx(2 * angle, abs=1e-14)
    assert shown("slotted/angle-doubling")[0] == pytest.approx(2, abs=1e-12)


def test_slotted_link_is_dead_where_the_crank_pin_passes_its_pivot():
    motion = changed("slotted/angle-doubling", "A: 40 deg", "A: 60 deg").motion
    dead = next(iter(motion.dead.values()))
    assert dead.tolist() == [False, False, False, True, False, False, False]


def test_ram_of_the_planetary_press_dwells_by_its_curve_of_five_lobes():
    b = math.radians(18)
    x, h = 100 * math.sin(b) + 10 * math.sin(4 * b), 100 * math.cos(b) - 10 * math.cos(4 * b) - 90
    rod = (x * x + h * h) / (2 * h)

    def ram(phi):
        p = 100 * np.exp(1j * phi) + 10j * np.exp(-4j * phi)
        return p.imag - np.sqrt(rod**2 - p.real**2)

    low = 1.5 * math.pi
    end = root(lambda phi: ram(phi) - ram(low) - 0.2, low + math.radians(19), low + math.radians(30))
    dwell, way = shown("planetary-dwell-press")
    assert dwell == pytest.approx(2 * (end - low), rel=1e-9)
    assert way == pytest.approx(0.2, rel=1e-12)


def test_pin_lever_of_equal_gears_gives_four_strokes_of_the_slider():
    g = math.radians(42)
    inner, outer = math.asin(90 * math.cos(g) / 120), math.asin(90 / 120)
    places = [
        (-120 + 140 * np.exp(1j * (psi + math.radians(50))))
        - math.sqrt(220**2 - (140 * math.sin(psi + math.radians(50)) - 0.97 * 140) ** 2)
        for psi in (inner, outer)
    ]
    strokes, swing = shown("gear-doubling")
    assert strokes == 4
    assert swing == pytest.approx(outer - inner, rel=1e-9)
    assert solved("gear-doubling").strokes.travel == pytest.approx(abs(places[1].real - places[0].real) / 1e3, rel=1e-9)


def test_claw_draws_the_film_down_along_its_straight_side():
    def claw(degrees):
        a = 9 * unit(degrees)
        b = meet(a, 29j, 23, 24, 22 + 19j)
        return a + (2.5 + 19j) * (b - a) / 23

    down, straight, width = shown("four-bars/claw")
    assert down == pytest.approx((claw(4) - claw(101)).imag / 1e3, rel=1e-9)
    ends = [root(lambda q: claw(q).real - claw(28).real + 0.35, *q) for q in ((-10, 20), (80, 115))]
    assert straight == pytest.approx(math.radians(ends[1] - ends[0]), rel=1e-9)
    turn = np.linspace(0, 360, 7201)
    assert width == pytest.approx(np.ptp([claw(q).real for q in turn]) / 1e3, rel=1e-6)


def test_safety_lever_presses_on_its_stop_until_the_load_is_too_large():
    """The moment of the stop by virtual work: the lever turns on the rod by a hair, the crank stands."""

    def places(b, s):
        d, e_x = -230 - 140j, -230
        rocker = (b - d) / 150
        c, p = d - 90j * rocker, d + (30 - 110j) * rocker
        arm = 200 + 90 * np.exp(1j * s)  # from C to E, in the axes of the rod
        below = math.acos((e_x - c.real) / abs(arm))
        rod = np.exp(1j * (-below)) * abs(arm) / arm
        lever = rod * np.exp(1j * s)
        x, v = c + 200 * rod, c + (90 + 60j) * rod
        u = x + 60j * lever
        t = meet(v, u, 60, 95, -90 - 296j)
        q = v + (-50 + 30j) * (t - v) / 60j
        return (c + arm * rod).imag, abs(q - p)

    s = math.radians(20)
    moments = {2000: [], 4000: []}
    b = -205 + 8j
    for phi in np.linspace(90, 450, 721):
        b = meet(40 * unit(phi), -230 - 140j, 220, 150, b)
        rise = slope(lambda turn, b=b: places(b, turn)[0], s) / 1e3
        longer = slope(lambda turn, b=b: places(b, turn)[1], s) / 1e3
        pull = 60 * (places(b, s)[1] - 190)
        for force, row in moments.items():
            row.append(pull * longer - force * rise)
    _, least, largest = shown("settings/spring-return-rod")
    assert least == pytest.approx(min(moments[2000]), rel=1e-5)
    assert largest == pytest.approx(max(moments[4000]), rel=1e-4)
    assert least > 0 > largest


def test_crank_rocker_of_the_swing_doubler_obeys_grashof():
    linkage = load(str(PROBLEMS / "four-bars/swing-crank-rocker.yaml")).linkage
    lengths = sorted(
        abs(linkage.local(link, b) - linkage.local(link, a))
        for link, a, b in (("1", "O", "A"), ("2", "A", "B"), ("3", "D", "B"), ("0", "O", "D"))
    )
    assert lengths[0] == pytest.approx(0.075) and lengths[0] + lengths[3] < lengths[1] + lengths[2]
    assert solved("four-bars/swing-crank-rocker").roles["3"] == "crank"


RISE = {"up": lambda x: 10 * x**3 - 15 * x**4 + 6 * x**5, "down": lambda x: 1 - x + np.sin(2 * np.pi * x) / (2 * np.pi)}


def coupler(relative, rise=18.0):
    """Length AB (mm) at an angle of the cam from the carrier (rad)."""
    turn = np.degrees(relative) % 360 - 20
    turn += 360 if turn < 0 else 0
    if turn < 100:
        return 150 + rise * RISE["up"](turn / 100)
    return 150 + rise * (1.0 if turn < 180 else RISE["down"]((turn - 180) / 100) if turn < 280 else 0.0)


def rocker_with_cam(phi, near, rise=18.0):
    """Angle of the rocker and of the carrier (rad): the coupler is as long as the cam makes it."""
    a, d = 50 * np.exp(1j * phi), 170 - 20j

    def b(theta):
        return a + coupler(phi - theta, rise) * np.exp(1j * theta)

    theta = root(lambda t: abs(b(t) - d) - 120, near - 0.2, near + 0.2)
    return np.angle(b(theta) - d), theta


def test_a_cam_on_the_crank_changes_the_length_of_the_coupler():
    phi, theta, psi = np.radians(40 + np.linspace(0, 360, 1441)), 0.4, []
    for q in phi:
        angle, theta = rocker_with_cam(q, theta)
        psi.append(angle)
    assert shown("cam-coupler")[0] == pytest.approx(np.ptp(psi), abs=2e-6)
    results = solved("cam-coupler")
    there = np.interp(np.radians([60, 90]), phi, np.unwrap(psi))
    assert results.motion.angle("4")[[2, 3]] == pytest.approx(there, abs=2e-5)
    assert float(np.max(results.lever.difference)) < 1e-12  # velocities alone know nothing of where the cam pushes


def test_without_a_rise_it_is_the_four_bar():
    text = (PROBLEMS / "cam-coupler.yaml").read_text(encoding="utf-8").partition("shows:")[0]
    still = solve(build_problem(read_text(text.replace("rise: 18", "rise: 0").replace("rise: -18", "rise: 0"), "x")))
    a = 50 * np.exp(1j * still.motion.q)
    b = np.array([meet(z, 170 - 20j, 150, 120, 187 + 98j) for z in a])
    assert still.motion.angle("4") == pytest.approx(np.angle(b - (170 - 20j)), abs=1e-12)


def test_a_cam_on_the_frame_moves_the_follower_on_a_turning_crank():
    text = """tmm: 1
units: {length: mm, angle: deg}
points: {O: [0, 0]}
links:
  1: {points: {O: [0, 0], T: [200, 0]}}
  2: {points: [P], slides: {on: 1, along: OT}}
cams:
  c: {cam: 0, follower: 2, carrier: 1, law: [{over: 180, rise: 30, law: cosine}, {over: 180, rise: -30, law: cosine}],
      offset: 100}
driver: {link: 1, speed: 60 rpm}
sketch: {at: 0, P: [100, 0]}
masses: {2: {mass: 1 kg, inertia: 0.001}}
gravity: 0
positions: {count: 8}
"""
    results = solve(build_problem(read_text(text, "x")))
    q = results.motion.q
    run = 115 - 15 * np.cos(np.mod(-q, 2 * np.pi))  # 30 mm along the cosine law, there and back
    assert np.abs(results.motion.named("P").x) * 1e3 == pytest.approx(run, abs=1e-9)
    # force of inertia along and across the crank, with the transfer functions of the law
    s, ds, dds, omega = run / 1e3, 15e-3 * np.sin(q), 15e-3 * np.cos(q), 2 * np.pi
    balance = results.reactions.balance.moment
    power = omega * (dds * omega**2 - s * omega**2) * ds + 2 * ds * omega * omega * s * omega
    assert balance * omega == pytest.approx(power, abs=1e-9)
