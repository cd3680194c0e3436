"""Diagrams over the cycle: quantities against the driver coordinate at round scales, with position numbers."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tmm_cli.drawing.paper import (
    DARK_COLOUR,
    INERTIA_COLOUR,
    LOAD_COLOUR,
    NAME_COLOUR,
    REACTION_COLOUR,
    THIN_COLOUR,
    ChartAxis,
    ChartCurve,
    CommonAxis,
    CurveJump,
    Drawing,
    DrawingSheet,
    PlotContent,
    Style,
    Words,
    axis_extent,
    count_fitting,
    draw_chart,
    file_safe_name,
    round_axis,
    scale_words,
    with_unit,
)
from tmm_cli.language import _, numeral, translated
from tmm_cli.mechanics import quantities
from tmm_cli.mechanics.analysis import Results, results_at
from tmm_cli.mechanics.forces import balance_symbol, find_table_jumps, reaction_symbol
from tmm_cli.mechanics.kinematics import Motion, driven_links, driving_pair_names, pressure_angle
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.numerics import NO_FORCE, Real
from tmm_cli.mechanics.plans import LANDSCAPE, PORTRAIT
from tmm_cli.mechanics.quantities import (
    ANGLE,
    ANGULAR_ACCELERATION,
    ANGULAR_SPEED,
    FORCE,
    INERTIA,
    MASS,
    MOMENT,
    NUMBER,
    Dimension,
)
from tmm_cli.mechanics.structure import POSITIONS_PER_TURN
from tmm_cli.problem import UnitSystem, typeset_unit
from tmm_cli.reports import output_motion

MOST_CURVES = 6  # in a panel of reactions, pressure angles or balancing moments


@dataclass(frozen=True)
class SampledCurve:
    """A quantity as a curve over the cycle and as dots at the computed positions.

    Attributes:
        name: name in the legend.
        values: values of the curve at closely spaced driver coordinates, SI units.
        points: values at the computed positions, SI units.
        limit: True for an allowable value, which is drawn dashed and without dots.
    """

    name: str
    values: Any
    points: Any
    limit: bool = False


@dataclass(frozen=True)
class QuantityPlot:
    """Quantities of the same dimension that are drawn in one panel.

    Attributes:
        words: title.
        dimension: their dimension.
        curves: their curves.
        symbol: letter in the scale factor, e.g. "R"; if empty, the one that is usual for the dimension.
    """

    words: str
    dimension: Dimension
    curves: Sequence[SampledCurve]
    symbol: str = ""


def output_plots(results: Results, motion: Motion, link: str) -> list[QuantityPlot]:
    """Return the plots of coordinate, speed and acceleration of an output. Angles have no jumps by 360 degrees."""
    assert results.motion is not None
    near = [int(np.argmin(np.abs(motion.q - q))) for q in results.motion.q]
    plots = []
    turning = {ANGULAR_SPEED: _("ω of {link}"), ANGULAR_ACCELERATION: _("ε of {link}")}
    curves, computed = output_motion(results, motion, link), output_motion(results, results.motion, link)
    for (name, values, dimension), (__, points, ___) in zip(curves, computed, strict=True):
        if dimension in turning:
            name = turning[dimension].format(link=link)
        if dimension == ANGLE:
            values = np.unwrap(values)
            points = points + 2 * np.pi * np.round((values[near] - points) / (2 * np.pi))
        plots.append(QuantityPlot(translated(name), dimension, [SampledCurve("", values, points)]))
    return plots


def balancing_plots(whole: Results, results: Results) -> list[QuantityPlot]:
    """Return the plots of the balancing moments of the drivers, then of their balancing forces.

    Args:
        whole: results at closely spaced driver coordinates, for the curves.
        results: results at the computed positions, for the dots.
    """
    if whole.reactions is None or results.reactions is None:
        return []
    several = len(whole.reactions.balances) > 1
    curves_of: dict[bool, list[SampledCurve]] = {True: [], False: []}
    for curve, points in zip(whole.reactions.balances, results.reactions.balances, strict=True):
        turns = curve.moment is not None if several else curve.kind == "moment"
        name = balance_symbol(curve.driver.link, several, turns=turns).name if several else ""
        values, dots = (b.generalized if several or turns else b.force for b in (curve, points))
        curves_of[turns].append(SampledCurve(name, values, dots))
    moments = _("balancing moments") if several else _("balancing moment")
    forces = _("balancing forces") if several else _("balancing force")
    return [
        QuantityPlot(words, dimension, sampled[first : first + MOST_CURVES])
        for words, dimension, sampled in ((moments, MOMENT, curves_of[True]), (forces, FORCE, curves_of[False]))
        for first in range(0, len(sampled), MOST_CURVES)
    ]


def reaction_plots(whole: Results, results: Results) -> list[QuantityPlot]:
    """Return the plots of the magnitudes of all reactions, with at most MOST_CURVES curves in each plot.

    Args:
        whole: results at closely spaced driver coordinates, for the curves.
        results: results at the computed positions, for the dots.
    """
    if whole.reactions is None or results.reactions is None:
        return []
    computed = {r.pair.name: r for r in results.reactions.all}
    plots = []
    for words, on_frame in ((_("reactions of the frame"), True), (_("reactions between moving links"), False)):
        sampled = [
            SampledCurve(f"{symbol.name} ({r.pair.name})", np.abs(r.force), np.abs(computed[r.pair.name].force))
            for r, symbol in ((r, reaction_symbol(r.by, r.on)) for r in whole.reactions.all)
            if (FRAME in (r.on, r.by)) == on_frame
        ]
        plots += [
            QuantityPlot(words, FORCE, sampled[i : i + MOST_CURVES], "R") for i in range(0, len(sampled), MOST_CURVES)
        ]
    return plots


def energy_plots(whole: Results, results: Results) -> list[QuantityPlot]:
    """Return the plots of reduced inertia, reduced moment, kinetic energy and powers; none without weights and loads.

    Args:
        whole: results at closely spaced driver coordinates, for the curves.
        results: results at the computed positions, for the dots.
    """
    curve, computed = whole.energy, results.energy
    if curve is None or computed is None:
        return []
    crank = results.linkage.driver.kind == "turn"
    powers = {
        _("driving forces"): "drivers",
        _("weights"): "weights",
        _("loads"): "loads",
        _("friction"): "friction",
        _("rate of change of T"): "rate",
    }
    plots = []
    for words, dimension, parts, symbol in (
        (_("reduced inertia J") if crank else _("reduced mass m"), INERTIA if crank else MASS, {"": "inertia"}, ""),
        (_("reduced moment M") if crank else _("reduced force F"), MOMENT if crank else FORCE, {"": "moment"}, ""),
        (_("kinetic energy T, J"), NUMBER, {"": "kinetic"}, "T"),
        (_("power, W"), NUMBER, powers, "P"),
    ):
        sampled = [SampledCurve(label, getattr(curve, name), getattr(computed, name)) for label, name in parts.items()]
        sampled = [sampled_curve for sampled_curve in sampled if np.any(np.nan_to_num(sampled_curve.values) != 0)]
        if sampled:
            plots.append(QuantityPlot(words, dimension, sampled, symbol))
    return plots


def shaking_plots(results: Results, q: Any) -> list[QuantityPlot]:
    """Return the plots of the shaking force and the shaking moment, with and without counterweights.

    q: closely spaced driver coordinates for the curves, rad or m.
    """
    balancing = results.balancing
    if balancing is None or not np.any(np.nan_to_num(balancing.cycle.before.force) != 0):
        return []
    stage_names = [(_("without counterweights"), balancing.before), (_("with counterweights"), balancing.after)]
    stages = [(*stage, curve) for stage, curve in zip(stage_names, balancing.at(results.mechanism, q), strict=True)]
    stages = stages[::-1] if balancing.cycle.counterweights else stages[:1]  # dashed: without counterweights
    nothing = NO_FORCE * float(np.nanmax(np.abs(balancing.cycle.before.force)))

    def size(force: Any) -> Any:
        return np.where(np.abs(force) > nothing, np.abs(force), 0 * np.abs(force))

    forces = [SampledCurve(name, size(curve.force), size(computed.force)) for name, computed, curve in stages]
    moments = [SampledCurve(name, curve.moment, computed.moment) for name, computed, curve in stages]
    about = _("shaking moment about {pivot}").format(pivot=balancing.pivot or _("the origin"))
    return [QuantityPlot(_("shaking force"), FORCE, forces), QuantityPlot(about, MOMENT, moments)]


def pressure_plots(results: Results, motion: Motion) -> list[QuantityPlot]:
    """Return the plots of pressure angles. Sliding and rotating driven links are separate, as their limits differ."""
    with np.errstate(all="ignore"):
        curves = {
            (kernel.group.title, lead[0], driving_pair_names(lead)): pressure_angle(motion, kernel, at, lead)
            for kernel, at in zip(motion.kernels, motion.placements, strict=True)
            for lead in driven_links(kernel.group)
        }
    plots = []
    for slides in (True, False):
        angles = [p for p in results.pressure if p.slides == slides]
        text = _("link {link} in pair {pair}")
        sampled = [
            SampledCurve(text.format(link=p.link, pair=p.pair), curves[p.group, p.link, p.pair], p.angles)
            for p in angles
        ]
        words = _("pressure angle of sliding links") if slides else _("pressure angle of rotating links")
        for first in range(0, len(sampled), MOST_CURVES):
            allowed = np.full(np.shape(motion.q), angles[0].allowed)
            limit = SampledCurve(_("allowed"), allowed, np.full(np.shape(angles[0].angles), np.nan), limit=True)
            plots.append(QuantityPlot(words, ANGLE, [*sampled[first : first + MOST_CURVES], limit], "θ"))
    return plots


MOST_POINTS = 1440  # of a curve over a cycle
MOST_DOTS = 90  # computed positions marked on a curve; more would hide it
MOST_PANELS = 5  # of a sheet
BORDER_OFFSET = 1e-6  # rad: curves are computed this much before and after the end of a stroke
LEAST_JUMP = 1e-3  # of the range of a curve: a larger step at the end of a stroke is a jump
CONSTANT_BELOW = 1e-9  # of the largest value: a curve with a smaller range is constant
LEAST_SUDDEN_JUMP = 0.01  # of the range of a curve: a jump away from the borders
JUMP_STEEPNESS = 6.0  # times the slopes just before and after it
MOST_WRITTEN_CURVES = 2  # in a panel: with more the values of jumps are not written
MOST_WRITTEN_JUMPS = 24  # of a curve: with more their values are not written
CURVE_COLOURS = (
    DARK_COLOUR,
    LOAD_COLOUR,
    INERTIA_COLOUR,
    REACTION_COLOUR,
    NAME_COLOUR,
    "#c77700",
    "#00757d",
    THIN_COLOUR,
)
CURVE_STYLES: tuple[Style, ...] = ("-", "--", "-.", ":")
SCALE_SYMBOLS = {
    quantities.LENGTH: "s",
    quantities.SPEED: "v",
    quantities.ACCELERATION: "a",
    quantities.ANGLE: "φ",
    quantities.ANGULAR_SPEED: "ω",
    quantities.ANGULAR_ACCELERATION: "ε",
    quantities.FORCE: "F",
    quantities.MOMENT: "M",
    quantities.INERTIA: "J",
    quantities.MASS: "m",
}
SYMBOL_UNITS = {"T": "J", "A": "J", "P": "W", "t": "s"}  # units of quantities without a unit in the file


def draw_diagrams(results: Results) -> Iterable[tuple[str, Drawing]]:
    """Yield all diagrams over the cycle, as (stem of the file name, drawing).

    They show outputs, balancing moments or forces, reactions, energy, pressure angles and shaking force.
    """
    coordinates, borders = dense_coordinates(results)
    whole = results_at(results, coordinates)
    motion = whole.motion
    assert motion is not None
    outputs = results.mechanism.outputs
    stems = [f"diagrams-link-{x}" if x in results.linkage.links else f"diagrams-{x}" for x in outputs]
    of_outputs = {stem: output_plots(results, motion, x) for stem, x in zip(stems, outputs, strict=True)}
    first = of_outputs.pop(stems[0]) if stems else []
    cycle = _("Diagrams over the cycle; dots: computed positions")
    reactions = _("Reactions over the cycle; dots: computed positions")
    energy = _("Reduced inertia and moment, energy and power; dots: computed positions")
    pressure = _("Pressure angles over the cycle; dots: computed positions; dashed: allowable values")
    balancing = _("Shaking force and shaking moment over the cycle; dots: computed positions")
    for caption, stem, plots in (
        (cycle, "diagrams", [*first, *balancing_plots(whole, results)]),
        *((cycle, stem, plots) for stem, plots in of_outputs.items()),
        (reactions, "reactions", reaction_plots(whole, results)),
        (energy, "energy", energy_plots(whole, results)),
        (pressure, "pressure", pressure_plots(results, motion)),
        (balancing, "shaking", shaking_plots(results, coordinates)),
    ):
        yield from plot_over_driver(results, file_safe_name(stem), caption, motion.q, borders, plots)


def dense_coordinates(results: Results) -> tuple[Real, list[int]]:
    """Return closely spaced driver coordinates over the cycle, and the indices after which quantities may jump.

    Quantities may jump at the end of a stroke and where a load given by a table jumps.
    """
    turns, sense = results.turns, results.linkage.driver.sense
    coordinates = results.closely(min((POSITIONS_PER_TURN - 1) * (turns or 1), MOST_POINTS) + 1)
    if not turns:
        return coordinates, []
    gone, end = sense * (coordinates - results.start), 2 * np.pi * turns
    stops = {stop for start, length, __ in _strokes_from_start(results) for stop in (start, start + length)}
    stops |= {float(sense * (q - results.start)) % end for q in find_table_jumps(results.mechanism)}
    borders = [stop for stop in sorted(stops - {0.0}) if stop > 2 * BORDER_OFFSET]
    borders = [stop for k, stop in enumerate(borders) if not k or stop - borders[k - 1] > 4 * BORDER_OFFSET]
    for border in borders:
        gone = gone[np.abs(gone - border) > 2 * BORDER_OFFSET]
        gone = np.append(gone, [border - BORDER_OFFSET, min(border + BORDER_OFFSET, end)])
    gone = np.sort(gone)
    before = np.searchsorted(gone, np.array(borders) - 1.5 * BORDER_OFFSET)
    return results.start + sense * gone, before.tolist()


def _strokes_from_start(results: Results) -> list[tuple[float, float, bool]]:
    """Return the strokes of the output over the cycle that begins with position 0, each as a tuple.

    It contains the driver angle from position 0 at which the stroke begins, the length of its range of driver angles
    (rad), and True for a working stroke. A stroke during which position 0 occurs is divided into two.
    """
    turns, strokes = results.turns, results.strokes
    if not turns or strokes is None:
        return []
    end, strokes_drawn = 2 * np.pi * turns, []
    for stroke in strokes.strokes:
        start = float(np.mod(results.linkage.driver.sense * (stroke.start - results.start), strokes.cycle))
        start = 0.0 if strokes.cycle - start < BORDER_OFFSET or start < BORDER_OFFSET else start
        for begin in (start - strokes.cycle, start):
            low, high = max(begin, 0.0), min(begin + stroke.length, end)
            if high - low > BORDER_OFFSET:
                strokes_drawn.append((low, end - low if end - high < BORDER_OFFSET else high - low, stroke.working))
    return strokes_drawn


def _stroke_names(results: Results, strokes: Sequence[tuple[float, float, bool]]) -> list[str]:
    """Name the strokes "working stroke" and "return stroke", or number them if there are several of each."""
    if not results.counts_strokes:
        return [_("working stroke") if working else _("return stroke") for __, __, working in strokes]
    numbers = list(range(1, len(strokes) + 1))
    if len(strokes) % 2:  # position 0 divides a stroke, of which this is the other part
        numbers[-1] = 1
    return [_("stroke {number}").format(number=number) for number in numbers]


def _axis_values(results: Results, q: Real) -> Any:
    """Convert driver coordinates to crank angles from position 0 (deg), or to displacements of a driving slider."""
    if results.linkage.driver.kind == "slide":
        return np.asarray(q) / results.problem.units.factor(quantities.LENGTH)
    return np.degrees(results.linkage.driver.sense * (q - results.start))


def plot_over_driver(
    results: Results, stem: str, caption: str, q: Real, borders: Sequence[int], plots: Sequence[QuantityPlot]
) -> Iterable[tuple[str, Drawing]]:
    """Draw quantities against the driver coordinate on one or more sheets, as (stem of the file name, drawing).

    Args:
        results: results at the computed positions.
        stem: stem of the first file name; further ones are numbered from 2.
        caption: caption of the sheets.
        q: driver coordinates of the curves (rad or m).
        borders: indices of q after which a quantity may jump.
        plots: quantities, one panel each.
    """
    left, number = list(plots), 1
    while left:
        count, drawing = _plot_sheet(results, caption, q, borders, left[:MOST_PANELS])
        yield (f"{stem}-{number}" if number > 1 else stem), drawing
        left, number = left[count:], number + 1


def _plot_sheet(
    results: Results, caption: str, q: Real, borders: Sequence[int], quantity_plots: Sequence[QuantityPlot]
) -> tuple[int, Drawing]:
    """Draw as many of the plots as fit on one sheet. Return their number and the sheet."""
    assert results.motion is not None
    sheet = DrawingSheet(results.problem.title, caption, paper=PORTRAIT if len(quantity_plots) > 2 else LANDSCAPE)
    xs, marks, end = _axis_values(results, q), _axis_values(results, results.motion.q), 360 * results.turns
    numbers = list(zip(marks.tolist(), map(str, results.numbers), strict=True))
    if end:
        marks = np.mod(marks + BORDER_OFFSET, end) - BORDER_OFFSET
        numbers = [(mark, text) for mark, (__, text) in zip(marks.tolist(), numbers, strict=True)]
        if not results.inputs.request.places:
            numbers.append((end, str(len(results.asked))))
    axis, words = _driver_axis(results, (0.0, end) if end else (min(xs), max(xs)), *axis_extent(sheet))
    strokes = sorted(_strokes_from_start(results))
    spans = [
        (math.degrees(start), math.degrees(start + length), name)
        for (start, length, __), name in zip(strokes, _stroke_names(results, strokes), strict=True)
    ]
    over = CommonAxis(axis, words, sorted(numbers), spans)
    plots = [plot_quantities(plot, results.problem.units, xs, marks, borders) for plot in quantity_plots]
    count = count_fitting(sheet, plots, over)
    draw_chart(sheet, plots[:count], over)
    return count, sheet.finish()


def _driver_axis(results: Results, ends: tuple[float, float], start: float, most: float) -> tuple[ChartAxis, Words]:
    """Return the horizontal axis for the driver coordinate, and its title with the scale factor."""
    if results.linkage.driver.kind == "turn":
        axis = round_axis(*ends, start, most, degrees=True)
        title = _("crank angle from position 0, deg")
        return axis, (f"{title};  ", *scale_words("φ", axis.mu, "deg/mm"))
    axis, units = round_axis(*ends, start, most), results.problem.units
    scale = scale_words("s", axis.mu * units.factor(quantities.LENGTH), "m/mm")
    title = with_unit(_("driver"), quantities.LENGTH, units)
    return axis, (f"{title};  ", *scale)


def plot_quantities(
    quantity_plot: QuantityPlot, units: UnitSystem, xs: Any, marks: Any, borders: Sequence[int]
) -> PlotContent:
    """Convert a plot from SI to the units of the file, and interrupt its curves where they jump.

    Args:
        quantity_plot: the quantities, SI units.
        units: units of the file.
        xs: values of the curves on the horizontal axis, (coordinates,).
        marks: values of the computed positions on the horizontal axis, (positions,).
        borders: indices of `xs` after which a curve may jump.
    """
    factor, unit = units.factor(quantity_plot.dimension), typeset_unit(units.spelt(quantity_plot.dimension))
    curves, jumps = [], []
    for k, sampled_curve in enumerate(quantity_plot.curves):
        values, points = (np.asarray(v) / factor for v in (sampled_curve.values, sampled_curve.points))
        if sampled_curve.limit:
            curves.append(ChartCurve(xs, values, sampled_curve.name, THIN_COLOUR, "--", 1.0))
            continue
        colour, style = (
            CURVE_COLOURS[k % len(CURVE_COLOURS)],
            CURVE_STYLES[(k // len(CURVE_COLOURS) + k) % len(CURVE_STYLES)],
        )
        values = np.broadcast_to(values, np.shape(xs))
        leaps = _find_jumps(xs, values, borders)
        after = np.array(leaps, dtype=int) + 1
        whole = np.insert(values, after, np.nan)
        curves.append(ChartCurve(np.insert(xs, after, np.nan), whole, sampled_curve.name, colour, style))
        dot_step = slice(None, None, math.ceil(len(marks) / MOST_DOTS) or 1)
        curves.append(
            ChartCurve(marks[dot_step], np.broadcast_to(points, np.shape(marks))[dot_step], "", colour, dots=True)
        )
        for i in leaps:
            written = len(quantity_plot.curves) <= MOST_WRITTEN_CURVES and len(leaps) <= MOST_WRITTEN_JUMPS
            jump_texts = [numeral(v, ".4g") if written else "" for v in (values[i], values[i + 1])]
            jumps.append(CurveJump(xs[i], (values[i], values[i + 1]), (jump_texts[0], jump_texts[1]), colour))
    return PlotContent(
        with_unit(quantity_plot.words, quantity_plot.dimension, units),
        curves,
        jumps,
        _scale_caption(quantity_plot, units, unit),
        degrees=quantity_plot.dimension == quantities.ANGLE and units.symbol(quantities.ANGLE) == "deg",
    )


def _find_jumps(xs: Any, values: Any, borders: Sequence[int]) -> list[int]:
    """Return the indices of the values after which a curve jumps.

    These are ends of strokes (`borders`), and points where the curve is much steeper than nearby, e.g. because friction
    reverses within a stroke.
    """
    steps, whole = np.abs(np.diff(values)), np.ptp(values)
    if not whole > CONSTANT_BELOW * np.max(np.abs(values)):
        return []
    rates = steps / np.maximum(np.abs(np.diff(xs)), BORDER_OFFSET)
    inside = np.arange(2, len(steps) - 2)
    about = np.max([rates[inside + k] for k in (-2, -1, 1, 2)], axis=0)
    sudden = inside[(steps[inside] > LEAST_SUDDEN_JUMP * whole) & (rates[inside] > JUMP_STEEPNESS * about)]
    return sorted({*(i for i in borders if steps[i] > LEAST_JUMP * whole), *map(int, sudden)})


def _scale_caption(quantity_plot: QuantityPlot, units: UnitSystem, unit: str) -> Any:
    """Return a function that writes the scale factor of a vertical axis. Lengths are in metres, as on other sheets."""
    symbol, factor = quantity_plot.symbol or SCALE_SYMBOLS.get(quantity_plot.dimension, ""), 1.0
    if quantity_plot.dimension == quantities.LENGTH:
        unit, factor = "m", units.factor(quantities.LENGTH)
    elif not unit:
        unit = SYMBOL_UNITS.get(quantity_plot.symbol, "1")
    per = f"({unit})/mm" if "/" in unit else f"{unit}/mm"
    return lambda mu: scale_words(symbol, mu * factor, per)
