"""Drawings of a synthesis as records, to be drawn elsewhere: constructions with compasses and ruler, curves.

Places in metres, angles in radians.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

Style = Literal["link", "link2", "thin", "dashed", "axis", "bold"]
Mark = Literal["hinge", "support", "slider", "dot", "none"]


@dataclass(frozen=True)
class Segment:
    """A straight line; name: written at its middle."""

    start: complex
    end: complex
    style: Style = "thin"
    name: str = ""


@dataclass(frozen=True)
class Arc:
    """An arc of a circle, counterclockwise from one angle to another; name: written at its middle."""

    centre: complex
    radius: float
    start: float
    end: float
    style: Style = "thin"
    name: str = ""


@dataclass(frozen=True)
class Curve:
    """A curve through places that lie close together (locus of pivots, coupler curve); name: written at its middle."""

    places: tuple[complex, ...]
    style: Style = "thin"
    name: str = ""


@dataclass(frozen=True)
class Spot:
    """A lettered point; along: direction of a slider's guide."""

    name: str
    at: complex
    mark: Mark = "dot"
    along: complex = 1 + 0j


@dataclass(frozen=True)
class Construction:
    """A sheet to scale. title: key of its words; notes: keys of words for the corner; name: of its file."""

    title: str
    segments: tuple[Segment, ...] = ()
    arcs: tuple[Arc, ...] = ()
    spots: tuple[Spot, ...] = ()
    notes: tuple[str, ...] = ()
    curves: tuple[Curve, ...] = ()
    name: str = "construction"

    def places(self) -> list[complex]:
        """What must be on the sheet: bold arcs and points; thin circles are cut at the edge."""
        ends = [place for s in self.segments for place in (s.start, s.end)]
        return ends + [s.at for s in self.spots] + [place for c in self.curves for place in c.places]


@dataclass(frozen=True)
class Line:
    """A curve of a diagram: values over its x (SI, rad); words: key of its name; dots: drawn as single points."""

    words: str
    x: Any
    y: Any
    dots: bool = False


@dataclass(frozen=True)
class Diagram:
    """A diagram (largest pressure angle along an arc, structural error). x, y: words and kind of the axes.

    equal: both to one scale, as a path has to be.
    """

    name: str
    title: str
    x: tuple[str, str]
    y: tuple[str, str]
    lines: tuple[Line, ...]
    equal: bool = False
