"""junit.xml: a case an answer, for what shows results of tests."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from xml.sax.saxutils import escape, quoteattr

from tmm_cli.grading.cells import shown
from tmm_cli.grading.exports.book import Gradebook, fitting
from tmm_cli.grading.exports.student_sheet import output


def files(book: Gradebook) -> Iterator[tuple[str, Iterable[str]]]:
    """One file of all students."""
    yield "junit.xml", _lines(book)


def _lines(book: Gradebook) -> Iterator[str]:
    """classname (the student) and name (the answer) are what a case is known by; texts stand in the elements."""
    marks = [mark for student in book.marks for mark in student.marks]
    counted = f'tests="{len(marks)}" failures="{sum(not fitting(mark) for mark in marks)}"'
    yield f'<?xml version="1.0" encoding="UTF-8"?>\n<testsuites {counted}>\n'
    yield f"<testsuite name={quoteattr(shown(book.title))} {counted}>\n"
    for student in book.marks:
        classname = quoteattr(shown(student.student))
        for answer, mark in zip(book.answers, student.marks, strict=True):
            text = escape(output(answer, mark, book.task.rules.reveal))
            inner = (
                f"<system-out>{text}</system-out>"
                if fitting(mark)
                else (f'<failure message="{mark.state}" type="{mark.state}">{text}</failure>')
            )
            yield f"<testcase classname={classname} name={quoteattr(answer.name)}>{inner}</testcase>\n"
    yield "</testsuite>\n</testsuites>\n"
