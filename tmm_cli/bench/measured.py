"""Common parts of the measurements: clock, description of the machine, targets."""

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
    """Return the versions of tmm, Python and NumPy, and the operating system."""
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
    """Base class for the results of a measurement.

    Attributes:
        reduced: True if fewer cases were measured.
        absent: messages on what could not be measured, with the reason.
        machine: versions and operating system.
        met: text printed if all targets are met.
    """

    reduced: bool = False
    absent: tuple[str, ...] = ()
    machine: dict[str, str] = field(default_factory=describe_machine)

    met: ClassVar[str] = "all targets met"

    @property
    @abstractmethod
    def failures(self) -> tuple[str, ...]:
        """Messages on missed targets; empty if all are met."""

    @property
    @abstractmethod
    def tables(self) -> tuple[Table, ...]:
        """Tables to print in the terminal."""

    @property
    def remarks(self) -> tuple[str, ...]:
        """Messages to print before the result of the check against the targets."""
        return self.absent

    def to_dict(self) -> dict[str, Any]:
        """Return the contents of the JSON file."""
        return asdict(self) | {"failures": list(self.failures)}

    def lines(self) -> list[Sequence[object]]:
        """Return the rows of the CSV file, the header first.

        If there are none, the file contains the only table of the measurement instead.
        """
        return []


def text_table(name: str, title: str, headers: Sequence[str], rows: Sequence[Sequence[str]]) -> Table:
    """Make a table whose cells are texts."""
    return Table(name, title, tuple(Column(header, [row[k] for row in rows]) for k, header in enumerate(headers)))


def csv_cell(value: float | None, digits: int = 3) -> str:
    """Return a number as text for a CSV file, with `digits` significant figures; empty for None or nan."""
    return "" if value is None or math.isnan(value) else f"{value:.{digits}g}"


def time_runs(runs: Mapping[Name, Callable[[], Any]], turns: int, least: float = 0.0) -> dict[Name, list[float]]:
    """Measure the times of several functions by calling them in turn, so that disturbances affect all of them alike.

    Args:
        runs: Functions by name. Each is called once before timing starts.
        turns: Number of timings of each function.
        least: A function that takes less than this time (s) is called several times in each timing.

    Returns:
        Times of a call (s), by name.
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
    """Interface of a measured time, which may have a target."""

    def describe_miss(self, slack: float) -> str:
        """Return a message if the target is missed, "" if it is met; slack: factor by which the target is widened."""


AnyTimedResult = TypeVar("AnyTimedResult", bound=TimedResult)


def time_until_met(
    runs: Mapping[str, Callable[[], Any]], find: Callable[[dict[str, float]], AnyTimedResult], reduced: bool
) -> AnyTimedResult:
    """Measure the times of several functions; repeat this up to three times as long as the target is missed.

    Other work of the machine can only lengthen a time, so the least of all times approaches the true one. A target that
    is still missed after all repetitions is missed by the program.

    Args:
        runs: Functions by name.
        find: Returns the result of the measurement from the least time (s) of each function.
        reduced: True for fewer timings and wider targets.

    Returns:
        Result of `find` for the least times.
    """
    least = dict.fromkeys(runs, math.inf)
    for turns in (REDUCED_TURNS if reduced else TURNS, *[TURNS] * ADDITIONAL_RUNS):
        for name, seconds in time_runs(runs, turns, LEAST_DURATION).items():
            least[name] = min(least[name], *seconds)
        timing = find(least)
        if not timing.describe_miss(target_slack(reduced)):
            break
    return timing
