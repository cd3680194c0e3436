"""Plans as named vectors in one plane, and the scales at which they are drawn on paper."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from tmm_cli.mechanics.forces import SUBSCRIPTS, Symbol, VectorKind
from tmm_cli.mechanics.numerics import NO_VECTOR

ROUND_SCALES = (
    1.0,
    2.0,
    2.5,
    4.0,
    5.0,
    10.0,
)  # scale factors, times a power of ten: those that GOST 2.302 allows in every decade
LANDSCAPE, PORTRAIT = (297.0, 210.0), (210.0, 297.0)  # A4, mm
MARGIN, STRIP = 12.0, 16.0  # mm: edge of the drawing, height of the title strip
PAD = 22.0  # mm around the figure, for labels


@dataclass(frozen=True)
class NamedVector:
    """Vector of a plan, from `start` to `end` (SI).

    Attributes:
        name: its name on the plan; for a velocity or an acceleration the letters of its ends, e.g. pa.
        kind: kind of vector, which determines how it is drawn.
        symbol: symbol of its value, e.g. v_A.
    """

    name: str
    start: complex
    end: complex
    kind: VectorKind
    symbol: Symbol = Symbol("")  # noqa: RUF009  frozen

    @property
    def value(self) -> complex:
        return self.end - self.start


@dataclass(frozen=True)
class Plan:
    """Vectors of a plan with its lettered points.

    Attributes:
        vectors: the vectors.
        ends: coordinates (SI) of the lettered points, the pole among them.
        corners: coordinates (SI) of the points n, k, ... at which two components meet.
    """

    vectors: tuple[NamedVector, ...]
    ends: Mapping[str, complex] = field(default_factory=dict)
    corners: Mapping[str, complex] = field(default_factory=dict)

    @property
    def size(self) -> float:
        """Larger side of the bounding box of the plan, in SI units."""
        points = [*self.ends.values(), *(p for v in self.vectors for p in (v.start, v.end))]
        return extent(points)[0] if points else 0.0

    def drawn(self) -> tuple[NamedVector, ...]:
        """Return the vectors that are not zero within rounding."""
        least = NO_VECTOR * self.size
        return tuple(v for v in self.vectors if abs(v.value) > least)


def extent(points: Iterable[complex]) -> tuple[float, float, float, complex]:
    """Return the larger side, the width, the height and the centre of the bounding box of some points."""
    points = list(points)
    xs, ys = [p.real for p in points], [p.imag for p in points]
    width, height = max(xs) - min(xs), max(ys) - min(ys)
    return max(width, height), width, height, complex((max(xs) + min(xs)) / 2, (max(ys) + min(ys)) / 2)


def drawing_area(paper: tuple[float, float]) -> tuple[complex, complex]:
    """Return two opposite corners (mm) of the area below the title strip of a sheet."""
    return MARGIN * (1 + 1j), complex(paper[0] - MARGIN, paper[1] - MARGIN - STRIP)


def round_scale(width: float, height: float, paper_width: float, paper_height: float) -> float:
    """Return the smallest round scale factor (SI units per mm) at which a box (SI) fits on the paper (mm)."""
    least = max(width / paper_width, height / paper_height)
    if not least > 0 or not math.isfinite(least):
        return 1.0
    power = 10.0 ** math.floor(math.log10(least))
    # the tolerance keeps a figure that fits exactly from jumping to the next factor by rounding
    return next((f * power for f in ROUND_SCALES if f * power >= least * (1 - 1e-9)), 10 * power)


def sheet_scale(points: Iterable[complex], pad: float = PAD) -> tuple[tuple[float, float], float]:
    """Choose portrait or landscape A4 for a figure, whichever shows it larger.

    Args:
        points: points of the figure, SI.
        pad: margin around the figure for labels, mm.

    Returns:
        Paper size (mm) and scale (SI units per mm).
    """
    _, width, height, _ = extent(list(points) or [0j])
    scales = {
        paper: round_scale(width, height, paper[0] - 2 * (MARGIN + pad), paper[1] - STRIP - 2 * (MARGIN + pad))
        for paper in (LANDSCAPE, PORTRAIT)
    }
    best = min(scales, key=lambda paper: (scales[paper], paper[1]))
    return best, scales[best]


def with_subscripts(segment: str) -> str:
    """Write the digits of a name as subscripts, e.g. pa₃ or s₁."""
    return segment.translate(SUBSCRIPTS)
