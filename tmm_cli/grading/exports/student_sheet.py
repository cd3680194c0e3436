"""What a student is told: each answer as it was understood, what was allowed, what went wrong. Never who copied."""

from __future__ import annotations

import cmath
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from tmm_cli.grading.cells import sentence, shown
from tmm_cli.grading.exports.book import STATES, Answer, Gradebook, percent, rounded, share_text
from tmm_cli.grading.record import Mark, State, StudentMarks
from tmm_cli.language import N_, _, numeral

WIDENED = 1.05  # times the usual error: less more is not worth telling
UNSAID = "†"  # marks answers without a unit
SHARES = {
    "largest": N_("Errors are shares of the largest value of a quantity in the cycle."),
    "range": N_("Errors of places are shares of the whole way."),
    "angle": N_("Errors of angles are shares of a radian: 1 % is 0.57 degrees."),
}


@dataclass(frozen=True)
class Row:
    """An answer of a sheet, its cells as plain text under the sheet's headers."""

    state: State
    cells: tuple[str, ...]


@dataclass(frozen=True)
class Sheet:
    """What one student is told, as plain text. reasons: sentences, each with the answers that it is about."""

    title: str
    student: str
    total: str
    problems: tuple[str, ...]
    headers: tuple[str, ...]
    rows: tuple[Row, ...]
    reasons: tuple[tuple[str, str], ...]
    notes: tuple[str, ...]


def sheets(book: Gradebook) -> Iterator[Sheet]:
    """In the order of the marks."""
    reveal = book.task.rules.reveal
    right = (_("right value"),) if reveal else ()
    headers = (_("asked"), _("your answer"), *right, _("off by"), _("allowed"), _("score"), _("result"))
    title, general = shown(book.title), _notes(book)
    for student in book.marks:
        both = list(zip(book.answers, student.marks, strict=True))
        unsaid = (_unsaid(),) if any(mark.reading and mark.value is not None for mark in student.marks) else ()
        yield Sheet(
            title,
            shown(student.student),
            _total(student),
            tuple(map(sentence, student.problems)),
            headers,
            tuple(Row(mark.state, _cells(answer, mark, reveal)) for answer, mark in both),
            tuple(_reasons(both)),
            (*unsaid, *general, *_why_more(both)),
        )


def _unsaid() -> str:
    return _("{mark} no unit was written: it was read in the one that fits.").format(mark=UNSAID)


def _total(student: StudentMarks) -> str:
    share = percent(student)
    points = _("{points} of {of} points").format(points=_points(student.points), of=_points(student.of))
    return points if share is None else f"{points} ({numeral(share, 'g')} %)"


def _points(points: float) -> str:
    return numeral(rounded(points), ".10g")


def _cells(answer: Answer, mark: Mark, reveal: bool) -> tuple[str, ...]:
    right = (answer.text(mark.right) if mark.judged else "-",) if reveal else ()
    points = f"{_points(mark.points)} / {_points(mark.of)}"
    return (
        answer.name,
        written(answer, mark),
        *right,
        _error(answer, mark),
        _allowed(answer, mark),
        points,
        _(STATES[mark.state]),
    )


def written(answer: Answer, mark: Mark) -> str:
    """The student's value with its unit, in the unit it was read in; as it was written where it is no value."""
    if mark.value is None or not cmath.isfinite(mark.value):
        return shown(mark.text) or "-"
    return answer.text(mark.value, mark.reading, mark.size) + (f" {UNSAID}" if mark.reading else "")


def _error(answer: Answer, mark: Mark) -> str:
    return "-" if mark.value is None or answer.asked.quantity.against == "exact" else share_text(mark.error)


def _allowed(answer: Answer, mark: Mark) -> str:
    """What was allowed, and what is usual where that is less."""
    if answer.asked.quantity.against == "exact":
        return _("exact")
    if not mark.judged:
        return share_text(answer.asked.tolerance)
    if not _widened(answer, mark):
        return share_text(mark.allowed)
    usual = share_text(answer.asked.tolerance)
    return _("{allowed}, usually {usual}").format(allowed=share_text(mark.allowed), usual=usual)


def _notes(book: Gradebook) -> tuple[str, ...]:
    """What errors are shares of."""
    against = {answer.asked.quantity.against for answer in book.answers}
    return tuple(_(SHARES[one]) for one in SHARES if one in against)


def _why_more(both: Iterable[tuple[Answer, Mark]]) -> Iterator[str]:
    """Why more than usual is allowed."""
    drawn = {answer.asked.drawn for answer, mark in both if _widened(answer, mark)}
    if True in drawn:
        yield _(
            "More than usual is allowed where lengths drawn 0.5 mm in 100 mm off move the value that far: nobody can "
            "measure it more exactly there."
        )
    if False in drawn:
        yield _("More than usual is allowed where lengths rounded to 0.05 % move a computed value that far.")


def _widened(answer: Answer, mark: Mark) -> bool:
    return answer.asked.quantity.against != "exact" and mark.allowed > WIDENED * answer.asked.tolerance


def _reasons(both: list[tuple[Answer, Mark]]) -> Iterator[tuple[str, str]]:
    """Each sentence once, with all answers that it is about; at last what nothing explains."""
    found: dict[str, list[str]] = {}
    left = []
    for answer, mark in both:
        for reason in mark.reasons:
            found.setdefault(reason, []).append(answer.name)
        if mark.state == "wrong" and not mark.reasons:
            left.append(answer.name)
    for reason, names in found.items():
        yield sentence(reason), ", ".join(names)
    if left:
        yield _("No typical mistake explains what is wrong here."), ", ".join(left)


def output(answer: Answer, mark: Mark, reveal: bool) -> str:
    """All about one answer in a few lines."""
    lines = [_("result: {result}").format(result=_(STATES[mark.state]))]
    if mark.state != "missing":
        lines.append(_("your answer: {answer}").format(answer=written(answer, mark)))
    if reveal and mark.judged:
        lines.append(_("right value: {value}").format(value=answer.text(mark.right)))
    if mark.value is not None and answer.asked.quantity.against != "exact":
        told = _("off by {error} of {whole}; allowed: {allowed}")
        lines.append(told.format(error=share_text(mark.error), whole=answer.of, allowed=_allowed(answer, mark)))
    if mark.reading and mark.value is not None:
        lines.append(_unsaid())
    return "\n".join((*lines, *map(sentence, mark.reasons)))
