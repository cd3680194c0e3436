"""Diagrams of a sweep: curves over one parameter, contour lines over two. Infeasible regions are hatched."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from tmm_cli.drawing.paper import (
    DARK_COLOUR,
    INERTIA_COLOUR,
    LEFT_MARGIN,
    LOAD_COLOUR,
    PLAIN_TEXT,
    POINT,
    RIGHT_MARGIN,
    SMALL_TEXT,
    TEXT_ROW,
    THIN_COLOUR,
    TICK_STEPS,
    ChartCurve,
    CommonAxis,
    Drawing,
    DrawingSheet,
    Panel,
    PlotContent,
    Style,
    axis_extent,
    contour_lines,
    draw_chart,
    file_safe_name,
    filling_axis,
    finite_limits,
    hatch_polygons,
    region_borders,
    region_polygons,
    round_up,
    text_width,
    with_unit,
)
from tmm_cli.language import _, numeral, spelt, translated
from tmm_cli.mechanics.numerics import Real
from tmm_cli.mechanics.plans import LANDSCAPE
from tmm_cli.mechanics.quantities import ANGLE
from tmm_cli.problem import UnitSystem, typeset_unit
from tmm_cli.sweep.options import ShownQuantity, SweepAxis
from tmm_cli.sweep.results import LIMIT, STATE_WORDS, STOPS, WORKS, Border, SweepResults

PANELS = 4  # per sheet
LEVELS = 12  # largest number of contour lines
MOST_NODES = 150  # grid nodes drawn in each direction; of a finer grid a part
PITCH = {True: 1.8, False: 3.2}  # mm of hatching: no mechanism, limit exceeded
COLOURS = {True: THIN_COLOUR, False: "#e3b27a"}
LABELLED_BORDERS = 5  # borders that are labelled
SAMPLE = 6.0  # mm: size of a field in the legend
LEAST = 15.0  # mm: length of a line that is labelled


def sweep_sheets(title: str, sweep: SweepResults, units: UnitSystem) -> Iterable[tuple[str, Drawing]]:
    """Yield the drawings of a sweep, as (stem of the file name, drawing)."""
    if len(sweep.axes) == 1:
        parts = [range(first, min(first + PANELS, len(sweep.shown))) for first in range(0, len(sweep.shown), PANELS)]
        for number, panels in enumerate(parts):
            yield (f"sweep-{number + 1}" if len(parts) > 1 else "sweep"), curve_sheet(title, sweep, panels, units)
        return
    for k, quantity in enumerate(sweep.shown):
        if np.any(np.isfinite(sweep.values[:, k])):
            yield f"sweep-{file_safe_name(quantity.name)}", contour_sheet(title, sweep, k, units)


def curve_sheet(title: str, sweep: SweepResults, indices: Sequence[int], units: UnitSystem) -> Drawing:
    """Draw some of the requested quantities over one parameter, each in a panel of its own.

    indices: indices of these quantities in `sweep.shown`.
    """
    (axis,) = sweep.axes
    caption = _(
        "Quantities as functions of {parameter}; dense hatching: mechanism does not exist; wide hatching: "
        "limit exceeded"
    )
    sheet = DrawingSheet(title, caption.format(parameter=axis.name), paper=LANDSCAPE)
    start, most = axis_extent(sheet)
    over = filling_axis(float(axis.values[0]), float(axis.values[-1]), start, most)
    plots = []
    for k in indices:
        quantity = sweep.shown[k]
        values = sweep.values[:, k] / units.factor(quantity.dimension)
        plots.append(
            PlotContent(
                _quantity_label(quantity, units),
                [ChartCurve(axis.values, values)],
                degrees=_in_degrees(quantity, units),
            )
        )
    ends = [float(axis.values[0]), *(mark.at[0] for mark in sweep.marks), float(axis.values[-1])]
    states = [*(mark.before for mark in sweep.marks), int(sweep.state[-1])]
    spans = [(low, high, translated(STATE_WORDS[n])) for (low, high), n in zip(pairwise(ends), states, strict=True)]
    panels = draw_chart(sheet, plots, CommonAxis(over, _axis_label(axis), spans=spans if sweep.marks else ()))
    for panel, plot in zip(panels, plots, strict=True):
        for curve in plot.curves:
            sheet.canvas.path(panel.at(curve.xs, curve.ys)[:: max(1, len(curve.xs) // 200)].tolist())
        for (low, high), n in zip(pairwise(ends), states, strict=True):
            if n >= LIMIT:
                _hatch_interval(panel, low, high, fails=n >= STOPS)
    for mark in sweep.marks[:LABELLED_BORDERS]:
        _label_border(panels[0], axis, mark)
    return sheet.finish()


def _hatch_interval(panel: Panel, low: float, high: float, *, fails: bool) -> None:
    """Hatch an interval of the parameter in a panel.

    Hatching is dense where no mechanism exists (`fails`), and wide where a limit is exceeded.
    """
    left, right = (float(panel.x.on(value)) for value in (low, high))
    corners = [
        complex(left, panel.y.start),
        complex(right, panel.y.start),
        complex(right, panel.y.end),
        complex(left, panel.y.end),
    ]
    for start, end in hatch_polygons([corners], PITCH[fails]):
        panel.sheet.line([start, end], COLOURS[fails], 0.4, z=0.4, blocks=False)


def _label_border(panel: Panel, axis: SweepAxis, mark: Border) -> None:
    """Label a boundary between states with the value of the parameter."""
    place = float(panel.x.on(mark.at[0]))
    text = f"{numeral(mark.at[0], '.6g')} {spelt(axis.unit)}".strip()
    panel.sheet.label(text, complex(place, panel.y.end - TEXT_ROW), SMALL_TEXT, DARK_COLOUR)


def contour_sheet(title: str, sweep: SweepResults, k: int, units: UnitSystem) -> Drawing:
    """Draw contour lines of the quantity with index k over two parameters."""
    quantity = sweep.shown[k]
    caption = _("{quantity}: contour lines over two parameters").format(quantity=_quantity_label(quantity, units))
    sheet = DrawingSheet(title, caption, paper=LANDSCAPE)
    low, high = sheet.canvas.low, sheet.canvas.high
    across, up = sweep.axes
    x = filling_axis(
        float(across.values[0]),
        float(across.values[-1]),
        low.real + LEFT_MARGIN,
        (high - low).real - LEFT_MARGIN - RIGHT_MARGIN,
    )
    bottom = low.imag + 2.6 * TEXT_ROW
    y = filling_axis(float(up.values[0]), float(up.values[-1]), bottom, high.imag - 1.6 * TEXT_ROW - bottom)
    panel = Panel(sheet, x, y)
    panel.grid()
    panel.numbers_across(0.2 * TEXT_ROW)
    sheet.text(complex((x.start + x.end) / 2, low.imag + 1.5), _axis_label(across), PLAIN_TEXT, ha="center")
    sheet.text(complex(low.real, high.imag - TEXT_ROW / 2), _axis_label(up), PLAIN_TEXT)
    columns, rows = (_select_nodes(len(axis.values)) for axis in sweep.axes)
    values = (sweep.values[:, k] / units.factor(quantity.dimension)).reshape(sweep.shape)[np.ix_(columns, rows)]
    state = sweep.state.reshape(sweep.shape)[np.ix_(columns, rows)]
    lines = _Grid(panel, sweep, (columns, rows))
    drawn = [
        (fails, name)
        for fails, name in ((True, _("mechanism does not exist")), (False, _("limit exceeded")))
        if np.any((state >= STOPS) if fails else (state == LIMIT))
    ]
    for fails, __ in drawn:
        lines.draw_region(state, fails=fails)
    _draw_contour_lines(lines, values, degrees=_in_degrees(quantity, units))
    _draw_legend(panel, drawn)
    return sheet.finish()


def _select_nodes(count: int) -> Real:
    """Return the indices of the parameter values that are drawn: at most MOST_NODES, evenly chosen, with both ends."""
    return np.unique(np.round(np.linspace(0, count - 1, min(count, MOST_NODES))).astype(int))


class _Grid:
    """Grid of a sweep over two parameters, drawn in a panel.

    drawn: indices of the parameter values that are drawn, one array for each parameter.
    """

    def __init__(self, panel: Panel, sweep: SweepResults, drawn: Sequence[Real]) -> None:
        self.panel = panel
        axes = [axis.values[nodes] for axis, nodes in zip(sweep.axes, drawn, strict=True)]
        self.x, self.y = axes
        self.marks: dict[tuple[int, int], list[float]] = {}  # by the parameter and the line along which they lie
        for mark in sweep.marks:
            across = 1 - mark.along
            line = int(np.argmin(np.abs(axes[across] - mark.at[across])))
            if axes[across][line] == mark.at[across]:
                self.marks.setdefault((mark.along, line), []).append(mark.at[mark.along])

    def on(self, nodes: Any) -> Any:
        """Convert grid coordinates, column + i row, to points on paper, mm."""
        grid = np.asarray(nodes)
        x = np.interp(grid.real, np.arange(len(self.x)), self.x)
        y = np.interp(grid.imag, np.arange(len(self.y)), self.y)
        return self.panel.at(x, y)

    def border_fraction(self, start: tuple[int, int], end: tuple[int, int]) -> float:
        """Return where the boundary of a region crosses a grid edge, as a fraction of its length.

        The result is 0.5 if the point of intersection was not computed.
        """
        along = 0 if start[0] != end[0] else 1
        values = (self.x, self.y)[along]
        low, high = float(values[start[along]]), float(values[end[along]])
        borders = [at for at in self.marks.get((along, start[1 - along]), ()) if low <= at <= high]
        return (borders[0] - low) / (high - low) if borders else 0.5

    def draw_region(self, state: Any, *, fails: bool) -> None:
        """Hatch and outline the region without a mechanism (`fails`), or the region where a limit is exceeded."""
        inside, outline = (state >= STOPS, state >= STOPS) if fails else (state == LIMIT, state != WORKS)
        pieces = [self.on(piece).tolist() for piece in region_polygons(inside, self.border_fraction)]
        for start, end in hatch_polygons(pieces, PITCH[fails]):
            self.panel.sheet.line([start, end], COLOURS[fails], 0.4, z=0.4, faint=True)
        style: Style = "-" if fails else "--"
        colour, z = (DARK_COLOUR, 2.5) if fails else (LOAD_COLOUR, 2.4)
        for line in region_borders(outline, self.border_fraction):
            self.panel.sheet.line(self.on(line).tolist(), colour, 1.1 if fails else 0.9, style, z, blocks=False)


def _draw_contour_lines(lines: _Grid, values: Any, *, degrees: bool) -> None:
    """Draw contour lines at round values and write each value on its longest line."""
    low, high = finite_limits([values])
    if not high > low:
        return
    sheet = lines.panel.sheet
    step = round_up((high - low) / LEVELS, TICK_STEPS)
    for n in range(int(np.ceil(low / step)), int(np.floor(high / step)) + 1):
        contours = [lines.on(line) for line in contour_lines(values, n * step)]
        lengths = [float(np.sum(np.abs(np.diff(line)))) for line in contours]
        for line in contours:
            sheet.line(line.tolist(), INERTIA_COLOUR, 0.9, z=2, faint=True)
        if contours and max(lengths) > LEAST:
            line = contours[int(np.argmax(lengths))]
            k = len(line) // 2
            text = numeral(n * step, ".10g") + ("°" if degrees else "")
            sheet.text(complex(line[k]), text, SMALL_TEXT, colour=INERTIA_COLOUR, ha="center")


def _draw_legend(panel: Panel, drawn: Sequence[tuple[bool, str]]) -> None:
    """Draw a legend of the kinds of hatching above the panel, on the right."""
    at = panel.x.end - sum(SAMPLE + 5 + text_width(text, SMALL_TEXT * POINT) for __, text in drawn)
    height = panel.sheet.canvas.high.imag - TEXT_ROW / 2
    for fails, text in drawn:
        field = [
            complex(at, height - 1.3),
            complex(at + SAMPLE, height - 1.3),
            complex(at + SAMPLE, height + 1.3),
            complex(at, height + 1.3),
        ]
        for start, end in hatch_polygons([field], PITCH[fails] / 1.5):
            panel.sheet.line([start, end], COLOURS[fails], 0.4, z=0.4, blocks=False)
        panel.sheet.line([*field, field[0]], DARK_COLOUR, 0.5, blocks=False)
        panel.text(complex(at + SAMPLE + 1.5, height), text)
        at += SAMPLE + 5 + text_width(text, SMALL_TEXT * POINT)


def _in_degrees(quantity: ShownQuantity, units: UnitSystem) -> bool:
    return quantity.dimension == ANGLE and units.symbol(ANGLE) == "deg"


def _quantity_label(quantity: ShownQuantity, units: UnitSystem) -> str:
    return with_unit(quantity.words, quantity.dimension, units)


def _axis_label(axis: SweepAxis) -> str:
    return f"{axis.name}, {typeset_unit(spelt(axis.unit))}" if axis.unit else axis.name
