"""Feedback sheets for students.

A sheet shows each answer as it was understood, its error, the tolerance, and the explanation of mistakes. The files are
feedback/<student>.md and feedback/<student>.html. They never say whose answers were copied.
"""

from __future__ import annotations

import cmath
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from html import escape
from typing import Final

from tmm_cli.grading.exports.book import STATES, Answer, Gradebook, percent_of_points, round_points, share_text
from tmm_cli.grading.record import Mark, State, StudentMarks
from tmm_cli.grading.untrusted_tables import printable_sentence, printable_text
from tmm_cli.language import N_, _, numeral

WIDENED = 1.05  # times the usual error: less more is not worth telling
UNSAID = "†"  # marks answers without a unit
SHARES = {
    "largest": N_("Errors are given in per cent of the largest value of the quantity in the cycle."),
    "range": N_("Errors of displacements are given in per cent of the whole range of motion."),
    "angle": N_("Errors of angles are given in per cent of one radian: 1 % is 0.57 degrees."),
}


@dataclass(frozen=True)
class StudentSheetRow:
    """Row of a feedback sheet: the table cells of an answer as plain text.

    Attributes:
        state: state of the answer, as in `Mark`.
        cells: texts of the cells.
    """

    state: State
    cells: tuple[str, ...]


@dataclass(frozen=True)
class StudentSheet:
    """Feedback for one student, as plain text.

    Attributes:
        title: title of the task.
        student: name of the student.
        total: points earned, e.g. "12 of 16 points (75 %)".
        problems: sentences on what could not be read.
        headers: headings of the table of answers.
        rows: rows of this table.
        reasons: explanations of mistakes, each with the names of the answers that it concerns.
        notes: remarks below the table on units and tolerances.
    """

    title: str
    student: str
    total: str
    problems: tuple[str, ...]
    headers: tuple[str, ...]
    rows: tuple[StudentSheetRow, ...]
    reasons: tuple[tuple[str, str], ...]
    notes: tuple[str, ...]


def build_feedback_sheets(book: Gradebook) -> Iterator[StudentSheet]:
    """Yield the feedback sheet of each student, in the order of the gradebook."""
    reveal = book.task.rules.reveal
    right = (_("right value"),) if reveal else ()
    headers = (_("quantity"), _("your answer"), *right, _("deviation"), _("allowed"), _("score"), _("result"))
    title, general = printable_text(book.title), _notes(book)
    for student in book.marks:
        both = list(zip(book.answers, student.marks, strict=True))
        unsaid = (
            (_assumed_unit_note(),) if any(mark.reading and mark.value is not None for mark in student.marks) else ()
        )
        yield StudentSheet(
            title,
            printable_text(student.student),
            _total_text(student),
            tuple(map(printable_sentence, student.problems)),
            headers,
            tuple(StudentSheetRow(mark.state, _cells(answer, mark, reveal)) for answer, mark in both),
            tuple(_reasons(both)),
            (*unsaid, *general, *_explain_wide_tolerances(both)),
        )


def _assumed_unit_note() -> str:
    return _("{mark} no unit was given: the unit that fits best was assumed.").format(mark=UNSAID)


def _total_text(student: StudentMarks) -> str:
    share = percent_of_points(student)
    points = _("{points} of {of} points").format(points=_points(student.points), of=_points(student.of))
    return points if share is None else f"{points} ({numeral(share, 'g')} %)"


def _points(points: float) -> str:
    return numeral(round_points(points), ".10g")


def _cells(answer: Answer, mark: Mark, reveal: bool) -> tuple[str, ...]:
    right = (answer.text(mark.right) if mark.is_judged else "-",) if reveal else ()
    points = f"{_points(mark.points)} / {_points(mark.of)}"
    return (
        answer.name,
        answer_text(answer, mark),
        *right,
        _error_text(answer, mark),
        _tolerance_text(answer, mark),
        points,
        _(STATES[mark.state]),
    )


def answer_text(answer: Answer, mark: Mark) -> str:
    """Return the student's value with the unit in which it was read, or the original text if it is not a value."""
    if mark.value is None or not cmath.isfinite(mark.value):
        return printable_text(mark.text) or "-"
    return answer.text(mark.value, mark.reading, mark.size) + (f" {UNSAID}" if mark.reading else "")


def _error_text(answer: Answer, mark: Mark) -> str:
    return "-" if mark.value is None or answer.asked.quantity.against == "exact" else share_text(mark.error)


def _tolerance_text(answer: Answer, mark: Mark) -> str:
    """Return the tolerance as text; a tolerance widened for this variant is followed by the usual one."""
    if answer.asked.quantity.against == "exact":
        return _("exact answer only")
    if not mark.is_judged:
        return share_text(answer.asked.tolerance)
    if not _is_widened(answer, mark):
        return share_text(mark.allowed)
    usual = share_text(answer.asked.tolerance)
    return _("{allowed}, usually {usual}").format(allowed=share_text(mark.allowed), usual=usual)


def _notes(book: Gradebook) -> tuple[str, ...]:
    """Return the notes that say what relative errors of the answers are relative to, e.g. the largest value in the
    cycle.
    """
    against = {answer.asked.quantity.against for answer in book.answers}
    return tuple(_(SHARES[one]) for one in SHARES if one in against)


def _explain_wide_tolerances(both: Iterable[tuple[Answer, Mark]]) -> Iterator[str]:
    """Yield sentences that explain why some tolerances are larger than usual."""
    drawn = {answer.asked.drawn for answer, mark in both if _is_widened(answer, mark)}
    if True in drawn:
        yield _(
            "The tolerance is larger than usual where drawing errors of 0.5 mm per 100 mm already cause such a "
            "deviation: the value cannot be measured more accurately there."
        )
    if False in drawn:
        yield _(
            "The tolerance is larger than usual where rounding the lengths to 0.05 % already causes such a "
            "deviation of a computed value."
        )


def _is_widened(answer: Answer, mark: Mark) -> bool:
    return answer.asked.quantity.against != "exact" and mark.allowed > WIDENED * answer.asked.tolerance


def _reasons(both: list[tuple[Answer, Mark]]) -> Iterator[tuple[str, str]]:
    """Yield each explanation once, with the names of all answers it concerns; unexplained answers come last."""
    found: dict[str, list[str]] = {}
    left = []
    for answer, mark in both:
        for reason in mark.reasons:
            found.setdefault(reason, []).append(answer.name)
        if mark.state == "wrong" and not mark.reasons:
            left.append(answer.name)
    for reason, names in found.items():
        yield printable_sentence(reason), ", ".join(names)
    if left:
        yield _("No typical mistake explains this error."), ", ".join(left)


def feedback_text(answer: Answer, mark: Mark, reveal: bool) -> str:
    """Return the feedback on one answer as a few lines of text; reveal: True to include the correct value."""
    lines = [_("result: {result}").format(result=_(STATES[mark.state]))]
    if mark.state != "missing":
        lines.append(_("your answer: {answer}").format(answer=answer_text(answer, mark)))
    if reveal and mark.is_judged:
        lines.append(_("right value: {value}").format(value=answer.text(mark.right)))
    if mark.value is not None and answer.asked.quantity.against != "exact":
        told = _("deviation: {error} of {whole}; allowed: {allowed}")
        lines.append(
            told.format(
                error=share_text(mark.error), whole=answer.reference_name, allowed=_tolerance_text(answer, mark)
            )
        )
    if mark.reading and mark.value is not None:
        lines.append(_assumed_unit_note())
    return "\n".join((*lines, *map(printable_sentence, mark.reasons)))


SIGNS = re.compile(r"([\\`*\[\]|#~])")
LINE = re.compile(r"(?<![^\W_])_|_(?![^\W_])")  # within a word it is no markup
CELL_BREAK = "\x1f"  # stands between the cells of a row while they are escaped


def markdown_text(sheet: StudentSheet) -> str:
    """Return a feedback sheet as Markdown; characters of students' texts that Markdown would interpret are escaped."""
    parts = [
        f"# {_escape_markdown(sheet.title)}",
        f"**{_escape_markdown(sheet.student)}**: {_escape_markdown(sheet.total)}",
    ]
    parts += [_markdown_list(sheet.problems)] if sheet.problems else []
    rows = [sheet.headers, ["---"] * len(sheet.headers), *(row.cells for row in sheet.rows)]
    parts.append("\n".join(f"| {_escape_markdown(CELL_BREAK.join(row)).replace(CELL_BREAK, ' | ')} |" for row in rows))
    if sheet.reasons:
        parts += [
            f"## {_('Explanation of mistakes')}",
            _markdown_list(f"{reason} ({names})" for reason, names in sheet.reasons),
        ]
    return "\n\n".join([*parts, *map(_escape_markdown, sheet.notes)]) + "\n"


def _markdown_list(lines: Iterable[str]) -> str:
    return "\n".join(f"- {_escape_markdown(line)}" for line in lines)


def _escape_markdown(text: str) -> str:
    safe = SIGNS.sub(r"\\\1", escape(text, quote=False))
    return LINE.sub(r"\\_", safe) if "_" in safe else safe


STYLE = """
body{font:16px/1.45 system-ui,sans-serif;color:#1a1a1a;max-width:60rem;margin:2rem auto;padding:0 1rem;
overflow-wrap:anywhere}
h1{font-size:1.35rem;margin:0}h2{font-size:1.05rem;margin:1.6rem 0 .3rem}
.who{margin:.2rem 0 1.2rem}.who b{font-size:1.1rem}
table{border-collapse:collapse;width:100%;font-variant-numeric:tabular-nums}
th,td{text-align:left;padding:.3rem .7rem .3rem 0;border-bottom:1px solid #ddd;vertical-align:top}
th{border-bottom:2px solid #1a1a1a;font-weight:600}td:first-child,th:first-child{padding-left:.6rem}
td{white-space:nowrap}td:nth-child(2),td:nth-last-child(3),td:last-child{white-space:normal}
td:first-child{border-left:4px solid #b3261e}.right td:first-child{border-left-color:#1d7a3a}
.follows td:first-child{border-left-color:#c77700}.missing td:first-child{border-left-color:#bbb}
.missing td{color:#767676}ul{padding-left:1.2rem;margin:.3rem 0}li{margin:.2rem 0}
.about,.note{color:#555;font-size:.87rem}.note{margin:.5rem 0}.note:first-of-type{margin-top:1rem}
@media print{body{margin:0;max-width:none;font-size:10.5pt}tr,li{break-inside:avoid}td:first-child{
print-color-adjust:exact;-webkit-print-color-adjust:exact}@page{margin:18mm}}
"""
PAGE_HEAD = (
    '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
    '<meta name="viewport" content="width=device-width,initial-scale=1">'
    "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none';style-src 'unsafe-inline'\">"
)


def html_page(sheet: StudentSheet) -> str:
    """Return a feedback sheet as a self-contained HTML page; right-to-left names are displayed correctly."""
    problems = _html_list(f"<li>{escape(problem)}</li>" for problem in sheet.problems)
    header = "".join(f"<th>{escape(header)}</th>" for header in sheet.headers)
    rows = "\n".join(
        f'<tr class="{row.state}"><td>{escape(CELL_BREAK.join(row.cells)).replace(CELL_BREAK, "</td><td>")}</td></tr>'
        for row in sheet.rows
    )
    reasons = _html_list(
        f'<li>{escape(reason)} <span class="about">{escape(names)}</span></li>' for reason, names in sheet.reasons
    )
    why = f"<h2>{escape(_('Explanation of mistakes'))}</h2>{reasons}" if reasons else ""
    notes = "".join(f'<p class="note">{escape(note)}</p>' for note in sheet.notes)
    return (
        f"{PAGE_HEAD}<title>{escape(sheet.title)}</title><style>{STYLE}</style></head>\n<body><h1>{escape(sheet.title)}</h1>"
        f'<p class="who"><b><bdi>{escape(sheet.student)}</bdi></b><br>{escape(sheet.total)}</p>{problems}\n'
        f"<table><thead><tr>{header}</tr></thead><tbody>\n{rows}\n</tbody></table>{why}{notes}</body></html>\n"
    )


def _html_list(items: Iterable[str]) -> str:
    found = "\n".join(items)
    return f"<ul>{found}</ul>" if found else ""


FEEDBACK_FORMATS: Final[Mapping[str, Callable[[StudentSheet], str]]] = {
    "md": markdown_text,
    "html": html_page,
}


def feedback_files(book: Gradebook) -> Iterator[tuple[str, Iterable[str]]]:
    """Yield the feedback files of all students: file names with their contents, Markdown and HTML."""
    for name, sheet in zip(book.files, build_feedback_sheets(book), strict=True):
        yield from ((f"feedback/{name}.{ending}", (text(sheet),)) for ending, text in FEEDBACK_FORMATS.items())
