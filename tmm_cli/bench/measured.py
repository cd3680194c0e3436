"""What measurements share: their clock, the machine they ran on, targets that are met or missed."""

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
ADDITIONAL_RUNS = 3  # so many times what misses its target is timed once more
LEAST_DURATION = 2e-3  # s: what is quicker is repeated in one turn
# the processor's time, which does not count what other programs take, where it is counted finely enough
CLOCK = process_time if get_clock_info("process_time").resolution < 1e-6 else perf_counter

Name = TypeVar("Name")


def describe_machine() -> dict[str, str]:
    """What it was measured on."""
    return {
        "tmm": __version__,
        "python": platform.python_version(),
        "numpy": np.__version__,
        "system": f"{platform.system()} {platform.machine()}",
    }


def target_slack(reduced: bool) -> float:
    """How much wider than stated the targets are."""
    return SLACK_WHEN_REDUCED if reduced else 1.0


@dataclass(frozen=True, kw_only=True)
class Measurement(ABC):
    """A whole measurement. absent: what could not be measured, and why."""

    reduced: bool = False
    absent: tuple[str, ...] = ()
    machine: dict[str, str] = field(default_factory=describe_machine)

    met: ClassVar[str] = "all targets met"

    @property
    @abstractmethod
    def failures(self) -> tuple[str, ...]:
        """Targets that are missed."""

    @property
    @abstractmethod
    def tables(self) -> tuple[Table, ...]:
        """What a terminal shows."""

    @property
    def remarks(self) -> tuple[str, ...]:
        """What is said before the verdict."""
        return self.absent

    def to_dict(self) -> dict[str, Any]:
        """JSON."""
        return asdict(self) | {"failures": list(self.failures)}

    def lines(self) -> list[Sequence[object]]:
        """What is written as CSV, the header first; none: the table that is shown, if it is one."""
        return []


def text_table(name: str, title: str, headers: Sequence[str], rows: Sequence[Sequence[str]]) -> Table:
    """A table of words."""
    return Table(name, title, tuple(Column(header, [row[k] for row in rows]) for k, header in enumerate(headers)))


def csv_cell(value: float | None, digits: int = 3) -> str:
    """A number of a CSV file; nothing where it is not given."""
    return "" if value is None or math.isnan(value) else f"{value:.{digits}g}"


def time_runs(runs: Mapping[Name, Callable[[], Any]], turns: int, least: float = 0.0) -> dict[Name, list[float]]:
    """Seconds of each by turns, so that what disturbs the machine disturbs all alike; one more turn warms up.

    What takes less than `least` (s) is repeated within its turn.
    """
    often = {}
    for name, run in runs.items():
        run()
        start = CLOCK()
        if least:
            run()
        often[name] = max(1, int(least / max(CLOCK() - start, 1e-9)))
    found: dict[Name, list[float]] = {name: [] for name in runs}
    for __ in range(turns):
        for name, run in runs.items():
            start = CLOCK()
            for __ in range(often[name]):
                run()
            found[name].append((CLOCK() - start) / often[name])
    return found


class TimedResult(Protocol):
    """What is found from times, and may have a target."""

    def missed(self, slack: float) -> str:
        """What is missed when its target is so many times as wide; nothing when it is met."""


AnyTimedResult = TypeVar("AnyTimedResult", bound=TimedResult)


def time_until_met(
    runs: Mapping[str, Callable[[], Any]], find: Callable[[dict[str, float]], AnyTimedResult], reduced: bool
) -> AnyTimedResult:
    """What is found from the least seconds of each run: from the turn that was disturbed least.

    Whatever else the machine does only adds to a time, so the least of all turns comes down to the truth. Where a
    target is missed, full turns are added up to 3 times; what is still missed then is missed by the product.
    """
    least = dict.fromkeys(runs, math.inf)
    for turns in (REDUCED_TURNS if reduced else TURNS, *[TURNS] * ADDITIONAL_RUNS):
        for name, seconds in time_runs(runs, turns, LEAST_DURATION).items():
            least[name] = min(least[name], *seconds)
        found = find(least)
        if not found.missed(target_slack(reduced)):
            break
    return found
