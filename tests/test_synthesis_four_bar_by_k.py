"""Four-bars by k and the rocker's extreme positions: what was asked comes back, all else is refused."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from test_synthesis_crank_slider import MET

from tmm_cli import solve
from tmm_cli.batch import prepare_batch
from tmm_cli.mechanics.linkage import FRAME, Sketch
from tmm_cli.mechanics.numerics import find_roots
from tmm_cli.problem import ProblemError, read_text
from tmm_cli.synthesis import (
    SHORTEST_ARC,
    FourBarByKSolution,
    FourBarByKTask,
    FourBarLinks,
    Infeasible,
    admissible_arcs,
    build_synthesised,
    choose_pivot,
    classify_four_bar,
    four_bar_at,
    k_of,
    largest_beta,
    largest_w,
    measure_demands,
    sample_arc,
)

LINKAGE = """
points: {A: [xA, yA], D: [30, -20]}
links:
  1: {points: [A, B], length: l1}
  2: {points: [B, C], length: l2}
  3: {points: [D, C], length: CD}
driver: {link: 1, speed: 2 rad/s, turns: SENSE}
sketch: {at: phi2, C: [30 + CD*cos(psi2), -20 + CD*sin(psi2)]}
output: 3
"""


def problem(more, psi1="50 deg", psi2="105 deg", k=1.2, driver="ccw"):
    text = (
        f"tmm: 1\nparameters: {{CD: 200, psi1: {psi1}, psi2: {psi2}}}\n"
        f"synthesis: {{task: four-bar-by-k, l3: CD, psi1: psi1, psi2: psi2, k: {k}, support: [30, -20]{more}}}\n"
    )
    return build_synthesised(read_text(text + LINKAGE.replace("SENSE", driver), "x.yaml"))


def drawn(seed, way, count=1000, least=0.0):
    """Many feasible tasks, with a place on one of the arcs of each."""
    a = np.random.default_rng(seed).random((7, count))
    half = 0.05 + 1.35 * a[0]
    side = np.where((a[1] < 0.5) & (half < 1.2), 1, -1)
    most = np.where(side > 0, np.pi / 2 - half, np.pi / 2 + half)
    theta = np.minimum(least + (0.9 * most - least) * a[2], 2.6)
    psi1 = 7 * a[3] - 3.5
    task = FourBarByKTask(
        l3=0.02 * 100 ** a[4], psi1=psi1, psi2=psi1 + way * 2 * half, k=k_of(theta), support=a[5] - 0.5 + 0.3j
    )
    beta = largest_beta(task, side) * (0.05 + 0.85 * a[6])
    w = np.where(theta > 0, np.sin(beta + theta / 2) / np.sin(np.maximum(theta, 1e-9) / 2), 1.1 + 10 * a[6])
    return task, w, side


def on_mechanism(task, found):
    """Extreme angles of the rocker (rad), k, and the largest pressure angle, measured on the motion of many four-bars.

    Strokes end where the rocker stands still, and the pressure angle is extreme where coupler and rocker turn alike.
    """
    first = problem(", l4: 300").linkage
    variants, middle = [], (task.psi1 + task.psi2) / 2
    c2 = task.support + task.l3 * np.exp(1j * task.psi2)
    columns = (found.l1, found.l2, task.l3 + 0 * found.l1, found.a, task.support + 0 * found.a, c2)
    for l1, l2, l3, a, d, c in zip(*columns, strict=True):
        links = {
            FRAME: replace(first.links[FRAME], points={"A": complex(a), "D": complex(d)}),
            "1": replace(first.links["1"], points={"A": 0j, "B": complex(l1)}),
            "2": replace(first.links["2"], points={"B": 0j, "C": complex(l2)}),
            "3": replace(first.links["3"], points={"D": 0j, "C": complex(l3)}),
        }
        sketch = Sketch(float(np.angle(c - a)), {"C": complex(c)})
        variants.append(replace(first, links=first.links | links, sketch=sketch))
    motion = prepare_batch(variants, forces=False, own_places=True)
    scan = np.tile(np.linspace(0, 2 * np.pi, 361)[:-1], (len(variants), 1))
    step, here = scan[0, 1], motion(scan)
    back = np.exp(-1j * middle)[:, None]

    def rocker(motion):
        return np.angle((motion["C.x"] - task.support[:, None]) * back)

    def pressure(motion):
        return np.angle((motion["C.x"] - motion["B.x"]) * np.conj(motion["C.x"] - task.support[:, None]) * turned)

    coupler = (here["C.x"] - here["B.x"]) * np.conj(here["C.x"] - task.support[:, None])
    turned = np.where(coupler[:, :1].imag > 0, -1j, 1j)

    def extremes(values, speed):
        for pick in (np.argmax, np.argmin):
            q = np.take_along_axis(scan, pick(values, axis=1)[:, None], axis=1)
            yield find_roots(lambda x: speed(motion(x)), q - step, q + step)

    last, first_end = extremes(rocker(here), lambda m: m["3.omega"])
    ends = [rocker(motion(q))[:, 0] + middle for q in (first_end, last)]
    way = np.mod(last - first_end, 2 * np.pi)[:, 0]
    slow = np.maximum(way, 2 * np.pi - way)
    angles = [pressure(motion(q))[:, 0] for q in extremes(pressure(here), lambda m: m["2.omega"] - m["3.omega"])]
    return ends, slow / (2 * np.pi - slow), np.max(np.abs(angles), axis=0), np.where(way > np.pi, 1, -1)


def comes_back(task, found):
    """All that was asked for is there, in the order of the positions; and the sense of the crank is as told."""
    ends, k, pressure, sense = on_mechanism(task, found)
    way = 1 if np.all(task.psi2 > task.psi1) else -1
    for value, wanted in zip(ends, (task.psi1, task.psi2)[::way], strict=True):
        assert np.max(np.abs(value - wanted)) < MET * math.pi
    assert np.abs(ends[1] - ends[0]) == pytest.approx(task.swing, rel=MET, abs=0)
    assert k == pytest.approx(task.k, rel=MET, abs=0)
    assert pressure == pytest.approx(found.pressure, rel=MET, abs=0)
    assert np.all((sense * way == found.sense) | (k < 1 + 1e-9))


@pytest.mark.parametrize("way", [1, -1])
def test_k_and_both_extreme_angles_come_back_anywhere_on_the_arcs(way):
    task, w, side = drawn(1, way)
    comes_back(task, four_bar_at(task, w, side))


def test_with_k_of_1_the_pivots_lie_on_the_line_of_both_ends():
    task, _, side = drawn(2, 1)
    task = replace(task, k=np.ones(1000))
    found = four_bar_at(task, 1.05 + 10 * np.random.default_rng(3).random(1000), side)
    comes_back(task, found)
    c1, c2 = (task.support + task.l3 * np.exp(1j * psi) for psi in (task.psi1, task.psi2))
    assert np.max(np.abs(np.imag((found.a - c1) / (c2 - c1)))) < MET
    assert found.l1 == pytest.approx(np.abs(c2 - c1) / 2, rel=1e-14)


def test_what_hundreds_of_choices_ask_for_comes_back():
    task, w, side = drawn(4, 1, 300, least=0.05)
    family, chosen = four_bar_at(task, w, side), []
    for n in range(300):
        one = FourBarByKTask(*(float(v[n]) for v in (task.l3, task.psi1, task.psi2, task.k)), complex(task.support[n]))
        way = ("best", "l4", "near", "level", "xA", "yA")[n % 6]
        if way == "level":  # turned until the pivot of the family is as high as D
            turn = -float(np.angle(family.a[n] - task.support[n]))
            task.psi1[n], task.psi2[n] = one.psi1 + turn, one.psi2 + turn
            one = replace(one, psi1=one.psi1 + turn, psi2=one.psi2 + turn)
        place = complex(family.a[n])
        f = choose_pivot(replace(one, choose=way, l4=float(family.l4[n]), near=place, xA=place.real, yA=place.imag))
        if way in ("xA", "yA"):
            there = (f.a.real, place.real) if way == "xA" else (f.a.imag, place.imag)
            assert abs(there[0] - there[1]) < MET * f.l4
            assert f.pressure <= family.pressure[n] * (1 + 1e-9)
        if way == "l4":
            assert f.l4 == pytest.approx(family.l4[n], rel=MET, abs=0)
            assert f.pressure <= family.pressure[n] * (1 + 1e-9)
        if way == "near":
            assert abs(f.a - family.a[n]) < 1e-7 * family.l4[n]
        if way == "level":
            assert abs(f.a.imag - 0.3) < MET * f.l4
        if way == "best":
            assert f.pressure <= family.pressure[n] * (1 + 1e-12)
        chosen.append(f)
    comes_back(
        task,
        FourBarByKSolution(
            *(np.array([getattr(f, name) for f in chosen]) for name in FourBarByKSolution.__dataclass_fields__)
        ),
    )


def test_every_pivot_of_the_arcs_makes_a_crank_and_none_beyond_them_keeps_both_positions_on_one_side():
    task, _, _ = drawn(5, 1, 50)
    for n in range(50):
        one = FourBarByKTask(*(float(v[n]) for v in (task.l3, task.psi1, task.psi2, task.k)), complex(task.support[n]))
        c1, c2 = (one.support + one.l3 * np.exp(1j * psi) for psi in (one.psi1, one.psi2))
        for side in (-1, 1):
            beta = np.linspace(0, (np.pi - one.theta) / 2, 402)[1:-1]
            f = four_bar_at(one, np.sin(beta + one.theta / 2) / np.sin(one.theta / 2), side)
            inside = beta < largest_beta(one, side)
            turns = classify_four_bar(FourBarLinks(f.l1, f.l2, one.l3, f.l4)).turns[:, 0]
            assert np.all(turns)  # every circle's triangles make a crank; the sides of AD decide
            sides = [np.imag((f.a - one.support) * np.conj(c - one.support)) for c in (c1, c2)]
            same = sides[0] * sides[1] > 0
            sure = np.abs(beta - largest_beta(one, side)) > 1e-9
            assert np.all((same == inside)[sure])
            seen = np.angle((c2 - f.a) / (c1 - f.a))
            assert np.abs(seen) == pytest.approx(one.theta, rel=1e-9)
            assert f.beta == pytest.approx(beta, rel=1e-9, abs=1e-12)


def test_the_frame_grows_or_shrinks_all_along_an_arc_and_the_slope_is_that_of_the_pivot():
    task, _, _ = drawn(6, 1, 200, least=0.02)
    for n in range(200):
        one = FourBarByKTask(*(float(v[n]) for v in (task.l3, task.psi1, task.psi2, task.k)), complex(task.support[n]))
        for side in admissible_arcs(one):
            w = sample_arc(one, side)
            f = four_bar_at(one, w, side)
            assert np.unique(np.sign(np.diff(f.l4[50:]))).size == 1
            x = np.linspace(w[0], w[-1], 9)[2:-2]
            step = 1e-6 * (w[-1] - w[0])
            rough = (four_bar_at(one, x + step, side).a - four_bar_at(one, x - step, side).a) / (2 * step)
            assert four_bar_at(one, x, side).slope == pytest.approx(rough, rel=1e-5)


def test_the_pressure_angle_is_a_right_angle_at_the_ends_of_the_arcs():
    one = FourBarByKTask(1.0, 0.3, 1.4, 1.25)
    for side in admissible_arcs(one):
        assert float(four_bar_at(one, largest_w(one, side), side).pressure) == pytest.approx(np.pi / 2, abs=1e-6)
        assert float(four_bar_at(one, 1.0, side).pressure) == pytest.approx(np.pi / 2, abs=1e-6)


def test_the_best_transmission_of_goessner_to_his_printed_digits():
    # S. Goessner, crocker (crank-rocker design), Examples/optimal.js: d = 120, psi = 80 deg, k = 10/9 printed with
    # a = 46.7, b = 116, c = 73.9, least transmission angle 37.7 deg; any size of the rocker gives the same shape
    f = choose_pivot(FourBarByKTask(1.0, 0.0, math.radians(80), 10 / 9))
    size = 120 / f.l4
    assert (round(f.l1 * size, 1), round(f.l2 * size), round(size, 1)) == (46.7, 116, 73.9)
    assert round(90 - math.degrees(f.pressure), 1) == 37.7


def test_the_crank_rocker_of_goessner_with_a_given_crank_and_frame():
    # the same, Examples/simple.js: a = 60, d = 120 printed with b = 103, c = 94, least transmission angle 35 deg
    one = FourBarByKTask(1.0, 0.0, math.radians(80), 10 / 9, sense=1)
    (side,) = admissible_arcs(one)

    def crank(x):
        f = four_bar_at(one, x, side)
        return f.l1 / f.l4 - 0.5

    w = find_roots(crank, np.array([1.001]), np.array([float(largest_w(one, side))]))
    f = four_bar_at(one, w, side)
    size = 120 / f.l4[0]
    assert (round(f.l2[0] * size), round(size)) == (103, 94)
    assert round(90 - math.degrees(f.pressure[0])) == 35


@pytest.mark.parametrize(
    "more",
    [
        "",
        ", l1: 60",
        ", l2: 250",
        ", l4: 300",
        ", choose: supports level",
        ", near: [300, 40]",
        ", turns: cw",
        ", pressure: 55 deg",
        ", xA: xF",
        ", yA: yF",
    ],
)
@pytest.mark.parametrize("angles", [("50 deg", "105 deg"), ("100 deg", "60 deg"), ("0", "-70 deg")])
def test_the_ordinary_stages_measure_what_was_asked(more, angles):
    if angles[0] != "50 deg":
        more = more.replace("supports level", "best transmission").replace(
            "[300, 40]", "[220, 10]" if angles[0] == "0" else "[-100, 150]"
        )
    x, y = {"50 deg": (200, 60), "100 deg": (-90, 150), "0": (200, 60)}[angles[0]]
    found = problem(more.replace("xF", str(x)).replace("yF", str(y)), *angles)
    for m in measure_demands(found.synthesis.outcome, solve(found, "kinematics")):
        assert m.difference <= MET, m


def test_the_told_sense_of_the_crank_is_that_whose_slow_stroke_leads_from_psi1_to_psi2():
    for sense in ("ccw", "cw"):
        strokes = solve(problem(f", turns: {sense}", driver=sense), "kinematics").strokes
        (slow,) = strokes.working
        assert slow.run == pytest.approx(math.radians(55), rel=1e-12)


def refusal(more, **angles):
    with pytest.raises(ProblemError) as caught:
        problem(more, **angles)
    return str(caught.value).partition(": synthesis")[2]


REFUSED = [
    (
        ", near: [-300, -40]",
        {},
        (
            ".near: the nearest point of the admissible arcs is the end of an arc, where the rocker reaches a "
            "dead position"
        ),
        "[-300, -40]",
        "nearest feasible value: near[0]: ",
    ),
    (
        "",
        {"k": 5},
        (
            ".k: k is too large for this swing angle: for every pivot A on the circle the rocker would pass "
            "through a dead position or nearly reach it"
        ),
        "5",
        "nearest feasible value: ",
    ),
    (
        "",
        {"k": 0.8},
        (
            ".k: k must be 1 or more: it is the duration of the working stroke divided by that of the shorter "
            "return stroke"
        ),
        "0.8",
        "nearest feasible value: ",
    ),
    (
        "",
        {"k": 1},
        (
            ".k: with k = 1 there is no best pivot: the farther away A is, the closer the largest pressure "
            "angle comes to psi/2"
        ),
        "1",
        "nearest feasible value: ",
    ),
    (
        "",
        {"psi2": "50 deg"},
        ".psi2: the swing angle of the rocker must be greater than 0 and less than 180 deg",
        "'psi2'",
        "nearest feasible value: ",
    ),
    (
        ", l4: 900",
        {},
        ".l4: no pivot A on the admissible arcs satisfies this condition",
        "900",
        "nearest feasible value: ",
    ),
    (
        ", l4: 100",
        {},
        ".l4: no pivot A on the admissible arcs satisfies this condition",
        "100",
        "nearest feasible value: ",
    ),
    (", l4: -3", {}, ".l4: this value is too small for a mechanism", "-3", "0.001 mm or more"),
    (
        ", l4: 900, turns: ccw",
        {},
        ".l4: no pivot A on the admissible arcs satisfies this condition",
        "900",
        "nearest feasible value: ",
    ),
    (
        ", turns: cw",
        {"k": 2.6},
        ".turns: with this sense of rotation of the crank the slow stroke leads from psi2 to psi1",
        "'cw'",
        "ccw",
    ),
    (
        ", choose: supports level",
        {"psi1": "80 deg", "psi2": "85 deg"},
        ".choose: no pivot A on the admissible arcs satisfies this condition",
        "'supports level'",
        "best transmission",
    ),
    (
        ", yA: 500",
        {},
        ".yA: no pivot A on the admissible arcs satisfies this condition",
        "500",
        "nearest feasible value: yA: 495.295 mm",
    ),
    (
        ", xA: -90",
        {},
        ".xA: no pivot A on the admissible arcs satisfies this condition",
        "-90",
        "nearest feasible value: xA: 144.727 mm",
    ),
    (
        ", l4: 300, choose: supports level",
        {},
        ": give only one condition for the pivot A",
        "choose and l4",
        "one of choose, pressure, l1, l2, l4, near, xA, yA",
    ),
    (
        ", pressure: 35 deg",
        {},
        ".pressure: no pivot A on the admissible arcs gives this largest pressure angle",
        "'35 deg'",
        "nearest feasible value: pressure: 48.168 deg",
    ),
    (
        ", pressure: 90 deg",
        {},
        ".pressure: the largest pressure angle must be less than 90 deg",
        "'90 deg'",
        "nearest feasible value: pressure: 89.9",
    ),
    (
        ", l1: 95",
        {},
        ".l1: no pivot A on the admissible arcs satisfies this condition",
        "95",
        "nearest feasible value: ",
    ),
    (
        ", l1: 70",
        {"k": 1},
        ".l1: with k = 1 the crank length is always half of C1C2",
        "70",
        "other input data; changing this value alone does not help",
    ),
    (
        ", l2: 60",
        {},
        ".l2: no pivot A on the admissible arcs satisfies this condition",
        "60",
        "nearest feasible value: ",
    ),
    (
        ", l2: 60",
        {"k": 1},
        ".l2: no pivot A on the admissible arcs satisfies this condition",
        "60",
        "nearest feasible value: ",
    ),
]


@pytest.mark.parametrize(("more", "angles", "reason", "found", "allowed"), REFUSED)
def test_what_cannot_be_is_refused_with_the_reason_and_the_nearest_that_can(more, angles, reason, found, allowed):
    assert refusal(more, **angles).startswith(f"{reason}\n  found:   {found}\n  allowed: {allowed}")


def test_a_circle_is_cut_twice_by_the_level_of_the_support_even_where_it_only_just_passes_it():
    # the pivots of this arc are from 2.2e-6 below D to 1.99 above it
    one = FourBarByKTask(1.0, 0.4301902709955578, 1.1314720235491965, 1.1067413188268937, choose="level", sense=-1)
    f = choose_pivot(one)
    assert abs(f.a.imag) < 1e-14 and f.pressure < np.radians(89)
    beta = largest_beta(one, 1) * np.linspace(0, 1, 2_000_001)[1:-1]
    along = four_bar_at(one, np.sin(beta + one.theta / 2) / np.sin(one.theta / 2), 1)
    (crossings,) = np.nonzero(np.diff(np.sign(along.a.imag)))
    assert len(crossings) == 2 and f.pressure == pytest.approx(np.min(along.pressure[crossings]), abs=1e-5)


def test_pivots_as_high_as_the_support_are_found_wherever_there_are_some():
    task, _, _ = drawn(9, 1, 50, least=0.02)
    for n in range(50):
        one = FourBarByKTask(*(float(v[n]) for v in (task.l3, task.psi1, task.psi2, task.k)), choose="level")
        scan = [four_bar_at(one, sample_arc(one, side), side).a.imag for side in admissible_arcs(one)]
        if any(np.any(np.diff(np.sign(offsets))) for offsets in scan):
            f = choose_pivot(one)
            assert abs(f.a.imag) < MET * f.l4
        else:
            with pytest.raises(Infeasible):
                choose_pivot(one)


@pytest.mark.parametrize("way", ["best", "level", "near", "xA", "yA"])
def test_a_support_that_is_far_away_takes_no_digits(way):
    one = FourBarByKTask(1.0, 0.3, 1.2, 1.15, choose=way, near=2.25 - 0.5j if way == "near" else None, xA=1.5, yA=-0.5)
    here = choose_pivot(one)
    for far in (2.0**20, 2.0**20 * 1j):  # places beside it are exact in doubles
        there = choose_pivot(
            replace(
                one,
                support=far,
                near=None if one.near is None else one.near + far,
                xA=1.5 + np.real(far),
                yA=-0.5 + np.imag(far),
            )
        )
        assert (there.w, there.l1, there.l2, there.l4) == (here.w, here.l1, here.l2, here.l4)


def test_the_nearest_k_and_l4_that_are_told_are_the_bounds():
    one = FourBarByKTask(0.2, math.radians(50), math.radians(105), 1.2)
    most = float(k_of(np.pi / 2 + one.swing / 2 - SHORTEST_ARC))
    assert (
        admissible_arcs(replace(one, k=most * (1 - 1e-6))) == [-1]
        and admissible_arcs(replace(one, k=most * (1 + 1e-9))) == []
    )
    for side in admissible_arcs(one):
        end = float(four_bar_at(one, largest_w(one, side), side).l4)
        assert choose_pivot(replace(one, choose="l4", l4=end - 1e-6)).l4 == pytest.approx(end - 1e-6, rel=1e-12)
    with pytest.raises(Infeasible):
        choose_pivot(replace(one, choose="l4", l4=end + 1e-6))


def test_a_given_crank_or_coupler_is_taken_with_the_better_transmission_of_both_arcs():
    one = FourBarByKTask(0.2, math.radians(50), math.radians(105), 1.2)
    for name, value in (("l1", 0.088), ("l2", 0.25)):
        found = choose_pivot(replace(one, choose=name, **{name: value}))
        assert getattr(found, name) == pytest.approx(value, rel=1e-14)
        other = choose_pivot(replace(one, choose=name, sense=-int(found.sense), **{name: value}))
        assert getattr(other, name) == pytest.approx(value, rel=1e-14) and other.pressure > found.pressure


def test_a_wished_pressure_angle_is_met_by_the_smaller_of_all_mechanisms_that_have_it():
    task = FourBarByKTask(0.2, math.radians(50), math.radians(105), 1.2, choose="pressure", pressure=math.radians(55))
    chosen = choose_pivot(task)
    assert chosen.pressure == pytest.approx(task.pressure, rel=1e-12)
    for side in admissible_arcs(task):
        family = four_bar_at(task, sample_arc(task, side), side)
        near = np.abs(family.pressure - task.pressure) < 2e-3
        assert np.all(family.l2[near] + family.l4[near] > 0.98 * (chosen.l2 + chosen.l4))


def test_with_k_of_1_the_family_is_a_line_and_any_longer_frame_is_there():
    found = problem(", l4: 400", k=1)
    outcome = found.synthesis.outcome
    assert outcome.notes == ("with k = 1 the circle becomes the line C1C2: A may be any of its points beyond C1",)
    for m in measure_demands(outcome, solve(found, "kinematics")):
        assert m.difference <= MET, m
    at_height = problem(", yA: 130", k=1).synthesis.outcome.parameters
    assert at_height["yA"].value == pytest.approx(0.13, rel=1e-14)
    assert refusal(", l4: 190", k=1).startswith(".l4: no pivot A on the admissible arcs satisfies this condition")


def test_the_family_is_drawn_with_the_choice_on_it():
    drawn = {d.name: d for d in problem("").synthesis.outcome.drawings}
    assert set(drawn) == {"construction", "family-pressure", "family-lengths"}
    theta = math.pi * 0.2 / 2.2
    c1, c2 = (0.03 - 0.02j + 0.2 * np.exp(1j * math.radians(psi)) for psi in (50, 105))
    assert len(drawn["construction"].curves) == 2
    for curve in drawn["construction"].curves:
        seen = [abs(np.angle((c2 - a) / (c1 - a))) for a in curve.places if abs(a - c1) > 1e-4]
        assert seen == pytest.approx(np.full(len(seen), theta), rel=1e-9)
    *both, chosen = drawn["family-pressure"].lines
    assert float(chosen.y[0]) == pytest.approx(min(float(np.min(line.y)) for line in both), rel=1e-4)
