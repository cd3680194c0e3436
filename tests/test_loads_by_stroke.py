"""A load depends on the stroke of its own link if that slides on the frame, else of the output, or of a named link."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tmm_cli import load, prepare, solve
from tmm_cli.batch import Task, read_task
from tmm_cli.grading import ReadAnswer, Submission, VariantTable, grade
from tmm_cli.mechanics.accuracy import judge_values
from tmm_cli.problem import ProblemError, build_any_problem, build_problem, read_text
from tmm_cli.reports import input_data_tables
from tmm_cli.sweep import SweptMechanisms, read_axes, run_sweep

V_ENGINE = Path("tests/data/v-compressor.yaml").read_text(encoding="utf-8")
R, ROD = 0.05, 0.2  # m
TWO_PISTONS = """tmm: 1
units: {length: mm, angle: deg}
parameters: {r: 50, l: 200}
points: {O: [0, 0]}
guides: {x: {through: O, angle: 0}}
links:
  1: {points: {O: [0, 0], A: [r, 0], C: [0, r]}}
  2: {points: [A, B], length: l}
  3: {points: [B], slides: x}
  4: {points: [C, D], length: l}
  5: {points: [D], slides: x}
driver: {link: 1, speed: 60 rpm}
sketch: {at: 30, B: [240, 0], D: [170, 0]}
gravity: 0
loads:
  Q: {on: 5, force: {angle: 180, against: stroke, table: [[0, 1000], [100, 0]]}}
output: [3, 5]
positions: {count: 12, from: 0}
"""


def solved(text):
    return solve(build_problem(read_text(text, "pistons.yaml")))


def sizes(text):
    """Sizes of the load Q at the positions, N."""
    return np.abs(next(x.force for x in solved(text).loads if x.name == "Q"))


def run_of(angle):
    """How far a piston on a crank pin at this angle is from its lower dead centre, m; it works forward from there."""
    place = R * np.cos(angle) + np.sqrt(ROD**2 - (R * np.sin(angle)) ** 2)
    return place - (ROD - R)


PHI = np.radians(np.arange(0, 360, 30))


@pytest.mark.parametrize(
    "against, pin",
    [("stroke", np.pi / 2), ("stroke of 5", np.pi / 2), ("stroke of 3", 0.0)],
)
def test_a_table_follows_the_stroke_of_its_own_piston_or_of_the_named_one(against, pin):
    """Cranks at 90 degrees; the table falls from 1000 N to 0 over the stroke of 100 mm."""
    expected = 1000 * (1 - run_of(PHI + pin) / 0.1)
    text = TWO_PISTONS.replace("against: stroke", f"against: {against}")
    assert sizes(text) == pytest.approx(expected, abs=1e-9)


def test_a_table_in_shares_follows_its_own_piston_too():
    shares = TWO_PISTONS.replace(
        "against: stroke, table: [[0, 1000], [100, 0]]", "against: share of stroke, table: [[0, 1000], [1, 0]]"
    )
    assert sizes(shares) == pytest.approx(1000 * (1 - run_of(PHI + np.pi / 2) / 0.1), abs=1e-9)
    named = shares.replace("share of stroke", "share of stroke of 3")
    assert sizes(named) == pytest.approx(1000 * (1 - run_of(PHI) / 0.1), abs=1e-9)


def test_a_load_on_a_rod_follows_the_output():
    text = TWO_PISTONS.replace("on: 5, force", "on: 4, at: D, force")
    assert sizes(text) == pytest.approx(1000 * (1 - run_of(PHI) / 0.1), abs=1e-9)


@pytest.mark.parametrize("when, pin", [("working stroke", np.pi / 2), ("working stroke of 3", 0.0)])
def test_a_load_of_the_working_stroke_acts_while_its_own_piston_works(when, pin):
    """It resists the forward stroke: the piston goes from the lower to the upper dead centre."""
    text = TWO_PISTONS.replace(
        "force: {angle: 180, against: stroke, table: [[0, 1000], [100, 0]]}", f"force: [-800, 0], when: {when}"
    )
    forward = np.mod(PHI + pin, 2 * np.pi) >= np.pi - 1e-9
    assert sizes(text) == pytest.approx(np.where(forward, 800, 0))


def test_the_working_stroke_of_another_output_is_what_the_file_says_of_it():
    """Piston 5 works backward: the table is counted from its upper dead centre; that of piston 3 does not change."""
    text = TWO_PISTONS.replace("output: [3, 5]", "output: [3, {link: 5, working: backward}]")
    assert sizes(text) == pytest.approx(1000 * run_of(PHI + np.pi / 2) / 0.1, abs=1e-9)
    both = solved(text)
    assert [both.strokes.working[0].run, both.further[0].working[0].run] == pytest.approx([0.1, -0.1])


def test_a_v_engine_with_its_law_of_motion():
    """Position 10, R_12 and R_14 of the compressor whose pistons are loaded by strokes of their own."""
    results = solved(V_ENGINE + "dynamics: {mean speed: 980 rpm, delta: 1/50}\n")
    found = [abs(results.reactions.of(pair).force[10]) for pair in ("A", "A''")]
    assert found == pytest.approx([4674, 1600], abs=0.5)


def test_the_same_engine_with_its_cylinders_exchanged_works_the_same():
    """Listed as output first or second, a piston has the same gas force."""
    for number in (3, 5):
        text = V_ENGINE.replace("output: [3, 5]", f"output: {number}")
        gas = {x.name: x.force for x in solved(text).loads if x.kind == "load"}
        usual = {x.name: x.force for x in solved(V_ENGINE).loads if x.kind == "load"}
        for name, force in gas.items():
            assert np.max(np.abs(force - usual[name])) < 1e-9 * np.max(np.abs(usual[name]))


def test_a_trace_of_one_mechanism_follows_the_strokes_of_both_pistons(tmp_path):
    (tmp_path / "two.yaml").write_text(TWO_PISTONS, encoding="utf-8")
    problem = load(tmp_path / "two.yaml")
    results, batch = solve(problem), prepare(problem)
    traced = batch(results.motion.q)["T.1"]
    assert traced == pytest.approx(results.reactions.balance.moment, abs=1e-12 * np.max(np.abs(traced)))


def test_the_digits_of_a_load_by_the_stroke_of_another_piston_are_judged():
    results = solved(TWO_PISTONS)

    def moment(found):
        return {("M_b", "1", ""): found.reactions.balance.moment}

    bound = judge_values(results, moment).bound["M_b", "1", ""]
    largest = np.max(np.abs(results.reactions.balance.moment))
    assert np.all(bound < 1e-12 * largest)


def test_a_sweep_solves_each_mechanism_with_the_strokes_of_both_pistons():
    """The largest balancing moment of the cycle, for cranks of two radii."""
    tree = read_text(TWO_PISTONS, "pistons.yaml")
    found = run_sweep(SweptMechanisms(tree, read_axes(Task(tree), ["r=40..50:2"]), ["M_b"]))
    assert found.taped
    for (crank,), (largest,) in zip(found.points, found.values, strict=True):
        closely = TWO_PISTONS.replace("r: 50", f"r: {crank}").replace("count: 12", "count: 3600")
        moment = solve(build_any_problem(read_text(closely, "pistons.yaml"))).reactions.balance.moment
        assert largest == pytest.approx(np.max(np.abs(moment)), rel=1e-5)


def test_grading_gives_each_student_the_strokes_of_his_own_pistons():
    asked = "variants: {r: {from: 40, to: 50, step: 5}}\ngrading: {drawn: false, answers: [{of: M_b, at: [2, 4, 9]}]}\n"
    task = read_task(read_text(TWO_PISTONS + asked, "task.yaml"))
    table = VariantTable(("r",), {"one": ("42",), "two": ("47",)})
    submissions = []
    for name, (crank,) in table.rows.items():
        moment = solved(TWO_PISTONS.replace("r: 50", f"r: {crank}")).reactions.balance.moment
        answers = {("M_b", k): ReadAnswer(moment[k], unit="N*m") for k in (2, 4, 9)}
        submissions.append(Submission(name, answers))
    marks = list(grade(task, table, submissions))
    assert [mark.state for student in marks for mark in student.marks] == ["right"] * 6


def test_tables_of_the_file_name_the_link_whose_stroke_it_is():
    tables = {table.name: table for table in input_data_tables(build_problem(read_text(TWO_PISTONS, "pistons.yaml")))}
    assert "stroke of link 5" in str([column.values for column in tables["loads"].columns])


@pytest.mark.parametrize(
    "written, message, found",
    [
        ("stroke of 9", "there is no moving link of that name", "'9'"),
        ("strokes", "this value is not allowed here", "'strokes'"),
        ("stroke of 1", "this mechanism has no working stroke", "link 1 has no extreme positions"),
    ],
)
def test_a_stroke_that_there_is_not_is_refused(written, message, found):
    with pytest.raises(ProblemError) as error:
        solve(
            build_any_problem(read_text(TWO_PISTONS.replace("against: stroke", f"against: {written}"), "pistons.yaml"))
        )
    assert (error.value.message, error.value.found) == (message, found)


def test_words_for_when_a_load_acts():
    with pytest.raises(ProblemError) as error:
        text = TWO_PISTONS.replace("on: 5, force", "on: 5, when: idle, force")
        build_any_problem(read_text(text, "pistons.yaml"))
    assert (error.value.message, error.value.found) == ("this value is not allowed here", "'idle'")
