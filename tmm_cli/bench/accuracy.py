"""Measurement of `tmm bench accuracy`: time per position and largest error of each method on each reference linkage."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from statistics import median
from typing import Any, ClassVar

import numpy as np

from tmm_cli.bench.measured import Measurement, csv_cell, target_slack, text_table, time_runs
from tmm_cli.bench.methods.case import (
    QUANTITIES,
    Case,
    Compared,
    Method,
    MethodAnswers,
    UnsupportedLinkageError,
    relative_errors,
)
from tmm_cli.bench.methods.registry import CLOSED_FORM, FEWER, METHODS, TAPED
from tmm_cli.bench.references import REFERENCE_NAMES, load_reference
from tmm_cli.bench.rivals import list_installed
from tmm_cli.mechanics.numerics import Real
from tmm_cli.reports import Table

QUANTITY_TITLES: dict[Compared, str] = {
    "positions": "Positions",
    "velocities": "Velocities",
    "accelerations": "Accelerations",
    "reactions": "Reactions",
    "balancing": "Balancing moment",
}
TIMED_POSITIONS = 360  # positions of a timed run
REPEATS, REDUCED_REPEATS = 15, 3
TARGETS: dict[Compared, float] = {quantity: 1e-14 if quantity == "positions" else 1e-13 for quantity in QUANTITIES}

Solver = Callable[[Real], MethodAnswers]


@dataclass(frozen=True)
class AccuracyRow:
    """Result of one method on one linkage.

    Attributes:
        linkage: name of the reference linkage.
        method: name of the method.
        family: name shared by methods that differ in one setting.
        setting: value of this setting, e.g. the tolerance; None if there is none.
        microseconds: time per position; None if it was not measured.
        errors: largest relative error of each quantity; nan if the method does not compute it.
    """

    linkage: str
    method: str
    family: str
    setting: float | None
    microseconds: float | None
    errors: dict[Compared, float]


@dataclass(frozen=True)
class Accuracy(Measurement):
    """Results of `tmm bench accuracy`.

    Attributes:
        rows: a result for each linkage and method.
        positions: number of positions in a timed run.
        repeats: number of timed runs, of which the median counts.
    """

    rows: tuple[AccuracyRow, ...]
    positions: int
    repeats: int

    met: ClassVar[str] = "all targets met: positions within 1e-14, all other quantities within 1e-13"

    @property
    def linkages(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(row.linkage for row in self.rows))

    @property
    def failures(self) -> tuple[str, ...]:
        """Messages on errors of tmm that exceed their targets."""
        return tuple(
            f"{row.linkage}: {row.method}: {quantity}: error {row.errors[quantity]:.2g}, target {TARGETS[quantity]:.0e}"
            for row in self.rows
            if row.method in (CLOSED_FORM.name, TAPED.name)
            for quantity in QUANTITIES
            if not row.errors[quantity] <= target_slack(self.reduced) * TARGETS[quantity]
        )

    def to_dict(self) -> dict[str, Any]:
        """Return the contents of the JSON file.

        An error that was not computed is null; an infinite one, where a method failed, is "inf".
        """
        content = super().to_dict() | {"targets": TARGETS}
        for row in content["rows"]:
            row["errors"] = {key: _plain(value) for key, value in row["errors"].items()}
        return content

    def lines(self) -> list[Sequence[object]]:
        """Return the rows of the CSV file: the header, then a row for each linkage and method."""
        header = ("linkage", "method", "family", "setting", "us_per_position", *QUANTITIES)
        return [
            header,
            *(
                (
                    row.linkage,
                    row.method,
                    row.family,
                    csv_cell(row.setting),
                    csv_cell(row.microseconds, 4),
                    *(csv_cell(row.errors[quantity]) for quantity in QUANTITIES),
                )
                for row in self.rows
            ),
        ]

    @property
    def tables(self) -> tuple[Table, ...]:
        """Tables of times and errors, one for each linkage."""
        return tuple(
            text_table(
                "accuracy",
                f"Errors relative to the largest value in the cycle: {name}",
                ("method", "µs per position", *QUANTITY_TITLES.values()),
                [
                    (
                        row.method,
                        "-" if row.microseconds is None else f"{row.microseconds:.3g}",
                        *("-" if math.isnan(row.errors[q]) else f"{row.errors[q]:.1e}" for q in QUANTITY_TITLES),
                    )
                    for row in self.rows
                    if row.linkage == name
                ],
            )
            for name in self.linkages
        )


def _plain(value: float) -> float | str | None:
    return None if math.isnan(value) else value if math.isfinite(value) else "inf"


def sample_coordinates(case: Case, count: int) -> Real:
    """Return `count` equally spaced driver coordinates (rad) over one revolution.

    They are shifted by a fraction of the spacing, so that no method is helped by special positions such as the start.
    """
    return case.start + case.law.sense * 2 * np.pi * (np.arange(count) + 0.3717) / count


def measure_accuracy(
    linkages: Sequence[str] = REFERENCE_NAMES,
    *,
    reduced: bool = False,
    methods: Iterable[Method] | None = None,
    progress: Callable[[str], None] = lambda __: None,
) -> Accuracy:
    """Measure the errors of all methods against reference values of 50 digits, and their times.

    The methods are timed alternately in one process; the median of the repeats counts.

    Args:
        linkages: Names of reference linkages.
        reduced: True for fewer methods and repeats.
        methods: Methods to measure; by default all.
        progress: Called with the name of each linkage.
    """
    chosen = tuple(methods or (FEWER if reduced else METHODS))
    rivals, missing = list_installed()
    absent = [f"{name}: not installed" for name in missing]
    repeats = REDUCED_REPEATS if reduced else REPEATS
    rows: list[AccuracyRow] = []
    for name in linkages:
        progress(name)
        true = load_reference(name)
        solvers: dict[Method, Solver] = {}
        for method in (*chosen, *rivals):
            try:
                solvers[method] = method.prepare(true.case)
            except UnsupportedLinkageError as error:
                absent.append(f"{method.name}: {name}: {error}")
        worst = {method: relative_errors(solver(true.q), true.exact) for method, solver in solvers.items()}
        q = sample_coordinates(true.case, TIMED_POSITIONS)
        seconds = time_runs({m: partial(solver, q) for m, solver in solvers.items() if m.timed}, repeats)
        micro = {m: 1e6 * median(of_turns) / TIMED_POSITIONS for m, of_turns in seconds.items()}
        rows += [AccuracyRow(name, m.name, m.family, m.setting, micro.get(m), worst[m]) for m in solvers]
    return Accuracy(tuple(rows), TIMED_POSITIONS, repeats, reduced=reduced, absent=tuple(absent))
