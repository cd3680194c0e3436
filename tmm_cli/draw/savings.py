"""Chart of savings: what is left of counts and times, as shares of what they would be without each."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from tmm_cli.bench.savings import Saving
from tmm_cli.draw.sheet import DARK, MM, picture
from tmm_cli.plans.record import LANDSCAPE
from tmm_cli.words import say

COLOURS = ("#1f4e9c", "#c77700")


def chart(title: str, found: Sequence[Saving], kind: str) -> bytes:
    """Bars of both shares, a pair a saving, with the numbers beside them."""
    shown = [s for s in found if not s.why]
    figure = Figure(figsize=(LANDSCAPE[0] * MM, LANDSCAPE[1] * MM * 0.75))
    FigureCanvasAgg(figure)
    figure.text(0.03, 0.955, say("savings.title"), fontsize=12, weight="bold")
    figure.text(0.03, 0.92, title[:90], fontsize=9, color="#404040", parse_math=False)
    axes = figure.add_subplot()
    at = np.arange(len(shown))
    counts = [s.with_ / s.without if s.without else 1.0 for s in shown]
    times = [s.seconds[0] / s.seconds[1] for s in shown]
    told = [
        [f"{s.with_} / {s.without} {say(f'savings.{s.counts}')}" for s in shown],
        [f"{_short(s.seconds[0])} / {_short(s.seconds[1])}" for s in shown],
    ]
    for k, (shares, key) in enumerate(((counts, "savings.share_counts"), (times, "savings.share_times"))):
        places = at + 0.2 * (2 * k - 1)
        axes.barh(places, np.minimum(shares, 1.0), height=0.36, color=COLOURS[k], label=say(key))
        for place, share, text in zip(places, shares, told[k], strict=True):
            axes.text(min(share, 1.0) + 0.008, place, text, va="center", fontsize=7.5, color=DARK)
    axes.set_yticks(at, [say(f"savings.{s.name}") for s in shown], fontsize=9)
    axes.invert_yaxis()
    axes.set_xlim(0, 1.28)
    axes.set_xticks(np.arange(0, 1.01, 0.1), [f"{100 * x:.0f} %" for x in np.arange(0, 1.01, 0.1)], fontsize=8)
    axes.axvline(1.0, color=DARK, lw=0.8)
    axes.grid(True, axis="x", color="#d8d8d8", lw=0.5)
    axes.set_axisbelow(True)
    axes.set_xlabel(say("savings.left"), fontsize=9)
    figure.legend(loc="upper right", bbox_to_anchor=(0.98, 0.985), fontsize=8, ncol=2, framealpha=0.9)
    figure.subplots_adjust(left=0.27, right=0.98, top=0.89, bottom=0.09)
    return picture(figure, kind)


def _short(seconds: float) -> str:
    return f"{seconds:.2g} s" if seconds >= 0.1 else f"{1e3 * seconds:.2g} ms"
