"""What went wrong: a sheet with a mistake in is explained by that mistake, and right sheets accuse nobody."""

from __future__ import annotations

from functools import cache

import numpy as np
from test_commands import SHAPER

from tmm_cli.batch import read_task, split_families
from tmm_cli.grading import WrittenAnswers, compute_right_answers, diagnose_students, list_cases, predict_answers
from tmm_cli.mechanics.quantities import ANGULAR_SPEED, LENGTH
from tmm_cli.problem import read_text

ASKED = """
variants: {OA: {from: 90, to: 120, step: 5}, n1: {among: [70 rpm, 80 rpm, 90 rpm]}}
grading:
  answers:
    - {of: omega of 3, at: 4}
    - {of: v of E, at: [3, 7]}
    - {of: epsilon of 3, at: 4}
    - {of: a of E, at: [3, 7]}
    - {of: U of 5, at: 7}
    - {of: R_34, at: 7}
    - {of: R_03, at: 7}
    - {of: M_b, at: [3, 7]}
"""
STUDENTS = 100
DRAWING = 0.01  # of the largest value: how far off careful drawings are


@cache
def group():
    task = read_task(read_text(SHAPER.read_text(encoding="utf-8") + ASKED, "task.yaml"))
    random = np.random.default_rng(5)
    columns = np.stack([random.uniform(0.09, 0.12, STUDENTS), random.uniform(7, 10, STUDENTS)], axis=1)
    family = next(split_families(lambda x: task.make(("OA", "n1"), (LENGTH, ANGULAR_SPEED), x), columns))[1]
    return family, compute_right_answers(family, task.asked)


def drawn(values, size=None):
    """Answers off drawings of these values; size: of the errors, by default the largest value or the answer itself."""
    known = group()[1]
    random = np.random.default_rng(1)
    vectors = np.array([asked.quantity.vector for asked in known.asked])
    errors = random.uniform(-DRAWING, DRAWING, values.shape) + 1j * vectors * random.uniform(
        -DRAWING, DRAWING, values.shape
    )
    return WrittenAnswers(
        values + errors * (np.maximum(known.scale, np.abs(values)) if size is None else size),
        np.zeros(values.shape, bool),
    )


def test_right_answers_off_a_drawing_accuse_nobody():
    family, known = group()
    assert not diagnose_students(family, known, drawn(known.value))


def test_what_one_mistake_makes_of_a_sheet_is_explained_by_it():
    """At least 95 of 100 sheets, and at most one of 100 by another one."""
    family, known = group()
    every, random = list_cases(family), np.random.default_rng(2)
    values = np.stack([predict_answers(family, known.asked, [case]) for case in every])
    with np.errstate(all="ignore"):
        moved = np.max(np.abs(values - known.value) / known.scale, axis=2)
    moves = np.isfinite(moved) & (moved > 4 * DRAWING * 5 / 3)
    made = [int(random.choice(np.flatnonzero(moves[:, n]))) for n in range(STUDENTS)]
    mistaken = values[made, np.arange(STUDENTS)]
    size = np.maximum(known.scale, np.abs(mistaken))
    for n, case in enumerate(made):
        if not every[case].solves or every[case].price:  # a right drawing, read or written in another unit
            size[n] *= np.minimum(1, np.abs(mistaken[n] / known.value[n]))
    found = diagnose_students(family, known, drawn(mistaken, size))
    rightly = wrongly = 0
    for n, case in enumerate(made):
        named = {one.code for claim in found.get(n, []) for one in claim.alternatives}
        rightly += every[case].code in named
        wrongly += bool(named) and every[case].code not in named
    assert rightly >= 0.95 * STUDENTS and wrongly <= 0.01 * STUDENTS
