"""Groups made up for measuring: variants of a six-bar with forces, answers drawn to 1 %, right or with mistakes in."""

from __future__ import annotations

import csv
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from importlib.resources import files
from pathlib import Path

import numpy as np

from tmm_cli.grading.grade import numbers_of
from tmm_cli.grading.mistakes import cases
from tmm_cli.grading.mistakes.base import Mistake
from tmm_cli.grading.record import VariantTable
from tmm_cli.grading.sheet import Right, predicted, right
from tmm_cli.grading.task import Task, read_task
from tmm_cli.problem.reader import read_text
from tmm_cli.variants.family import Family, families
from tmm_cli.vectors import Real, Vector

DRAWING = 0.01  # of the largest value: how far off answers are at most
MOVES = 4  # times that a mistake must move an answer, or nobody could see it
BOUNDS = {"OA": (90.0, 110.0, "mm"), "AB": (340.0, 360.0, "mm"), "n1": (80.0, 110.0, "rpm")}


@cache
def text() -> str:
    """The task's file."""
    return (files("tmm_cli.bench") / "data" / "grading" / "six-bar.yaml").read_text(encoding="utf-8")


@dataclass(frozen=True, eq=False)
class Group:
    """Students with variants of their own; what is right for them."""

    task: Task
    table: VariantTable
    family: Family
    right: Right
    random: np.random.Generator

    @cached_property
    def cases(self) -> tuple[Mistake, ...]:
        return cases(self.family)

    @cached_property
    def with_mistake(self) -> Vector:
        """What each mistake makes of the sheets, (cases, students, answers)."""
        with np.errstate(all="ignore"):
            return np.stack([predicted(self.family, self.right.asked, [case]) for case in self.cases])

    @cached_property
    def seen(self) -> Real:
        """Which mistakes can be seen on whose sheets, (cases, students)."""
        with np.errstate(all="ignore"):
            moved = np.max(np.abs(self.with_mistake - self.right.value) / self.right.scale, axis=2)
        found: Real = np.isfinite(moved) & (moved >= MOVES * DRAWING)
        return found

    def mistakes(self, n: int, count: int) -> tuple[int, ...]:
        """So many of different kinds that can be seen on the sheet of a student, kinds alike often."""
        kinds: dict[type[Mistake], list[int]] = {}
        for c in np.flatnonzero(self.seen[:, n]).tolist():
            kinds.setdefault(type(self.cases[c]), []).append(c)
        chosen = self.random.permutation(len(kinds))[:count]
        own = list(kinds.values())
        return tuple(int(self.random.choice(own[k])) for k in chosen)

    def sheets(self, made: Sequence[tuple[int, ...]]) -> Vector:
        """Answers with these mistakes in, drawn."""
        value = self.right.value.copy()
        for n, own in enumerate(made):
            if len(own) == 1:
                value[n] = self.with_mistake[own[0], n]
            elif own:
                with np.errstate(all="ignore"):
                    two = predicted(self.family.take([n]), self.right.asked, [self.cases[c] for c in own])
                value[n] = two[0]
        return self.drawn(value)

    def drawn(self, value: Vector, rows: Real | None = None) -> Vector:
        """Answers as they are measured off a plan of these values; exact ones are counted, not measured.

        rows: whose they are, all students when left out.
        """
        scale = self.right.scale if rows is None else self.right.scale[rows]
        vector, exact = (np.array(found) for found in zip(*(
            (asked.quantity.vector, asked.quantity.against == "exact") for asked in self.right.asked
        ), strict=True))  # fmt: skip
        off = self.random.uniform(-DRAWING, DRAWING, value.shape)
        aside = self.random.uniform(-DRAWING, DRAWING, value.shape) * vector
        size = np.maximum(scale, np.abs(value)) / np.where(vector, np.sqrt(2), 1)
        return np.where(exact, value, value + (off + 1j * aside) * size)


def group(count: int, seed: int = 1) -> Group:
    """So many students."""
    task = read_task(read_text(text(), "six-bar.yaml"))
    random = np.random.default_rng(seed)
    columns = [[f"{x:.2f} {unit}" for x in random.uniform(low, high, count)] for low, high, unit in BOUNDS.values()]
    rows = {str(n): row for n, row in enumerate(zip(*columns, strict=True))}
    table = VariantTable(tuple(BOUNDS), rows)
    family = family_of(task, table)
    return Group(task, table, family, right(family, task.asked), random)


def family_of(task: Task, table: VariantTable) -> Family:
    """All variants of a table, solved together."""
    dimensions, numbers = numbers_of(task, table, list(table.rows))
    ((rows, family),) = families(lambda own: task.make(table.names, dimensions, own), numbers)
    if not isinstance(family, Family) or len(rows) < len(table.rows):
        raise AssertionError("a variant of the measurement cannot be assembled")
    return family


def write(group: Group, sheets: Vector, folder: Path, first: int = 0) -> None:
    """The task, the table of variants, and a file of each student, as they are handed in.

    first: students who are there already.
    """
    (folder / "submissions").mkdir(parents=True, exist_ok=True)
    (folder / "task.yaml").write_text(text(), encoding="utf-8")
    names = [f"student-{first + n + 1}" for n in range(len(sheets))]
    rows = [[name, *row] for name, row in zip(names, group.table.rows.values(), strict=True)]
    with (folder / "variants.csv").open("a", encoding="utf-8", newline="") as stream:
        csv.writer(stream).writerows(rows if first else [["student", *group.table.names], *rows])
    for name, own in zip(names, sheets.tolist(), strict=True):
        with (folder / "submissions" / f"{name}.csv").open("w", encoding="utf-8", newline="") as stream:
            csv.writer(stream).writerows(_rows(group.task, own))


def _rows(task: Task, values: Sequence[complex]) -> Iterator[Sequence[object]]:
    yield "quantity", "position", "unit", "value", "x", "y"
    for asked, value in zip(task.asked, values, strict=True):
        number = value / task.units.factor(asked.quantity.dimension)
        x, y = f"{number.real:.4g}", f"{number.imag:.4g}"
        own = ("", x, y) if asked.quantity.vector else (x, "", "")
        position = "" if asked.number is None else asked.number
        yield asked.quantity.name, position, task.units.symbol(asked.quantity.dimension), *own
