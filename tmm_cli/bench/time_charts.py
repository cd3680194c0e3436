"""Charts of `tmm bench speed`, `savings` and `synthesis`: times, counts, and speed of optimal synthesis."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullFormatter, NullLocator

from tmm_cli.bench.chart_axes import BLUE, GREEN, GREY, INK, ORANGE, RED, label_axes, make_page, set_log_axes
from tmm_cli.bench.savings import COUNTED_NAMES, SAVING_TITLES, Savings
from tmm_cli.bench.searches import NEAR, SEARCH_NAMES, SEARCHED, Searches
from tmm_cli.bench.speed import GROWING, Growth, SpeedMeasurement

MECHANISM_COLOURS = {"crank-slider": BLUE, "six-bar": RED, "shaper": GREEN}


def speed_charts(speed: SpeedMeasurement) -> dict[str, Figure]:
    """Draw the charts of `tmm bench speed`; return them by file name."""
    return {"speed.png": draw_speed(speed)}


def draw_speed(speed: SpeedMeasurement) -> Figure:
    """Draw all results of `tmm bench speed` on one sheet."""
    caption = (
        "all joints, centres of mass, reactions, balancing moment; least of many turns in one "
        "process; tmm {tmm}, Python {python}, NumPy {numpy}, {system}"
    ).format(**speed.machine)
    figure = make_page("Speed: tmm against code written by hand for one mechanism", caption)
    grid = figure.add_gridspec(2, 6, left=0.07, right=0.98, top=0.86, bottom=0.08, hspace=0.38, wspace=1.2)
    _draw_times(figure.add_subplot(grid[0, :3]), speed)
    _draw_ratios(figure.add_subplot(grid[0, 3:]), speed)
    for k, growth in enumerate(speed.growths):
        _draw_growth(figure.add_subplot(grid[1, 2 * k : 2 * k + 2]), growth)
    return figure


def _draw_times(axes: Any, speed: SpeedMeasurement) -> None:
    for name, colour in MECHANISM_COLOURS.items():
        races = [r for r in speed.races if r.mechanism == name and r.variants == 1]
        x = [r.positions for r in races]
        axes.plot(x, [r.ours for r in races], "o-", ms=5, lw=1.3, color=colour, label=f"{name}, tmm")
        axes.plot(
            x, [r.by_hand for r in races], "s--", ms=4.5, lw=1, mfc="white", color=colour, label=f"{name}, by hand"
        )
    set_log_axes(axes)
    axes.legend(fontsize=8, frameon=False)
    label_axes(axes, "Time per position", "positions", "ns per position")


def _draw_ratios(axes: Any, speed: SpeedMeasurement) -> None:
    kinds = list(dict.fromkeys((r.variants, r.positions) for r in speed.races))
    width = 0.8 / len(MECHANISM_COLOURS)
    for k, (name, colour) in enumerate(MECHANISM_COLOURS.items()):
        races = {(r.variants, r.positions): r for r in speed.races if r.mechanism == name}
        x = [n - 0.4 + width * (k + 0.5) for n in range(len(kinds))]
        axes.bar(x, [races[kind].ratio for kind in kinds], width * 0.9, color=colour, label=name)
    for n, kind in enumerate(kinds):
        allowed = next((r.target for r in speed.races if (r.variants, r.positions) == kind), None)
        if allowed is not None:
            axes.plot([n - 0.45, n + 0.45], [allowed, allowed], color=INK, lw=1.4)
    axes.axhline(1, color=GREY, lw=0.8, zorder=0)
    axes.set_ylim(0, 1.25 * max([1.3, *(r.ratio for r in speed.races)]))
    axes.set_xticks(range(len(kinds)), [f"{variants} x {positions}" for variants, positions in kinds], fontsize=8)
    axes.legend(fontsize=8, frameon=False, ncol=3, loc="upper left")
    label_axes(axes, "Ratio, with its limit", "variants x positions", "tmm / by hand")


def _draw_growth(axes: Any, growth: Growth) -> None:
    n, t = np.array(growth.numbers, float), 1e3 * np.array(growth.seconds)
    slope, start = np.polyfit(n, t, 1, w=1 / t)
    axes.plot(n, start + slope * n, "-", lw=1, color=GREY, label="straight line: linear growth")
    axes.plot(n, t, "o", ms=5, color=RED)
    set_log_axes(axes)
    what = GROWING[growth.what][0]
    axes.legend(fontsize=8, frameon=False, loc="upper left")
    label_axes(axes, f"Growth with {what}: exponent {growth.exponent:.3f}", what, "ms")


SAVINGS_SHEET_SHARE = 0.75  # of the height of a landscape sheet


def savings_charts(measured: Savings) -> dict[str, Figure]:
    """Draw the charts of `tmm bench savings`; return them by file name."""
    return {"savings.png": draw_savings(measured)}


def draw_savings(measured: Savings) -> Figure:
    """Draw a pair of bars for each saving, counts and times, with the numbers beside them."""
    savings = measured.found
    figure = make_page("Savings by computing only what is requested", measured.title[:90], SAVINGS_SHEET_SHARE)
    axes = figure.add_subplot()
    at = np.arange(len(savings))
    counts = [s.with_ / s.without for s in savings]
    times = [s.seconds[0] / s.seconds[1] for s in savings]
    counted = [f"{s.with_} / {s.without} {COUNTED_NAMES[s.counts]}" for s in savings]
    timed = [f"{_short_time(s.seconds[0])} / {_short_time(s.seconds[1])}" for s in savings]
    for off, colour, shares, labels, label in (
        (-0.2, BLUE, counts, counted, "counts: with / without"),
        (0.2, ORANGE, times, timed, "time: with / without"),
    ):
        axes.barh(at + off, np.minimum(shares, 1.0), height=0.36, color=colour, label=label)
        for place, share, text in zip(at + off, shares, labels, strict=True):
            axes.text(min(share, 1.0) + 0.008, place, text, va="center", fontsize=7.5, color=INK)
    axes.set_yticks(at, [SAVING_TITLES[s.name] for s in savings], fontsize=9)
    axes.invert_yaxis()
    axes.set_xlim(0, 1.28)
    axes.set_xticks(np.arange(0, 1.01, 0.1), [f"{100 * x:.0f} %" for x in np.arange(0, 1.01, 0.1)], fontsize=8)
    axes.axvline(1.0, color=INK, lw=0.8)
    axes.grid(True, axis="x", color="#d8d8d8", lw=0.5)
    axes.set_axisbelow(True)
    axes.set_xlabel("remaining share", fontsize=9)
    figure.legend(loc="upper right", bbox_to_anchor=(0.98, 0.985), fontsize=8, ncol=2, framealpha=0.9)
    figure.subplots_adjust(left=0.27, right=0.98, top=0.88, bottom=0.09)
    return figure


def _short_time(seconds: float) -> str:
    return f"{seconds:.2g} s" if seconds >= 0.1 else f"{1e3 * seconds:.2g} ms"


SEARCH_COLOURS = dict(zip(SEARCH_NAMES, (RED, BLUE, GREEN, ORANGE), strict=True))
SEARCH_MARKERS = dict(zip(SEARCH_NAMES, "osD^", strict=True))
LEAST_DEVIATION = 1e-7  # %: smaller deviations are drawn here
SEARCH_SHEET_SHARE = 0.62  # of the height of a landscape sheet


def search_charts(measured: Searches) -> dict[str, Figure]:
    """Draw the charts of `tmm bench synthesis`; return them by file name."""
    return {"synthesis.png": draw_searches(measured)}


def draw_searches(measured: Searches) -> Figure:
    """Draw the speed of evaluation and the deviations of the searches, side by side on a sheet."""
    caption = (
        "five lengths of a crank-rocker, three constraints, 72 positions; one thread; tmm {tmm}, "
        "Python {python}, NumPy {numpy}, {system}"
    )
    title = "Optimal synthesis: rate of evaluation, and deviation of the search from the best known"
    figure = make_page(title, caption.format(**measured.machine), SEARCH_SHEET_SHARE)
    grid = figure.add_gridspec(1, 2, left=0.065, right=0.98, top=0.8, bottom=0.12, wspace=0.2)
    _draw_rates(figure.add_subplot(grid[0, 0]), measured)
    _draw_deviations(figure.add_subplot(grid[0, 1]), measured)
    return figure


def _draw_rates(axes: Any, measured: Searches) -> None:
    for name in SEARCH_NAMES:
        rates = [r for r in measured.rates if r.problem == name]
        label = f"{name}: {rates[0].parameters} lengths, {rates[0].constraints} constraints"
        axes.plot(
            [r.generation for r in rates],
            [r.per_second / 1e3 for r in rates],
            f"{SEARCH_MARKERS[name]}-",
            ms=5.5,
            lw=1.3,
            color=SEARCH_COLOURS[name],
            label=label,
        )
    aimed = [(r.generation, r.target / 1e3) for r in measured.rates if r.target is not None]
    label = "target, at the generation size of the search"
    axes.plot(*zip(*aimed, strict=True), "_", ms=18, mew=1.8, color=INK, label=label)
    sizes = sorted({r.generation for r in measured.rates if r.problem == SEARCHED})
    axes.set_xscale("log")
    axes.set_xticks(sizes, [f"{n:,}".replace(",", " ") for n in sizes])
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_xlim(sizes[0] / 1.5, sizes[-1] * 1.5)
    axes.set_ylim(0, 1.45 * max(r.per_second for r in measured.rates) / 1e3)
    axes.legend(fontsize=8, frameon=False, loc="upper right")
    label_axes(axes, "Candidates per second", "candidates per generation", "thousand candidates per second")


def _draw_deviations(axes: Any, measured: Searches) -> None:
    colour = SEARCH_COLOURS[SEARCH_NAMES[0]]
    last = max(f.evaluations for f in measured.found) / 1e3
    for n, f in enumerate(f for f in measured.found if f.history):
        x, off = np.array([at for at, __ in f.history]) / 1e3, 100 * np.array([off for __, off in f.history])
        axes.plot(
            x,
            np.maximum(off, LEAST_DEVIATION),
            "-",
            lw=0.9,
            alpha=0.6,
            color=colour,
            drawstyle="steps-post",
            label="search, seed by seed, from 72 positions" if n == 0 else None,
        )
        end, low = f.evaluations / 1e3, max(100 * f.off, LEAST_DEVIATION)
        axes.plot([end, 1.06 * last], [max(off[-1], LEAST_DEVIATION), low], ":", lw=0.8, color=colour)
        polished = "refined on exact peaks, 1e-7 % and nearer" if n == 0 else None
        axes.plot([1.06 * last], [low], "*", ms=10, color=colour, label=polished, clip_on=False, zorder=5)
    axes.axhline(100 * NEAR, color=INK, lw=1.2, label="target, 0.1 %")
    axes.set_yscale("log")
    axes.set_xlim(0, 1.12 * last)
    axes.set_ylim(LEAST_DEVIATION / 2, None)
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, __: f"{value:g}".replace("e-0", "e-")))
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.legend(fontsize=8, frameon=False, loc="upper right")
    near = f"{measured.near} of {len(measured.found)} seeds within 0.1 % of the best known"
    label_axes(axes, near, "thousand candidates evaluated", "above the best known, %")
