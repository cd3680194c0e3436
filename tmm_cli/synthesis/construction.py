"""Drawings of a synthesis as records, drawn elsewhere: ruler-and-compass constructions and diagrams.

Points are complex numbers in metres; angles are in radians.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final, Literal

import numpy as np

Style = Literal["link", "link2", "thin", "dashed", "axis", "bold"]
Mark = Literal["hinge", "support", "slider", "stone", "dot", "none"]
Chain = Literal["", "four-bar", "crank-slider", "slotted-lever", "shaper"]
CHAIN_LETTERS: Final[Mapping[Chain, str]] = {  # letters of the joints from the driver's pivot, as in constructions
    "four-bar": "ABCD",
    "crank-slider": "OAB",
    "slotted-lever": "OACB",
    "shaper": "OACDE",
}


@dataclass(frozen=True)
class Segment:
    """A straight line; name: the text beside it."""

    start: complex
    end: complex
    style: Style = "thin"
    name: str = ""


@dataclass(frozen=True)
class Arc:
    """An arc of a circle, counterclockwise from `start` to `end` (rad)."""

    centre: complex
    radius: float
    start: float
    end: float
    style: Style = "thin"


def full_circle(centre: complex, radius: float) -> Arc:
    """Return a whole circle as a construction line."""
    return Arc(centre, radius, 0.0, 2 * np.pi, "dashed")


def swept_arc(centre: complex, points: Any, style: Style = "thin", beyond: float = 0.0) -> Arc:
    """Return the arc about a centre through successive points (an array), extended by `beyond` (rad) at both ends."""
    turns = np.unwrap(np.angle(points - centre))
    return Arc(centre, float(abs(points[0] - centre)), float(turns.min()) - beyond, float(turns.max()) + beyond, style)


@dataclass(frozen=True)
class ConstructionCurve:
    """A curve through closely spaced points (locus of pivots, coupler curve), cut at the edge of the sheet.

    name: the text beside it; pieces of one curve share a name, which is written once.
    """

    places: tuple[complex, ...]
    style: Style = "thin"
    name: str = ""


@dataclass(frozen=True)
class LetteredPoint:
    """A point with a letter. along: direction of a slider's guide, or of the link that carries a sliding block."""

    name: str
    at: complex
    mark: Mark = "dot"
    along: complex = 1 + 0j


@dataclass(frozen=True)
class Angle:
    """The angle at a vertex between the directions to two points. right: drawn with a right-angle mark."""

    vertex: complex
    first: complex
    last: complex
    name: str = ""
    right: bool = False


@dataclass(frozen=True)
class DimensionLine:
    """A dimension: the distance of two points along a direction; along = 0: along the line between them."""

    start: complex
    end: complex
    name: str
    along: complex = 0j


@dataclass(frozen=True)
class CircleCentre:
    """Centre of a construction circle, with lines to it from points on the circle; it may lie far off the sheet."""

    at: complex
    radius: float
    legs: tuple[complex, ...]
    name: str = "M"


@dataclass(frozen=True)
class GeometricConstruction:
    """A construction drawn to scale on a sheet of its own.

    Attributes:
        title, notes: texts with letters in {}; the notes stand in a corner.
        name: name of its file.
        wishes: sets of points to show too, in order of priority, if the mechanism stays large enough. Other points that
            are not in `places` are cut at the edge of the sheet.
        chain: the mechanism it shows; gives the letters of the joints (CHAIN_LETTERS).
        values: name, value (SI) and kind of the quantities listed in the corner.
        around: further points that the sheet must hold.
    """

    title: str
    segments: tuple[Segment, ...] = ()
    arcs: tuple[Arc, ...] = ()
    spots: tuple[LetteredPoint, ...] = ()
    notes: tuple[str, ...] = ()
    curves: tuple[ConstructionCurve, ...] = ()
    name: str = "construction"
    angles: tuple[Angle, ...] = ()
    sizes: tuple[DimensionLine, ...] = ()
    centres: tuple[CircleCentre, ...] = ()
    wishes: tuple[tuple[complex, ...], ...] = ()
    chain: Chain = ""
    values: tuple[tuple[str, float, str], ...] = ()  # name, value in SI, kind
    around: tuple[complex, ...] = ()  # further points that the sheet must hold

    def places(self) -> list[complex]:
        """Return the points that the sheet must hold."""
        ends = [place for s in self.segments for place in (s.start, s.end)]
        sizes = [place for s in self.sizes for place in (s.start, s.end)]
        return [*ends, *(s.at for s in self.spots), *sizes, *self.around]


def circle_extent(centre: complex, radius: float) -> tuple[complex, ...]:
    """Return four points whose bounding box contains the circle."""
    return tuple(centre + radius * direction for direction in (1, 1j, -1, -1j))


@dataclass(frozen=True)
class DiagramLine:
    """A curve of a diagram. text: legend; x, y: values (SI, rad); dots: drawn as points; faint: behind the others."""

    text: str
    x: Any
    y: Any
    dots: bool = False
    faint: bool = False


@dataclass(frozen=True)
class Diagram:
    """A diagram, for example of the structural error or of the largest pressure angle along an arc.

    x, y: title and kind of the axes; equal: both axes to one scale, as for a path. lower: curves of a second panel
    below, over the same x, with a logarithmic axis `lower_y`.
    """

    name: str
    title: str
    x: tuple[str, str]
    y: tuple[str, str]
    lines: tuple[DiagramLine, ...]
    equal: bool = False
    lower: tuple[DiagramLine, ...] = ()
    lower_y: tuple[str, str] = ("", "number")
