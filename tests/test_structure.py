"""Structure and names of links, strokes, and loads that depend on them."""

from __future__ import annotations

import html
import json
import math
import re
from pathlib import Path

import numpy as np
import pytest
from bank import NAMES, REPEATED, moved, problem, solved
from models import CLASS_III, SI, results_of
from test_commands import SHAPER, tmm

from tmm_cli import solve
from tmm_cli.mechanics.analysis import results_at
from tmm_cli.mechanics.structure import (
    analyse_structure,
    basic_schemes,
    classify_linkage,
    find_contours,
    four_link_scheme,
    is_dependent,
    link_motion,
    six_bar_schemes,
)
from tmm_cli.problem import build_problem, read_text
from tmm_cli.reports import (
    collect_warnings,
    describe_link_motion,
    generalised_mobility,
    mobility_by_classes,
    mobility_with_replacements,
)

SIX = "I(0,1) -> II(2,3) -> II(4,5)"


@pytest.mark.parametrize(
    "name, formula, types, roles",
    [
        ("shaper", SIX, ["RPR", "RRP"], ["crank", "stone", "slotted link", "coupler", "slider"]),
        ("six-bar", SIX, ["RRR", "RRP"], ["crank", "coupler", "rocker", "coupler", "slider"]),
        ("course-2", SIX, ["RPR", "RPP"], ["crank", "stone", "slotted link", "stone", "slider"]),
        ("crank-rocker", "I(0,1) -> II(2,3)", ["RRR"], ["crank", "coupler", "rocker"]),
        ("double-crank", "I(0,1) -> II(2,3)", ["RRR"], ["crank", "coupler", "crank"]),
        ("sine", "I(0,1) -> II(2,3)", ["RPP"], ["crank", "stone", "slider"]),
        ("tangent", "I(0,1) -> II(2,3)", ["PRP"], ["slotted link", "stone", "slider"]),
        ("cylinder", "I(0,1) -> II(2,3)", ["RRR"], ["slider", "coupler", "rocker"]),
    ],
)
def test_formula_of_structure_types_and_names(name, formula, types, roles):
    results = moved(name)
    assert results.structure.formula == formula
    assert [g.type for g in results.structure.groups] == types
    assert list(results.roles.values()) == roles
    assert results.structure.mobility == 1
    assert results.structure.contours == len(types)


def test_a_compound_hinge_of_three_links_is_two_pairs():
    structure = moved("six-bar").structure
    assert (len(structure.links), len(structure.pairs)) == (5, 7)
    assert [(p.name, p.i, p.j) for p in structure.pairs if p.point == "B"] == [("B", "2", "3"), ("B''", "3", "4")]


@pytest.mark.parametrize("order", ["23456", "65432", "42635"])
def test_groups_do_not_depend_on_the_order_in_which_links_are_written(order):
    """Hinge B joins 2, 3 and 4, whichever is written first."""
    links = {
        "2": {"points": ["A", "B"], "length": 0.35},
        "3": {"points": ["D", "B"], "length": 0.25},
        "4": {"points": ["B", "F"], "length": 0.45},
        "5": {"points": ["F"], "slides": {"on": "x"}},
        "6": {"points": ["B"], "slides": {"on": "4", "through": "F", "angle": 0}},
    }
    links["6"] = {"points": ["B", "H"], "length": 0.3}
    links["7"] = {"points": ["H"], "slides": {"on": "y"}}
    problem = {
        "tmm": 1,
        "units": SI,
        "points": {"O": [0, 0], "D": [0.4, 0]},
        "guides": {"x": {"through": [0, 0.2], "angle": 0}, "y": {"through": [0.5, 0], "angle": 1.57}},
        "links": {"1": {"points": ["O", "A"], "length": 0.1}, **{n: links[n] for n in (*order, "7")}},
        "driver": {"link": "1", "speed": 1},
        "sketch": {"at": 0.3, "B": [0.37, 0.25], "F": [0.81, 0.2], "H": [0.5, 0.52]},
    }
    structure = results_of(problem, "structure").structure
    assert sorted(sorted(g.links) for g in structure.groups) == [["2", "3"], ["4", "5"], ["6", "7"]]
    assert len([p for p in structure.pairs if p.point == "B"]) == 3


def test_a_class_iii_group_is_named_and_solved():
    problem = build_problem(read_text(CLASS_III + "sketch: {at: 250 deg, 1: 1, 2: 38, 3: 124, 4: 29}", "iii.yaml"))
    structure = analyse_structure(problem.linkage)
    assert structure.formula == "I(0,5) -> III(1,2,3,4)"
    assert structure.groups[0].order == 3
    results = solve(problem)
    assert results.structure.mechanism_class == 3
    assert np.max(results.lever.difference[results.motion.moving]) < 1e-12


def test_coefficient_of_change_of_mean_speed_follows_from_the_geometry():
    theta = 2 * math.asin(100 / 300)
    assert moved("slotted-lever").strokes.k == pytest.approx((math.pi + theta) / (math.pi - theta), rel=1e-12)
    assert moved("slotted-lever").strokes.travel == pytest.approx(theta, rel=1e-12)
    theta = 2 * math.asin(60 / 150)
    assert moved("whitworth").strokes.k == pytest.approx((math.pi + theta) / (math.pi - theta), rel=1e-12)
    assert moved("whitworth").strokes.travel == pytest.approx(0.24, rel=1e-12)
    r, rod, e = 50, 190, 40
    stroke = math.sqrt((rod + r) ** 2 - e * e) - math.sqrt((rod - r) ** 2 - e * e)
    assert moved("crank-slider-offset").strokes.travel == pytest.approx(stroke / 1000, rel=1e-12)
    theta = math.asin(e / (rod - r)) - math.asin(e / (rod + r))
    assert moved("crank-slider-offset").strokes.k == pytest.approx((math.pi + theta) / (math.pi - theta), rel=1e-12)


def test_strokes_are_the_same_whichever_way_the_crank_turns_but_for_their_order():
    text = SHAPER.read_text(encoding="utf-8")
    one = solve(build_problem(read_text(text, "x.yaml")), "kinematics").strokes
    other = solve(build_problem(read_text(text.replace("turns: ccw", "turns: cw"), "x.yaml")), "kinematics").strokes
    assert other.travel == pytest.approx(one.travel, rel=1e-12)
    assert other.strokes[0].length == pytest.approx(one.strokes[0].length, rel=1e-12)
    assert other.strokes[0].run == pytest.approx(-one.strokes[0].run, rel=1e-12)  # the slow stroke runs back now


def test_position_0_is_the_start_of_the_working_stroke_and_loads_of_it_act_in_it_only():
    results = solved("shaper")
    speed = results.motion.slide(results.linkage.slides[1]).v
    assert abs(speed[0]) < 1e-12 * np.max(np.abs(speed))
    close = results_at(results, results.closely(721)[1:-1])
    load = next(x for x in close.loads if x.name == "F")
    speed = close.motion.slide(results.linkage.slides[1]).v
    moving = np.abs(speed) > 1e-9
    assert np.array_equal((load.force.real > 0)[moving], (speed < 0)[moving])  # resists, and only then


def test_a_load_by_table_against_the_stroke_is_interpolated_and_held_at_its_ends():
    text = SHAPER.read_text(encoding="utf-8").replace(
        "force: [1500, 0], when: working stroke",
        "force: {angle: 0, against: stroke, table: [[50, 100], [150, 300]]}, when: working stroke",
    )
    results = solve(build_problem(read_text(text, "x.yaml")))
    load = next(x for x in results.loads if x.name == "F")
    run = results.motion.slide(results.linkage.slides[1]).run
    gone = np.abs(run - results.strokes.strokes[0].low) * 1000
    working = results.strokes.share(results.motion.q, 1)
    assert load.force.real[working] == pytest.approx(np.interp(gone[working], [50, 150], [100, 300]), rel=1e-12)
    assert np.all(load.force[~working] == 0)


def test_angular_acceleration_changes_speed_along_the_way_and_time_says_when():
    text = SHAPER.read_text(encoding="utf-8").replace("turns: ccw", "turns: ccw, acceleration: 3 rad/s^2")
    motion = solve(build_problem(read_text(text, "x.yaml")), "kinematics").motion
    turned = motion.q - motion.q[0]
    start = 82 * math.pi / 30
    assert motion.rate == pytest.approx(np.sqrt(start**2 + 2 * 3 * turned), rel=1e-14)
    assert start * motion.time + 3 * motion.time**2 / 2 == pytest.approx(turned, abs=1e-13)
    # v = s' omega, a = s'' omega^2 + s' epsilon
    slide = motion.slide(motion.linkage.slides[1])
    assert slide.a == pytest.approx(slide.second * motion.rate**2 + slide.first * 3, rel=1e-13)


def test_a_balancing_force_at_the_crank_s_end_has_the_balancing_moment_and_changes_the_frame_s_reaction_only():
    text = SHAPER.read_text(encoding="utf-8")
    by_moment = solve(build_problem(read_text(text, "x.yaml"))).reactions
    by_force = solve(
        build_problem(read_text(text.replace("turns: ccw", "turns: ccw, balance: force"), "x.yaml"))
    ).reactions
    assert by_force.balance.force * 0.110 == pytest.approx(by_moment.balance.moment, rel=1e-14)
    for one, other in zip(by_moment.all[1:], by_force.all[1:], strict=True):
        assert np.array_equal(one.force, other.force)
    gap = by_moment.frames[0].force - by_force.frames[0].force
    assert gap == pytest.approx(by_force.balance.vector, rel=1e-9, abs=1e-9)


def test_a_driven_slider_is_balanced_along_its_guide():
    results = solved("cylinder")
    balance, frame = results.reactions.balance, results.reactions.frames[0]
    assert balance.moment is None
    assert np.max(np.abs(balance.vector.imag)) == 0
    assert np.max(np.abs(frame.force.real)) < 1e-12 * np.max(np.abs(frame.force))
    assert np.max(results.lever.difference) < 1e-13


@pytest.mark.parametrize("short", [0.01, 0.0001, 0.000001])
def test_a_gap_narrower_than_any_sampling_still_stops_the_crank(short):
    """Nearly a parallelogram: the crank is blocked where A and D are nearer than links 2 and 3 can fold."""
    problem = {
        "tmm": 1,
        "units": {"length": "mm", "angle": "deg"},
        "points": {"O": [0, 0], "D": [300, 0]},
        "links": {
            "1": {"points": ["O", "A"], "length": 100},
            "2": {"points": ["A", "B"], "length": 300},
            "3": {"points": ["D", "B"], "length": 100 - short},
        },
        "driver": {"link": "1", "speed": 1},
        "sketch": {"at": 60, "B": [350, 86]},
    }
    way = results_of(problem, "kinematics").driver_range
    blocked = math.acos((100**2 + 300**2 - (200 + short) ** 2) / (2 * 100 * 300))
    assert not way.full
    assert way.start == pytest.approx(blocked, rel=1e-5)


def test_a_position_where_nothing_has_an_arm_is_no_failure_of_the_lever_and_no_wrong_way_of_a_load():
    """At the end of a stroke both balancing moments may be nothing but rounding."""
    for name in NAMES[1::4]:
        alone = solve(problem(name), positions=[0])
        assert alone.lever_holds, name
        assert not any("in the direction of motion" in w for w in collect_warnings(alone)), name


def kind(name):
    """Classes of its groups with their pairs, toothed pairs, drivers: by what a problem is solved, drawn and told."""
    linkage = solved(name).linkage
    groups = {(group.title.partition("(")[0], str(group.type)) for group in analyse_structure(linkage).groups}
    return groups, {mesh.kind for mesh in linkage.meshes}, [driver.kind for driver in linkage.drivers]


def blocks(name):
    return set(solved(name).problem.source.data) - {"reference", "shows"}  # what is read off its results


def test_what_whole_bank_tests_leave_out_is_of_the_kind_of_one_that_stays_and_has_no_block_that_this_lacks():
    assert set(REPEATED.values()) <= set(NAMES)
    for name, kept in REPEATED.items():
        assert kind(name) == kind(kept), name
        assert not blocks(name) - blocks(kept), (name, kept)


def test_a_table_that_ends_before_the_stroke_does_gets_a_warning():
    text = SHAPER.read_text(encoding="utf-8").replace(
        "force: [1500, 0], when: working stroke",
        "force: {angle: 0, against: stroke, table: [[0, 100], [150, 300]]}, when: working stroke",
    )
    said = list(collect_warnings(solve(build_problem(read_text(text, "x.yaml")))))
    assert said == [
        (
            "the table of load F does not cover the whole range of its argument (stroke): beyond its first and "
            "last row, the value of that row is used; rows in fractions of the stroke (against: share of "
            "stroke) cover any stroke"
        )
    ]


@pytest.mark.parametrize(
    "name, p5, p4, w, types, kind, motions",
    [  # counted by hand on the drawings; motions of links 1, 2, ...: r rotation, t translation, p plane motion
        ("crank-slider", 4, 0, 1, [(2, "ВВП")], ("simple",), "rpt"),
        ("crank-rocker", 4, 0, 1, [(1, "ВВВ")], ("simple",), "rpr"),
        ("slotted-lever", 4, 0, 1, [(3, "ВПВ")], ("simple",), "rpr"),
        ("tangent", 4, 0, 1, [(4, "ПВП")], ("simple",), "rpt"),
        ("sine", 4, 0, 1, [(5, "ВПП")], ("simple",), "rtt"),
        ("six-bar", 7, 0, 1, [(1, "ВВВ"), (2, "ВВП")], ("complex", "several types"), "rprpt"),
        ("shaper", 7, 0, 1, [(3, "ВПВ"), (2, "ВВП")], ("complex", "several types"), "rprpt"),
        ("engine-four", 13, 0, 1, [(2, "ВВП")] * 4, ("complex", "same type"), "rptptptpt"),
        ("five-bar", 5, 0, 2, [(1, "ВВВ")], ("simple",), "rppr"),
        ("cam-lever", 5, 1, 1, [(None, ""), (2, "ВВП")], ("complex", "several types"), "rrpt"),
        ("shaking-screen", 7, 0, 1, [(None, "")], ("simple",), None),
        ("clamp", 10, 0, 1, [(1, "ВВВ"), (2, "ВВП"), (2, "ВВП")], ("complex", "combined"), "tprptpt"),
        ("parallel-couplers", 6, 0, 0, [(1, "ВВВ")], ("simple",), "rprp"),
    ],
)
def test_pairs_groups_and_motions_are_those_counted_by_hand(name, p5, p4, w, types, kind, motions):
    results = solve(problem(name), "structure")
    structure, n = results.structure, len(results.structure.links)
    assert [sum(pair.pair_class == k for pair in structure.pairs) for k in (5, 4)] == [p5, p4]
    assert 3 * n - 2 * p5 - p4 == structure.mobility == w
    assert [(group.type_number, group.letters) for group in structure.groups] == types
    assert {group.mobility for group in structure.groups} == {0}
    assert classify_linkage(structure)[1:] == kind
    if motions:
        assert "".join(link_motion(results.linkage, link)[0] for link in structure.links) == motions


def test_a_planar_pair_has_its_freedoms_class_and_code():
    pairs = {pair.name: pair for pair in moved("cam-lever").structure.pairs}
    assert [(pairs[n].freedoms, pairs[n].pair_class, pairs[n].code) for n in ("O", "x", "cam")] == [
        (1, 5, "1в"),
        (1, 5, "1п"),
        (2, 4, ""),
    ]


def test_formulas_of_mobility_have_their_numbers():
    """A cam with a rocker, a rod and a slider: n = 4, five lower pairs and a higher one; replaced, n = 5 and p1 = 7."""
    assert mobility_by_classes((4, 5, 1)) == "3*4 - 2*5 - 1 = 1"
    assert generalised_mobility((4, 5, 1)) == "3*4 - 2*5 - 1*1 = 1"
    assert mobility_with_replacements((4, 5, 1)) == "3*5 - 2*7 = 1"


@pytest.mark.parametrize(
    "kinds, scheme",
    [
        ("RRRR", "hinged four-bar"),
        ("RRRP", "crank-slider"),
        ("PRRR", "crank-slider"),
        ("RRPR", "slotted-lever"),
        ("RPRR", "slotted-lever"),
        ("RRPP", "sine"),
        ("PPRR", "sine"),
        ("RPRP", "tangent"),
        ("PRPR", "tangent"),
        ("RPPR", "double slotted-link"),
        ("PRRP", "double-slider"),
        ("RPPP", None),
    ],
)
def test_a_contour_of_four_links_has_the_name_of_the_textbooks(kinds, scheme):
    assert four_link_scheme(kinds) == scheme


@pytest.mark.parametrize(
    "name, contours_of_four, six_bar",
    [
        ("shaper", {"0-1-2-3-0": "slotted-lever", "0-3-4-5-0": "crank-slider"}, ("Watt II",)),
        # the rod at the compound hinge B belongs to the rocker (Watt II) or to the coupler (Stephenson III)
        ("six-bar", {"0-1-2-3-0": "hinged four-bar", "0-3-4-5-0": "crank-slider"}, ("Stephenson III", "Watt II")),
        ("course-2", {"0-1-2-3-0": "slotted-lever", "0-3-4-5-0": "sine"}, ("Watt II",)),
        ("cranks/double-stroke-press", {"0-1-2-3-0": "hinged four-bar"}, ("Stephenson III",)),
        ("engine-four", {f"0-1-{k}-{k + 1}-0": "crank-slider" for k in (2, 4, 6, 8)}, ()),
        ("five-bar", {}, ()),
    ],
)
def test_basic_schemes_of_the_bank(name, contours_of_four, six_bar):
    structure = solve(problem(name), "structure").structure
    assert basic_schemes(structure) == contours_of_four
    assert six_bar_schemes(structure) == six_bar


@pytest.mark.parametrize("name, dependent", [("parallel-couplers", 1), ("four-bars/transfer", 3), ("six-bar", 0)])
def test_a_contour_closed_by_a_redundant_link_is_dependent(name, dependent):
    structure = solve(problem(name), "structure").structure
    marked = [is_dependent(contour, structure) for contour in find_contours(structure.pairs, structure.links)]
    assert (marked[0], sum(marked)) == (False, dependent)


def test_motion_of_a_link_names_its_axis_or_its_guide():
    results = moved("sine")
    words = [describe_link_motion(results, link) for link in results.linkage.moving]
    assert words == ["rotates about O", "translation", "slides along guide x"]


def test_explain_gives_the_structure_in_the_words_of_a_note():
    text = tmm("explain", "problems/shaper.yaml").stdout
    assert "slotted-link mechanism 0-1-2-3-0, crank-slider mechanism 0-3-4-5-0, six-bar: Watt II." in text
    assert "type RPR (ВПВ, 3)" in text
    assert "1: rotates about O; 2: plane motion; 3: rotates about C; 4: plane motion; 5: slides along guide x." in text


def test_a_roller_is_a_link_with_a_local_freedom(tmp_path):
    """By hand: 4 links and the roller, 5 hinges and the guide, cam and roller: 3*5 - 2*6 - 1 = 2, of which Wm = 1."""
    wanted = "3·5 − 2·6 − 1 = 2, of which Wm = 1 is local: the rotation of rollers (5) does not move other links"
    for command in ("structure", "explain"):
        assert wanted in re.sub(r"\s+", " ", tmm(command, "problems/cam-lever.yaml").stdout)
    text = Path("problems/cam-lever.yaml").read_text(encoding="utf-8").replace("roller: 5", "roller: 4")
    file = tmp_path / "cam.yaml"
    file.write_text(text, encoding="utf-8")
    done = tmm("structure", str(file))
    assert done.returncode == 2
    assert "cams.cam.roller: a link already has this number" in done.stderr
    one_roller = Path("problems/cam-lever.yaml").read_text(encoding="utf-8")
    block = one_roller[one_roller.index("  cam:\n") : one_roller.index("driver:")]
    file.write_text(one_roller.replace(block, block + block.replace("  cam:\n", "  cam2:\n")), encoding="utf-8")
    done = tmm("structure", str(file))
    assert done.returncode == 2
    assert "cams.cam2.roller: a link already has this number" in done.stderr
    assert "found:   '5'" in done.stderr and "allowed: a different number for each roller" in done.stderr


@pytest.mark.parametrize(("c", "motion"), [([300, 100], "translation"), ([252, -88], "plane motion")])
def test_the_coupler_of_a_parallelogram_translates_and_that_of_an_antiparallelogram_does_not(c, motion):
    text = f"""tmm: 1
units: {{length: mm, angle: deg}}
points: {{O: [0, 0], D: [300, 0]}}
links:
  1: {{points: [O, A], length: 100}}
  2: {{points: [A, B], length: 300}}
  3: {{points: [D, B], length: 100}}
driver: {{link: 1, speed: 60 rpm}}
sketch: {{at: 90, B: {c}}}
positions: {{at: [60, 90, 120]}}
"""
    results = solve(build_problem(read_text(text, "x")), "structure")
    assert describe_link_motion(results, "2") == motion


def test_the_result_names_the_motion_that_the_table_names():
    """Both couplers of the parallelogram, which are equal and parallel to its frame, translate."""
    done = tmm("structure", "problems/parallel-couplers.yaml", "--json")
    links = json.loads(done.stdout)["structure"]["links"]
    assert [link["motion"] for link in links] == ["rotation", "translation", "rotation", "translation"]


def test_several_primary_mechanisms_have_as_many_freedoms_together():
    text = re.sub(r"\s+", " ", tmm("structure", "problems/five-bar.yaml").stdout)
    assert "primary mechanisms I(0,1), I(0,4); total mobility W = 2" in text
    assert "primary mechanisms" not in tmm("structure", "problems/shaper.yaml").stdout


@pytest.mark.parametrize(
    "name, sentences",
    [
        # K = p - n: 7 - 5; all pairs are lower
        (
            "shaper",
            (
                (
                    "Type of the kinematic chain and of the structure: closed, complex: the driver and several groups, "
                    "groups of several types."
                ),
                "Number of independent loops K = p − n: 2.",
            ),
        ),
        # p = 6 hinges on n = 4 links; the contour through the second coupler repeats the first
        ("parallel-couplers", ("Number of independent loops K = p − n: 2, including dependent ones: 1.",)),
        # five hinges on four links, 3*4 - 2*5 = 2
        (
            "five-bar",
            (
                "Primary mechanisms: I(0,1), I(0,4); total mobility W = 2.",
                "Type of the kinematic chain and of the structure: closed, simple: the driver and one group.",
            ),
        ),
        # p = 5 + 1 on n = 4 links
        (
            "cam-lever",
            (
                "Number of independent loops K = p − n: 2.",
                "With each higher pair replaced by a link with two revolute pairs: W = 3·5 − 2·7 = 1.",
            ),
        ),
    ],
)
def test_explain_and_the_note_have_the_words_of_the_structure(name, sentences, tmp_path):
    explained = re.sub(r"\s+", " ", tmm("explain", f"problems/{name}.yaml").stdout)
    done = tmm("note", f"problems/{name}.yaml", "-o", str(tmp_path))
    assert done.returncode == 0, done.stderr
    page = next(tmp_path.rglob("note.html")).read_text(encoding="utf-8")
    note = re.sub(r"\s+", " ", html.unescape(re.sub(r"<[^>]+>", "", page)))
    for sentence in sentences:
        assert sentence in explained
        assert sentence in note


def test_explain_gives_each_pair_its_class_and_code():
    told = re.sub(r"\s+", " ", tmm("explain", "problems/cam-lever.yaml").stdout)
    for pair in ("O 0-1 (5, 1в)", "x 0-4 (5, 1п)", "cam 1-2 (4)"):
        assert pair in told
