"""Scan of many variants at once by their trace: assembly, full rotation, limits, ends of strokes.

Driver positions of one revolution are scanned first; what decides between two of them (a group that may
fail to close, ends of strokes, peaks of limited quantities) is then searched there. Variants in which
much happens between two positions are scanned with a finer step.
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
    """Curves to be followed in a scan.

    Attributes:
        peaks: names of limited curves whose peaks are needed with full precision.
        limits: limits of curves, near which all peaks are computed precisely.
        strokes: True if the ends of strokes are to be found too.
    """

    peaks: Sequence[str] = ()
    limits: Mapping[str, float] = field(default_factory=dict)
    strokes: bool = True


@dataclass(frozen=True, eq=False)
class ScanResults:
    """State of each variant (SCAN_WORKS, ...), (variants,); for working ones the peaks of limited curves by
    name, else nan.

    sure: the scan is conclusive: outputs have the number of strokes of the first variant, no near misses. A
    peak far below its limit that was not requested has the precision of the scan. ends: driver coordinates of
    the ends of strokes of `CrankVariants.stroke_links`, (variants, links, 2).
    """

    does: Real
    sure: Real
    peaks: Mapping[str, Real]
    ends: Real

    def take(self, rows: Real) -> ScanResults:
        """Return the results of the selected variants."""
        peaks = {name: peak[rows] for name, peak in self.peaks.items()}
        return ScanResults(self.does[rows], self.sure[rows], peaks, self.ends[rows])


def scan_variants(crank_variants: CrankVariants, columns: Real, wish: ScanRequest) -> ScanResults:
    """Scan the variants whose numbers are the rows of columns (variants, n)."""
    scanned = _VariantScan(crank_variants, columns, wish, SCAN).looked
    again = np.flatnonzero(~scanned.sure)
    for rows in np.array_split(again, -(-len(again) // BLOCK)) if again.size else ():
        fine = _VariantScan(crank_variants, columns[rows], wish, FINE_SCAN).looked
        scanned.does[rows], scanned.sure[rows], scanned.ends[rows] = fine.does, fine.sure, fine.ends
        for name, peak in scanned.peaks.items():
            peak[rows] = fine.peaks[name]
    return scanned


class _VariantScan:
    """Variants at equally spaced driver positions of one revolution."""

    def __init__(self, crank_variants: CrankVariants, columns: Real, wish: ScanRequest, samples: int) -> None:
        self.crank_variants, self.columns, self.wish = crank_variants, columns, wish
        self.places, self.step = samples, 2 * np.pi / samples
        self.found = crank_variants.scan(*split_columns(columns), self.at(np.arange(samples)))

    def at(self, numbers: Real) -> Real:
        """Return driver coordinates of scan positions."""
        return self.crank_variants.linkage.sketch.at + self.step * numbers

    @property
    def looked(self) -> ScanResults:
        """Results of the scan."""
        does, sure = self._assembled()
        ends = np.full((len(self.columns), len(self.crank_variants.stroke_links), 2), np.nan)
        if self.wish.strokes and np.any(does == SCAN_WORKS):
            for k in range(len(self.crank_variants.stroke_links)):
                slope = self.found[f"slope{k}"]
                turns = sign_changes(slope)
                sure &= np.sum(turns, axis=1) == self.crank_variants.strokes[k]
                sure &= ~_nearly_reaches(-np.abs(slope), ~(turns | np.roll(turns, 1, axis=1)))
                rows = np.flatnonzero((does == SCAN_WORKS) & sure)
                if self.crank_variants.strokes[k] and rows.size:
                    low = np.nonzero(turns[rows])[1].reshape(-1, 2)
                    slope_of = _curve_of_variants(self.crank_variants, f"slope{k}", self.columns[rows])
                    ends[rows, k] = _stroke_ends(slope_of, self.at(low), self.at(low + 1))
        works = does == SCAN_WORKS
        peaks = {
            limited.name: np.where(works, self._peak(limited.name, works), np.nan)
            for limited in self.crank_variants.limited
        }
        return ScanResults(does, sure | ~works, peaks, ends)

    def _assembled(self) -> tuple[Real, Real]:
        """State of each variant by assembly at the sketch, full rotation and dead positions; and whether it is
        certain.
        """
        does = np.full(len(self.columns), SCAN_WORKS)
        apart, lost, doubtful = np.zeros((3, len(does)), dtype=bool)
        for k in range(len(self.crank_variants.kernels)):
            gap, slack, det = (self.found[f"{name}{k}"] for name in ("gap", "slack", "det"))
            missing = ~(gap <= 0)
            apart |= missing[:, 0]
            lost |= np.any(missing | (gap >= -2 * slack) | (np.sign(det) != np.sign(det[:, :1])), axis=1)
            if k in self.crank_variants.single:
                doubtful |= _nearly_reaches(-np.abs(det), np.ones(det.shape, dtype=bool))
        does[lost], does[apart] = SCAN_STOPS, SCAN_APART
        for k in range(len(self.crank_variants.kernels)):
            name = f"gap{k}"
            gap = self.found[name]
            rows, at = candidate_peaks(gap, np.zeros(len(gap)), (does == SCAN_WORKS)[:, None])
            if rows.size:
                close = VariantCurves(self.crank_variants.part(name, f"slack{k}"), self.columns[rows])
                q = self.at(at)
                place, value = find_minima(_negated_curve(close, name), q - self.step, q + self.step)
                does[rows[-value >= -2 * close(place)[f"slack{k}"]]] = SCAN_STOPS
        return does, ~doubtful

    def _peak(self, name: str, works: Real) -> Real:
        """Largest value of a curve of each variant; if not requested, refined only near its limit."""
        curve = self.found[name]
        top: Real = np.max(curve, axis=1)
        limit = self.wish.limits.get(name)
        level = top if name in self.wish.peaks or limit is None else np.maximum(top, limit)
        rows, at = candidate_peaks(curve, level, works[:, None])
        if rows.size:
            close = VariantCurves(self.crank_variants.part(name), self.columns[rows])
            before, centre, after = (curve[rows, (at + n) % self.places] for n in (-1, 0, 1))
            peaks = refine_peaks(lambda q: close(q)[name], self.at(at), self.step, (before, centre, after))
            np.maximum.at(top, rows, peaks)
        return top


def _nearly_reaches(curve: Real, where: Real) -> Real:
    """Variants whose negative curves may reach zero between two positions. where: positions that count."""
    rows, _at = candidate_peaks(curve, np.zeros(len(curve)), where)
    reaching = np.zeros(len(curve), dtype=bool)
    reaching[rows] = True
    return reaching


def _stroke_ends(slope: Callable[[Real], Real], low: Real, high: Real) -> Real:
    """Roots between scan positions; a root at a position itself may be lost by rounding, and is taken there."""
    at_low, at_high = slope(low), slope(high)
    outside = np.sign(at_low) == np.sign(at_high)
    roots = find_roots(slope, low, high)
    return np.where(outside, np.where(np.abs(at_low) < np.abs(at_high), low, high), roots)


def _curve_of_variants(crank_variants: CrankVariants, name: str, columns: Real) -> Callable[[Real], Real]:
    """One curve of variants, as a function of driver coordinates of each."""
    close = VariantCurves(crank_variants.part(name), columns)
    return lambda q: close(q)[name]


def _negated_curve(close: VariantCurves, name: str) -> Callable[[Real], Real]:
    return lambda q: -close(q)[name]


def variant_strokes(
    crank_variants: CrankVariants, columns: Real, looked: ScanResults, varied: Variant
) -> Strokes | None:
    """Strokes of working variants, as arrays (variants, 1)."""
    outputs = []
    for k, link in enumerate(crank_variants.stroke_links):
        curve = _TracedOutputCurve(
            link, crank_variants.linkage.output_swings(link), _curve_of_variants(crank_variants, f"place{k}", columns)
        )
        if crank_variants.strokes[k]:
            resists = resisted_direction(varied.linkage, link)
            outputs.append(working_and_idle_strokes(crank_variants.linkage, curve, looked.ends[:, k], resists))
        else:
            outputs.append(Strokes(link, curve.kind, (), ""))
    return replace(outputs[0], others=tuple(outputs[1:])) if outputs else None


@dataclass(frozen=True)
class _TracedOutputCurve:
    """Curve of one output, see `kinematics.Curve`."""

    link: str
    swings: bool
    place: Callable[[Real], Real]

    @property
    def kind(self) -> str:
        return "swing" if self.swings else "slide"
