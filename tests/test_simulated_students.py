"""Simulated students who share no code with the product: the key is theirs, and no mistake is named in vain."""

from __future__ import annotations

from functools import cache

import pytest
from simulated_group import Group, lost, recognisable, told, unknown
from simulated_students import SLIPS, Work

from tmm_cli.grading import MISTAKES

LINKAGES = ["shaper", "six-bar"]
ASKED_REACTIONS = {"shaper": "R_34", "six-bar": "a_FB^n"}


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


@pytest.mark.parametrize("name", LINKAGES)
def test_a_slip_costs_one_answer(name):
    """At least 95 of 100 slips in what is asked for, and 80 of 100 where an intermediate result is not asked for."""
    own = group(name, 5)
    numbers = sorted({number for _, number in own.keys if number is not None})
    sheets = [own.slip(slip, number) for slip in SLIPS[name] for number in numbers * 4]
    costs = {slip: [] for slip in SLIPS[name]}
    for sheet, marks in zip(sheets, own.grade(sheets), strict=True):
        numbers = [number for _, number in lost(marks)]
        costs[next(iter(sheet.work.slips))].append(len(numbers) == len(set(numbers)))
    asked = [one for slip in ("omega_3", "epsilon_3", ASKED_REACTIONS[name]) for one in costs[slip]]
    every = [one for of_slip in costs.values() for one in of_slip]
    assert sum(asked) >= 0.95 * len(asked)
    assert sum(every) >= 0.8 * len(every)


@pytest.mark.parametrize("name", LINKAGES)
def test_one_mistake_costs_one_answer_and_the_order_of_the_questions_changes_nothing(name):
    own = group(name, 6)
    sheets = [own.sheet(Work("load-both-strokes" if n % 2 else "inertia-reversed")) for n in range(20)]
    sheets += [own.slip(slip, 8) for slip in SLIPS[name]]
    reverse = Group(name, 6)
    reverse.task = own.reversed_task()
    for one, other in zip(own.grade(sheets), reverse.grade(sheets), strict=True):
        assert {mark.key: (mark.state, mark.mistakes) for mark in one.marks} == {
            mark.key: (mark.state, mark.mistakes) for mark in other.marks
        }
    for marks in own.grade(sheets[:20]):
        assert len(lost(marks)) == 1 or not any(mark.mistakes for mark in marks.marks)


def test_what_is_right_with_own_values_follows_from_an_answer_that_stands_on_the_sheet():
    """Never through a guessed mistake: every source named is an answer of the student at the same position."""
    own = group("shaper", 7)
    sheets = [own.sheet(Work("crank-speed", 6.283)) for _ in range(10)]
    for marks in own.grade(sheets):
        for mark in marks.marks:
            if mark.state == "follows":
                assert mark.reasons[0].startswith("This answer is right if your own earlier values of ")
            elif mark.state == "repeated":
                assert mark.reasons[-1].startswith("This mistake has already cost the points of ")


def test_every_mistake_has_an_identifier_of_its_own_for_scripts():
    own = group("shaper", 8)
    sheets = [own.sheet(Work(name)) for name in ("coriolis-left-out", "sense", "weight-for-mass")]
    found = [{name for mark in marks.marks for name in mark.identifiers} for marks in own.grade(sheets)]
    assert found == [{"coriolis-left-out"}, {"sense"}, {"weight-for-mass"}]
    codes, names = {kind.code for kind in MISTAKES}, {kind.name for kind in MISTAKES}
    assert len(codes) == len(names) == len({(kind.code, kind.name) for kind in MISTAKES})


@pytest.mark.parametrize("name", LINKAGES)
def test_copies_are_named_with_the_shared_digits_and_nobody_else_is(name):
    """60 copies: of right and of wrong sheets, to the digit or retouched by 0.3 %; and 300 students who work alone."""
    own = group(name, 9)
    right = [own.sheet(Work()) for _ in range(150)]
    wrong = [own.sheet(Work(own.mistakes[n % len(own.mistakes)])) for n in range(150)]
    sources = [*right[:15], *wrong[:15], *right[15:30], *wrong[15:30]]
    copies = [own.copy(sheet, 0.003 if n >= 30 else 0) for n, sheet in enumerate(sources)]
    found = own.grade([*right, *wrong, *copies])
    copied = {marks.student: marks.copied for marks in found if marks.copied}
    names = {
        f"s{300 + n}": f"s{n if n < 15 else 135 + n if n < 30 else n - 15 if n < 45 else 120 + n}" for n in range(60)
    }
    assert {student: copied.get(student) for student in names} == names
    assert set(copied) - set(names) <= set(names.values())  # a wrong sheet and its copy are both named
    assert all(marks.shared for marks in found[300:330])


@pytest.mark.parametrize("name", LINKAGES)
def test_recognisable_mistakes_are_named_rightly_or_not_at_all(name):
    """Of mistakes that move two answers or more: at least 85 % named rightly alone, at most 2 % wrongly."""
    found, _ = recognisable(group(name, 10), 5)
    verdicts = {verdict: sum(n for (_, one), n in found.items() if one == verdict) for verdict in ("right", "wrong")}
    assert verdicts["right"] >= 0.85 * sum(found.values())
    assert verdicts["wrong"] <= 0.02 * sum(found.values())


@pytest.mark.parametrize("name", LINKAGES)
def test_mistakes_without_a_model_are_not_taken_for_others(name):
    """A miscopied length or mass, a sign, a lever arm left out: at most 10 % of the students are told anything."""
    sheets, marks = unknown(group(name, 12), 8)
    assert told(marks) <= 0.1 * len(sheets)
