"""One candidate of an optimal synthesis: objective and constrained quantities, as exactly as they will be measured."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from tmm_cli.synthesis.goals import FORCES, FOUR, LEAST
from tmm_cli.synthesis.mean_ratio import ratio
from tmm_cli.synthesis.peaks import highest
from tmm_cli.synthesis.readings import ends_of
from tmm_cli.variants.apart import Apart
from tmm_cli.variants.way import Places
from tmm_cli.vectors import Real

if TYPE_CHECKING:
    from tmm_cli.synthesis.candidates import Search

Along = Callable[[int, str, Real], Real]  # an output of a goal, by its name, at shares of the way


def exactly(search: Search, x: Real) -> list[float]:
    """x: in 0..1; nan where the candidate has no such quantity."""
    with np.errstate(all="ignore"):
        along = _along(search, x)
        found, coarse = search.closely(x)(x), search.values(np.stack([x, x]))
        values = [np.min(p) if goal.of in LEAST else np.max(p) for goal, p in zip(search.goals, found, strict=True)]
        scan = search.over(search.scan)
        for n, (goal, over) in enumerate(zip(search.goals, search.overs, strict=True)):
            own = scan[search.along(n, search.scan)]

            def highest_of(name: str, sign: float = 1.0, n: int = n, own: Real = own) -> float:
                return highest(lambda shares: sign * along(n, name, shares), own, closed=search.overs[n].closed)

            if goal.of in FORCES and np.isnan(coarse[n][0]):  # somewhere the driver has stopped, or is locked
                values[n] = np.nan
            elif over.rough and goal.of in FORCES:
                values[n] = highest_of("y0")
            slides = goal.of == "stroke" and not over.swings and not np.isnan(values[n])
            if slides and not isinstance(search.program, Apart) and not _several(search, partial(along, n, "slope")):
                values[n] = highest_of("run") + highest_of("run", -1.0)
            if goal.of == "k":
                values[n] = ratio(partial(along, n, "slope"), scan[: search.scan])
        if search.single:
            two = search.run(np.stack([x, x]), Places(scan, search.with_sketch(np.zeros(0))))
            values[1] = -1.0 if search.turned_over(two, search.scan)[0] else values[1]
    return [float(value) for value in values]


def _along(search: Search, x: Real) -> Along:
    near, two = search.program.about(search.numbers(x)), search.numbers(np.stack([x, x]))

    def along(n: int, name: str, shares: Real) -> Real:
        found: Real = near(two, Places(shares, np.zeros(0)))[f"{n}.{name}"][0, : len(shares)]
        return found

    return along


def _several(search: Search, slope: Callable[[Real], Real]) -> bool:
    """Whether an output has more than two double strokes, of which the longest stroke counts."""
    return search.closed and bool(ends_of(slope(search.over(search.scan)[: search.scan])[None])[0] > FOUR)
