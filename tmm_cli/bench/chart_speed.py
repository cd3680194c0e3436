"""The chart of `tmm bench speed`, A4: time a position, ratio to code by hand, growth."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from tmm_cli.bench.chart_axes import BLUE, DARK, GREEN, GREY, RED, bare, decades, page
from tmm_cli.bench.speed import GROWING, Growth, Speed

COLOURS = {"crank-slider": BLUE, "six-bar": RED, "shaper": GREEN}


def speed_charts(speed: Speed) -> dict[str, Figure]:
    """By the names of their files."""
    return {"speed.png": chart(speed)}


def chart(speed: Speed) -> Figure:
    """All of the measurement on one sheet."""
    caption = (
        "all joints, centres of mass, reactions, balancing moment; least of many turns in one "
        "process; tmm {tmm}, Python {python}, NumPy {numpy}, {system}"
    ).format(**speed.machine)
    figure = page("Speed: tmm against code written by hand for one mechanism", caption)
    grid = figure.add_gridspec(2, 6, left=0.07, right=0.98, top=0.86, bottom=0.08, hspace=0.38, wspace=1.2)
    _times(figure.add_subplot(grid[0, :3]), speed)
    _ratios(figure.add_subplot(grid[0, 3:]), speed)
    for k, growth in enumerate(speed.growths):
        _growth(figure.add_subplot(grid[1, 2 * k : 2 * k + 2]), growth)
    return figure


def _times(axes: Any, speed: Speed) -> None:
    for name, colour in COLOURS.items():
        races = [r for r in speed.races if r.mechanism == name and r.variants == 1]
        x = [r.positions for r in races]
        axes.plot(x, [r.ours for r in races], "o-", ms=5, lw=1.3, color=colour, label=f"{name}, tmm")
        axes.plot(
            x, [r.by_hand for r in races], "s--", ms=4.5, lw=1, mfc="white", color=colour, label=f"{name}, by hand"
        )
    decades(axes)
    axes.legend(fontsize=8, frameon=False)
    bare(axes, "Time a position", "positions", "ns a position")


def _ratios(axes: Any, speed: Speed) -> None:
    kinds = list(dict.fromkeys((r.variants, r.positions) for r in speed.races))
    width = 0.8 / len(COLOURS)
    for k, (name, colour) in enumerate(COLOURS.items()):
        races = {(r.variants, r.positions): r for r in speed.races if r.mechanism == name}
        x = [n - 0.4 + width * (k + 0.5) for n in range(len(kinds))]
        axes.bar(x, [races[kind].ratio for kind in kinds], width * 0.9, color=colour, label=name)
    for n, kind in enumerate(kinds):
        allowed = next((r.target for r in speed.races if (r.variants, r.positions) == kind), None)
        if allowed is not None:
            axes.plot([n - 0.45, n + 0.45], [allowed, allowed], color=DARK, lw=1.4)
    axes.axhline(1, color=GREY, lw=0.8, zorder=0)
    axes.set_ylim(0, 1.25 * max([1.3, *(r.ratio for r in speed.races)]))
    axes.set_xticks(range(len(kinds)), [f"{variants} x {positions}" for variants, positions in kinds], fontsize=8)
    axes.legend(fontsize=8, frameon=False, ncol=3, loc="upper left")
    bare(axes, "Ratio, and what is allowed", "variants x positions", "tmm / by hand")


def _growth(axes: Any, growth: Growth) -> None:
    n, t = np.array(growth.numbers, float), 1e3 * np.array(growth.seconds)
    slope, start = np.polyfit(n, t, 1, w=1 / t)
    axes.plot(n, start + slope * n, "-", lw=1, color=GREY, label="straight line: linear growth")
    axes.plot(n, t, "o", ms=5, color=RED)
    decades(axes)
    what = GROWING[growth.what][0]
    axes.legend(fontsize=8, frameon=False, loc="upper left")
    bare(axes, f"Growth with {what}: exponent {growth.exponent:.3f}", what, "ms")
