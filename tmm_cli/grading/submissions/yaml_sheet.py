"""An answer sheet in YAML: `v of E at 7, m/s: 1,31` line by line, a vector perhaps as a mapping of its parts."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from tmm_cli.grading.submissions.answers import Entry
from tmm_cli.language import _
from tmm_cli.problem.composer import Composer
from tmm_cli.problem.errors import ProblemError, quote
from tmm_cli.problem.reader import read_text


class Texts(Composer):
    """Every value as the text that stands there, as students write numbers in other ways than YAML does."""

    def parsed(self) -> Iterator[Any]:
        for self.last in super().parsed():
            yield self.last

    def scalar(self, event: Any, path: Any) -> str:
        return str(event.value)

    def cut_by_comma(self, event: Any, path: Any) -> None:
        """Nothing: a list is read as the text that it is."""

    def sequence(self, start: Any, path: Any) -> Any:
        found = super().sequence(start, path)
        return self.text[start.start_mark.index : self.last.end_mark.index] if start.flow_style else found


def read_sheet(text: str, file: str) -> tuple[str, list[Entry]]:
    """The student that a sheet names ("" of none) and its entries. Raises ProblemError."""
    data = read_text(text, file, Texts).data
    student: Any = data.pop("student", "")
    answers: Any = data.pop("answers", data) or {}
    if not isinstance(student, str) or not isinstance(answers, dict):
        raise ProblemError(
            _("this is no answer sheet"), found=quote(answers), allowed="answers: {v of E at 7: 1.31 m/s}", file=file
        )
    return student, list(_entries(answers))


def _entries(answers: dict[str, Any]) -> Iterator[Entry]:
    for over, value in answers.items():
        if isinstance(value, dict):
            yield from (Entry(_text(cell), f"{over}, {part}") for part, cell in value.items())
        else:
            yield Entry(_text(value), over)


def _text(value: Any) -> str:
    return value if isinstance(value, str) else quote(value)
