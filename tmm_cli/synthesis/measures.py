"""Quantities that verify a synthesis, measured on the analysed mechanism: time ratio k, stroke, speeds.

The slope of the output is the derivative of its displacement or angle with respect to the driver coordinate. A stroke
ends where the slope changes sign. A dwell, where the slope is exactly zero, belongs to no stroke. Near an instantaneous
stop rounding may give the slope either sign over several positions; the stroke then ends in the middle of them.
tmm_cli.mechanics.kinematics.strokes has the same rules.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np

from tmm_cli.mechanics.analysis import Results, motion_at_positions
from tmm_cli.mechanics.kinematics import DriverRange, find_pressure, find_travel, output_slope
from tmm_cli.mechanics.linkage import FRAME, Output
from tmm_cli.mechanics.numerics import DEMAND_MET, NO_DEMAND, SURE_SIGN, Real, bisect
from tmm_cli.synthesis.record import Demand, SolutionQuality, SynthesisOutcome


def theta_of(k: Any) -> Any:
    """Return the angle theta = pi (k - 1)/(k + 1) (rad) between the crank positions at the ends of the strokes."""
    k = np.asarray(k)
    return np.pi * (k - 1) / (k + 1)


def k_of(theta: Any) -> Any:
    """Return the time ratio k = (pi + theta)/(pi - theta), where theta (rad) is the angle between the extreme crank
    positions.
    """
    return (np.pi + theta) / (np.pi - theta)


def time_ratio_of_curve(slope: Callable[[Real], Real], shares: Real) -> float:
    """Return the total time of the slower strokes divided by that of the faster ones; nan if the curve has no strokes.

    Args:
        slope: function that returns the first transfer function of the output at fractions of the cycle.
        shares: fractions of the cycle in equal steps, covering the whole cycle, shape (samples,).
    """
    y, step = slope(shares), shares[1] - shares[0]
    moves = np.flatnonzero(y)
    after = np.roll(moves, -1)
    back = y[moves] * y[after] < 0
    last, first = moves[back], after[back]
    if not last.size:
        return float("nan")
    still = np.mod(first - last, len(y)) > 1
    before, on = np.sign(y[last]), np.sign(y[first])
    stops = _find_stroke_ends(slope, shares[last], step, before)
    goes_on = 1.0 - _find_stroke_ends(lambda s: slope(1.0 - s), 1.0 - shares[first], step, on)
    middle = stops + (np.mod(goes_on - stops + 0.5, 1.0) - 0.5) / 2
    stops, goes_on = np.where(still, stops, middle), np.where(still, goes_on, middle)
    lengths = np.mod(np.roll(stops, -1) - goes_on, 1.0)
    forward = on > 0
    rise, fall = float(lengths[forward].sum()), float(lengths[~forward].sum())
    return max(rise, fall) / min(rise, fall)


def _find_stroke_ends(slope: Callable[[Real], Real], low: Real, step: float, before: Real) -> Real:
    """Return the fractions of the cycle at which strokes end: the slope of the output no longer has the sign `before`.

    low: fractions of the cycle; each stroke ends within one step after them.
    """
    return bisect(lambda shares: np.sign(slope(shares)) == before, low, low + step)[0]


# Quantities measured on an analysed mechanism (pipeline.Results); nan if it has no such quantity.


NO_VALUE = math.nan

DriverEnds = tuple[float, float] | None  # ends of the driver range (rad or m); None: a cycle


def output_stroke(results: Results, ends: DriverEnds = None) -> float:
    """Return the stroke H (m) or the swing angle psi (rad) of the output link; nan if it has none.

    Args:
        results: analysis of the mechanism.
        ends: range of the driver (rad or m); None for a cycle.
    """
    if results.driver_range is not None and (ends or not results.driver_range.full):
        driver_range, link = results.driver_range, results.mechanism.output
        travel = link and find_travel(
            results.linkage, results.kernels, np.array(ends or (driver_range.start, driver_range.end)), link
        )
        return travel.high - travel.low if travel else NO_VALUE
    strokes = results.strokes
    return strokes.travel if strokes is not None and strokes.strokes else NO_VALUE


def arc_or_stroke(results: Results) -> float:
    """Return the stroke H (m) of a sliding output, or the arc psi l (m) that the first point of a swinging output
    describes.
    """
    link = results.mechanism.output
    arm = results.linkage.output_arm(link) if link else None
    return output_stroke(results) * (1.0 if arm is None else arm[1])


def time_ratio(results: Results) -> float:
    """Return the time ratio k (coefficient of change of mean speed); nan if the output has no strokes."""
    strokes = results.strokes
    return strokes.k if strokes is not None and strokes.strokes else NO_VALUE


def time_ratio_uncertainty(results: Results) -> float:
    """Return the uncertainty of the time ratio k from rounding.

    Near the ends of a stroke the sign of the output speed is uncertain, and with it the duration of the stroke.
    """
    strokes = results.strokes
    if strokes is None or not strokes.strokes:
        return 0.0
    ends, lengths = np.array([s.start for s in strokes.strokes]), np.array([s.length for s in strokes.strokes])
    works = np.array([s.working for s in strokes.strokes])
    away = 2.0 ** np.arange(-52, -6)
    positions = ends[:, None, None] + np.array([[1.0], [-1.0]]) * away
    around = ends[0] + strokes.cycle * np.arange(64) / 64
    slopes = np.abs(output_slope(motion_at_positions(results, np.append(positions, around)), strokes.link))
    speed = slopes[:-64].reshape(positions.shape)
    dwells = np.any(speed[:, :, -1:] == 0, axis=1)  # their ends are exact
    sure = np.all(speed > SURE_SIGN * np.nanmax(slopes), axis=1) | dwells
    doubtful = np.sum(
        np.logical_or.accumulate(~sure[:, ::-1], axis=1), axis=1
    )  # number of steps, with all smaller ones
    blur = float(np.sum(away[np.minimum(doubtful, len(away) - 1)]))
    return blur * (1 / float(lengths[works].sum()) + 1 / float(lengths[~works].sum()))


def largest_pressure_angle(results: Results, ends: DriverEnds = None) -> float:
    """Return the largest pressure angle (rad) on the output link, or on any link if there is no pressure angle on the
    output.

    The result is nan if no link has a pressure angle.

    Args:
        results: analysis of the mechanism.
        ends: range of the driver (rad or m); None for a cycle.
    """
    strokes, over = results.strokes, results.pressure
    link = strokes.link if strokes is not None else None
    if ends and results.motion is not None:
        driver_range = DriverRange(*ends, False, inclusive=True)
        over = find_pressure(results.linkage, results.kernels, driver_range, results.inputs.pressure_limits)
    largest = [p.largest for p in over if p.link == link] or [p.largest for p in over]
    return max(largest, default=NO_VALUE)


def quality_of(results: Results) -> SolutionQuality | None:
    """Return the quality of the mechanism that a synthesis found.

    It is taken from the solution of the task if the task computes it, otherwise from the analysis of the mechanism.

    Returns:
        The quality; None if the problem has no synthesis, or if the mechanism has no pressure angle.
    """
    synthesis = results.problem.synthesis
    if synthesis is None or synthesis.outcome.quality is not None:
        return synthesis.outcome.quality if synthesis else None
    over = [p for p in results.pressure if p.link == results.mechanism.output] or list(results.pressure)
    if results.motion is None or not over:
        return None
    worst = max(over, key=lambda p: p.largest - p.allowed)
    limited = any(d.of == "pressure" for d in synthesis.outcome.demands)
    return SolutionQuality(worst.largest, worst.slides, completes_range(results), limited=limited)


def mean_output_speed(results: Results) -> float:
    """Return the mean speed (m/s) of a sliding output over a cycle; nan if the output does not slide.

    If the crank accelerates, the mean is taken over the first cycle.
    """
    strokes, driver = results.strokes, results.linkage.driver
    if strokes is None or not strokes.strokes or strokes.kind != "slide":
        return NO_VALUE
    travel = math.fsum(abs(s.run) for s in strokes.strokes)
    last = driver.rate**2 + 2 * driver.acceleration * strokes.cycle
    return NO_VALUE if last < 0 else travel * (driver.rate + math.sqrt(last)) / (2 * strokes.cycle)


def completes_range(results: Results, ends: DriverEnds = None) -> bool:
    """Return True if the driver completes its motion.

    Args:
        results: analysis of the mechanism.
        ends: range (rad or m) that the driver must cover; None for a full rotation, or the stroke of a sliding driver.
    """
    driver_range = results.driver_range
    if driver_range is None:
        return False
    return driver_range.full or (
        driver_range.start <= ends[0] and ends[1] <= driver_range.end if ends else driver_range.inclusive
    )


def driver_completes_range(results: Results, ends: DriverEnds = None) -> float:
    """Return `completes_range` as a number: 1 if the driver completes its motion, else 0."""
    return float(completes_range(results, ends))


def stroke_end_angle(results: Results, near: float) -> float:
    """Return the angle (rad) of a swinging output in that extreme position whose angle is nearest to `near` (rad).

    It is the angle of the line from the hinge of the link on the frame to the first other point of the link. The result
    is nan if the output does not swing.
    """
    strokes, linkage = results.strokes, results.linkage
    if strokes is None or not strokes.strokes or strokes.kind != "swing":
        return NO_VALUE
    points = linkage.links[strokes.link].points
    fixed = next((h.point for h in linkage.hinges if {FRAME, strokes.link} <= set(h.links)), None)
    other = next((name for name in points if name != fixed), None)
    if fixed is None or other is None:
        return NO_VALUE
    arm = points[other] - points[fixed]
    turn = math.atan2(arm.imag, arm.real)
    ends = [turn + end - near for s in strokes.strokes for end in (s.low, s.low + s.run)]
    return near + min((math.remainder(away, math.tau) for away in ends), key=abs)


# Demands of a synthesis, measured on the analysed mechanism.


@dataclass(frozen=True)
class MeasuredDemand:
    """A required or predicted value, compared with the value measured on the mechanism.

    Attributes:
        demand: the required or predicted value.
        value: measured value (SI, rad); nan if the mechanism has no such quantity.
        difference: relative difference between the measured and the required value.
        open: uncertainty of the measured value from rounding; 0 if it is within the tolerance.
    """

    demand: Demand
    value: float
    difference: float
    open: float = 0.0

    @property
    def met(self) -> bool:
        return self.difference <= max(DEMAND_MET, self.open)


@lru_cache(maxsize=1)
def measure_problem(results: Results) -> tuple[MeasuredDemand, ...]:
    """Measure the values that the synthesis of a problem requires or predicts.

    Returns:
        One record per value; () if the problem has no synthesis, or if its motion was not computed completely.
    """
    synthesis = results.problem.synthesis
    if synthesis is None or results.of or results.motion is None:
        return ()
    return measure_demands(synthesis.outcome, results)


def measure_demands(outcome: SynthesisOutcome, results: Results) -> tuple[MeasuredDemand, ...]:
    """Measure, on the analysed mechanism, the values that a synthesis requires or predicts.

    They are measured on the link that the synthesis concerns, even if the file names another output link.
    """
    results, measured = _replace_output_link(synthesised_link(outcome, results), results), []
    for demand in outcome.demands:
        value = _zero_rounding(demand, float(demand.measure(results)))
        left = demand.open(results) if demand.open is not None else 0.0
        measured.append(MeasuredDemand(demand, value, demand.difference(value), left if left > DEMAND_MET else 0.0))
    return tuple(measured)


def synthesised_link(outcome: SynthesisOutcome, results: Results) -> str | None:
    """Return the link whose stroke or swing the synthesis determines.

    Of the links that slide, or swing, on the frame this is the one nearest to the driver; of several equally near ones
    the output link of the file. The output link is also returned if the task specifies neither slide nor swing.
    """
    linkage, output = results.linkage, results.mechanism.output
    on_frame = {"slide": linkage.slides_on_frame, "swing": linkage.hinged_to_frame}.get(outcome.output)
    if on_frame is None:
        return output
    away = {FRAME: 0} | {driver.link: 0 for driver in linkage.drivers}  # number of groups between the driver and a link
    for group in results.structure.all_groups:
        away |= dict.fromkeys(group.links, 1 + max(away[link] for link in group.known))
    links = [link for group in results.structure.all_groups for link in group.links if on_frame(link)]
    return min(links, key=lambda link: (away[link], link != output), default=output)


def _replace_output_link(link: str | None, results: Results) -> Results:
    mechanism = results.mechanism
    if link is None or link == mechanism.output:
        return results
    inputs = replace(results.inputs, linkage=replace(results.linkage, output=Output(link), outputs=(Output(link),)))
    other = replace(mechanism, inputs=inputs).with_known(kernels=mechanism.kernels, driver_range=mechanism.driver_range)
    return replace(results, inputs=inputs, mechanism=other)


def _zero_rounding(demand: Demand, value: float) -> float:
    """Return the measured value, or zero if its magnitude is no more than the rounding error of the required value."""
    return 0.0 if abs(value) <= NO_DEMAND * max(abs(demand.value), demand.at) else value
