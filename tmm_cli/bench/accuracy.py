"""`tmm bench accuracy`: time a position against largest error, for every method on every linkage."""

from __future__ import annotations

import csv
import io
import math
import platform
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass, field
from statistics import median
from time import get_clock_info, perf_counter, process_time
from typing import Any

import numpy as np

from tmm_cli import __version__
from tmm_cli.accuracy.case import QUANTITIES, Answers, Case, Method, Quantity, Unable, errors
from tmm_cli.accuracy.methods import FEWER, METHODS, OURS, TAPED
from tmm_cli.bench.references import NAMES, reference
from tmm_cli.vectors import Real

COUNT = 360  # positions of a timed run
REPEATS, REDUCED_REPEATS = 15, 3
TARGETS: dict[Quantity, float] = {quantity: 1e-14 if quantity == "positions" else 1e-13 for quantity in QUANTITIES}
SLACK_WHEN_REDUCED = 2.0

# the processor's time, which does not count what other programs take, where it is counted finely enough
CLOCK = process_time if get_clock_info("process_time").resolution < 1e-6 else perf_counter

Solver = Callable[[Real], Answers]


@dataclass(frozen=True)
class Row:
    """One method on one linkage. microseconds: a position, None where time means nothing; errors: nan is not given."""

    linkage: str
    method: str
    family: str
    setting: float | None
    microseconds: float | None
    errors: dict[Quantity, float]


@dataclass(frozen=True)
class Accuracy:
    """The whole measurement. absent: rivals that are not installed, or cannot do a linkage, and why."""

    rows: tuple[Row, ...]
    positions: int
    repeats: int
    reduced: bool
    absent: tuple[str, ...] = ()
    machine: dict[str, str] = field(default_factory=dict)

    @property
    def failures(self) -> tuple[str, ...]:
        """Where the product misses its targets."""
        slack = SLACK_WHEN_REDUCED if self.reduced else 1.0
        return tuple(
            f"{row.linkage}: {row.method}: {quantity}: error {row.errors[quantity]:.2g}, target {TARGETS[quantity]:.0e}"
            for row in self.rows if row.method in (OURS.name, TAPED.name)
            for quantity in QUANTITIES if not row.errors[quantity] <= slack * TARGETS[quantity]
        )  # fmt: skip

    def to_dict(self) -> dict[str, Any]:
        """JSON: what is not given or not timed is null, an infinite error (the method failed) is "inf"."""
        content = asdict(self) | {"targets": TARGETS, "failures": list(self.failures)}
        for row in content["rows"]:
            row["errors"] = {key: _plain(value) for key, value in row["errors"].items()}
        return content

    def to_csv(self) -> str:
        """A line a linkage and method."""
        stream = io.StringIO()
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(["linkage", "method", "family", "setting", "us_per_position", *QUANTITIES])
        for row in self.rows:
            time = "" if row.microseconds is None else f"{row.microseconds:.4g}"
            setting = "" if row.setting is None else f"{row.setting:g}"
            found = ["" if math.isnan(row.errors[q]) else f"{row.errors[q]:.3g}" for q in QUANTITIES]
            writer.writerow([row.linkage, row.method, row.family, setting, time, *found])
        return stream.getvalue()


def _plain(value: float) -> float | str | None:
    return None if math.isnan(value) else value if math.isfinite(value) else "inf"


def places(case: Case, count: int) -> Real:
    """Places of the driver over a turn, close together, none of them a special one."""
    found: Real = case.start + case.law.sense * 2 * np.pi * (np.arange(count) + 0.3717) / count
    return found


def measure(
    linkages: Sequence[str] = NAMES,
    *,
    reduced: bool = False,
    methods: Iterable[Method] | None = None,
    progress: Callable[[str], None] = lambda _: None,
) -> Accuracy:
    """Errors of all methods against 50 digits; their times, taken by turns in one process, median of the repeats."""
    from tmm_cli.bench.rivals import installed

    chosen = tuple(methods or (FEWER if reduced else METHODS))
    rivals, missing = installed()
    absent = [f"{name}: not installed" for name in missing]
    repeats = REDUCED_REPEATS if reduced else REPEATS
    rows: list[Row] = []
    for name in linkages:
        progress(name)
        true = reference(name)
        solvers: dict[Method, Solver] = {}
        for method in (*chosen, *rivals):
            try:
                solvers[method] = method.prepare(true.case)
            except Unable as error:
                absent.append(f"{method.name}: {name}: {error}")
        worst = {method: errors(solver(true.q), true.exact) for method, solver in solvers.items()}
        times = by_turns({m: s for m, s in solvers.items() if m.timed}, places(true.case, COUNT), repeats)
        rows += [Row(name, m.name, m.family, m.setting, times.get(m), worst[m]) for m in solvers]
    return Accuracy(tuple(rows), COUNT, repeats, reduced, tuple(absent), machine())


def by_turns(solvers: dict[Method, Solver], q: Real, repeats: int) -> dict[Method, float]:
    """Microseconds a position of each, the median of its turns; one turn before that warms up."""
    found: dict[Method, list[float]] = {method: [] for method in solvers}
    for turn in range(repeats + 1):
        for method, solver in solvers.items():
            start = CLOCK()
            solver(q)
            if turn:
                found[method].append(CLOCK() - start)
    return {method: 1e6 * median(times) / len(q) for method, times in found.items()}


def machine() -> dict[str, str]:
    """What it was measured on."""
    return {
        "tmm": __version__, "python": platform.python_version(), "numpy": np.__version__,
        "system": f"{platform.system()} {platform.machine()}",
    }  # fmt: skip
