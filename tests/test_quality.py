"""Limits of the driver, ends of strokes and dead positions against the equations that define them, in 50 digits."""

from __future__ import annotations

import math
from pathlib import Path

import mpmath as mp
import numpy as np
import pytest
from models import SI, results_of

from tmm_cli import solve
from tmm_cli.mechanics.analysis import motion_at_positions
from tmm_cli.problem import build_any_problem, read_text
from tmm_cli.reports import walk

PROBLEMS = Path(__file__).parents[1] / "problems"
DIGITS = 1e-12  # rad (m for a cylinder)


pytestmark = pytest.mark.usefixtures("fifty_digits")


def case(points, links, driver, sketch, **more):
    return {"tmm": 1, "units": SI, "points": points, "links": links, "driver": driver, "sketch": sketch, **more}


def four_bar(a, b, c, d, at, B, **more):
    """Crank OA = a, coupler AB = b, rocker DB = c; D is at the place d."""
    links = {
        "1": {"points": ["O", "A"], "length": a},
        "2": {"points": ["A", "B"], "length": b},
        "3": {"points": ["D", "B"], "length": c},
    }
    return case({"O": [0, 0], "D": list(d)}, links, {"link": "1", "speed": 1}, {"at": at, "B": list(B)}, **more)


def quality(results):
    """Rows of the table Quality by their words."""
    (table,) = walk(results, ["quality"])
    names, values, units = (column.values for column in table.columns)
    return dict(zip(names, zip(values, units, strict=True), strict=True))


def test_a_rocker_has_a_stroke_along_its_arc_and_k_both_ways():
    rows = quality(results_of(four_bar(0.1, 0.35, 0.25, (0.4, 0), 1, (0.35, 0.25), output="3"), "kinematics"))
    # the rocker's ends: crank and coupler on one line; angles of the triangles with the frame at D and at O
    at_d, at_o = (
        [math.acos((own**2 + 0.4**2 - other**2) / (2 * own * 0.4)) for own, other in both]
        for both in ([(0.25, 0.45), (0.25, 0.25)], [(0.45, 0.25), (0.25, 0.25)])
    )
    swing, theta = at_d[0] - at_d[1], abs(at_o[0] - at_o[1])
    k = (math.pi + theta) / (math.pi - theta)
    assert rows["stroke H = psi*l of point B, where l is its distance from the pivot"] == (
        pytest.approx(swing * 0.25, rel=1e-12),
        "m",
    )
    assert rows["1/k = T_return/T_working"][0] == pytest.approx(1 / k, rel=1e-12)
    assert rows["angle theta = 180 deg (k - 1)/(k + 1)"][0] == pytest.approx(theta, rel=1e-11)


def crank_slider(r, rod, e, at, B, driver="1"):
    """The slider B runs along the x axis at the height e."""
    links = {
        "1": {"points": ["O", "A"], "length": r},
        "2": {"points": ["A", "B"], "length": rod},
        "3": {"points": ["B"], "slides": {"on": "x"}},
    }
    return case(
        {"O": [0, 0]},
        links,
        {"link": driver, "speed": 1},
        {"at": at, **B},
        guides={"x": {"through": [0, e], "angle": 0}},
    )


def ends(problem):
    """Places of the limits, in growing order."""
    way = results_of(problem, "kinematics").driver_range
    assert not way.full
    return sorted(limit.place for limit in way.limits)


def near(found, expected, cycle=None):
    assert len(found) == len(expected)
    for one, other in zip(found, expected, strict=True):
        off = mp.mpf(float(one)) - other
        if cycle:
            off -= cycle * mp.nint(off / cycle)
        assert abs(off) < DIGITS, (one, other)


def from_cosines(a, d, base):
    """Angle between crank a and frame d where the crank's end is at the distance `base` from the rocker's pivot."""
    return mp.acos((mp.mpf(a) ** 2 + mp.mpf(d) ** 2 - base**2) / (2 * mp.mpf(a) * mp.mpf(d)))


def test_double_rocker_stops_where_coupler_and_rocker_are_in_line():
    a, b, c, d = 0.4, 0.25, 0.3, 0.5
    stretched = from_cosines(a, d, mp.mpf(b) + mp.mpf(c))
    near(ends(four_bar(a, b, c, (d, 0), 0.6, (0.5, 0.3))), [-stretched, stretched])


def test_rocker_stops_on_both_sides_of_an_inclined_frame():
    a, b, c, d = 0.3, 0.3, 0.35, (0.3, 0.4)
    base = mp.sqrt(mp.mpf(d[0]) ** 2 + mp.mpf(d[1]) ** 2)
    turned = mp.atan2(mp.mpf(d[1]), mp.mpf(d[0]))
    most = from_cosines(a, base, mp.mpf(b) + mp.mpf(c))
    near(ends(four_bar(a, b, c, d, 1.4, (0.01, 0.59))), [turned - most, turned + most])


def test_crank_longer_than_the_rod_stops_where_the_rod_stands_across_the_guide():
    r, rod, e = 0.3, 0.2, 0.05
    top = mp.asin((mp.mpf(e) + mp.mpf(rod)) / mp.mpf(r))
    bottom = mp.asin((mp.mpf(e) - mp.mpf(rod)) / mp.mpf(r))
    near(ends(crank_slider(r, rod, e, 0.1, {"B": [0.5, 0.05]})), [bottom, top])


def test_a_piston_that_drives_stops_where_crank_and_rod_are_in_line():
    r, rod, e = 0.1, 0.35, 0.03
    far, close = (mp.sqrt((mp.mpf(rod) + s * mp.mpf(r)) ** 2 - mp.mpf(e) ** 2) for s in (1, -1))
    near(ends(crank_slider(r, rod, e, 0.35, {"A": [0.03, 0.09]}, driver="3")), [close, far])


def test_strokes_of_an_offset_crank_slider_end_where_crank_and_rod_are_in_line():
    r, rod, e = 0.1, 0.35, 0.06
    problem = crank_slider(r, rod, e, 0.7, {"B": [0.42, 0.06]})
    starts = sorted(s.start for s in results_of(problem, "kinematics").strokes.strokes)
    far = mp.asin(mp.mpf(e) / (mp.mpf(rod) + mp.mpf(r)))
    back = mp.pi + mp.asin(mp.mpf(e) / (mp.mpf(rod) - mp.mpf(r)))
    near(starts, [far, back], 2 * mp.pi)


def test_strokes_of_a_crank_rocker():
    a, b, c, d = 0.1, 0.35, 0.25, 0.3
    results = results_of(four_bar(a, b, c, (d, 0), 1.0, (0.35, 0.25)), "kinematics")

    def angle(base):
        return mp.acos((base**2 + mp.mpf(d) ** 2 - mp.mpf(c) ** 2) / (2 * base * mp.mpf(d)))

    far, back = angle(mp.mpf(b) + mp.mpf(a)), mp.pi + angle(mp.mpf(b) - mp.mpf(a))
    near(sorted(s.start for s in results.strokes.strokes), [far, back], 2 * mp.pi)


def slotted_lever(r, pivot, at):
    links = {
        "1": {"points": ["O", "A"], "length": r},
        "2": {"points": ["A"], "slides": {"on": "3", "along": "CD"}},
        "3": {"points": ["C", "D"], "length": 1.0},
    }
    A = (r * math.cos(at) - pivot[0], r * math.sin(at) - pivot[1])
    D = [pivot[k] + A[k] / math.hypot(*A) for k in (0, 1)]
    return case({"O": [0, 0], "C": list(pivot)}, links, {"link": "1", "speed": 1}, {"at": at, "D": D})


def test_strokes_of_a_slotted_lever_end_where_it_is_square_to_the_crank():
    r, pivot = 0.1, (0.02, -0.25)
    turned = mp.atan2(mp.mpf(pivot[1]), mp.mpf(pivot[0]))
    half = mp.acos(mp.mpf(r) / mp.sqrt(mp.mpf(pivot[0]) ** 2 + mp.mpf(pivot[1]) ** 2))
    results = results_of(slotted_lever(r, pivot, 0.3), "kinematics")
    starts = sorted(np.mod([s.start for s in results.strokes.strokes], 2 * np.pi))
    near(starts, sorted(mp.fmod(x + 2 * mp.pi, 2 * mp.pi) for x in (turned - half, turned + half)))


@pytest.mark.parametrize("pivot", [(0.15, -0.2), (0.13, -0.21), (0.3, 0), (-0.11, 0.17)])
def test_a_slotted_lever_as_long_as_the_crank_goes_through_where_the_stone_meets_its_pivot(pivot):
    """Also where the distance of the two comes out as exactly nothing. The lever turns half as fast as the crank: the
    stone is there twice in a cycle of two turns.
    """
    results = results_of(slotted_lever(math.hypot(*pivot), pivot, 0.7), "kinematics")
    assert results.driver_range.full and results.driver_range.turns == 2
    near([d.place for d in results.dead], [mp.atan2(*map(mp.mpf, pivot[::-1]))] * 2, 2 * mp.pi)


def test_change_points_of_an_inclined_parallelogram():
    d = (0.3, 0.2)
    length = math.hypot(*d)
    problem = four_bar(0.1, length, 0.1, d, 1.5, (0.31, 0.3))
    turned = mp.atan2(mp.mpf(d[1]), mp.mpf(d[0]))
    dead = sorted(np.mod([x.place for x in results_of(problem, "kinematics").dead], 2 * np.pi))
    near(dead, [turned, turned + mp.pi], 2 * mp.pi)


def test_change_point_of_a_four_bar_whose_links_all_come_into_one_line():
    problem = four_bar(0.125, 0.25, 0.375, (0.5, 0), 1.0, (0.3, 0.3))  # 0.125 + 0.5 = 0.25 + 0.375, without rounding
    results = results_of(problem, "kinematics")
    near([x.place for x in results.dead], [-mp.pi, mp.pi])  # once a turn: it is back where it was after two
    assert results.driver_range.turns == 2


# --- groups of class III: the plate on three rods, or on two rods and a slider

PLATE = ((0, 0), (0.3, 0), (0.15, 0.2))
PIVOTS = {"K": (0.75, 0.1), "L": (0.5, 0.75)}


def plate(x, y, t, k):
    """Place of the plate's hinge k."""
    px, py = map(mp.mpf, PLATE[k])
    return x + px * mp.cos(t) - py * mp.sin(t), y + px * mp.sin(t) + py * mp.cos(t)


def squares(one, other):
    return (one[0] - mp.mpf(other[0])) ** 2 + (one[1] - mp.mpf(other[1])) ** 2


def triad(r, rods, at, start, guide=None):
    """Problem of crank OA, rod AB, plate BCD, rod CK and rod DL (or a slider at D); its three equations."""
    x, y, t = start

    def place(k):
        px, py = PLATE[k]
        return [x + px * math.cos(t) - py * math.sin(t), y + px * math.sin(t) + py * math.cos(t)]

    links = {
        "1": {"points": ["O", "A"], "length": r},
        "2": {"points": ["A", "B"], "length": rods[0]},
        "3": {"points": dict(zip("BCD", map(list, PLATE), strict=True))},
        "4": {"points": ["C", "K"], "length": rods[1]},
        "5": {"points": ["D"], "slides": {"on": "g"}} if guide else {"points": ["D", "L"], "length": rods[2]},
    }
    points = {"O": [0, 0]} | {n: list(p) for n, p in PIVOTS.items() if n != "L" or not guide}
    guides = {"guides": {"g": {"through": list(guide[:2]), "angle": guide[2]}}} if guide else {}
    sketch = {"at": at, **{n: place(k) for k, n in enumerate("BCD")}}
    problem = case(points, links, {"link": "1", "speed": 1}, sketch, **guides)

    def equations(x, y, t, q):
        r1 = mp.mpf(r)
        first = squares(plate(x, y, t, 0), (r1 * mp.cos(q), r1 * mp.sin(q))) - mp.mpf(rods[0]) ** 2
        second = squares(plate(x, y, t, 1), PIVOTS["K"]) - mp.mpf(rods[1]) ** 2
        if guide:
            gx, gy, angle = map(mp.mpf, guide)
            D = plate(x, y, t, 2)
            return first, second, mp.cos(angle) * (D[1] - gy) - mp.sin(angle) * (D[0] - gx)
        return first, second, squares(plate(x, y, t, 2), PIVOTS["L"]) - mp.mpf(rods[2]) ** 2

    return problem, equations


def determinant(r, guide, x, y, t, q):
    """Of the equations' derivatives by x, y and t, each over 2 for a rod."""
    rows = []
    for k, pivot in enumerate(((mp.mpf(r) * mp.cos(q), mp.mpf(r) * mp.sin(q)), PIVOTS["K"], PIVOTS["L"])):
        here = plate(x, y, t, k)
        across = (here[0] - mp.mpf(pivot[0]), here[1] - mp.mpf(pivot[1]))
        if guide and k == 2:
            across = (-mp.sin(guide[2]), mp.cos(guide[2]))
        rows.append([*across, (here[0] - x) * across[1] - (here[1] - y) * across[0]])
    return mp.det(mp.matrix(rows))


def folds(problem, equations, r, guide):
    """Limits, and where in 50 digits the three equations have a double root, from a state beside each limit."""
    results = results_of(problem, "kinematics")
    found = sorted(limit.place for limit in results.driver_range.limits)
    exact = []
    for place, inside in zip(found, (1, -1), strict=True):
        motion = motion_at_positions(results, np.array([place + 1e-6 * inside]))
        pose = motion.poses["3"]
        start = (pose.x[0].real, pose.x[0].imag, np.angle(pose.z[0]), place)
        root = mp.findroot(lambda *v: (*equations(*v), determinant(r, guide, *v)), tuple(map(mp.mpf, start)))
        exact.append(root[3])
    return found, exact


@pytest.mark.parametrize(
    "r, rods, guide",
    [(0.3, (0.35, 0.3, 0.25), None), (0.25, (0.35, 0.3, 0), (0.3, 0.5, 0.1)), (0.35, (0.3, 0.3, 0.3), None)],
)
def test_limits_of_a_class_iii_group(r, rods, guide):
    problem, equations = triad(r, rods, 0.9, (0.45, 0.2, 0.4), guide)
    found, exact = folds(problem, equations, r, guide)
    near(found, exact)


def test_strokes_of_a_class_iii_group():
    """The rocker CK turns back where the determinant of the plate's equations with C held is zero."""
    problem, equations = triad(0.06, (0.4, 0.3, 0.3), 0.9, (0.42, 0.2, 0.4))
    problem["output"] = {"link": "4"}
    results = results_of(problem, "kinematics")
    for stroke in results.strokes.strokes:
        pose = motion_at_positions(results, np.array([stroke.start])).poses["3"]

        def stops(x, y, t, q):
            # velocities of plate and crank with C at rest: rows of the equations by x, y, t, and by q
            rows = [
                [
                    mp.diff(lambda *v, k=k: equations(*v)[k], (x, y, t, q), tuple(int(n == m) for m in range(4)))
                    for n in range(4)
                ]
                for k in (0, 2)
            ]
            px, py = (mp.mpf(v) for v in PLATE[1])
            still = [
                [1, 0, -px * mp.sin(t) - py * mp.cos(t), 0],
                [0, 1, px * mp.cos(t) - py * mp.sin(t), 0],
            ]
            return mp.det(mp.matrix([*rows, *still]))

        start = (pose.x[0].real, pose.x[0].imag, np.angle(pose.z[0]), stroke.start)
        root = mp.findroot(lambda *v, f=stops: (*equations(*v), f(*v)), tuple(map(mp.mpf, start)))
        near([stroke.start], [root[3]])


def test_strokes_of_a_four_stroke_engine_are_counted_from_position_0_on():
    text = (PROBLEMS / "four-stroke-engine.yaml").read_text()
    for start, first in ((0, 0.0), (90, 0.0), (200, 180.0)):
        results = solve(build_any_problem(read_text(text.replace("from: 0", f"from: {start}"), "engine.yaml")))
        (table,) = walk(results, ("quality",))
        rows = dict(zip(table.columns[0].values, table.columns[1].values, strict=True))
        assert [rows[f"driver position at the start of stroke {n}"] for n in (1, 2, 3, 4)] == pytest.approx(
            np.mod(first + 180 * np.arange(4), 720), abs=1e-6
        )
        assert not any("working" in name or "idle" in name for name in rows)
