"""Symbols of hydraulic cylinders and springs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from tmm_cli.drawing.paper import DARK_COLOUR, DrawingSheet, draw_hatching
from tmm_cli.drawing.symbols.scene import ON_LINE, MechanismScene
from tmm_cli.mechanics.forces import Symbol
from tmm_cli.mechanics.linkage import FRAME, Driver, Linkage, Slide, Spring
from tmm_cli.mechanics.numerics import cross, dot, unit

BARREL_HALF_WIDTH = 2.3  # mm
LEAST_BARREL = 8.0  # mm: least length of a cylinder
COIL_PITCH = 3.0  # mm between coils of a spring
COIL_HALF_WIDTH = 2.2  # mm
SPRING_END = 4.0  # mm: straight end of a spring
TORSION_SPIRAL = (1.9, 5.8, 2.25)  # mm: inner and outer radius of a torsion spring, its turns
SPRING_COLOUR = "#5f3b8a"
SPRING_BODY = "{}|spring"  # name of the body of a spring, which is stretched


def cylinder_drivers(linkage: Linkage) -> dict[str, Driver]:
    """Return the drivers that are drawn as cylinders, by prismatic pair: those that slide between two moving links."""
    return {d.joint: d for d in linkage.drivers if d.kind == "slide" and d.base != FRAME}


@dataclass(frozen=True)
class Cylinder:
    """A cylinder that drives one moving link relative to another.

    Attributes:
        slide: Its prismatic pair.
        back, front: Ends of the barrel, mm.
        piston: Position of the piston, mm.
        end: Outer end of the piston rod, mm.
    """

    slide: Slide
    back: complex
    front: complex
    piston: complex
    end: complex

    @staticmethod
    def of(sheet: DrawingSheet, scene: MechanismScene, slide: Slide) -> Cylinder:
        """Return the cylinder for a prismatic pair.

        The barrel begins at the last point of its link behind the rod end, or else one stroke before it. If the barrel
        is too short for the stroke, the piston is drawn with a shorter one.
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
        """Return the ends (mm) of the part that belongs to this link: the barrel or the rod."""
        return (self.back, self.front) if link == self.slide.carrier else (self.piston, self.end)

    def draw(self, sheet: DrawingSheet, hue: Mapping[str, str]) -> None:
        """Draw the barrel in section, with piston and rod."""
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


def draw_springs(sheet: DrawingSheet, scene: MechanismScene) -> None:
    """Draw all springs with their names."""
    for spring in scene.linkage.springs:
        if spring.turns:
            with sheet.part(spring.j):
                draw_torsion_spring(sheet, scene, spring)
            continue
        start, end = sheet.on(scene.place(spring.i, spring.at_i)), sheet.on(scene.place(spring.j, spring.at_j))
        if not np.isfinite(start + end) or abs(end - start) < 0.5:
            continue
        with sheet.part(SPRING_BODY.format(spring.name)):
            (draw_coil_spring if spring.rate > 0 else draw_gas_spring)(sheet, start, end)
        for link, at in ((spring.i, start), (spring.j, end)):
            with sheet.part(link):
                sheet.circle(at, 0.75, "white", SPRING_COLOUR, 1.0, 6.1)
                if link == FRAME:
                    out = (at - start - end + at) / abs(end - start)
                    low, high = at + out * (1 - 2.6j), at + out * (1 + 2.6j)
                    sheet.line([low, high], DARK_COLOUR, 1.1, z=2.7)
                    draw_hatching(sheet, low, high, out)
        middle = (start + end) / 2
        sheet.label(spring.name, middle + 1j * (end - start) / abs(end - start) * COIL_HALF_WIDTH, 9, SPRING_COLOUR)


def draw_coil_spring(sheet: DrawingSheet, start: complex, end: complex) -> None:
    """Draw a coil spring as a zigzag line between two points, mm."""
    length = abs(end - start)
    along = (end - start) / length
    stub = min(SPRING_END, 0.15 * length)
    number = int(np.clip((length - 2 * stub) / COIL_PITCH, 4, 14))
    step = (length - 2 * stub) / number
    side = 1j * along * min(COIL_HALF_WIDTH, length / 5)
    coils = [start + along * (stub + (k + 0.5) * step) + (-1) ** k * side for k in range(number)]
    sheet.line([start, start + stub * along, *coils, end - stub * along, end], SPRING_COLOUR, 1.1, z=3.8)


def draw_gas_spring(sheet: DrawingSheet, start: complex, end: complex) -> None:
    """Draw a gas spring or a constant force as a cylinder between two points, mm."""
    along = (end - start) / abs(end - start)
    neck, side = start + 0.6 * (end - start), 1j * along * 1.6
    sheet.line([start, end], SPRING_COLOUR, 1.1, z=3.7)
    sheet.area([start + side, neck + side, neck - side, start - side], "white", SPRING_COLOUR, 1.1, 3.8)


def draw_torsion_spring(sheet: DrawingSheet, scene: MechanismScene, spring: Spring) -> None:
    """Draw a torsion spring as a spiral about the hinge of its two links, or else about its end on the second link."""
    point = scene.linkage.shared(spring.i, spring.j)
    centre = sheet.on(scene.place(spring.j, spring.at_j) if point is None else scene.point(point))
    if not np.isfinite(centre):
        return
    inner, outer, turns = TORSION_SPIRAL
    share = np.linspace(0, 1, 120)
    arc = centre + (inner + (outer - inner) * share) * unit(scene.angle(spring.j) + 2 * np.pi * turns * share)
    sheet.line([complex(p) for p in arc], SPRING_COLOUR, 1.1, z=5.5)
    last = complex(arc[-1])
    sheet.line([last, last + 2.4 * (last - centre) / abs(last - centre)], SPRING_COLOUR, 1.1, z=5.5)
    sheet.label(spring.name, last, 9, SPRING_COLOUR)
