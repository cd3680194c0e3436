"""Diagrams of dynamics: law of motion over the cycle, Wittenbauer's energy-mass diagram, a single run.

The law of motion is drawn against the travel of the driver. Travel and moments are counted positive in its sense of
motion, so that driving moments are positive whether it rotates clockwise or counterclockwise. The energy-mass diagram
contains its two tangents with their angles, and the segment between them that determines the flywheel.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
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
from tmm_cli.drawing.sheets.diagrams import BORDER_OFFSET, QuantityPlot, SampledCurve, plot_over_driver, plot_quantities
from tmm_cli.language import _, numeral, spelt, symbol
from tmm_cli.mechanics.analysis import Results, motion_at_positions
from tmm_cli.mechanics.forces import CourseSymbol, Symbol, collect_loads, reduced_inertias, reduced_moment
from tmm_cli.mechanics.numerics import Real
from tmm_cli.mechanics.plans import LANDSCAPE, PORTRAIT
from tmm_cli.mechanics.quantities import (
    ACCELERATION,
    ANGULAR_ACCELERATION,
    ANGULAR_SPEED,
    FORCE,
    INERTIA,
    LENGTH,
    MOMENT,
    NUMBER,
    SPEED,
)
from tmm_cli.problem import UnitSystem, typeset_unit

if TYPE_CHECKING:
    from tmm_cli.mechanics.dynamics import SingleRun, SteadyRunning, SteadySolution, Tangent


LEAST_STRETCH = 1 / 2000  # of a cycle: 0.1 mm of a diagram as wide as a page
MOST_CURVES = 6  # loads or links with a curve each; of more, the smallest are added up


def draw_law_of_motion(results: Results) -> Iterable[tuple[str, Drawing]]:
    """Yield the sheets of the law of motion and the energy-mass diagram; none if the file does not request dynamics."""
    yield from draw_law_curves(results)
    yield from draw_energy_mass(results)


def draw_law_curves(results: Results) -> Iterable[tuple[str, Drawing]]:
    """Yield the sheets with reduced moments, work and energy, then those with inertia, speed, acceleration and time."""
    running = results.steady
    if running is None or results.motion is None:
        return
    travel, borders = _dense_travel(running)
    q, computed = running.start + running.sense * travel, running.travel(results.motion.q)
    moments = _("Reduced moments, work and energy; driving moments are positive; dots: computed positions")
    yield from plot_over_driver(
        results, "law-moments", moments, q, borders, _load_plots(results, running, travel, computed)
    )
    motion = _("Reduced inertia and the law of motion of the driver; dots: computed positions")
    yield from plot_over_driver(
        results, "law-motion", motion, q, borders, _motion_plots(results, running, travel, computed)
    )


def draw_energy_mass(results: Results) -> Iterable[tuple[str, Drawing]]:
    """Yield the energy-mass diagram, as (stem of the file name, drawing), if the file requests dynamics."""
    if results.steady is not None and results.motion is not None:
        yield "energy-mass", energy_mass_sheet(results, results.steady, _dense_travel(results.steady)[0])


def _dense_travel(running: SteadyRunning) -> tuple[Real, list[int]]:
    """Return close travels of the driver over the cycle (rad), and the indices after which quantities may jump."""
    lows, highs = visible_stretches(running.steady.law.energy.edges)
    inner = np.linspace(0, 1, max(4, 720 // len(lows)))
    low, high = lows[:, None] + BORDER_OFFSET, highs[:, None] - BORDER_OFFSET
    travels = low + (high - low) * inner
    return travels.ravel(), (len(inner) * np.arange(1, len(lows)) - 1).tolist()


def visible_stretches(edges: Real) -> tuple[Real, Real]:
    """Return the starts and the ends of those intervals between `edges` that are wide enough to be visible.

    Adjacent narrow intervals are joined into one. If this is still narrower than a line, it is left out, and the curve
    jumps there.
    """
    least = LEAST_STRETCH * (edges[-1] - edges[0])
    wide = np.diff(edges) >= least
    kept = edges[np.append(True, wide) | np.append(wide, True)]
    seen = np.diff(kept) >= least
    return kept[:-1][seen], kept[1:][seen]


def _load_plots(results: Results, running: SteadyRunning, travel: Real, computed: Real) -> list[QuantityPlot]:
    """Return the plots of reduced load moments with their sum, load and driving moment, work and kinetic energy.

    Args:
        results: results at the computed positions.
        running: steady running of the machine.
        travel: travels of the driver for the curves, rad.
        computed: travels of the driver at the computed positions, rad.
    """
    steady = running.steady
    law, machine = steady.law, steady.machine
    loads = _curves_with_sum(
        _reduced_load_moments(results, running, travel), _reduced_load_moments(results, running, computed), _("sum")
    )

    def works(x: Real) -> tuple[Real, Real, Real]:
        return machine.work(x), steady.work(x) - machine.work(x), steady.work(x)

    def energies(x: Real) -> tuple[Real, Real]:
        square = law.speed(x) ** 2 / 2
        return machine.inertia(x) * square, law.flywheel * (square - law.speed(0 * x) ** 2 / 2)

    driver = _("constant moment") if steady.task.motor is None else _("motor")
    driving = [
        _sample_curve(_("loads"), machine.moment, travel, computed),
        _sample_curve(driver, law.driving, travel, computed),
    ]
    energy_names = _("links"), _("energy change of the flywheel")
    return [
        QuantityPlot(_("reduced moments of the loads"), MOMENT, loads),
        QuantityPlot(_("moments"), MOMENT, driving),
        QuantityPlot(
            _("work, J"), NUMBER, _sample_curves((_("loads"), driver, _("sum")), works, travel, computed), "A"
        ),
        QuantityPlot(
            _("kinetic energy, J"),
            NUMBER,
            _sample_curves(energy_names, energies, travel, computed)[: 2 if law.flywheel else 1],
            "T",
        ),
    ]


def _motion_plots(results: Results, running: SteadyRunning, travel: Real, computed: Real) -> list[QuantityPlot]:
    """Return the plots of reduced inertia of the links with their sum, its derivative, speed, acceleration and time.

    travel, computed: travels of the driver (rad) along the curves, and at the computed positions.
    """
    steady = running.steady
    law = steady.law
    parts = _curves_with_sum(
        _reduced_link_inertias(results, running, travel), _reduced_link_inertias(results, running, computed), _("sum")
    )
    mean = SampledCurve(
        _("mean of the largest and the smallest value"),
        np.full(np.shape(travel), np.mean(steady.speeds)),
        np.full(np.shape(computed), np.nan),
        limit=True,
    )
    return [
        QuantityPlot(_("reduced inertia of the links"), INERTIA, parts),
        QuantityPlot("dJ/dφ", INERTIA, [_sample_curve("", steady.machine.slope, travel, computed)], "J′"),
        QuantityPlot(
            _("angular velocity ω"), ANGULAR_SPEED, [_sample_curve(_("ω"), law.speed, travel, computed), mean]
        ),
        QuantityPlot(
            _("angular acceleration ε"), ANGULAR_ACCELERATION, [_sample_curve("", law.acceleration, travel, computed)]
        ),
        QuantityPlot(_("time t, s"), NUMBER, [_sample_curve("", law.time, travel, computed)], "t"),
    ]


def _sample_curve(name: str, function: Any, travel: Real, computed: Real) -> SampledCurve:
    return SampledCurve(name, function(travel), function(computed))


def _sample_curves(names: Sequence[str], function: Any, travel: Real, computed: Real) -> list[SampledCurve]:
    return [SampledCurve(name, *both) for name, *both in zip(names, function(travel), function(computed), strict=True)]


def _reduced_load_moments(results: Results, running: SteadyRunning, travel: Real) -> dict[str, Real]:
    """Return the reduced moments of the loads, by the name of the load, positive in the driver's sense of motion."""
    motion = motion_at_positions(results, running.start + running.sense * travel)
    moments: dict[str, Real] = {}
    for load in collect_loads(motion, results.strokes):
        if load.kind != "inertia":
            text = _("weight of link {link}") if load.kind == "weight" else _("load {name}")
            name = text.format(link=load.link, name=load.name.rstrip("'"))
            moments[name] = moments.get(name, 0.0) + running.sense * reduced_moment(motion, load)
    return moments


def _reduced_link_inertias(results: Results, running: SteadyRunning, travel: Real) -> dict[str, Real]:
    motion = motion_at_positions(results, running.start + running.sense * travel)
    text = _("link {link}")
    return {text.format(link=link): inertia + 0.0 * travel for link, (inertia, __) in reduced_inertias(motion).items()}


def _curves_with_sum(curves: dict[str, Real], points: dict[str, Real], total: str) -> list[SampledCurve]:
    """Return the sum of several quantities as a curve, then a curve for each of them that is not zero.

    If there would be more than MOST_CURVES curves, the smallest quantities are combined into one curve.

    Args:
        curves: values along the curves, by name.
        points: values at the computed positions, by name.
        total: name of the sum.
    """
    sizes = {name: float(np.max(np.abs(values))) for name, values in curves.items()}
    largest = max(sizes.values(), default=0.0)
    curves_drawn = [
        SampledCurve(name, curves[name], points[name]) for name, size in sizes.items() if size > 1e-9 * largest
    ]
    total_curve = _total_curve(curves_drawn, total)
    if len(curves_drawn) > MOST_CURVES:
        kept = sorted(curves_drawn, key=lambda curve: -sizes[curve.name])[: MOST_CURVES - 1]
        rest = [curve for curve in curves_drawn if curve not in kept]
        curves_drawn = [*(curve for curve in curves_drawn if curve in kept), _total_curve(rest, _("sum of the others"))]
    return (
        [total_curve, *curves_drawn]
        if len(curves_drawn) > 1
        else [replace(total_curve, name=curve.name) for curve in curves_drawn] or [total_curve]
    )


def _total_curve(curves_drawn: Sequence[SampledCurve], name: str) -> SampledCurve:
    still = SampledCurve(name, np.zeros(1), np.zeros(1))
    return SampledCurve(
        name, sum((c.values for c in curves_drawn), still.values), sum((c.points for c in curves_drawn), still.points)
    )


FAR_RATIO = 2.0  # widths of the diagram: if zero inertia is farther away, it is not on the sheet
LEAST_WIDTH_SHARE = 0.1  # of the largest inertia: least width of the diagram
AXIS_OVERHANG = 0.08  # of the axis, beyond the curve
TANGENT_OVERHANG = 0.3  # of the axis, beyond the point of contact
ARC_RADII = (26.0, 16.0)  # mm: radii of the angles
ANGLE_LINE = 6.0  # mm by which the zero line of an angle extends beyond its arc
MOST_NUMBERED = 24  # positions with numbers
TANGENT_COLOURS = (LOAD_COLOUR, INERTIA_COLOUR)
TANGENT_ANGLES = (Symbol("ψ", "max"), Symbol("ψ", "min"))
SEGMENT_ENDS = ("a", "b")


@dataclass(frozen=True)
class DrawnTangent:
    """A tangent of the energy-mass diagram on paper.

    Attributes:
        start: its intersection with the energy axis, mm.
        touching: its point of contact with the curve, mm.
        angle: angle between the tangent and the inertia axis, rad.
    """

    start: complex
    touching: complex
    angle: float

    @classmethod
    def of(cls, panel: Panel, tangent: Tangent, factor: float) -> DrawnTangent:
        begins = complex(panel.at(panel.x.low, tangent.offset + tangent.slope * factor * panel.x.low))
        touching = complex(panel.at(tangent.inertia / factor, tangent.energy))
        return cls(begins, touching, math.atan(tangent.slope * factor * panel.x.mu / panel.y.mu))


def energy_mass_sheet(results: Results, running: SteadyRunning, travel: Real) -> Drawing:
    """Draw the energy-mass diagram: work of all moments from position 0 against the reduced inertia of the links."""
    assert results.motion is not None
    steady, units = running.steady, results.problem.units
    factor, unit = units.factor(INERTIA), typeset_unit(units.spelt(INERTIA))
    title = _("Energy-mass diagram with tangents for the largest and the smallest speed; dots: computed positions")
    sheet = DrawingSheet(results.problem.title, title, paper=LANDSCAPE)
    text_start = sheet.canvas.low + 0.5 * TEXT_ROW * 1j
    sheet.canvas = OccupiedArea(sheet.canvas.low + 2.4 * TEXT_ROW * 1j, sheet.canvas.high)

    def diagram(x: Real, colour: str = DARK_COLOUR, *, dots: bool = False) -> ChartCurve:
        return ChartCurve(steady.machine.inertia(x) / factor, steady.work(x), colour=colour, dots=dots)

    whole, dotted = diagram(travel), diagram(running.travel(results.motion.q), dots=True)
    start, longest = axis_extent(sheet)
    axis = round_axis(*_axis_ends(whole.xs, _massless_width(steady) / factor), start, longest)
    words = with_unit(_("reduced inertia J of the links"), INERTIA, units)
    below = (f"{words};  ", *scale_words("J", axis.mu, f"({unit})/mm"))
    names = _("tangent for the largest speed"), _("tangent for the smallest speed")
    lines = [
        _tangent_curve(tangent, factor, (axis.low, axis.high), name, colour)
        for tangent, name, colour in zip(steady.tangents, names, TANGENT_COLOURS, strict=True)
    ]
    work = PlotContent(
        _("work A of all moments, J"), [whole, *lines, dotted], scale=lambda mu: scale_words("A", mu, "J/mm")
    )
    panel = draw_chart(sheet, [work], CommonAxis(axis, below))[0]
    for curve in (whole, *lines):
        sheet.canvas.path(panel.at(curve.xs, curve.ys).tolist())
    step = max(1, round(round_up(len(dotted.xs) / MOST_NUMBERED, TICK_STEPS)))
    for place, number in list(zip(panel.at(dotted.xs, dotted.ys).tolist(), results.numbers, strict=True))[::step]:
        sheet.label(str(number), place, 8, DARK_COLOUR)
    drawn = [DrawnTangent.of(panel, tangent, factor) for tangent in steady.tangents]
    for drawn_tangent, name, end, radius, colour in zip(
        drawn, TANGENT_ANGLES, SEGMENT_ENDS, ARC_RADII, TANGENT_COLOURS, strict=True
    ):
        _draw_tangent_angle(sheet, drawn_tangent, name, radius, colour)
        sheet.circle(drawn_tangent.start, 0.6, NAME_COLOUR, NAME_COLOUR, 0.4, 5)
        sheet.label(end, drawn_tangent.start, 9, NAME_COLOUR, "italic")
    with sheet.on_layer("dimensions"):
        sheet.line([drawn_tangent.start for drawn_tangent in drawn], NAME_COLOUR, 2.0, z=4.2)
    sheet.text(text_start + TEXT_ROW * 1j, _measured_text(drawn), PLAIN_TEXT)
    if steady.law.flywheel:
        sheet.text(text_start, _flywheel_text(steady.law.flywheel, axis.low, units), PLAIN_TEXT)
    return sheet.finish()


def _axis_ends(inertia: Any, massless: float) -> tuple[float, float]:
    """Return the values at both ends of the inertia axis. It begins at zero unless the curve is far from zero.

    massless: value at the end of the axis if no link has inertia.
    """
    low, high = float(np.min(inertia)), float(np.max(inertia))
    if high <= 0.0:
        return 0.0, massless
    wide = max(high - low, LEAST_WIDTH_SHARE * high)
    step = round_up(wide / 4)
    begins = step * math.floor((low - wide) / step) if low > FAR_RATIO * wide else 0.0
    return begins, high + AXIS_OVERHANG * (high - begins)


def _massless_width(steady: SteadySolution) -> float:
    """Return the length of the inertia axis (kg*m²) for a mechanism whose links have no inertia.

    It is chosen so that a tangent rises over this length by the range of the work over the cycle. It is 1 if the work
    is constant.
    """
    fastest, slowest = steady.tangents
    rise = abs(fastest.offset - slowest.offset)
    return rise / fastest.slope if rise > 0.0 else 1.0


def _tangent_curve(tangent: Tangent, factor: float, ends: tuple[float, float], name: str, colour: str) -> ChartCurve:
    """Return a tangent of the energy-mass diagram as a curve, from the energy axis to beyond its point of contact."""
    low, high = ends
    xs = np.array([low, min(tangent.inertia / factor + TANGENT_OVERHANG * (high - low), high)])
    return ChartCurve(xs, tangent.offset + tangent.slope * factor * xs, name, colour, "--", 1.0)


def _draw_tangent_angle(sheet: DrawingSheet, tangent: DrawnTangent, name: Symbol, radius: float, colour: str) -> None:
    """Draw the angle between a tangent of the energy-mass diagram and the inertia axis. Mark the point of contact."""
    sheet.line([tangent.start, tangent.start + radius + ANGLE_LINE], THIN_COLOUR, 0.6, z=1.4, faint=True)
    arc = tangent.start + radius * np.exp(1j * np.linspace(0, tangent.angle, 30))
    sheet.line(arc.tolist(), colour, 0.7, z=2.6)
    sheet.label(name, complex(arc[15]), 9, NAME_COLOUR)
    sheet.circle(tangent.touching, 0.9, "white", colour, 0.9, 4.5)


def _measured_text(drawn: list[DrawnTangent]) -> Words:
    """Return the text with the angles of both tangents and the segment ab between them, as measured on the diagram."""
    texts: list[str | Symbol] = []
    for tangent, name in zip(drawn, TANGENT_ANGLES, strict=True):
        texts += [name, f" = {numeral(math.degrees(tangent.angle), '.4g')}°;   "]
    a, b = (tangent.start for tangent in drawn)
    return (*texts, f"ab = {numeral(abs(a - b), '.4g')} {spelt('mm')}")


def _flywheel_text(inertia: float, begins: float, units: UnitSystem) -> Words:
    """Return the equation for the moment of inertia of the flywheel from the segment ab and the angles of the tangents.

    begins: inertia at the start of the horizontal axis, in the unit of the file; it is subtracted.
    """
    tan, largest, least = symbol("tan"), *TANGENT_ANGLES
    in_units = units.from_si(inertia, INERTIA)
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
        f" = {numeral(in_units, '.4g')} {typeset_unit(units.spelt(INERTIA))}",
    )


MOST_SAMPLES = 480  # in all pieces of a run together
SAMPLES_PER_PIECE = 40  # least number, where there are few pieces
LEAST_SAMPLES = 4  # in a piece, where there are very many


def draw_single_run(results: Results) -> Iterable[tuple[str, Drawing]]:
    """Yield the diagrams of a single run, as (stem of the file name, drawing), if the file requests it."""
    single = results.single
    if single is None or results.motion is None:
        return
    crank, units = results.linkage.driver.kind == "turn", results.problem.units
    factor = np.pi / 180 if crank else units.factor(LENGTH)
    count = len(single.run.steps)
    pieces = single.run.closely(
        max(LEAST_SAMPLES, min(SAMPLES_PER_PIECE, 4 * MOST_SAMPLES // count), MOST_SAMPLES // count)
    )
    times, states = (np.concatenate(arrays, axis=-1) for arrays in zip(*pieces, strict=True))
    ends = (np.cumsum([len(piece_times) for piece_times, __ in pieces])[:-1] - 1).tolist()
    computed = single.travel(results.motion.q)
    time, speed = single.run.at(computed)
    sheet = DrawingSheet(
        results.problem.title,
        _("Single run: diagrams against the travel of the driver; dots: computed positions"),
        paper=PORTRAIT,
    )
    start, most = axis_extent(sheet)
    axis = round_axis(0.0, float(single.run.way[-1]) / factor, start, most, degrees=crank)
    if crank:
        axis_title = _("crank angle from the start of the run, deg")
        words = f"{axis_title};  ", *scale_words("φ", axis.mu, "deg/mm")
    else:
        axis_title = with_unit(_("travel of the driver from the start of the run"), LENGTH, units)
        words = f"{axis_title};  ", *scale_words("s", axis.mu * factor, "m/mm")
    reached = np.isfinite(time)
    numbers = [
        (float(x) / factor, str(n))
        for x, n, is_reached in zip(computed, results.numbers, reached, strict=True)
        if is_reached
    ]
    quantity_plots = _run_plots(single, (times, states), (time, computed, speed), crank=crank)
    plots = [plot_quantities(plot, units, states[0] / factor, computed / factor, ends) for plot in quantity_plots]
    draw_chart(sheet, plots, CommonAxis(axis, words, sorted(numbers)))
    yield "single-run", sheet.finish()


def _run_plots(
    single: SingleRun, curve: tuple[Real, Any], points: tuple[Real, Real, Real], *, crank: bool
) -> list[QuantityPlot]:
    """Return the plots of a single run: moments, work and energy, speed, acceleration and time.

    Args:
        single: the run.
        curve: times and states along the curves.
        points: times, travels and speeds at the computed positions.
        crank: True if the driver rotates.
    """
    times, (travel, speed, driven, loaded, braked) = curve
    time, computed, speeds = points
    changes, at_points = single.acceleration(times, travel, speed), single.acceleration(time, computed, speeds)
    none = np.full(np.shape(computed), np.nan)
    driving = _("driving moment") if crank else _("driving force")
    moments = [
        SampledCurve(driving, single.driving(travel, speed, changes), single.driving(computed, speeds, at_points)),
        SampledCurve(
            _("loads"),
            single.machine.moment(travel),
            np.where(np.isfinite(time), single.machine.moment(computed), none),
        ),
    ]
    works = [SampledCurve(driving, driven, none), SampledCurve(_("loads"), loaded, none)]
    if single.task.brake:
        works.append(SampledCurve(_("brake"), braked, none))
    works.append(SampledCurve(_("kinetic energy"), single.energy(travel, speed), single.energy(computed, speeds)))
    return [
        QuantityPlot(_("moments") if crank else _("forces"), MOMENT if crank else FORCE, moments),
        QuantityPlot(_("work and kinetic energy, J"), NUMBER, works, "A"),
        QuantityPlot(
            _("angular velocity ω") if crank else _("speed v"),
            ANGULAR_SPEED if crank else SPEED,
            [SampledCurve("", speed, speeds)],
        ),
        QuantityPlot(
            _("angular acceleration ε") if crank else _("acceleration a"),
            ANGULAR_ACCELERATION if crank else ACCELERATION,
            [SampledCurve("", changes, at_points)],
        ),
        QuantityPlot(_("time t, s"), NUMBER, [SampledCurve("", times, time)], "t"),
    ]
