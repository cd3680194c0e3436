"""What goes into grading and what comes out of it: variants, submissions, marks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

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
