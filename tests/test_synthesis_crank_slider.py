"""Crank-sliders from their stroke: what was asked comes back on the mechanism, and what cannot be is refused."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from tmm_cli import solve
from tmm_cli.batch import prepare_batch
from tmm_cli.mechanics.linkage import Sketch
from tmm_cli.mechanics.numerics import find_roots
from tmm_cli.problem import ProblemError, read_text
from tmm_cli.synthesis import (
    CrankSliderTask,
    build_synthesised,
    find_crank_slider,
    k_of,
    largest_theta,
    measure_demands,
    shortest_rod,
    smallest_pressure,
    theta_of,
)

LINKAGE = """
points: {{O: [0, 0]}}
guides: {{x: {{through: [0, -e], angle: 0}}}}
links:
  1: {{points: [O, A], length: r}}
  2: {{points: [A, B], length: l}}
  3: {{points: [B], slides: {{on: x}}}}
driver: {{link: 1, speed: {speed!r} rad/s}}
sketch: {{at: 0 deg, B: [r + l, -e]}}
output: 3
"""
MET = 1e-12
shares = st.tuples(*[st.floats(0.0, 1.0, allow_subnormal=False)] * 3)
# many tasks a case: their numbers come from a seed, for hypothesis draws (and shrinks) long lists slowly
thousand = st.integers(0, 2**32 - 1).map(lambda seed: np.random.default_rng(seed).random((3, 1000)))


def metres(share):
    return 0.01 * 200**share


def problem(block, speed=1.0):
    """A file with this synthesis and a crank-slider that uses what it finds."""
    keys = ", ".join(f"{key}: {value}" for key, value in block.items())
    text = f"tmm: 1\nsynthesis: {{task: crank-slider, {keys}}}\n{LINKAGE.format(speed=speed)}"
    return build_synthesised(read_text(text, "x.yaml"))


def variants(found):
    """The linkage of the file with the lengths of many tasks."""
    first = problem({"stroke": "1 m", "ratio": 3, "nu": 0.5}).linkage
    for r, rod, e in np.broadcast(found.r, found.l, found.e):
        links = first.links | {
            "1": replace(first.links["1"], points={"O": 0j, "A": complex(r)}),
            "2": replace(first.links["2"], points={"A": 0j, "B": complex(rod)}),
        }
        sketch = Sketch(0.0, {"B": complex(r + rod, -e)})
        yield replace(first, links=links, slides=(replace(first.slides[0], through=complex(0, -e)),), sketch=sketch)


def on_mechanism(found):
    """Stroke (m), k and largest pressure angle (rad) of many crank-sliders, measured on their motion.

    Ends of strokes and the place of the steepest rod lie where the slider's speed and the rod's angular speed change
    sign; nothing of the synthesis is used.
    """
    at = prepare_batch(list(variants(found)), forces=False, own_places=True)
    count = np.size(found.r)
    scan = np.tile(np.linspace(0, 2 * np.pi, 73)[:-1], (count, 1))
    step, run, ends = scan[0, 1], at(scan)["B.x"].real, []
    for pick in (np.argmax, np.argmin):
        q = np.take_along_axis(scan, pick(run, axis=1)[:, None], axis=1)
        ends.append(find_roots(lambda x: at(x)["B.v"].real, q - step, q + step))
    far, near = ends
    stroke = (at(far)["B.x"].real - at(near)["B.x"].real)[:, 0]
    way = np.mod(near - far, 2 * np.pi)[:, 0]
    slow = np.maximum(way, 2 * np.pi - way)
    quarter = np.full((count, 1), np.pi / 2)
    here = at(find_roots(lambda x: at(x)["2.omega"], quarter - 0.3, quarter + 0.4))
    rod = here["B.x"] - here["A.x"]
    return stroke, slow / (2 * np.pi - slow), np.arctan2(np.abs(rod.imag), rod.real)[:, 0]


def comes_back(asked):
    """Every stroke, k and pressure angle asked for, or foretold, is there on the mechanism."""
    found = find_crank_slider(asked)
    for name, values in zip(("stroke", "k", "pressure"), on_mechanism(found), strict=True):
        given = getattr(asked, name)
        assert values == pytest.approx(np.broadcast_to(getattr(found, name), values.shape), rel=MET, abs=0), name
        if given is not None:
            assert values == pytest.approx(given, rel=MET, abs=0), name


@settings(max_examples=2)
@given(thousand)
def test_stroke_comes_back_from_ratio_and_offset(drawn):
    a, b, c = drawn
    comes_back(CrankSliderTask(stroke=metres(c), ratio=1.05 + 9 * a, nu=0.95 * b * (0.05 + 9 * a)))


@settings(max_examples=2)
@given(thousand)
def test_stroke_and_k_come_back_from_the_ratio(drawn):
    a, b, c = drawn
    ratio = 1.05 + 9 * a
    comes_back(CrankSliderTask(stroke=metres(c), ratio=ratio, k=k_of(0.97 * b * largest_theta(ratio))))


@settings(max_examples=2)
@given(thousand)
def test_stroke_and_offset_come_back_from_the_ratio(drawn):
    a, b, c = drawn
    ratio, stroke = 1.05 + 9 * a, metres(c)
    e = 0.97 * b * stroke * (ratio - 1) / (2 * np.sqrt(ratio))
    assert find_crank_slider(CrankSliderTask(stroke=stroke, ratio=ratio, e=e)).e == pytest.approx(e, rel=MET)
    comes_back(CrankSliderTask(stroke=stroke, ratio=ratio, e=e))


def test_stroke_offset_and_ratio_give_the_crank_of_the_printed_formula():
    """Task 1 of the source, H, e and L, as it prints the crank; here with 17 digits of its numbers."""
    h, e, length = 150.0, 20.0, 3.7
    more = (length**2 + 1) * h**2
    r = math.sqrt((more + math.sqrt(more**2 - 4 * length**2 * h**2 * (h**2 + 4 * e**2))) / (8 * length**2))
    found = find_crank_slider(CrankSliderTask(stroke=h, e=e, ratio=length))
    assert found.r == pytest.approx(r, rel=1e-14)
    assert (found.r, found.l) == pytest.approx((74.788276, 276.716621), abs=5e-7)
    assert math.degrees(found.pressure) == pytest.approx(20.0321, abs=5e-5)


@pytest.mark.parametrize(
    "keys, message",
    [
        ("e: 20", "missing: ratio or k\n  found:   e\n"),
        ("e: 20, ratio: 3.7, k: 1.1", "remove: k or e or ratio\n  found:   ratio, e, k\n"),
        (
            "e: 112, ratio: 3.7",
            (
                "synthesis.e: the crank does not rotate fully: this requires l > r + e\n"
                "  found:   112\n"
                "  allowed: nearest feasible value: e: 105.274 mm"
            ),
        ),
        ("e: -1, ratio: 3.7", "synthesis.e: the offset is a distance"),
    ],
)
def test_offset_and_ratio_are_refused_where_they_give_no_crank(keys, message):
    with pytest.raises(ProblemError) as refused:
        problem({"stroke": 150} | dict(key.split(": ") for key in keys.split(", "))).linkage  # noqa: B018
    assert message in str(refused.value)


@settings(max_examples=2)
@given(thousand)
def test_stroke_k_and_pressure_come_back_from_the_shortest_rod(drawn):
    a, b, c = drawn
    k = 1 + 1.2 * a
    least = smallest_pressure(theta_of(k))
    comes_back(CrankSliderTask(stroke=metres(c), k=k, pressure=least + (0.02 + 0.9 * b) * (1.5 - least)))


@settings(max_examples=2)
@given(thousand)
def test_stroke_and_pressure_come_back_from_the_offset(drawn):
    a, b, c = drawn
    comes_back(CrankSliderTask(stroke=metres(c), nu=3 * a, pressure=0.1 + 1.3 * b))


@settings(max_examples=2)
@given(thousand)
def test_stroke_and_k_come_back_from_the_offset_in_metres(drawn):
    a, b, c = drawn
    theta, stroke = 0.02 + 1.2 * a, metres(c)
    comes_back(CrankSliderTask(stroke=stroke, k=k_of(theta), e=(0.05 + 0.9 * b) * stroke / np.tan(theta)))


@settings(max_examples=2)
@given(thousand)
def test_the_mean_speed_comes_back(drawn):
    a, b, c = drawn
    ratio, speed = 1.2 + 5 * a, 1 + 90 * b
    found = find_crank_slider(CrankSliderTask(speed=c + 0.1, crank_speed=speed, ratio=ratio, nu=0.5 * (ratio - 1)))
    assert on_mechanism(found)[0] * speed / np.pi == pytest.approx(c + 0.1, rel=MET, abs=0)


@pytest.mark.parametrize(
    "block",
    [
        {"stroke": "120 mm", "ratio": 4, "nu": 0.5},
        {"stroke": "120 mm", "ratio": 4, "k": 1.2},
        {"speed": "0.4 m/s", "crank_speed": "15 rad/s", "ratio": 3, "nu": 0},
        {"stroke": "80 mm", "k": 1.1, "pressure": "33 deg"},
        {"stroke": "80 mm", "nu": 0.3, "pressure": "30 deg"},
        {"stroke": "50 mm", "e": "20 mm", "k": 1.5},
        {"stroke": "80 mm", "k": 1, "pressure": "20 deg"},
    ],
)
def test_the_ordinary_stages_measure_what_was_asked(block):
    found = problem(block, 15.0)
    for m in measure_demands(found.synthesis.outcome, solve(found, "kinematics")):
        assert m.difference <= MET, m


def test_no_other_length_keeps_the_pressure_angle_and_is_shorter():
    theta, limit = theta_of(1.15), math.radians(45)
    length = float(shortest_rod(theta, limit))
    shorter = np.linspace(1.0001, length * (1 - 1e-9), 5000)
    assert np.all(find_crank_slider(CrankSliderTask(stroke=1.0, k=1.15, ratio=shorter)).pressure > limit)


def test_the_least_pressure_angle_is_the_least_over_all_lengths():
    for k in (1.01, 1.2, 1.5, 2.0, 2.8):
        longest = 1 / math.tan(float(theta_of(k)) / 2) ** 2
        lengths = np.geomspace(1, longest, 200_003)[1:-1]
        least = np.min(find_crank_slider(CrankSliderTask(stroke=1.0, k=k, ratio=lengths)).pressure)
        assert float(smallest_pressure(theta_of(k))) == pytest.approx(least, rel=1e-7)


def test_h_and_nu_obey_the_relations_of_the_course():
    found = find_crank_slider(CrankSliderTask(stroke=0.12, k=1.3, ratio=3.0))
    theta = math.pi * 0.3 / 2.3
    assert found.h == pytest.approx(math.sqrt(2 * (10 - 8 * math.cos(theta))), rel=1e-14)
    assert found.nu == pytest.approx(8 * math.sin(theta) / found.h, rel=1e-14)
    far, near = math.sqrt(16 - found.nu**2), math.sqrt(4 - found.nu**2)
    assert found.h == pytest.approx(far - near, rel=1e-14)
    assert found.r == pytest.approx(0.12 / found.h, rel=1e-14)
    assert found.printed == pytest.approx(math.sqrt((found.h - 2) * 8), rel=1e-13)
    assert found.error == pytest.approx(found.printed / found.nu - 1, rel=1e-12)


def test_the_printed_nu_is_right_for_small_theta_only():
    errors = [
        float(find_crank_slider(CrankSliderTask(stroke=1.0, k=k, ratio=3.0)).error) for k in (1.001, 1.01, 1.1, 1.3)
    ]
    assert errors == sorted(errors) and errors[0] < 1e-5 and errors[-1] > 0.05


def test_the_mean_speed_gives_the_stroke_by_30_v_over_n():
    n, v = 300.0, 0.8
    found = find_crank_slider(CrankSliderTask(speed=v, crank_speed=n * math.pi / 30, ratio=4.0, nu=0.0))
    assert found.stroke == pytest.approx(30 * v / n, rel=1e-15)
    assert found.r == pytest.approx(found.stroke / 2, rel=1e-15)


def test_the_triangle_of_both_extreme_positions_worked_by_hand():
    # 3-4-5: A above B2 at e = 3 is the limit; sides l + r = 5, l - r = 3 with H = 4
    found = find_crank_slider(CrankSliderTask(stroke=4.0, ratio=4.0, nu=2.999999))
    assert (found.r, found.l) == (pytest.approx(1, rel=1e-2), pytest.approx(4, rel=1e-2))
    found = find_crank_slider(CrankSliderTask(stroke=7.0, e=12.0, k=k_of(np.arctan2(16, 12) - np.arctan2(9, 12))))
    assert (found.r, found.l) == (pytest.approx(2.5, rel=1e-14), pytest.approx(17.5, rel=1e-14))


@given(shares)
def test_a_k_just_below_the_bound_is_met_and_one_just_above_is_refused(drawn):
    ratio = 1.1 + 8 * drawn[0]
    most = float(k_of(largest_theta(ratio)))
    with pytest.raises(ProblemError, match="k is too large for this ratio"):
        problem({"stroke": 100, "ratio": ratio, "k": most * (1 + 1e-9)})
    found = problem({"stroke": 100, "ratio": ratio, "k": 1 + (most - 1) * (1 - 1e-6)})
    link = found.linkage.links
    r, rod = abs(link["1"].points["A"]), abs(link["2"].points["B"])
    assert r - found.linkage.slides[0].through.imag < rod  # e is below


@pytest.mark.parametrize(
    "keys",
    [
        {"ratio": 3, "nu": 0.5},
        {"ratio": 3, "k": 1.1},
        {"pressure": "30 deg", "nu": 0.3},
        {"pressure": "40 deg", "k": 1.1},
        {"ratio": 3, "nu": 0},
    ],
)
def test_the_approximate_nu_and_k_are_told_in_every_task(keys):
    outcome = problem({"stroke": 120, **keys}).synthesis.outcome
    told = {v.text: float(v.value) for v in (*outcome.asked, *outcome.found)}
    printed, nu = (
        told["nu by the approximation sqrt((h - 2)(L^2 - 1)) for small theta"],
        told["relative offset nu = e/r"],
    )
    approximate = math.sqrt((told["stroke-to-crank ratio h = H/r"] - 2) * (told["rod-to-crank ratio L = l/r"] ** 2 - 1))
    assert printed == pytest.approx(approximate, rel=1e-12, abs=1e-7) and told["k (time ratio)"] >= 1
    assert told["relative error of this approximation"] == pytest.approx(printed / nu - 1 if nu else 0, abs=1e-12)
