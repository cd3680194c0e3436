"""Drawing of a group: how points are spread, hardest quantities, commonest mistakes."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from tmm_cli.draw.chart_axes import DARK, ORANGE, bare, page
from tmm_cli.errors import _
from tmm_cli.grading.record import State, StudentMarks
from tmm_cli.grading.statistics import STEP, Difficulty, commonest, handed_in, hardest, histogram, percents
from tmm_cli.grading.task import Task

MOST, FEWEST = 10, 6  # bars that a panel has room for
BAD = "#c4574b"
LONGEST = 32  # characters of a line beside a bar
STATES: dict[State, tuple[str, str]] = {
    "right": (_("right"), "#4c9a68"), "follows": (_("right given own"), "#a9d6b8"), "wrong": (_("wrong"), BAD),
    "missing": (_("missing"), "#d0d0d0"),
}  # fmt: skip


def chart(task: Task, marks: Sequence[StudentMarks]) -> Figure:
    """A landscape sheet of A4."""
    own = percents(marks)
    told = _("{students} students, {there} handed in; median {median:.0f} %, mean {mean:.0f} % of the points")
    caption = told.format(
        students=len(marks), there=len(handed_in(marks)),
        median=np.median(own) if own.size else 0, mean=own.mean() if own.size else 0,
    )  # fmt: skip
    figure = page(task.problem.title[:90], caption)
    grid = figure.add_gridspec(2, 2, height_ratios=(1, 1.25), left=0.13, right=0.97, top=0.86, bottom=0.07,
                               hspace=0.36, wspace=0.55)  # fmt: skip
    _spread(figure.add_subplot(grid[0, :]), marks, own)
    difficulties, mistakes = hardest(task, marks)[:MOST], commonest(marks)[:MOST]
    rows = max(len(difficulties), len(mistakes), FEWEST)
    _difficulties(figure.add_subplot(grid[1, 0]), difficulties, rows)
    _mistakes(figure.add_subplot(grid[1, 1]), mistakes, rows)
    return figure


def _spread(axes: Any, marks: Sequence[StudentMarks], own: Any) -> None:
    _panel(axes, _("Points"), "y")
    counts = histogram(marks)
    axes.bar(np.arange(STEP / 2, 100, STEP), counts, width=0.92 * STEP, color="#4a6fa5", zorder=2)
    for k, count in enumerate(counts):
        if count:
            axes.text(STEP * (k + 0.5), count, f"{count}", ha="center", va="bottom", fontsize=8, color=DARK)
    if own.size:
        axes.axvline(np.median(own), color=ORANGE, lw=2, label=_("median"), zorder=3)
        axes.axvspan(*np.quantile(own, (0.25, 0.75)), color="#f9ecd6", lw=0, label=_("middle half"), zorder=0)
        axes.legend(loc="upper left", fontsize=8, frameon=False)
    axes.set_xlim(0, 100)
    axes.set_ylim(0, 1.12 * max(1, counts.max(initial=0)))
    axes.set_xticks(range(0, 101, STEP), [f"{p} %" for p in range(0, 101, STEP)])
    axes.yaxis.set_major_locator(MaxNLocator(6, integer=True))
    axes.set_ylabel(_("students"), fontsize=8)


def _difficulties(axes: Any, found: Sequence[Difficulty], rows: int) -> None:
    _panel(axes, _("Hardest quantities"))
    left = np.zeros(len(found))
    for state, (label, colour) in STATES.items():
        shares = np.array([100 * own.answers[state] / max(1, own.answers.total()) for own in found])
        axes.barh(range(len(found)), shares, left=left, height=0.7, color=colour, label=label)
        left += shares
    _names(axes, [own.name for own in found], rows)
    axes.set_xlim(0, 100)
    axes.set_xticks(range(0, 101, 25), [f"{p} %" for p in range(0, 101, 25)])
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.07), ncol=4, fontsize=8, frameon=False, columnspacing=1.2)


def _mistakes(axes: Any, found: Sequence[tuple[str, int, int]], rows: int) -> None:
    _panel(axes, _("Commonest mistakes"))
    if not found:
        axes.axis("off")
        axes.text(0, 0.95, _("none was recognised"), fontsize=9, va="top", transform=axes.transAxes)
        return
    axes.barh(range(len(found)), [one[1] for one in found], height=0.7, color=BAD)
    for k, one in enumerate(found):
        axes.text(one[1], k, f" {one[1]}", va="center", fontsize=8, color=DARK)
    _names(axes, [one[0] for one in found], rows)
    axes.set_xlim(0, 1.12 * found[0][1])
    axes.xaxis.set_major_locator(MaxNLocator(6, integer=True))
    axes.set_xlabel(_("students"), fontsize=8)


def _panel(axes: Any, title: str, grid: str = "x") -> None:
    """Bars on their one line, with a light grid across them."""
    bare(axes, title)
    axes.grid(False, axis="y" if grid == "x" else "x")
    axes.spines[["top", "right", "left" if grid == "y" else "bottom"]].set_visible(False)
    axes.tick_params(length=0)


def _names(axes: Any, names: Sequence[str], rows: int) -> None:
    """Beside the bars, from the top; bars of both panels are as thick."""
    texts = [textwrap.fill(name, LONGEST, max_lines=2, placeholder="…") for name in names]
    axes.set_yticks(range(len(names)), texts, parse_math=False)
    axes.set_ylim(rows - 0.5, -0.5)
