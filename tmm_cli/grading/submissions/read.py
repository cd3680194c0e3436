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
from tmm_cli.grading.submissions.answers import AnswerCell, AnswerConverter, one_line
from tmm_cli.grading.submissions.numbers import PARTS, Part, check_unit
from tmm_cli.grading.untrusted_tables import decode_text, read_file_bytes, read_rows
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
        entries: function of a row that returns its answer cells, each with the heading that applies to it.
        width: number of columns in the header.
    """

    student: int | None
    entries: Callable[[Row], Iterator[AnswerCell]]
    width: int

    def student_in(self, row: Row) -> str:
        """Return the name of the student in a row, "" if there is none."""
        return "" if self.student is None else _cell(row, self.student)

    def has_extra_cells(self, row: Row) -> bool:
        """Return True if a row has more cells than the header."""
        return any(row[self.width :])


def recognise_table(header: Row, answers: AnswerConverter, *, filled: bool = True) -> AnswerColumns:
    """Recognise the structure of a table from its header.

    Args:
        header: Cells of the header. If there is a column `quantity`, each row contains one answer; otherwise each
            column does.
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
        return _recognise_long_table(columns, len(header))
    first = 0 if _is_known_heading(header[0], answers) else 1
    if filled and "student" not in columns and not any(_is_known_heading(text, answers) for text in header):
        raise ProblemError(
            _("none of the headings of this table is recognised"),
            found=quote("; ".join(header)),
            allowed=_("columns quantity; position; unit; value, or headings such as v of E at 7"),
        )
    for text in header[first:]:
        if _is_unit(text) and not _is_known_heading(text, answers):
            raise ProblemError(
                _("a heading that contains a comma must be in quotes"),
                found=quote(text),
                allowed=_('"H, mm" or H [mm]'),
            )

    def entries(row: Row) -> Iterator[AnswerCell]:
        return (AnswerCell(cell, over) for over, cell in zip(header[first:], row[first:], strict=False))

    return AnswerColumns(0 if first else None, entries, len(header))


def _is_known_heading(heading: str, answers: AnswerConverter) -> bool:
    try:
        answers.read_heading(AnswerCell("", heading))
    except ProblemError:
        return False
    return True


def _is_unit(text: str) -> bool:
    try:
        return bool(check_unit(text))
    except ProblemError:
        return False


def _recognise_long_table(columns: dict[str, tuple[int, str]], width: int) -> AnswerColumns:
    """Return the structure of a table with one answer in each row and the columns quantity, position, unit, value, x,
    y, ...
    """
    places = {name: place for name, (place, _unit) in columns.items()}
    parts: list[tuple[Part, int, str]] = [("", *columns["value"])] if "value" in columns else []
    parts += [(part, *columns[part]) for part in PARTS if part in columns]

    def entries(row: Row) -> Iterator[AnswerCell]:
        quantity, position, unit = (_cell(row, places.get(name)) for name in ("quantity", "position", "unit"))
        for part, place, own in parts:
            yield AnswerCell(_cell(row, place), quantity, part, position, own or ("" if part == "angle" else unit))

    return AnswerColumns(places.get("student"), entries, width)


def _cell(row: Row, place: int | None) -> str:
    return row[place] if place is not None and place < len(row) else ""


# An answer sheet in YAML: `v of E at 7, m/s: 1,31` line by line, a vector perhaps as a mapping of its parts.


class TextComposer(Composer):
    """YAML reader that keeps every value as the text in the file, e.g. `1,5`: students' numbers are not always YAML
    numbers.
    """

    def parsed(self) -> Iterator[Any]:
        for self.last in super().parsed():
            yield self.last

    def scalar(self, event: Any, path: Any) -> str:
        return str(event.value)

    def cut_by_comma(self, event: Any, path: Any) -> None:
        """Accept a comma between brackets: such a list, e.g. `[1,2; 3,4]`, is kept as text."""

    def sequence(self, start: Any, path: Any) -> Any:
        found = super().sequence(start, path)
        return self.text[start.start_mark.index : self.last.end_mark.index] if start.flow_style else found


def read_sheet(text: str, file: str) -> tuple[str, list[AnswerCell]]:
    """Read an answer sheet in YAML.

    Args:
        text: Contents of the file.
        file: Name of the file, for error messages.

    Returns:
        Name of the student ("" if none), and the answers as cells with headings.

    Raises:
        ProblemError: The file is not an answer sheet.
    """
    data = read_text(text, file, TextComposer).data
    student: Any = data.pop("student", "")
    answers: Any = data.pop("answers", data) or {}
    if not isinstance(student, str) or not isinstance(answers, dict):
        raise ProblemError(
            _("this is not an answer sheet"),
            found=quote(answers),
            allowed="answers: {v of E at 7: 1.31 m/s}",
            file=file,
        )
    return student, list(_yaml_cells(answers))


def _yaml_cells(answers: dict[str, Any]) -> Iterator[AnswerCell]:
    for over, value in answers.items():
        if isinstance(value, dict):
            yield from (AnswerCell(_text(cell), f"{over}, {part}") for part, cell in value.items())
        else:
            yield AnswerCell(_text(value), over)


def _text(value: Any) -> str:
    return value if isinstance(value, str) else quote(value)


# What students hand in: a folder with a file of each, or one table of all. A file that is broken stops nothing.


LARGEST, MOST_ROWS = 1_000_000, 2_000  # of a student's file: bytes, rows
LARGEST_TABLE, MOST_ROWS_OF_ALL = 20_000_000, 500_000
LONGER = N_("a row with more cells than the header is ignored. Does it contain a decimal comma without quotes?")
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
    for submission in reader.read_folder(real) if real.is_dir() else reader.read_table(real):
        seen.add(submission.student)
        yield submission
    for student in students:
        if student not in seen:
            yield Submission(student, problems=(_("nothing was handed in"),))


class _Reader:
    def __init__(self, task: Task, students: Collection[str]) -> None:
        self.answers = AnswerConverter(task)
        self.students = frozenset(students)
        self.alike: dict[str, list[str]] = {}
        for student in students:
            self.alike.setdefault(_fold_name(student), []).append(student)

    def find_student(self, name: str) -> str:
        """Return the known student meant by a name; otherwise the name itself, without unprintable characters.

        Differences of case, spaces and lookalike Cyrillic letters are ignored.
        """
        if name in self.students:
            return name
        found = self.alike.get(_fold_name(name), [])
        if len(found) == 1:
            return found[0]
        return clean(name.encode(errors="replace").decode().translate(NO_PATH).strip(" ."), 100) or "?"

    def read_folder(self, folder: Path) -> Iterator[Submission]:
        """Yield the submissions in a folder in the order of file names; several files of a student are refused."""
        files: dict[str, list[str]] = {}
        for name in sorted(os.listdir(folder)):
            if not name.startswith((".", "~$")) and name.casefold() not in OF_WINDOWS:  # ~$: of an editor that is open
                files.setdefault(self.find_student(Path(name).stem), []).append(name)
        for student, names in files.items():
            if len(names) == 1:
                yield self.read_file(folder / names[0], student)
            else:
                told = ", ".join(clean(name, 60) for name in names[:4])
                yield _unreadable_submission(
                    student,
                    _("there is more than one file of this student ({count}): {names}").format(
                        count=len(names), names=told
                    ),
                )

    def read_file(self, path: Path, student: str) -> Submission:
        """Read the file of one student."""
        problems: dict[str, None] = {}
        own: list[AnswerCell] = []
        try:
            if path.suffix.lower() in SHEETS:
                found = [read_sheet(decode_text(read_file_bytes(path, LARGEST)), path.name)]
            elif path.suffix.lower() in TABLES or path.is_dir() or path.is_symlink():
                rows = read_rows(path, LARGEST, MOST_ROWS)
                shape = self.recognise_table(rows)
                found = [
                    (shape.student_in(row), list(shape.entries(row)))
                    for row in rows[1:]
                    if not shape.has_extra_cells(row)
                ]
                problems = dict.fromkeys([_(LONGER)] if any(map(shape.has_extra_cells, rows[1:])) else [])
            else:
                raise ProblemError(_("this is not an answer sheet"), allowed=_("CSV, XLSX without macros, YAML"))
        except ProblemError as error:
            return _unreadable_submission(student, one_line(error.located(clean(path.name))))
        for name, entries in found:
            other = self.find_student(name)
            if name and other != student:
                problems[_("the file contains the name of another student: {name}").format(name=quote(other))] = None
                if other in self.students:
                    continue
            own += entries
        read = self.answers.convert(student, own, problems)
        if read.answers or read.by_angle or read.problems:
            return read
        return replace(read, problems=(_("there are no answers in {file}").format(file=clean(path.name)),))

    def read_table(self, path: Path) -> Iterator[Submission]:
        """Yield the submissions in a single file: a table with all students, or a YAML sheet of one student.

        Raises:
            ProblemError: The table cannot be read.
        """
        if path.suffix.lower() in SHEETS:
            yield self.read_file(path, self.find_student(path.stem))
            return
        by_student: dict[str, list[list[str]]] = {}
        rows = read_rows(path, LARGEST_TABLE, MOST_ROWS_OF_ALL)
        shape = self.recognise_table(rows, str(path))
        if shape.student is None:
            raise ProblemError(
                _("no column contains the names of the students"),
                found=", ".join(rows[0]),
                allowed="student",
                file=str(path),
            )
        for row in rows[1:]:
            by_student.setdefault(self.find_student(shape.student_in(row)), []).append(row)
        for student, own in by_student.items():
            problems = (_(LONGER),) if any(map(shape.has_extra_cells, own)) else ()
            entries = (entry for row in own if not shape.has_extra_cells(row) for entry in shape.entries(row))
            yield self.answers.convert(student, entries, problems)

    def recognise_table(self, rows: list[list[str]], file: str | None = None) -> AnswerColumns:
        """Recognise the structure of a table from its first row.

        Raises:
            ProblemError: The table is empty or its header cannot be read.
        """
        if not rows:
            raise ProblemError(_("the table is empty"), file=file)
        return recognise_table(rows[0], self.answers, filled=len(rows) > 1)


def _unreadable_submission(student: str, why: str) -> Submission:
    return Submission(student, problems=(why,), unread=True)


def _fold_name(name: str) -> str:
    """Return a name without differences of case, spaces or lookalike Cyrillic letters, for comparison with other
    names.
    """
    return to_latin(" ".join(unicodedata.normalize("NFC", name).replace("_", " ").split())).casefold()
