"""Coulomb friction where the answer is known in closed form, and where it locks."""

from __future__ import annotations

import math
from dataclasses import replace

import mpmath as mp
import numpy as np
import pytest
from models import linkage_of, results_of, solved_text
from transforms import turned

from tmm_cli.mechanics.analysis import Inputs, solve
from tmm_cli.mechanics.linkage import Friction, Request
from tmm_cli.reports import assess_accuracy, computed_tables

G = 9.81
SLIDER = {
    "tmm": 1,
    "units": {"length": "m", "angle": "rad"},
    "guides": {"x": {"through": [0, 0], "angle": 0}},
    "links": {"1": {"points": ["A"], "slides": {"on": "x"}}},
    "driver": {"link": 1, "speed": 0.2},
    "masses": {"1": {"mass": 3}},
    "positions": {"at": [0, 0.1, 0.2]},
}
CRANK = {
    "tmm": 1,
    "units": {"length": "m", "angle": "rad"},
    "points": {"O": [0, 0]},
    "links": {"1": {"points": {"O": [0, 0], "A": [0.3, 0]}}},
    "driver": {"link": 1, "speed": 2},
    "masses": {"1": {"mass": 5, "centre": "O"}},
}
# a wedge 1 driven along x lifts follower 2 in a vertical guide; the slope is between them
WEDGE = {
    "tmm": 1,
    "units": {"length": "m", "angle": "rad"},
    "guides": {"x": {"through": [0, 0], "angle": 0}, "y": {"through": [0, 0], "angle": "90 deg"}},
    "links": {
        "1": {"points": {"A": [0, 0]}, "slides": {"on": "x"}},
        "2": {"points": {"B": [0, 0]}, "slides": [{"on": "y"}, {"on": 1, "through": [0, 0], "angle": "-20 deg"}]},
    },
    "driver": {"link": 1, "speed": 0.1},
    "sketch": {"at": 0.05, "B": [0, 0.018]},
    "loads": {"F": {"on": 2, "force": [0, -100]}},
    "gravity": 0,
    "positions": {"at": [0.0, 0.05]},
}


def test_without_the_block_nothing_of_it_is_computed():
    assert results_of(SLIDER).friction is None


def test_a_slider_is_held_back_by_mu_times_its_weight():
    results = results_of(SLIDER | {"friction": {"coefficient": 0.15}})
    assert np.allclose(results.reactions.balance.force, 0.15 * 3 * G, rtol=1e-14)


def test_a_shaft_is_held_back_by_mu_times_its_weight_times_the_radius_of_its_journal():
    results = results_of(CRANK | {"friction": {"coefficient": 0.1, "radius": 0.02}})
    assert np.allclose(results.reactions.balance.moment, 0.1 * 0.02 * 5 * G, rtol=1e-14)
    backward = CRANK | {
        "driver": {"link": 1, "speed": 2, "turns": "cw"},
        "friction": {"coefficient": 0.1, "radius": 0.02},
    }
    assert np.allclose(results_of(backward).reactions.balance.moment, -0.1 * 0.02 * 5 * G, rtol=1e-14)


@pytest.mark.parametrize("mu", [0.05, 0.2])
def test_a_wedge_needs_the_force_of_its_friction_angles(mu):
    """Friction on all three faces, by the polygons of both links: I. I. Artobolevsky, ch. 11."""
    results = results_of(WEDGE | {"friction": {"coefficient": mu}})
    a = math.radians(20)
    # follower: Q + mu N_y (down), N_y from the wall, R on the slope at the friction angle; wedge: slope and floor
    phi = math.atan(mu)
    # R acts on the follower at a + phi from the vertical; across: N_y = R sin(a + phi); up: R cos(a + phi) = Q + mu N_y
    R = 100 / (math.cos(a + phi) - mu * math.sin(a + phi))
    push = R * math.sin(a + phi) + mu * R * math.cos(a + phi)
    assert np.allclose(np.abs(results.reactions.balance.force), push, rtol=1e-11)
    assert not np.any(results.friction.locked)
    assert results.losses.efficiency == pytest.approx(100 * math.tan(a) / push, rel=1e-10)


def test_a_steep_wedge_locks_and_says_where():
    """cos(a + phi) = mu sin(a + phi), that is a + 2 phi = 90 deg: beyond it no force moves the follower."""
    steep = WEDGE | {
        "links": {
            **WEDGE["links"],
            "2": {"points": {"B": [0, 0]}, "slides": [{"on": "y"}, {"on": 1, "through": [0, 0], "angle": "-60 deg"}]},
        },
        "sketch": {"at": 0.05, "B": [0, 0.087]},
    }
    free = results_of(steep | {"friction": {"coefficient": 0.25}})  # a + 2 phi = 88 deg
    locked = results_of(steep | {"friction": {"coefficient": 0.28}})  # a + 2 phi = 91 deg
    assert not np.any(free.friction.locked)
    assert np.all(locked.friction.locked)


def test_power_balances_with_friction_and_the_lever_bears_it_too():
    results = results_of(WEDGE | {"friction": {"coefficient": 0.1}})
    assert np.max(np.abs(results.energy.balance)) < 1e-12
    assert np.max(results.lever.difference) < 1e-12
    assert np.all(results.energy.friction < 0)


def test_the_efficiency_of_a_crank_slider_is_the_work_that_arrives_at_the_slider():
    problem = {
        "tmm": 1,
        "units": {"length": "m", "angle": "rad"},
        "points": {"O": [0, 0]},
        "guides": {"x": {"through": [0, 0], "angle": 0}},
        "links": {
            "1": {"points": ["O", "A"], "length": 0.1},
            "2": {"points": ["A", "B"], "length": 0.3},
            "3": {"points": ["B"], "slides": {"on": "x"}},
        },
        "driver": {"link": 1, "speed": 10},
        "sketch": {"at": 1, "B": [0.35, 0]},
        "gravity": 0,
        "loads": {"F": {"on": 3, "force": [-1000, 0], "when": "working stroke"}},
        "output": {"link": 3, "working": "forward"},
        "friction": {"coefficient": 0.1, "radius": 0.015},
    }
    results = results_of(problem)
    useful = 1000 * 0.2  # the load goes against the stroke H = 2 r
    assert results.losses.efficiency == pytest.approx(useful / results.losses.drivers, rel=1e-4)
    assert 0.8 < results.losses.efficiency < 0.95
    assert sum(results.losses.pairs.values()) == pytest.approx(useful - results.losses.drivers, rel=1e-3)


@pytest.mark.parametrize("by", [40, 77, -131])
def test_pairs_of_links_that_do_not_move_against_each_other_have_no_friction_however_the_drawing_lies(by):
    """The elbows of a breaking rod, hinged at X and in contact at P, move as one link."""
    rod = linkage_of("settings/breaking-rod")
    pairs = [*(Friction(point, 0.15, 0.03) for point in "OAXPE"), Friction("y", 0.15)]
    places = np.radians(np.arange(12) * 30.0 + 7)

    def forces(linkage, at):
        results = solve(Inputs(linkage, Request(places=tuple(at))))
        assert not any(np.any(results.friction.work.get(point, 0)) for point in "XP")
        return {r.pair.name: np.abs(r.force) for r in results.reactions.all}

    drawn = forces(replace(rod, friction=tuple(pairs)), places)
    otherwise = forces(turned(replace(rod, friction=tuple(pairs)), math.radians(by)), places + math.radians(by))
    largest = max(np.max(force) for force in drawn.values())
    for name, force in drawn.items():
        assert np.allclose(force, otherwise[name], rtol=0, atol=1e-11 * largest)
    without = forces(replace(rod, friction=tuple(f for f in pairs if f.pair not in "XP")), places)
    assert all(np.allclose(force, without[name], rtol=0, atol=1e-11 * largest) for name, force in drawn.items())


def test_a_machine_without_a_useful_load_has_an_efficiency_of_zero_and_without_friction_none():
    """Weights and inertia give back over a turn what they took, but for rounding."""
    idle = {
        "tmm": 1,
        "units": {"length": "m", "angle": "rad"},
        "points": {"O": [0, 0]},
        "guides": {"x": {"through": [0, 0], "angle": 0}},
        "links": {
            "1": {"points": ["O", "A"], "length": 0.1},
            "2": {"points": ["A", "B"], "length": 0.4},
            "3": {"points": ["B"], "slides": {"on": "x"}},
        },
        "driver": {"link": 1, "speed": 10},
        "sketch": {"at": 1, "B": [0.45, 0]},
        "masses": {"2": {"mass": 2, "inertia": 0.04, "centre": {"on": "AB", "at": 0.5}}},
    }
    assert results_of(idle | {"friction": {"coefficient": 0.1, "radius": 0.02}}).losses.efficiency == 0
    assert results_of(idle | {"friction": {"coefficient": 1e-20, "radius": 0.02}}).losses.efficiency is None


CRANK_PRESS = """tmm: 1
points: {O: [0, 0]}
guides: {x: {through: O, angle: 0}}
links:
  1: {points: [O, A], length: 100}
  2: {points: [A, B], length: 400}
  3: {points: [B], slides: {on: x}}
driver: {link: 1, speed: 60 rpm}
sketch: {at: 60 deg, B: [440, 0]}
loads: {F: {on: 3, at: B, force: [-5000, 0]}}
friction: {coefficient: 0.1, radius: 30, pairs: {x: {coefficient: 0.15}, B: {radius: 20}}}
gravity: 0
positions: {at: [-120, -60, -20]}
"""


def moment_by_friction_circles(degrees):
    """The driving moment (N*m) of the press above on its way to the load, in 50 digits.

    The rod has no mass: its force S is a tangent to the friction circles of A (radius 0.1 * 30 = 3 mm) and of B (2 mm),
    so it deviates from AB by asin((3 + 2) / 400), or by asin((3 - 2) / 400) beyond the upright crank, where the rod
    rotates back. The guide's force is at its friction angle: F + mu N = S cos(beta), N = S sin(beta).
    I. I. Artobolevsky, Theory of Mechanisms, ch. 11.
    """
    with mp.workdps(50):
        r, rod, F, mu = mp.mpf("0.1"), mp.mpf("0.4"), mp.mpf(5000), mp.mpf("0.15")
        phi = mp.radians(-degrees)  # mirrored: the crank is above the guide, and the slider moves outwards
        lean, radius_A, radius_O = mp.asin(r * mp.sin(phi) / rod), mp.mpf("0.003"), mp.mpf("0.003")
        turned = mp.sign(mp.cos(phi))  # in which sense the rod rotates
        beta = lean + mp.asin((radius_A + turned * mp.mpf("0.002")) / rod)  # S leans away from the guide by friction
        S = F / (mp.cos(beta) - mu * mp.sin(beta))
        # arm of S about O: the crank's own, and both friction circles; the line passes A at the radius of its circle
        return S * (r * mp.sin(phi + beta) + radius_A + radius_O)


@pytest.mark.parametrize(("number", "degrees"), [(0, -120), (1, -60), (2, -20)])
def test_a_press_needs_the_moment_of_its_friction_circles_and_digits_bound_it(number, degrees):
    results = solved_text(CRANK_PRESS)
    table = assess_accuracy(results).table(next(one for one in computed_tables(results) if one.name == "balance"))
    balance = next(column for column in table.columns if column.header == "M_b")
    exact = moment_by_friction_circles(degrees)
    value = results.reactions.balance.moment[number]
    assert value == pytest.approx(float(exact), rel=1e-12)
    assert abs(mp.mpf(float(value)) - exact) <= balance.bound[number] < 1e-6 * abs(value)
