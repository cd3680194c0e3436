"""Wittenbauer's energy-mass diagram with its two tangents: their angles, and the segment that tells the flywheel."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_cli.drawing.paper import (
    DARK_COLOUR,
    INERTIA_COLOUR,
    LOAD_COLOUR,
    NAME_COLOUR,
    PLAIN_TEXT,
    TEXT_ROW,
    THIN_COLOUR,
    TICK_STEPS,
    ChartCurve,
    CommonAxis,
    Drawing,
    DrawingSheet,
    OccupiedArea,
    Panel,
    PlotContent,
    Words,
    axis_extent,
    draw_chart,
    round_axis,
    round_up,
    scale_words,
    with_unit,
)
from tmm_cli.language import _, numeral, spelt, symbol
from tmm_cli.mechanics.analysis import Results
from tmm_cli.mechanics.forces import CourseSymbol, Symbol
from tmm_cli.mechanics.numerics import Real
from tmm_cli.mechanics.plans import LANDSCAPE
from tmm_cli.mechanics.quantities import INERTIA as MOMENT_OF_INERTIA
from tmm_cli.problem import UnitSystem, typeset_unit

if TYPE_CHECKING:
    from tmm_cli.mechanics.dynamics import SteadyRunning, SteadySolution, Tangent


FAR_RATIO = 2.0  # times as wide as the diagram is: farther off, the inertia of zero is not on the sheet
LEAST_WIDTH_SHARE = 0.1  # of the largest inertia: the diagram is taken for so wide at least
AXIS_OVERHANG, TANGENT_OVERHANG = (
    0.08,
    0.3,
)  # of the axis: so far it goes on beyond the diagram, and tangents beyond where they touch
ARC_RADII = (26.0, 16.0)  # mm: radii of the angles
ANGLE_LINE = 6.0  # mm of the line beyond an arc from which an angle is counted
MOST_NUMBERED = 24  # positions at most that have their numbers
TANGENT_COLOURS, TANGENT_ANGLES, SEGMENT_ENDS = (
    (LOAD_COLOUR, INERTIA_COLOUR),
    (Symbol("ψ", "max"), Symbol("ψ", "min")),
    ("a", "b"),
)


@dataclass(frozen=True)
class DrawnTangent:
    """A tangent as it is drawn, mm and rad: where it begins on the axis of energy, where it touches, its angle."""

    start: complex
    touching: complex
    angle: float

    @classmethod
    def of(cls, panel: Panel, tangent: Tangent, factor: float) -> DrawnTangent:
        begins = complex(panel.at(panel.x.low, tangent.offset + tangent.slope * factor * panel.x.low))
        touching = complex(panel.at(tangent.inertia / factor, tangent.energy))
        return cls(begins, touching, math.atan(tangent.slope * factor * panel.x.mu / panel.y.mu))


def energy_mass_sheet(results: Results, running: SteadyRunning, way: Real) -> Drawing:
    """Work of all moments from position 0 on against the reduced inertia of the links, over the cycle."""
    assert results.motion is not None
    steady, units = running.steady, results.problem.units
    factor, unit = units.factor(MOMENT_OF_INERTIA), typeset_unit(units.spelt(MOMENT_OF_INERTIA))
    title = _("Energy-mass diagram with tangents of the largest and the least speed; dots: computed positions")
    sheet = DrawingSheet(results.problem.title, title, paper=LANDSCAPE)
    told = sheet.ground.low + 0.5 * TEXT_ROW * 1j
    sheet.ground = OccupiedArea(sheet.ground.low + 2.4 * TEXT_ROW * 1j, sheet.ground.high)

    def diagram(x: Real, colour: str = DARK_COLOUR, *, dots: bool = False) -> ChartCurve:
        return ChartCurve(steady.machine.inertia(x) / factor, steady.work(x), colour=colour, dots=dots)

    whole, here = diagram(way), diagram(running.way(results.motion.q), dots=True)
    start, longest = axis_extent(sheet)
    axis = round_axis(*_axis_ends(whole.xs, _massless_width(steady) / factor), start, longest)
    words = with_unit(_("reduced inertia of the links J"), MOMENT_OF_INERTIA, units)
    below = (f"{words};  ", *scale_words("J", axis.mu, f"({unit})/mm"))
    names = _("tangent of the largest speed"), _("tangent of the least speed")
    lines = [
        _tangent_curve(tangent, factor, (axis.low, axis.high), name, colour)
        for tangent, name, colour in zip(steady.tangents, names, TANGENT_COLOURS, strict=True)
    ]
    work = PlotContent(
        _("work of all moments A, J"), [whole, *lines, here], scale=lambda mu: scale_words("A", mu, "J/mm")
    )
    panel = draw_chart(sheet, [work], CommonAxis(axis, below))[0]
    for curve in (whole, *lines):
        sheet.ground.path(panel.at(curve.xs, curve.ys).tolist())
    every = max(1, round(round_up(len(here.xs) / MOST_NUMBERED, TICK_STEPS)))
    for place, number in list(zip(panel.at(here.xs, here.ys).tolist(), results.numbers, strict=True))[::every]:
        sheet.label(str(number), place, 8, DARK_COLOUR)
    drawn = [DrawnTangent.of(panel, tangent, factor) for tangent in steady.tangents]
    for one, name, end, radius, colour in zip(
        drawn, TANGENT_ANGLES, SEGMENT_ENDS, ARC_RADII, TANGENT_COLOURS, strict=True
    ):
        _draw_tangent_angle(sheet, one, name, radius, colour)
        sheet.circle(one.start, 0.6, NAME_COLOUR, NAME_COLOUR, 0.4, 5)
        sheet.label(end, one.start, 9, NAME_COLOUR, "italic")
    with sheet.on_layer("dimensions"):
        sheet.line([one.start for one in drawn], NAME_COLOUR, 2.0, z=4.2)
    sheet.text(told + TEXT_ROW * 1j, _measured_text(drawn), PLAIN_TEXT)
    if steady.law.flywheel:
        sheet.text(told, _flywheel_text(steady.law.flywheel, axis.low, units), PLAIN_TEXT)
    return sheet.finish()


def _axis_ends(inertia: Any, massless: float) -> tuple[float, float]:
    """Of the axis: it begins at zero unless that is far off. massless: its end where all links are without inertia."""
    low, high = float(np.min(inertia)), float(np.max(inertia))
    if high <= 0.0:
        return 0.0, massless
    wide = max(high - low, LEAST_WIDTH_SHARE * high)
    step = round_up(wide / 4)
    begins = step * math.floor((low - wide) / step) if low > FAR_RATIO * wide else 0.0
    return begins, high + AXIS_OVERHANG * (high - begins)


def _massless_width(steady: SteadySolution) -> float:
    """The inertia (kg*m^2) over which a tangent rises as much as the work changes in the cycle; 1 where it does not."""
    fastest, slowest = steady.tangents
    rise = abs(fastest.offset - slowest.offset)
    return rise / fastest.slope if rise > 0.0 else 1.0


def _tangent_curve(tangent: Tangent, factor: float, ends: tuple[float, float], name: str, colour: str) -> ChartCurve:
    """From the axis of energy on."""
    low, high = ends
    xs = np.array([low, min(tangent.inertia / factor + TANGENT_OVERHANG * (high - low), high)])
    return ChartCurve(xs, tangent.offset + tangent.slope * factor * xs, name, colour, "--", 1.0)


def _draw_tangent_angle(sheet: DrawingSheet, tangent: DrawnTangent, name: Symbol, radius: float, colour: str) -> None:
    """Of a tangent with the axis of inertia, where it begins; and where it touches."""
    sheet.line([tangent.start, tangent.start + radius + ANGLE_LINE], THIN_COLOUR, 0.6, z=1.4, faint=True)
    arc = tangent.start + radius * np.exp(1j * np.linspace(0, tangent.angle, 30))
    sheet.line(arc.tolist(), colour, 0.7, z=2.6)
    sheet.label(name, complex(arc[15]), 9, NAME_COLOUR)
    sheet.circle(tangent.touching, 0.9, "white", colour, 0.9, 4.5)


def _measured_text(drawn: list[DrawnTangent]) -> Words:
    """What one would measure on the sheet."""
    told: list[str | Symbol] = []
    for one, name in zip(drawn, TANGENT_ANGLES, strict=True):
        told += [name, f" = {numeral(math.degrees(one.angle), '.4g')}°;   "]
    a, b = (one.start for one in drawn)
    return (*told, f"ab = {numeral(abs(a - b), '.4g')} {spelt('mm')}")


def _flywheel_text(inertia: float, begins: float, units: UnitSystem) -> Words:
    """How its inertia follows from that. begins: the inertia at which the axis does, in the unit of the file."""
    tan, largest, least = symbol("tan"), *TANGENT_ANGLES
    found = units.from_si(inertia, MOMENT_OF_INERTIA)
    return (
        CourseSymbol("J_f"),
        " = ab·",
        Symbol("μ", "J"),
        f"/({tan} ",
        largest,
        f" − {tan} ",
        least,
        ")",
        f" − {numeral(begins, '.4g')}" if begins else "",
        f" = {numeral(found, '.4g')} {typeset_unit(units.spelt(MOMENT_OF_INERTIA))}",
    )
