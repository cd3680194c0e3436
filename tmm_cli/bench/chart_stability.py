"""The charts of stability: a panel a family, errors above, and below what each method made of the linkages."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from tmm_cli.bench.chart_axes import GREEN, INK, ORANGE, RED, make_page, set_error_axis
from tmm_cli.bench.scenes import BY_NAME
from tmm_cli.bench.stability import PRODUCT, Stability, StabilityRow

PANELS = 5  # on a sheet; the sixth place is the key's
STABILITY_LEAST_ERROR, STABILITY_LARGEST_ERROR = 1e-19, 1e4  # of the error axis; what lies beyond is drawn on its edge
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
    "said": ("no answer, or a bound as wide as it is off", "#9aa0a6"),
    "wrong": ("wrong, and it does not say so", "#d93025"),
}
DISTANCES = {
    "rad": "distance of the driver, rad",
    "share": "distance as a share of the length",
    "ratio": "l / r",
    "m": "size, m",
}


def stability_charts(stability: Stability) -> dict[str, Figure]:
    """Sheets of A4 with five families each, by the names of their files."""
    families = stability.families
    pages = [families[k : k + PANELS] for k in range(0, len(families), PANELS)]
    title = "Near what kills a method ({page} of {pages})"
    return {
        f"stability-{number}.png": _draw_sheet(stability, chosen, title.format(page=number, pages=len(pages)))
        for number, chosen in enumerate(pages, 1)
    }


def _draw_sheet(stability: Stability, families: tuple[str, ...], title: str) -> Figure:
    shown = [method for method in STYLES if method in stability.methods]
    caption = (
        "Above: largest error of the answers given, positions to balancing moment, over the largest value. Below: of "
        f"{max(row.scenes for row in stability.rows)} linkages at each distance the share that it gets right, does not "
        "and says so, gets wrong."
    )
    figure = make_page(title, caption)
    for number, family in enumerate(families):
        left, bottom = 0.075 + 0.322 * (number % 3), 0.51 - 0.47 * (number // 3)
        above = figure.add_axes((left, bottom + 0.19, 0.25, 0.2))
        below = figure.add_axes((left, bottom + 0.015, 0.25, 0.168))
        _draw_errors(above, stability, family, shown, number % 3 == 0)
        _draw_outcomes(below, stability, family, shown)
    _draw_key(figure, shown)
    return figure


def _line_style(method: str) -> dict[str, Any]:
    return {"ms": 3, "lw": 0.8} | STYLES[method][1]


def _rows_of_family(rows: list[StabilityRow], family: str) -> list[StabilityRow]:
    """Rows from left to right: the worst distance on the right, sizes and ratios as they grow."""
    return sorted(rows, key=lambda row: row.distance, reverse=BY_NAME[family].unit in ("rad", "share"))


def _draw_errors(axes: Any, stability: Stability, family: str, shown: list[str], labelled: bool) -> None:
    axes.set_title(BY_NAME[family].title, fontsize=8.5, loc="left", pad=3)
    set_error_axis(axes, range(-18, 4, 3))
    axes.set_ylim(STABILITY_LEAST_ERROR, STABILITY_LARGEST_ERROR)
    for method in shown:
        rows = _rows_of_family(stability.of(family, method), family)
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


def _draw_outcomes(axes: Any, stability: Stability, family: str, shown: list[str]) -> None:
    """A row a method, a column a distance: its colours mixed by the shares of the linkages."""
    there = [method for method in shown if stability.of(family, method)]
    rows = [_rows_of_family(stability.of(family, method), family) for method in there]
    picture = np.array([[_outcome_colour(row) for row in line] for line in rows])
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
    axes.set_xlabel(DISTANCES[BY_NAME[family].unit], fontsize=7, labelpad=1.5)


def _outcome_colour(row: StabilityRow) -> tuple[float, ...]:
    colours = [to_rgb(colour) for __, colour in VERDICTS.values()]
    counts = (row.right, row.said, row.wrong)
    return tuple(sum(n * rgb[k] for n, rgb in zip(counts, colours, strict=True)) / row.scenes for k in range(3))


def _draw_key(figure: Figure, shown: list[str]) -> None:
    handles: list[Any] = [Line2D([], [], label=STYLES[method][0], **_line_style(method)) for method in shown]
    handles.insert(1, Line2D([], [], color=RED, lw=1.2, ls=":", label="the bound that tmm prints"))
    for label, colour in VERDICTS.values():
        handles.append(Patch(facecolor=colour, edgecolor="#808080", lw=0.5, label=label))
    figure.legend(
        handles=handles, loc="upper left", bbox_to_anchor=(0.7, 0.46), fontsize=7.5, frameon=False, labelspacing=0.7
    )
