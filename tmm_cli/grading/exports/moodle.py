"""moodle.csv: what the gradebook of Moodle takes in. One unknown user or bad number there stops the whole of it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from tmm_cli.grading.cells import shown
from tmm_cli.grading.exports.book import Gradebook, rounded
from tmm_cli.grading.exports.tables_csv import csv_lines


def files(book: Gradebook) -> Iterator[tuple[str, Iterable[str]]]:
    """Students as the teacher names them (user name, id number or address), and the points."""
    known = [one for one in book.marks if book.users is None or one.student in book.users]
    rows = ((shown(student.student), rounded(student.points)) for student in known)
    yield "moodle.csv", csv_lines(book, ("user", "grade"), rows)
