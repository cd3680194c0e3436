"""Stroke of the output, or its swing."""

from __future__ import annotations

from typing import Any

import numpy as np

from tmm_cli.analysis.pipeline import Results
from tmm_cli.errors import _
from tmm_cli.linkage import Linkage
from tmm_cli.synthesis import measures
from tmm_cli.synthesis.measures import Ends
from tmm_cli.synthesis.optimal.peaks import highest, peak
from tmm_cli.synthesis.optimal.quantities.base import Curve, Over, Read, Windows
from tmm_cli.synthesis.optimal.quantities.run import OfTheRun, runs_of, strokes_of, travel_of
from tmm_cli.synthesis.optimal.readings import ends_of, longest
from tmm_cli.vectors import Real

FOUR = 4  # ends of strokes in a cycle: of more the highest and the lowest may belong to two strokes


class Stroke(OfTheRun):
    """Metres, or radians; the longest of several."""

    of, text = "stroke", _("stroke of the output")

    def kind(self, linkage: Linkage, groups: Any) -> str:
        return "length" if self.slides(linkage, groups) else "angle"

    def coarse(self, read: Read, over: Over) -> Real:
        travel = travel_of(read, over)
        if over.closed and np.any(ends_of(read("slope")) > FOUR):
            return longest(read("run"), travel, turns=over.swings)
        return travel

    def fine(self, parts: Windows, exact: Read, over: Over, step: float) -> Real:
        if not parts:
            return exact("slope")[:, :1] * np.nan
        runs = runs_of(parts, over)
        if over.closed and len(parts) > FOUR:
            return strokes_of(runs).T
        tops, lows = ([peak(side * run) for run in runs] for side in (1, -1))
        travel: Real = np.max(tops, axis=0) + np.max(lows, axis=0)
        return travel[:, None]

    def closest(self, value: float, curve: Curve, scan: Real, over: Over) -> float:
        several = over.closed and ends_of(curve("slope", scan)[None])[0] > FOUR
        if over.swings or not over.taped or several or np.isnan(value):
            return value
        top = highest(lambda shares: curve("run", shares), scan, closed=over.closed)
        return top + highest(lambda shares: -curve("run", shares), scan, closed=over.closed)

    def _measured(self, results: Results, ends: Ends) -> float:
        return measures.stroke(results, ends)
