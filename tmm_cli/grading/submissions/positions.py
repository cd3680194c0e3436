"""Answers whose position is told by the driver's angle, put to the task's positions of the student's variant."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tmm_cli.grading.record import Submission
from tmm_cli.grading.submissions.answers import MOST_TOLD, twice
from tmm_cli.grading.submissions.headings import Heading
from tmm_cli.grading.task import Task
from tmm_cli.language import _
from tmm_cli.vectors import Real

NEAR = np.radians(2.0)  # as angles are read off a drawing


def at_positions(submission: Submission, task: Task, places: Real) -> Submission:
    """The submission with these answers among the others; what is not counted of them is told.

    places: angles of the variant's positions (rad).
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
                _("{quantity} at phi = {angle:.6g} deg: the nearest position, {number}, is at {own:.6g} deg").format(
                    quantity=quantity, angle=np.degrees(angle), number=number, own=np.degrees(places[nearest]) % 360
                )
            )
        elif (quantity, number) not in asked:
            told.append(_("not asked, so not counted: {names}").format(names=f"{quantity} at {number}"))
        elif (quantity, number) in answers:
            told.append(twice(Heading(quantity, number)))
        else:
            answers[quantity, number] = given
    return replace(submission, answers=answers, by_angle={}, problems=(*submission.problems, *told[:MOST_TOLD]))
