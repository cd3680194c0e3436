"""gradescope/<student>.json: a results.json of Gradescope for every student."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator

from tmm_cli.grading.cells import sentence
from tmm_cli.grading.exports.book import Gradebook, fitting, rounded
from tmm_cli.grading.exports.student_sheet import output
from tmm_cli.grading.record import StudentMarks


def files(book: Gradebook) -> Iterator[tuple[str, Iterable[str]]]:
    """A record a student."""
    for name, student in zip(book.files, book.marks, strict=True):
        yield f"gradescope/{name}.json", (_text(book, student),)


def _text(book: Gradebook, student: StudentMarks) -> str:
    tests = [
        {
            "name": answer.name,
            "score": rounded(mark.points),
            "max_score": rounded(mark.of),
            "status": "passed" if fitting(mark) else "failed",
            "output": output(answer, mark, book.task.rules.reveal),
            "output_format": "text",
            "visibility": "visible",
        }
        for answer, mark in zip(book.answers, student.marks, strict=True)
    ]
    told = "\n".join(map(sentence, student.problems))
    found = {"score": rounded(student.points), "output": told, "output_format": "text", "tests": tests}
    return json.dumps(found, ensure_ascii=False, allow_nan=False)
