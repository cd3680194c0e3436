"""Reading of submissions: a folder with a file per student, or one table; a damaged file does not affect the others."""

from __future__ import annotations

import os
import re
import unicodedata
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from tmm_cli.batch import Task
from tmm_cli.grading.record import Submission
from tmm_cli.grading.submissions.answers import Answers, Entry, one_line
from tmm_cli.grading.submissions.numbers import PARTS, Part, checked_unit
from tmm_cli.grading.untrusted_tables import bytes_of, decoded, rows_of
from tmm_cli.grading.variant_tables import WHO
from tmm_cli.language import N_, _
from tmm_cli.problem import Composer, ProblemError, clean, quote, read_text, to_latin

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
class AnswerColumns:
    """Structure of a submitted table, read from its header.

    Attributes:
        student: index of the column with the students' names, None if there is no such column.
        entries: function that returns the cells of a row with their headings.
        width: number of columns in the header.
    """

    student: int | None
    entries: Callable[[Row], Iterator[Entry]]
    width: int

    def named(self, row: Row) -> str:
        """Return the name of the student in a row, "" if there is none."""
        return "" if self.student is None else _cell(row, self.student)

    def longer(self, row: Row) -> bool:
        """Return True if a row has more cells than the header."""
        return any(row[self.width :])


def shape_of(header: Row, answers: Answers, *, filled: bool = True) -> AnswerColumns:
    """Recognise the structure of a table from its header.

    Args:
        header: Cells of the header. A column `quantity` means an answer per row; otherwise each column is an answer.
        answers: Converter that knows the requested answers.
        filled: True if rows follow the header, so that a header without any known answer is an error.

    Raises:
        ProblemError: The header cannot be read.
    """
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
            _("none of the headings of this table is recognised"),
            found=quote("; ".join(header)),
            allowed=_("quantity; position; unit; value, or names of answers such as v of E at 7"),
        )
    for text in header[first:]:
        if _is_unit(text) and not _known(text, answers):
            raise ProblemError(
                _("a heading that contains a comma must be in quotes"),
                found=quote(text),
                allowed=_('"H, mm" or H [mm]'),
            )

    def entries(row: Row) -> Iterator[Entry]:
        return (Entry(cell, over) for over, cell in zip(header[first:], row[first:], strict=False))

    return AnswerColumns(0 if first else None, entries, len(header))


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


def _long(columns: dict[str, tuple[int, str]], width: int) -> AnswerColumns:
    """Return the structure of a table with an answer per row: columns quantity, position, unit, value, x, y, ..."""
    places = {name: place for name, (place, _unit) in columns.items()}
    parts: list[tuple[Part, int, str]] = [("", *columns["value"])] if "value" in columns else []
    parts += [(part, *columns[part]) for part in PARTS if part in columns]

    def entries(row: Row) -> Iterator[Entry]:
        quantity, position, unit = (_cell(row, places.get(name)) for name in ("quantity", "position", "unit"))
        for part, place, own in parts:
            yield Entry(_cell(row, place), quantity, part, position, own or ("" if part == "angle" else unit))

    return AnswerColumns(places.get("student"), entries, width)


def _cell(row: Row, place: int | None) -> str:
    return row[place] if place is not None and place < len(row) else ""


# An answer sheet in YAML: `v of E at 7, m/s: 1,31` line by line, a vector perhaps as a mapping of its parts.


class Texts(Composer):
    """YAML reader that keeps every value as its text, since students write numbers differently from YAML."""

    def parsed(self) -> Iterator[Any]:
        for self.last in super().parsed():
            yield self.last

    def scalar(self, event: Any, path: Any) -> str:
        return str(event.value)

    def cut_by_comma(self, event: Any, path: Any) -> None:
        """Do nothing: a list in brackets is read as its text, so a comma in it is allowed."""

    def sequence(self, start: Any, path: Any) -> Any:
        found = super().sequence(start, path)
        return self.text[start.start_mark.index : self.last.end_mark.index] if start.flow_style else found


def read_sheet(text: str, file: str) -> tuple[str, list[Entry]]:
    """Read an answer sheet in YAML.

    Args:
        text: Contents of the file.
        file: Name of the file, for error messages.

    Returns:
        Name of the student ("" if none), and the answers as cells with headings.

    Raises:
        ProblemError: The file is not an answer sheet.
    """
    data = read_text(text, file, Texts).data
    student: Any = data.pop("student", "")
    answers: Any = data.pop("answers", data) or {}
    if not isinstance(student, str) or not isinstance(answers, dict):
        raise ProblemError(
            _("not an answer sheet"), found=quote(answers), allowed="answers: {v of E at 7: 1.31 m/s}", file=file
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


# What students hand in: a folder with a file of each, or one table of all. A file that is broken stops nothing.


LARGEST, MOST_ROWS = 1_000_000, 2_000  # of a student's file: bytes, rows
LARGEST_TABLE, MOST_ROWS_OF_ALL = 20_000_000, 500_000
LONGER = N_("a row with more cells than the header is not counted. Does it contain a decimal comma without quotes?")
NO_PATH = str.maketrans("/\\", "\u2215\u29f5")  # a name never leads to another folder
OF_WINDOWS = ("thumbs.db", "desktop.ini")  # files that Windows leaves in folders
TABLES, SHEETS = (".csv", ".tsv", ".txt", ".xlsx"), (".yaml", ".yml")


def read_submissions(path: str | os.PathLike[str], task: Task, students: Collection[str]) -> Iterator[Submission]:
    """Yield the submissions one by one, each read when it is requested; students who handed in nothing come last.

    Args:
        path: Folder with a file named after each student, or a single table with all students.
        task: Task.
        students: Names of the students who have variants.

    Raises:
        ProblemError: The path or the table of all students cannot be read.
    """
    real = Path(os.path.realpath(path))
    reader = _Reader(task, students)
    seen = set()
    for submission in reader.folder(real) if real.is_dir() else reader.table(real):
        seen.add(submission.student)
        yield submission
    for student in students:
        if student not in seen:
            yield Submission(student, problems=(_("nothing was handed in"),))


class _Reader:
    def __init__(self, task: Task, students: Collection[str]) -> None:
        self.answers = Answers(task)
        self.students = frozenset(students)
        self.alike: dict[str, list[str]] = {}
        for student in students:
            self.alike.setdefault(_folded(student), []).append(student)

    def student(self, name: str) -> str:
        """Return the known student meant by a name; otherwise the name itself, without unprintable characters.

        Differences of case, spaces and lookalike Cyrillic letters are ignored.
        """
        if name in self.students:
            return name
        found = self.alike.get(_folded(name), [])
        if len(found) == 1:
            return found[0]
        return clean(name.encode(errors="replace").decode().translate(NO_PATH).strip(" ."), 100) or "?"

    def folder(self, folder: Path) -> Iterator[Submission]:
        """Yield the submissions in a folder in the order of file names; a student with more than one file is not read."""
        files: dict[str, list[str]] = {}
        for name in sorted(os.listdir(folder)):
            if not name.startswith((".", "~$")) and name.casefold() not in OF_WINDOWS:  # ~$: of an editor that is open
                files.setdefault(self.student(Path(name).stem), []).append(name)
        for student, names in files.items():
            if len(names) == 1:
                yield self.file(folder / names[0], student)
            else:
                told = ", ".join(clean(name, 60) for name in names[:4])
                yield _unread(
                    student,
                    _("more than one file of this student ({count}): {names}").format(count=len(names), names=told),
                )

    def file(self, path: Path, student: str) -> Submission:
        """Read the file of one student."""
        problems: dict[str, None] = {}
        own: list[Entry] = []
        try:
            if path.suffix.lower() in SHEETS:
                found = [read_sheet(decoded(bytes_of(path, LARGEST)), path.name)]
            elif path.suffix.lower() in TABLES or path.is_dir() or path.is_symlink():
                rows = rows_of(path, LARGEST, MOST_ROWS)
                shape = self.shape(rows)
                found = [(shape.named(row), list(shape.entries(row))) for row in rows[1:] if not shape.longer(row)]
                problems = dict.fromkeys([_(LONGER)] if any(map(shape.longer, rows[1:])) else [])
            else:
                raise ProblemError(_("not an answer sheet"), allowed=_("CSV, XLSX without macros, YAML"))
        except ProblemError as error:
            return _unread(student, one_line(error.located(clean(path.name))))
        for name, entries in found:
            other = self.student(name)
            if name and other != student:
                problems[_("the file contains the name of another student: {name}").format(name=quote(other))] = None
                if other in self.students:
                    continue
            own += entries
        read = self.answers.submission(student, own, problems)
        if read.answers or read.by_angle or read.problems:
            return read
        return replace(read, problems=(_("there is no answer in {file}").format(file=clean(path.name)),))

    def table(self, path: Path) -> Iterator[Submission]:
        """Yield the submissions in a single file: a table with all students, or a YAML sheet of one student.

        Raises:
            ProblemError: The table cannot be read.
        """
        if path.suffix.lower() in SHEETS:
            yield self.file(path, self.student(path.stem))
            return
        by_student: dict[str, list[list[str]]] = {}
        rows = rows_of(path, LARGEST_TABLE, MOST_ROWS_OF_ALL)
        shape = self.shape(rows, str(path))
        if shape.student is None:
            raise ProblemError(
                _("no column contains the names of the students"),
                found=", ".join(rows[0]),
                allowed="student",
                file=str(path),
            )
        for row in rows[1:]:
            by_student.setdefault(self.student(shape.named(row)), []).append(row)
        for student, own in by_student.items():
            problems = (_(LONGER),) if any(map(shape.longer, own)) else ()
            entries = (entry for row in own if not shape.longer(row) for entry in shape.entries(row))
            yield self.answers.submission(student, entries, problems)

    def shape(self, rows: list[list[str]], file: str | None = None) -> AnswerColumns:
        """Recognise the structure of a table from its first row.

        Raises:
            ProblemError: The table is empty or its header cannot be read.
        """
        if not rows:
            raise ProblemError(_("the table is empty"), file=file)
        return shape_of(rows[0], self.answers, filled=len(rows) > 1)


def _unread(student: str, why: str) -> Submission:
    return Submission(student, problems=(why,), unread=True)


def _folded(name: str) -> str:
    """Return a name in a form for comparison: without differences of case, spaces or lookalike Cyrillic letters."""
    return to_latin(" ".join(unicodedata.normalize("NFC", name).replace("_", " ").split())).casefold()
