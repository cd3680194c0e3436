"""Mechanisms that `tmm sweep` goes through in a minute on one core: variants of a file on a tape, with all it shows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from time import perf_counter
from typing import Any

from tmm_cli.batch import Task
from tmm_cli.bench.measured import timed, words
from tmm_cli.bench.references import tree_of
from tmm_cli.reports import Table
from tmm_cli.sweep import SweptMechanisms, grid_points, read_axes

SWEPT = {"six-bar": "OA=80..120"}  # problems of 12 positions, and over what
SWEPT_QUANTITIES = ("H,k,pressure,M_b,R_34",)
SWEPT_MECHANISMS, REDUCED_MECHANISMS = 20_000, 2_000  # of a sweep: as many as are one job of a long one
A_MINUTE = 1e6


@dataclass(frozen=True)
class Sweeping:
    """A sweep of so many mechanisms of so many positions each: mechanisms a minute; preparing (ms) is once."""

    mechanism: str
    mechanisms: int
    positions: int
    a_minute: float
    preparing: float

    @property
    def target(self) -> float:
        """At least so many mechanisms a minute."""
        return A_MINUTE

    def missed(self, slack: float) -> str:
        if self.a_minute >= self.target / slack:
            return ""
        return f"sweep of {self.mechanism}: {self.a_minute:.0f} mechanisms a minute, target {self.target:.0f}"

    def to_dict(self) -> dict[str, Any]:
        """JSON."""
        return asdict(self) | {"target": self.target}


def sweeping(name: str, reduced: bool) -> Sweeping:
    """How the command computes the points of a sweep, of which every one works."""
    count = REDUCED_MECHANISMS if reduced else SWEPT_MECHANISMS
    start = perf_counter()
    tree = tree_of(name)
    mechanisms = SweptMechanisms(tree, read_axes(Task(tree), [f"{SWEPT[name]}:{count}"]), SWEPT_QUANTITIES)
    assert mechanisms.turning is not None
    preparing = 1e3 * (perf_counter() - start)
    points = grid_points(mechanisms.axes)

    def found(least: dict[str, float]) -> Sweeping:
        positions = mechanisms.task.problem.request.count
        return Sweeping(name, count, positions, 60 * count / least[""], preparing)

    return timed({"": lambda: mechanisms.at(points)}, found, reduced)


def sweep_table(rows: Sequence[Sweeping]) -> Table:
    """What a terminal shows."""
    return words(
        "sweeps",
        f"Mechanisms that a sweep goes through in a minute on one core, with {SWEPT_QUANTITIES[0]}",
        ("mechanism", "mechanisms", "positions of each", "a minute", "at least", "preparing once, ms"),
        [
            (
                r.mechanism,
                str(r.mechanisms),
                str(r.positions),
                f"{r.a_minute:.0f}",
                f"{r.target:.0f}",
                f"{r.preparing:.0f}",
            )
            for r in rows
        ],
    )
