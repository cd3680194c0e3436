"""Diagrams over the cycle: motion of the output, what balances the driver, sizes of all reactions."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from tmm_cli.draw.sheet import DARK, LANDSCAPE, MM, PORTRAIT
from tmm_cli.linkage import FRAME
from tmm_cli.motion import Motion
from tmm_cli.pipeline import Results, at_places
from tmm_cli.plans.record import reaction_name
from tmm_cli.problem.dimensions import (
    ACCELERATION,
    ANGLE,
    ANGULAR_ACCELERATION,
    ANGULAR_SPEED,
    FORCE,
    LENGTH,
    MOMENT,
    SPEED,
    Dimension,
)
from tmm_cli.strokes import output_link, output_run
from tmm_cli.words import say

POINTS = 361
LINES = (DARK, "#b3261e", "#1f4e9c", "#1d7a3a", "#7a3d99", "#c77700", "#00757d", "#8a8a8a")
STYLES = ("-", "--", "-.", ":")


def diagrams(results: Results) -> Iterable[tuple[str, Figure]]:
    """The output's run, speed and acceleration; the balancing moment; the reactions on a second sheet."""
    whole = at_places(results, results.closely(POINTS))
    motion = whole.motion
    assert motion is not None and results.motion is not None
    q = _turned(results, motion)
    marks = _turned(results, results.motion)
    panels: list[tuple[str, Dimension, list[tuple[str, Any, Any]]]] = []
    link = output_link(results.linkage, results.structure.groups)
    if link is not None:
        panels += _output(results, motion, link)
    if whole.reactions is not None and results.reactions is not None and whole.lever is not None:
        plan, given = whole.reactions.balance, results.reactions.balance
        crank = plan.kind == "moment"
        name = "draw.moment" if crank else "draw.force"
        panels.append(
            (say(name), MOMENT if crank else FORCE,
             [("", plan.moment if crank else plan.force, given.moment if crank else given.force)])
        )  # fmt: skip
    if panels:
        yield "diagrams", _figure(results, say("draw.diagrams"), q, marks, panels)
    if whole.reactions is not None and results.reactions is not None:
        here = {r.pair.name: r for r in results.reactions.all}
        parts: list[tuple[str, Dimension, list[tuple[str, Any, Any]]]] = []
        for word, on_frame in (("draw.outer", True), ("draw.inner", False)):
            lines = [
                (f"{reaction_name(r.by, r.on)} ({r.pair.name})", np.abs(r.force), np.abs(here[r.pair.name].force))
                for r in whole.reactions.all
                if (FRAME in (r.on, r.by)) == on_frame
            ]
            parts += [(say(word), FORCE, lines[i : i + 6]) for i in range(0, len(lines), 6)]
        yield "reactions", _figure(results, say("draw.reactions"), q, marks, parts)


def _output(results: Results, motion: Motion, link: str) -> Iterable[tuple[str, Dimension, list[tuple[str, Any, Any]]]]:
    slides = results.strokes is not None and results.strokes.kind == "slide"
    dims = (LENGTH, SPEED, ACCELERATION) if slides else (ANGLE, ANGULAR_SPEED, ANGULAR_ACCELERATION)
    names = ("run", "v", "a") if slides else ("psi", "omega", "epsilon")
    assert results.motion is not None
    curve, points = _law(motion, link), _law(results.motion, link)
    if not slides:
        curve[0] = np.unwrap(curve[0])
        points[0] = curve[0][0] + np.angle(np.exp(1j * (points[0] - curve[0][0])))
        near = [np.argmin(np.abs(_turned(results, motion) - x)) for x in _turned(results, results.motion)]
        points[0] = points[0] + 2 * np.pi * np.round((curve[0][near] - points[0]) / (2 * np.pi))
    for name, dimension, values, given in zip(names, dims, curve, points, strict=True):
        yield say(f"cycle.{name}", link=link), dimension, [("", values, given)]


def _law(motion: Motion, link: str) -> list[Any]:
    run, first, second = output_run(motion, link)
    return [run, first * motion.rate, second * motion.rate**2 + first * motion.acceleration]


def _turned(results: Results, motion: Motion) -> Any:
    """The driver's turn from position 0, deg; a slider's run in the file's unit."""
    if results.linkage.driver.kind == "slide":
        return np.array([results.problem.units.from_si(float(v), LENGTH) for v in motion.q])
    return np.degrees(results.linkage.driver.sense * (motion.q - results.start))


def _figure(
    results: Results,
    title: str,
    q: Any,
    marks: Any,
    panels: Sequence[tuple[str, Dimension, Sequence[tuple[str, Any, Any]]]],
) -> Figure:
    units = results.problem.units
    size = PORTRAIT if len(panels) > 2 else LANDSCAPE
    figure = Figure(figsize=(size[0] * MM, size[1] * MM))
    FigureCanvasAgg(figure)
    figure.text(0.06, 0.965, results.problem.title[:90], fontsize=12, weight="bold", parse_math=False)
    figure.text(0.06, 0.945, title, fontsize=9, color="#404040", parse_math=False)
    for number, (name, dimension, lines) in enumerate(panels, 1):
        axes = figure.add_subplot(len(panels), 1, number)
        for k, (label, values, given) in enumerate(lines):
            style: dict[str, Any] = {
                "color": LINES[k % len(LINES)],
                "ls": STYLES[(k // len(LINES) + k) % len(STYLES)],
                "lw": 1.4,
            }
            axes.plot(q, _in_units(values, dimension, units), label=label or None, **style)
            axes.plot(marks, _in_units(given, dimension, units), "o", ms=3, color=style["color"])
        axes.set_ylabel(f"{name}, {units.symbol(dimension)}", parse_math=False, fontsize=9)
        axes.axhline(0, color=DARK, lw=0.6)
        axes.grid(True, color="#d8d8d8", lw=0.5)
        axes.margins(x=0)
        axes.tick_params(labelsize=8)
        if results.linkage.driver.kind == "turn" and results.way is not None and results.way.full:
            axes.set_xticks(np.arange(0, 361, 30))
            axes.set_xlim(0, 360)
        if any(label for label, _, _ in lines):
            legend = axes.legend(fontsize=8, ncol=3, loc="best", framealpha=0.9)
            for text in legend.get_texts():
                text.set_parse_math(False)
        if number == len(panels):
            unit = units.symbol(LENGTH) if results.linkage.driver.kind == "slide" else "deg"
            axes.set_xlabel(f"{say('draw.turn' if unit == 'deg' else 'cycle.drive')}, {unit}", fontsize=9)
    figure.subplots_adjust(left=0.12, right=0.96, top=0.92, bottom=0.07, hspace=0.22)
    return figure


def _in_units(values: Any, dimension: Dimension, units: Any) -> Any:
    return np.asarray(values) / units.factor(dimension)
