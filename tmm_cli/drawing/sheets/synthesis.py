"""The construction of a synthesis as a student would draw it, and the mechanism in its extreme positions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from itertools import cycle

import numpy as np

from tmm_cli.drawing.paper import (
    DARK_COLOUR,
    INERTIA_COLOUR,
    LOAD_COLOUR,
    REACTION_COLOUR,
    THIN_COLOUR,
    ChartCurve,
    CommonAxis,
    Drawing,
    DrawingSheet,
    PlotContent,
    axis_extent,
    draw_chart,
    filling_axis,
    finite_limits,
    round_axis,
    scale_words,
    with_unit,
)
from tmm_cli.drawing.sheets.construction import draw_construction
from tmm_cli.drawing.sheets.mechanism import draw_measured, draw_paths, draw_skeleton, point_paths
from tmm_cli.drawing.symbols import (
    MEASURED,
    MechanismScene,
    cylinder_drivers,
    draw_slider,
    form_by_points,
    frame_pivots,
    points_to_scale,
)
from tmm_cli.language import _, translated
from tmm_cli.mechanics.analysis import Results, motion_at_positions
from tmm_cli.mechanics.plans import LANDSCAPE
from tmm_cli.mechanics.quantities import ANGLE, DIMENSIONS, Dimension
from tmm_cli.problem import UnitSystem
from tmm_cli.synthesis import Diagram, DiagramLine, SynthesisOutcome

STROKE_MARKS = ("ᴵ", "ᴵᴵ", "ᴵᴵᴵ", "ᴵⱽ")  # of strokes, in their order


def draw_synthesis(
    title: str,
    outcome: SynthesisOutcome,
    results: Results | None,
    units: UnitSystem,
    names: Mapping[str, str] | None = None,
) -> Iterable[tuple[str, Drawing]]:
    """What the task draws, and the extreme positions, if there is a mechanism with strokes.

    names: of parameters, standard name to that in the file.
    """
    linkage = results.linkage if results is not None else None
    for drawn in outcome.drawings:
        if isinstance(drawn, Diagram):
            yield f"synthesis-{drawn.name}", synthesis_diagram(title, drawn, units)
        else:
            yield f"synthesis-{drawn.name}", draw_construction(title, drawn, units, linkage, names).finish()
    if results is not None and results.strokes is not None and results.strokes.strokes:
        yield "synthesis-extremes", extreme_positions_sheet(results).finish()


def draw_problem_synthesis(results: Results) -> Iterable[tuple[str, Drawing]]:
    """The sheets of a problem whose file has a synthesis."""
    found = results.problem.synthesis
    if found is not None:
        yield from draw_synthesis(results.problem.title, found.outcome, results, results.problem.units, found.names)


def synthesis_diagram(title: str, drawn: Diagram, units: UnitSystem) -> Drawing:
    """Curves over one quantity, in the units of the file."""
    sheet = DrawingSheet(title, translated(drawn.title), paper=LANDSCAPE)
    words, kind = drawn.x
    wide = DIMENSIONS[kind].dimension
    over = finite_limits(
        [np.asarray(line.x, dtype=float) / units.factor(wide) for line in (*drawn.lines, *drawn.lower)]
    )
    degrees = wide == ANGLE and units.symbol(ANGLE) == "deg"
    start, most = axis_extent(sheet)
    axis = filling_axis(*over, start, most) if drawn.equal else round_axis(*over, start, most, degrees=degrees)
    plots = [_diagram_plot(drawn.lines, drawn.y, wide, units)]
    if drawn.lower:
        plots.append(replace(_diagram_plot(drawn.lower, drawn.lower_y, wide, units), logarithmic=True, share=0.6))
    draw_chart(sheet, plots, CommonAxis(axis, with_unit(translated(words), wide, units)), same_scale=drawn.equal)
    return sheet.finish()


def _diagram_plot(lines: Iterable[DiagramLine], y: tuple[str, str], wide: Dimension, units: UnitSystem) -> PlotContent:
    """Curves of a panel, those behind the others first."""
    words, kind = y
    high = DIMENSIONS[kind].dimension
    colours = cycle((DARK_COLOUR, LOAD_COLOUR, INERTIA_COLOUR, REACTION_COLOUR))
    curves = [
        ChartCurve(
            np.asarray(line.x, dtype=float) / units.factor(wide),
            np.asarray(line.y, dtype=float) / units.factor(high),
            translated(line.text),
            THIN_COLOUR if line.faint else next(colours),
            width=1.0 if line.faint else 1.3,
            dots=line.dots,
        )
        for line in sorted(lines, key=lambda line: not line.faint)
    ]
    return PlotContent(with_unit(translated(words), high, units), curves)


def extreme_positions_sheet(results: Results) -> DrawingSheet:
    """The mechanism at both ends of its working stroke, the start in full, with the paths of its points."""
    strokes, linkage = results.strokes, results.linkage
    assert strokes is not None
    ends = [stroke.start for stroke in strokes.strokes]
    if len(ends) == 1:
        ends.append(ends[0] + linkage.driver.sense * strokes.strokes[0].length)
    motion = motion_at_positions(results, np.array(ends), 2)
    scene = MechanismScene(linkage, results.structure, motion.poses)
    ways = point_paths(results)
    used = [*frame_pivots(linkage), *(place for way in ways for place in way)]
    sheet = DrawingSheet(results.problem.title, _("Extreme positions of the output"), points_to_scale(scene, used))
    draw_paths(sheet, ways)
    others = [replace(scene, k=k) for k in range(1, len(ends))]
    for other in others:
        draw_skeleton(sheet, other, INERTIA_COLOUR, 1.6, 2.9)
        for link in linkage.moving:
            for start, end in form_by_points(sheet, other, link, whole=False).edges:
                sheet.ground.line(start, end)
        for pair in results.structure.pairs:
            if pair.slide is not None and pair.name not in cylinder_drivers(linkage):
                draw_slider(sheet, other, pair, MEASURED, INERTIA_COLOUR)
    draw_measured(sheet, scene, STROKE_MARKS[0])
    points = linkage.moving_points
    sheet.ground.rivals += [sheet.on(here.point(name)) for here in (scene, *others) for name in points]
    for other in others:
        for name in points:
            at = sheet.on(other.point(name))
            if any(name in h.point for h in linkage.hinges):
                sheet.circle(at, 0.8 * MEASURED.hinge, edge=INERTIA_COLOUR)
            else:
                sheet.circle(at, 0.6, INERTIA_COLOUR, INERTIA_COLOUR)
            sheet.label(name + STROKE_MARKS[min(other.k, 3)], at, 10, INERTIA_COLOUR)
    sheet.note(scale_words("l", sheet.mu, "m/mm"))
    sheet.note(_("I: start of the working stroke, II: its end"))
    return sheet
