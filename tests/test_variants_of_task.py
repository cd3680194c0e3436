"""Variants of a task solved together are what each is as a file of its own."""

from __future__ import annotations

import numpy as np
import pytest
from test_commands import ROOT, SHAPER

from tmm_cli import solve
from tmm_cli.batch import read_task, split_families
from tmm_cli.grading import (
    ReadAnswer,
    Submission,
    VariantTable,
    grade,
    read_parameter_values,
    solve_with_mistakes as solved,
)
from tmm_cli.problem import ProblemError, read_text

ASKED = """
variants: {OA: {from: 100, to: 120, step: 5}, n1: {among: [70 rpm, 80 rpm, 90 rpm]}}
grading:
  answers: [{of: H}, {of: k}, {of: class}, {of: v of E, at: [3, 7]}, {of: a of E, at: 3}, {of: R_34, at: 7},
            {of: M_b, at: [3, 7]}]
"""
TABLE = VariantTable(("OA", "n1"), {"1": ("110", "82 rpm"), "2": ("105", "70 rpm"), "3": ("0.12 m", "90 rpm")})
ITS_OWN = VariantTable(("OA",), {"1": ("110",)})


def task():
    return read_task(read_text(SHAPER.read_text(encoding="utf-8") + ASKED, "task.yaml"))


def family_of(own, table=TABLE):
    dimensions, columns = read_parameter_values(own, table, list(table.rows))
    return next(split_families(lambda numbers: own.make(table.names, dimensions, numbers), columns))[1]


def test_a_family_is_what_its_variants_are_one_by_one():
    own = task()
    together = solved(family_of(own))
    for n, row in enumerate(TABLE.rows.values()):
        single = solve(own.variant(dict(zip(TABLE.names, row, strict=True))))
        assert together.motion.q[n] == pytest.approx(single.motion.q, abs=1e-14)
        assert together.reactions.balance.moment[n] == pytest.approx(single.reactions.balance.moment, rel=1e-13)
        first = together.family.strokes.strokes[0]
        assert abs(first.run[n, 0]) == pytest.approx(single.strokes.travel, rel=1e-14)


@pytest.mark.parametrize(
    "force",
    [
        "[F, 0]",
        "{angle: 0, against: stroke, table: [[OA, F], [300, 2*F], [500, 0]]}",
        "{angle: 0, against: share of stroke, table: [[5 %, F], [0.6, 2*F], [1, 0]]}",
    ],
)
def test_loads_that_vary_are_those_of_the_variants_one_by_one(force):
    text = SHAPER.read_text(encoding="utf-8").replace("OA: 110", "OA: 110\n  F: 1500").replace("[1500, 0]", force)
    own = read_task(read_text(text + "grading: {answers: [{of: M_b, at: 3}]}", "task.yaml"))
    table = VariantTable(("OA", "F"), {"1": ("110", "1500"), "2": ("105", "900"), "3": ("120", "-700")})
    together = solved(family_of(own, table))
    for n, row in enumerate(table.rows.values()):
        single = solve(own.variant(dict(zip(table.names, row, strict=True))))
        assert together.reactions.balance.moment[n] == pytest.approx(single.reactions.balance.moment, rel=1e-12)


HIGHER = {
    "press-class-iii": (("OA", "CE"), [("85", "310"), ("88", "300"), ("80", "325")]),
    "class-iv": (("OA", "BD"), [("52", "260"), ("50", "270"), ("55", "255")]),
}


@pytest.mark.parametrize("name", HIGHER)
def test_groups_of_higher_classes_go_their_ways_together(name):
    names, rows = HIGHER[name]
    text = (ROOT / "problems" / f"{name}.yaml").read_text(encoding="utf-8")
    own = read_task(read_text(text + "grading: {answers: [{of: M_b, at: 3}]}", "task.yaml"))
    table = VariantTable(names, {str(n): row for n, row in enumerate(rows)})
    together = solved(family_of(own, table))
    assert len(together.family) == len(rows)
    for n, row in enumerate(rows):
        single = solve(own.variant(dict(zip(names, row, strict=True))))
        moment = single.reactions.balance.moment
        assert together.motion.q[n] == pytest.approx(single.motion.q, abs=1e-14)
        assert together.reactions.balance.moment[n] == pytest.approx(moment, abs=1e-13 * np.max(np.abs(moment)))
        assert abs(together.family.strokes.strokes[0].run[n, 0]) == pytest.approx(single.strokes.travel, rel=1e-13)


def test_a_crank_that_is_driven_to_and_fro_is_asked_about_in_its_stroke():
    text = SHAPER.read_text(encoding="utf-8").replace("speed: n1", "speed: n1, stroke: [20, 120]")
    own = read_task(read_text(text + "grading: {answers: [{of: M_b, at: 3}]}", "task.yaml"))
    q = np.degrees(family_of(own).q)
    assert np.min(q) == pytest.approx(20) and np.max(q) == pytest.approx(120)


def test_a_variant_that_its_sketch_shows_badly_is_found_alone():
    text = (ROOT / "problems/shaking-screen.yaml").read_text(encoding="utf-8")
    own = read_task(read_text(text + "grading: {answers: [{of: M_b, at: 3}]}", "task.yaml"))
    table = VariantTable(("CE",), {"1": ("180",), "2": ("185",), "3": ("230",)})
    dimensions, columns = read_parameter_values(own, table, list(table.rows))
    found = list(split_families(lambda numbers: own.make(table.names, dimensions, numbers), columns))
    assert [rows.tolist() for rows, _ in found] == [[0, 1], [2]]


def test_bare_numbers_of_a_table_are_in_the_units_of_the_file():
    _, columns = read_parameter_values(task(), TABLE, ["1", "3"])
    assert columns == pytest.approx(np.array([[0.11, 82 * np.pi / 30], [0.12, 90 * np.pi / 30]]))


def test_an_angle_is_judged_to_a_degree_or_two_however_little_the_link_swings():
    own = read_task(read_text(SHAPER.read_text(encoding="utf-8") + "grading: {answers: [{of: phi of 3, at: 3}]}", "t"))
    right = np.degrees(solve(own.problem).motion.link("3").angle[3])
    key = ("phi of 3", 3)
    sheets = [Submission("1", {key: ReadAnswer(right + off, unit="deg")}) for off in (361, -1, 2.5, -4)]
    states = [next(grade(own, ITS_OWN, [sheet])).marks[0].state for sheet in sheets]
    assert states == ["right", "right", "wrong", "wrong"]


def test_answers_are_judged_against_the_largest_value_of_the_cycle():
    given = {("H", None): ReadAnswer(414), ("v of E", 3): ReadAnswer(1.31), ("M_b", 3): ReadAnswer(200, unit="N*m")}
    marks, none = grade(task(), TABLE, [Submission("1", given), Submission("nobody")])
    states = {mark.key: mark.state for mark in marks.marks}
    assert [states[key] for key in given] == ["right", "right", "wrong"]
    assert {mark.reading for mark in marks.marks if mark.key == ("H", None)} == {"mm"}
    assert marks.points == 2 and none.problems == ("this student has no variant",)


def test_a_tolerance_in_bare_per_cent_is_refused():
    """`tolerance: 3` would take every answer of the group for right: 300 % of the largest value."""
    rules = "grading: {answers: [{of: H, tolerance: 3}]}"
    own = read_task(read_text(SHAPER.read_text(encoding="utf-8") + rules, "t.yaml"))
    with pytest.raises(ProblemError) as caught:
        assert own.asked
    assert str(caught.value) == (
        "t.yaml:38:40: grading.answers[0].tolerance: a fraction cannot be greater than 1\n  found:   3\n  allowed: 3 %"
    )


def test_a_quantity_that_is_none_is_refused_with_one_name_of_each_kind():
    own = read_task(read_text(SHAPER.read_text(encoding="utf-8") + "grading: {answers: [{of: Mb, at: 3}]}", "t.yaml"))
    with pytest.raises(ProblemError) as caught:
        assert own.asked
    assert str(caught.value) == (
        "t.yaml:38:26: grading.answers[0].of: there is no quantity with this name\n"
        "  found:   'Mb'\n"
        "  allowed: e.g. W, class, n, p1, p2, passive, H, strokes, k, x of E, y of E, jerk of E, phi "
        "of 1, omega of 1, epsilon of 1, s of 1, v of E, a of E, v of 2 on 3, a of 2 on 3, Coriolis of 2 on 3, U of 1, "
        "M of 1, R_01, arm of R_32, M_b, F_b\n"
        "  did you mean 'M_b'?"
    )
