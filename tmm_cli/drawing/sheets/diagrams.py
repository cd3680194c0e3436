"""Diagrams over the cycle, each quantity at a round scale over the driver's turn and the numbers of positions."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
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
from tmm_cli.drawing.sheets import over_cycle
from tmm_cli.drawing.sheets.over_cycle import QuantityPlot
from tmm_cli.language import _, numeral
from tmm_cli.mechanics import quantities
from tmm_cli.mechanics.analysis import Results, results_at
from tmm_cli.mechanics.forces import find_table_jumps
from tmm_cli.mechanics.numerics import Real
from tmm_cli.mechanics.plans import LANDSCAPE, PORTRAIT
from tmm_cli.mechanics.structure import POSITIONS_PER_TURN
from tmm_cli.problem import UnitSystem, typeset_unit

MOST_POINTS = 1440  # of a curve over a cycle
MOST_DOTS = 90  # computed positions that are marked on a curve; more of them would hide it
MOST_PANELS = 5  # of a sheet
BORDER_OFFSET = 1e-6  # rad: so far before and after the border of a stroke a curve is computed
LEAST_JUMP = 1e-3  # of all a curve runs through: what it does there in one step is a jump
CONSTANT_BELOW = 1e-9  # of its largest value: what runs through less stays the same
LEAST_SUDDEN_JUMP, JUMP_STEEPNESS = (
    0.01,
    6.0,
)  # the same away from the borders: of all it runs through, and of its rates before and after
MOST_WRITTEN_CURVES, MOST_WRITTEN_JUMPS = (
    2,
    24,
)  # curves in a panel, and jumps of a curve, up to which the values of jumps are written
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
SYMBOL_UNITS = {"T": "J", "A": "J", "P": "W", "t": "s"}  # of what has no unit in the file


def draw_diagrams(results: Results) -> Iterable[tuple[str, Drawing]]:
    """Run, speed and acceleration of the outputs, and the balancing moments; reactions, energy and pressure angles."""
    places, borders = dense_coordinates(results)
    whole = results_at(results, places)
    motion = whole.motion
    assert motion is not None
    outputs = results.mechanism.outputs
    stems = [f"diagrams-link-{x}" if x in results.linkage.links else f"diagrams-{x}" for x in outputs]
    of_outputs = {stem: over_cycle.output_plots(results, motion, x) for stem, x in zip(stems, outputs, strict=True)}
    first = of_outputs.pop(stems[0]) if stems else []
    cycle = _("Diagrams over the cycle; dots: computed positions")
    reactions = _("Reactions over the cycle; dots: computed positions")
    energy = _("The mechanism reduced to its driver, and its powers; dots: computed positions")
    pressure = _("Pressure angles over the cycle; dots: computed positions, dashed: allowed")
    balancing = _("What shakes the frame over the cycle; dots: computed positions")
    for caption, stem, every in (
        (cycle, "diagrams", [*first, *over_cycle.balancing_plots(whole, results)]),
        *((cycle, stem, every) for stem, every in of_outputs.items()),
        (reactions, "reactions", over_cycle.reaction_plots(whole, results)),
        (energy, "energy", over_cycle.energy_plots(whole, results)),
        (pressure, "pressure", over_cycle.pressure_plots(results, motion)),
        (balancing, "shaking", over_cycle.shaking_plots(results, places)),
    ):
        yield from plot_over_driver(results, file_safe_name(stem), caption, motion.q, borders, every)


def dense_coordinates(results: Results) -> tuple[Real, list[int]]:
    """Places of the driver close together, and after which of them a stroke ends or a table of a load jumps."""
    turns, sense = results.turns, results.linkage.driver.sense
    places = results.closely(min((POSITIONS_PER_TURN - 1) * (turns or 1), MOST_POINTS) + 1)
    if not turns:
        return places, []
    gone, end = sense * (places - results.start), 2 * np.pi * turns
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
    """Strokes in what is drawn, from position 0 on: start, length (rad), whether it is a working one."""
    turns, strokes = results.turns, results.strokes
    if not turns or strokes is None:
        return []
    end, found = 2 * np.pi * turns, []
    for stroke in strokes.strokes:
        start = float(np.mod(results.linkage.driver.sense * (stroke.start - results.start), strokes.cycle))
        start = 0.0 if strokes.cycle - start < BORDER_OFFSET or start < BORDER_OFFSET else start
        for begin in (start - strokes.cycle, start):
            low, high = max(begin, 0.0), min(begin + stroke.length, end)
            if high - low > BORDER_OFFSET:
                found.append((low, end - low if end - high < BORDER_OFFSET else high - low, stroke.working))
    return found


def _stroke_names(results: Results, strokes: Sequence[tuple[float, float, bool]]) -> list[str]:
    """What the strokes are called."""
    if not results.counts_strokes:
        return [_("working stroke") if working else _("idle stroke") for __, __, working in strokes]
    numbers = list(range(1, len(strokes) + 1))
    if len(strokes) % 2:  # position 0 is within a stroke, and this is its other part
        numbers[-1] = 1
    return [_("stroke {number}").format(number=number) for number in numbers]


def _axis_values(results: Results, q: Real) -> Any:
    """The driver's turn from position 0, deg; a slider's run in the file's unit."""
    if results.linkage.driver.kind == "slide":
        return np.asarray(q) / results.problem.units.factor(quantities.LENGTH)
    return np.degrees(results.linkage.driver.sense * (q - results.start))


def plot_over_driver(
    results: Results, stem: str, caption: str, q: Real, borders: Sequence[int], every: Sequence[QuantityPlot]
) -> Iterable[tuple[str, Drawing]]:
    """Draw quantities at driver coordinates q, which may jump after those numbered `borders`, on one or more sheets.

    stem: name of the first sheet; the further ones are numbered from 2 on.
    """
    left, number = list(every), 1
    while left:
        count, drawing = _plot_sheet(results, caption, q, borders, left[:MOST_PANELS])
        yield (f"{stem}-{number}" if number > 1 else stem), drawing
        left, number = left[count:], number + 1


def _plot_sheet(
    results: Results, caption: str, q: Real, borders: Sequence[int], every: Sequence[QuantityPlot]
) -> tuple[int, Drawing]:
    """A sheet with as many of the quantities as it has room for, and how many these are."""
    assert results.motion is not None
    sheet = DrawingSheet(results.problem.title, caption, paper=PORTRAIT if len(every) > 2 else LANDSCAPE)
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
    plots = [plot_quantities(one, results.problem.units, xs, marks, borders) for one in every]
    count = count_fitting(sheet, plots, over)
    draw_chart(sheet, plots[:count], over)
    return count, sheet.finish()


def _driver_axis(results: Results, ends: tuple[float, float], start: float, most: float) -> tuple[ChartAxis, Words]:
    """The axis of the driver's turn (deg) or of its run, and what is written below it."""
    if results.linkage.driver.kind == "turn":
        axis = round_axis(*ends, start, most, degrees=True)
        return axis, (f"{_('turn of the crank from position 0, deg')};  ", *scale_words("φ", axis.mu, "deg/mm"))
    axis, units = round_axis(*ends, start, most), results.problem.units
    scale = scale_words("s", axis.mu * units.factor(quantities.LENGTH), "m/mm")
    return axis, (f"{with_unit(_('driver'), quantities.LENGTH, units)};  ", *scale)


def plot_quantities(found: QuantityPlot, units: UnitSystem, xs: Any, marks: Any, borders: Sequence[int]) -> PlotContent:
    """A panel of quantities over places xs, which may jump after those of the numbers `borders`; marks: of points."""
    factor, unit = units.factor(found.dimension), typeset_unit(units.spelt(found.dimension))
    curves, jumps = [], []
    for k, course in enumerate(found.courses):
        values, points = (np.asarray(v) / factor for v in (course.values, course.points))
        if course.limit:
            curves.append(ChartCurve(xs, values, course.name, THIN_COLOUR, "--", 1.0))
            continue
        colour, style = (
            CURVE_COLOURS[k % len(CURVE_COLOURS)],
            CURVE_STYLES[(k // len(CURVE_COLOURS) + k) % len(CURVE_STYLES)],
        )
        values = np.broadcast_to(values, np.shape(xs))
        leaps = _find_jumps(xs, values, borders)
        after = np.array(leaps, dtype=int) + 1
        whole = np.insert(values, after, np.nan)
        curves.append(ChartCurve(np.insert(xs, after, np.nan), whole, course.name, colour, style))
        every = slice(None, None, math.ceil(len(marks) / MOST_DOTS) or 1)
        curves.append(ChartCurve(marks[every], np.broadcast_to(points, np.shape(marks))[every], "", colour, dots=True))
        for i in leaps:
            written = len(found.courses) <= MOST_WRITTEN_CURVES and len(leaps) <= MOST_WRITTEN_JUMPS
            told = [numeral(v, ".4g") if written else "" for v in (values[i], values[i + 1])]
            jumps.append(CurveJump(xs[i], (values[i], values[i + 1]), (told[0], told[1]), colour))
    return PlotContent(
        with_unit(found.words, found.dimension, units),
        curves,
        jumps,
        _scale_caption(found, units, unit),
        degrees=found.dimension == quantities.ANGLE and units.symbol(quantities.ANGLE) == "deg",
    )


def _find_jumps(xs: Any, values: Any, borders: Sequence[int]) -> list[int]:
    """After which places a curve jumps: at ends of strokes, and where it runs far faster than just before and after.

    So it does where friction turns about within a stroke.
    """
    steps, whole = np.abs(np.diff(values)), np.ptp(values)
    if not whole > CONSTANT_BELOW * np.max(np.abs(values)):
        return []
    rates = steps / np.maximum(np.abs(np.diff(xs)), BORDER_OFFSET)
    inside = np.arange(2, len(steps) - 2)
    about = np.max([rates[inside + k] for k in (-2, -1, 1, 2)], axis=0)
    sudden = inside[(steps[inside] > LEAST_SUDDEN_JUMP * whole) & (rates[inside] > JUMP_STEEPNESS * about)]
    return sorted({*(i for i in borders if steps[i] > LEAST_JUMP * whole), *map(int, sudden)})


def _scale_caption(found: QuantityPlot, units: UnitSystem, unit: str) -> Any:
    """How the scale of the axis is written: that of lengths in metres, as on the other sheets."""
    symbol, factor = found.symbol or SCALE_SYMBOLS.get(found.dimension, ""), 1.0
    if found.dimension == quantities.LENGTH:
        unit, factor = "m", units.factor(quantities.LENGTH)
    elif not unit:
        unit = SYMBOL_UNITS.get(found.symbol, "1")
    per = f"({unit})/mm" if "/" in unit else f"{unit}/mm"
    return lambda mu: scale_words(symbol, mu * factor, per)
