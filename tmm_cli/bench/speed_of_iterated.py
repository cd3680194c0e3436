"""Linkages with groups of class III beside the six-bar, whose groups are dyads: both on tapes, by turns."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from tmm_cli.batch import prepare_batch
from tmm_cli.bench.measured import timed, words
from tmm_cli.bench.references import reference
from tmm_cli.mechanics.linkage import Linkage
from tmm_cli.reports import Table

ITERATED = ("press-class-iii",)
POSITIONS = (360, 36_000)
OF_SIX_BAR = 360  # positions
ITERATED_TARGETS = {360: 2.0 / 0.23, 36_000: 1.0 / 0.23}  # 2 us and 1 us a position where the six-bar takes 0.23


@dataclass(frozen=True)
class Iterated:
    """A linkage with a group that is found by iteration: nanoseconds a position, its own and the six-bar's of 360.

    rest: share of the positions that the tape leaves to the ordinary stages.
    """

    mechanism: str
    positions: int
    ours: float
    six_bar: float
    rest: float

    @property
    def ratio(self) -> float:
        return self.ours / self.six_bar

    @property
    def target(self) -> float:
        """At most this ratio."""
        return ITERATED_TARGETS[self.positions]

    def missed(self, slack: float) -> str:
        if self.ratio <= slack * self.target:
            return ""
        kind = f"{self.mechanism}, {self.positions} positions"
        return f"{kind}: {self.ratio:.1f} times the six-bar, target {self.target:.1f}"

    def to_dict(self) -> dict[str, Any]:
        """JSON."""
        return asdict(self) | {"ratio": self.ratio, "target": self.target}


def against_six_bar(name: str, reduced: bool) -> list[Iterated]:
    """Times of a linkage round its cycle, with all that `everything` holds."""
    batch, six_bar = (
        prepare_batch(_linkage_with_constant_loads(name)),
        prepare_batch(_linkage_with_constant_loads("six-bar")),
    )
    found = []
    for positions in POSITIONS:
        q, few = (batch.linkages[0].sketch.at + 2 * np.pi * np.arange(n) / n for n in (positions, OF_SIX_BAR))
        rest = 1 - float(np.mean(batch.closed(q)))

        def judged(least: dict[str, float], n: int = positions, rest: float = rest) -> Iterated:
            return Iterated(name, n, least["ours"] * 1e9 / n, least["six"] * 1e9 / OF_SIX_BAR, rest)

        runs = {"ours": lambda q=q: batch(q), "six": lambda q=few: six_bar(q)}
        found.append(timed(runs, judged, reduced))
    return found


def _linkage_with_constant_loads(name: str) -> Linkage:
    """A reference whose loads are constant, as those of the other races are."""
    found = reference(name).case.linkage
    loads = tuple(
        replace(x, force=x.force * (1 if x.table is None else x.table.values[0]), table=None, when="always")
        for x in found.loads
    )
    return replace(found, loads=loads)


def iterated_table(rows: Sequence[Iterated]) -> Table:
    """What a terminal shows."""
    return words(
        "iterated",
        "Groups of class III, nanoseconds a position with all reactions, against the six-bar",
        ("mechanism", "positions", "tmm", "six-bar", "ratio", "at most", "left to the stages"),
        [
            (
                r.mechanism,
                str(r.positions),
                f"{r.ours:.0f}",
                f"{r.six_bar:.0f}",
                f"{r.ratio:.1f}",
                f"{r.target:.1f}",
                f"{100 * r.rest:.1f} %",
            )
            for r in rows
        ],
    )
