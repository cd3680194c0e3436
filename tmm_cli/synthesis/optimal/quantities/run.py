"""What the strokes of the output have in common: they end where its slope changes its sign."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from tmm_cli.errors import _
from tmm_cli.forces.plan import Reactions
from tmm_cli.kinematics.motion import Motion
from tmm_cli.kinematics.strokes import output_place, output_slope
from tmm_cli.linkage import Linkage
from tmm_cli.synthesis.optimal.peaks import peak
from tmm_cli.synthesis.optimal.quantities.base import Goal, Over, Read, Windows
from tmm_cli.synthesis.optimal.readings import swept
from tmm_cli.vectors import Real


class OfTheRun(Goal):
    """A quantity of the output's strokes. A window is about an end of a stroke, of the angle there, followed."""

    def unfit(self, linkage: Linkage, groups: Any, *, closed: bool) -> tuple[str, str] | None:
        if self.output(linkage, groups) is None:
            return (
                _("no link is the output, whose stroke this is"),
                _("output: a link that slides or swings on the frame; or another quantity"),
            )
        return None

    def outputs(self, motion: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
        output = self.output(motion.linkage, tuple(kernel.group for kernel in motion.kernels))
        assert output is not None
        return {"slope": output_slope(motion, output), "run": output_place(motion, output)}

    def windows(self, read: Read, over: Over) -> list[tuple[Any, int]]:
        slope = read("slope")[0]
        moves = np.flatnonzero(slope)  # in a dwell it is exactly zero
        after = np.roll(moves, -1) if over.closed else np.append(moves[1:], moves[-1:])
        turns = [int(k) for k in moves[slope[moves] * slope[after] < 0]]
        turns = turns if over.closed else [0, *turns, len(slope) - 1]
        if not over.swings:
            return [(0.0, k) for k in turns]
        followed = np.unwrap(read("run")[0])
        return [(float(followed[k]), k) for k in turns]


def travel_of(read: Read, over: Over) -> Real:
    """How far the run goes, coarsely, (variants,); nan where the output turns on and on."""
    run = read("run")
    travel: Real = np.max(run, axis=1) - np.min(run, axis=1)
    if over.swings and np.any(past := travel > np.pi):  # angles are within -pi..pi
        slope = read("slope")[past]
        turns = np.all(slope > 0, axis=1) | np.all(slope < 0, axis=1)  # such an output has no strokes
        travel[past] = np.where(turns & over.closed, np.nan, swept(run[past]))
    return travel


def runs_of(parts: Windows, over: Over) -> list[Real]:
    """The run in each window, followed."""
    runs = []
    for angle, __, read in parts:
        run = read("run")
        runs.append(run - 2 * np.pi * np.round((run - angle) / (2 * np.pi)) if over.swings else run)
    return runs


def strokes_of(runs: list[Real]) -> Real:
    """Lengths of the strokes between windows, (strokes, variants)."""
    ends = [np.where(run[:, 0] + run[:, -1] < 2 * np.mean(run, axis=1), peak(run), -peak(-run)) for run in runs]
    return np.abs(np.diff([*ends, ends[0]], axis=0))
