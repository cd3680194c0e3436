"""Tables and words of wheels, racks, cams, cylinders, springs, friction, several drivers and several outputs."""

from __future__ import annotations

import numpy as np
import pytest
from higher import PROBLEMS
from test_draw_pairs import solved

from tmm_cli import solve
from tmm_cli.problem import build_problem, read_text
from tmm_cli.reports import explain_tables, tables


def table(name, of):
    return next(t for t in tables(solved(of)) if t.name == name)


def rows(found):
    return list(zip(*(column.values for column in found.columns), strict=True))


@pytest.mark.parametrize(
    ("name", "roles"),
    [
        ("gear", ["gear wheel", "gear wheel", "coupler", "slider"]),
        ("planet", ["carrier", "planet", "coupler", "slider"]),
        ("rack", ["crank", "coupler", "rack", "gear wheel"]),
        ("flat follower", ["cam", "follower", "coupler", "rocker"]),
        ("swinging follower", ["cam", "follower", "coupler", "slider"]),
        ("cylinder", ["cylinder", "piston", "rocker"]),
        ("two cylinders", ["rocker", "coupler", "cylinder", "piston", "cylinder", "piston"]),
    ],
)
def test_links_have_the_names_of_the_field(name, roles):
    assert list(table("links", name).columns[1].values) == roles


@pytest.mark.parametrize(
    ("name", "kind", "words"),
    [
        ("gear", "gears: 1", "gears (G)"),
        ("rack", "gears with racks: 1", "gear and rack (K)"),
        ("flat follower", "cams with followers: 1", "cam and follower (C)"),
    ],
)
def test_higher_pairs_are_counted_and_named(name, kind, words):
    facts = dict(rows(table("structure", name)))
    assert facts["number of lower pairs p1"].startswith("5 (") and facts["number of higher pairs p2"] == f"1 ({kind})"
    assert facts["mobility W = 3n - 2 p1 - p2"] == "3*4 - 2*5 - 1 = 1"
    assert words in table("pairs", name).columns[2].values


def test_of_lower_pairs_alone_the_count_is_the_usual_one():
    facts = dict(rows(table("structure", "two cranks")))
    assert facts["mobility W = 3n - 2 p1"] == "3*4 - 2*5 = 2" and "number of higher pairs p2" not in facts


def test_the_cycle_has_every_driver_every_output_and_what_both_ways_give():
    found = {c.header: np.array(c.values, object) for c in table("cycle", "two cranks").columns}
    for link in "23":
        assert {f"angle of link {link}", f"omega of link {link}", f"epsilon of link {link}"} <= set(found)
    # crank 4 goes back twice as fast; both are in their places of the sketch together
    assert np.allclose(
        np.degrees(np.float64(found["phi of link 4"])), np.mod(90 - 2 * (np.arange(0, 360, 30) - 30), 360)
    )
    total = np.float64(found["M_b of link 1"]) - 2 * np.float64(found["M_b of link 4"])
    assert np.allclose(total, np.float64(found["sum reduced to link 1, force plan"]))
    assert np.allclose(total, np.float64(found["sum reduced to link 1, Zhukovsky lever"]))


def test_with_one_driver_the_cycle_says_plainly_what_balances_it():
    headers = [c.header for c in table("cycle", "gear").columns]
    assert headers[-3:] == ["M_b, force plan", "M_b, Zhukovsky lever", "difference, %"]


def told(name):
    return {t.name: rows(t) for t in explain_tables(solved(name))}


def test_explain_lists_wheels_with_their_law_and_pitch_radii():
    assert told("planet")["meshes"] == [
        ("g", "internal gearing", "frame, 2", "1", "phi_2 = 3 phi_0", "180 mm, 60 mm", "20 deg")
    ]
    assert told("gear")["meshes"][0][4:6] == ("phi_2 = -0.5 phi_1", "60 mm, 120 mm")
    assert told("rack")["meshes"] == [("k", "gear and rack", "4, 3", "frame", "s_3 = 50 phi_4", "50 mm", "20 deg")]


def test_explain_lists_the_law_of_a_cam_piece_by_piece():
    pieces = told("flat follower")["cams"]
    assert pieces[0] == ("c", "1", "2", "1", "0 deg", "120 deg", "40 mm", "sine", "100 mm")
    assert [row[7] for row in pieces] == ["sine", "dwell", "3-4-5", "dwell"]
    assert pieces[-1][5] == "360 deg" and pieces[-1][8] == "60 mm"  # back where it began


def test_explain_lists_springs_friction_and_all_drivers():
    assert told("cylinder")["springs"] == [("s", "frame, 3", "[520, -120], [200, 0]", "2000 N/m", "120 mm", "20 N", "")]
    assert told("swinging follower")["springs"][0][3:5] == ("6 N*m/rad", "170 deg")
    assert told("friction")["friction"] == [
        ("O", "0.1", "15 mm"),
        ("A", "0.1", "15 mm"),
        ("B", "0.1", "15 mm"),
        ("x", "0.1", "none (prismatic pair)"),
    ]
    assert told("two cranks")["drivers"][1] == (
        "4",
        "frame",
        "E",
        "rotates",
        "12.5664 rad/s",
        "clockwise",
        "90 deg",
    )
    assert told("cylinder")["drivers"] == [("2", "1", "A'", "slides", "0.1 m/s", "extending", "260 mm")]


@pytest.mark.parametrize("name", PROBLEMS)
def test_explain_says_nothing_of_what_is_not_there(name):
    found = set(told(name))
    text = PROBLEMS[name]
    for block, key in (("gears:", "meshes"), ("cams:", "cams"), ("springs:", "springs"), ("friction:", "friction")):
        assert (key in found) == (block in text) or (key == "meshes" and "racks:" in text)
    assert ("drivers" in found) == ("- {link" in text or ", on: 1, speed" in text)


def test_a_sketch_at_the_end_of_a_stroke_hides_no_stroke():
    """Sketched at its outer dead centre, the crank-slider has its seam at the inner one."""
    strokes = solved("friction").strokes
    assert strokes.travel == pytest.approx(0.16) and len(strokes.strokes) == 2


def test_speeds_of_toothed_wheels_stand_in_turns_a_minute_too():
    found, units = table("link-motion", "gear"), solved("gear").problem.units
    omega, n = (next(c for c in found.columns if c.header == header) for header in ("omega", "n"))
    assert n.heading(units) == "n, rpm" and found.columns.index(n) == found.columns.index(omega) + 1
    np.testing.assert_allclose(n.numbers(units), omega.array * 30 / np.pi, rtol=1e-15)
    assert "n" not in [column.header for column in table("link-motion", "two cranks").columns]


def test_what_is_positive_does_not_depend_on_how_the_driver_turns_and_stands_below_the_tables():
    """A crank bears the same weight at its end however it turns: M_b is the same, its power is not."""
    text = """tmm: 1
gravity: 0
points: {O: [0, 0]}
links:
  1: {points: [O, A], length: 60}
driver: {link: 1, speed: 10 rad/s, turns: WAY}
sketch: {at: 0}
masses: {1: {mass: 1 kg, centre: A}}
loads: {F: {on: 1, at: A, force: [0, -100]}}
positions: {at: [0]}
"""
    ccw, cw = (solve(build_problem(read_text(text.replace("WAY", way), "x.yaml"))) for way in ("ccw", "cw"))
    assert ccw.reactions.balance.moment[0] == pytest.approx(6) == cw.reactions.balance.moment[0]
    assert ccw.lever.balancing[0] == pytest.approx(6) == cw.lever.balancing[0]
    assert (ccw.energy.drivers[0], cw.energy.drivers[0]) == (pytest.approx(60), pytest.approx(-60))
    assert (ccw.motion.link("1").omega[0], cw.motion.link("1").omega[0]) == (10, -10)
    told = {table.name: " ".join(table.notes) for table in tables(cw)}
    for name in ("cycle", "balance", "link-motion"):
        assert (
            "positive counterclockwise, whatever the direction of rotation of the driver: a negative M_b acts clockwise"
            in told[name]
        )
    assert (
        "A power that accelerates the mechanism is positive" in told["energy"]
        and "Counterclockwise moments are positive" in told["lever"]
    )
