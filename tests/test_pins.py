"""Compound hinges: what the pin does to each of its links, however the hinge is counted as pairs."""

from __future__ import annotations

import csv
from dataclasses import replace
from itertools import islice, permutations
from math import factorial
from pathlib import Path

import numpy as np
import pytest
import random_linkages
from test_commands import tmm

from tmm_cli import solve
from tmm_cli.batch import read_task
from tmm_cli.grading import ReadAnswer, Submission, VariantTable, grade
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.structure import analyse_structure
from tmm_cli.problem import ProblemError, build_problem, read_text
from tmm_cli.reports import to_json

V_ENGINE = Path("tests/data/v-compressor.yaml").read_text(encoding="utf-8")
SIX_BAR = Path("problems/six-bar.yaml")
TEXT = SIX_BAR.read_text(encoding="utf-8")
PUSH = complex(300, -700)  # N, on the pin B


def pins(text):
    """The force of pin B on each link, N, and the largest of them."""
    results = solve(build_problem(read_text(text, "pins.yaml")))
    found = {pin.link: pin.force for pin in results.reactions.pins(results.linkage)}
    return found, max(np.max(np.abs(force)) for force in found.values())


def attached(text, point, link):
    """The file with the links of a compound hinge attached to one of them."""
    return text.replace("links:\n", f"hinges: {{{point}: {{attached to: {link}}}}}\nlinks:\n", 1)


def pairs_at(point, structure):
    """The pairs of a compound hinge."""
    return [(pair.name, pair.i, pair.j) for pair in structure.pairs if pair.point == point]


def pushed(link):
    """The linkage with the pin pushed, the push being put down to one of its links."""
    return pins(TEXT.replace("loads:\n", f"loads:\n  P: {{on: {link}, at: B, force: [{PUSH.real}, {PUSH.imag}]}}\n"))


def test_what_a_pin_does_to_its_links_comes_to_nothing():
    force, largest = pins(TEXT)
    assert list(force) == ["2", "3", "4"]
    assert np.max(np.abs(sum(force.values()))) < 1e-15 * largest


@pytest.mark.parametrize("link", ["2", "3", "4"])
def test_the_links_bear_the_load_on_their_pin_whichever_of_them_it_is_put_down_to(link):
    force, largest = pushed(link)
    borne = {name: f + (PUSH if name == link else 0) for name, f in force.items()}
    assert np.max(np.abs(PUSH - sum(borne.values()))) < 1e-15 * largest, "the pin itself is in equilibrium"
    other, __ = pushed("2")
    for name, f in borne.items():
        assert np.max(np.abs(f - other[name] - (PUSH if name == "2" else 0))) < 4e-15 * largest


def test_the_pin_bears_each_link_with_all_that_acts_on_it():
    """Rod 4 hangs on pin B and pin F: both forces, its weight and its inertia are in equilibrium."""
    results = solve(build_problem(read_text(TEXT, "pins.yaml")))
    force = next(pin.force for pin in results.reactions.pins(results.linkage) if pin.link == "4")
    total = force + results.reactions.of("F").onto("4") + sum(x.force for x in results.loads if x.link == "4")
    assert np.max(np.abs(total)) < 1e-15 * np.max(np.abs(force))


@pytest.mark.parametrize("link", ["2", "3"])
def test_the_pin_forces_do_not_depend_on_the_link_to_which_the_others_are_attached(link):
    results = [solve(build_problem(read_text(text, "pins.yaml"))) for text in (TEXT, attached(TEXT, "B", link))]
    usual, other = ({pin.link: pin for pin in r.reactions.pins(r.linkage)} for r in results)
    assert other[link].pairs == ("B", "B''")
    for name, pin in usual.items():
        assert np.max(np.abs(pin.force - other[name].force)) < 4e-15 * np.max(np.abs(pin.force))
    balances = [r.reactions.balance.moment for r in results]
    assert np.max(np.abs(balances[0] - balances[1])) < 4e-15 * np.max(np.abs(balances[0]))


def test_tables_and_result_json_have_a_row_a_link(tmp_path):
    assert tmm("forces", SIX_BAR).stdout.count("B, B''") == 1
    tmm("run", SIX_BAR, "--no-drawings", "-o", tmp_path)
    with next(tmp_path.rglob("pins.csv")).open(encoding="utf-8-sig") as file:
        rows = list(csv.DictReader(file))
    written = to_json(solve(build_problem(read_text(TEXT, "pins.yaml"))))["forces"]["compound_hinges"]["B"]
    for row in rows:
        position = int(row["position"])
        assert float(row["Fx, N"]) == pytest.approx(written[row["link"]]["x"][position], rel=1e-8)
    assert len(rows) == 12 * 3
    assert "Compound hinges" not in tmm("forces", "problems/crank-rocker.yaml").stdout


def rod_on_crank_pin(results, rod, piston, pin, guide, push, position):
    """The force of the crank pin on a connecting rod (N), by the equations of equilibrium of the rod and its piston.

    guide: angle of the piston's guide (rad); push: the force of the gas on the piston. Unknown are both components of
    the forces on the rod at the crank pin and at the piston pin, and the force across the guide.
    """
    motion, links = results.motion, results.linkage.links
    end = motion.named(pin).x[position]
    crank_pin = motion.named("A").x[position]
    centre, turning = motion.centre(rod), motion.link(rod)
    mass, piston_mass, g = links[rod].mass, links[piston].mass, -9.81j
    inertia = mass * (g - centre.a[position])
    couple = -links[rod].inertia * turning.epsilon[position]
    on_piston = push + piston_mass * (g - motion.named(pin).a[position])
    across = 1j * np.exp(1j * guide)
    arm, to_centre = end - crank_pin, centre.x[position] - crank_pin
    rows = np.array(
        [
            [1, 0, 1, 0, 0],
            [0, 1, 0, 1, 0],
            [0, 0, -arm.imag, arm.real, 0],
            [0, 0, -1, 0, across.real],
            [0, 0, 0, -1, across.imag],
        ]
    )
    moment = (np.conj(to_centre) * inertia).imag + couple
    right = [-inertia.real, -inertia.imag, -moment, -on_piston.real, -on_piston.imag]
    x, y = np.linalg.solve(rows, right)[:2]
    return complex(x, y)


def test_both_rods_of_a_v_engine_are_attached_to_the_crank():
    """Two rods on one crank pin: R_12 is the force of rod 2 alone, not that of the whole pin."""
    results = solve(build_problem(read_text(V_ENGINE, "v-compressor.yaml")))
    position = 10
    assert pairs_at("A", results.structure) == [("A", "1", "2"), ("A''", "1", "4")]
    assert results.structure.formula == "I(0,1) -> II(2,3), I(0,1) -> II(4,5)"
    gas = {load.name: load.force[position] for load in results.loads}
    forces = {r.pair.name: r.onto(r.on)[position] for r in results.reactions.all}
    one = rod_on_crank_pin(results, "2", "3", "B", np.radians(45), gas["p1"], position)
    two = rod_on_crank_pin(results, "4", "5", "C", np.radians(135), gas["p2"], position)
    assert forces["A"] == pytest.approx(one, rel=1e-12)
    assert forces["A''"] == pytest.approx(two, rel=1e-12)
    assert (abs(one), abs(two), abs(one + two)) == pytest.approx((4683.3, 1583.5, 5577.6), abs=0.05)
    pin = {pin.link: pin.force[position] for pin in results.reactions.pins(results.linkage)}
    assert pin["1"] == pytest.approx(-(one + two), rel=1e-12)


def test_attached_to_a_rod_the_crank_bears_the_whole_pin_in_one_pair():
    """The force of each pair is the vector sum of the forces of the pin on the links beyond it."""
    results = solve(build_problem(read_text(attached(V_ENGINE, "A", 2), "v-compressor.yaml")))
    pin = {pin.link: pin.force for pin in results.reactions.pins(results.linkage)}
    usual = solve(build_problem(read_text(V_ENGINE, "v-compressor.yaml"))).reactions
    whole = usual.of("A").onto("2") + usual.of("A''").onto("4")
    largest = np.max(np.abs(whole))
    assert pairs_at("A", results.structure) == [("A", "1", "2"), ("A''", "2", "4")]
    assert results.structure.formula == "I(0,1) -> II(2,3) -> II(4,5)"
    assert np.max(np.abs(results.reactions.of("A").onto("2") - whole)) < 1e-14 * largest
    assert np.max(np.abs(results.reactions.of("A").onto("1") - pin["1"])) < 1e-14 * largest
    assert np.max(np.abs(results.reactions.of("A''").onto("4") - usual.of("A''").onto("4"))) < 1e-14 * largest


def test_a_later_rod_may_be_attached_first():
    """Attached to rod 4 its group is solved first, and the other rod is attached to it."""
    structure = solve(build_problem(read_text(attached(V_ENGINE, "A", 4), "v-compressor.yaml")), "structure").structure
    assert pairs_at("A", structure) == [("A", "1", "4"), ("A''", "4", "2")]
    assert structure.formula == "I(0,1) -> II(4,5) -> II(2,3)"


CYLINDER = """tmm: 1
points: {O: [0, 0], Q: [200, -100], K: [-300, 0]}
links:
  1: {points: {O: [0, 0], A: [0, 150]}}
  2: {points: [Q, E], length: 100}
  3: {points: [A], slides: {on: 2, along: QE, unbounded: true}}
  4: {points: [A, C], length: 300}
  5: {points: [K, C], length: 150}
driver: {link: 3, on: 2, speed: 50 mm/s, stroke: [260, 320]}
sketch: {at: 300, A: [0, 150], C: [-290, 150]}
"""


def test_links_are_attached_to_the_driven_piston_before_the_lever_that_it_swings():
    usual = analyse_structure(build_problem(read_text(CYLINDER, "x.yaml")).linkage)
    to_lever = analyse_structure(build_problem(read_text(attached(CYLINDER, "A", 1), "x.yaml")).linkage)
    assert [(p.i, p.j) for p in usual.pairs if p.point == "A" and p.kind == "R"] == [("1", "3"), ("3", "4")]
    assert [(p.i, p.j) for p in to_lever.pairs if p.point == "A" and p.kind == "R"] == [("1", "3"), ("1", "4")]


def test_friction_in_a_compound_hinge_acts_between_the_links_that_are_attached():
    """On each rod mu r R of its own force, R_12 and R_14; the drivers' work is what friction takes more."""
    text = V_ENGINE + "friction: {coefficient: 0.1, radius: 20, pairs: {x: {coefficient: 0}, y: {coefficient: 0}}}\n"
    results = solve(build_problem(read_text(text, "v-compressor.yaml")))
    motion = results.motion
    for pair, rod in (("A", "2"), ("A''", "4")):
        slip = motion.link(rod).omega - motion.link("1").omega
        expected = -0.1 * 0.020 * np.abs(results.reactions.of(pair).force) * np.sign(slip)
        load = next(x for x in results.loads if x.kind == "friction" and x.name == f"T{pair}{rod}")
        assert np.max(np.abs(load.moment - expected)) < 1e-12 * np.max(np.abs(expected))
        back = next(x for x in results.loads if x.kind == "friction" and x.name == f"T{pair}1")
        assert np.max(np.abs(back.moment + expected)) < 1e-12 * np.max(np.abs(expected))
    assert np.max(np.abs(results.lever.difference)) < 1e-9


@pytest.mark.parametrize(
    "point, link, message, found, allowed",
    [
        ("Q", 1, "there is no hinge of that name", "'Q'", None),
        ("B", 2, "this hinge joins only two links, which form one pair, so no attachment is needed", "2, 3", None),
        ("A", 5, "link 5 does not belong to hinge A", "'5'", "1, 2, 4"),
    ],
)
def test_a_wrong_attachment_is_refused(point, link, message, found, allowed):
    with pytest.raises(ProblemError) as error:
        build_problem(read_text(attached(V_ENGINE, point, link), "v-compressor.yaml"))
    assert (error.value.message, error.value.found) == (message, found)
    assert allowed is None or error.value.allowed == allowed


def test_an_attachment_that_joins_groups_is_refused():
    """Rod 4 is placed by pin B, which coupler and rocker place: attached to it they would make one group of four."""
    with pytest.raises(ProblemError) as error:
        build_problem(read_text(attached(TEXT, "B", 4), "six-bar.yaml"))
    assert error.value.message == "if the links are attached to 4, the mechanism splits into other Assur groups"
    assert error.value.allowed == "2, 3"


def expected_link(linkage, structure, hinge):
    """The link to which the rule attaches the others, found from the groups: frame, driver, first group."""
    if FRAME in hinge.links:
        return {FRAME}
    cranks = {driver.link for driver in linkage.drivers} & set(hinge.links)
    if cranks:
        return cranks
    group = next(g for g in structure.all_groups if set(g.links) & set(hinge.links))
    own = [link for link in hinge.links if link in group.links]
    joined = [n for n in own if any({n, FRAME} == {p.i, p.j} for p in structure.pairs)]
    return {min(joined or own, key=list(linkage.links).index)}


@pytest.mark.parametrize("name", ["six-bar", "engine-four", "toggle-press", "cranks/reversing", "slotted/intermittent"])
def test_the_order_of_links_in_the_file_does_not_change_what_is_attached(name):
    linkage = build_problem(read_text(Path(f"problems/{name}.yaml").read_text(encoding="utf-8"), name)).linkage
    found = set()
    for order in islice(permutations(linkage.moving), 0, None, max(1, factorial(len(linkage.moving)) // 60)):
        links = {name: linkage.links[name] for name in (FRAME, *order)}
        hinges = tuple(replace(h, links=tuple(n for n in links if n in h.links)) for h in linkage.hinges)
        structure = analyse_structure(replace(linkage, links=links, hinges=hinges))
        found.add(frozenset((p.point, frozenset((p.i, p.j))) for p in structure.pairs if p.kind == "R"))
    assert len(found) == 1


@pytest.mark.parametrize("seed", range(12))
def test_links_of_a_compound_hinge_are_attached_by_the_rule_in_random_chains(seed):
    linkage = random_linkages.linkage(seed, ("RRR", "RRR", "RRP", "RRR"))
    structure = analyse_structure(linkage)
    for hinge in linkage.hinges:
        pairs = [{p.i, p.j} for p in structure.pairs if p.point == hinge.point and p.kind == "R"]
        assert len(pairs) == len(hinge.links) - 1
        assert expected_link(linkage, structure, hinge) & set.intersection(*pairs)


def marked(answers):
    """States of the answers of a student of the V engine, sizes in N by quantity, at position 10."""
    asked = ", ".join(f"{{of: {name}, at: 10}}" for name in answers)
    task = read_task(read_text(V_ENGINE + f"grading: {{drawn: false, answers: [{asked}]}}\n", "task.yaml"))
    given = {(name, 10): ReadAnswer(size, unit="N") for name, size in answers.items()}
    (marks,) = grade(task, VariantTable((), {"one": ()}), [Submission("one", given)])
    return {mark.key[0]: (mark.state, abs(mark.right)) for mark in marks.marks}


@pytest.mark.parametrize(
    "answers, states",
    [
        ({"R_12": 4683.3, "R_14": 1583.5, "R_A": 5577.6}, ["right", "right", "right"]),
        ({"R_12": 5577.6, "R_24": 1583.5}, ["right", "right"]),  # rod 4 attached to rod 2
        ({"R_14": 5577.6, "R_42": 4683.3}, ["right", "right"]),  # rod 2 attached to rod 4
        ({"R_12": 5200, "R_A": 4683.3}, ["wrong", "wrong"]),
    ],
)
def test_grading_accepts_a_reaction_under_either_attachment(answers, states):
    found = marked(answers)
    assert [state for state, _right in found.values()] == states
    for (state, right), size in zip(found.values(), answers.values(), strict=True):
        assert state == "wrong" or right == pytest.approx(size, abs=0.05)


def test_a_reaction_given_by_components_has_the_direction_of_its_attachment():
    """R_12 of the rod alone and of the whole pin, and the whole pin with the sign of R_21."""
    results = solve(build_problem(read_text(V_ENGINE, "v-compressor.yaml")))
    pin = {pin.link: pin.force[10] for pin in results.reactions.pins(results.linkage)}
    task = read_task(read_text(V_ENGINE + "grading: {drawn: false, answers: [{of: R_12, at: 10}]}\n", "task.yaml"))
    states = []
    for force in (pin["2"], -pin["1"], pin["1"]):
        given = {("R_12", 10): ReadAnswer(force.real, force.imag, "components", "N")}
        (marks,) = grade(task, VariantTable((), {"one": ()}), [Submission("one", given)])
        states += [mark.state for mark in marks.marks]
    assert states == ["right", "right", "wrong"]
