"""Common parts of measurements: clock, description of the machine, targets."""

from __future__ import annotations

import math
import platform
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from time import get_clock_info, perf_counter, process_time
from typing import Any, ClassVar, Protocol, TypeVar

import numpy as np

from tmm_cli import __version__
from tmm_cli.reports import Column, Table

SLACK_WHEN_REDUCED = 2.0
TURNS, REDUCED_TURNS = 41, 15
ADDITIONAL_RUNS = 3  # additional series for a missed target
LEAST_DURATION = 2e-3  # s: quicker runs are repeated within a turn
# processor time, which excludes other programs, where its resolution is sufficient
CLOCK = process_time if get_clock_info("process_time").resolution < 1e-6 else perf_counter

Name = TypeVar("Name")


def describe_machine() -> dict[str, str]:
    """Return the versions and the system of the measurement."""
    return {
        "tmm": __version__,
        "python": platform.python_version(),
        "numpy": np.__version__,
        "system": f"{platform.system()} {platform.machine()}",
    }


def target_slack(reduced: bool) -> float:
    """Return the factor by which targets are widened: 2 in a reduced run, otherwise 1."""
    return SLACK_WHEN_REDUCED if reduced else 1.0


@dataclass(frozen=True, kw_only=True)
class Measurement(ABC):
    """Results of a measurement. absent: what could not be measured, and why."""

    reduced: bool = False
    absent: tuple[str, ...] = ()
    machine: dict[str, str] = field(default_factory=describe_machine)

    met: ClassVar[str] = "all targets met"

    @property
    @abstractmethod
    def failures(self) -> tuple[str, ...]:
        """Missed targets."""

    @property
    @abstractmethod
    def tables(self) -> tuple[Table, ...]:
        """Tables shown in the terminal."""

    @property
    def remarks(self) -> tuple[str, ...]:
        """Remarks shown before the verdict."""
        return self.absent

    def to_dict(self) -> dict[str, Any]:
        """Return the content of the JSON file."""
        return asdict(self) | {"failures": list(self.failures)}

    def lines(self) -> list[Sequence[object]]:
        """Return the CSV rows, the header first; if empty, a single table is written instead."""
        return []


def text_table(name: str, title: str, headers: Sequence[str], rows: Sequence[Sequence[str]]) -> Table:
    """Make a table of texts."""
    return Table(name, title, tuple(Column(header, [row[k] for row in rows]) for k, header in enumerate(headers)))


def csv_cell(value: float | None, digits: int = 3) -> str:
    """Write a number for a CSV file; empty if None or nan."""
    return "" if value is None or math.isnan(value) else f"{value:.{digits}g}"


def time_runs(runs: Mapping[Name, Callable[[], Any]], turns: int, least: float = 0.0) -> dict[Name, list[float]]:
    """Time the runs alternately (s), so that disturbances of the machine affect all alike, after one run for warming
    up.

    A run that takes less than `least` (s) is repeated within its turn.
    """
    often = {}
    for name, run in runs.items():
        run()
        start = CLOCK()
        if least:
            run()
        often[name] = max(1, int(least / max(CLOCK() - start, 1e-9)))
    seconds: dict[Name, list[float]] = {name: [] for name in runs}
    for __ in range(turns):
        for name, run in runs.items():
            start = CLOCK()
            for __ in range(often[name]):
                run()
            seconds[name].append((CLOCK() - start) / often[name])
    return seconds


class TimedResult(Protocol):
    """A result of timing, with or without a target."""

    def missed(self, slack: float) -> str:
        """Describe the target if it is missed, with its limit widened by the factor `slack`; empty if it is met."""


AnyTimedResult = TypeVar("AnyTimedResult", bound=TimedResult)


def time_until_met(
    runs: Mapping[str, Callable[[], Any]], find: Callable[[dict[str, float]], AnyTimedResult], reduced: bool
) -> AnyTimedResult:
    """Return find(least times of all runs), with additional turns while its target is missed.

    Other work of the machine only adds to a time, so the least of all turns approaches the true time. If a target is
    missed, up to 3 full series are added; a target still missed then is missed by the product.
    """
    least = dict.fromkeys(runs, math.inf)
    for turns in (REDUCED_TURNS if reduced else TURNS, *[TURNS] * ADDITIONAL_RUNS):
        for name, seconds in time_runs(runs, turns, LEAST_DURATION).items():
            least[name] = min(least[name], *seconds)
        timing = find(least)
        if not timing.missed(target_slack(reduced)):
            break
    return timing
