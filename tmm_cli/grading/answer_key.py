"""Answer key for the teacher: right answers of all students, tolerances, and questions that are not informative."""

from __future__ import annotations

import cmath
import math
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass

from tmm_cli.batch import Question, Task, split_families
from tmm_cli.grading.record import VariantTable
from tmm_cli.grading.run import read_parameter_values
from tmm_cli.grading.sheet import compute_right_answers
from tmm_cli.language import _
from tmm_cli.mechanics.errors import LinkageError
from tmm_cli.mechanics.quantities import NUMBER

HEADER = ("student", "quantity", "position", "value", "direction, deg", "unit", "allowed", "allowed, %", "note")
NOTHING = 1e-9  # of what is allowed: smaller values are zero but for rounding
WIDE = 0.25  # of the largest value: whoever guesses is right


@dataclass(frozen=True)
class KeyLine:
    """Line of the answer key: the right answer to one question for one student.

    Attributes:
        student: name of the student.
        asked: the question.
        value: correct value, SI; complex for a vector.
        allowed: tolerance, SI.
        share: tolerance as a fraction of the reference value. The reference value is the largest value in the cycle,
            the range of the quantity, or 1 rad for an angle.
    """

    student: str
    asked: Question
    value: complex
    allowed: float
    share: float

    @property
    def idle_reason(self) -> str:
        """Reason why the answer to this question says little about the student, e.g. that zero counts as right.

        Empty if the question is informative.
        """
        if self.asked.quantity.against == "exact":
            return ""
        if self.share > WIDE:
            return _("the question does not distinguish right answers from wrong ones: its tolerance is too large")
        return (
            _("the question does not distinguish right answers from wrong ones: zero counts as a right answer")
            if abs(self.value) <= self.allowed
            else ""
        )

    def cells(self, task: Task) -> list[str]:
        """Return the table cells of this line, in the order of HEADER, in the units of the task file."""
        quantity = self.asked.quantity
        scale = task.units.factor(quantity.dimension)
        value = self.value if abs(self.value) > NOTHING * self.allowed else 0
        size = abs(value) if quantity.vector else value.real
        direction = f"{math.degrees(cmath.phase(value)) % 360:.4g}" if quantity.vector and value else ""
        unit = "" if quantity.dimension == NUMBER else task.units.symbol(quantity.dimension)
        number = "" if self.asked.number is None else str(self.asked.number)
        exact = quantity.against == "exact"
        allowed, share = ("", "") if exact else (f"{self.allowed / scale:.3g}", f"{100 * self.share:.3g}")
        name = quantity.name
        value_text = f"{size / scale + 0.0:.6g}"
        return [self.student, name, number, value_text, direction, unit, allowed, share, self.idle_reason]


def compute_answer_key(task: Task, table: VariantTable) -> Iterator[KeyLine]:
    """Yield the lines of the answer key for one student after another.

    A student whose mechanism cannot be solved has no lines.

    Args:
        task: Task whose block `grading` lists the questions.
        table: Parameter values of each student's variant.

    Raises:
        ProblemError: The table or the task is wrong.
    """
    students = list(table.rows)
    dimensions, columns = read_parameter_values(task, table, students)
    found: dict[int, list[KeyLine]] = {}
    for rows, family in split_families(lambda numbers: task.make(table.names, dimensions, numbers), columns):
        if isinstance(family, LinkageError):
            continue
        own = compute_right_answers(family, task.asked)
        for n, row in enumerate(rows.tolist()):
            found[row] = [
                KeyLine(
                    students[row],
                    asked,
                    complex(own.value[n, k]),
                    float(own.allowed[n, k] * own.scale[n, k]),
                    float(own.allowed[n, k]),
                )
                for k, asked in enumerate(task.asked)
            ]
    for row in range(len(students)):
        yield from found.get(row, ())


def describe_idle_questions(lines: list[KeyLine]) -> Iterator[str]:
    """Yield a sentence for each question whose answer says little about some students, with the number of these
    students.
    """
    students = len({line.student for line in lines})
    found = Counter((line.asked.name, line.idle_reason) for line in lines if line.idle_reason)
    for (name, why), count in found.items():
        yield _("{asked}: {why} (students: {count} of {all})").format(asked=name, why=why, count=count, all=students)
