"""Coefficient of change of mean speed, the longer stroke over the shorter in time."""

from __future__ import annotations

from typing import Any

import numpy as np

from tmm_cli.analysis.pipeline import Results
from tmm_cli.errors import _
from tmm_cli.linkage import Linkage
from tmm_cli.synthesis import measures
from tmm_cli.synthesis.mean_ratio import ratio
from tmm_cli.synthesis.measures import Ends
from tmm_cli.synthesis.optimal.peaks import zero
from tmm_cli.synthesis.optimal.quantities.base import Curve, Over, Read, Windows
from tmm_cli.synthesis.optimal.quantities.run import OfTheRun
from tmm_cli.synthesis.optimal.readings import forward_share, ratio_of
from tmm_cli.vectors import Real

OF_A_CYCLE = (
    _("this belongs to a driver that turns on and on, and this one goes between two ends"),
    _("another quantity, or a crank over its cycle"),
)  # fmt: skip


class K(OfTheRun):
    """1 and more."""

    of, text = "k", _("k, the longer stroke over the shorter")

    dimension = "number"

    def unfit(self, linkage: Linkage, groups: Any, *, closed: bool) -> tuple[str, str] | None:
        return super().unfit(linkage, groups, closed=closed) or (None if closed else OF_A_CYCLE)

    def coarse(self, read: Read, over: Over) -> Real:
        return ratio_of(forward_share(read("slope")))

    def fine(self, parts: Windows, exact: Read, over: Over, step: float) -> Real:
        if not parts:
            return exact("slope")[:, :1] * np.nan
        forward: Any = 0.0
        for __, start, read in parts:
            slope = read("slope")
            forward = forward + np.where(slope[:, 0] > 0, 1, -1) * (start + step * zero(slope))
        return ratio_of(np.mod(forward, 1.0))[:, None]

    def closest(self, value: float, curve: Curve, scan: Real, over: Over) -> float:
        return ratio(lambda shares: curve("slope", shares), scan)

    def measure(self, results: Results, ends: Ends) -> float:
        return measures.slower_ratio(results)

    def open(self, results: Results) -> float:
        return measures.ratio_open(results)
