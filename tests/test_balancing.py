"""Counterweights found by least squares against what textbooks prove of them."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest

from tmm_cli import load, solve
from tmm_cli.analysis.pipeline import at_positions
from tmm_cli.dynamics.balancing import balanced, shaking

PROBLEMS = Path(__file__).parents[1] / "problems"


@cache
def turn_of(name, count=720):
    results = solve(load(PROBLEMS / f"{name}.yaml"))
    return at_positions(results, results.start + np.arange(count) * 2 * np.pi / count), results


def test_two_counterweights_balance_the_forces_of_a_four_bar():
    motion, __ = turn_of("crank-rocker")
    assert balanced(motion, {"1": 0j, "3": 0j}).left < 1e-12


def test_a_counterweight_on_the_crank_alone_leaves_a_part_of_a_crank_slider():
    motion, __ = turn_of("crank-slider")
    one, both = balanced(motion, {"1": 0j}), balanced(motion, {"1": 0j, "2": 0j})
    assert 0.1 < one.left < 1 and both.left < 1e-12
    assert np.mean(np.abs(one.after.force) ** 2) < np.mean(np.abs(one.before.force) ** 2)


def test_an_engine_of_four_cylinders_in_line_leaves_its_second_harmonic():
    motion, __ = turn_of("engine-four")
    harmonics = np.abs(np.fft.fft(shaking(motion).force)) / len(motion.q)
    assert harmonics[1] < 1e-9 * harmonics[2]


@pytest.mark.parametrize("name", ["crank-rocker", "crank-slider", "six-bar", "shaper"])
def test_what_shakes_is_the_rate_of_all_momentum(name):
    motion, results = turn_of(name)
    step = 1e-5
    ends = [at_positions(results, motion.q + sign * step) for sign in (-1, 1)]
    momentum = [sum(m.linkage.links[n].mass * m.centre(n).v for n in m.linkage.moving) for m in ends]
    rate = (momentum[1] - momentum[0]) / (2 * step) * motion.rate
    force = shaking(motion).force
    assert force == pytest.approx(-rate, abs=1e-5 * np.max(np.abs(force)))
