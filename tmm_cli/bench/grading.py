"""Measurement of `tmm bench grading`: time to grade a group, its growth, and the share of mistakes named correctly.

The groups are simulated. Their variants are those of a six-bar with forces. The answers have drawing errors of 1 %, and
some contain mistakes.
"""

from __future__ import annotations

import csv
import math
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from importlib.resources import files
from pathlib import Path
from typing import Literal

import numpy as np

import tmm_cli
from tmm_cli.batch import Task, VariantFamily, read_task, split_families
from tmm_cli.bench.measured import CLOCK, Measurement, target_slack, text_table
from tmm_cli.grading import (
    CHUNK,
    Mistake,
    RightAnswers,
    VariantGenerator,
    VariantTable,
    WrittenAnswers,
    compute_right_answers,
    diagnose_students,
    find_carried_errors,
    list_cases,
    predict_answers,
    read_parameter_values,
    replace_by_own_answer,
    solve_with_mistakes,
)
from tmm_cli.mechanics.numerics import Real, Vector
from tmm_cli.problem import read_text
from tmm_cli.reports import Table

DRAWING_ERROR = 0.01  # fraction of the largest value: largest error of a drawn answer
VISIBLE_FACTOR = 4  # multiple of the drawing error by which a visible mistake changes an answer
BOUNDS = {"OA": (90.0, 110.0, "mm"), "AB": (340.0, 360.0, "mm"), "n1": (80.0, 110.0, "rpm")}


@cache
def grading_task_text() -> str:
    """Return the text of the task file that the simulated students solve."""
    return (files("tmm_cli.bench") / "data" / "grading" / "six-bar.yaml").read_text(encoding="utf-8")


@dataclass(frozen=True, eq=False)
class StudentGroup:
    """Simulated students.

    Attributes:
        task: task that they solve.
        table: parameter values of their variants.
        family: their variants, solved together.
        right: right answers of their variants.
        random: generator of their mistakes and drawing errors.
    """

    task: Task
    table: VariantTable
    family: VariantFamily
    right: RightAnswers
    random: np.random.Generator

    @cached_property
    def cases(self) -> tuple[Mistake, ...]:
        return list_cases(self.family)

    @cached_property
    def with_mistake(self) -> Vector:
        """Answers that result from each mistake, (mistakes, students, answers)."""
        with np.errstate(all="ignore"):
            return np.stack([predict_answers(self.family, self.right.asked, [case]) for case in self.cases])

    @cached_property
    def visible(self) -> Real:
        """True for a mistake that visibly changes at least two answers of a student, (mistakes, students)."""
        with np.errstate(all="ignore"):
            moved = np.abs(self.with_mistake - self.right.value) / self.right.scale
        second = np.sort(moved, axis=2)[:, :, -2]
        visible: Real = np.all(np.isfinite(moved), axis=2) & (second >= VISIBLE_FACTOR * DRAWING_ERROR)
        return visible

    def choose_mistakes(self, n: int, count: int) -> tuple[int, ...]:
        """Choose `count` random mistakes of different kinds for student n; return their indices.

        Only mistakes that visibly change the answers of this student are chosen; all kinds are equally likely.
        """
        kinds: dict[str, list[int]] = {}
        for c in np.flatnonzero(self.visible[:, n]).tolist():
            kinds.setdefault(self.cases[c].code, []).append(c)
        chosen = self.random.permutation(len(kinds))[:count]
        kind_members = list(kinds.values())
        return tuple(int(self.random.choice(kind_members[k])) for k in chosen)

    def make_answers(self, mistakes: Sequence[tuple[int, ...]]) -> Vector:
        """Return answers with drawing errors, (students, answers).

        mistakes: for each student, the indices of the mistakes made.
        """
        value, factor = self.right.value.copy(), np.ones(self.right.value.shape)
        for n, student_mistakes in enumerate(mistakes):
            if len(student_mistakes) == 1:
                value[n] = self.with_mistake[student_mistakes[0], n]
                case, right = self.cases[student_mistakes[0]], self.right.value[n]
                if not case.solves or case.price:  # a right drawing, read or written in another unit
                    factor[n] = np.minimum(1, np.abs(value[n] / np.where(right == 0, 1, right)))
            elif student_mistakes:
                with np.errstate(all="ignore"):
                    two = predict_answers(
                        self.family.take([n]), self.right.asked, [self.cases[c] for c in student_mistakes]
                    )
                value[n] = two[0]
        drawn: Vector = value + factor * (self.add_drawing_errors(value) - value)
        return drawn

    def add_drawing_errors(self, value: Vector, rows: Real | None = None) -> Vector:
        """Return values with random drawing errors; quantities that must be exact (e.g. mobility) are unchanged.

        Args:
            value: Values, (students, answers).
            rows: Indices of the students to whom the values belong; None for all.
        """
        scale = self.right.scale if rows is None else self.right.scale[rows]
        vector, exact = (
            np.array(flags)
            for flags in zip(
                *((answer.quantity.vector, answer.quantity.against == "exact") for answer in self.right.asked),
                strict=True,
            )
        )
        off = self.random.uniform(-DRAWING_ERROR, DRAWING_ERROR, value.shape)
        aside = self.random.uniform(-DRAWING_ERROR, DRAWING_ERROR, value.shape) * vector
        magnitude = np.maximum(scale, np.abs(value)) / np.where(vector, np.sqrt(2), 1)
        return np.where(exact, value, value + (off + 1j * aside) * magnitude)


def make_students(count: int, seed: int = 1) -> StudentGroup:
    """Simulate students whose variants have random parameter values."""
    task = read_task(read_text(grading_task_text(), "six-bar.yaml"))
    random = np.random.default_rng(seed)
    columns = [[f"{x:.2f} {unit}" for x in random.uniform(low, high, count)] for low, high, unit in BOUNDS.values()]
    rows = {str(n): row for n, row in enumerate(zip(*columns, strict=True))}
    table = VariantTable(tuple(BOUNDS), rows)
    family = solve_family(task, table)
    return StudentGroup(task, table, family, compute_right_answers(family, task.asked), random)


def solve_family(task: Task, table: VariantTable) -> VariantFamily:
    """Build all variants of a table together, with their data as arrays (variants, 1)."""
    dimensions, numbers = read_parameter_values(task, table, list(table.rows))
    ((rows, family),) = split_families(lambda values: task.make(table.names, dimensions, values), numbers)
    if not isinstance(family, VariantFamily) or len(rows) < len(table.rows):
        raise AssertionError("a variant of the measurement cannot be assembled")
    return family


def write_submissions(group: StudentGroup, sheets: Vector, folder: Path, first: int = 0) -> None:
    """Write the files of a course: the task, the table of variants, and the answers of each student.

    Args:
        group: Students.
        sheets: Their answers, (students, answers).
        folder: Folder for the files.
        first: Number of students written before; the table of variants is continued.
    """
    (folder / "submissions").mkdir(parents=True, exist_ok=True)
    (folder / "task.yaml").write_text(grading_task_text(), encoding="utf-8")
    names = [f"student-{first + n + 1}" for n in range(len(sheets))]
    rows = [[name, *row] for name, row in zip(names, group.table.rows.values(), strict=True)]
    with (folder / "variants.csv").open("a", encoding="utf-8", newline="") as stream:
        csv.writer(stream).writerows(rows if first else [["student", *group.table.names], *rows])
    for name, answers in zip(names, sheets.tolist(), strict=True):
        with (folder / "submissions" / f"{name}.csv").open("w", encoding="utf-8", newline="") as stream:
            csv.writer(stream).writerows(_submission_rows(group.task, answers))


def _submission_rows(task: Task, values: Sequence[complex]) -> Iterator[Sequence[object]]:
    yield "quantity", "position", "unit", "value", "x", "y"
    for answer, value in zip(task.asked, values, strict=True):
        number = value / task.units.factor(answer.quantity.dimension)
        x, y = f"{number.real:.4g}", f"{number.imag:.4g}"
        cells = ("", x, y) if answer.quantity.vector else (x, "", "")
        position = "" if answer.number is None else answer.number
        yield answer.quantity.name, position, task.units.symbol(answer.quantity.dimension), *cells


# Figures of `tmm bench grading`.


STUDENTS, REDUCED_STUDENTS = (2_000, 10_000), (300,)
FULL_STUDENTS = 100_000  # students of a full run
TARGET_STUDENTS = 10_000  # to which the targets apply
PART_STUDENTS = 1_000  # students simulated at once
SECONDS, BEGINNING = 60.0 / 10_000, 3.0  # s per student; s of any run
MEMORY, SOLVING, GROWTH = 1000.0, 5.0, 1.1  # MB of all processes; % of the processor time; exponent of the students
ONE, TWO = 0.2, 0.05  # shares of the students with one mistake, with two
SHEETS, REDUCED_SHEETS = 1000, 60
CHAINS, REDUCED_CHAINS = 500, 40
CANDIDATES, REDUCED_CANDIDATES, PER_SECOND = 10_000, 2_000, 10_000.0
LOOKS = 0.05  # s between observations of the memory


@dataclass(frozen=True)
class GradingFigure:
    """A measured number of `tmm bench grading`, and its target.

    Attributes:
        what: what was measured.
        of: number of students, sheets or candidates that were measured.
        found: measured value.
        target: limit of the value; None if there is none.
        bound: "most" if the target is the largest permitted value, "least" if it is the smallest.
        absolute: True for times, which depend on the machine and its load; a reduced run does not check them.
    """

    what: str
    of: int
    found: float
    target: float | None = None
    bound: Literal["most", "least"] = "most"
    absolute: bool = False

    def describe_miss(self, slack: float) -> str:
        if self.target is None or math.isnan(self.found):
            return ""
        if self.bound == "most":
            fails = self.found > self.target * slack
        elif self.target <= 100:  # per cent: the remainder to 100 is widened
            fails = self.found < 100 - (100 - self.target) * slack
        else:
            fails = self.found < self.target / slack
        if not fails:
            return ""
        text = "{what}, of {of}: {found}, target {target:g}"
        return text.format(what=self.what, of=self.of, found=f"{self.found:.4g}", target=self.target)


@dataclass(frozen=True)
class GradingMeasurement(Measurement):
    """Results of `tmm bench grading`."""

    figures: tuple[GradingFigure, ...]

    @property
    def failures(self) -> tuple[str, ...]:
        judged = (figure for figure in self.figures if not (self.reduced and figure.absolute))
        return tuple(filter(None, (figure.describe_miss(target_slack(self.reduced)) for figure in judged)))

    @property
    def tables(self) -> tuple[Table, ...]:
        title = "Grading of a group: six-bar with forces, 12 answers each, drawn to 1 %"
        signs = {"most": "≤", "least": "≥"}
        rows = [
            (
                figure.what,
                str(figure.of),
                f"{figure.found:.4g}",
                "" if figure.target is None else f"{signs[figure.bound]} {figure.target:.4g}",
            )
            for figure in self.figures
        ]
        return (text_table("grading", title, ("figure", "of", "found", "target"), rows),)


def measure_grading(
    *, reduced: bool = False, full: bool = False, progress: Callable[[str], None] = lambda _: None
) -> GradingMeasurement:
    """Measure all figures of `tmm bench grading`.

    Args:
        reduced: True for smaller groups.
        full: True to grade also 100 000 students.
        progress: Called with the name of each step.
    """
    sheets = REDUCED_SHEETS if reduced else SHEETS
    figures: list[GradingFigure] = []
    students = make_students(sheets)
    for count in range(3):
        progress(f"diagnosis of {count} mistakes")
        figures += measure_diagnosis(students, count)
    progress("error carried forward")
    figures.append(measure_carried_errors(make_students(REDUCED_CHAINS if reduced else CHAINS, seed=2)))
    progress("variants")
    figures.append(measure_variant_selection(REDUCED_CANDIDATES if reduced else CANDIDATES))
    sizes = REDUCED_STUDENTS if reduced else (*STUDENTS, *[FULL_STUDENTS] * full)
    return GradingMeasurement((*figures, *measure_command(sizes, progress)), reduced=reduced)


def measure_diagnosis(group: StudentGroup, count: int) -> Iterator[GradingFigure]:
    """Measure how the mistakes in simulated sheets are named; each sheet contains `count` mistakes.

    The results are the percentages of sheets in which a mistake is named correctly, in which only wrong mistakes are
    named, and in which a wrong mistake is named beside a correct one. If `count` is 0, they are the percentages of
    sheets in which an answer is marked wrong, and in which a mistake is named.
    """
    students = range(len(group.family))
    mistakes = [group.choose_mistakes(n, count) for n in students]
    value = group.make_answers(mistakes)
    written = WrittenAnswers(value, np.zeros(value.shape, dtype=bool))
    claims = diagnose_students(group.family, group.right, written)
    rightly = wrongly = beside = 0
    for n in students:
        made_kinds = {group.cases[c].code for c in mistakes[n]}
        hits = [bool(made_kinds & {case.code for case in claim.alternatives}) for claim in claims.get(n, ())]
        rightly += any(hits)
        wrongly += bool(hits) and not any(hits)
        beside += not all(hits)
    share = 100 / len(students)
    if count == 0:
        fails = np.any(group.right.error(written) > group.right.allowed, axis=1)
        yield GradingFigure("correct sheets with an answer marked wrong, %", len(students), share * np.sum(fails), 0.0)
        yield GradingFigure("correct sheets with a mistake claimed, %", len(students), share * wrongly, 0.0)
        return
    least, most = ((95.0, 1.0), (80.0, 2.0))[count - 1]
    title = ("sheets with one mistake, {how}, %", "sheets with two mistakes, {how}, %")[count - 1]
    yield GradingFigure(title.format(how="named correctly"), len(students), share * rightly, least, "least")
    yield GradingFigure(title.format(how="named wrongly"), len(students), share * wrongly, most)
    yield GradingFigure(
        title.format(how="with another mistake also claimed"), len(students), share * (beside - wrongly)
    )


def measure_carried_errors(group: StudentGroup) -> GradingFigure:
    """Measure the percentage of students who lose the points of only one answer when they make one error.

    In each sheet one answer is far off, and all later answers follow correctly from it.
    """
    right, chance = group.right, group.random
    count = len(group.family)
    drawn, source = group.add_drawing_errors(right.value), np.full(count, -1)
    motion = solve_with_mistakes(group.family).motion
    begins = [
        k
        for k, answer in enumerate(right.asked)
        if replace_by_own_answer(answer.quantity, right.value[:, [k]], motion, right.value[:, [k]]) is not None
    ]
    for k, rows in zip(begins, np.array_split(np.arange(count), len(begins)), strict=True):
        answer, subfamily = right.asked[k], group.family.take(rows)
        turn = np.exp(2j * np.pi * chance.random(len(rows)))
        direction = turn if answer.quantity.vector else np.sign(turn.real)
        wrong_values = right.value[rows, k] + chance.uniform(0.2, 0.6, len(rows)) * right.scale[rows, k] * direction
        mistake = replace_by_own_answer(
            answer.quantity, wrong_values[:, None], solve_with_mistakes(subfamily).motion, right.value[rows, k][:, None]
        )
        later = group.add_drawing_errors(predict_answers(subfamily, right.asked, [mistake] if mistake else []), rows)
        same = [j for j, other in enumerate(right.asked) if other.position == answer.position]
        drawn[rows[:, None], same] = later[:, same]
        drawn[rows, k], source[rows] = wrong_values, k
    written = WrittenAnswers(drawn, np.zeros(drawn.shape, dtype=bool))
    follows = find_carried_errors(group.family, right, written)
    wrong = right.error(written) > right.allowed
    alone = sum(
        {k for k in np.flatnonzero(wrong[n]).tolist() if (n, k) not in follows} == {int(source[n])}
        for n in range(count)
    )
    title = "students who lose the points of one answer only, %"
    return GradingFigure(title, count, 100 * alone / count, 100.0, "least")


def measure_variant_selection(count: int) -> GradingFigure:
    """Measure how many candidates for variants are checked per second on one core."""
    variety = VariantGenerator(make_students(1).task)
    random = np.random.default_rng(1)
    picks = np.stack([random.integers(0, len(values), count) for values in variety.numbers], axis=1)
    per_second = 0.0
    for first in range(0, count, CHUNK):  # the least time counts: other work of the machine only adds to it
        start = CLOCK()
        judgements = variety.check(picks[first : first + CHUNK])
        per_second = max(per_second, len(judgements.why) / (CLOCK() - start))
    return GradingFigure(
        "candidates for variants judged per second", count, per_second, PER_SECOND, "least", absolute=True
    )


def measure_command(sizes: Sequence[int], progress: Callable[[str], None]) -> Iterator[GradingFigure]:
    """Measure the time and the memory of `tmm grade` for groups of these sizes.

    The last result is the exponent p of the growth of time with the number of students n, time ~ n^p.
    """
    times = []
    for students in sizes:
        progress(f"{students} students")
        solving = 0.0
        with tempfile.TemporaryDirectory() as folder:
            for number in range(-(-students // PART_STUDENTS)):
                students_part = make_students(min(PART_STUDENTS, students - PART_STUDENTS * number), seed=number + 3)
                write_submissions(
                    students_part,
                    students_part.make_answers(_draw_mistakes(students_part)),
                    Path(folder),
                    PART_STUDENTS * number,
                )
                start = CLOCK()
                solve_with_mistakes(solve_family(students_part.task, students_part.table))
                solving += CLOCK() - start
            run = _run_command(Path(folder))
        times.append(run.first + run.others)
        limit = SECONDS * students + (BEGINNING if students < TARGET_STUDENTS else 0)
        least = min(run.seconds, run.first + run.others / 2)  # other work of the machine counts in the former only
        yield GradingFigure("graded with all outputs on two cores, s", students, least, limit, absolute=True)
        yield GradingFigure("the same, wall-clock time, s", students, run.seconds)
        yield GradingFigure("the same, processor time, s", students, times[-1])
        yield GradingFigure(
            "memory of all processes, MB", students, run.memory, MEMORY if students <= TARGET_STUDENTS else None
        )
        yield GradingFigure(
            "solving the variants, % of the processor time", students, 100 * solving / times[-1], SOLVING
        )
    for k in range(1, len(sizes)):
        power = math.log(times[k] / times[k - 1]) / math.log(sizes[k] / sizes[k - 1])
        yield GradingFigure("exponent of the growth of time with students", sizes[k], power, GROWTH)


def _draw_mistakes(group: StudentGroup) -> list[tuple[int, ...]]:
    """Choose the mistakes of each student of a typical group, in which most students make none."""
    draws = group.random.random(len(group.family))
    return [group.choose_mistakes(n, 2 if x < TWO else 1 if x < TWO + ONE else 0) for n, x in enumerate(draws.tolist())]


@dataclass
class _CommandRun:
    """Resources that a command used.

    Attributes:
        seconds: wall-clock time, s.
        first: processor time of its first process, s.
        others: processor time of its other processes, s.
        memory: largest memory of all processes together, MB.
    """

    seconds: float = math.nan
    first: float = math.nan
    others: float = 0.0
    memory: float = math.nan


def _run_command(folder: Path) -> _CommandRun:
    """Run `tmm grade` with two processes and return the resources it used."""
    call = ["-m", "tmm_cli", "grade", "task.yaml", "--variants", "variants.csv", "--submissions", "submissions"]
    environment = {**os.environ, "PYTHONPATH": str(Path(tmm_cli.__file__).parents[1])}
    run, begun, start = _CommandRun(), os.times(), time.perf_counter()
    with (folder / "told.txt").open("wb") as output:
        running = subprocess.Popen(
            [sys.executable, *call, "--jobs", "2"], cwd=folder, env=environment, stdout=output, stderr=output
        )
        while running.poll() is None:
            _observe_process(run, running.pid)
            time.sleep(LOOKS)
    run.seconds, ended = time.perf_counter() - start, os.times()
    if running.returncode:
        raise RuntimeError((folder / "told.txt").read_text(encoding="utf-8", errors="replace")[-2000:])
    processor_time = ended.children_user + ended.children_system - begun.children_user - begun.children_system
    run.first = run.seconds if math.isnan(run.first) else run.first
    run.others = max(0.0, processor_time - run.first)
    return run


def _observe_process(run: _CommandRun, process: int) -> None:
    """Update the resources used by a running process, if the system reports them."""
    try:
        proc_folder = Path(f"/proc/{process}")
        run.first = sum(
            map(int, proc_folder.joinpath("stat").read_text().rpartition(")")[2].split()[11:13])
        ) / os.sysconf("SC_CLK_TCK")
        children = proc_folder.joinpath(f"task/{process}/children").read_text().split()
        pages = sum(
            int(Path(f"/proc/{process_id}/statm").read_text().split()[1]) for process_id in (process, *children)
        )
        run.memory = float(np.fmax(run.memory, pages * os.sysconf("SC_PAGE_SIZE") / 2**20))
    except (OSError, ValueError, AttributeError, IndexError):
        pass  # it has ended, or the system has no /proc
