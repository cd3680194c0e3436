"""Drawings of a synthesis as records, to be drawn elsewhere: constructions with compasses and ruler, curves.

Places in metres, angles in radians.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final, Literal

import numpy as np

Style = Literal["link", "link2", "thin", "dashed", "axis", "bold"]
Mark = Literal["hinge", "support", "slider", "stone", "dot", "none"]
Chain = Literal["", "four-bar", "crank-slider", "slotted-lever", "shaper"]
CHAIN_LETTERS: Final[
    Mapping[Chain, str]
] = {  # of the joints along the chain from the driver's pivot, as constructions say
    "four-bar": "ABCD",
    "crank-slider": "OAB",
    "slotted-lever": "OACB",
    "shaper": "OACDE",
}


@dataclass(frozen=True)
class Segment:
    """A straight line; name: written beside it."""

    start: complex
    end: complex
    style: Style = "thin"
    name: str = ""


@dataclass(frozen=True)
class Arc:
    """An arc of a circle, counterclockwise from one angle to another."""

    centre: complex
    radius: float
    start: float
    end: float
    style: Style = "thin"


def full_circle(centre: complex, radius: float) -> Arc:
    """A whole circle of construction."""
    return Arc(centre, radius, 0.0, 2 * np.pi, "dashed")


def swept_arc(centre: complex, places: Any, style: Style = "thin", beyond: float = 0.0) -> Arc:
    """The arc about a centre on which places (an array) follow one another, and so far (rad) beyond both ends."""
    turns = np.unwrap(np.angle(places - centre))
    return Arc(centre, float(abs(places[0] - centre)), float(turns.min()) - beyond, float(turns.max()) + beyond, style)


@dataclass(frozen=True)
class ConstructionCurve:
    """A curve through places that lie close together (locus of pivots, coupler curve); name: written beside it.

    It is cut at the edge of the sheet. Pieces of one curve have one name, which is written once.
    """

    places: tuple[complex, ...]
    style: Style = "thin"
    name: str = ""


@dataclass(frozen=True)
class LetteredPoint:
    """A lettered point; along: direction of a slider's guide, or of the link that a stone is on."""

    name: str
    at: complex
    mark: Mark = "dot"
    along: complex = 1 + 0j


@dataclass(frozen=True)
class Angle:
    """The angle at a vertex between the ways to two places; right: drawn as a right angle is."""

    vertex: complex
    first: complex
    last: complex
    name: str = ""
    right: bool = False


@dataclass(frozen=True)
class DimensionLine:
    """A dimension line: the distance of two places along a direction (of the line between them if it is 0)."""

    start: complex
    end: complex
    name: str
    along: complex = 0j


@dataclass(frozen=True)
class CircleCentre:
    """Centre of a circle of construction, with lines to it from places on the circle; it may be far off the sheet."""

    at: complex
    radius: float
    legs: tuple[complex, ...]
    name: str = "M"


@dataclass(frozen=True)
class GeometricConstruction:
    """A sheet to scale. title, and notes for the corner: texts with letters in {}; name: of its file.

    wishes: what else is on the sheet if the mechanism stays large enough on it, first wish first. Places that are not
    in `places` or granted are cut at the edge. chain: which mechanism it is, so that joints can be called as in a file.
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
    values: tuple[tuple[str, float, str], ...] = ()  # name, value in SI, kind: for the corner
    around: tuple[complex, ...] = ()  # what the sheet must hold besides

    def places(self) -> list[complex]:
        """What must be on the sheet."""
        ends = [place for s in self.segments for place in (s.start, s.end)]
        sizes = [place for s in self.sizes for place in (s.start, s.end)]
        return [*ends, *(s.at for s in self.spots), *sizes, *self.around]


def circle_extent(centre: complex, radius: float) -> tuple[complex, ...]:
    """Places that hold a whole circle."""
    return tuple(centre + radius * way for way in (1, 1j, -1, -1j))


@dataclass(frozen=True)
class DiagramLine:
    """A curve of a diagram: values over its x (SI, rad); text: what it is called; dots: drawn as single points.

    faint: behind the others.
    """

    text: str
    x: Any
    y: Any
    dots: bool = False
    faint: bool = False


@dataclass(frozen=True)
class Diagram:
    """A diagram (largest pressure angle along an arc, structural error). x, y: text and kind of the axes.

    equal: both to one scale, as a path has to be.
    lower: curves of a panel below it over the same x, with an axis (text, kind) that is logarithmic.
    """

    name: str
    title: str
    x: tuple[str, str]
    y: tuple[str, str]
    lines: tuple[DiagramLine, ...]
    equal: bool = False
    lower: tuple[DiagramLine, ...] = ()
    lower_y: tuple[str, str] = ("", "number")
