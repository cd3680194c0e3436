"""The construction of a synthesis as a student would draw it, and the mechanism in its extreme positions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tmm_cli.analysis.pipeline import Results, at_positions
from tmm_cli.draw.actuators import cylinders
from tmm_cli.draw.chart_axes import chart
from tmm_cli.draw.construction import construction
from tmm_cli.draw.drawing import Drawing
from tmm_cli.draw.forms import by_points
from tmm_cli.draw.mechanism import measured, skeleton, trajectories
from tmm_cli.draw.render import slider
from tmm_cli.draw.scene import Scene
from tmm_cli.draw.sheet import DARK, GREY, INERTIA, LOAD, REACTION, THIN, Sheet, scale_text, with_unit
from tmm_cli.draw.symbols import MEASURED
from tmm_cli.errors import _
from tmm_cli.plans.record import LANDSCAPE
from tmm_cli.problem.units import UnitSystem
from tmm_cli.quantities import KINDS, Dimension
from tmm_cli.synthesis.construction import Diagram, Line
from tmm_cli.synthesis.record import Outcome

ENDS = ("ᴵ", "ᴵᴵ", "ᴵᴵᴵ", "ᴵⱽ")  # of strokes, in their order


def sheets(
    title: str, outcome: Outcome, results: Results | None, units: UnitSystem, names: Mapping[str, str] | None = None
) -> Iterable[tuple[str, Drawing | Figure]]:
    """What the task draws, and the extreme positions, if there is a mechanism with strokes.

    names: of parameters, standard name to that in the file.
    """
    linkage = results.linkage if results is not None else None
    for drawn in outcome.drawings:
        if isinstance(drawn, Diagram):
            yield f"synthesis-{drawn.name}", diagram(title, drawn, units)
        else:
            yield f"synthesis-{drawn.name}", construction(title, drawn, units, linkage, names).finish()
    if results is not None and results.strokes is not None and results.strokes.strokes:
        yield "synthesis-extremes", extremes(results).finish()


def synthesised(results: Results) -> Iterable[tuple[str, Drawing | Figure]]:
    """The sheets of a problem whose file has a synthesis."""
    found = results.problem.synthesis
    if found is not None:
        yield from sheets(results.problem.title, found.outcome, results, results.problem.units, found.names)


def diagram(title: str, drawn: Diagram, units: UnitSystem) -> Figure:
    """Curves over one quantity, in the units of the file."""
    figure = chart(LANDSCAPE, title, drawn.title)
    axes = figure.add_axes((0.1, 0.11, 0.85, 0.74))
    x_words, x_kind = drawn.x
    across = KINDS[x_kind].dimension
    if drawn.lower:
        axes.set_position((0.1, 0.42, 0.85, 0.43))
        below = figure.add_axes((0.1, 0.11, 0.85, 0.25), sharex=axes)
        below.set_yscale("log")
        _panel(below, drawn.lower, drawn.lower_y, across, units)
        axes.tick_params(labelbottom=False)
    _panel(axes, drawn.lines, drawn.y, across, units)
    if drawn.equal:
        axes.set_aspect("equal", adjustable="datalim")
    (below if drawn.lower else axes).set_xlabel(with_unit(x_words, across, units), parse_math=False)
    return figure


def _panel(axes: Axes, lines: Iterable[Line], y: tuple[str, str], across: Dimension, units: UnitSystem) -> None:
    """Curves with their legend and the axis upwards."""
    y_words, y_kind = y
    up, number = KINDS[y_kind].dimension, 0
    for line in lines:
        xs, ys = (
            np.asarray(values, dtype=float) / units.factor(kind) for values, kind in ((line.x, across), (line.y, up))
        )
        style = {"ls": "none", "marker": "o", "ms": 4} if line.dots else {"lw": 1.0 if line.faint else 1.4}
        colour = THIN if line.faint else (DARK, LOAD, INERTIA, REACTION)[number % 4]
        axes.plot(xs, ys, color=colour, label=line.text, zorder=2 if line.faint else 3, **style)
        number += not line.faint
    axes.set_ylabel(with_unit(y_words, up, units), parse_math=False)
    axes.grid(color=GREY, lw=0.4)
    if len(axes.lines) > 1:
        axes.legend(fontsize=9)


def extremes(results: Results) -> Sheet:
    """The mechanism at both ends of its working stroke, the start in full, with the paths of its points."""
    strokes, linkage = results.strokes, results.linkage
    assert strokes is not None
    ends = [stroke.start for stroke in strokes.strokes]
    if len(ends) == 1:
        ends.append(ends[0] + linkage.driver.sense * strokes.strokes[0].length)
    motion = at_positions(results, np.array(ends), 2)
    scene = Scene(linkage, results.structure, motion.poses)
    sheet = trajectories(results, scene, _("Extreme positions of the output"))
    others = [replace(scene, k=k) for k in range(1, len(ends))]
    for other in others:
        skeleton(sheet, other, INERTIA, 1.6, 2.9)
        for link in linkage.moving:
            for start, end in by_points(sheet, other, link).edges:
                sheet.ground.line(start, end)
        for pair in results.structure.pairs:
            if pair.slide is not None and pair.name not in cylinders(linkage):
                slider(sheet, other, pair, MEASURED, INERTIA)
    measured(sheet, scene, ENDS[0])
    points = linkage.moving_points
    sheet.ground.rivals += [sheet.on(here.point(name)) for here in (scene, *others) for name in points]
    for other in others:
        for name in points:
            at = sheet.on(other.point(name))
            if any(name in h.point for h in linkage.hinges):
                sheet.circle(at, 0.8 * MEASURED.hinge, edge=INERTIA)
            else:
                sheet.circle(at, 0.6, INERTIA, INERTIA)
            sheet.label(name + ENDS[min(other.k, 3)], at, 10, INERTIA)
    sheet.note(scale_text("l", sheet.mu, "m/mm"))
    sheet.note(_("I: start of the working stroke, II: its end"))
    return sheet
