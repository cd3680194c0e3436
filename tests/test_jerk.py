"""Third derivatives: jerk of points and links, in tables, in a sweep and in every way of solving the motion."""

from __future__ import annotations

import csv
from dataclasses import replace

import mpmath
import numpy as np
import pytest
from bank import NAMES, solved
from models import file_of
from numpy.polynomial import chebyshev
from test_commands import tmm

from tmm_cli.batch import prepare_batch
from tmm_cli.mechanics.analysis import results_at
from tmm_cli.mechanics.groups import DriverMotion
from tmm_cli.mechanics.kinematics import compute_motion
from tmm_cli.mechanics.numerics import Dual, to_double_double, to_float

NODES = np.cos(np.pi * (np.arange(24) + 0.5) / 24)
WINDOWS = (0.04, 0.01, 0.002)  # shares of the travel of the driver; the widest is exact but where a cam changes its law
SHARES = np.array([0.0713, 0.313, 0.587, 0.861])
TO_SLOPE = (
    chebyshev.chebvander(np.zeros(1), 22)[0]
    @ chebyshev.chebder(np.eye(24))
    @ np.linalg.inv(chebyshev.chebvander(NODES, 23))
)
"""Weights of the values at Chebyshev nodes for the slope in the middle, exact for polynomials of degree 23."""


def slope_of_accelerations(results, motion, window, read):
    """The rate of an acceleration along the motion, from its values at nodes on both sides of each position."""
    way = results.closely(101)
    half = window * abs(way[-1] - way[0])
    near = compute_motion(motion.linkage, motion.kernels, (motion.q[:, None] + half * NODES).ravel(), motion.law)
    return read(near).reshape(len(motion.q), -1) @ TO_SLOPE / half * motion.rate


@pytest.fixture(params=NAMES)
def results(request):
    results = solved(request.param)
    if not isinstance(results.motion.law, DriverMotion):
        pytest.skip("the speed of the driver follows from a motor or a table")
    way = results.closely(101)
    return results_at(results, way[0] + (way[-1] - way[0]) * SHARES)


def readers(linkage):
    """Pairs of functions of a motion: acceleration of a point or link, and its jerk."""
    for link in linkage.moving:
        for point in linkage.links[link].points:
            yield lambda m, point=point: m.named(point).a, lambda m, point=point: m.jerk(point)
        yield lambda m, link=link: m.link(link).epsilon, lambda m, link=link: m.angular_jerk(link)


def test_jerk_is_the_rate_of_the_acceleration(results):
    motion = results.motion
    largest = motion.largest.acceleration * np.abs(motion.rate) ** 3 + motion.largest.speed * np.abs(
        motion.rate * motion.acceleration
    )
    for acceleration, jerk in readers(results.linkage):
        gaps = [
            np.abs(jerk(motion) - slope_of_accelerations(results, motion, window, acceleration)) for window in WINDOWS
        ]
        size = np.abs(jerk(motion)) + largest / np.minimum(motion.largest.size, 1.0)
        assert np.all(np.nanmin(gaps, axis=0) <= 1e-6 * size)


def test_a_motion_solved_in_time_is_the_same_motion(results):
    motion = results.motion
    timed = compute_motion(motion.linkage, motion.kernels, motion.q, motion.law, in_time=True)
    assert np.array_equal(timed.rate, motion.rate) and np.array_equal(timed.acceleration, motion.acceleration)
    largest = motion.largest
    spin, gain, rate = largest.speed / largest.size, largest.acceleration / largest.size, np.abs(motion.rate)
    epsilon = gain * rate**2 + spin * np.abs(motion.acceleration)
    for link in results.linkage.moving:
        one, other = timed.link(link), motion.link(link)
        for name, size in {"omega": spin * rate, "epsilon": epsilon, "first": spin, "second": gain}.items():
            assert np.all(np.abs(getattr(one, name) - getattr(other, name)) <= 1e-9 * size)
        assert np.all(np.abs(timed.first[link].v - motion.first[link].v) <= 1e-9 * largest.speed)
        assert np.all(np.abs(timed.second[link].a - motion.second[link].a) <= 1e-9 * largest.acceleration)


def test_a_trace_gives_the_jerk_of_the_stages():
    results = solved("press-class-iii")
    linkage, q = results.linkage, results.motion.q

    def read(motion, _):
        return {link: motion.angular_jerk(link) for link in linkage.moving}

    batch = prepare_batch(linkage, read, forces=False)
    assert batch.program is not None
    for link, jerk in batch(q).items():
        assert jerk == pytest.approx(results.motion.angular_jerk(link), rel=1e-10, abs=1e-6)


def test_jerk_of_a_crank_slider_to_50_digits():
    results = solved("crank-slider")
    values = {key: mpmath.mpf(value) for key, value in {"r": "0.06", "l": "0.22"}.items()}
    omega = mpmath.mpf(600) * mpmath.pi / 30
    jerk = results.motion.jerk("B")
    with mpmath.workdps(50):

        def place(t):
            angle = omega * t
            height = values["r"] * mpmath.sin(angle)
            return values["r"] * mpmath.cos(angle) + mpmath.sqrt(values["l"] ** 2 - height**2)

        for q, value in zip(results.motion.q, jerk, strict=True):
            truth = mpmath.diff(place, mpmath.mpf(float(q)) / omega, 3)
            assert value.real == pytest.approx(float(truth), abs=1e-11 * np.max(np.abs(jerk)))


def test_jerk_grows_with_the_cube_of_the_speed():
    motion = solved("shaper").motion
    doubled = replace(motion.law, rate=2 * motion.law.rate)
    fast = compute_motion(motion.linkage, motion.kernels, motion.q, doubled)
    assert fast.jerk("E") == pytest.approx(8 * motion.jerk("E"), rel=1e-12, abs=1e-9)


def test_jerk_in_double_doubles_confirms_that_in_floats():
    motion = solved("six-bar").motion
    exact = compute_motion(motion.linkage, motion.kernels, to_double_double(motion.q), motion.law)
    for link in motion.linkage.moving:
        both = motion.angular_jerk(link), to_float(exact.angular_jerk(link))
        assert both[0] == pytest.approx(both[1], rel=1e-9, abs=1e-9 * np.max(np.abs(both[1])))


def test_sweep_and_table_show_the_same_jerk(tmp_path):
    file = tmp_path / "crank.yaml"
    file.write_text(file_of("crank-slider").read_text() + "  jb: {of: jerk of B, over: largest}\n")
    assert tmm("run", file, "-o", tmp_path, "--no-drawings").returncode == 0
    rows = list(csv.DictReader((tmp_path / "crank" / "properties.csv").open()))
    (shown,) = (row for row in rows if row["property"] == "jb")
    assert shown["unit"] == "m/s^3"
    assert tmm("sweep", file, "--over", "r=60..70:2", "--show", "jerk_B", "-o", tmp_path).returncode == 0
    (table,) = (tmp_path / "crank-sweep").glob("sweep.csv")
    swept = next(csv.DictReader(table.open()))
    assert float(swept["jerk of B, m/s^3"]) == pytest.approx(float(shown["value"]), rel=1e-9)


DERIVATIVES = (  # function, its derivative
    (lambda x: (x + 2) * (3 - x) / (1 + x), lambda x: ((1 - 2 * x) * (1 + x) - (x + 2) * (3 - x)) / (1 + x) ** 2),
    (np.sqrt, lambda x: 0.5 / np.sqrt(x)),
    (lambda x: np.sin(x) * np.cos(2 * x), lambda x: np.cos(x) * np.cos(2 * x) - 2 * np.sin(x) * np.sin(2 * x)),
    (lambda x: np.arctan2(x, 2.0), lambda x: 2 / (4 + x * x)),
    (lambda x: np.abs(x + 1j * x * x), lambda x: (x + 2 * x**3) / np.sqrt(x * x + x**4)),
    (lambda x: np.where(x > 1, x**3, -x), lambda x: np.where(x > 1, 3 * x**2, -1)),
    (lambda x: np.maximum(x, 1.0) + np.minimum(x * x, 1.0), lambda x: np.where(x > 1, 1.0, 2 * x)),
    (lambda x: np.stack([x, x * x], axis=-1)[..., 1], lambda x: 2 * x),
)


@pytest.mark.parametrize(("function", "derivative"), DERIVATIVES)
def test_a_dual_number_carries_the_derivative(function, derivative):
    x = np.array([0.3, 0.9, 1.7])
    both = function(Dual(x, np.ones(3)))
    assert both.value == pytest.approx(function(x), rel=1e-15)
    assert both.slope == pytest.approx(derivative(x), rel=1e-14)


def test_jerk_is_refused_where_a_motor_gives_the_law_of_motion(tmp_path):
    file = tmp_path / "motor.yaml"
    file.write_text(file_of("shaper-motor").read_text() + "shows:\n  j: {of: jerk of E, at: 3}\n")
    ended = tmm("run", file, "-o", tmp_path, "--no-drawings")
    assert ended.returncode == 2
    message = "shows.j.of: the jerk is computed only for a driver with constant speed or constant acceleration"
    assert message in ended.stderr
