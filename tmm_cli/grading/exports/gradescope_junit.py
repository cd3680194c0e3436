"""Marks written as test results: gradescope/<student>.json (results.json of Gradescope) and junit.xml."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from xml.sax.saxutils import escape, quoteattr

from tmm_cli.grading.exports.book import Gradebook, earns_points, round_points
from tmm_cli.grading.exports.feedback import feedback_text
from tmm_cli.grading.record import StudentMarks
from tmm_cli.grading.untrusted_tables import printable_sentence, printable_text


def gradescope_files(book: Gradebook) -> Iterator[tuple[str, Iterable[str]]]:
    """Yield a results file for Gradescope for each student."""
    for name, student in zip(book.files, book.marks, strict=True):
        yield f"gradescope/{name}.json", (_gradescope_record(book, student),)


def _gradescope_record(book: Gradebook, student: StudentMarks) -> str:
    tests = [
        {
            "name": answer.name,
            "score": round_points(mark.points),
            "max_score": round_points(mark.of),
            "status": "passed" if earns_points(mark) else "failed",
            "output": feedback_text(answer, mark, book.task.rules.reveal),
            "output_format": "text",
            "visibility": "visible",
        }
        for answer, mark in zip(book.answers, student.marks, strict=True)
    ]
    told = "\n".join(map(printable_sentence, student.problems))
    found = {"score": round_points(student.points), "output": told, "output_format": "text", "tests": tests}
    return json.dumps(found, ensure_ascii=False, allow_nan=False)


def junit_file(book: Gradebook) -> Iterator[tuple[str, Iterable[str]]]:
    """Yield junit.xml with the answers of all students as test cases."""
    yield "junit.xml", _junit_lines(book)


def _junit_lines(book: Gradebook) -> Iterator[str]:
    """Yield the lines of junit.xml; in a test case, classname is the student and name is the answer."""
    marks = [mark for student in book.marks for mark in student.marks]
    counted = f'tests="{len(marks)}" failures="{sum(not earns_points(mark) for mark in marks)}"'
    yield f'<?xml version="1.0" encoding="UTF-8"?>\n<testsuites {counted}>\n'
    yield f"<testsuite name={quoteattr(printable_text(book.title))} {counted}>\n"
    for student in book.marks:
        classname = quoteattr(printable_text(student.student))
        for answer, mark in zip(book.answers, student.marks, strict=True):
            text = escape(feedback_text(answer, mark, book.task.rules.reveal))
            inner = (
                f"<system-out>{text}</system-out>"
                if earns_points(mark)
                else (f'<failure message="{mark.state}" type="{mark.state}">{text}</failure>')
            )
            yield f"<testcase classname={classname} name={quoteattr(answer.name)}>{inner}</testcase>\n"
    yield "</testsuite>\n</testsuites>\n"
