"""Four-bars by positions of their coupler: every position comes back on the motion, and what cannot be is refused."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from tmm_cli import solve
from tmm_cli.batch import prepare_batch
from tmm_cli.mechanics.linkage import Sketch
from tmm_cli.problem import ProblemError, read_text
from tmm_cli.synthesis import (
    CouplerPoses,
    CouplerPositionsTask,
    Dyads,
    Infeasible,
    build_synthesised,
    burmester_curve,
    circle_centre,
    dyads_by_rotation,
    find_dyads,
    measure_demands,
    point_at_distance,
    rate_guidance,
)
from tmm_cli.synthesis.coupler_positions import dyads as search

LINKAGE = """
points: {A: [Ax, Ay], D: [Dx, Dy]}
links:
  1: {points: [A, B], length: l1}
  2: {points: [B, C], length: l2, also: {P: [Px, Py]}}
  3: {points: [D, C], length: l3}
driver: {link: 1, speed: 1 rad/s}
sketch: {at: phi1, C: [Cx, Cy]}
output: 3
"""
LEAST = "smallest transmission angle between the first and last position"
MET = 1e-12
COUNT = 250


@cache
def problem(block):
    return build_synthesised(read_text(f"tmm: 1\nsynthesis: {{task: coupler-positions, {block}}}\n{LINKAGE}", "x.yaml"))


def random_tasks(count, seed, least=0.35):
    """Positions (m, rad) of the couplers of random four-bars, from `count` angles of their cranks in order, on one
    assembly, with a transmission angle (rad) of `least` or more all the way; pivots and pins (in the coupler's axes).
    """
    rng, kept, many = np.random.default_rng(seed), [], 4 * COUNT
    while sum(len(k[0]) for k in kept) < COUNT:
        a, d, p = rng.uniform(-1, 1, (3, many)) + 1j * rng.uniform(-1, 1, (3, many))
        l1, l2, l3 = rng.uniform(0.3, 2.0, (3, many))
        turned, start = rng.uniform(-np.pi, np.pi, (2, many))
        side = rng.choice([-1.0, 1.0], many)
        steps = rng.choice([-1.0, 1.0], many) * rng.uniform(0.25, 0.7, (count - 1, many))
        phi = start + np.concatenate([np.zeros((1, many)), np.cumsum(steps, 0)])

        def coupler(phi, a=a, d=d, l1=l1, l2=l2, l3=l3, side=side):
            b = a + l1 * np.exp(1j * phi)
            way = d - b
            inner = (l2**2 + l3**2 - np.abs(way) ** 2) / (2 * l2 * l3)
            cosine = (l2**2 + np.abs(way) ** 2 - l3**2) / (2 * l2 * np.abs(way))
            return b, np.angle(way) + side * np.arccos(np.clip(cosine, -1, 1)), inner

        fine = phi[0] + (phi[-1] - phi[0]) * np.linspace(0, 1, 200)[:, None]
        good = (np.abs(coupler(fine)[2]) < np.cos(least)).all(0) & (np.abs(d - a) > 0.3)
        b, angle, _ = coupler(phi)
        angle = angle + turned
        places = b + p * np.exp(1j * angle)
        moves = np.abs(np.angle(np.exp(1j * (angle[1] - angle[0])))) > 0.05
        rows = (places, angle, a, d, -p, -p + l2 * np.exp(-1j * turned))
        kept.append([x[..., good & moves].T for x in rows])
    return [np.concatenate(parts)[:COUNT] for parts in zip(*kept, strict=True)]


def on_mechanism(poses, one, other):
    """Places and angles of the couplers (tasks, positions) on the motion of linkages in double precision."""
    block = "positions: [[0, 0, 0], [60, 40, 15], [110, 100, 35]], B: [0, -20], C: [50, 0]"
    first = problem(block).linkage
    a, d, m, n = (np.asarray(x, complex) for x in (one.pivot, other.pivot, one.pin, other.pin))
    b, c = (np.asarray(poses.on_frame(x.pin), complex) for x in (one, other))
    linkages = []
    for k in range(len(a)):
        span = n[k] - m[k]
        local = -m[k] * span.conjugate() / abs(span)
        l1, l3 = abs(b[k, 0] - a[k]), abs(c[k, 0] - d[k])
        links = first.links | {
            "0": replace(first.links["0"], points={"A": complex(a[k]), "D": complex(d[k])}),
            "1": replace(first.links["1"], points={"A": 0j, "B": complex(l1)}),
            "2": replace(first.links["2"], points={"B": 0j, "C": complex(abs(span)), "P": complex(local)}),
            "3": replace(first.links["3"], points={"D": 0j, "C": complex(l3)}),
        }
        linkages.append(replace(first, links=links, sketch=Sketch(float(np.angle(b[k, 0] - a[k])), {"C": c[k, 0]})))
    phi = np.angle(b - a[:, None])
    left = ((d[:, None] - b).conj() * (c - b)).imag[:, 0] > 0  # a batch is assembled as its first linkage is
    places, angles = np.empty(b.shape, complex), np.empty(b.shape)
    for side in (left, ~left):
        at = prepare_batch([linkages[k] for k in np.flatnonzero(side)], forces=False, own_places=True)(phi[side])
        places[side] = at["P.x"]
        angles[side] = np.angle((at["C.x"] - at["B.x"]) / (n - m)[side, None])
    return places, angles


def comes_back(places, angles, one, other):
    poses = CouplerPoses(np.asarray(places, np.clongdouble), np.asarray(angles, np.longdouble))
    found, turned = on_mechanism(poses, one, other)
    size = np.maximum(1.0, np.abs(np.asarray(one.pivot - other.pivot, complex)))[:, None]
    assert np.max(np.abs(found - places) / size) < MET
    assert np.max(np.abs(np.angle(np.exp(1j * (turned - angles))))) < MET


def exact(places, angles):
    return CouplerPoses(np.asarray(places, np.clongdouble), np.asarray(angles, np.longdouble))


def test_three_positions_come_back_from_pins_and_from_pivots():
    places, angles, a, d, m, n = random_tasks(3, 3)
    poses = exact(places, angles)
    by_pins = [Dyads(circle_centre(poses.on_frame(pin)), pin) for pin in (m, n)]
    by_pivots = [Dyads(pivot, circle_centre(poses.in_plane(pivot))) for pivot in (a, d)]
    for found in (by_pins, by_pivots, (by_pins[0], by_pivots[1])):
        for dyads, pivot, pin in zip(found, (a, d), (m, n), strict=True):
            assert np.max(np.abs(dyads.pivot - pivot)) < 1e-6 and np.max(np.abs(dyads.pin - pin)) < 1e-6
        comes_back(places, angles, *found)


def test_two_positions_come_back_from_pins_or_pivots_and_lengths():
    places, angles, a, d, m, n = random_tasks(2, 2)
    poses, found = exact(places, angles), []
    for pivot, pin, by_pin in ((a, m, True), (d, n, False)):
        length = np.abs(poses.on_frame(pin)[:, 0] - pivot)
        ends, third, given = (poses.on_frame(pin), pivot, pin) if by_pin else (poses.in_plane(pivot), pin, pivot)
        way = ends[:, 1] - ends[:, 0]
        side = np.sign((np.conj(way) * (third - ends[:, 0])).imag)
        other = point_at_distance(ends, length, side)
        assert np.max(np.abs(other - third)) < 1e-6
        found.append(Dyads(other, given) if by_pin else Dyads(given, other))
    comes_back(places, angles, *found)


def test_four_positions_come_back_from_the_turns_of_both_links():
    places, angles, a, d, m, n = random_tasks(4, 4)
    poses, found = exact(places, angles), []
    for pivot, pin in ((a, m), (d, n)):
        arm = np.asarray(poses.on_frame(pin) - pivot[:, None], complex)
        turn = np.angle(arm[:, 1] / arm[:, 0])
        ways = [dyads_by_rotation(poses, turn, branch) for branch in (0, 1)]
        gaps = [np.nan_to_num(np.asarray(np.abs(w.pivot - pivot), float), nan=9.0) for w in ways]
        second = gaps[1] < gaps[0]
        one = Dyads(
            *(
                np.where(second, y, x)
                for x, y in ((w[0], w[1]) for w in ([x.pivot for x in ways], [x.pin for x in ways]))
            )
        )
        assert np.max(np.minimum(*gaps)) < 1e-3  # how sharply near positions tell the pivot
        found.append(one)
    comes_back(places, angles, *found)


@pytest.mark.parametrize("count", [2, 3, 4])
def test_positions_that_a_four_bar_took_in_order_have_no_defect_and_others_are_named(count):
    places, angles, a, d, m, n = random_tasks(count, 10 + count)
    one, other = Dyads(a, m), Dyads(d, n)
    there = rate_guidance(exact(places, angles), one, other)
    assert np.all(there.defect == 0) and np.all(there.least > 0.34)
    if count == 4:
        mixed = [0, 2, 1, 3]
        turned = rate_guidance(exact(places[:, mixed], angles[:, mixed]), one, other)
        assert np.mean(turned.defect == 2) > 0.9 and np.all(turned.defect[np.abs(there.turn) < np.pi] == 2)


FOUR = "[[0, 0, 0], [60, 40, 15], [110, 100, 35], [130, 170, 60]]"


@pytest.mark.parametrize(
    "block",
    [
        "positions: [[0, 0, 0], [60, 40, 15], [110, 100, 35]], B: [0, -20], C: [50, 0]",
        "positions: [[0, 0, 0], [60, 40, 15], [110, 100, 35]], A: [-150, 150], C: [50, 0]",
        "positions: [[0, 0, 0], [60, 40, 15], [110, 100, 35]], A: [0, 300], D: [-50, 300]",
        "positions: [[0, 0, 0], [60, 40, 75]], B: [0, 0], AB: 70, C: [50, 0], DC: 60",
        f"positions: {FOUR}",
        f"positions: {FOUR}, AB_turn: 10",
        f"positions: {FOUR}, DC_turn: 40, DC_branch: 2",
    ],
)
def test_the_ordinary_stages_measure_what_was_asked(block):
    found = problem(block)
    every = measure_demands(found.synthesis.outcome, solve(found, "kinematics"))
    assert len(every) >= 7
    for m in every:
        assert m.difference <= MET, m


def test_every_place_of_the_curves_guides_through_four_positions():
    poses = exact([0, 0.06 + 0.04j, 0.11 + 0.1j, 0.13 + 0.17j], np.radians([0, 15, 35, 60]))
    for branch in (0, 1):
        dyads = dyads_by_rotation(poses, np.linspace(-3.1, 3.1, 400), branch)
        radii = np.abs(poses.on_frame(dyads.pin) - dyads.pivot[:, None])
        good = np.isfinite(radii).all(-1) & (radii[:, 0] < 10)
        assert good.sum() > 50 and np.ptp(radii[good], axis=1) == pytest.approx(0, abs=1e-13)


def test_the_best_transmission_on_the_curves_is_not_beaten_by_random_links_of_them():
    found = problem(f"positions: {FOUR}").synthesis.outcome
    least = next(v.value for v in found.found if v.text == LEAST)
    poses = exact([0, 0.06 + 0.04j, 0.11 + 0.1j, 0.13 + 0.17j], np.radians([0, 15, 35, 60]))
    size, rng = 0.17**2 + 0.13**2, np.random.default_rng(1)
    dyads = [dyads_by_rotation(poses, rng.uniform(-np.pi, np.pi, 20_000), branch) for branch in rng.integers(0, 2, 2)]
    there = rate_guidance(poses, *dyads)
    (a, m), (d, n) = ((x.pivot, x.pin) for x in dyads)
    arms = [np.abs(poses.on_frame(x.pin)[..., 0] - x.pivot) for x in dyads]
    fair = np.all([(x > 0.15 * size**0.5) & (x < 2 * size**0.5) for x in (*arms, np.abs(a - d), np.abs(m - n))], 0)
    good = fair & (there.defect == 0)
    assert good.sum() > 5 and np.max(there.least[good]) <= least + 1e-6


def best_of(positions):
    """The search on Burmester's curves of positions (m, rad) itself: its dyads and how good they are."""
    places, angles = zip(*((complex(x, y), np.radians(angle)) for x, y, angle in positions), strict=True)
    task = CouplerPositionsTask(places, angles)
    limits = search.LinkLimits(0.15 * task.size, *(3 * [2 * task.size]))
    return task.poses, search.best_on_curves(task.poses, task.size, limits, {})


def random_positions(rng):
    steps = np.cumsum(rng.uniform(-0.2, 0.8, 4))
    places = 0.6 * np.arange(4) + 0.3 * (rng.uniform(-1, 1, 4) + 1j * rng.uniform(-1, 1, 4))
    return [
        [round(100 * p.real), round(100 * p.imag), round(np.degrees(a))] for p, a in zip(places, steps, strict=True)
    ]


STRIP = [[-10, 11, 8], [68, -28, -3], [108, -12, -12], [160, 29, -7]]  # sound four-bars of a strip 0.6 deg high only


def test_the_best_transmission_does_not_depend_on_how_densely_the_curves_are_laid_out(monkeypatch):
    positions = random_positions(np.random.default_rng(3))
    poses, found = best_of(positions)
    monkeypatch.setattr(search, "COUNT", 500)
    monkeypatch.setattr(search, "STARTS", 250)
    _, fine = best_of(positions)
    assert found[2] == pytest.approx(fine[2], abs=1e-6) or (found[2] < 1e-6 and fine[2] < 1e-6)
    if found[2] > 1e-6:
        there = rate_guidance(poses, *found[:2])
        assert there.defect == 0 and there.least == pytest.approx(found[2], abs=1e-9)


@pytest.mark.parametrize(
    ("positions", "least"),
    [
        (
            [[-7, -21, 29], [45, -11, 31], [100, 20, 34], [169, -27, 63]],
            59.814406,
        ),  # by AB_turn: 16.303, DC_turn: 15.403
        (STRIP, 0.613174),
        ([[11, -17, 33], [32, 7, 32], [116, -30, 24], [164, -21, 41]], 6.504174),
    ],
)
def test_a_four_bar_that_is_known_to_be_good_is_not_missed(positions, least):
    outcome = problem(f"positions: {positions}").synthesis.outcome
    assert np.degrees(next(v.value for v in outcome.found if v.text == LEAST)) > least


def test_three_positions_of_one_angle_leave_a_circle_of_pins_and_parallelograms_that_must_pass_their_change_point():
    poses = exact([0, 0.05 + 0.025j, 0.095 + 0.06j, 0.13 + 0.11j], np.radians([0, 0, 0, 20]))
    pins = burmester_curve(poses).at(0, np.linspace(0, 6, 50))
    radii = np.abs(poses.on_frame(pins.pin) - pins.pivot[:, None])
    assert np.ptp(radii, axis=1) == pytest.approx(0, abs=1e-15) and np.ptp(radii[:, 0]) == pytest.approx(0, abs=1e-15)
    with pytest.raises(Infeasible, match="branch defect"):
        find_dyads(CouplerPositionsTask(tuple(map(complex, poses.places)), tuple(map(float, poses.angles))))


ON_CIRCLE = ", ".join(f"[100*cos({t} deg), 100*sin({t} deg), 15]" for t in (0, 30, 70, 100))


@pytest.mark.parametrize("more", ["", ", AB_turn: 30", ", AB_turn: 30, DC_turn: 30"])
def test_a_coupler_that_goes_on_a_circle_without_turning_is_that_of_any_parallelogram(more):
    found = problem(f"positions: [{ON_CIRCLE}]{more}")
    outcome = found.synthesis.outcome
    numbers = {name: float(v.value) for name, v in outcome.parameters.items()}
    assert (numbers["l1"], numbers["l2"]) == pytest.approx((0.1, numbers["l4"])) and numbers["l3"] == pytest.approx(0.1)
    assert outcome.notes[0].startswith(
        "the coupler does not rotate: any parallelogram with these links AB and DC guides it"
    )
    assert next(v.value for v in outcome.found if v.text == LEAST) == pytest.approx(np.radians(40))
    for m in measure_demands(outcome, solve(found, "kinematics")):
        assert m.difference <= MET, m


REFUSED = {
    f"positions: [{ON_CIRCLE}], AB_turn: 31": (
        "synthesis.AB_turn: the coupler does not rotate, so both links must rotate through the same angle: "
        "the angle between positions 1 and 2, measured on the circle through all positions\n"
        "  found:   31\n"
        "  allowed: nearest feasible value: AB_turn: 30 deg"
    ),
    "positions: [[0, 0, 5], [10, 5, 5], [20, 10, 5], [30, 15, 5]]": (
        "synthesis.positions: the coupler does not rotate and its positions lie on a straight line: the "
        "links would be infinitely long"
    ),
    f"positions: {FOUR}, AB_turn: 15": "synthesis.AB_turn: no link of reasonable length rotates by this angle",
    f"positions: {FOUR}, AB_turn: 15.0000001": "synthesis.AB_turn: no link of reasonable length rotates by this angle",
    "positions: [[0, 0, 0], [60, 40, 15], [0, 0, 360], [130, 170, 60]]": (
        "synthesis.positions[2]: this position is given twice\n  found:   position 1\n"
    ),
    "positions: [[0, 0, 0], [60, 40, 75]], B: [0, 0], AB: 30, C: [50, 0], DC: 60": (
        "synthesis.AB: link AB is too short to reach both positions\n  found:   30\n  allowed: nearest "
        "feasible value: AB: 36.05"
    ),
    "positions: [[0, 0, 0], [50, 0, 15], [100, 0, 35]], B: [0, 0], C: [50, 0]": (
        "synthesis.B: the three positions of B lie on a straight line: the other end of the link would "
        "be infinitely far away\n"
        "  found:   [0, 0]\n"
        "  allowed: nearest feasible value: B[1]: 1 mm"
    ),
    "positions: [[0, 0, 0], [50, 0, 15], [100, 0, 35]], B: [0, 0], AB: 5, C: [50, 0]": (
        "synthesis: these keys do not determine link AB; number of positions: 3; remove: AB\n  found:   B, AB\n"
    ),
    "positions: [[0, 0, 0], [50, 0]], B: [0, 0], AB: 5, C: [50, 0]": (
        "synthesis.positions[1]: expected a point and an angle: [x, y, angle]\n"
    ),
    "positions: [[0, 0, 0], [0, 0, 30]], B: [0, 0], AB: 5, C: [50, 0], DC: 50": (
        "synthesis.B: point B is at rest between these positions, relative to the frame or to the coupler: "
        "it is the pole of the displacement. Choose another point\n"
        "  found:   [0, 0]\n"
        "  allowed: nearest feasible value: B[1]: 1 mm"
    ),
    "positions: [[0, 0, 0], [60, 40, 75]], B: [0, 0], AB: 70, C: [50, 0], DC: 150, DC_side: right": (
        "synthesis.positions: branch defect: some positions belong to the other assembly of the "
        "four-bar\n"
        "  found:   a list, number of items: 2\n"
        "  allowed: nearest feasible value: positions[1][2]: 69.3"
    ),
    "positions: [[0, 0, 0], [50, 20, 0], [100, 10, 0]], B: [0, 0], C: [0, 0]": (
        "synthesis.C: AB and DC have a common pin or pivot: this is not a four-bar\n"
        "  found:   [0, 0]\n"
        "  allowed: nearest feasible value: C[0]: 1 mm"
    ),
    "positions: [[0, 0, 0], [50, 20, 10], [100, 10, 30]], A: [0, 60], D: [0, 60]": (
        "synthesis.D: AB and DC have a common pin or pivot: this is not a four-bar\n"
    ),
    "positions: [[0, 0, 0], [0, 0, 10], [0, 0, 30], [0, 0, 60]]": (
        "synthesis.positions: no link with its ends on Burmester's curves has a reasonable length"
    ),
    "positions: [[0, 0, 0], [0, 0, 0]], B: [0, 0], AB: 5, C: [50, 0], DC: 50": (
        "synthesis.positions[1]: this position is given twice\n"
        "  found:   position 1\n"
        "  allowed: a different position, e.g. rotated by 20 deg"
    ),
}


@pytest.mark.parametrize("block", REFUSED)
def test_what_cannot_be_is_refused_with_the_reason_and_what_can(block):
    with pytest.raises(ProblemError) as caught:
        problem(block)
    assert str(caught.value).partition(": ")[2].startswith(REFUSED[block])


def told(outcome):
    """Values that were found, by their names or what they are called."""
    return {v.name or v.text: v.value for v in outcome.found}


def test_the_listed_curve_is_that_of_links_through_all_four_positions():
    (curve,) = problem(f"positions: {FOUR}").synthesis.outcome.listings
    assert curve.long and len(curve.rows) > 300
    places = np.array([0, 60 + 40j, 110 + 100j, 130 + 170j]) / 1000
    angles = np.radians([0, 15, 35, 60])
    for _, turn, ax, ay, bx, by, x1, y1, length in curve.rows[::7]:
        pins = places + complex(bx, by) * np.exp(1j * angles)
        arms = pins - complex(ax, ay)
        assert np.abs(arms) == pytest.approx(length, rel=1e-9) and pins[0] == pytest.approx(complex(x1, y1))
        assert np.angle(arms[1] / arms[0] * np.exp(-1j * turn)) == pytest.approx(0, abs=1e-9)


def test_a_pivot_near_a_wanted_place_is_the_nearest_of_the_curve_and_its_turn_and_branch_give_it_again():
    keys = f"positions: {FOUR}, defects: keep"
    (curve,) = problem(keys).synthesis.outcome.listings
    pivots = np.array([complex(row[2], row[3]) for row in curve.rows])
    for wanted in ((-40, 90), (20, 60), (150, -30)):
        outcome = problem(f"{keys}, A_near: [{wanted[0]}, {wanted[1]}], DC_turn: 5").synthesis.outcome
        found = told(outcome)
        a = complex(found["Ax"], found["Ay"])
        away = abs(a - complex(*wanted) / 1000)
        assert away == pytest.approx(found["distance of A from the preferred point"])
        assert away <= np.min(np.abs(pivots - complex(*wanted) / 1000)) + 1e-12
        branch, turn = (
            found["solution branch of AB"],
            f"{np.degrees(found['rotation of AB from position 1 to 2']):.15g}",
        )
        again = told(problem(f"{keys}, AB_turn: {turn}, AB_branch: {branch}, DC_turn: 5").synthesis.outcome)
        assert complex(again["Ax"], again["Ay"]) == pytest.approx(a, rel=1e-9)


def test_a_pivot_that_is_asked_for_on_the_curve_is_met():
    (curve,) = problem(f"positions: {FOUR}").synthesis.outcome.listings
    for row in curve.rows[10::150]:
        near = f"[{row[2] * 1000:.17g}, {row[3] * 1000:.17g}]"
        found = told(problem(f"positions: {FOUR}, D_near: {near}, AB_turn: 10, defects: keep").synthesis.outcome)
        assert found["distance of D from the preferred point"] == pytest.approx(0, abs=1e-9)


def test_free_pivots_lie_in_the_box_and_the_best_of_it_is_no_better_than_the_best_of_all():
    free = told(problem(f"positions: {FOUR}").synthesis.outcome)
    x, y = ([1000 * float(free[f"{name}{axis}"]) for name in "AD"] for axis in "xy")
    for room in (1, -0.3 * (max(x) - min(x))):  # with the best in it, and without
        low, high = (min(x) - room, min(y) - 300), (max(x) + abs(room), max(y) + 300)
        box = f"[[{low[0]}, {low[1]}], [{high[0]}, {high[1]}]]"
        found = told(problem(f"positions: {FOUR}, pivots_within: {box}, defects: keep").synthesis.outcome)
        for name in "AD":
            assert low[0] <= 1000 * found[f"{name}x"] <= high[0] and low[1] <= 1000 * found[f"{name}y"] <= high[1]
        assert found[LEAST] == pytest.approx(free[LEAST], rel=1e-4) or room < 0
        assert found[LEAST] <= free[LEAST] * (1 + 1e-4)


def test_a_box_without_a_pivot_is_refused():
    with pytest.raises(ProblemError) as caught:
        problem(f"positions: {FOUR}, AB_turn: 10, pivots_within: [[210, 290], [250, 240]]")
    assert (
        "the box contains no two pivots for which links, frame and coupler have reasonable lengths"
        in caught.value.message
    )
    with pytest.raises(ProblemError, match="pivots_within applies only to pivots that are not given"):
        problem(f"positions: {FOUR}, pivots_within: [[0, 0], [9, 9]], AB_turn: 10, DC_turn: 5")
