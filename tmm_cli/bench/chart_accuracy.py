"""The work-precision chart of a linkage: a panel a quantity, time a position across, largest relative error upward."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator

from tmm_cli.bench.accuracy import NAMED, TARGETS, Accuracy, AccuracyRow
from tmm_cli.bench.chart_axes import BLUE, GREEN, INK, ORANGE, RED, label_axes, make_page, set_error_axis, set_log_axes
from tmm_cli.bench.methods.case import QUANTITIES

LEAST_ERROR, LARGEST_ERROR = 1e-20, 1e4  # of the error axis; what lies beyond is drawn on its edge
PROJECT_ERROR = 0.05  # what a course project allows
PURPLE = "#7a3d99"
FAMILIES: dict[str, tuple[str, dict[str, Any]]] = {
    "closed": ("groups (tmm), class II in closed form", {"marker": "*", "ms": 13, "color": RED, "zorder": 9}),
    "taped": ("the same, written on a tape", {"marker": "*", "ms": 13, "color": RED, "mfc": "white", "zorder": 9}),
    "newton": ("Newton on loop closure, tolerances 1e-2 to 1e-15", {"marker": "o", "ms": 4, "color": BLUE}),
    "multibody": ("whole Jacobian, Lagrange multipliers", {"marker": "s", "ms": 6, "color": GREEN, "zorder": 8}),
    "differences": ("central differences, steps 0.1 to 1e-8 rad", {"marker": "v", "ms": 4.5, "color": ORANGE}),
    "single": ("groups in single precision", {"marker": "D", "ms": 5.5, "color": PURPLE}),
    "extended": ("groups in extended precision", {"marker": "D", "ms": 5.5, "color": PURPLE, "mfc": "white"}),
    "pylinkage": ("pylinkage", {"marker": "P", "ms": 7, "color": "#00838f"}),
    "kinepy": ("kinepy", {"marker": "X", "ms": 7, "color": "#5d4037"}),
}
LINED = ("newton", "differences")  # methods that differ in one setting


def accuracy_charts(accuracy: Accuracy) -> dict[str, Figure]:
    """One a linkage, by the names of their files."""
    return {f"accuracy-{name}.png": draw_accuracy(accuracy, name) for name in accuracy.linkages}


def draw_accuracy(accuracy: Accuracy, linkage: str) -> Figure:
    """The chart of one linkage, A4."""
    rows = [row for row in accuracy.rows if row.linkage == linkage]
    caption = (
        "largest relative error over the cycle against 50 digits; time with all reactions, "
        "{count} positions at once, median of {repeats}; tmm {tmm}, Python {python}, NumPy "
        "{numpy}, {system}"
    ).format(count=accuracy.positions, repeats=accuracy.repeats, **accuracy.machine)
    figure = make_page(f"Time against error: {linkage}", caption)
    times = [row.microseconds for row in rows if row.microseconds is not None]
    for number, quantity in enumerate(QUANTITIES):
        axes = figure.add_subplot(2, 3, number + 1)
        set_log_axes(axes)
        axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0), numticks=30))
        axes.set_xlim(min(times) / 1.6, max(times) * 1.6)
        axes.set_ylim(LEAST_ERROR, LARGEST_ERROR)
        set_error_axis(axes, range(-20, 5, 4))
        axes.set_yticks([10.0**k for k in range(-20, 5)], minor=True)
        left, below = number % 3 == 0, number > 1
        label_axes(axes, NAMED[quantity], "µs a position" * below, "largest relative error" * left)
        for family in FAMILIES:
            _draw_family(axes, [row for row in rows if row.family == family], quantity)
        for row in rows:
            if row.family == "board":
                axes.axhline(row.errors[quantity], color=INK, lw=1.1, ls=_dash_style(row), zorder=2)
        axes.axhline(TARGETS[quantity], color=RED, lw=0.7, ls="-.", zorder=1)
        if quantity == "balancing":
            axes.axhline(PROJECT_ERROR, color=GREEN, lw=1.1, zorder=2)
    _draw_legend(figure, rows)
    figure.subplots_adjust(left=0.07, right=0.98, top=0.885, bottom=0.07, hspace=0.24, wspace=0.2)
    return figure


def _dash_style(board: AccuracyRow) -> str:
    return "--" if board.setting == 0.5 else ":"


def _draw_family(axes: Any, rows: list[AccuracyRow], quantity: Any) -> None:
    there = [row for row in rows if row.microseconds is not None and not np.isnan(row.errors[quantity])]
    if not there:
        return
    style = FAMILIES[there[0].family][1]
    x = [row.microseconds for row in there]
    y = [float(np.clip(row.errors[quantity], LEAST_ERROR, LARGEST_ERROR)) for row in there]
    axes.plot(x, y, lw=0.9, clip_on=False, **style)
    if there[0].family == "differences" and quantity != "positions":
        for k in (0, -1):  # the line comes down with the step and goes up again with rounding
            axes.annotate(
                f"{there[k].setting:g}".replace("e-0", "e-"),
                (x[k], y[k]),
                (6, 0),
                textcoords="offset points",
                fontsize=7,
                va="center",
                color=style["color"],
                zorder=7,
                bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.8},
            )


def _draw_legend(figure: Figure, rows: list[AccuracyRow]) -> None:
    """In the place of a sixth panel."""
    there = {row.family for row in rows}
    handles = [
        Line2D([], [], lw=0.9 if family in LINED else 0, label=label, **style)
        for family, (label, style) in FAMILIES.items()
        if family in there
    ]
    for row in rows:
        if row.family == "board":
            label = f"drawing board, read to {row.setting} mm"
            handles.append(Line2D([], [], color=INK, lw=1.1, ls=_dash_style(row), label=label))
    handles.append(Line2D([], [], color=GREEN, lw=1.1, label="the 5 % rule"))
    handles.append(Line2D([], [], color=RED, lw=0.7, ls="-.", label="target of tmm"))
    axes = figure.add_subplot(2, 3, 6)
    axes.axis("off")
    axes.legend(
        handles=handles, loc="upper left", fontsize=8.5, frameon=False, bbox_to_anchor=(-0.08, 1.02), labelspacing=0.75
    )
