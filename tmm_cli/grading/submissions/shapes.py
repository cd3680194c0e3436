"""The two shapes of a table: an answer in every row, or all answers of a student in one row."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from tmm_cli.grading.submissions.answers import Answers, Entry
from tmm_cli.grading.submissions.headings import PARTS, Part
from tmm_cli.grading.submissions.numbers import checked_unit
from tmm_cli.grading.tables import WHO
from tmm_cli.language import _
from tmm_cli.problem.errors import ProblemError, quote

Row = Sequence[str]

_COLUMNS = {  # of a table with an answer in every row: how students call them
    "quantity": ("величина", "что найти", "veličina", "velicina"),
    "position": ("положение", "№ положения", "номер положения", "položaj", "polozaj", "положај"),
    "unit": ("единица", "единицы", "ед", "ед изм", "единица измерения", "единицы измерения", "jedinica", "јединица"),
    "value": ("answer", "значение", "ответ", "vrednost", "vrijednost", "odgovor", "вредност", "одговор"),
    "size": ("модуль", "intenzitet", "интензитет"),
    "angle": ("угол", "ugao", "угао"),
    "student": WHO,
}
_WORDS = {word: column for column, words in _COLUMNS.items() for word in words}


@dataclass(frozen=True)
class Shape:
    """How the rows below a header are read. student: the column of names, if there is one. width: of the header."""

    student: int | None
    entries: Callable[[Row], Iterator[Entry]]
    width: int

    def named(self, row: Row) -> str:
        """The student that a row names; "" of none."""
        return "" if self.student is None else _cell(row, self.student)

    def longer(self, row: Row) -> bool:
        """Whether something stands beyond the header."""
        return any(row[self.width :])


def shape_of(header: Row, answers: Answers, *, filled: bool = True) -> Shape:
    """Long where a column is called `quantity`, and wide otherwise; filled: rows follow. Raises ProblemError."""
    columns: dict[str, tuple[int, str]] = {}  # places and units: `angle, deg`
    for n, text in enumerate(header):
        word, _comma, unit = re.sub(r"\[(.*)\]$", r",\1", text).partition(",")
        name = " ".join(word.casefold().replace(".", " ").split())
        columns.setdefault(_WORDS.get(name, name), (n, unit.strip()))
    if "quantity" in columns:
        return _long(columns, len(header))
    first = 0 if _known(header[0], answers) else 1
    if filled and "student" not in columns and not any(_known(text, answers) for text in header):
        raise ProblemError(
            _("no heading of this table is understood"), found=quote("; ".join(header)),
            allowed=_("quantity; position; unit; value, or names of answers such as v of E at 7"),
        )  # fmt: skip
    for text in header[first:]:
        if _is_unit(text) and not _known(text, answers):
            raise ProblemError(
                _("a heading with a comma needs quotes"), found=quote(text), allowed=_('"H, mm" or H [mm]')
            )

    def entries(row: Row) -> Iterator[Entry]:
        return (Entry(cell, over) for over, cell in zip(header[first:], row[first:], strict=False))

    return Shape(0 if first else None, entries, len(header))


def _known(heading: str, answers: Answers) -> bool:
    try:
        answers.heading(Entry("", heading))
    except ProblemError:
        return False
    return True


def _is_unit(text: str) -> bool:
    try:
        return bool(checked_unit(text))
    except ProblemError:
        return False


def _long(columns: dict[str, tuple[int, str]], width: int) -> Shape:
    """Columns quantity, and perhaps student, position, unit, value, x, y, size, angle."""
    places = {name: place for name, (place, _unit) in columns.items()}
    parts: list[tuple[Part, int, str]] = [("", *columns["value"])] if "value" in columns else []
    parts += [(part, *columns[part]) for part in PARTS if part in columns]

    def entries(row: Row) -> Iterator[Entry]:
        quantity, position, unit = (_cell(row, places.get(name)) for name in ("quantity", "position", "unit"))
        for part, place, own in parts:
            yield Entry(_cell(row, place), quantity, part, position, own or ("" if part == "angle" else unit))

    return Shape(places.get("student"), entries, width)


def _cell(row: Row, place: int | None) -> str:
    return row[place] if place is not None and place < len(row) else ""
