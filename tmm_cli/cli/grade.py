"""Command `tmm grade`: grade the submissions of a group of students and explain their mistakes."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from types import FrameType
from typing import Annotated

import typer

from tmm_cli.batch import Task, in_processes, on_cluster, read_task
from tmm_cli.cli.common import Jobs, Scheduler, console, progress_bars, reporting_errors
from tmm_cli.cli.opening import print_file_summary, read_in_file_language
from tmm_cli.cli.talk import BAD_INPUT, CHECK_FAILED, OK, printable, say, warn
from tmm_cli.grading import (
    EXPORTS,
    Gradebook,
    StudentMarks,
    Submission,
    check_load_tables,
    grade_group,
    read_submissions,
    read_table,
    statistics_tables,
    write_gradebook,
    write_template,
)
from tmm_cli.language import _
from tmm_cli.problem import ProblemError, parse_names
from tmm_cli.reports import print_on_terminal, refuse_unwritable

CACHE_FOLDER = ".graded"  # in the output folder: marks of earlier runs

File = Annotated[str, typer.Argument(metavar="TASK", help="Problem file with a block `grading`.", show_default=False)]
Variants = Annotated[
    str | None, typer.Option(metavar="FILE", help="Table of the students' variants, CSV or XLSX.", show_default=False)
]
Submissions = Annotated[
    str | None, typer.Option(metavar="PATH", help="Folder with one file per student, or one table.", show_default=False)
]
Folder = Annotated[Path, typer.Option("--out", "-o", metavar="DIR", help="Folder for marks and feedback.")]
Reveal = Annotated[bool, typer.Option("--reveal", help="Show the right values in the feedback.")]
Formats = Annotated[
    str | None, typer.Option(metavar="NAMES", help="Write only these formats, e.g. csv,moodle.", show_default=False)
]
Template = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE", help="Write an empty answer sheet to this file (.xlsx, .csv or .yaml).", show_default=False
    ),
]


def grade(
    file: File,
    variants: Variants = None,
    submissions: Submissions = None,
    out: Folder = Path("marks"),
    reveal: Reveal = False,
    formats: Formats = None,
    jobs: Jobs = None,
    scheduler: Scheduler = None,
    template: Template = None,
) -> None:
    """Mark the submissions of a group; a second run marks only those that have changed.

    Exit code 1 if a submission could not be marked. With --template only an empty answer sheet is written.
    """
    with reporting_errors():
        task = read_task(read_in_file_language(file))
        if template is not None:
            write_template(task, template)
            say(_("written: {files}").format(files=printable(template)))
            raise typer.Exit(OK)
        if variants is None or submissions is None:
            say(_("error: give --variants and --submissions, or --template"))
            raise typer.Exit(BAD_INPUT)
        refuse_unwritable(out, folder=True)
        raise typer.Exit(_grade_group(task, variants, submissions, out, reveal, formats, jobs, scheduler))


def _grade_group(
    task: Task,
    variants: str,
    submissions: str,
    out: Path,
    reveal: bool,
    formats: str | None,
    jobs: int | None,
    scheduler: str | None,
) -> int:
    """Grade the submissions, write and print the marks, and return the exit code. Raises ProblemError or OSError."""
    reason = _("there is no gradebook format of that name")
    names = list(EXPORTS) if formats is None else parse_names(formats, EXPORTS, "--formats", reason)
    print_file_summary(task.problem)
    table = read_table(variants, task)
    with suppress(ProblemError):  # an unreadable value is reported when the student is graded
        for slip in check_load_tables(task, table):
            warn(f"{task.problem.name}: {slip}")
    jobs = jobs or os.cpu_count() or 1
    runner = on_cluster(scheduler) if scheduler else in_processes(jobs)
    with progress_bars() as progress, _stop_on_interrupt() as stopped:
        reading = progress.add_task(_("submissions read"), total=len(table.rows))
        handed = []
        for submission in read_submissions(submissions, task, table.rows):
            handed.append(submission)
            progress.advance(reading)
        place = {student: n for n, student in enumerate(table.rows)}
        handed.sort(key=lambda submission: place.get(submission.student, len(place)))
        grading = progress.add_task(_("submissions graded"), total=len(handed))
        marks = grade_group(
            task, table, handed, runner, out / CACHE_FOLDER, lambda count: progress.advance(grading, count), stopped
        )
    if len(marks) < len(handed):
        text = _("stopped; submissions graded: {done} of {count}; the next run keeps their marks and grades the others")
        say(text.format(done=len(marks), count=len(handed)))
        return CHECK_FAILED
    write_gradebook(out, Gradebook(task.reveal_values() if reveal else task, marks, users=table.rows), names, jobs)
    for statistics in statistics_tables(task, marks):
        print_on_terminal(statistics, task.units, console())
    return _print_summary(handed, marks, out)


@contextmanager
def _stop_on_interrupt() -> Iterator[Callable[[], bool]]:
    """Context manager in which the first Ctrl-C lets running work finish; a second one ends the command.

    Yields:
        A function that returns True after the first Ctrl-C.
    """
    pressed = []

    def note(number: int, frame: FrameType | None) -> None:
        pressed.append(number)
        signal.signal(signal.SIGINT, before)
        say(_("stopping as soon as the submissions now being graded are finished"))

    before = signal.signal(signal.SIGINT, note)
    try:
        yield lambda: bool(pressed)
    finally:
        signal.signal(signal.SIGINT, before)


def _print_summary(handed: Sequence[Submission], marks: Sequence[StudentMarks], out: Path) -> int:
    """Print how many students were graded, and return the exit code."""
    both = list(zip(handed, marks, strict=True))
    left = sum(submission.unread or grade.problems != submission.problems for submission, grade in both)
    none = sum(
        not (submission.unread or submission.answers or submission.by_angle)
        for submission, grade in both
        if grade.problems == submission.problems
    )
    text = _("written: {folder}; students graded: {count}, without an answer: {none}, impossible to grade: {left}")
    say(text.format(folder=printable(out), count=len(both) - none - left, none=none, left=left))
    return CHECK_FAILED if left else OK
