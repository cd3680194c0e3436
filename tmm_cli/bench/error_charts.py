"""Charts of `tmm bench accuracy` (time against error) and `tmm bench stability` (errors near critical positions)."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import LogLocator

from tmm_cli.bench.accuracy import QUANTITY_TITLES, TARGETS, Accuracy, AccuracyRow
from tmm_cli.bench.chart_axes import BLUE, GREEN, INK, ORANGE, RED, label_axes, make_page, set_error_axis, set_log_axes
from tmm_cli.bench.linkage_families import FAMILIES_BY_NAME
from tmm_cli.bench.methods.case import QUANTITIES
from tmm_cli.bench.stability import PRODUCT, Stability, StabilityRow

LEAST_ERROR, LARGEST_ERROR = 1e-20, 1e4  # ends of the error axis; values beyond are drawn at its edge
PROJECT_ERROR = 0.05  # error allowed in a course project
PURPLE = "#7a3d99"
FAMILIES: dict[str, tuple[str, dict[str, Any]]] = {
    "closed": ("groups (tmm), class II in closed form", {"marker": "*", "ms": 13, "color": RED, "zorder": 9}),
    "taped": ("the same, as a traced program", {"marker": "*", "ms": 13, "color": RED, "mfc": "white", "zorder": 9}),
    "newton": ("Newton on loop closure, tolerances 1e-2 to 1e-15", {"marker": "o", "ms": 4, "color": BLUE}),
    "multibody": ("whole Jacobian, Lagrange multipliers", {"marker": "s", "ms": 6, "color": GREEN, "zorder": 8}),
    "differences": ("central differences, steps 0.1 to 1e-8 rad", {"marker": "v", "ms": 4.5, "color": ORANGE}),
    "single": ("groups in single precision", {"marker": "D", "ms": 5.5, "color": PURPLE}),
    "extended": ("groups in extended precision", {"marker": "D", "ms": 5.5, "color": PURPLE, "mfc": "white"}),
    "pylinkage": ("pylinkage", {"marker": "P", "ms": 7, "color": "#00838f"}),
    "kinepy": ("kinepy", {"marker": "X", "ms": 7, "color": "#5d4037"}),
}
LINED = ("newton", "differences")  # methods that differ in one setting


def accuracy_charts(accuracy: Accuracy) -> dict[str, Figure]:
    """Draw the charts of `tmm bench accuracy`, one for each linkage; return them by file name."""
    return {f"accuracy-{name}.png": draw_accuracy(accuracy, name) for name in accuracy.linkages}


def draw_accuracy(accuracy: Accuracy, linkage: str) -> Figure:
    """Draw the A4 chart of one linkage, with a panel for each quantity.

    In each panel the x axis is the time per position, the y axis the largest relative error.
    """
    rows = [row for row in accuracy.rows if row.linkage == linkage]
    caption = (
        "largest relative error over the cycle against 50 digits; time with all reactions, "
        "{count} positions at once, median of {repeats}; tmm {tmm}, Python {python}, NumPy "
        "{numpy}, {system}"
    ).format(count=accuracy.positions, repeats=accuracy.repeats, **accuracy.machine)
    figure = make_page(f"Time against error: {linkage}", caption)
    times = [row.microseconds for row in rows if row.microseconds is not None]
    for number, quantity in enumerate(QUANTITIES):
        axes = figure.add_subplot(2, 3, number + 1)
        set_log_axes(axes)
        axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0), numticks=30))
        axes.set_xlim(min(times) / 1.6, max(times) * 1.6)
        axes.set_ylim(LEAST_ERROR, LARGEST_ERROR)
        set_error_axis(axes, range(-20, 5, 4))
        axes.set_yticks([10.0**k for k in range(-20, 5)], minor=True)
        left, below = number % 3 == 0, number > 1
        label_axes(axes, QUANTITY_TITLES[quantity], "µs per position" * below, "largest relative error" * left)
        for family in FAMILIES:
            _draw_family(axes, [row for row in rows if row.family == family], quantity)
        for row in rows:
            if row.family == "board":
                axes.axhline(row.errors[quantity], color=INK, lw=1.1, ls=_dash_style(row), zorder=2)
        axes.axhline(TARGETS[quantity], color=RED, lw=0.7, ls="-.", zorder=1)
        if quantity == "balancing":
            axes.axhline(PROJECT_ERROR, color=GREEN, lw=1.1, zorder=2)
    _draw_legend(figure, rows)
    figure.subplots_adjust(left=0.07, right=0.98, top=0.885, bottom=0.07, hspace=0.24, wspace=0.2)
    return figure


def _dash_style(board: AccuracyRow) -> str:
    return "--" if board.setting == 0.5 else ":"


def _draw_family(axes: Any, rows: list[AccuracyRow], quantity: Any) -> None:
    timed_rows = [row for row in rows if row.microseconds is not None and not np.isnan(row.errors[quantity])]
    if not timed_rows:
        return
    style = FAMILIES[timed_rows[0].family][1]
    x = [row.microseconds for row in timed_rows]
    y = [float(np.clip(row.errors[quantity], LEAST_ERROR, LARGEST_ERROR)) for row in timed_rows]
    axes.plot(x, y, lw=0.9, clip_on=False, **style)
    if timed_rows[0].family == "differences" and quantity != "positions":
        for k in (0, -1):  # errors decrease with the step and increase again by rounding
            axes.annotate(
                f"{timed_rows[k].setting:g}".replace("e-0", "e-"),
                (x[k], y[k]),
                (6, 0),
                textcoords="offset points",
                fontsize=7,
                va="center",
                color=style["color"],
                zorder=7,
                bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.8},
            )


def _draw_legend(figure: Figure, rows: list[AccuracyRow]) -> None:
    """Draw the legend in place of the sixth panel."""
    families = {row.family for row in rows}
    handles = [
        Line2D([], [], lw=0.9 if family in LINED else 0, label=label, **style)
        for family, (label, style) in FAMILIES.items()
        if family in families
    ]
    for row in rows:
        if row.family == "board":
            label = f"drawing board, read to {row.setting} mm"
            handles.append(Line2D([], [], color=INK, lw=1.1, ls=_dash_style(row), label=label))
    handles.append(Line2D([], [], color=GREEN, lw=1.1, label="the 5 % rule"))
    handles.append(Line2D([], [], color=RED, lw=0.7, ls="-.", label="target of tmm"))
    axes = figure.add_subplot(2, 3, 6)
    axes.axis("off")
    axes.legend(
        handles=handles, loc="upper left", fontsize=8.5, frameon=False, bbox_to_anchor=(-0.08, 1.02), labelspacing=0.75
    )


PANELS = 5  # on a sheet; the sixth place is for the key
STABILITY_LEAST_ERROR, STABILITY_LARGEST_ERROR = (
    1e-19,
    1e4,
)  # ends of the error axis; values beyond are drawn at its edge
STYLES: dict[str, tuple[str, dict[str, Any]]] = {
    PRODUCT: ("tmm, with its bound", {"marker": "*", "ms": 8, "color": RED, "lw": 1.6, "zorder": 9}),
    "closed": ("groups (tmm) in float64 alone", {"marker": ".", "ms": 4, "color": "#e58a83", "lw": 1.0}),
    "newton-2": ("Newton on loop closure, 1e-2", {"marker": "^", "color": "#8fb4e8"}),
    "newton-6": ("Newton on loop closure, 1e-6", {"marker": "v", "color": "#4a7fd0"}),
    "newton-12": ("Newton on loop closure, 1e-12", {"marker": "o", "color": "#1f3f80"}),
    "multibody": ("whole Jacobian, multipliers", {"marker": "s", "color": GREEN}),
    "differences-4": ("central differences, 1e-4 rad", {"marker": "v", "color": ORANGE}),
    "single": ("groups in single precision", {"marker": "D", "color": "#7a3d99"}),
    "extended": ("groups in extended precision", {"marker": "D", "color": "#7a3d99", "mfc": "white"}),
    "board-0.50": ("drawing board, 0.50 mm", {"marker": "_", "ms": 4, "color": INK}),
    "cosines": ("law of cosines (acos)", {"marker": "P", "color": "#00838f"}),
    "freudenstein": ("Freudenstein, tan of half the angle", {"marker": "X", "color": "#5d4037"}),
}
VERDICTS = {
    "right": ("right", "#ffffff"),
    "said": ("failure reported, or within a wide error bound", "#9aa0a6"),
    "wrong": ("wrong result without report", "#d93025"),
}
DISTANCES = {
    "rad": "distance of the driver coordinate, rad",
    "share": "distance as a fraction of the length",
    "ratio": "l / r",
    "m": "size, m",
}


def stability_charts(stability: Stability) -> dict[str, Figure]:
    """Draw the charts of `tmm bench stability`, five linkage families on an A4 sheet; return them by file name."""
    families = stability.families
    pages = [families[k : k + PANELS] for k in range(0, len(families), PANELS)]
    title = "Errors near critical positions ({page} of {pages})"
    return {
        f"stability-{number}.png": _draw_sheet(stability, chosen, title.format(page=number, pages=len(pages)))
        for number, chosen in enumerate(pages, 1)
    }


def _draw_sheet(stability: Stability, families: tuple[str, ...], title: str) -> Figure:
    methods = [method for method in STYLES if method in stability.methods]
    caption = (
        "Above: largest error of the results, from positions to balancing moment, relative to the largest value. "
        f"Below: of {max(row.scenes for row in stability.rows)} linkages at each distance, the shares with right "
        "results, reported failures and wrong results."
    )
    figure = make_page(title, caption)
    for number, family in enumerate(families):
        left, bottom = 0.075 + 0.322 * (number % 3), 0.51 - 0.47 * (number // 3)
        above = figure.add_axes((left, bottom + 0.19, 0.25, 0.2))
        below = figure.add_axes((left, bottom + 0.015, 0.25, 0.168))
        _draw_errors(above, stability, family, methods, number % 3 == 0)
        _draw_outcomes(below, stability, family, methods)
    _draw_key(figure, methods)
    return figure


def _line_style(method: str) -> dict[str, Any]:
    return {"ms": 3, "lw": 0.8} | STYLES[method][1]


def _rows_of_family(rows: list[StabilityRow], family: str) -> list[StabilityRow]:
    """Sort the results of a linkage family as they follow along the x axis of the chart, from left to right.

    The distance closest to the critical position is on the right. Sizes and ratios increase to the right.
    """
    return sorted(rows, key=lambda row: row.distance, reverse=FAMILIES_BY_NAME[family].unit in ("rad", "share"))


def _draw_errors(axes: Any, stability: Stability, family: str, methods: list[str], labelled: bool) -> None:
    axes.set_title(FAMILIES_BY_NAME[family].title, fontsize=8.5, loc="left", pad=3)
    set_error_axis(axes, range(-18, 4, 3))
    axes.set_ylim(STABILITY_LEAST_ERROR, STABILITY_LARGEST_ERROR)
    for method in methods:
        rows = _rows_of_family(stability.select_rows(family, method), family)
        if not rows:
            continue
        axes.plot(
            range(len(rows)),
            np.clip([row.error for row in rows], STABILITY_LEAST_ERROR, STABILITY_LARGEST_ERROR),
            **_line_style(method),
        )
        if method == PRODUCT:
            bound = np.clip([row.bound for row in rows], STABILITY_LEAST_ERROR, STABILITY_LARGEST_ERROR)
            axes.plot(range(len(rows)), bound, color=RED, lw=1.2, ls=":", zorder=8)
        axes.set_xlim(-0.5, len(rows) - 0.5)
    axes.minorticks_off()
    axes.set_xticks([])
    axes.tick_params(labelsize=6.5)
    axes.grid(True, axis="y", color="#e2e2e2", lw=0.5)
    if labelled:
        axes.set_ylabel("largest error", fontsize=7.5)


def _draw_outcomes(axes: Any, stability: Stability, family: str, methods: list[str]) -> None:
    """Draw a grid of cells, with a row for each method and a column for each distance from the critical position.

    The colour of a cell shows the fractions of right results, of reported failures and of wrong results.
    """
    family_rows = [method for method in methods if stability.select_rows(family, method)]
    rows = [_rows_of_family(stability.select_rows(family, method), family) for method in family_rows]
    picture = np.array([[_outcome_colour(row) for row in line] for line in rows])
    axes.imshow(picture, aspect="auto", interpolation="nearest")
    axes.set_yticks(range(len(family_rows)), family_rows, fontsize=6)
    axes.set_yticks(np.arange(len(family_rows) - 1) + 0.5, minor=True)
    axes.set_xticks(np.arange(len(rows[0]) - 1) + 0.5, minor=True)
    axes.grid(True, which="minor", color="#d0d0d0", lw=0.4)
    axes.tick_params(which="minor", length=0)
    axes.tick_params(length=2, pad=1.5)
    every = max(1, (len(rows[0]) + 1) // 6)
    ticks = range(0, len(rows[0]), every)
    labels = [f"{rows[0][k].distance:.0e}".replace("e-0", "e-").replace("e+0", "e").replace("e+", "e") for k in ticks]
    axes.set_xticks(list(ticks), labels, fontsize=6.5)
    axes.set_xlabel(DISTANCES[FAMILIES_BY_NAME[family].unit], fontsize=7, labelpad=1.5)


def _outcome_colour(row: StabilityRow) -> tuple[float, ...]:
    colours = [to_rgb(colour) for __, colour in VERDICTS.values()]
    counts = (row.right, row.said, row.wrong)
    return tuple(sum(n * rgb[k] for n, rgb in zip(counts, colours, strict=True)) / row.scenes for k in range(3))


def _draw_key(figure: Figure, methods: list[str]) -> None:
    handles: list[Any] = [Line2D([], [], label=STYLES[method][0], **_line_style(method)) for method in methods]
    handles.insert(1, Line2D([], [], color=RED, lw=1.2, ls=":", label="error bound printed by tmm"))
    for label, colour in VERDICTS.values():
        handles.append(Patch(facecolor=colour, edgecolor="#808080", lw=0.5, label=label))
    figure.legend(
        handles=handles, loc="upper left", bbox_to_anchor=(0.7, 0.46), fontsize=7.5, frameon=False, labelspacing=0.7
    )
