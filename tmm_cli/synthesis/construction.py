"""A construction with compasses and ruler as a record, to be drawn elsewhere; places in metres, angles in radians."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

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
class Spot:
    """A lettered point; along: direction of a slider's guide."""

    name: str
    at: complex
    mark: Mark = "dot"
    along: complex = 1 + 0j


@dataclass(frozen=True)
class Construction:
    """A sheet. title: key of its words; notes: keys of words for the corner."""

    title: str
    segments: tuple[Segment, ...] = ()
    arcs: tuple[Arc, ...] = ()
    spots: tuple[Spot, ...] = ()
    notes: tuple[str, ...] = ()

    def places(self) -> list[complex]:
        """What must be on the sheet: bold arcs and points; thin circles are cut at the edge."""
        ends = [place for s in self.segments for place in (s.start, s.end)]
        return ends + [s.at for s in self.spots]
