"""Charts on a sheet: panels one above another over one axis, with grids, curves, numbers of positions, legends."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tmm_cli.draw.paper.axes import TICKS, Axis, decades, equal, limits, round_up, upwards
from tmm_cli.draw.paper.drawing import POINT, Align, Style
from tmm_cli.draw.paper.fonts import width as width_of
from tmm_cli.draw.paper.script import Words, parts
from tmm_cli.draw.paper.script import width as width_of_words
from tmm_cli.draw.paper.sheet import DARK, THIN, Sheet

FINE = "#dcdcdc"  # of grids
SOFT = "#505050"  # of scales and numbers of positions
SMALL, PLAIN = 8.0, 9.0  # points
LEFT, RIGHT = 17.0, 6.0  # mm beside the panels, for numbers on their axes
ROW = 4.5  # mm from a line of text to the next
SAMPLE = 8.0  # mm of a curve in a legend
APART = 5.0  # mm between entries of a legend
EVERY = (11.0, 6.0)  # mm between numbers on an axis, across and upwards
DOT = 0.55  # mm: radius
LOWEST = 12.0  # mm: least height of a panel
KEPT = 8  # of so many places of a curve one keeps labels off it


@dataclass(frozen=True)
class Curve:
    """Values over those of the common axis; those that are not finite interrupt it. dots: drawn as single points."""

    xs: Any
    ys: Any
    label: str = ""
    colour: str = DARK
    style: Style = "-"
    width: float = 1.3
    dots: bool = False


@dataclass(frozen=True)
class Jump:
    """A place of the common axis at which a curve leaps from a value to another, as they are written."""

    at: float
    values: tuple[float, float]
    texts: tuple[str, str]
    colour: str = DARK


@dataclass(frozen=True)
class Plot:
    """What a panel shows. scale: how the scale of its axis is written, from mu; share: of the height."""

    words: str
    curves: Sequence[Curve]
    jumps: Sequence[Jump] = ()
    scale: Callable[[float], Words] | None = None
    share: float = 1.0
    degrees: bool = False
    logarithmic: bool = False

    @property
    def legend(self) -> list[Curve]:
        """Curves that have a name, where it tells anything."""
        named = [curve for curve in self.curves if curve.label]
        return named if len(self.curves) > 1 else []


@dataclass(frozen=True)
class Across:
    """The common axis. numbers: of positions, by their places; spans: stretches that have a name."""

    axis: Axis
    words: Words
    numbers: Sequence[tuple[float, str]] = ()
    spans: Sequence[tuple[float, float, str]] = ()


def room(sheet: Sheet) -> tuple[float, float]:
    """Where the common axis may begin, and how long it may be, mm."""
    start = sheet.ground.low.real + LEFT
    return start, sheet.ground.high.real - RIGHT - start


def count_fitting(sheet: Sheet, plots: Sequence[Plot], over: Across) -> int:
    """Return how many of the panels, from the first one on, fit on the sheet with a height of at least LOWEST mm."""
    needed = np.cumsum([ROW * len(_head(plot, over.axis.length)) for plot in plots])
    free = [_height_for_panels(sheet, over, count) for count in range(1, len(plots) + 1)]
    return max(1, int(np.count_nonzero(needed <= free)))


def _height_for_panels(sheet: Sheet, over: Across, count: int) -> float:
    """The height (mm) that so many panels of LOWEST mm leave for their heads."""
    beside = (2 + bool(over.spans)) * ROW
    return float((sheet.ground.high - sheet.ground.low).imag - beside - count * (_between(over) + LOWEST))


def _between(over: Across) -> float:
    """The height (mm) between a panel and the head of the next one."""
    return 0.3 * ROW + (ROW if over.numbers else 0.6 * ROW)


def chart(sheet: Sheet, plots: Sequence[Plot], over: Across, *, same_scale: bool = False) -> list[Panel]:
    """Panels one above another, as high as the sheet leaves room for. same_scale: of a single panel's two axes.

    Entries of legends for which the sheet is too low are left out.
    """
    start, most = room(sheet)
    x = replace(over.axis, start=start + (most - over.axis.length) / 2)
    top = sheet.ground.high.imag - (ROW if over.spans else 0.0)
    under = _between(over) - 0.3 * ROW
    low = sheet.ground.low.imag + 2 * ROW
    heads = [_head(plot, x.length) for plot in plots]
    allowed = _height_for_panels(sheet, over, len(plots)) / ROW
    if sum(map(len, heads)) > allowed:
        heads = [rows[: max(1, int(allowed / len(plots)))] for rows in heads]
    free = top - low - sum(ROW * (len(rows) + 0.3) + under for rows in heads)
    panels = []
    for plot, rows in zip(plots, heads, strict=True):
        height = free * plot.share / sum(p.share for p in plots)
        bottom = top - ROW * (len(rows) + 0.3) - height
        axes = x, _axis(plot, bottom, height)
        if same_scale:
            axes = equal(axes, [limits([getattr(c, way) for c in plot.curves]) for way in ("xs", "ys")])
        panel = Panel(sheet, *axes)
        panel.grid()
        _write_head(panel, plot, rows, top)
        panel.fill(plot)
        panel.positions(over.numbers)
        panels.append(panel)
        top = bottom - under
    last = panels[-1]
    last.numbers_across(under)
    middle = complex(last.x.start + last.x.length / 2, sheet.ground.low.imag + 1.5)
    sheet.text(middle, over.words, PLAIN, ha="center")
    _spans(panels, over.spans, sheet.ground.high.imag - 1.5)
    return panels


@dataclass(frozen=True)
class Panel:
    """A field of a sheet with its two axes."""

    sheet: Sheet
    x: Axis
    y: Axis

    def at(self, x: Any, y: Any) -> NDArray[Any]:
        """Places of values on paper, mm."""
        return self.x.on(x) + 1j * self.y.on(y)

    def line(self, start: complex, end: complex, colour: str, width: float, style: Style = "-", z: float = 1.0) -> None:
        """A line; one that lies above the grid keeps labels off, others are interrupted under them."""
        self.sheet.line([start, end], colour, width, style, z, faint=z <= 1)

    def upright(self, place: float, colour: str, width: float, style: Style = "-", z: float = 1.0) -> None:
        """A line from below to above at a place across, mm."""
        self.line(complex(place, self.y.start), complex(place, self.y.end), colour, width, style, z)

    def level(self, place: float, colour: str, width: float, z: float) -> None:
        """A line from side to side at a height, mm."""
        self.line(complex(self.x.start, place), complex(self.x.end, place), colour, width, z=z)

    def text(self, at: complex, text: Words, ha: Align = "left", size: float = SMALL, colour: str = DARK) -> None:
        self.sheet.text(at, text, size, ha=ha, colour=colour)

    def grid(self, across: bool = True) -> None:
        """Lines at round numbers, those of the axis upwards beside it, the border, the line of zero."""
        for value, __ in self.x.ticks(EVERY[0]) if across else ():
            self.upright(float(self.x.on(value)), FINE, 0.5, z=0.5)
        for value, text in self.y.ticks(EVERY[1]):
            height = float(self.y.on(value))
            self.level(height, FINE, 0.5, z=0.5)
            self.text(complex(self.x.start - 1.5, height), text, "right")
        for place in (self.x.start, self.x.end):
            self.upright(place, THIN, 0.6)
        for place in (self.y.start, self.y.end):
            self.level(place, THIN, 0.6, 1)
        if not self.y.logarithmic and self.y.low <= 0 <= self.y.high:
            self.level(float(self.y.on(0.0)), DARK, 0.7, z=1.5)

    def numbers_across(self, under: float) -> None:
        """Round numbers below the panel, so far under it (mm)."""
        for value, text in self.x.ticks(EVERY[0]):
            self.text(complex(float(self.x.on(value)), self.y.start - under - 0.5 * ROW), text, "center")

    def positions(self, numbers: Sequence[tuple[float, str]]) -> None:
        """Short lines at positions and their numbers, a round share of them where all are too many."""
        widest = max((width_of(text, SMALL * POINT) for __, text in numbers), default=0.0)
        crowd = len(numbers) * (widest + 2) / self.x.length
        for value, text in numbers[:: max(1, round(round_up(crowd, TICKS)))] if numbers else ():
            place = float(self.x.on(value))
            self.line(complex(place, self.y.start), complex(place, self.y.start - 0.8), DARK, 0.6)
            self.text(complex(place, self.y.start - 0.65 * ROW), text, "center", SMALL, SOFT)

    def fill(self, plot: Plot) -> None:
        """Its curves, and where they leap."""
        for curve in plot.curves:
            places = self.at(curve.xs, curve.ys)
            if curve.dots:
                for place in np.atleast_1d(places):
                    self.sheet.circle(complex(place), DOT, curve.colour, curve.colour, 0.3, 4)
                continue
            self.sheet.line(places.tolist(), curve.colour, curve.width, curve.style, blocks=False)
            if plot.jumps:
                kept = places[np.isfinite(places)][::KEPT].tolist()
                for start, end in pairwise(kept):
                    self.sheet.ground.line(start, end)
        for jump in plot.jumps:
            for value, text in zip(jump.values, jump.texts, strict=True):
                place = complex(self.at(jump.at, value))
                self.sheet.circle(place, DOT, "white", jump.colour, 0.7, 4.5)
                if text:
                    self.sheet.label(text, place, SMALL, jump.colour)


def _axis(plot: Plot, bottom: float, height: float) -> Axis:
    values = [curve.ys for curve in plot.curves]
    if not plot.logarithmic:
        return upwards(*limits(values), bottom, height, degrees=plot.degrees)
    above_zero = [np.where(np.asarray(v) > 0, v, np.nan) for v in values]
    return decades(*limits(above_zero), bottom, height)


def _entry(curve: Curve) -> float:
    return SAMPLE + 1 + width_of(curve.label, SMALL * POINT) + APART


def _head(plot: Plot, most: float) -> list[list[Curve]]:
    """Rows above a panel with the entries of its legend in each; the first one begins with its words."""
    words = (plot.words, *(parts(plot.scale(0.00025)) if plot.scale else ()))
    rows: list[list[Curve]] = [[]]
    if sum(map(_entry, plot.legend)) < most - width_of_words(words, PLAIN * POINT) - 2 * APART:
        return [list(plot.legend)]
    left = 0.0
    for curve in plot.legend:
        if _entry(curve) > left:
            rows.append([])
            left = most
        rows[-1].append(curve)
        left -= _entry(curve)
    return rows


def _write_head(panel: Panel, plot: Plot, rows: Sequence[Iterable[Curve]], top: float) -> None:
    """What the panel shows and at which scale, and its legend."""
    at = complex(panel.x.start, top - ROW / 2)
    panel.text(at, plot.words, size=PLAIN)
    if plot.scale is not None:
        after = at + width_of(plot.words, PLAIN * POINT) + APART
        panel.text(after, plot.scale(panel.y.mu), colour=SOFT)
    for number, row in enumerate(rows):
        entries = list(row)
        place = complex(panel.x.end - sum(map(_entry, entries)) + APART, top - ROW * (number + 0.5))
        place = place if number == 0 else complex(panel.x.start, place.imag)
        for curve in entries:
            if curve.dots:
                panel.sheet.circle(place + SAMPLE - 2, DOT, curve.colour, curve.colour, 0.3, 4)
            else:
                panel.line(place, place + SAMPLE, curve.colour, curve.width, curve.style)
            panel.text(place + SAMPLE + 1, curve.label)
            place += _entry(curve)


def _spans(panels: Sequence[Panel], spans: Sequence[tuple[float, float, str]], height: float) -> None:
    """Borders of stretches through all panels, their names between arrows above the first one."""
    if not spans:
        return
    first = panels[0]
    for panel in panels:
        for value in {end for span in spans for end in span[:2]}:
            place = float(panel.x.on(value))
            if panel.x.start + 0.1 < place < panel.x.end - 0.1:
                panel.upright(place, DARK, 0.6, "-.", 2)
    for start, end, text in spans:
        low, high = float(first.x.on(start)), float(first.x.on(end))
        half = width_of(text, SMALL * POINT) / 2 + 1
        if high - low < 2 * half:
            continue
        middle = complex((low + high) / 2, height)
        first.text(middle, text, "center")
        for way, place in ((-1, low), (1, high)):
            first.line(complex(place, height - 1.2), complex(place, height + 1.2), DARK, 0.6)
            if abs(place - middle.real) - half > 3:
                tip = complex(place, height)
                first.line(middle + way * half, tip, THIN, 0.6)
                first.sheet.area([tip, tip - way * 2 + 0.4j, tip - way * 2 - 0.4j], THIN, "none", z=1, blocks=False)
