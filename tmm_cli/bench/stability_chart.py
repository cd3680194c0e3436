"""The charts of stability: a panel a family, errors above, and below what each method made of the linkages."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from tmm_cli.bench.families import BY_NAME
from tmm_cli.bench.stability import OURS, Row, Stability
from tmm_cli.plans.record import LANDSCAPE
from tmm_cli.words import say

MM = 1 / 25.4  # inches
PANELS = 5  # on a sheet; the sixth place is the key's
LOW, HIGH = 1e-19, 1e4  # of the error axis; what lies beyond is drawn on its edge
WHITE, GREY, RED = "#ffffff", "#9aa0a6", "#d93025"
STYLES: dict[str, dict[str, Any]] = {
    OURS: {"marker": "*", "ms": 8, "color": "#b3261e", "lw": 1.6, "zorder": 9},
    "closed": {"marker": ".", "ms": 4, "color": "#e58a83", "lw": 1.0},
    "newton-2": {"marker": "^", "ms": 3, "color": "#8fb4e8", "lw": 0.8},
    "newton-6": {"marker": "v", "ms": 3, "color": "#4a7fd0", "lw": 0.8},
    "newton-12": {"marker": "o", "ms": 3, "color": "#1f3f80", "lw": 0.8},
    "multibody": {"marker": "s", "ms": 3, "color": "#1d7a3a", "lw": 0.8},
    "differences-4": {"marker": "v", "ms": 3, "color": "#c77700", "lw": 0.8},
    "single": {"marker": "D", "ms": 2.6, "color": "#7a3d99", "lw": 0.8},
    "extended": {"marker": "D", "ms": 3, "color": "#7a3d99", "mfc": "white", "lw": 0.8},
    "board-0.50": {"marker": "_", "ms": 4, "color": "#1a1a1a", "lw": 0.8},
    "cosines": {"marker": "P", "ms": 3.4, "color": "#00838f", "lw": 0.8},
    "freudenstein": {"marker": "X", "ms": 3.4, "color": "#5d4037", "lw": 0.8},
}


def called(method: str) -> str:
    """A method in words."""
    family, _, setting = method.partition("-")
    return say(f"stability.{family}", k=setting)


def charts(stability: Stability) -> Iterator[Figure]:
    """Sheets of A4 with five families each."""
    families = stability.families
    pages = [families[k : k + PANELS] for k in range(0, len(families), PANELS)]
    for number, page in enumerate(pages, 1):
        yield _sheet(stability, page, say("stability.chart", page=number, pages=len(pages)))


def _sheet(stability: Stability, families: tuple[str, ...], title: str) -> Figure:
    shown = [method for method in STYLES if method in stability.methods]
    figure = Figure(figsize=(LANDSCAPE[0] * MM, LANDSCAPE[1] * MM))
    FigureCanvasAgg(figure)
    figure.text(0.035, 0.965, title, fontsize=12, weight="bold")
    scenes = max(row.scenes for row in stability.rows)
    figure.text(0.035, 0.943, say("stability.caption", scenes=scenes), fontsize=7, color="#404040")
    for number, family in enumerate(families):
        left, bottom = 0.075 + 0.322 * (number % 3), 0.52 - 0.47 * (number // 3)
        above = figure.add_axes((left, bottom + 0.19, 0.25, 0.2))
        below = figure.add_axes((left, bottom + 0.015, 0.25, 0.168))
        _errors(above, stability, family, shown, number % 3 == 0)
        _made(below, stability, family, shown)
    _key(figure, shown)
    return figure


def _places(rows: list[Row], family: str) -> list[Row]:
    """Rows from left to right: the worst distance on the right, sizes and ratios as they grow."""
    return sorted(rows, key=lambda row: row.distance, reverse=BY_NAME[family].unit in ("rad", "share"))


def _errors(axes: Any, stability: Stability, family: str, shown: list[str], labelled: bool) -> None:
    axes.set_title(say(f"stability.{family}"), fontsize=8.5, loc="left", pad=3)
    axes.set_yscale("log")
    axes.set_ylim(LOW, HIGH)
    for method in shown:
        rows = _places(stability.of(family, method), family)
        if not rows:
            continue
        y = [float(np.clip(row.error, LOW, HIGH)) for row in rows]
        axes.plot(range(len(rows)), y, **STYLES[method])
        if method == OURS:
            bound = [float(np.clip(row.bound, LOW, HIGH)) for row in rows]
            axes.plot(range(len(rows)), bound, color=STYLES[OURS]["color"], lw=1.2, ls=":", zorder=8)
        axes.set_xlim(-0.5, len(rows) - 0.5)
    axes.set_yticks([10.0**k for k in range(-18, 4, 3)], [f"1e{k}" if k else "1" for k in range(-18, 4, 3)])
    axes.minorticks_off()
    axes.set_xticks([])
    axes.tick_params(labelsize=6.5)
    axes.grid(True, axis="y", color="#e2e2e2", lw=0.5)
    if labelled:
        axes.set_ylabel(say("stability.error"), fontsize=7.5)


def _made(axes: Any, stability: Stability, family: str, shown: list[str]) -> None:
    """A row a method, a column a distance: its colours mixed by the shares of the linkages."""
    there = [method for method in shown if stability.of(family, method)]
    rows = [_places(stability.of(family, method), family) for method in there]
    picture = np.array([[_mixed(row) for row in line] for line in rows])
    axes.imshow(picture, aspect="auto", interpolation="nearest")
    axes.set_yticks(range(len(there)), there, fontsize=6)
    axes.set_yticks(np.arange(len(there) - 1) + 0.5, minor=True)
    axes.set_xticks(np.arange(len(rows[0]) - 1) + 0.5, minor=True)
    axes.grid(True, which="minor", color="#d0d0d0", lw=0.4)
    axes.tick_params(which="minor", length=0)
    axes.tick_params(length=2, pad=1.5)
    every = max(1, (len(rows[0]) + 1) // 6)
    ticks = range(0, len(rows[0]), every)
    labels = [f"{rows[0][k].distance:.0e}".replace("e-0", "e-").replace("e+0", "e").replace("e+", "e") for k in ticks]
    axes.set_xticks(list(ticks), labels, fontsize=6.5)
    axes.set_xlabel(say(f"stability.x.{BY_NAME[family].unit}"), fontsize=7, labelpad=1.5)


def _mixed(row: Row) -> tuple[float, ...]:
    parts = ((row.right, WHITE), (row.said, GREY), (row.wrong, RED))
    return tuple(sum(count * to_rgb(colour)[k] for count, colour in parts) / row.scenes for k in range(3))


def _key(figure: Figure, shown: list[str]) -> None:
    handles: list[Any] = [Line2D([], [], label=called(method), **STYLES[method]) for method in shown]
    bound = Line2D([], [], color=STYLES[OURS]["color"], lw=1.2, ls=":", label=say("stability.bound"))
    handles.insert(1, bound)
    for key, colour in (("right", WHITE), ("said", GREY), ("wrong", RED)):
        handles.append(Patch(facecolor=colour, edgecolor="#808080", lw=0.5, label=say(f"stability.{key}")))
    figure.legend(handles=handles, loc="upper left", bbox_to_anchor=(0.7, 0.47), fontsize=7.5, frameon=False,
                  labelspacing=0.7)  # fmt: skip
