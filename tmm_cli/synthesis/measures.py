"""What is measured on an analysed mechanism (pipeline.Results); nan where it has no such quantity."""

from __future__ import annotations

import math

import numpy as np

from tmm_cli.analysis.pipeline import Results, at_positions
from tmm_cli.kinematics.driver_range import DriverRange
from tmm_cli.kinematics.output import find_travel, output_slope
from tmm_cli.kinematics.pressure import find_pressure
from tmm_cli.linkage import FRAME
from tmm_cli.tolerances import SURE_SIGN

NONE = math.nan

Ends = tuple[float, float] | None  # of the driver's way (rad or m), where it is no cycle


def stroke(results: Results, ends: Ends = None) -> float:
    """Stroke H (m) or swing psi (rad) of the output: in a cycle, or over a way of the driver."""
    if results.driver_range is not None and (ends or not results.driver_range.full):
        way, link = results.driver_range, results.mechanism.output
        found = link and find_travel(results.linkage, results.kernels, np.array(ends or (way.start, way.end)), link)
        return found.high - found.low if found else NONE
    strokes = results.strokes
    return strokes.travel if strokes is not None and strokes.strokes else NONE


def arc_or_stroke(results: Results) -> float:
    """Stroke H (m) of the output; of an output that swings the arc H = psi l of its first point."""
    link = results.mechanism.output
    arm = results.linkage.output_arm(link) if link else None
    return stroke(results) * (1.0 if arm is None else arm[1])


def ratio(results: Results) -> float:
    """Coefficient of change of mean speed k."""
    strokes = results.strokes
    return strokes.k if strokes is not None and strokes.strokes else NONE


def ratio_open(results: Results) -> float:
    """By how much of k rounding leaves it open, as the sign of the output's speed is not sure about ends of strokes."""
    strokes = results.strokes
    if strokes is None or not strokes.strokes:
        return 0.0
    ends, lengths = np.array([s.start for s in strokes.strokes]), np.array([s.length for s in strokes.strokes])
    works = np.array([s.working for s in strokes.strokes])
    away = 2.0 ** np.arange(-52, -6)
    places = ends[:, None, None] + np.array([[1.0], [-1.0]]) * away
    around = ends[0] + strokes.cycle * np.arange(64) / 64
    every = np.abs(output_slope(at_positions(results, np.append(places, around)), strokes.link))
    speed = every[:-64].reshape(places.shape)
    dwells = np.any(speed[:, :, -1:] == 0, axis=1)  # which begin and end to the last digit
    sure = np.all(speed > SURE_SIGN * np.nanmax(every), axis=1) | dwells
    doubtful = np.sum(np.logical_or.accumulate(~sure[:, ::-1], axis=1), axis=1)  # so many steps, and all nearer ones
    blur = float(np.sum(away[np.minimum(doubtful, len(away) - 1)]))
    return blur * (1 / float(lengths[works].sum()) + 1 / float(lengths[~works].sum()))


def pressure(results: Results, ends: Ends = None) -> float:
    """The largest pressure angle on the output, rad."""
    strokes, over = results.strokes, results.pressure
    link = strokes.link if strokes is not None else None
    if ends and results.motion is not None:
        way = DriverRange(*ends, False, inclusive=True)
        over = find_pressure(results.linkage, results.kernels, way, results.inputs.pressure_limits)
    found = [p.largest for p in over if p.link == link] or [p.largest for p in over]
    return max(found, default=NONE)


def mean_speed(results: Results) -> float:
    """Mean speed of a sliding output over a cycle, of an accelerated crank over the first from position 0 on, m/s."""
    strokes, driver = results.strokes, results.linkage.driver
    if strokes is None or not strokes.strokes or strokes.kind != "slide":
        return NONE
    way = math.fsum(abs(s.run) for s in strokes.strokes)
    last = driver.rate**2 + 2 * driver.acceleration * strokes.cycle
    return NONE if last < 0 else way * (driver.rate + math.sqrt(last)) / (2 * strokes.cycle)


def goes_its_way(results: Results, ends: Ends = None) -> bool:
    """Whether the driver turns fully, goes the whole of its stroke, or from one end to the other."""
    way = results.driver_range
    if way is None:
        return False
    return way.full or (way.start <= ends[0] and ends[1] <= way.end if ends else way.inclusive)


def crank_turns(results: Results, ends: Ends = None) -> float:
    """1 when it does, else 0."""
    return float(goes_its_way(results, ends))


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
