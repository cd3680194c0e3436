"""The chart of `tmm bench speed`, A4: time a position, ratio to code by hand, growth."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullFormatter

from tmm_cli.bench.chart import GREY, MM
from tmm_cli.bench.chart_axes import bare
from tmm_cli.bench.speed import Growth, Speed
from tmm_cli.plans.record import LANDSCAPE
from tmm_cli.words import say

COLOURS = {"crank-slider": "#1f4e9c", "six-bar": "#b3261e", "shaper": "#1d7a3a"}
PLAIN = FuncFormatter(lambda value, _: f"{value:g}")


def chart(speed: Speed) -> Figure:
    """All of the measurement on one sheet."""
    figure = Figure(figsize=(LANDSCAPE[0] * MM, LANDSCAPE[1] * MM))
    FigureCanvasAgg(figure)
    figure.text(0.06, 0.955, say("speed.chart"), fontsize=13, weight="bold")
    figure.text(0.06, 0.928, say("speed.caption", **speed.machine), fontsize=7.5, color="#404040")
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
        axes.plot(x, [r.ours for r in races], "o-", ms=5, lw=1.3, color=colour, label=say("speed.line_ours", name=name))
        axes.plot(x, [r.by_hand for r in races], "s--", ms=4.5, lw=1, mfc="white", color=colour,
                  label=say("speed.line_hand", name=name))  # fmt: skip
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.xaxis.set_major_formatter(PLAIN)
    axes.yaxis.set_major_formatter(PLAIN)
    axes.set_xlabel(say("speed.positions"), fontsize=9)
    axes.set_ylabel(say("speed.axis"), fontsize=9)
    axes.legend(fontsize=8, frameon=False)
    bare(axes, say("speed.panel_time"))


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
            axes.plot([n - 0.45, n + 0.45], [allowed, allowed], color="#1a1a1a", lw=1.4)
    axes.axhline(1, color=GREY, lw=0.8, zorder=0)
    axes.set_ylim(0, 1.25 * max([1.3, *(r.ratio for r in speed.races)]))
    axes.set_xticks(range(len(kinds)), [say("speed.shape", variants=v, positions=p) for v, p in kinds], fontsize=8)
    axes.set_xlabel(f"{say('speed.variants')} x {say('speed.positions')}", fontsize=9)
    axes.set_ylabel(say("speed.axis_ratio"), fontsize=9)
    axes.legend(fontsize=8, frameon=False, ncol=3, loc="upper left")
    bare(axes, say("speed.panel_ratio"))


def _growth(axes: Any, growth: Growth) -> None:
    n, t = np.array(growth.numbers, float), 1e3 * np.array(growth.seconds)
    slope, start = np.polyfit(n, t, 1, w=1 / t)
    axes.plot(n, start + slope * n, "-", lw=1, color=GREY, label=say("speed.fit"))
    axes.plot(n, t, "o", ms=5, color="#b3261e")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.xaxis.set_major_formatter(PLAIN)
    axes.yaxis.set_major_formatter(PLAIN)
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.set_xlabel(say(f"speed.{growth.what}"), fontsize=9)
    axes.set_ylabel(say("speed.axis_ms"), fontsize=9)
    axes.legend(fontsize=8, frameon=False, loc="upper left")
    bare(axes, say("speed.panel_growth", what=say(f"speed.{growth.what}"), exponent=growth.exponent))
