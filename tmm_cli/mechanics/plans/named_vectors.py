"""Plans as named vectors in one plane, and the scale at which they are drawn on paper."""

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
)  # scale factors, times a power of ten; of GOST 2.302 those of every decade
LANDSCAPE, PORTRAIT = (297.0, 210.0), (210.0, 297.0)  # A4, mm
MARGIN, STRIP = 12.0, 16.0  # mm: edge of the drawing, height of the title strip
PAD = 22.0  # mm around the figure, for labels


@dataclass(frozen=True)
class NamedVector:
    """Vector from start to end (SI) with its name on the plan and the symbol of its value.

    The name of a velocity or an acceleration is its segment on the plan: pa, with the value v_A.
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
    """Vectors of a plan. ends: lettered points, the pole among them; corners: points where components meet (n,
    k).
    """

    vectors: tuple[NamedVector, ...]
    ends: Mapping[str, complex] = field(default_factory=dict)
    corners: Mapping[str, complex] = field(default_factory=dict)

    @property
    def size(self) -> float:
        """Largest extent, SI."""
        points = [*self.ends.values(), *(p for v in self.vectors for p in (v.start, v.end))]
        return extent(points)[0] if points else 0.0

    def drawn(self) -> tuple[NamedVector, ...]:
        """Return the vectors that are longer than rounding errors."""
        least = NO_VECTOR * self.size
        return tuple(v for v in self.vectors if abs(v.value) > least)


def extent(points: Iterable[complex]) -> tuple[float, float, float, complex]:
    """Return the larger side, width, height and centre of the bounding box of points."""
    points = list(points)
    xs, ys = [p.real for p in points], [p.imag for p in points]
    width, height = max(xs) - min(xs), max(ys) - min(ys)
    return max(width, height), width, height, complex((max(xs) + min(xs)) / 2, (max(ys) + min(ys)) / 2)


def drawing_area(paper: tuple[float, float]) -> tuple[complex, complex]:
    """Return the corners of the area below the title strip, mm."""
    return MARGIN * (1 + 1j), complex(paper[0] - MARGIN, paper[1] - MARGIN - STRIP)


def round_scale(width: float, height: float, paper_width: float, paper_height: float) -> float:
    """Return the smallest round scale factor (SI units per mm) at which a box fits on paper (mm)."""
    least = max(width / paper_width, height / paper_height)
    if not least > 0 or not math.isfinite(least):
        return 1.0
    power = 10.0 ** math.floor(math.log10(least))
    # the tolerance keeps a figure that fits exactly from jumping to the next factor by rounding
    return next((f * power for f in ROUND_SCALES if f * power >= least * (1 - 1e-9)), 10 * power)


def sheet_scale(points: Iterable[complex], pad: float = PAD) -> tuple[tuple[float, float], float]:
    """Return the paper size (mm) on which points (SI) are drawn largest, and the scale (SI units per mm)."""
    _, width, height, _ = extent(list(points) or [0j])
    scales = {
        paper: round_scale(width, height, paper[0] - 2 * (MARGIN + pad), paper[1] - STRIP - 2 * (MARGIN + pad))
        for paper in (LANDSCAPE, PORTRAIT)
    }
    best = min(scales, key=lambda paper: (scales[paper], paper[1]))
    return best, scales[best]


def with_subscripts(segment: str) -> str:
    """Write the figures of a segment or a lettered point as subscripts: pa₃, s₁."""
    return segment.translate(SUBSCRIPTS)
