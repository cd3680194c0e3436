"""The work-precision chart of a linkage: a panel a quantity, time a position across, largest relative error upward."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from tmm_cli.accuracy.case import QUANTITIES
from tmm_cli.bench.accuracy import TARGETS, Accuracy, Row
from tmm_cli.plans.record import LANDSCAPE
from tmm_cli.words import say

MM = 1 / 25.4  # inches
LOW, HIGH = 1e-20, 1e4  # of the error axis; what lies beyond is drawn on its edge
DARK, GREY = "#1a1a1a", "#8a8a8a"
STYLES: dict[str, dict[str, Any]] = {
    "closed": {"marker": "*", "ms": 13, "color": "#b3261e", "zorder": 9},
    "taped": {"marker": "*", "ms": 13, "color": "#b3261e", "mfc": "white", "zorder": 9},
    "newton": {"marker": "o", "ms": 4, "color": "#1f4e9c"},
    "multibody": {"marker": "s", "ms": 6, "color": "#1d7a3a", "zorder": 8},
    "differences": {"marker": "v", "ms": 4.5, "color": "#c77700"},
    "single": {"marker": "D", "ms": 5.5, "color": "#7a3d99"},
    "extended": {"marker": "D", "ms": 5.5, "color": "#7a3d99", "mfc": "white"},
    "pylinkage": {"marker": "P", "ms": 7, "color": "#00838f"},
    "kinepy": {"marker": "X", "ms": 7, "color": "#5d4037"},
}


def chart(accuracy: Accuracy, linkage: str) -> Figure:
    """The chart of one linkage, A4."""
    rows = [row for row in accuracy.rows if row.linkage == linkage]
    figure = Figure(figsize=(LANDSCAPE[0] * MM, LANDSCAPE[1] * MM))
    FigureCanvasAgg(figure)
    figure.text(0.05, 0.962, say("accuracy.chart", linkage=linkage), fontsize=13, weight="bold")
    caption = say("accuracy.caption", count=accuracy.positions, repeats=accuracy.repeats, **accuracy.machine)
    figure.text(0.05, 0.935, caption, fontsize=7.5, color="#404040")
    times = [row.microseconds for row in rows if row.microseconds is not None]
    limits = (min(times) / 1.6, max(times) * 1.6)
    for number, quantity in enumerate(QUANTITIES):
        axes = figure.add_subplot(2, 3, number + 1)
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_xlim(*limits)
        axes.set_ylim(LOW, HIGH)
        _scales(axes)
        axes.set_title(say(f"accuracy.{quantity}"), fontsize=10, loc="left")
        for family, style in STYLES.items():
            _family(axes, [row for row in rows if row.family == family], quantity, style)
        for row in rows:
            if row.family == "board":
                axes.axhline(row.errors[quantity], color=DARK, lw=1.1, ls="--" if row.setting == 0.5 else ":", zorder=2)
        axes.axhline(TARGETS[quantity], color="#b3261e", lw=0.7, ls="-.", zorder=1)
        if quantity == "balancing":
            axes.axhline(0.05, color="#1d7a3a", lw=1.1, zorder=2)
        if number % 3 == 0:
            axes.set_ylabel(say("accuracy.error"), fontsize=9)
        if number > 1:
            axes.set_xlabel(say("accuracy.time"), fontsize=9)
    _legend(figure, rows)
    figure.subplots_adjust(left=0.07, right=0.98, top=0.885, bottom=0.07, hspace=0.24, wspace=0.2)
    return figure


def _scales(axes: Any) -> None:
    """Decades that can be read: plain numbers of microseconds, every fourth power of ten of error."""
    axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0), numticks=30))
    axes.xaxis.set_major_formatter(FuncFormatter(_plain_number))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.set_yticks([10.0**k for k in range(-20, 5, 4)], [f"1e{k}" if k else "1" for k in range(-20, 5, 4)])
    axes.set_yticks([10.0**k for k in range(-20, 5)], minor=True)
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.tick_params(labelsize=8)
    axes.grid(True, color="#e2e2e2", lw=0.5)


def _plain_number(value: float, _: int) -> str:
    return f"{value:g}"


def _family(axes: Any, rows: list[Row], quantity: Any, style: dict[str, Any]) -> None:
    there = [row for row in rows if row.microseconds is not None and not np.isnan(row.errors[quantity])]
    if there:
        x = [row.microseconds for row in there]
        y = [float(np.clip(row.errors[quantity], LOW, HIGH)) for row in there]
        axes.plot(x, y, lw=0.9, clip_on=False, **style)
        if there[0].family == "differences" and quantity != "positions":
            for k in (0, -1):  # the line comes down with the step and goes up again with rounding
                axes.annotate(
                    f"{there[k].setting:g}".replace("e-0", "e-"), (x[k], y[k]), (6, 0), textcoords="offset points",
                    fontsize=7, va="center", color=style["color"], zorder=7,
                    bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.8},
                )  # fmt: skip


def _legend(figure: Figure, rows: list[Row]) -> None:
    families = {row.family for row in rows}
    handles = [
        Line2D([], [], lw=0.9 if family in ("newton", "differences") else 0, label=say(f"accuracy.{family}"), **style)
        for family, style in STYLES.items() if family in families
    ]  # fmt: skip
    for row in rows:
        if row.family == "board":
            style = "--" if row.setting == 0.5 else ":"
            handles.append(Line2D([], [], color=DARK, lw=1.1, ls=style, label=say("accuracy.paper", mm=row.setting)))
    handles.append(Line2D([], [], color="#1d7a3a", lw=1.1, label=say("accuracy.five")))
    handles.append(Line2D([], [], color="#b3261e", lw=0.7, ls="-.", label=say("accuracy.target")))
    axes = figure.add_subplot(2, 3, 6)
    axes.axis("off")
    axes.legend(handles=handles, loc="upper left", fontsize=8.5, frameon=False, bbox_to_anchor=(-0.08, 1.02),
                labelspacing=0.75)  # fmt: skip
