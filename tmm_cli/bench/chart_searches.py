"""The chart of `tmm bench synthesis`: candidates a second by the size of generations, and the search seed by seed."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullFormatter, NullLocator

from tmm_cli.bench.chart_axes import BLUE, DARK, GREEN, ORANGE, RED, bare, page
from tmm_cli.bench.searches import NEAR, SEARCH_NAMES, SEARCHED, Searches

COLOURS = dict(zip(SEARCH_NAMES, (RED, BLUE, GREEN, ORANGE), strict=True))
MARKS = dict(zip(SEARCH_NAMES, "osD^", strict=True))
FLOOR = 1e-7  # %: what is nearer is drawn there
SHARE = 0.62  # of the height of a landscape sheet


def search_charts(measured: Searches) -> dict[str, Figure]:
    """By the names of their files."""
    return {"synthesis.png": chart(measured)}


def chart(measured: Searches) -> Figure:
    """Both panels on half a sheet."""
    caption = (
        "five lengths of a crank-rocker, three constraints, 72 positions; one thread; tmm {tmm}, "
        "Python {python}, NumPy {numpy}, {system}"
    )
    title = "Optimal synthesis: how quickly candidates are evaluated, how near the search comes"
    figure = page(title, caption.format(**measured.machine), SHARE)
    grid = figure.add_gridspec(1, 2, left=0.065, right=0.98, top=0.8, bottom=0.12, wspace=0.2)
    _rates(figure.add_subplot(grid[0, 0]), measured)
    _found(figure.add_subplot(grid[0, 1]), measured)
    return figure


def _rates(axes: Any, measured: Searches) -> None:
    for name in SEARCH_NAMES:
        rates = [r for r in measured.rates if r.problem == name]
        label = f"{name}: {rates[0].parameters} lengths, {rates[0].constraints} constraints"
        axes.plot(
            [r.generation for r in rates],
            [r.per_second / 1e3 for r in rates],
            f"{MARKS[name]}-",
            ms=5.5,
            lw=1.3,
            color=COLOURS[name],
            label=label,
        )
    aimed = [(r.generation, r.target / 1e3) for r in measured.rates if r.target is not None]
    label = "target, at the size that the search uses"
    axes.plot(*zip(*aimed, strict=True), "_", ms=18, mew=1.8, color=DARK, label=label)
    sizes = sorted({r.generation for r in measured.rates if r.problem == SEARCHED})
    axes.set_xscale("log")
    axes.set_xticks(sizes, [f"{n:,}".replace(",", " ") for n in sizes])
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_xlim(sizes[0] / 1.5, sizes[-1] * 1.5)
    axes.set_ylim(0, 1.45 * max(r.per_second for r in measured.rates) / 1e3)
    axes.legend(fontsize=8, frameon=False, loc="upper right")
    bare(axes, "Candidates a second", "candidates in a generation", "thousand candidates a second")


def _found(axes: Any, measured: Searches) -> None:
    colour = COLOURS[SEARCH_NAMES[0]]
    last = max(f.evaluations for f in measured.found) / 1e3
    for n, f in enumerate(f for f in measured.found if f.history):
        x, off = np.array([at for at, __ in f.history]) / 1e3, 100 * np.array([off for __, off in f.history])
        axes.plot(
            x,
            np.maximum(off, FLOOR),
            "-",
            lw=0.9,
            alpha=0.6,
            color=colour,
            drawstyle="steps-post",
            label="search, seed by seed, from 72 positions" if n == 0 else None,
        )
        end, low = f.evaluations / 1e3, max(100 * f.off, FLOOR)
        axes.plot([end, 1.06 * last], [max(off[-1], FLOOR), low], ":", lw=0.8, color=colour)
        polished = "polished on exact peaks, 1e-7 % and nearer" if n == 0 else None
        axes.plot([1.06 * last], [low], "*", ms=10, color=colour, label=polished, clip_on=False, zorder=5)
    axes.axhline(100 * NEAR, color=DARK, lw=1.2, label="target, 0.1 %")
    axes.set_yscale("log")
    axes.set_xlim(0, 1.12 * last)
    axes.set_ylim(FLOOR / 2, None)
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, __: f"{value:g}".replace("e-0", "e-")))
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.legend(fontsize=8, frameon=False, loc="upper right")
    near = f"{measured.near} of {len(measured.found)} seeds within 0.1 % of the best known"
    bare(axes, near, "thousand candidates evaluated", "above the best known, %")
