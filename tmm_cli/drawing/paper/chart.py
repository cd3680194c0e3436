"""Charts: panels above one another on a common axis, with round scales, curves, legends and position numbers."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tmm_cli.drawing.paper.record import POINT, Align, Style
from tmm_cli.drawing.paper.sheet import THIN_COLOUR, DrawingSheet
from tmm_cli.drawing.paper.texts import (
    DARK_COLOUR,
    Words,
    script_width as width_of_words,
    split_symbols,
    text_width as width_of,
)
from tmm_cli.language import numeral

ROUND_SCALES = (1.0, 2.0, 2.5, 4.0, 5.0, 10.0)  # scale factors, times a power of ten
DEGREE_SCALES = (1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0)
TICK_STEPS = (1.0, 2.0, 5.0, 10.0)  # steps between numbers on an axis, times a power of ten
ANGLE_STEPS = (1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 45.0, 60.0, 90.0, 180.0, 360.0)  # the same for angles
EQUAL_WITHIN = 1e-9  # relative: values that differ by less are equal
MOST_DECADES = 12  # on a logarithmic axis; smaller values are drawn at its end


@dataclass(frozen=True)
class ChartAxis:
    """A horizontal or vertical axis of a chart.

    Attributes:
        low: value at the start of the axis; for a logarithmic axis, its decimal logarithm.
        mu: units per mm; for a logarithmic axis, powers of ten per mm.
        start: position of the start of the axis on paper, mm.
        length: length of the axis, mm.
        logarithmic: True for a logarithmic axis.
        degrees: True if the values are angles. The numbers on the axis are then multiples of 15, 30, 45, ... degrees.
    """

    low: float
    mu: float
    start: float
    length: float
    logarithmic: bool = False
    degrees: bool = False

    @property
    def high(self) -> float:
        return self.low + self.mu * self.length

    @property
    def end(self) -> float:
        """Position of the end of the axis on paper, mm."""
        return self.start + self.length

    def on(self, values: Any) -> NDArray[Any]:
        """Convert values to positions along the axis, mm.

        Values too small for a logarithmic axis are placed at its start.
        """
        scaled = np.asarray(values, dtype=float)
        if self.logarithmic:
            with np.errstate(divide="ignore", invalid="ignore"):
                scaled = np.maximum(np.log10(scaled), self.low)
        return self.start + (scaled - self.low) / self.mu

    def ticks(self, apart: float) -> list[tuple[float, str]]:
        """Return the round values at which the axis has numbers, at least `apart` mm apart, with their texts."""
        step = max(1.0, math.ceil(apart * self.mu)) if self.logarithmic else self._step(apart * self.mu)
        first, last = math.ceil(self.low / step - EQUAL_WITHIN), math.floor(self.high / step + EQUAL_WITHIN)
        values = [k * step for k in range(first, last + 1)]
        if self.logarithmic:
            return [(10.0**value, f"1e{value:.0f}" if value else "1") for value in values]
        return [(value, numeral(value, ".10g")) for value in values]

    def _step(self, least: float) -> float:
        if self.degrees and 1 <= least <= ANGLE_STEPS[-1]:
            return next(step for step in ANGLE_STEPS if step >= least * (1 - EQUAL_WITHIN))
        return round_up(least, TICK_STEPS)


def round_up(least: float, steps: Sequence[float] = ROUND_SCALES) -> float:
    """Return the smallest round number that is not less than `least`: one of `steps` times a power of ten."""
    power = 10.0 ** math.floor(math.log10(least))
    return next(step for step in steps if step * power >= least * (1 - EQUAL_WITHIN)) * power


def finite_limits(values: Sequence[Any]) -> tuple[float, float]:
    """Return the smallest and the largest finite value; (0, 1) if no value is finite."""
    joined = np.concatenate([np.zeros(0), *(np.ravel(np.asarray(v, dtype=float)) for v in values)])
    joined = joined[np.isfinite(joined)]
    return (float(joined.min()), float(joined.max())) if joined.size else (0.0, 1.0)


def filling_axis(low: float, high: float, start: float, length: float) -> ChartAxis:
    """Return an axis from `low` to `high` that is exactly `length` mm long.

    Its scale is therefore usually not round.
    """
    return ChartAxis(low, (high - low) / length, start, length)


def round_axis(low: float, high: float, start: float, most: float, *, degrees: bool = False) -> ChartAxis:
    """Return an axis from `low` to `high` at the largest round scale at which it is no longer than `most` mm."""
    low, high = _widen_range(low, high)
    mu = round_up((high - low) / most, DEGREE_SCALES if degrees else ROUND_SCALES)
    return ChartAxis(low, mu, start, (high - low) / mu, degrees=degrees)


def vertical_axis(
    low: float, high: float, start: float, length: float, *, degrees: bool = False, air: float = 2.0
) -> ChartAxis:
    """Return an axis of this length at a round scale, with at least `air` mm free above and below the values.

    It includes zero unless the values are far from zero. If all values have the same sign, it begins or ends at zero.
    """
    low, high = _widen_range(low, high)
    if max(abs(low), abs(high)) < 2 * (high - low):
        low, high = min(low, 0.0), max(high, 0.0)
    mu = round_up((high - low) / (length - 2 * air), ROUND_SCALES)
    spare = mu * length - (high - low)
    below = 0.0 if low == 0 else spare if high == 0 else spare / 2
    return ChartAxis(low - below, mu, start, length, degrees=degrees)


def logarithmic_axis(low: float, high: float, start: float, length: float) -> ChartAxis:
    """Return a logarithmic axis from one power of ten to another, for values from `low` to `high`."""
    most = math.ceil(math.log10(high)) if high > 0 else 0
    least = math.floor(math.log10(low)) if low > 0 else most - MOST_DECADES
    least = max(min(least, most - 1), most - MOST_DECADES)
    return ChartAxis(least, (most - least) / length, start, length, logarithmic=True)


def equal_scales(axes: tuple[ChartAxis, ChartAxis], ends: Sequence[tuple[float, float]]) -> tuple[ChartAxis, ChartAxis]:
    """Give two axes the same round scale.

    ends: smallest and largest value to be shown on each axis; this range is placed in the middle of the axis.
    """
    spans = [_widen_range(*limits) for limits in ends]
    mu = round_up(max((high - low) / axis.length for axis, (low, high) in zip(axes, spans, strict=True)))
    first_axis, other = (
        replace(axis, low=(low + high - mu * axis.length) / 2, mu=mu)
        for axis, (low, high) in zip(axes, spans, strict=True)
    )
    return first_axis, other


def _widen_range(low: float, high: float) -> tuple[float, float]:
    """Return a range unchanged; if its ends coincide, return a range around their common value."""
    if high - low > EQUAL_WITHIN * max(abs(low), abs(high)):
        return low, high
    half = abs(low) / 2 or 0.5
    return low - half, high + half


# Charts on a sheet: panels one above another over one axis, with grids, curves, numbers of positions, legends.


GRID_COLOUR = "#dcdcdc"  # of grids
SCALE_COLOUR = "#505050"  # of scales and numbers of positions
SMALL_TEXT, PLAIN_TEXT = 8.0, 9.0  # points
LEFT_MARGIN, RIGHT_MARGIN = 17.0, 6.0  # mm on both sides of the panels, for the numbers on their axes
TEXT_ROW = 4.5  # mm: line spacing
LEGEND_SAMPLE = 8.0  # mm of a curve in a legend
LEGEND_GAP = 5.0  # mm between entries of a legend
NUMBER_GAPS = (11.0, 6.0)  # mm between numbers on an axis, across and upwards
DOT_RADIUS = 0.55  # mm: radius
LEAST_PANEL_HEIGHT = 12.0  # mm: least height of a panel
LABEL_SAMPLING = 8  # every eighth point of a curve keeps labels off it


@dataclass(frozen=True)
class ChartCurve:
    """A curve of a chart.

    Attributes:
        xs: values on the common axis.
        ys: values on the axis of the panel; the curve is interrupted where they are not finite.
        label: name in the legend.
        colour: colour of the line.
        style: style of the line.
        width: width of the line, points.
        dots: True if the values are drawn as dots instead of a line.
    """

    xs: Any
    ys: Any
    label: str = ""
    colour: str = DARK_COLOUR
    style: Style = "-"
    width: float = 1.3
    dots: bool = False


@dataclass(frozen=True)
class CurveJump:
    """Discontinuity of a curve.

    It contains the value on the common axis, the values of the curve before and after the jump, and their labels.
    """

    at: float
    values: tuple[float, float]
    texts: tuple[str, str]
    colour: str = DARK_COLOUR


@dataclass(frozen=True)
class PlotContent:
    """Content of one panel of a chart.

    Attributes:
        words: title with the unit.
        curves: curves.
        jumps: discontinuities of the curves.
        scale: function that returns the text for the scale factor (units per mm) of the vertical axis; None: no text.
        share: height of the panel relative to the other panels.
        degrees: True if the values are angles in degrees.
        logarithmic: True if the vertical axis is logarithmic.
    """

    words: str
    curves: Sequence[ChartCurve]
    jumps: Sequence[CurveJump] = ()
    scale: Callable[[float], Words] | None = None
    share: float = 1.0
    degrees: bool = False
    logarithmic: bool = False

    @property
    def legend(self) -> list[ChartCurve]:
        """Curves that are listed in the legend: those with a name. There are none if the panel has only one curve."""
        named = [curve for curve in self.curves if curve.label]
        return named if len(self.curves) > 1 else []


@dataclass(frozen=True)
class CommonAxis:
    """The horizontal axis that all panels of a chart share.

    Attributes:
        axis: scale and position of the axis.
        words: title with the unit.
        numbers: value on the axis and number of each computed position.
        spans: named intervals of the axis, e.g. strokes, as (start, end, name).
    """

    axis: ChartAxis
    words: Words
    numbers: Sequence[tuple[float, str]] = ()
    spans: Sequence[tuple[float, float, str]] = ()


def axis_extent(sheet: DrawingSheet) -> tuple[float, float]:
    """Return the start of the horizontal axis of charts on a sheet, and its greatest possible length, mm."""
    start = sheet.canvas.low.real + LEFT_MARGIN
    return start, sheet.canvas.high.real - RIGHT_MARGIN - start


def count_fitting(sheet: DrawingSheet, plots: Sequence[PlotContent], over: CommonAxis) -> int:
    """Return how many panels of a chart, counted from the first one, fit on a sheet. The result is at least 1."""
    needed = np.cumsum([TEXT_ROW * len(_legend_rows(plot, over.axis.length)) for plot in plots])
    free = [_height_for_panels(sheet, over, count) for count in range(1, len(plots) + 1)]
    return max(1, int(np.count_nonzero(needed <= free)))


def _height_for_panels(sheet: DrawingSheet, over: CommonAxis, count: int) -> float:
    """Return the height (mm) left on the sheet for titles and legends if `count` panels have their smallest height."""
    beside = (2 + bool(over.spans)) * TEXT_ROW
    return float((sheet.canvas.high - sheet.canvas.low).imag - beside - count * (_panel_gap(over) + LEAST_PANEL_HEIGHT))


def _panel_gap(over: CommonAxis) -> float:
    """Return the distance (mm) between a panel and the title of the panel below it."""
    return 0.3 * TEXT_ROW + (TEXT_ROW if over.numbers else 0.6 * TEXT_ROW)


def draw_chart(
    sheet: DrawingSheet, plots: Sequence[PlotContent], over: CommonAxis, *, same_scale: bool = False
) -> list[Panel]:
    """Draw panels above one another, as high as the sheet permits.

    If the sheet is too low for all legends, the last entries are omitted.

    Args:
        sheet: sheet to draw on.
        plots: contents of the panels, from the top down.
        over: the horizontal axis.
        same_scale: use the same scale for both axes of a single panel.

    Returns:
        The panels.
    """
    start, most = axis_extent(sheet)
    x = replace(over.axis, start=start + (most - over.axis.length) / 2)
    top = sheet.canvas.high.imag - (TEXT_ROW if over.spans else 0.0)
    under = _panel_gap(over) - 0.3 * TEXT_ROW
    low = sheet.canvas.low.imag + 2 * TEXT_ROW
    heads = [_legend_rows(plot, x.length) for plot in plots]
    allowed = _height_for_panels(sheet, over, len(plots)) / TEXT_ROW
    if sum(map(len, heads)) > allowed:
        heads = [rows[: max(1, int(allowed / len(plots)))] for rows in heads]
    free = top - low - sum(TEXT_ROW * (len(rows) + 0.3) + under for rows in heads)
    panels = []
    for plot, rows in zip(plots, heads, strict=True):
        height = free * plot.share / sum(p.share for p in plots)
        bottom = top - TEXT_ROW * (len(rows) + 0.3) - height
        axes = x, _plot_axis(plot, bottom, height)
        if same_scale:
            axes = equal_scales(
                axes, [finite_limits([getattr(c, coordinate) for c in plot.curves]) for coordinate in ("xs", "ys")]
            )
        panel = Panel(sheet, *axes)
        panel.grid()
        _write_head(panel, plot, rows, top)
        panel.fill(plot)
        panel.positions(over.numbers)
        panels.append(panel)
        top = bottom - under
    last = panels[-1]
    last.numbers_across(under)
    middle = complex(last.x.start + last.x.length / 2, sheet.canvas.low.imag + 1.5)
    sheet.text(middle, over.words, PLAIN_TEXT, ha="center")
    _draw_spans(panels, over.spans, sheet.canvas.high.imag - 1.5)
    return panels


@dataclass(frozen=True)
class Panel:
    """A panel of a chart, with its horizontal and vertical axes."""

    sheet: DrawingSheet
    x: ChartAxis
    y: ChartAxis

    def at(self, x: Any, y: Any) -> NDArray[Any]:
        """Convert values on both axes to points on paper, mm."""
        return self.x.on(x) + 1j * self.y.on(y)

    def line(self, start: complex, end: complex, colour: str, width: float, style: Style = "-", z: float = 1.0) -> None:
        """Draw a line in the panel.

        Labels do not cover a line above the grid (z > 1). Other lines are interrupted where a label covers them.
        """
        self.sheet.line([start, end], colour, width, style, z, faint=z <= 1)

    def upright(self, place: float, colour: str, width: float, style: Style = "-", z: float = 1.0) -> None:
        """Draw a vertical line through the panel, `place` mm from the left edge of the paper."""
        self.line(complex(place, self.y.start), complex(place, self.y.end), colour, width, style, z)

    def level(self, place: float, colour: str, width: float, z: float) -> None:
        """Draw a horizontal line through the panel, `place` mm from the lower edge of the paper."""
        self.line(complex(self.x.start, place), complex(self.x.end, place), colour, width, z=z)

    def text(
        self, at: complex, text: Words, ha: Align = "left", size: float = SMALL_TEXT, colour: str = DARK_COLOUR
    ) -> None:
        self.sheet.text(at, text, size, ha=ha, colour=colour)

    def grid(self, across: bool = True) -> None:
        """Draw the grid, the numbers of the vertical axis, the border and the zero line."""
        for value, __ in self.x.ticks(NUMBER_GAPS[0]) if across else ():
            self.upright(float(self.x.on(value)), GRID_COLOUR, 0.5, z=0.5)
        for value, text in self.y.ticks(NUMBER_GAPS[1]):
            height = float(self.y.on(value))
            self.level(height, GRID_COLOUR, 0.5, z=0.5)
            self.text(complex(self.x.start - 1.5, height), text, "right")
        for place in (self.x.start, self.x.end):
            self.upright(place, THIN_COLOUR, 0.6)
        for place in (self.y.start, self.y.end):
            self.level(place, THIN_COLOUR, 0.6, 1)
        if not self.y.logarithmic and self.y.low <= 0 <= self.y.high:
            self.level(float(self.y.on(0.0)), DARK_COLOUR, 0.7, z=1.5)

    def numbers_across(self, under: float) -> None:
        """Write the numbers of the horizontal axis `under` mm below the panel."""
        for value, text in self.x.ticks(NUMBER_GAPS[0]):
            self.text(complex(float(self.x.on(value)), self.y.start - under - 0.5 * TEXT_ROW), text, "center")

    def positions(self, numbers: Sequence[tuple[float, str]]) -> None:
        """Mark the computed positions of the mechanism on the horizontal axis with short lines and numbers.

        If there are too many numbers, only every second, fifth or tenth position is marked.

        numbers: value on the axis and number of each position.
        """
        widest = max((width_of(text, SMALL_TEXT * POINT) for __, text in numbers), default=0.0)
        crowd = len(numbers) * (widest + 2) / self.x.length
        for value, text in numbers[:: max(1, round(round_up(crowd, TICK_STEPS)))] if numbers else ():
            place = float(self.x.on(value))
            self.line(complex(place, self.y.start), complex(place, self.y.start - 0.8), DARK_COLOUR, 0.6)
            self.text(complex(place, self.y.start - 0.65 * TEXT_ROW), text, "center", SMALL_TEXT, SCALE_COLOUR)

    def fill(self, plot: PlotContent) -> None:
        """Draw the curves and their discontinuities."""
        for curve in plot.curves:
            points = self.at(curve.xs, curve.ys)
            if curve.dots:
                for place in np.atleast_1d(points):
                    self.sheet.circle(complex(place), DOT_RADIUS, curve.colour, curve.colour, 0.3, 4)
                continue
            self.sheet.line(points.tolist(), curve.colour, curve.width, curve.style, blocks=False)
            if plot.jumps:
                kept = points[np.isfinite(points)][::LABEL_SAMPLING].tolist()
                for start, end in pairwise(kept):
                    self.sheet.canvas.line(start, end)
        for jump in plot.jumps:
            for value, text in zip(jump.values, jump.texts, strict=True):
                place = complex(self.at(jump.at, value))
                self.sheet.circle(place, DOT_RADIUS, "white", jump.colour, 0.7, 4.5)
                if text:
                    self.sheet.label(text, place, SMALL_TEXT, jump.colour)


def _plot_axis(plot: PlotContent, bottom: float, height: float) -> ChartAxis:
    values = [curve.ys for curve in plot.curves]
    if not plot.logarithmic:
        return vertical_axis(*finite_limits(values), bottom, height, degrees=plot.degrees)
    above_zero = [np.where(np.asarray(v) > 0, v, np.nan) for v in values]
    return logarithmic_axis(*finite_limits(above_zero), bottom, height)


def _legend_width(curve: ChartCurve) -> float:
    return LEGEND_SAMPLE + 1 + width_of(curve.label, SMALL_TEXT * POINT) + LEGEND_GAP


def _legend_rows(plot: PlotContent, most: float) -> list[list[ChartCurve]]:
    """Distribute the legend entries over rows above a panel. The first row also contains the title."""
    words = (plot.words, *(split_symbols(plot.scale(0.00025)) if plot.scale else ()))
    rows: list[list[ChartCurve]] = [[]]
    if sum(map(_legend_width, plot.legend)) < most - width_of_words(words, PLAIN_TEXT * POINT) - 2 * LEGEND_GAP:
        return [list(plot.legend)]
    left = 0.0
    for curve in plot.legend:
        if _legend_width(curve) > left:
            rows.append([])
            left = most
        rows[-1].append(curve)
        left -= _legend_width(curve)
    return rows


def _write_head(panel: Panel, plot: PlotContent, rows: Sequence[Iterable[ChartCurve]], top: float) -> None:
    """Write the title, the scale factor and the legend of a panel above it."""
    at = complex(panel.x.start, top - TEXT_ROW / 2)
    panel.text(at, plot.words, size=PLAIN_TEXT)
    if plot.scale is not None:
        after = at + width_of(plot.words, PLAIN_TEXT * POINT) + LEGEND_GAP
        panel.text(after, plot.scale(panel.y.mu), colour=SCALE_COLOUR)
    for number, row in enumerate(rows):
        entries = list(row)
        place = complex(panel.x.end - sum(map(_legend_width, entries)) + LEGEND_GAP, top - TEXT_ROW * (number + 0.5))
        place = place if number == 0 else complex(panel.x.start, place.imag)
        for curve in entries:
            if curve.dots:
                panel.sheet.circle(place + LEGEND_SAMPLE - 2, DOT_RADIUS, curve.colour, curve.colour, 0.3, 4)
            else:
                panel.line(place, place + LEGEND_SAMPLE, curve.colour, curve.width, curve.style)
            panel.text(place + LEGEND_SAMPLE + 1, curve.label)
            place += _legend_width(curve)


def _draw_spans(panels: Sequence[Panel], spans: Sequence[tuple[float, float, str]], height: float) -> None:
    """Draw the bounds of named intervals through all panels, and their names between arrows above the first panel."""
    if not spans:
        return
    first = panels[0]
    for panel in panels:
        for value in {end for span in spans for end in span[:2]}:
            place = float(panel.x.on(value))
            if panel.x.start + 0.1 < place < panel.x.end - 0.1:
                panel.upright(place, DARK_COLOUR, 0.6, "-.", 2)
    for start, end, text in spans:
        low, high = float(first.x.on(start)), float(first.x.on(end))
        half = width_of(text, SMALL_TEXT * POINT) / 2 + 1
        if high - low < 2 * half:
            continue
        middle = complex((low + high) / 2, height)
        first.text(middle, text, "center")
        for side, place in ((-1, low), (1, high)):
            first.line(complex(place, height - 1.2), complex(place, height + 1.2), DARK_COLOUR, 0.6)
            if abs(place - middle.real) - half > 3:
                tip = complex(place, height)
                first.line(middle + side * half, tip, THIN_COLOUR, 0.6)
                first.sheet.area(
                    [tip, tip - side * 2 + 0.4j, tip - side * 2 - 0.4j], THIN_COLOUR, "none", z=1, blocks=False
                )
