"""Records that describe the drawings of a synthesis: ruler-and-compass constructions and diagrams.

The records are drawn by another package. Points are complex numbers in metres; angles are in radians.
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
    """A straight line between two points, with an optional text beside it.

    Attributes:
        start, end: ends of the line (complex, m).
        style: line style.
        name: text beside the line; empty for none.
    """

    start: complex
    end: complex
    style: Style = "thin"
    name: str = ""


@dataclass(frozen=True)
class Arc:
    """An arc of a circle, drawn counterclockwise from the angle `start` to the angle `end`.

    Attributes:
        centre: centre of the circle (complex, m).
        radius: radius (m).
        start, end: directions from the centre to both ends of the arc (rad).
        style: line style.
    """

    centre: complex
    radius: float
    start: float
    end: float
    style: Style = "thin"


def full_circle(centre: complex, radius: float) -> Arc:
    """Return a full circle, drawn as a dashed construction line."""
    return Arc(centre, radius, 0.0, 2 * np.pi, "dashed")


def swept_arc(centre: complex, points: Any, style: Style = "thin", beyond: float = 0.0) -> Arc:
    """Return the arc about a centre that passes through successive points of a circle.

    Args:
        centre: centre of the arc (complex, m).
        points: points on the circle in order of motion (complex array, m).
        style: line style.
        beyond: angle by which the arc is extended at both ends (rad).
    """
    turns = np.unwrap(np.angle(points - centre))
    return Arc(centre, float(abs(points[0] - centre)), float(turns.min()) - beyond, float(turns.max()) + beyond, style)


@dataclass(frozen=True)
class ConstructionCurve:
    """A curve through closely spaced points, such as a locus of pivots or a coupler curve. It is cut at the edge of the
    sheet.

    Attributes:
        places: points of the curve (complex, m).
        style: line style.
        name: text beside the curve. Pieces of one curve share a name, which is written once.
    """

    places: tuple[complex, ...]
    style: Style = "thin"
    name: str = ""


@dataclass(frozen=True)
class LetteredPoint:
    """A point with a letter, drawn as a hinge, a support, a slider or a dot.

    Attributes:
        name: letter of the point.
        at: the point (complex, m).
        mark: symbol drawn at the point; `stone` is a sliding block.
        along: direction of a slider's guide, or of the link on which a sliding block moves (complex).
    """

    name: str
    at: complex
    mark: Mark = "dot"
    along: complex = 1 + 0j


@dataclass(frozen=True)
class Angle:
    """An angle dimension: the angle at a vertex between the directions to two points.

    Attributes:
        vertex, first, last: vertex and the two points (complex, m).
        name: text beside the angle.
        right: True to draw a right-angle mark instead of an arc.
    """

    vertex: complex
    first: complex
    last: complex
    name: str = ""
    right: bool = False


@dataclass(frozen=True)
class DimensionLine:
    """A linear dimension: the distance between two points, measured along a direction.

    Attributes:
        start, end: the two points (complex, m).
        name: text on the dimension line.
        along: direction of measurement (complex); 0 for the direction from `start` to `end`.
    """

    start: complex
    end: complex
    name: str
    along: complex = 0j


@dataclass(frozen=True)
class CircleCentre:
    """Centre of a construction circle, joined by lines to points on the circle. It may lie far outside the sheet.

    Attributes:
        at: the centre (complex, m).
        radius: radius of the circle (m).
        legs: points on the circle to which lines are drawn (complex, m).
        name: letter of the centre.
    """

    at: complex
    radius: float
    legs: tuple[complex, ...]
    name: str = "M"


@dataclass(frozen=True)
class GeometricConstruction:
    """A geometric construction, drawn to scale on a separate sheet.

    Attributes:
        title: title of the sheet; letters of points stand in {}.
        segments, arcs, spots, curves, angles, sizes, centres: lines, arcs, lettered points, curves, angle dimensions,
            linear dimensions and circle centres to be drawn.
        notes: texts in a corner of the sheet; letters of points stand in {}.
        name: file name without its extension.
        wishes: sets of points (complex, m) that the sheet should also show, most important first, provided that the
            mechanism stays large enough. Any other point that `places` does not return is cut at the edge of the sheet.
        chain: type of the mechanism drawn; selects the letters of its joints (CHAIN_LETTERS).
        values: name, value (SI) and kind of the quantities listed in the corner.
        around: additional points that the sheet must contain (complex, m).
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
        """Return the points that the sheet must contain (complex, m)."""
        ends = [place for s in self.segments for place in (s.start, s.end)]
        sizes = [place for s in self.sizes for place in (s.start, s.end)]
        return [*ends, *(s.at for s in self.spots), *sizes, *self.around]


def circle_extent(centre: complex, radius: float) -> tuple[complex, ...]:
    """Return the four points of a circle that determine its bounding box (complex, m)."""
    return tuple(centre + radius * direction for direction in (1, 1j, -1, -1j))


@dataclass(frozen=True)
class DiagramLine:
    """A curve of a diagram.

    Attributes:
        text: legend.
        x, y: coordinates of its points (SI, rad), shape (points,).
        dots: True to draw separate points instead of a line.
        faint: True to draw the curve in a pale colour behind the others.
    """

    text: str
    x: Any
    y: Any
    dots: bool = False
    faint: bool = False


@dataclass(frozen=True)
class Diagram:
    """A diagram, for example of the structural error or of the largest pressure angle along an arc.

    Attributes:
        name: file name without its extension.
        title: title of the diagram.
        x, y: title and kind of each axis.
        lines: curves of the diagram.
        equal: True if both axes have the same scale, as for a path.
        lower: curves of a second panel below, over the same x axis.
        lower_y: title and kind of the logarithmic y axis of the second panel.
    """

    name: str
    title: str
    x: tuple[str, str]
    y: tuple[str, str]
    lines: tuple[DiagramLine, ...]
    equal: bool = False
    lower: tuple[DiagramLine, ...] = ()
    lower_y: tuple[str, str] = ("", "number")
