"""Data of grading: variants, submissions, marks; and the reading of answers in units."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from typing import Literal

import numpy as np

from tmm_cli.grading.sheet import Right, Written
from tmm_cli.language import _
from tmm_cli.mechanics.analysis import NamedQuantity
from tmm_cli.mechanics.numerics import Vector
from tmm_cli.mechanics.quantities import ACCELERATION, ANGLE, ANGULAR_SPEED, FORCE, LENGTH, MOMENT, SPEED, Dimension
from tmm_cli.problem import ProblemError, UnitError, UnitSystem, parse_unit, quote

Key = tuple[str, int | None]  # a quantity and the position as the students count it; None: of the mechanism as a whole
Form = Literal["number", "size", "components", "polar"]


@dataclass(frozen=True)
class VariantTable:
    """Parameter values by student: rows[student] are texts in the order of names."""

    names: tuple[str, ...]
    rows: Mapping[str, tuple[str, ...]]


@dataclass(frozen=True)
class Given:
    """Answer as it was read: one number, or two.

    components: x and y; polar: magnitude and direction. unit: as written, or as the sheet asks; "" if neither gives it.
    turn_unit: the same for the direction. text: the original text.
    """

    first: float
    second: float = 0.0
    form: Form = "number"
    unit: str = ""
    turn_unit: str = ""
    text: str = ""


@dataclass(frozen=True)
class Submission:
    """Submission of one student.

    problems: sentences on what could not be read. by_angle: answers at a driver angle (rad) instead of a position
    number, by quantity and angle. unread: nothing could be read.
    """

    student: str
    answers: Mapping[Key, Given] = field(default_factory=dict)
    problems: tuple[str, ...] = ()
    by_angle: Mapping[tuple[str, float], Given] = field(default_factory=dict)
    unread: bool = False


State = Literal["missing", "right", "follows", "wrong"]


@dataclass(frozen=True)
class Mark:
    """Judged answer.

    value, right: SI, in the form of the quantity; size: the value is the magnitude of a vector. scale: reference value
    of `error` and `allowed`. reading: unit assumed where none was written. reasons: sentences for the student.
    mistakes: their names for the statistics.
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

    @property
    def judged(self) -> bool:
        """True if there was a variant to judge the answer by."""
        return self.allowed > 0


@dataclass(frozen=True)
class StudentMarks:
    """Marks of one student; `copied`: student whose variant fits the answers better, for the teacher only."""

    student: str
    marks: tuple[Mark, ...]
    problems: tuple[str, ...] = ()
    copied: str = ""

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


def read(units: UnitSystem, wanted: Right, submissions: Sequence[Submission]) -> tuple[Written, Cells, Cells]:
    """Read answers in SI; without a unit, in the most fitting of the usual ones.

    Returns:
        The answers, the assumed units, and the reasons why a text is not an answer; the last two by (student, answer).
    """
    shape = len(submissions), len(wanted.asked)
    value, size = np.full(shape, np.nan, dtype=complex), np.zeros(shape, dtype=bool)
    how: Cells = {}
    refused: Cells = {}
    for k, asked in enumerate(wanted.asked):
        for (form, unit, turn_unit), rows in _alike(submissions, asked.key).items():
            given = [submissions[n].answers[asked.key] for n in rows]
            try:
                named = _factors(asked.quantity, unit, units)
                numbers = _numbers(given, form, factor(turn_unit or "deg", ANGLE))
            except ProblemError as no:
                refused |= dict.fromkeys(((n, k) for n in rows), str(no))
                continue
            size[rows, k] = asked.quantity.vector and form in ("number", "size")
            meant = numbers[:, None] * np.array(list(named.values()))
            best = np.zeros(len(rows), dtype=int)
            if len(named) > 1:
                error = wanted.side_by_side(rows, k, len(named)).error(Written(meant, size[rows, k][:, None]))
                best = np.argmin(np.nan_to_num(error, nan=np.inf), axis=1)
                names = list(named)
                how |= {(n, k): names[b] for n, b in zip(rows, best.tolist(), strict=True)}
            value[rows, k] = meant[np.arange(len(rows)), best]
    return Written(value, size), how, refused


def _alike(submissions: Sequence[Submission], key: Key) -> dict[tuple[Form, str, str], list[int]]:
    """Return the indices of submissions by the form and the units of an answer."""
    found: dict[tuple[Form, str, str], list[int]] = {}
    for n, submission in enumerate(submissions):
        given = submission.answers.get(key)
        if given is not None:
            found.setdefault((given.form, given.unit, given.turn_unit), []).append(n)
    return found


def _factors(quantity: NamedQuantity, unit: str, units: UnitSystem) -> dict[str, float]:
    """Return SI factors by unit: the written unit, otherwise all possible ones, the file's own first.

    Raises:
        UnitError: The unit does not measure this quantity.
    """
    names = (unit,) if unit else (units.symbol(quantity.dimension), *UNSAID.get(quantity.dimension, ()))
    return {name: factor(name, quantity.dimension) for name in names}


def _numbers(given: Sequence[Given], form: Form, turn: float) -> Vector:
    """Return the written answers as complex numbers in their unit."""
    first, second = np.array([[one.first, one.second] for one in given]).T
    turned = first * np.exp(1j * second * turn) if form == "polar" else first
    found: Vector = turned + 1j * second if form == "components" else turned.astype(complex)
    return found


@cache
def factor(name: str, dimension: Dimension) -> float:
    """Return the SI factor of a unit.

    Raises:
        UnitError: The unit measures something else.
    """
    if not name:
        return 1.0
    unit = parse_unit(name)
    if not unit.dimension.fits(dimension):
        raise UnitError(_("expected here: {want}").format(want=dimension), found=quote(name), allowed=dimension.example)
    return unit.si(1.0)
