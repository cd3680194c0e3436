"""Arrows for forces and couples on links, which are not to scale, and moment arms, which are."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np

from tmm_cli.drawing.paper import SAMPLE_STEP, VECTOR_COLOURS, DrawingSheet, Style, Words, count_beside, draw_dimension
from tmm_cli.mechanics.forces import DRIVE, ForceOrCouple, MomentEquation
from tmm_cli.mechanics.numerics import Vector, cross, dot

ARM_COLOUR = "#00757d"
LOAD_LENGTH = 20.0  # mm: loads are not to scale and have equal lengths (guidelines, 2.3.2)
SAME_DIRECTION = 0.05  # rad, about: forces in one direction
EXTRA_LENGTH = 9.0  # mm by which each further force in one direction is longer
SHAFT_REACH = 1.3  # mm on either side of a shaft that count as covered
RIGHT_ANGLE_LEG = 1.8  # mm
LEAST_MARKED_ARM = 5.0  # mm: a shorter arm has no right-angle mark
ON_BAR_WITHIN = 0.6  # mm between an arm and the points of a bar on which it lies
COVERED_SHARE = 0.6  # of an arm that lies on bars: beyond it the arm is drawn beside them
LEAST_DRAWN_ARM = 1.5  # mm: a shorter arm is only in the table
COUPLE_RADII = (5.5, 8.1, 10.7, 13.3)  # mm: successive radii of couples at one point


@dataclass
class ForceArrows:
    """Arrows for forces and couples on a sheet.

    A force has its tail or its head at the point of action, whichever covers less of the drawing. A couple is drawn as
    an open circle with an arrowhead.

    Attributes:
        sheet: sheet to draw on.
        whole: True for a drawing of the whole mechanism. All forces then have their tails at the points of action, and
            the balancing moment of a crank is drawn around its support.
        taken: forces drawn so far: point of action (mm), direction, and True if the tail is at the point.
        coupled: points of the couples drawn so far, mm.
        directions: points of action (mm) and directions of all forces.
    """

    sheet: DrawingSheet
    whole: bool = False
    taken: list[tuple[complex, complex, bool]] = field(default_factory=list)
    coupled: list[complex] = field(default_factory=list)
    directions: list[tuple[complex, complex]] = field(default_factory=list)

    def draw(self, acting: Iterable[ForceOrCouple]) -> None:
        acting = list(acting)
        self.directions += [
            (self.sheet.on(load.at), load.force / abs(load.force)) for load in acting if not load.couple
        ]
        for load in acting:
            at, colour = self.sheet.on(load.at), VECTOR_COLOURS[load.kind]
            if load.couple:
                number = sum(abs(at - other) < 1 for other in self.coupled) + (self.whole and load.pair == DRIVE)
                _draw_couple(
                    self.sheet,
                    at,
                    np.sign(load.moment),
                    colour,
                    load.symbol,
                    COUPLE_RADII[min(number, len(COUPLE_RADII) - 1)],
                )
                self.coupled.append(at)
            else:
                self._force(
                    at, load.force / abs(load.force), load.symbol, colour, "--" if load.kind == "inner" else "-"
                )

    def _force(self, at: complex, along: complex, name: Words, colour: str, style: Style) -> None:
        alike = [
            out
            for place, direction, out in self.taken
            if abs(at - place) < 1 and abs(along - direction) < SAME_DIRECTION
        ]
        against = any(
            abs(at - place) < 1 and abs(along + direction) < SAME_DIRECTION for place, direction in self.directions
        )
        # with its head there, the arrow would cover an opposite one that begins there, or another that ends there
        free = not against and all(alike)
        out = self.whole or not free or self._covered(at, -along) + 3 >= self._covered(at, along)
        self.taken.append((at, along, out))
        start = at if out else at - LOAD_LENGTH * along
        end = start + (LOAD_LENGTH + EXTRA_LENGTH * sum(alike) if out else LOAD_LENGTH) * along
        if style == "-":
            self.sheet.arrow(start, end, colour, 1.5, z=5 - 0.01 * sum(alike))  # longer arrows lie under shorter ones
        else:
            self.sheet.line([start, end], colour, 1.0, style, 4)
            self.sheet.arrow(end - 4 * along, end, colour, 1.0)
        self.sheet.label(name, end if out else start, 9.5, colour)

    def _covered(self, at: complex, direction: complex) -> int:
        """Count the points of the drawing that an arrow from a point in this direction would cover."""
        crowd = self.sheet.canvas.line_points - at
        run, off = dot(direction, crowd), np.abs(cross(direction, crowd))
        return int(np.count_nonzero((run > 2.5) & (run < LOAD_LENGTH + 3) & (off < SHAFT_REACH)))


def _draw_couple(sheet: DrawingSheet, at: complex, sense: float, colour: str, name: Words, radius: float) -> None:
    """Draw a couple as an open circle with an arrowhead, counterclockwise if `sense` is positive."""
    angles = np.linspace(0.35 * np.pi, 1.75 * np.pi, 40)[:: int(sense)]
    arc = [at + radius * complex(np.cos(a), np.sin(a)) for a in angles]
    sheet.line(arc[:-4], colour, 1.2, z=5)
    sheet.arrow(arc[-9], arc[-1], colour, 1.2)
    sheet.label(name, arc[20], 9, colour)


def arrow_extent(acting: Iterable[ForceOrCouple]) -> list[tuple[complex, complex]]:
    """Return points that must be on the sheet so that the arrows of forces fit on it.

    Each is a point of action (m) with an offset (mm) in the direction of the arrow or against it.
    """
    offsets = []
    for load in acting:
        along = 0j if load.couple else (LOAD_LENGTH + 2) * load.force / abs(load.force)
        offsets += [(load.at, along), (load.at, -along)]
    return offsets


def draw_arms(sheet: DrawingSheet, equations: Sequence[MomentEquation], links: Vector) -> None:
    """Draw the moment arms of equations, each with its letter and a right-angle mark.

    An arm is a thin line from the moment centre to the foot of the perpendicular on the line of action. An arm along a
    link is drawn beside it as a dimension line.

    Args:
        sheet: sheet to draw on.
        equations: moment equations.
        links: closely spaced points along the links, mm.
    """
    drawn: set[int] = set()
    beside_links: list[tuple[complex, complex, str]] = []
    for equation in equations:
        centre = sheet.on(equation.centre)
        feet: list[complex] = []
        for term in sorted((t for t in equation.terms if t.number), key=lambda t: t.arm):
            if term.number in drawn:
                continue
            drawn.add(term.number)
            at, foot = sheet.on(term.acting.at), sheet.on(term.foot)
            sheet.line([at, foot], ARM_COLOUR, 0.45, "--", 1.6, faint=True)
            length = abs(foot - centre)
            if length < LEAST_DRAWN_ARM:
                continue
            if (
                length > LEAST_MARKED_ARM
                and count_beside(links, centre, foot, ON_BAR_WITHIN) > COVERED_SHARE * length / SAMPLE_STEP
            ):
                beside_links.append((centre, foot, term.letter.name))
                continue
            sheet.line([centre, foot], ARM_COLOUR, 0.7, z=4.6)
            # collinear arms overlap: the letter stands at the part beyond the shorter ones
            direction = (foot - centre) / (length or 1.0)
            inner = [f for f in feet if abs(cross(direction, f - centre)) < 0.5 and dot(direction, f - centre) > 0]
            start = max(inner, key=lambda f: abs(f - centre), default=centre)
            sheet.label(term.letter, (start + foot) / 2, 8.5, ARM_COLOUR)
            feet.append(foot)
            if length > LEAST_MARKED_ARM:
                _draw_right_angle(sheet, foot, direction, at)
    for centre, foot, name in beside_links:  # last, so that they avoid everything else
        draw_dimension(sheet, centre, foot, name)


def _draw_right_angle(sheet: DrawingSheet, foot: complex, direction: complex, at: complex) -> None:
    """Draw the right-angle mark at the foot of a moment arm, on the side of the force."""
    back, side = -RIGHT_ANGLE_LEG * direction, RIGHT_ANGLE_LEG * 1j * direction
    if dot(side, at - foot) < 0:
        side = -side
    sheet.line([foot + back, foot + back + side, foot + side], ARM_COLOUR, 0.45, z=4.6)
