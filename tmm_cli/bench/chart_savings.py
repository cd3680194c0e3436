"""Chart of savings: what is left of counts and times, as shares of what they would be without each."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from tmm_cli.bench.chart_axes import BLUE, DARK, ORANGE, page
from tmm_cli.bench.savings import COUNTED, NAMED, Savings

SHARE = 0.75  # of the height of a landscape sheet


def savings_charts(measured: Savings) -> dict[str, Figure]:
    """By the names of their files."""
    return {"savings.png": chart(measured)}


def chart(measured: Savings) -> Figure:
    """Bars of both shares, a pair a saving, with the numbers beside them."""
    shown = measured.found
    figure = page("What is saved by computing no more than what is asked for", measured.title[:90], SHARE)
    axes = figure.add_subplot()
    at = np.arange(len(shown))
    counts = [s.with_ / s.without for s in shown]
    times = [s.seconds[0] / s.seconds[1] for s in shown]
    counted = [f"{s.with_} / {s.without} {COUNTED[s.counts]}" for s in shown]
    timed = [f"{_short(s.seconds[0])} / {_short(s.seconds[1])}" for s in shown]
    for off, colour, shares, told, label in (
        (-0.2, BLUE, counts, counted, "counts: with / without"),
        (0.2, ORANGE, times, timed, "time: with / without"),
    ):
        axes.barh(at + off, np.minimum(shares, 1.0), height=0.36, color=colour, label=label)
        for place, share, text in zip(at + off, shares, told, strict=True):
            axes.text(min(share, 1.0) + 0.008, place, text, va="center", fontsize=7.5, color=DARK)
    axes.set_yticks(at, [NAMED[s.name] for s in shown], fontsize=9)
    axes.invert_yaxis()
    axes.set_xlim(0, 1.28)
    axes.set_xticks(np.arange(0, 1.01, 0.1), [f"{100 * x:.0f} %" for x in np.arange(0, 1.01, 0.1)], fontsize=8)
    axes.axvline(1.0, color=DARK, lw=0.8)
    axes.grid(True, axis="x", color="#d8d8d8", lw=0.5)
    axes.set_axisbelow(True)
    axes.set_xlabel("what is left", fontsize=9)
    figure.legend(loc="upper right", bbox_to_anchor=(0.98, 0.985), fontsize=8, ncol=2, framealpha=0.9)
    figure.subplots_adjust(left=0.27, right=0.98, top=0.88, bottom=0.09)
    return figure


def _short(seconds: float) -> str:
    return f"{seconds:.2g} s" if seconds >= 0.1 else f"{1e3 * seconds:.2g} ms"
