"""Conversion of table cells with their headings to answers. Components of a vector may stand in separate cells."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from tmm_cli.batch import Task
from tmm_cli.grading.record import Key, ReadAnswer, Submission
from tmm_cli.grading.submissions.numbers import (
    Heading,
    Headings,
    Part,
    UnknownQuantityError,
    check_unit,
    read_answer,
    read_position,
)
from tmm_cli.language import _
from tmm_cli.mechanics.numerics import Real
from tmm_cli.mechanics.quantities import ANGLE
from tmm_cli.problem import ProblemError, nearest_name, parse_unit, quote

MOST_TOLD = 20  # problems of one submission
MOST_CELLS = 10_000  # of one submission
LIMIT = 10_000  # headings that are kept read


Cells = dict[Part, tuple[str, str]]  # text and unit of every part of an answer


class AnswerCell(NamedTuple):
    """A cell of a submitted table with the texts that say which answer it contains.

    Attributes:
        cell: text of the cell.
        heading: heading of its column, or the contents of the column `quantity` in its row.
        part: component of a vector, if the table has columns for components.
        position, unit: contents of the columns `position` and `unit`; empty if there are no such columns.
    """

    cell: str
    heading: str
    part: Part = ""
    position: str = ""
    unit: str = ""


class HeadingMeaning(NamedTuple):
    """Meaning of a heading.

    Attributes:
        place: quantity and position.
        part: component of a vector, if any.
        unit: unit, "" if none.
        asked: True if the task requests this answer.
    """

    place: Heading
    part: Part
    unit: str
    asked: bool


class AnswerConverter:
    """Converter of table cells to the answers that a task requests.

    Raises:
        ProblemError: The block `grading` of the task is wrong.
    """

    def __init__(self, task: Task) -> None:
        self.asked = {one.key for one in task.asked}
        self.vectors = {one.quantity.name: one.quantity.vector for one in task.asked}
        self.names = list(self.vectors)
        self.headings = Headings(task.quantities)
        self.known: dict[AnswerCell, HeadingMeaning | ProblemError] = {}

    def read_heading(self, entry: AnswerCell) -> HeadingMeaning:
        """Return the meaning of the heading of a cell.

        Raises:
            ProblemError: The heading cannot be read.
        """
        key = entry._replace(cell="")
        found = self.known.get(key)
        if found is None:
            try:
                found = self._read_heading(key)
            except ProblemError as error:
                found = error
            if len(self.known) < LIMIT:
                self.known[key] = found
        if isinstance(found, ProblemError):
            raise found.with_traceback(None)
        return found

    def _read_heading(self, entry: AnswerCell) -> HeadingMeaning:
        over = self.headings.read(entry.heading)
        position, angle = read_position(entry.position)
        if position is not None or angle is not None:
            over = replace(over, position=position, angle=angle)
        place = replace(over, part="", unit="")
        asked = over.quantity in self.names if over.angle is not None else _key(place) in self.asked
        return HeadingMeaning(place, entry.part or over.part, check_unit(entry.unit) or over.unit, asked)

    def convert(self, student: str, entries: Iterable[AnswerCell], problems: Iterable[str] = ()) -> Submission:
        """Convert the cells of one student's table to a submission; empty cells and dashes are not answers.

        problems: messages on the file itself; messages on single cells are added to them.
        """
        told: list[str | ProblemError] = list(problems)
        cells: dict[Heading, Cells] = {}  # by quantity and position
        unasked: dict[Heading, None] = {}
        for count, entry in enumerate(entries):
            if count == MOST_CELLS:
                told.insert(0, _("only the first {most} cells are read").format(most=MOST_CELLS))
                break
            if not entry.cell.strip(" -–—"):
                continue
            try:
                over = self.read_heading(entry)
            except ProblemError as error:
                told.append(error)
                continue
            if not over.asked:
                unasked[over.place] = None
            elif over.part in (parts := cells.setdefault(over.place, {})):
                told.append(repeated_answer_message(over.place))
            else:
                parts[over.part] = entry.cell, over.unit
        answers: dict[Key, ReadAnswer] = {}
        by_angle: dict[tuple[str, float], ReadAnswer] = {}
        for place, parts in cells.items():
            try:
                given = _join_components(parts)
                if given is None:
                    continue
                if given.form != "number" and not self.vectors[place.quantity]:
                    raise ProblemError(_("expected one number"), found=quote(given.text))
            except ProblemError as error:
                told.append(error.at(_answer_name(place)))
                continue
            if {"x", "y"} & parts.keys() and {"", "size", "angle"} & parts.keys():
                told.append(
                    _(
                        "{name}: both the components and a magnitude or direction are given; "
                        "only the components are graded"
                    ).format(name=_answer_name(place))
                )
            if place.angle is None:
                answers[_key(place)] = given
            else:
                by_angle[place.quantity, place.angle] = given
        if unasked:
            told.insert(0, self._not_requested_message(list(unasked)))
        lines = [line if isinstance(line, str) else self._error_line(line) for line in told[:MOST_TOLD]]
        if len(told) > MOST_TOLD:
            lines.append(_("and {count} more").format(count=len(told) - MOST_TOLD))
        return Submission(student, answers, tuple(lines), by_angle)

    def _error_line(self, error: ProblemError) -> str:
        if isinstance(error, UnknownQuantityError):
            near = nearest_name(error.name, self.names)
            error = ProblemError(error.message, found=error.found, near=near)
        return one_line(error)

    def _not_requested_message(self, places: list[Heading]) -> str:
        """Return the message that an answer is not requested, with similar names of requested quantities if there are
        any.
        """
        names = []
        for place in places[:MOST_TOLD]:
            near = None if place.quantity in self.names else nearest_name(place.quantity, self.names)
            names.append(_answer_name(place) + (_(" (requested: {near})").format(near=near) if near else ""))
        more = [_("{count} more").format(count=len(places) - MOST_TOLD)] if len(places) > MOST_TOLD else []
        return _("these answers are not requested and are not graded: {names}").format(names=", ".join([*names, *more]))


def one_line(error: ProblemError) -> str:
    """Return an error message in one line."""
    return "; ".join(" ".join(line.split()) for line in str(error).splitlines())


def repeated_answer_message(place: Heading) -> str:
    """Return the message that the same answer is given twice."""
    return _("{name} is given twice: the first answer counts").format(name=_answer_name(place))


def _key(place: Heading) -> Key:
    return place.quantity, place.position


def _answer_name(place: Heading) -> str:
    if place.angle is not None:
        return _("{quantity} at phi = {angle:.6g} deg").format(quantity=place.quantity, angle=math.degrees(place.angle))
    if place.position is None:
        return place.quantity
    return _("{quantity} at {position}").format(quantity=place.quantity, position=place.position)


def _join_components(cells: Cells) -> ReadAnswer | None:
    """Join the table cells with the components of one vector to an answer; return None if they are empty.

    Raises:
        ProblemError: A component is missing or the units differ.
    """
    if "x" in cells or "y" in cells:
        if not {"x", "y"} <= cells.keys():
            raise ProblemError(_("one component is missing"), found=", ".join(cells), allowed="x, y")
        x, y = (_read_single_number(*cells[part]) for part in ("x", "y"))
        if x.unit and y.unit and x.unit != y.unit:
            raise ProblemError(_("the components have different units"), found=f"{quote(x.unit)}, {quote(y.unit)}")
        return ReadAnswer(x.first, y.first, "components", x.unit or y.unit, text=f"{x.text}; {y.text}")
    size = cells.get("size") or cells.get("")
    if size is None:
        raise ProblemError(_("the magnitude of the vector is missing"), found=", ".join(cells), allowed="size, angle")
    if "angle" in cells:
        given, turn = _read_single_number(*size), _read_single_number(*cells["angle"])
        if turn.unit and parse_unit(turn.unit).dimension != ANGLE:
            raise ProblemError(_("the direction must be an angle"), found=quote(turn.unit), allowed="deg, rad")
        return ReadAnswer(
            given.first,
            turn.first,
            "polar",
            given.unit,
            turn.unit,
            _("{size} at {angle}").format(size=given.text, angle=turn.text),
        )
    return read_answer(*size)


def _read_single_number(text: str, unit: str) -> ReadAnswer:
    found = read_answer(text, unit)
    if found is None or found.form != "number":
        raise ProblemError(_("expected one number"), found=quote(text))
    return found


# Answers whose position is told by the driver's angle, put to the task's positions of the student's variant.


NEAR = np.radians(2.0)  # as angles are read off a drawing


def assign_to_positions(submission: Submission, task: Task, places: Real) -> Submission:
    """Convert answers given at driver angles to answers at the nearest positions of the student's variant.

    Args:
        submission: Submission of the student.
        task: Task.
        places: Driver angles (rad) at the positions of the variant.

    Returns:
        The submission with all answers by position number. Answers that cannot be converted, e.g. because no position
        is near the angle, are reported in `problems`.
    """
    if not submission.by_angle:
        return submission
    asked = {one.key for one in task.asked}
    answers, told = dict(submission.answers), []
    for (quantity, angle), given in submission.by_angle.items():
        away = np.abs(np.remainder(places - angle + np.pi, 2 * np.pi) - np.pi)
        nearest = int(np.argmin(away))
        number = nearest + task.rules.count
        if away[nearest] > NEAR:
            told.append(
                _(
                    "{quantity} at phi = {angle:.6g} deg: there is no position at this angle; the nearest is position "
                    "{number} at {own:.6g} deg"
                ).format(
                    quantity=quantity, angle=np.degrees(angle), number=number, own=np.degrees(places[nearest]) % 360
                )
            )
        elif (quantity, number) not in asked:
            told.append(
                _("these answers are not requested and are not graded: {names}").format(names=f"{quantity} at {number}")
            )
        elif (quantity, number) in answers:
            told.append(repeated_answer_message(Heading(quantity, number)))
        else:
            answers[quantity, number] = given
    return replace(submission, answers=answers, by_angle={}, problems=(*submission.problems, *told[:MOST_TOLD]))
