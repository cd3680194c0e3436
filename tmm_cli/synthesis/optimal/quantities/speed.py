"""Mean speed of a sliding output over a cycle."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from tmm_cli.analysis.pipeline import Results
from tmm_cli.errors import _
from tmm_cli.forces.plan import Reactions
from tmm_cli.kinematics.motion import Motion
from tmm_cli.linkage import Linkage
from tmm_cli.synthesis import measures
from tmm_cli.synthesis.measures import Ends
from tmm_cli.synthesis.optimal.quantities.base import Over, Read, Windows
from tmm_cli.synthesis.optimal.quantities.k import OF_A_CYCLE
from tmm_cli.synthesis.optimal.quantities.run import OfTheRun, runs_of, strokes_of
from tmm_cli.vectors import Real


class Speed(OfTheRun):
    """m/s; of an accelerated crank over its first cycle from position 0 on."""

    of, text = "speed", _("mean speed of the output")

    dimension = "speed"

    def unfit(self, linkage: Linkage, groups: Any, *, closed: bool) -> tuple[str, str] | None:
        if not self.slides(linkage, groups) and self.output(linkage, groups) is not None:
            return (
                _("the output swings: it has no mean speed in metres a second"),
                _("an output that slides on the frame, or another quantity"),
            )
        return super().unfit(linkage, groups, closed=closed) or (None if closed else OF_A_CYCLE)

    def outputs(self, motion: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
        found, driver = super().outputs(motion, reactions), motion.linkage.driver
        nothing = 0.0 * found["slope"]
        return {**found, "rate": driver.rate + nothing, "gain": driver.acceleration + nothing}

    def coarse(self, read: Read, over: Over) -> Real:
        run = read("run")
        found: Real = np.sum(np.abs(run - np.roll(run, 1, axis=1)), axis=1) * _mean_rate(read, over) / over.cycle
        return found

    def fine(self, parts: Windows, exact: Read, over: Over, step: float) -> Real:
        if not parts:
            return exact("slope")[:, :1] * np.nan
        found: Real = np.sum(strokes_of(runs_of(parts, over)), axis=0) * _mean_rate(parts[0][2], over) / over.cycle
        return found[:, None]

    def measure(self, results: Results, ends: Ends) -> float:
        return measures.mean_speed(results)


def _mean_rate(read: Read, over: Over) -> Real:
    """The crank's mean speed in the first cycle from position 0 on: half the sum of those at its ends, (variants,)."""
    rate, gain = (read(name)[:, 0] for name in ("rate", "gain"))
    found: Real = (rate + np.sqrt(rate * rate + 2 * gain * over.cycle)) / 2
    return found
