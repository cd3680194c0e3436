"""Simulated students who share no code with the product: the key is theirs, and no mistake is named in vain."""

from __future__ import annotations

from functools import cache

import pytest
from simulated_group import Group, lost, told
from simulated_students import SLIPS, Work

LINKAGES = ["shaper", "six-bar"]


@cache
def group(name, seed):
    return Group(name, seed)


@pytest.mark.parametrize("name", LINKAGES)
def test_loop_equations_and_newton_euler_give_the_key(name):
    own = group(name, 1)
    sheets = [own.sheet(Work()) for _ in range(20)]
    for sheet, marks in zip(sheets, own.grade(sheets), strict=True):
        for mark in marks.marks:
            quantity, number = mark.key
            assert mark.right == pytest.approx(sheet.right[quantity][number or 0], rel=1e-9, abs=1e-12 * mark.scale)


@pytest.mark.parametrize("name", LINKAGES)
def test_a_right_sheet_off_a_drawing_loses_nothing_and_accuses_nobody(name):
    own = group(name, 2)
    found = own.grade([own.sheet(Work()) for _ in range(500)])
    assert (told(found), sum(map(len, map(lost, found)))) == (0, 0)


@pytest.mark.parametrize("name", LINKAGES)
def test_of_200_sheets_with_one_random_wrong_answer_at_most_two_are_told_a_mistake(name):
    own = group(name, 3)
    assert told(own.grade([own.one_wrong_answer() for _ in range(200)])) <= 2


@pytest.mark.parametrize("name", LINKAGES)
def test_of_80_slips_at_most_four_are_told_a_typical_mistake(name):
    own = group(name, 4)
    numbers = sorted({number for _, number in own.keys if number is not None})
    sheets = [own.slip(slip, number) for slip in SLIPS[name] for number in numbers * 4][:80]
    assert told(own.grade(sheets)) <= 4
