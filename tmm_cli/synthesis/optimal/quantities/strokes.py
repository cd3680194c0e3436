"""Quantities of the output strokes (length, time ratio, mean speed). A stroke ends where the output reverses."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np

from tmm_cli.language import N_
from tmm_cli.mechanics.analysis import Results
from tmm_cli.mechanics.forces import Reactions
from tmm_cli.mechanics.kinematics import Motion, output_coordinate, output_slope
from tmm_cli.mechanics.linkage import Linkage
from tmm_cli.mechanics.numerics import Real, highest_value, locate_zero, window_peak
from tmm_cli.synthesis import measures
from tmm_cli.synthesis.measures import DriverEnds, time_ratio_of_curve
from tmm_cli.synthesis.optimal.quantities.base import Curve, MechanismQuantity, QuantityRange, Read, Windows

FOUR = 4  # reversals in a cycle: with more, the extremes may belong to different strokes


class StrokeQuantity(MechanismQuantity):
    """A quantity of the output strokes, computed from windows of positions around the ends of the strokes.

    If the output swings, jumps of its angle by 360 degrees are removed.
    """

    of_a_cycle: ClassVar[bool] = False

    def unfit(self, linkage: Linkage, groups: Any, *, closed: bool) -> str | None:
        if self.output(linkage, groups) is None:
            return N_(
                "the linkage has no output link with a stroke, that is, no output link that slides or swings on "
                "the frame"
            )
        if self.of_a_cycle and not closed:
            return N_(
                "this quantity is defined only for a continuously rotating driver; here the driver moves between "
                "two end positions"
            )
        return None

    def outputs(self, motion: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
        output = self.output(motion.linkage, tuple(kernel.group for kernel in motion.kernels))
        assert output is not None
        return {"slope": output_slope(motion, output), "run": output_coordinate(motion, output)}

    def windows(self, read: Read, over: QuantityRange) -> list[tuple[Any, int]]:
        slope = read("slope")[0]
        moves = np.flatnonzero(slope)  # zero in a dwell
        after = np.roll(moves, -1) if over.closed else np.append(moves[1:], moves[-1:])
        turns = [int(k) for k in moves[slope[moves] * slope[after] < 0]]
        turns = turns if over.closed else [0, *turns, len(slope) - 1]
        if not over.swings:
            return [(0.0, k) for k in turns]
        followed = np.unwrap(read("run")[0])
        return [(float(followed[k]), k) for k in turns]

    def fine(self, parts: Windows, exact: Read, over: QuantityRange, step: float) -> Real:
        return self.between(parts, over, step) if parts else exact("slope")[:, :1] * np.nan

    @abstractmethod
    def between(self, parts: Windows, over: QuantityRange, step: float) -> Real:
        """Return values of the quantity, shape (variants, values), from windows of positions around the ends of the
        strokes.
        """


class OutputStroke(StrokeQuantity):
    """Stroke (m) or swing angle (rad) of the output link; the longest one if there are several."""

    of, text = "stroke", N_("stroke of the output link")

    def kind(self, linkage: Linkage, groups: Any) -> str:
        return "length" if self.slides(linkage, groups) else "angle"

    def coarse(self, read: Read, over: QuantityRange) -> Real:
        travel = coarse_travel(read, over)
        if over.closed and np.any(count_reversals(read("slope")) > FOUR):
            return longest_stroke(read("run"), travel, turns=over.swings)
        return travel

    def between(self, parts: Windows, over: QuantityRange, step: float) -> Real:
        runs = unwrap_runs(parts, over)
        if over.closed and len(parts) > FOUR:
            return stroke_lengths(runs).T
        whole = np.vstack(runs)
        tops, lows = (window_peak(side * whole).reshape(len(runs), -1) for side in (1, -1))
        travel: Real = np.max(tops, axis=0) + np.max(lows, axis=0)
        return travel[:, None]

    def refine_value(self, value: float, curve: Curve, scan: Real, over: QuantityRange) -> float:
        several = over.closed and count_reversals(curve("slope", scan)[None])[0] > FOUR
        if over.swings or not over.traced or several or np.isnan(value):
            return value
        top = highest_value(lambda shares: curve("run", shares), scan, closed=over.closed)
        return top + highest_value(lambda shares: -curve("run", shares), scan, closed=over.closed)

    def measure_range(self, results: Results, ends: DriverEnds) -> float:
        return measures.output_stroke(results, ends)


class TimeRatio(StrokeQuantity):
    """Time ratio k: duration of the slower stroke divided by that of the faster one, at least 1."""

    of, text, dimension, of_a_cycle = (
        "k",
        N_("k: duration of the longer stroke divided by that of the shorter one"),
        "number",
        True,
    )

    def coarse(self, read: Read, over: QuantityRange) -> Real:
        return time_ratio_of_share(forward_share(read("slope")))

    def between(self, parts: Windows, over: QuantityRange, step: float) -> Real:
        forward: Any = 0.0
        for __, start, read in parts:
            slope = read("slope")
            forward = forward + np.where(slope[:, 0] > 0, 1, -1) * (start + step * locate_zero(slope))
        return time_ratio_of_share(np.mod(forward, 1.0))[:, None]

    def refine_value(self, value: float, curve: Curve, scan: Real, over: QuantityRange) -> float:
        return time_ratio_of_curve(lambda shares: curve("slope", shares), scan)

    def measure_range(self, results: Results, ends: DriverEnds) -> float:
        k = measures.time_ratio(results)
        return max(k, 1 / k)

    def open(self, results: Results) -> float:
        return measures.time_ratio_uncertainty(results)


class MeanOutputSpeed(StrokeQuantity):
    """Mean speed (m/s) of a sliding output link over a cycle; over the first cycle if the crank accelerates."""

    of, text, dimension, of_a_cycle = "speed", N_("mean speed of the output link"), "speed", True

    def unfit(self, linkage: Linkage, groups: Any, *, closed: bool) -> str | None:
        if not self.slides(linkage, groups) and self.output(linkage, groups) is not None:
            return N_("the output link swings: it has no mean speed in m/s")
        return super().unfit(linkage, groups, closed=closed)

    def outputs(self, motion: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
        outputs, driver = super().outputs(motion, reactions), motion.linkage.driver
        nothing = 0.0 * outputs["slope"]
        return {**outputs, "rate": driver.rate + nothing, "gain": driver.acceleration + nothing}

    def coarse(self, read: Read, over: QuantityRange) -> Real:
        run = read("run")
        speed: Real = np.sum(np.abs(run - np.roll(run, 1, axis=1)), axis=1) * mean_crank_speed(read, over) / over.cycle
        return speed

    def between(self, parts: Windows, over: QuantityRange, step: float) -> Real:
        speed: Real = (
            np.sum(stroke_lengths(unwrap_runs(parts, over)), axis=0) * mean_crank_speed(parts[0][2], over) / over.cycle
        )
        return speed[:, None]

    def measure_range(self, results: Results, ends: DriverEnds) -> float:
        return measures.mean_output_speed(results)


def coarse_travel(read: Read, over: QuantityRange) -> Real:
    """Return the approximate range of the output motion, shape (variants,); nan if the output rotates continuously."""
    run = read("run")
    travel: Real = np.max(run, axis=1) - np.min(run, axis=1)
    if over.swings and np.any(past := travel > np.pi):  # angles lie in -pi..pi, neighbours less than pi apart
        slope = read("slope")[past]
        turns = np.all(slope > 0, axis=1) | np.all(slope < 0, axis=1)  # an output without reversals has no strokes
        travel[past] = np.where(turns & over.closed, np.nan, np.ptp(np.unwrap(run[past], axis=1), axis=1))
    return travel


def longest_stroke(run: Real, travel: Real, *, turns: bool) -> Real:
    """Return the longest stroke of a periodic curve with several reversals, shape (variants,).

    Args:
        run: samples over one cycle, shape (variants, positions).
        travel: total range of each curve, an upper limit of the stroke, shape (variants,).
        turns: True if the curve is an angle wrapped to -pi..pi.
    """
    step = np.diff(run, axis=1, append=run[:, :1])
    step = (step + np.pi) % (2 * np.pi) - np.pi if turns else step
    stroke, best = np.zeros(len(run)), np.zeros(len(run))
    for k in range(2 * run.shape[1]):  # two cycles, for the stroke that continues past the end
        increment = step[:, k % run.shape[1]]
        stroke = np.where(stroke * increment >= 0, stroke + increment, increment)
        best = np.maximum(best, np.abs(stroke))
    return np.minimum(best, travel)


def count_reversals(slope: Real) -> Real:
    """Return how often the motion reverses in a cycle, shape (variants,). A reversal with a dwell may count twice."""
    sign = np.sign(slope)
    reversals: Real = np.sum(sign != np.roll(sign, 1, axis=1), axis=1)
    return reversals


def unwrap_runs(parts: Windows, over: QuantityRange) -> list[Real]:
    """Return the motion of the output in each window of positions, with jumps of angles by 360 degrees removed."""
    runs = []
    for angle, __, read in parts:
        run = read("run")
        runs.append(run - 2 * np.pi * np.round((run - angle) / (2 * np.pi)) if over.swings else run)
    return runs


def stroke_lengths(runs: list[Real]) -> Real:
    """Return the lengths of the strokes, shape (strokes, variants), from windows of positions around their ends."""
    ends = [
        np.where(run[:, 0] + run[:, -1] < 2 * np.mean(run, axis=1), window_peak(run), -window_peak(-run))
        for run in runs
    ]
    return np.abs(np.diff([*ends, ends[0]], axis=0))


def forward_share(slope: Real) -> Real:
    """Return the fraction of the time of motion, without dwells, in which a curve rises, shape (variants,).

    Args:
        slope: slope of the curve at equal steps, shape (variants, positions); zero in dwells.
    """
    after = np.roll(slope, -1, axis=1)
    up, down = np.maximum(slope, 0) + np.maximum(after, 0), np.maximum(-slope, 0) + np.maximum(-after, 0)
    with np.errstate(all="ignore"):
        rests = up + down == 0
        fraction: Real = np.sum(np.where(rests, 0.0, up / (up + down)), axis=1) / np.sum(~rests, axis=1)
    return fraction


def time_ratio_of_share(share: Real) -> Real:
    """Return the time ratio k of two strokes from the fraction of time that one of them takes."""
    with np.errstate(all="ignore"):
        ratio: Real = np.maximum(share, 1 - share) / np.minimum(share, 1 - share)
    return ratio


def mean_crank_speed(read: Read, over: QuantityRange) -> Real:
    """Return the mean crank speed in the first cycle, shape (variants,): half the sum of the speeds at its start and
    end.
    """
    rate, gain = (read(name)[:, 0] for name in ("rate", "gain"))
    return (rate + np.sqrt(rate * rate + 2 * gain * over.cycle)) / 2
