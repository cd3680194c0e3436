"""What is measured on an analysed mechanism (pipeline.Results); nan where it has no such quantity."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from tmm_cli.linkage import FRAME

if TYPE_CHECKING:
    from tmm_cli.pipeline import Results

NONE = math.nan


def stroke(results: Results) -> float:
    """Stroke H (m) or swing psi (rad) of the output: in a cycle, or over the driver's own stroke."""
    if results.way is not None and not results.way.full:
        from tmm_cli.strokes import find_travel

        way, link = results.way, results.mechanism.output
        found = link and find_travel(results.linkage, results.kernels, np.array([way.start, way.end]), link)
        return found.high - found.low if found else NONE
    strokes = results.strokes
    return strokes.travel if strokes is not None and strokes.strokes else NONE


def ratio(results: Results) -> float:
    """Coefficient of change of mean speed k."""
    strokes = results.strokes
    return strokes.k if strokes is not None and strokes.strokes else NONE


def slower_ratio(results: Results) -> float:
    """The longer stroke over the shorter."""
    k = ratio(results)
    return max(k, 1 / k)


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


def goes_its_way(results: Results) -> bool:
    """Whether the driver turns fully, or goes the whole of its stroke."""
    return results.way is not None and (results.way.full or results.way.inclusive)


def crank_turns(results: Results) -> float:
    """1 when it does, else 0."""
    return float(goes_its_way(results))


def end_angle(results: Results, near: float) -> float:
    """The angle (rad) of a swinging output from its hinge on the frame, at the end of a stroke nearest to `near`.

    It is that of the line from that hinge to the first other point of the link.
    """
    strokes, linkage = results.strokes, results.linkage
    if strokes is None or not strokes.strokes or strokes.kind != "swing":
        return NONE
    points = linkage.links[strokes.link].points
    fixed = next((h.point for h in linkage.hinges if {FRAME, strokes.link} <= set(h.links)), None)
    other = next((name for name in points if name != fixed), None)
    if fixed is None or other is None:
        return NONE
    arm = points[other] - points[fixed]
    turn = math.atan2(arm.imag, arm.real)
    ends = [turn + end - near for s in strokes.strokes for end in (s.low, s.low + s.run)]
    return near + min((math.remainder(away, math.tau) for away in ends), key=abs)
