"""The chart of `tmm bench synthesis`: candidates a second by the size of generations, and the search seed by seed."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullFormatter, NullLocator

from tmm_cli.bench.chart import DARK, MM
from tmm_cli.bench.chart_axes import bare
from tmm_cli.bench.searches import NAMES, NEAR, PER_SECOND, Searches
from tmm_cli.plans.record import LANDSCAPE
from tmm_cli.words import say

COLOURS = dict(zip(NAMES, ("#b3261e", "#1f4e9c", "#1d7a3a"), strict=True))
MARKS = dict(zip(NAMES, "osD", strict=True))
FLOOR = 1e-7  # %: what is nearer is drawn there
SHARE = 0.62  # of the height of a landscape sheet


def chart(measured: Searches) -> Figure:
    """Both panels on half a sheet."""
    figure = Figure(figsize=(LANDSCAPE[0] * MM, SHARE * LANDSCAPE[1] * MM))
    FigureCanvasAgg(figure)
    figure.text(0.06, 0.94, say("searches.chart"), fontsize=13, weight="bold")
    figure.text(0.06, 0.895, say("searches.caption", **measured.machine), fontsize=7.5, color="#404040")
    grid = figure.add_gridspec(1, 2, left=0.065, right=0.98, top=0.8, bottom=0.12, wspace=0.2)
    _rates(figure.add_subplot(grid[0, 0]), measured)
    _found(figure.add_subplot(grid[0, 1]), measured)
    return figure


def _rates(axes: Any, measured: Searches) -> None:
    for name in NAMES:
        rates = [r for r in measured.rates if r.problem == name]
        label = say("searches.line", problem=name, parameters=rates[0].parameters, constraints=rates[0].constraints)
        axes.plot([r.generation for r in rates], [r.per_second / 1e3 for r in rates], f"{MARKS[name]}-", ms=5.5, lw=1.3,
                  color=COLOURS[name], label=label)  # fmt: skip
    aimed = next(r for r in measured.rates if r.target is not None)
    axes.plot(
        [aimed.generation], [PER_SECOND / 1e3], "_", ms=18, mew=1.8, color=DARK, label=say("searches.target_rate")
    )
    sizes = sorted({r.generation for r in measured.rates if r.problem == aimed.problem})
    axes.set_xscale("log")
    axes.set_xticks(sizes, [f"{n:,}".replace(",", " ") for n in sizes])
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_xlim(sizes[0] / 1.5, sizes[-1] * 1.5)
    axes.set_ylim(0, 1.45 * max(r.per_second for r in measured.rates) / 1e3)
    axes.set_xlabel(say("searches.axis_generation"), fontsize=9)
    axes.set_ylabel(say("searches.axis_rate"), fontsize=9)
    axes.legend(fontsize=8, frameon=False, loc="upper right")
    bare(axes, say("searches.panel_rate"))


def _found(axes: Any, measured: Searches) -> None:
    colour = COLOURS[NAMES[0]]
    last = max(f.evaluations for f in measured.found) / 1e3
    for n, f in enumerate(f for f in measured.found if f.history):
        x, off = np.array([at for at, _ in f.history]) / 1e3, 100 * np.array([off for _, off in f.history])
        axes.plot(x, np.maximum(off, FLOOR), "-", lw=0.9, alpha=0.6, color=colour, drawstyle="steps-post",
                  label=say("searches.searched") if n == 0 else None)  # fmt: skip
        end, low = f.evaluations / 1e3, max(100 * f.off, FLOOR)
        axes.plot([end, 1.06 * last], [max(off[-1], FLOOR), low], ":", lw=0.8, color=colour)
        axes.plot([1.06 * last], [low], "*", ms=10, color=colour, label=say("searches.polished") if n == 0 else None,
                  clip_on=False, zorder=5)  # fmt: skip
    axes.axhline(100 * NEAR, color=DARK, lw=1.2, label=say("searches.target_off"))
    axes.set_yscale("log")
    axes.set_xlim(0, 1.12 * last)
    axes.set_ylim(FLOOR / 2, None)
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}".replace("e-0", "e-")))
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.set_xlabel(say("searches.axis_evaluations"), fontsize=9)
    axes.set_ylabel(say("searches.axis_off"), fontsize=9)
    axes.legend(fontsize=8, frameon=False, loc="upper right")
    bare(axes, say("searches.panel_found", near=measured.near, count=len(measured.found)))
