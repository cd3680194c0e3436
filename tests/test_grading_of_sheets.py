"""Whole sheets: an early mistake costs once, copies are seen, right answers earn all their points."""

from __future__ import annotations

import numpy as np
import pytest
from test_commands import ROOT, SHAPER
from test_diagnosis import ASKED, group
from test_variants_of_task import family_of

from tmm_cli.batch import read_task
from tmm_cli.grading import (
    OtherZero,
    ReadAnswer,
    Sense,
    Submission,
    VariantTable,
    WrittenAnswers,
    find_carried_errors,
    find_copies,
    grade,
    predict_answers,
    replace_by_own_answer,
    solve_with_mistakes,
)
from tmm_cli.problem import read_text

TASK = read_task(read_text(SHAPER.read_text(encoding="utf-8") + ASKED, "task.yaml"))
NAMES = [f"student {n}" for n in range(8)]
TABLE = VariantTable(("OA", "n1"), {n: (f"{95 + 3 * k} mm", f"{70 + 4 * k} rpm") for k, n in enumerate(NAMES)})
UNITS = {
    "omega": "rad/s",
    "epsilon": "rad/s^2",
    "v": "m/s",
    "a": "m/s^2",
    "U": "N",
    "M_b": "N*m",
    "R_34": "N",
    "R_03": "N",
}


def sheet(values):
    """Answers in SI as a student writes them."""
    found = {}
    for asked, value in zip(TASK.asked, values, strict=True):
        unit = UNITS.get(asked.quantity.name.split(" of ")[0], "N")
        two = asked.quantity.vector
        found[asked.key] = ReadAnswer(value.real, value.imag if two else 0.0, "components" if two else "number", unit)
    return found


def rights(students=NAMES):
    empty = [Submission(name) for name in students]
    return np.array([[mark.right for mark in marks.marks] for marks in grade(TASK, TABLE, empty)])


def states(marks):
    return {f"{mark.key[0]} at {mark.key[1]}": mark.state for mark in marks.marks}


def test_right_answers_earn_all_points():
    found = list(grade(TASK, TABLE, [Submission(n, sheet(row)) for n, row in zip(NAMES, rights(), strict=True)]))
    assert [marks.points for marks in found] == [11.0] * len(NAMES)
    assert not any(mark.reasons for marks in found for mark in marks.marks)


@pytest.mark.parametrize(
    "wrong, follow",
    [
        ("a of E at 7", ["U of 5 at 7", "R_34 at 7", "R_03 at 7"]),
        ("U of 5 at 7", ["R_34 at 7", "R_03 at 7"]),
        ("R_34 at 7", ["R_03 at 7"]),
    ],
)
def test_an_early_mistake_costs_its_own_points_only(wrong, follow):
    family, known = group()
    k = next(k for k, asked in enumerate(known.asked) if asked.name == wrong)
    value = known.value[:, k][:, None] + 0.4 * known.scale[:, k][:, None]
    own = replace_by_own_answer(
        known.asked[k].quantity, value, solve_with_mistakes(family).motion, known.value[:, k][:, None]
    )
    values = predict_answers(family, known.asked, [own])
    same = [j for j, asked in enumerate(known.asked) if asked.position == known.asked[k].position and j >= k]
    mixed = known.value.copy()
    mixed[:, same] = values[:, same]
    mixed[:, k] = value[:, 0]
    written = WrittenAnswers(mixed, np.zeros(mixed.shape, bool))
    found = find_carried_errors(family, known, written)
    failed = known.error(written) > known.allowed
    for n in range(len(family)):
        lost = [known.asked[j].name for j in np.flatnonzero(failed[n]) if (n, int(j)) not in found]
        assert lost == [wrong]
    assert {known.asked[j].name for _, j in found} >= set(follow)


def test_an_answer_that_follows_says_from_what():
    row = rights()[0]
    names = [asked.name for asked in TASK.asked]
    mass, motion = 52.0, names.index("a of E at 7")
    row[motion] *= 1.5
    row[names.index("U of 5 at 7")] = -mass * row[motion]
    (marks,) = grade(TASK, TABLE, [Submission(NAMES[0], sheet(row))])
    assert states(marks)["a of E at 7"] == "wrong" and states(marks)["U of 5 at 7"] == "follows"
    told = next(mark.reasons for mark in marks.marks if mark.key == ("U of 5", 7))
    assert told == ("This answer is right if your own earlier values of a of E at 7 are used.",)


def test_the_sheet_of_another_variant_is_named_to_the_teacher():
    rows = rights()
    rows[3] = rows[5]
    found = find_copies(list(grade(TASK, TABLE, [Submission(n, sheet(r)) for n, r in zip(NAMES, rows, strict=True)])))
    assert [marks.copied for marks in found] == ["", "", "", NAMES[5], "", "", "", ""]
    assert not any("student 5" in reason for mark in found[3].marks for reason in mark.reasons)


def test_a_crank_turned_the_wrong_way_has_its_loads_in_the_same_part_of_the_turn():
    text = SHAPER.read_text(encoding="utf-8")
    table = VariantTable(("OA", "n1"), {"1": ("110", "82 rpm"), "2": ("105", "70 rpm")})
    given = family_of(read_task(read_text(text + ASKED, "t")), table)
    other = family_of(read_task(read_text(text.replace("turns: ccw", "turns: cw") + ASKED, "t")), table)
    moment = [
        solve_with_mistakes(one).reactions.balance.moment
        for one in (OtherZero(True).change_family(Sense(True).change_family(given)), other)
    ]
    assert moment[0] == pytest.approx(moment[1], rel=1e-12)


def test_positions_may_be_counted_from_either_extreme_position():
    either = ASKED.replace("grading:", "grading:\n  from: either")
    task = read_task(read_text(SHAPER.read_text(encoding="utf-8") + either, "task.yaml"))
    rows, others = rights(), predict_answers(OtherZero(True).change_family(family_of(TASK, TABLE)), TASK.asked)
    sheets = [sheet(rows[0]), sheet(others[1])]
    found = list(grade(task, TABLE, [Submission(n, own) for n, own in zip(NAMES, sheets, strict=False)]))
    assert [marks.points for marks in found] == [11.0, 11.0]
    (marks,) = grade(TASK, TABLE, [Submission(NAMES[1], sheets[1])])
    assert marks.points < 11.0


def test_where_a_guides_reaction_acts_is_not_judged_where_it_is_nearly_zero():
    text = (ROOT / "problems" / "crank-slider.yaml").read_text(encoding="utf-8")
    task = read_task(read_text(text + "grading: {answers: [{of: arm of R_03, at: [5, 8, 9, 10]}]}", "task.yaml"))
    answers = {asked.key: ReadAnswer(1e6, unit="mm") for asked in task.asked}
    (marks,) = grade(task, VariantTable((), {"one": ()}), [Submission("one", answers)])
    assert [mark.state for mark in marks.marks] == ["wrong", "wrong", "right", "wrong"]
    assert np.isnan(marks.marks[2].right)
