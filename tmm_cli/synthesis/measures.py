"""What is measured on an analysed mechanism (pipeline.Results); nan where it has no such quantity."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tmm_cli.pipeline import Results

NONE = math.nan


def stroke(results: Results) -> float:
    """Stroke H (m) or swing psi (rad) of the output."""
    strokes = results.strokes
    return strokes.travel if strokes is not None and strokes.strokes else NONE


def ratio(results: Results) -> float:
    """Coefficient of change of mean speed k."""
    strokes = results.strokes
    return strokes.k if strokes is not None and strokes.strokes else NONE


def pressure(results: Results) -> float:
    """The largest pressure angle on the output, rad."""
    strokes = results.strokes
    link = strokes.link if strokes is not None else None
    found = [p.largest for p in results.pressure if p.link == link] or [p.largest for p in results.pressure]
    return max(found, default=NONE)


def mean_speed(results: Results) -> float:
    """Mean speed of a sliding output over a turn of a crank of constant speed, m/s."""
    strokes = results.strokes
    if strokes is None or not strokes.strokes or strokes.kind != "slide" or results.linkage.driver.acceleration:
        return NONE
    way = math.fsum(abs(s.run) for s in strokes.strokes)
    return way * results.linkage.driver.rate / strokes.cycle


def crank_turns(results: Results) -> float:
    """1 when the driver turns fully, else 0."""
    return float(results.way is not None and results.way.full)
