"""Pressure angles against the formulas that textbooks give for single schemes; the calculator knows none of them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from bank import solved
from models import results_of

from tmm_cli.mechanics.forces import find_transmitted_forces

FOUR_BAR = {
    "tmm": 1,
    "units": {"length": "m", "angle": "rad"},
    "points": {"O": [0, 0], "D": [0.4, 0]},
    "links": {
        "1": {"points": ["O", "A"], "length": 0.1},
        "2": {"points": ["A", "B"], "length": 0.35},
        "3": {"points": ["D", "B"], "length": 0.25},
    },
    "driver": {"link": 1, "speed": 10},
    "sketch": {"at": 1, "B": [0.35, 0.25]},
}


def slider(offset: float) -> dict:
    return {
        "tmm": 1,
        "units": {"length": "m", "angle": "rad"},
        "points": {"O": [0, 0]},
        "guides": {"x": {"through": [0, offset], "angle": 0}},
        "links": {
            "1": {"points": ["O", "A"], "length": 0.1},
            "2": {"points": ["A", "B"], "length": 0.4},
            "3": {"points": ["B"], "slides": {"on": "x"}},
        },
        "driver": {"link": 1, "speed": 10},
        "sketch": {"at": 1, "B": [0.45, offset]},
    }


def test_a_four_bar_transmits_worst_with_the_crank_on_the_line_of_the_frame():
    (found,) = results_of(FOUR_BAR, "kinematics").pressure
    r, coupler, rocker, frame = 0.1, 0.35, 0.25, 0.4

    def transmission(diagonal: float) -> float:
        return math.acos((coupler**2 + rocker**2 - diagonal**2) / (2 * coupler * rocker))

    angles = [transmission(frame - r), math.pi - transmission(frame + r)]
    least = min(angles)
    assert found.link == "3" and not found.slides
    assert abs(found.transmission - least) < 1e-9
    # one of the two positions of the crank on the line of the frame, up to the flat top of the maximum
    where = 0.0 if least == angles[0] else math.pi
    assert abs(math.remainder(found.place - where, 2 * math.pi)) < 1e-6
    assert abs(found.gain - 1 / math.sin(least)) < 1e-8
    # and the other extreme in the other one
    assert found.other == pytest.approx(math.pi / 2 - max(angles), abs=1e-9)
    assert abs(math.remainder(found.other_place - (math.pi - where), 2 * math.pi)) < 1e-6


@pytest.mark.parametrize("offset", [0.0, 0.05, -0.08])
def test_a_crank_slider_transmits_worst_with_the_crank_square_to_the_path(offset):
    (found,) = results_of(slider(offset), "kinematics").pressure
    assert found.slides
    assert abs(math.sin(found.largest) - (0.1 + abs(offset)) / 0.4) < 1e-12
    assert abs(math.cos(found.place)) < 1e-6
    assert math.sin(found.other) == pytest.approx((0.1 - abs(offset)) / 0.4, abs=1e-12)
    assert math.sin(found.other_place) == pytest.approx(-math.sin(found.place), abs=1e-9)


def test_without_masses_the_useful_force_is_that_of_the_pressure_angle():
    """A rocker with a moment of 20 N m: P Q along the rocker's circle is the moment over its length, whatever P is."""
    problem = FOUR_BAR | {"loads": {"M": {"on": 3, "moment": -20}}, "gravity": [0, 0]}
    results = results_of(problem, "forces")
    (transmitted,) = find_transmitted_forces(results.motion, results.reactions)
    assert (transmitted.link, transmitted.pair) == ("3", "B")
    assert transmitted.useful == pytest.approx(np.full(12, 20 / 0.25), rel=1e-12)
    assert transmitted.useful == pytest.approx(transmitted.driving * np.cos(results.pressure[0].angles), rel=1e-12)


def test_a_stone_gives_its_slotted_link_all_of_its_force():
    results = solved("slotted-lever")
    (transmitted,) = find_transmitted_forces(results.motion, results.reactions)
    couple = results.reactions.of(transmitted.pair).couple
    assert np.max(np.abs(couple)) < 1  # N m, of the inertia of the stone
    assert transmitted.useful == pytest.approx(transmitted.driving, rel=1e-3)


def test_a_stone_pushes_its_slotted_link_square_to_it():
    problem = {
        "tmm": 1,
        "units": {"length": "m", "angle": "rad"},
        "points": {"O": [0, 0], "C": [0, -0.3]},
        "links": {
            "1": {"points": ["O", "A"], "length": 0.1},
            "2": {"points": ["A"], "slides": {"on": 3, "along": "CD"}},
            "3": {"points": ["C", "D"], "length": 0.6},
        },
        "driver": {"link": 1, "speed": 10},
        "sketch": {"at": 1, "D": [0.1, 0.29]},
    }
    (found,) = results_of(problem, "kinematics").pressure
    assert found.link == "3" and found.largest < 1e-12


def test_an_offset_slot_is_pushed_at_the_angle_of_its_offset():
    problem = {
        "tmm": 1,
        "units": {"length": "m", "angle": "rad"},
        "points": {"O": [0, 0], "C": [0, -0.3]},
        "links": {
            "1": {"points": ["O", "A"], "length": 0.1},
            "2": {"points": ["A"], "slides": {"on": 3, "through": [0, 0.05], "angle": 0}},
            "3": {"points": ["C", "D"], "length": 0.6},
        },
        "driver": {"link": 1, "speed": 10},
        "sketch": {"at": 1, "D": [0.1, 0.29]},
    }
    (found,) = results_of(problem, "kinematics").pressure
    # the stone is nearest to C when the crank points down: sin(angle) = offset / distance
    assert abs(math.sin(found.largest) - 0.05 / 0.2) < 1e-12


def test_the_verdict_is_by_the_defaults_or_by_the_file():
    (by_default,) = results_of(slider(0.08), "kinematics").pressure
    assert by_default.allowed == math.radians(30) and by_default.holds
    strict = slider(0.08) | {"checks": {"pressure_sliding": "20 deg"}}
    (by_file,) = results_of(strict, "kinematics").pressure
    assert by_file.allowed == pytest.approx(math.radians(20)) and not by_file.holds


def test_at_every_position_it_is_the_angle_of_the_force_to_the_velocity():
    results = results_of(slider(0.05) | {"loads": {"F": {"on": 3, "force": [-100, 0]}}, "gravity": 0})
    (found,) = results.pressure
    force, velocity = results.reactions.of("B").onto("3"), results.motion.named("B").v
    moving = np.abs(velocity) > 1e-6
    cosine = np.abs((force * np.conj(velocity)).real) / np.abs(force) / np.abs(velocity)
    assert np.allclose(np.cos(found.angles[moving]), cosine[moving], rtol=0, atol=1e-12)


def test_a_link_driven_in_two_pairs_has_the_angle_of_their_power():
    """The lead of a class IV contour: without other forces the drawn reactions are those of the definition."""
    results = results_of(
        {
            "tmm": 1,
            "units": {"length": "mm", "angle": "deg"},
            "points": {"O": [0, 0], "G": [310, 110]},
            "links": {
                "1": {"points": ["O", "A"], "length": 52},
                "2": {"points": {"A": [0, 0], "B": [110, 0], "C": [40, 195]}},
                "3": {"points": ["B", "D"], "length": 260},
                "4": {"points": {"G": [0, 0], "D": [265, 0], "E": [145, 5]}},
                "5": {"points": ["C", "E"], "length": 295},
            },
            "driver": {"link": 1, "speed": 5},
            "positions": {"count": 24},
            "sketch": {"at": 90, "B": [95, -5], "C": [135, 198], "D": [308, -156], "E": [311, -36]},
            "loads": {"M": {"on": 4, "moment": -60}},
            "gravity": 0,
        }
    )
    (found,) = results.pressure
    assert found.link == "4" and found.pair == "D, E"
    power, most = 0.0, 0.0
    for name in "DE":
        force, velocity = results.reactions.of(name).onto("4"), results.motion.named(name).v
        power = power + (force * np.conj(velocity)).real
        most = most + np.abs(force) * np.abs(velocity)
    assert np.allclose(power, 60 * results.motion.link("4").omega, rtol=1e-12)
    assert np.allclose(np.cos(found.angles), np.abs(power) / most, rtol=0, atol=1e-12)
    assert found.largest >= np.max(found.angles)


def test_it_is_a_right_angle_at_an_end_where_the_rocker_is_stretched():
    problem = FOUR_BAR | {"links": FOUR_BAR["links"] | {"1": {"points": ["O", "A"], "length": 0.3}}}
    problem |= {"positions": {"count": 4}}
    results = results_of(problem, "kinematics")
    (found,), limits = results.pressure, results.driver_range.limits
    assert found.largest == math.pi / 2 and found.transmission == 0 and math.isinf(found.gain)
    assert found.place in [limit.place for limit in limits], "coupler and rocker in line: 0.6 from A to D"
    assert abs(math.hypot(0.3 * math.cos(found.place) - 0.4, 0.3 * math.sin(found.place)) - 0.6) < 1e-12


def test_it_is_a_right_angle_at_a_change_point_too():
    """Coupler and rocker in line, as long as crank and frame together."""
    lengths = {"1": 0.1, "2": 0.3, "3": 0.2}
    links = {name: link | {"length": lengths[name]} for name, link in FOUR_BAR["links"].items()}
    (found,) = results_of(FOUR_BAR | {"links": links}, "kinematics").pressure
    assert found.largest == math.pi / 2 and found.transmission == 0 and math.isinf(found.gain)
    assert math.cos(found.place) == pytest.approx(-1)


def test_an_angle_as_large_as_allowed_is_allowed_and_one_of_several_pairs_is_zero_where_all_push_along():
    """Forces of 45 deg on a link that is held in a circle by several cranks; rounding may add to it."""
    (pressure,) = solved("four-bars/transfer").pressure
    assert pressure.largest == pytest.approx(math.pi / 4, abs=1e-14) and pressure.holds
    assert np.all(pressure.angles[1::3] == 0) and np.all(pressure.angles[::3] > 0.7)


def test_an_angle_that_stays_the_same_is_the_largest_at_the_beginning_of_the_way():
    results = solved("settings/spring-return-rod")
    tappet = results.pressure[2]
    assert np.ptp(tappet.angles) < 1e-14
    assert tappet.place == results.driver_range.start


def test_a_parallelogram_drawn_at_any_angle_has_its_largest_angle_at_its_change_points():
    """There a place of the scan may be the change point itself, where no angle is known."""
    for drawn_at in (0, 40):
        b, c = math.radians(drawn_at), math.radians(drawn_at + 60)
        results = results_of(
            {
                "tmm": 1,
                "units": {"length": "m", "angle": "rad"},
                "points": {"O": [0, 0], "C": [0.4 * math.cos(b), 0.4 * math.sin(b)]},
                "links": {
                    "1": {"points": ["O", "A"], "length": 0.1},
                    "2": {"points": ["A", "B"], "length": 0.4},
                    "3": {"points": ["C", "B"], "length": 0.1},
                },
                "driver": {"link": 1, "speed": 10},
                "sketch": {
                    "at": c,
                    "B": [0.4 * math.cos(b) + 0.1 * math.cos(c), 0.4 * math.sin(b) + 0.1 * math.sin(c)],
                },
            },
            "kinematics",
        )
        (pressure,) = results.pressure
        assert pressure.largest == pytest.approx(math.pi / 2, abs=1e-6)
