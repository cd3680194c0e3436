"""result.json: the marks of all students as data for scripts, with the identifiers of the named mistakes."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from typing import Any

from tmm_cli.grading.exports.book import Gradebook
from tmm_cli.grading.record import StudentMarks
from tmm_cli.grading.untrusted_tables import printable_sentence, printable_text


def plain_marks(marks: StudentMarks) -> dict[str, Any]:
    """Return the marks of a student as dictionaries and lists that JSON can represent."""
    return {
        "points": marks.points,
        "copied": marks.copied,
        "shared": list(marks.shared),
        "problems": list(marks.problems),
        "marks": {
            mark.key[0] if mark.key[1] is None else f"{mark.key[0]} at {mark.key[1]}": {
                "state": mark.state,
                "error": mark.error,
                "allowed": mark.allowed,
                "mistakes": list(mark.mistakes),
                "identifiers": list(mark.identifiers),
            }
            for mark in marks.marks
        },
    }


def result_file(book: Gradebook) -> Iterator[tuple[str, Iterable[str]]]:
    """Yield the file result.json, with a line for each student."""
    yield "result.json", _result_lines(book)


def _result_lines(book: Gradebook) -> Iterator[str]:
    yield '{"students": {'
    for number, marks in enumerate(book.marks):
        record = plain_marks(marks)
        for mark in record["marks"].values():  # an infinite error is no number of JSON
            mark["error"] = mark["error"] if abs(mark["error"]) < float("inf") else None
        record["copied"] = printable_text(marks.copied)
        record["shared"] = [printable_text(text) for text in marks.shared]
        record["problems"] = [printable_sentence(problem) for problem in marks.problems]
        name = json.dumps(printable_text(marks.student))
        yield f"{',' if number else ''}\n{name}: {json.dumps(record)}"
    yield "\n}}\n"
