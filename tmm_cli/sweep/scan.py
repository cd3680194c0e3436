"""Scan of variants over one revolution of the crank: assembly, full rotation, limits, ends of strokes.

The variants are first evaluated at equally spaced driver positions by replaying a trace. A search follows where
something may happen between two positions: a group cannot be assembled, a stroke ends, or a curve that has a limit has
a peak. Variants for which this is inconclusive are scanned again in smaller steps.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from tmm_cli.batch import Variant, split_columns, working_and_idle_strokes
from tmm_cli.mechanics.kinematics import Strokes, resisted_direction
from tmm_cli.mechanics.numerics import Real, find_minima, find_roots
from tmm_cli.sweep.traced_stages import (
    FINE_SCAN,
    CrankVariants,
    VariantCurves,
    candidate_peaks,
    refine_peaks,
    sign_changes,
)

SCAN = 72  # positions per revolution of the driver
BLOCK = 50  # variants in one fine scan
SCAN_WORKS, SCAN_STOPS, SCAN_APART = range(3)  # states of a variant


@dataclass(frozen=True)
class ScanRequest:
    """Curves to be examined in a scan.

    Attributes:
        peaks: names of curves whose largest values are needed with full precision.
        limits: limits by the name of the curve; a peak near its limit is computed with full precision.
        strokes: True if the ends of strokes are needed.
    """

    peaks: Sequence[str] = ()
    limits: Mapping[str, float] = field(default_factory=dict)
    strokes: bool = True


@dataclass(frozen=True, eq=False)
class ScanResults:
    """Results of a scan.

    Attributes:
        does: state of each variant: SCAN_WORKS, SCAN_STOPS or SCAN_APART, (variants,).
        sure: True where the scan is conclusive: each output has as many strokes as in the first variant, and no curve
            comes so close to zero that a change of sign may be overlooked, (variants,).
        peaks: largest value of each curve that has a limit, by name, (variants,). It is nan unless the variant works.
            If it
            was not requested and is far below its limit, it is only the largest of the scanned values.
        ends: driver coordinates at the ends of the strokes of `CrankVariants.stroke_links`, (variants, links, 2).
    """

    does: Real
    sure: Real
    peaks: Mapping[str, Real]
    ends: Real

    def take(self, rows: Real) -> ScanResults:
        """Return the results of the selected variants."""
        peaks = {name: peak[rows] for name, peak in self.peaks.items()}
        return ScanResults(self.does[rows], self.sure[rows], peaks, self.ends[rows])


def scan_variants(crank_variants: CrankVariants, columns: Real, request: ScanRequest) -> ScanResults:
    """Scan variants of a linkage over one revolution of the crank.

    Args:
        crank_variants: the traced problem.
        columns: parameter values of the variants in SI units, (variants, parameters).
        request: curves to be examined.
    """
    scanned = _VariantScan(crank_variants, columns, request, SCAN).scanned
    again = np.flatnonzero(~scanned.sure)
    for rows in np.array_split(again, -(-len(again) // BLOCK)) if again.size else ():
        fine = _VariantScan(crank_variants, columns[rows], request, FINE_SCAN).scanned
        scanned.does[rows], scanned.sure[rows], scanned.ends[rows] = fine.does, fine.sure, fine.ends
        for name, peak in scanned.peaks.items():
            peak[rows] = fine.peaks[name]
    return scanned


class _VariantScan:
    """Curves of variants at equally spaced driver positions of one revolution."""

    def __init__(self, crank_variants: CrankVariants, columns: Real, request: ScanRequest, samples: int) -> None:
        self.crank_variants, self.columns, self.request = crank_variants, columns, request
        self.places, self.step = samples, 2 * np.pi / samples
        self.found = crank_variants.scan(*split_columns(columns), self.at(np.arange(samples)))

    def at(self, numbers: Real) -> Real:
        """Return the driver coordinates at scan positions, which are given by their numbers."""
        return self.crank_variants.linkage.sketch.at + self.step * numbers

    @property
    def scanned(self) -> ScanResults:
        """Results of the scan. Where necessary they are computed more exactly between scan positions."""
        does, sure = self._determine_states()
        ends = np.full((len(self.columns), len(self.crank_variants.stroke_links), 2), np.nan)
        if self.request.strokes and np.any(does == SCAN_WORKS):
            for k in range(len(self.crank_variants.stroke_links)):
                slope = self.found[f"slope{k}"]
                turns = sign_changes(slope)
                sure &= np.sum(turns, axis=1) == self.crank_variants.strokes[k]
                sure &= ~_may_reach_zero(-np.abs(slope), ~(turns | np.roll(turns, 1, axis=1)))
                rows = np.flatnonzero((does == SCAN_WORKS) & sure)
                if self.crank_variants.strokes[k] and rows.size:
                    low = np.nonzero(turns[rows])[1].reshape(-1, 2)
                    slope_of = _curve_of_variants(self.crank_variants, f"slope{k}", self.columns[rows])
                    ends[rows, k] = _find_stroke_ends(slope_of, self.at(low), self.at(low + 1))
        works = does == SCAN_WORKS
        peaks = {
            limited.name: np.where(works, self._largest_values(limited.name, works), np.nan)
            for limited in self.crank_variants.limited
        }
        return ScanResults(does, sure | ~works, peaks, ends)

    def _determine_states(self) -> tuple[Real, Real]:
        """Determine the state of each variant from its assembly over one revolution.

        Returns:
            States, (variants,), and True where the state is certain, (variants,).
        """
        does = np.full(len(self.columns), SCAN_WORKS)
        apart, lost, doubtful = np.zeros((3, len(does)), dtype=bool)
        for k in range(len(self.crank_variants.kernels)):
            gap, slack, det = (self.found[f"{name}{k}"] for name in ("gap", "slack", "det"))
            missing = ~(gap <= 0)
            apart |= missing[:, 0]
            lost |= np.any(missing | (gap >= -2 * slack) | (np.sign(det) != np.sign(det[:, :1])), axis=1)
            if k in self.crank_variants.single:
                doubtful |= _may_reach_zero(-np.abs(det), np.ones(det.shape, dtype=bool))
        does[lost], does[apart] = SCAN_STOPS, SCAN_APART
        for k in range(len(self.crank_variants.kernels)):
            name = f"gap{k}"
            gap = self.found[name]
            rows, at = candidate_peaks(gap, np.zeros(len(gap)), (does == SCAN_WORKS)[:, None])
            if rows.size:
                close = VariantCurves(self.crank_variants.curve_program(name, f"slack{k}"), self.columns[rows])
                q = self.at(at)
                place, value = find_minima(_negated_curve(close, name), q - self.step, q + self.step)
                does[rows[-value >= -2 * close(place)[f"slack{k}"]]] = SCAN_STOPS
        return does, ~doubtful

    def _largest_values(self, name: str, works: Real) -> Real:
        """Return the largest value of a curve for each variant, (variants,).

        Unless the request asks for its peaks, the value is computed exactly only where the curve may reach its limit.
        """
        curve = self.found[name]
        top: Real = np.max(curve, axis=1)
        limit = self.request.limits.get(name)
        level = top if name in self.request.peaks or limit is None else np.maximum(top, limit)
        rows, at = candidate_peaks(curve, level, works[:, None])
        if rows.size:
            close = VariantCurves(self.crank_variants.curve_program(name), self.columns[rows])
            before, centre, after = (curve[rows, (at + n) % self.places] for n in (-1, 0, 1))
            peaks = refine_peaks(lambda q: close(q)[name], self.at(at), self.step, (before, centre, after))
            np.maximum.at(top, rows, peaks)
        return top


def _may_reach_zero(curve: Real, where: Real) -> Real:
    """Return True for each variant whose curve, negative at the scan positions, may reach zero between two of them.

    where: mask of the positions to be examined, (variants, positions).
    """
    rows, _at = candidate_peaks(curve, np.zeros(len(curve)), where)
    reaching = np.zeros(len(curve), dtype=bool)
    reaching[rows] = True
    return reaching


def _find_stroke_ends(slope: Callable[[Real], Real], low: Real, high: Real) -> Real:
    """Find the ends of strokes: zeros of the slope of the output coordinate between `low` and `high`.

    If a zero lies at one of these bounds and rounding hides the change of sign, that bound is returned.
    """
    at_low, at_high = slope(low), slope(high)
    outside = np.sign(at_low) == np.sign(at_high)
    roots = find_roots(slope, low, high)
    return np.where(outside, np.where(np.abs(at_low) < np.abs(at_high), low, high), roots)


def _curve_of_variants(crank_variants: CrankVariants, name: str, columns: Real) -> Callable[[Real], Real]:
    """Return a function that evaluates one curve of the variants at driver coordinates, (variants, n)."""
    close = VariantCurves(crank_variants.curve_program(name), columns)
    return lambda q: close(q)[name]


def _negated_curve(close: VariantCurves, name: str) -> Callable[[Real], Real]:
    return lambda q: -close(q)[name]


def variant_strokes(
    crank_variants: CrankVariants, columns: Real, scanned: ScanResults, varied: Variant
) -> Strokes | None:
    """Return the strokes of working variants, whose numbers are arrays (variants, 1); None if no link has strokes."""
    outputs = []
    for k, link in enumerate(crank_variants.stroke_links):
        curve = _TracedOutputCurve(
            link, crank_variants.linkage.output_swings(link), _curve_of_variants(crank_variants, f"place{k}", columns)
        )
        if crank_variants.strokes[k]:
            resists = resisted_direction(varied.linkage, link)
            outputs.append(working_and_idle_strokes(crank_variants.linkage, curve, scanned.ends[:, k], resists))
        else:
            outputs.append(Strokes(link, curve.kind, (), ""))
    return replace(outputs[0], others=tuple(outputs[1:])) if outputs else None


@dataclass(frozen=True)
class _TracedOutputCurve:
    """Coordinate of an output link as a function of the driver coordinate, in the form of `kinematics.Curve`."""

    link: str
    swings: bool
    place: Callable[[Real], Real]

    @property
    def kind(self) -> str:
        return "swing" if self.swings else "slide"
