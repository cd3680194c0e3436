"""What goes into grading and what comes out of it: variants, submissions, marks."""

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
    """Values of parameters by student: rows[student] are texts in the order of names."""

    names: tuple[str, ...]
    rows: Mapping[str, tuple[str, ...]]


@dataclass(frozen=True)
class Given:
    """An answer as it was read: one number, or two.

    components: x and y; polar: size and direction. unit: as it was written, or as the sheet asks for it; "" where
    neither says it. turn_unit: of the direction, likewise. text: what stood there.
    """

    first: float
    second: float = 0.0
    form: Form = "number"
    unit: str = ""
    turn_unit: str = ""
    text: str = ""


@dataclass(frozen=True)
class Submission:
    """What one student handed in.

    problems: what could not be read, a sentence each; they stop nothing. by_angle: answers whose position is told by
    the driver's angle (rad), by quantity and angle: which position that is depends on the variant. unread: nothing
    could be read.
    """

    student: str
    answers: Mapping[Key, Given] = field(default_factory=dict)
    problems: tuple[str, ...] = ()
    by_angle: Mapping[tuple[str, float], Given] = field(default_factory=dict)
    unread: bool = False


State = Literal["missing", "right", "follows", "wrong"]


@dataclass(frozen=True)
class Mark:
    """An answer judged.

    value, right: SI, in the form of the quantity; size: the value is that of a vector without its direction. scale:
    the largest value in the cycle, of which error and allowed are shares. reading: the unit in which it was taken where
    none was written. reasons: sentences for the student. mistakes: their names, for the group.
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
        """Whether there was a variant to judge it by."""
        return self.allowed > 0


@dataclass(frozen=True)
class StudentMarks:
    """All of one student. copied: of whom the answers fit the variant better, for the teacher alone."""

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
    """Answers in SI, read in the unit that fits where none is written: which that was; and what is no answer, why."""
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
    """Who answered in the same form and units."""
    found: dict[tuple[Form, str, str], list[int]] = {}
    for n, submission in enumerate(submissions):
        given = submission.answers.get(key)
        if given is not None:
            found.setdefault((given.form, given.unit, given.turn_unit), []).append(n)
    return found


def _factors(quantity: NamedQuantity, unit: str, units: UnitSystem) -> dict[str, float]:
    """In SI: the unit as it is written, else each that it may be, the file's own first. Raises UnitError."""
    names = (unit,) if unit else (units.symbol(quantity.dimension), *UNSAID.get(quantity.dimension, ()))
    return {name: factor(name, quantity.dimension) for name in names}


def _numbers(given: Sequence[Given], form: Form, turn: float) -> Vector:
    """What was written, as complex numbers of the unit."""
    first, second = np.array([[one.first, one.second] for one in given]).T
    turned = first * np.exp(1j * second * turn) if form == "polar" else first
    found: Vector = turned + 1j * second if form == "components" else turned.astype(complex)
    return found


@cache
def factor(name: str, dimension: Dimension) -> float:
    """A unit in SI. Raises UnitError where it measures something else."""
    if not name:
        return 1.0
    unit = parse_unit(name)
    if not unit.dimension.fits(dimension):
        raise UnitError(_("expected here: {want}").format(want=dimension), found=quote(name), allowed=dimension.example)
    return unit.si(1.0)
