"""How far a motion is from what is wanted of it at several places."""

from __future__ import annotations

import numpy as np

from tmm_cli.analysis.pipeline import Results
from tmm_cli.linkage import Linkage
from tmm_cli.synthesis.measures import Ends
from tmm_cli.synthesis.optimal.quantities.base import Goal, Over, Read, Windows
from tmm_cli.vectors import Real


class Deviation(Goal):
    """Root mean square, or the largest."""

    largest: str  # what that is called

    def title(self, linkage: Linkage) -> str:
        return self.largest if self.norm == "largest" else self.text

    def deviations(self, read: Read, over: Over) -> Real:
        """From all that is wanted, (variants, wanted), m or rad."""
        raise NotImplementedError

    def deviations_on(self, results: Results, ends: Ends) -> Real:
        """The same of an analysed mechanism."""
        raise NotImplementedError

    def counted(self, off: Real) -> Real:
        """Root mean square, or the largest, (variants,)."""
        if self.norm == "largest":
            off = np.max(np.abs(off), axis=1, keepdims=True)
        found: Real = np.sqrt(np.mean(off * off, axis=1))
        return found

    def coarse(self, read: Read, over: Over) -> Real:
        return self.counted(self.deviations(read, over))

    def fine(self, parts: Windows, exact: Read, over: Over, step: float) -> Real:
        off = self.deviations(exact, over)
        return np.hstack([off, -off]) if self.norm == "largest" else self.counted(off)[:, None]

    def smooth(self, pieces: Real) -> Real:
        return pieces if self.norm == "largest" else pieces**2

    def _measured(self, results: Results, ends: Ends) -> float:
        return float(self.counted(self.deviations_on(results, ends)[None, :])[0])
