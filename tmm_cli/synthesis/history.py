"""The diagram of a search: its best candidates by generation, and by how much they miss the constraints."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from tmm_cli.synthesis.construction import Diagram, Line
from tmm_cli.vectors import Real

W: Final = "synthesis_optimal"
LEAST: Final = 1e-12  # a smaller violation is none that could be shown


def diagram(history: Real, shown: Callable[[Real], Real], polished: float, of: str, kind: str) -> Diagram:
    """history: objective and violation of the best candidate, by generation; shown: an objective as users read it.

    Above: the best so far of those that keep the constraints, and behind it the candidate that led in each generation
    (early on it misses them: the tolerance shrinks to zero). Below: by how much that one misses them, where it does.
    """
    objective, violation = history[:, 0], history[:, 1]
    generation = np.arange(len(history))
    leading = np.where(np.isfinite(objective), objective, np.nan)
    kept = np.fmin.accumulate(np.where(violation == 0, leading, np.nan))
    lines = [Line(f"{W}.leading", generation, shown(leading), faint=True)]
    if np.any(np.isfinite(kept)):
        lines.append(Line(f"{W}.evolution", generation, shown(kept)))
    lines.append(Line(f"{W}.polished", np.array([len(history)]), np.array([polished]), dots=True))
    missed = np.isfinite(violation) & (violation > LEAST)
    lower = (Line(f"{W}.violation", generation, np.where(missed, violation, np.nan)),) if np.any(missed) else ()
    return Diagram(
        "history", f"{W}.history", (f"{W}.generation", "number"), (f"{W}.best_{of}", kind), tuple(lines), lower=lower,
        lower_y=(f"{W}.violation", "number"),
    )  # fmt: skip
