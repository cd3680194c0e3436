"""The graded examples of the bank, as `tmm check` expects them: what was made up is what is found."""

from __future__ import annotations

import json

import pytest
from test_commands import ROOT, tmm
from write_graded_examples import MISTAKES, NAMES

from tmm_cli.grading import MISTAKES as KINDS

GRADED = {
    file.parent.name: json.loads(file.read_text(encoding="utf-8"))["result"]["students"]
    for file in (ROOT / "problems" / "grading").glob("*/expected.json")
}
CALLED = {kind.__name__: kind.name for kind in KINDS}


def test_there_are_three_of_twelve_students_each():
    assert len(GRADED) == 3
    assert all(len(set(students) & set(NAMES)) == 12 for students in GRADED.values())


@pytest.mark.parametrize("example", GRADED)
def test_right_sheets_off_drawings_earn_all_points_and_accuse_nobody(example):
    students = GRADED[example]
    most = max(marks["points"] for marks in students.values())
    for n, name in enumerate(NAMES):
        if n not in MISTAKES:
            assert students[name]["points"] == most, name
            assert not any(mark["mistakes"] for mark in students[name]["marks"].values())


@pytest.mark.parametrize("example", GRADED)
def test_a_mistake_that_was_made_is_named_wherever_an_answer_is_wrong(example):
    for n, kind in MISTAKES.items():
        if kind in CALLED:
            marks = GRADED[example][NAMES[n]]["marks"].values()
            named = {mistake for mark in marks for mistake in mark["mistakes"]}
            assert all(CALLED[kind] in told for told in named), (NAMES[n], named)
            assert bool(named) == any(mark["state"] != "right" for mark in marks)


def test_a_broken_sheet_has_its_line_and_stops_nothing():
    lost = [students["Lebedeva"] for students in GRADED.values()]
    assert [marks["points"] for marks in lost] == [0, 0, 0]
    assert all(marks["problems"] for marks in lost)


def test_a_copied_sheet_is_named_where_the_variants_differ_enough():
    assert {name: students["Kovac"]["copied"] for name, students in GRADED.items()} == {
        "shaper": "Borisov",
        "crank-slider": "Borisov",
        "six-bar": "",
    }


def test_examples_are_checked_from_their_own_folder_and_from_that_of_all():
    for folder, count in (("grading", 3), ("grading/six-bar", 1)):
        done = tmm("check", ROOT / "problems" / folder)
        assert done.returncode == 0 and f"problems: {count}, of which with differences: 0" in done.stderr
