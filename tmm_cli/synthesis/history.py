"""The diagram of a search: its best candidates by generation, and by how much they miss the constraints."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from tmm_cli.synthesis.construction import Diagram, Line
from tmm_cli.synthesis.evolution import Evolved
from tmm_cli.vectors import Real

W: Final = "synthesis_optimal"
LEAST: Final = 1e-12  # a smaller violation is none that could be shown
GENERATIONS: Final = ("leading", "violation", "polished", "generation", "history")  # words
EACH: Final = ("one_by_one", "", "exactly", "candidate", "tried")


def diagram(evolved: Evolved, shown: Callable[[Real], Real], polished: float, of: str, kind: str) -> Diagram:
    """shown: an objective as users read it; polished: the one that was found.

    Above: the best so far of those that keep the constraints, and behind it the candidate that led in each generation
    (early on it misses them: the tolerance shrinks to zero). Below: by how much that one misses them, where it does.
    Where all were tried, each of them that keeps the constraints, and the best so far.
    """
    objective, violation = evolved.history.T
    leading, missing, found, across, title = EACH if evolved.every else GENERATIONS
    number = np.arange(len(objective))
    there = np.where(np.isfinite(objective) & ((violation == 0) | (not evolved.every)), objective, np.nan)
    kept = np.fmin.accumulate(np.where(violation == 0, there, np.nan))
    lines = [Line(f"{W}.{leading}", number, shown(there), faint=True)]
    if np.any(np.isfinite(kept)):
        lines.append(Line(f"{W}.evolution", number, shown(kept)))
    lines.append(Line(f"{W}.{found}", np.array([len(number)]), np.array([polished]), dots=True))
    missed = np.isfinite(violation) & (violation > LEAST)
    below = missing and np.any(missed)
    lower = (Line(f"{W}.{missing}", number, np.where(missed, violation, np.nan)),) if below else ()
    return Diagram(
        "history", f"{W}.{title}", (f"{W}.{across}", "number"), (f"{W}.best_{of}", kind), tuple(lines), lower=lower,
        lower_y=(f"{W}.violation", "number"),
    )  # fmt: skip
