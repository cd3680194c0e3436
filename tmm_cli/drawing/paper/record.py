"""Record of a drawing: lines, areas, circles and texts in mm of paper, from which each file format is written.

The origin is the lower left corner of the paper. No format may interpret a text as markup or mathematics.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Literal

POINT = 25.4 / 72  # mm
ARROWHEAD_LENGTH, ARROWHEAD_HALF_WIDTH = 3.4, 1.0  # mm

Layer = Literal["frame", "links", "supports", "construction", "vectors", "dimensions", "text"]
Style = Literal["-", "--", ":", "-."]
Align = Literal["left", "center", "right"]
DASHES: dict[Style, tuple[float, ...]] = {"-": (), "--": (3.7, 1.6), ":": (1.0, 1.65), "-.": (6.4, 1.6, 1.0, 1.6)}


@dataclass(frozen=True, slots=True)
class LineMark:
    """A polyline.

    Attributes:
        places: its points, mm.
        colour: colour, e.g. "#1a1a1a".
        width: width of the line, mm.
        style: solid, dashed, dotted or dash-dotted.
        layer: layer in a CAD program.
        z: marks with larger z are drawn over those with smaller z.
    """

    places: tuple[complex, ...]
    colour: str
    width: float
    style: Style = "-"
    layer: Layer = "construction"
    z: float = 3.0

    def moved(self, by: complex) -> LineMark:
        return replace(self, places=tuple(place + by for place in self.places))

    @property
    def dashes(self) -> tuple[float, ...]:
        """Lengths drawn and skipped alternately, mm; empty for a solid line."""
        return tuple(length * self.width for length in DASHES[self.style])


@dataclass(frozen=True, slots=True)
class AreaMark:
    """A filled polygon.

    Attributes:
        corners: its corners, mm.
        face: colour of the area.
        edge: colour of the outline; None: no outline.
        width: width of the outline, mm.
        layer, z: as in `LineMark`.
    """

    corners: tuple[complex, ...]
    face: str
    edge: str | None
    width: float
    layer: Layer = "construction"
    z: float = 2.0

    def moved(self, by: complex) -> AreaMark:
        return replace(self, corners=tuple(corner + by for corner in self.corners))


@dataclass(frozen=True, slots=True)
class CircleMark:
    """A filled circle with an outline; its attributes are those of `AreaMark`."""

    centre: complex
    radius: float
    face: str
    edge: str
    width: float
    layer: Layer = "construction"
    z: float = 6.0

    def moved(self, by: complex) -> CircleMark:
        return replace(self, centre=self.centre + by)


@dataclass(frozen=True, slots=True)
class TextMark:
    """One line of text.

    Attributes:
        at: its left end, middle or right end (according to `align`) at half the height of the letters, mm.
        text: the text.
        size: font size, mm.
        colour: colour of the letters.
        align: alignment.
        bold, italic: weight and slant of the font.
        turn: rotation about `at`, counterclockwise, deg.
        layer, z: as in `LineMark`.
    """

    at: complex
    text: str
    size: float
    colour: str
    align: Align = "left"
    bold: bool = False
    italic: bool = False
    turn: float = 0.0
    layer: Layer = "text"
    z: float = 9.0

    def moved(self, by: complex) -> TextMark:
        return replace(self, at=self.at + by)


Mark = LineMark | AreaMark | CircleMark | TextMark


@dataclass(frozen=True)
class Drawing:
    """A finished drawing: paper size (mm) and marks in drawing order."""

    paper: tuple[float, float]
    marks: tuple[Mark, ...]

    @classmethod
    def of(cls, paper: tuple[float, float], marks: Iterable[Mark]) -> Drawing:
        """Make a drawing of marks, sorted by their z."""
        return cls(paper, tuple(sorted(marks, key=lambda mark: mark.z)))

    def moved(self, by: complex) -> Drawing:
        """Return the drawing with all marks shifted by a vector (mm) on its paper."""
        return replace(self, marks=tuple(mark.moved(by) for mark in self.marks))

    def texts(self) -> list[str]:
        """Return all texts of the drawing."""
        return [mark.text for mark in self.marks if isinstance(mark, TextMark)]
