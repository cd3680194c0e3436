"""What measurements share: their clock, the machine they ran on, targets that are met or missed."""

from __future__ import annotations

import platform
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from time import get_clock_info, perf_counter, process_time
from typing import Any, TypeVar

import numpy as np

from tmm_cli import __version__

SLACK_WHEN_REDUCED = 2.0
# the processor's time, which does not count what other programs take, where it is counted finely enough
CLOCK = process_time if get_clock_info("process_time").resolution < 1e-6 else perf_counter

Name = TypeVar("Name")


def machine() -> dict[str, str]:
    """What it was measured on."""
    return {
        "tmm": __version__, "python": platform.python_version(), "numpy": np.__version__,
        "system": f"{platform.system()} {platform.machine()}",
    }  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class Measured(ABC):
    """A whole measurement. absent: what could not be measured, and why."""

    reduced: bool = False
    absent: tuple[str, ...] = ()
    machine: dict[str, str] = field(default_factory=machine)

    @property
    def slack(self) -> float:
        """How much wider than stated the targets are."""
        return SLACK_WHEN_REDUCED if self.reduced else 1.0

    @property
    @abstractmethod
    def failures(self) -> tuple[str, ...]:
        """Targets that are missed."""

    def to_dict(self) -> dict[str, Any]:
        """JSON."""
        return asdict(self) | {"failures": list(self.failures)}

    def lines(self) -> list[Sequence[object]]:
        """What is written as CSV, the header first; none: the table that is shown."""
        return []


def times(runs: Mapping[Name, Callable[[], Any]], turns: int, least: float = 0.0) -> dict[Name, list[float]]:
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
