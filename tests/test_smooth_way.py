"""Exact change points: a machine goes smoothly through them, and the file may ask for the side of the sketch."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest
from models import PARALLELOGRAM, solved_text

from tmm_cli.analysis.pipeline import at_positions
from tmm_cli.problem.errors import ProblemError
from tmm_cli.results.reports.quality import tables
from tmm_cli.results.warnings import warnings

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
    return at_positions(results, np.linspace(driver_range.start + 0.0071, driver_range.end + 0.0071, number))


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
    said = list(warnings(moved(PARALLELOGRAM)))
    assert said[0] == (
        "change point of II(2,3) inside the cycle at 0 deg (margin 0): there the group may go over into another "
        "assembly; the results go smoothly through, as a machine that runs does (the other: `change points: keep side`)"
    )


def test_it_keeps_to_the_side_of_the_sketch_when_asked_and_becomes_an_antiparallelogram():
    results = moved(PARALLELOGRAM + "change points: keep side\n")
    motion = everywhere(results)
    half = np.mod(motion.q, 2 * np.pi) < np.pi
    assert np.allclose(motion.first["3"].w[half], 1) and np.all(motion.first["3"].w[~half] < 0)
    assert "the results keep to the side of the sketch" in next(iter(warnings(results)))
    (quality,) = tables(results)
    assert (quality.columns[0].values[0], quality.columns[1].values[0]) == ("link 3 turns in a cycle by", 0)


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


def test_a_place_is_found_alone():
    results = moved(PARALLELOGRAM)
    alone = [float(at_positions(results, np.array([q])).first["3"].w[0]) for q in (-20.0, -1.0, 1.0, 4.0, 100.0)]
    assert alone == pytest.approx([1.0] * 5)
