"""Symbols of hydraulic cylinders, and of load elements with their supports."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from tmm_cli.drawing.paper import DARK_COLOUR, DrawingSheet, draw_hatching
from tmm_cli.drawing.symbols.scene import ON_LINE, MechanismScene
from tmm_cli.mechanics.elements.element import LoadElement
from tmm_cli.mechanics.forces import Symbol
from tmm_cli.mechanics.linkage import FRAME, Driver, Linkage, Slide
from tmm_cli.mechanics.numerics import cross, dot
from tmm_cli.reports import ELEMENT_COLOUR, element_view

BARREL_HALF_WIDTH = 2.3  # mm
LEAST_BARREL = 8.0  # mm: least length of a cylinder
NAME_DISTANCE = 2.2  # mm of the name of a load element from its line
ELEMENT_BODY = "{}|spring"  # name of the body of a load element, which is stretched


def cylinder_drivers(linkage: Linkage) -> dict[str, Driver]:
    """Return the drivers that are drawn as cylinders, by prismatic pair.

    These are the drivers that slide between two moving links.
    """
    return {d.joint: d for d in linkage.drivers if d.kind == "slide" and d.base != FRAME}


@dataclass(frozen=True)
class Cylinder:
    """A cylinder that drives one moving link relative to another.

    Attributes:
        slide: its prismatic pair.
        back, front: ends of the barrel, mm.
        piston: position of the piston, mm.
        end: outer end of the piston rod, mm.
    """

    slide: Slide
    back: complex
    front: complex
    piston: complex
    end: complex

    @staticmethod
    def of(sheet: DrawingSheet, scene: MechanismScene, slide: Slide) -> Cylinder:
        """Return the cylinder for a prismatic pair.

        The barrel begins at the last point of its link behind the rod end. If there is no such point, it begins one
        stroke before the rod end. If it is too short for the whole stroke, the piston is drawn with a shorter stroke.
        """
        low, high = (run / sheet.mu for run in scene.travel(slide))
        foot, end = sheet.on(scene.place(slide.carrier, slide.through)), sheet.on(scene.place(slide.runner, slide.at))
        along, stroke = scene.along(slide), high - low
        run = float(dot(along, end - foot))
        arms = [sheet.on(point) - foot for point in scene.ends(slide.carrier)]
        runs = [float(dot(along, arm)) for arm in arms if abs(cross(along, arm)) < ON_LINE]
        behind = [r for r in runs if r < low - LEAST_BARREL / 2]
        start = min(behind) if behind else low - max(1.4 * stroke, 1.5 * LEAST_BARREL)
        length = max(min(max(1.25 * stroke, 0.6 * (low - start)), 0.88 * (low - start)), min(LEAST_BARREL, low - start))
        share = (run - low) / max(stroke, 0.74 * length, 1e-9)
        piston = start + length * (0.13 + 0.74 * share)
        return Cylinder(slide, foot + along * start, foot + along * (start + length), foot + along * piston, end)

    def part(self, link: str) -> tuple[complex, complex]:
        """Return the ends (mm) of the barrel or of the rod, whichever belongs to this link."""
        return (self.back, self.front) if link == self.slide.carrier else (self.piston, self.end)

    def draw(self, sheet: DrawingSheet, hue: Mapping[str, str]) -> None:
        """Draw the cylinder: the barrel in section, the piston and the rod."""
        side = 1j * (self.front - self.back) / abs(self.front - self.back) * BARREL_HALF_WIDTH
        corners = [self.back + side, self.front + side, self.front - side, self.back - side]
        with sheet.part(self.slide.carrier):
            sheet.area(corners, "white", hue[self.slide.carrier], 1.3, 4.6)
        rod = hue[self.slide.runner]
        with sheet.part(self.slide.runner):
            sheet.line([self.piston + 0.8 * side, self.piston - 0.8 * side], rod, 2.4, z=4.8)
            sheet.line([self.piston, self.end], rod, 1.8, z=4.7)


def driver_symbol(driver: Driver, letter: str) -> Symbol:
    """Return the symbol of the speed of a driver: ω1, or ω21 for link 2 relative to moving link 1."""
    return Symbol(letter, driver.link + ("" if driver.base == FRAME else driver.base))


def draw_elements(sheet: DrawingSheet, scene: MechanismScene) -> None:
    """Draw the symbols of all load elements, with their names."""
    for element in scene.linkage.elements:
        if element.turns:
            with sheet.part(element.j):
                _draw_torsional_element(sheet, scene, element)
        else:
            _draw_linear_element(sheet, element, *(sheet.on(scene.place(end.link, end.at)) for end in element.ends))


def _draw_linear_element(sheet: DrawingSheet, element: LoadElement, start: complex, end: complex) -> None:
    """Draw a linear load element (e.g. a spring) between its ends (mm), with its supports on the frame."""
    if not np.isfinite(start + end) or abs(end - start) < 0.5:
        return
    with sheet.part(ELEMENT_BODY.format(element.name)):
        element_view(element.block).draw_linear(sheet, element, start, end)
    for link, at in ((element.i, start), (element.j, end)):
        with sheet.part(link):
            sheet.circle(at, 0.75, "white", ELEMENT_COLOUR, 1.0, 6.1)
            if link == FRAME:
                out = (at - start - end + at) / abs(end - start)
                low, high = at + out * (1 - 2.6j), at + out * (1 + 2.6j)
                sheet.line([low, high], DARK_COLOUR, 1.1, z=2.7)
                draw_hatching(sheet, low, high, out)
    middle = (start + end) / 2
    sheet.label(element.name, middle + 1j * (end - start) / abs(end - start) * NAME_DISTANCE, 9, ELEMENT_COLOUR)


def _draw_torsional_element(sheet: DrawingSheet, scene: MechanismScene, element: LoadElement) -> None:
    """Draw a torsional load element about the hinge of its two links.

    If the links have no common hinge, it is drawn about its point on the second link.
    """
    point = scene.linkage.shared(element.i, element.j)
    centre = sheet.on(scene.place(element.j, element.at_j) if point is None else scene.point(point))
    if np.isfinite(centre):
        last = element_view(element.block).draw_torsional(sheet, element, centre, scene.angle(element.j))
        sheet.label(element.name, last, 9, ELEMENT_COLOUR)
