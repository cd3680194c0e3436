"""Records of grading (variants, submissions, marks), and the conversion of answers to SI units."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from typing import Literal

import numpy as np

from tmm_cli.grading.sheet import RightAnswers, WrittenAnswers
from tmm_cli.language import _
from tmm_cli.mechanics.analysis import NamedQuantity
from tmm_cli.mechanics.numerics import Vector
from tmm_cli.mechanics.quantities import ACCELERATION, ANGLE, ANGULAR_SPEED, FORCE, LENGTH, MOMENT, SPEED, Dimension
from tmm_cli.problem import ProblemError, UnitError, UnitSystem, parse_unit, quote

Key = tuple[str, int | None]  # a quantity and the position as the students count it; None: of the mechanism as a whole
Form = Literal["number", "size", "components", "polar"]


@dataclass(frozen=True)
class VariantTable:
    """Parameter values of each student's variant.

    Attributes:
        names: names of the parameters.
        rows: values as texts in the order of `names`, by student.
    """

    names: tuple[str, ...]
    rows: Mapping[str, tuple[str, ...]]


@dataclass(frozen=True)
class ReadAnswer:
    """An answer as read from a cell: one number or two.

    Attributes:
        first, second: components x and y, or magnitude and direction (form `polar`). A single number is in `first`.
        form: number, size (magnitude of a vector), components or polar.
        unit: unit written by the student, otherwise that of the answer sheet; "" if neither states it.
        turn_unit: unit of the direction: written by the student, otherwise that of the answer sheet; "" if not stated.
        text: the original text.
    """

    first: float
    second: float = 0.0
    form: Form = "number"
    unit: str = ""
    turn_unit: str = ""
    text: str = ""


@dataclass(frozen=True)
class Submission:
    """Everything that one student handed in.

    Attributes:
        student: name of the student.
        answers: answers by quantity and position number.
        problems: sentences on what could not be read.
        by_angle: answers by quantity and driver angle (rad), where the student gave an angle instead of a position
            number.
        unread: True if nothing could be read.
    """

    student: str
    answers: Mapping[Key, ReadAnswer] = field(default_factory=dict)
    problems: tuple[str, ...] = ()
    by_angle: Mapping[tuple[str, float], ReadAnswer] = field(default_factory=dict)
    unread: bool = False


State = Literal["missing", "right", "follows", "repeated", "wrong"]


@dataclass(frozen=True)
class Mark:
    """Mark for one answer of a student.

    Attributes:
        key: quantity and position number.
        state: missing, right, follows (it follows correctly from wrong earlier answers), repeated (wrong because of a
            named mistake that already cost the points of an earlier answer) or wrong.
        points, of: points earned and points available.
        value: the student's value, SI; complex for a vector. None if there is none.
        right: correct value, SI.
        size: True if `value` is only the magnitude of a vector.
        scale: reference value (SI) of the relative errors `error` and `allowed`.
        error: relative error of the answer.
        allowed: largest permitted relative error.
        reading: unit that was assumed because none was written.
        reasons: sentences for the student.
        mistakes: names of the mistakes, for the statistics.
        text: the answer as written.
        identifiers: stable names of the mistakes for scripts; alternatives are joined by a vertical bar.
    """

    key: Key
    state: State
    points: float
    of: float
    value: complex | None = None
    right: complex = 0j
    size: bool = False
    scale: float = 1.0
    error: float = 0.0
    allowed: float = 0.0
    reading: str = ""
    reasons: tuple[str, ...] = ()
    mistakes: tuple[str, ...] = ()
    text: str = ""
    identifiers: tuple[str, ...] = ()

    @property
    def is_judged(self) -> bool:
        """True if the answer could be judged, i.e. the student has a variant that can be solved."""
        return self.allowed > 0


@dataclass(frozen=True)
class StudentMarks:
    """Marks of one student.

    Attributes:
        student: name of the student.
        marks: a mark for each question of the task.
        problems: sentences on what could not be read.
        copied: student whose variant fits the answers better or who has the same answers, "" if none; for the teacher
            only.
        shared: the answers that are those of the student `copied`, to the digit or slightly retouched.
    """

    student: str
    marks: tuple[Mark, ...]
    problems: tuple[str, ...] = ()
    copied: str = ""
    shared: tuple[str, ...] = ()

    @property
    def points(self) -> float:
        return sum(mark.points for mark in self.marks)

    @property
    def of(self) -> float:
        return sum(mark.of for mark in self.marks)


# What an answer may mean: its number in the unit written beside it, or in each that people write without saying so.


UNSAID: dict[Dimension, tuple[str, ...]] = {
    LENGTH: ("mm", "m", "cm"),
    ANGLE: ("deg", "rad"),
    SPEED: ("m/s", "mm/s"),
    ACCELERATION: ("m/s^2", "mm/s^2"),
    ANGULAR_SPEED: ("rad/s", "rpm"),
    FORCE: ("N", "kN"),
    MOMENT: ("N*m", "N*mm"),
}


Cells = dict[tuple[int, int], str]  # words by student and answer


def read_in_si(
    units: UnitSystem, wanted: RightAnswers, submissions: Sequence[Submission]
) -> tuple[WrittenAnswers, Cells, Cells]:
    """Convert the answers of all students to SI.

    If an answer has no unit, the usual unit is assumed with which it fits the correct value best.

    Args:
        units: Units of the task file.
        wanted: Right answers.
        submissions: Submissions of the students.

    Returns:
        Answers in SI; units assumed for answers without one; messages on texts that are not answers. The last two are
        dictionaries by the indices (student, answer).
    """
    shape = len(submissions), len(wanted.asked)
    value, size = np.full(shape, np.nan, dtype=complex), np.zeros(shape, dtype=bool)
    how: Cells = {}
    refused: Cells = {}
    for k, asked in enumerate(wanted.asked):
        for (form, unit, turn_unit), rows in _group_by_form(submissions, asked.key).items():
            given = [submissions[n].answers[asked.key] for n in rows]
            try:
                named = _possible_factors(asked.quantity, unit, units)
                numbers = _complex_numbers(given, form, si_factor(turn_unit or "deg", ANGLE))
            except ProblemError as no:
                refused |= dict.fromkeys(((n, k) for n in rows), str(no))
                continue
            size[rows, k] = asked.quantity.vector and form in ("number", "size")
            meant = numbers[:, None] * np.array(list(named.values()))
            best = np.zeros(len(rows), dtype=int)
            if len(named) > 1:
                error = wanted.repeat_question(rows, k, len(named)).error(WrittenAnswers(meant, size[rows, k][:, None]))
                best = np.argmin(np.nan_to_num(error, nan=np.inf), axis=1)
                names = list(named)
                how |= {(n, k): names[b] for n, b in zip(rows, best.tolist(), strict=True)}
            value[rows, k] = meant[np.arange(len(rows)), best]
    return WrittenAnswers(value, size), how, refused


def _group_by_form(submissions: Sequence[Submission], key: Key) -> dict[tuple[Form, str, str], list[int]]:
    """Group the students by how they wrote their answer to one question.

    Returns:
        Lists of the indices of submissions, by the form of the answer, its unit, and the unit of its direction.
    """
    found: dict[tuple[Form, str, str], list[int]] = {}
    for n, submission in enumerate(submissions):
        given = submission.answers.get(key)
        if given is not None:
            found.setdefault((given.form, given.unit, given.turn_unit), []).append(n)
    return found


def _possible_factors(quantity: NamedQuantity, unit: str, units: UnitSystem) -> dict[str, float]:
    """Return the SI factors of the units an answer may be in: the written unit, or else all usual ones.

    Raises:
        UnitError: The unit does not measure this quantity.
    """
    names = (unit,) if unit else (units.symbol(quantity.dimension), *UNSAID.get(quantity.dimension, ()))
    return {name: si_factor(name, quantity.dimension) for name in names}


def _complex_numbers(given: Sequence[ReadAnswer], form: Form, turn: float) -> Vector:
    """Convert answers of the same form to complex numbers in the unit in which they are written.

    turn: radians per unit of the direction, for magnitudes with directions.
    """
    first, second = np.array([[one.first, one.second] for one in given]).T
    turned = first * np.exp(1j * second * turn) if form == "polar" else first
    found: Vector = turned + 1j * second if form == "components" else turned.astype(complex)
    return found


@cache
def si_factor(name: str, dimension: Dimension) -> float:
    """Return the SI value of a unit; 1 for an empty name.

    Raises:
        UnitError: The unit is not a unit of this dimension.
    """
    if not name:
        return 1.0
    unit = parse_unit(name)
    if not unit.dimension.fits(dimension):
        raise UnitError(_("expected here: {want}").format(want=dimension), found=quote(name), allowed=dimension.example)
    return unit.si(1.0)
