"""Exact change points: a machine goes smoothly through them, and the file may ask for the side of the sketch."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest
from models import PARALLELOGRAM, solved_text

from tmm_cli.mechanics.analysis import motion_at_positions
from tmm_cli.problem import ProblemError
from tmm_cli.reports import collect_warnings, quality_tables

KITE = """tmm: 1
points: {O: [0, 0], D: [100, 0]}
links:
  1: {points: [O, A], length: 100}
  2: {points: [A, B], length: 250}
  3: {points: [D, B], length: 250}
driver: {link: 1, speed: 60 rpm}
sketch: {at: 60 deg, B: [250, 200]}
"""
ISOSCELES = """tmm: 1
points: {O: [0, 0]}
guides: {x: {through: O, angle: 0}}
links:
  1: {points: [O, A], length: 100}
  2: {points: [A, B], length: 100}
  3: {points: [B], slides: {on: x}}
driver: {link: 1, speed: 60 rpm}
sketch: {at: 60 deg, B: [100, 0]}
"""
LEVER = """tmm: 1
points: {O: [0, 0], C: [0, -100]}
links:
  1: {points: [O, A], length: 100}
  2: {points: [A], slides: {on: 3, along: CD}}
  3: {points: [C, D], length: 300}
driver: {link: 1, speed: 60 rpm}
sketch: {at: 60 deg, D: [100, 200]}
"""


moved = partial(solved_text, stage="kinematics")


def everywhere(results, number=701):
    """Over the whole cycle, but for places in a change point."""
    driver_range = results.driver_range
    return motion_at_positions(results, np.linspace(driver_range.start + 0.0071, driver_range.end + 0.0071, number))


@pytest.mark.parametrize("at, B", [("60 deg", "[350, 86]"), ("-100 deg", "[283, -98]"), ("179 deg", "[200, 2]")])
def test_a_parallelogram_stays_one_wherever_its_sketch_is_drawn(at, B):
    text = PARALLELOGRAM.replace("60 deg", at).replace("[350, 86]", B)
    results = moved(text)
    motion = everywhere(results)
    assert np.allclose(motion.first["3"].w, 1, rtol=0, atol=1e-7)
    assert np.allclose(motion.poses["2"].z, 1, rtol=0, atol=1e-7)
    assert results.driver_range.full and results.driver_range.turns == 1


def test_an_antiparallelogram_stays_one_too():
    motion = everywhere(moved(PARALLELOGRAM.replace("B: [350, 86]", "B: [286, -99]")))
    assert np.all(motion.first["3"].w < 0)


def test_the_warning_says_what_is_done_and_how_to_ask_for_the_other():
    said = list(collect_warnings(moved(PARALLELOGRAM)))
    assert said[0] == (
        "change point of II(2,3) in the cycle at 0 deg (margin 0): here the group can change to another "
        "assembly; the results continue smoothly, as in a running machine (for the other branch: `change "
        "points: keep side`)"
    )


def test_it_keeps_to_the_side_of_the_sketch_when_asked_and_becomes_an_antiparallelogram():
    results = moved(PARALLELOGRAM + "change points: keep side\n")
    motion = everywhere(results)
    half = np.mod(motion.q, 2 * np.pi) < np.pi
    assert np.allclose(motion.first["3"].w[half], 1) and np.all(motion.first["3"].w[~half] < 0)
    assert "the results are for the assembly of the sketch" in next(iter(collect_warnings(results)))
    (quality,) = quality_tables.quality_tables(results)
    assert (quality.columns[0].values[0], quality.columns[1].values[0]) == ("rotation of link 3 per cycle", 0)


def test_another_word_there_is_refused():
    with pytest.raises(ProblemError, match=r"(?s)x.yaml:11:16: change points: .*allowed: smooth, keep side"):
        moved(PARALLELOGRAM + "change points: keep\n")


@pytest.mark.parametrize("text, turns", [(KITE, 2), (LEVER, 2), (ISOSCELES, 1)])
def test_other_linkages_with_change_points_move_without_a_jump(text, turns):
    """A kite (Galloway) and a lever whose stone comes over its pivot go half a turn in one of the crank."""
    results = moved(text)
    motion = everywhere(results, 1001)
    assert (results.driver_range.turns, results.driver_range.repeats) == (turns, True)
    w = motion.first["3"].v.real if text is ISOSCELES else motion.first["3"].w
    ahead = (
        np.diff(motion.poses["3"].x.real) if text is ISOSCELES else np.diff(np.unwrap(np.angle(motion.poses["3"].z)))
    )
    step = motion.q[1] - motion.q[0]
    assert np.max(np.abs(np.diff(w))) < 0.06 * np.max(np.abs(w))
    assert np.max(np.abs(ahead - step * (w[1:] + w[:-1]) / 2)) < 1e-3 * step


def chain(number):
    """So many parallelograms, the rocker of each the crank of the next."""
    links, points, places = ["  1: {points: [O0, A0], length: 100}"], ["O0: [0, 0]"], []
    for k in range(1, number + 1):
        points.append(f"O{k}: [{300 * k}, 0]")
        places.append(f"A{k}: [{300 * k + 50}, 86.6]")
        links.append(f"  c{k}: {{points: [A{k - 1}, A{k}], length: 300}}")
        links.append(f"  r{k}: {{points: [O{k}, A{k}], length: 100}}")
    return (
        f"tmm: 1\npoints: {{{', '.join(points)}}}\nlinks:\n"
        + "\n".join(links)
        + f"\ndriver: {{link: 1, speed: 60 rpm}}\nsketch: {{at: 60 deg, {', '.join(places)}}}\n"
    )


def test_a_chain_of_parallelograms_comes_back_after_one_turn():
    """All rockers go as the crank does and the couplers translate: what a group leaves of its digits moves no later
    change point away from it."""
    results = moved(chain(12))
    assert (results.driver_range.turns, results.driver_range.repeats) == (1, True)
    motion = everywhere(results, 101)
    for k in range(1, 13):
        assert np.allclose(motion.first[f"r{k}"].w, 1, rtol=0, atol=1e-6)
        assert np.allclose(motion.poses[f"c{k}"].z, 1, rtol=0, atol=1e-6)


def test_a_kite_whose_hinges_meet_has_its_rotation_in_the_table():
    """The rocker of a Galloway mechanism rotates once in two turns of the crank.

    Where A lies on D, omega_3/omega_1 is (1 + 100/250)/2, half a cycle later (1 - 100/250)/2.
    """
    results = moved(at_places(KITE, "[0, 360 deg]"))
    (quality,) = quality_tables.quality_tables(results)
    rows = dict(zip(quality.columns[0].values, quality.columns[1].values, strict=True))
    assert rows["turns of the driver per cycle"] == 2
    assert rows["rotation of link 3 per cycle"] == pytest.approx(360, abs=1e-9)  # deg
    assert results.motion.first["3"].w == pytest.approx([0.7, 0.3], rel=1e-9)


def test_a_place_is_found_alone():
    results = moved(PARALLELOGRAM)
    alone = [float(motion_at_positions(results, np.array([q])).first["3"].w[0]) for q in (-20.0, -1.0, 1.0, 4.0, 100.0)]
    assert alone == pytest.approx([1.0] * 5)


def at_places(text, places):
    """The file with these positions."""
    return f"{text.partition('positions:')[0]}positions: {{at: {places}}}\n"


def limits(text, places):
    """A motion with positions in change points, all of which are passed smoothly."""
    motion = moved(at_places(text, f"[{places}]")).motion
    assert motion.limits.any() and not motion.moving[motion.limits].any()
    assert np.array_equal(motion.limits | motion.moving, np.ones(len(motion.q), dtype=bool))
    return motion


def test_the_cranks_of_a_parallelogram_have_one_speed_in_its_change_points_too():
    text = PARALLELOGRAM.replace("speed: 60 rpm", "speed: 10 rad/s, acceleration: 3 rad/s^2")
    assert text != PARALLELOGRAM
    motion = limits(text, "0, 60, 180")
    rate = motion.rate
    assert motion.limits.tolist() == [True, False, True]
    assert motion.link("3").omega == pytest.approx(rate, rel=1e-11)
    assert motion.link("3").epsilon == pytest.approx(np.full(3, 3.0), rel=1e-8)
    assert motion.link("2").omega == pytest.approx(np.zeros(3), abs=1e-10)
    assert motion.named("B").v == pytest.approx(1j * rate * np.exp(1j * motion.q) * abs(motion.named("A").v / rate))


def test_a_crank_slider_with_a_rod_as_long_as_its_crank_passes_where_its_pins_meet():
    """s = 2 r cos(phi) and omega_2 = -omega_1, also where B lies on O."""
    motion = limits(ISOSCELES, '"90 deg", "30 deg", "270 deg"')
    omega, q = 2 * np.pi, motion.q
    assert motion.named("B").x.real == pytest.approx(0.2 * np.cos(q), abs=1e-13)
    assert motion.named("B").v.real == pytest.approx(-0.2 * omega * np.sin(q), rel=1e-10)
    assert motion.named("B").a.real == pytest.approx(-0.2 * omega**2 * np.cos(q), abs=1e-8)
    assert motion.link("2").omega == pytest.approx(np.full(3, -omega), rel=1e-10)


def test_where_the_side_of_the_sketch_is_kept_velocities_jump_and_have_no_limit():
    text = PARALLELOGRAM.replace("driver:", "change points: keep side\ndriver:")
    results = moved(at_places(text, "[0, 60]"))
    assert results.motion.limits is None and results.motion.moving.tolist() == [False, True]
    assert "position 0 (0 deg): group II(2,3) is in a dead position; velocities and forces are undefined" in list(
        collect_warnings(results)
    )


def test_a_dead_position_in_which_the_driver_turns_back_has_no_limits():
    text = PARALLELOGRAM.replace("length: 300", "length: 280")
    assert text != PARALLELOGRAM
    results = moved(text)
    end = float(results.driver_range.end)
    assert not results.driver_range.full
    motion = motion_at_positions(results, np.array([end]))
    assert motion.limits is None and not motion.moving.any()


def test_the_balancing_moment_has_its_limit_by_the_lever_and_reactions_have_none():
    """Massless parallelogram with 5 N m against its driven crank: M_b = 5 N m; the rod's force is 5/(l sin(phi))."""
    text = PARALLELOGRAM.replace("masses:", "gravity: 0\nloads: {M: {on: 3, moment: -5}}\nmasses:")
    results = solved_text(at_places(text, "[0, 60]").replace("mass: 3 kg, inertia: 0.1", "mass: 0"))
    assert results.lever.balancing == pytest.approx([5, 5], rel=1e-10)
    assert np.isnan(results.reactions.balance.moment[0]) and results.lever_holds
    said = list(collect_warnings(results))
    assert (
        "position 0 (0 deg): II(2,3) passes a change point smoothly; velocities and accelerations are "
        "limit values, reactions have no limit there"
    ) in said
