"""The construction of a synthesis as a student would draw it, and the mechanism in its extreme positions."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from tmm_cli.cycle import DENSE
from tmm_cli.draw.scheme import BOX, HINGE, beyond, mechanism, moving_points, skeleton, support, trajectory
from tmm_cli.draw.sheet import DARK, GREY, INERTIA, LOAD, MM, REACTION, THIN, Sheet, picture, scale_text
from tmm_cli.linkage import FRAME
from tmm_cli.pipeline import Results, at_positions
from tmm_cli.plans.record import LANDSCAPE
from tmm_cli.problem.dimensions import KINDS, Dimension
from tmm_cli.problem.units import UnitSystem
from tmm_cli.synthesis.construction import Arc, Construction, Diagram, Spot
from tmm_cli.synthesis.record import Outcome
from tmm_cli.words import say

STYLES = {  # colour, width, line
    "link": (DARK, 2.2, "-"), "link2": (INERTIA, 2.2, "-"), "thin": (THIN, 0.8, "-"), "dashed": (THIN, 0.7, "--"),
    "axis": (THIN, 0.7, "-."), "bold": (LOAD, 1.3, "-"),
}  # fmt: skip
ARC = 181  # places along an arc


def files(title: str, outcome: Outcome, results: Results | None, units: UnitSystem) -> Iterable[tuple[str, bytes]]:
    """Every sheet as PNG and SVG."""
    for stem, figure in sheets(title, outcome, results, units):
        for kind in ("png", "svg"):
            yield f"{stem}.{kind}", picture(figure, kind)


def sheets(title: str, outcome: Outcome, results: Results | None, units: UnitSystem) -> Iterable[tuple[str, Figure]]:
    """What the task draws, and the extreme positions, if there is a mechanism with strokes."""
    for drawn in outcome.drawings:
        figure = diagram(title, drawn, units) if isinstance(drawn, Diagram) else construction(title, drawn).finish()
        yield f"synthesis-{drawn.name}", figure
    if results is not None and results.strokes is not None and results.strokes.strokes:
        yield "synthesis-extremes", extremes(results).finish()


def synthesised(results: Results) -> Iterable[tuple[str, Figure]]:
    """The sheets of a problem whose file has a synthesis."""
    if results.synthesis is not None:
        yield from sheets(results.problem.title, results.synthesis.outcome, results, results.problem.units)


def construction(title: str, drawn: Construction) -> Sheet:
    """One sheet; arcs that are bold are on it whole."""
    around = [p for arc in drawn.arcs if arc.style == "bold" for p in _along(arc)]
    sheet = Sheet(title, say(drawn.title), [*drawn.places(), *around])
    for s in drawn.segments:
        colour, width, line = STYLES[s.style]
        start, end = sheet.on(s.start), sheet.on(s.end)
        sheet.line([start, end], colour, width, line, z=3 if s.style.startswith("link") else 1.5)
        if s.name:
            sheet.label(s.name, (start + end) / 2, 10, "#7a3d99", "italic")
    for arc in drawn.arcs:
        colour, width, line = STYLES[arc.style]
        places = [sheet.on(p) for p in _along(arc)]
        sheet.line(places, colour, width, line, z=1.2)
        if arc.name:
            sheet.label(arc.name, places[len(places) // 2], 10, "#7a3d99", "italic")
    for curve in drawn.curves:
        colour, width, line = STYLES[curve.style]
        places = [sheet.on(p) for p in curve.places]
        sheet.line(places, colour, width, line, z=1.3)
        if curve.name:
            sheet.label(curve.name, places[len(places) // 2], 10, "#7a3d99", "italic")
    for spot in drawn.spots:
        _spot(sheet, spot)
    for note in (scale_text("l", sheet.mu, "m/mm"), *map(say, drawn.notes)):
        sheet.note(note)
    return sheet


def diagram(title: str, drawn: Diagram, units: UnitSystem) -> Figure:
    """Curves over one quantity, in the units of the file."""
    figure = Figure(figsize=(LANDSCAPE[0] * MM, LANDSCAPE[1] * MM))
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0.1, 0.11, 0.85, 0.74))
    figure.text(0.04, 0.95, title[:90], fontsize=12, weight="bold", va="top", parse_math=False)
    figure.text(0.04, 0.91, say(drawn.title), fontsize=9, color="#404040", va="top", parse_math=False)
    (x_words, x_kind), (y_words, y_kind) = drawn.x, drawn.y
    across, up = KINDS[x_kind].dimension, KINDS[y_kind].dimension
    for number, line in enumerate(drawn.lines):
        x, y = (
            np.asarray(values, dtype=float) / units.factor(kind) for values, kind in ((line.x, across), (line.y, up))
        )
        style = {"ls": "none", "marker": "o", "ms": 4} if line.dots else {"lw": 1.4}
        axes.plot(x, y, color=(DARK, LOAD, INERTIA, REACTION)[number % 4], label=say(line.words), **style)
    axes.set_xlabel(_axis(x_words, across, units), parse_math=False)
    axes.set_ylabel(_axis(y_words, up, units), parse_math=False)
    axes.grid(color=GREY, lw=0.4)
    if drawn.equal:
        axes.set_aspect("equal", adjustable="datalim")
    if len(drawn.lines) > 1:
        axes.legend(fontsize=9)
    return figure


def _axis(words: str, dimension: Dimension, units: UnitSystem) -> str:
    return ", ".join(part for part in (say(words), units.symbol(dimension)) if part)


def _along(arc: Arc) -> list[complex]:
    angles = np.linspace(arc.start, arc.end, ARC)
    return [complex(arc.centre + arc.radius * z) for z in np.exp(1j * angles)]


def _spot(sheet: Sheet, spot: Spot) -> None:
    at = sheet.on(spot.at)
    if spot.mark == "slider":
        half = [complex(x * BOX[0] / 2, y * BOX[1] / 2) * spot.along for x, y in ((1, 1), (-1, 1), (-1, -1), (1, -1))]
        sheet.area([at + corner for corner in half], "white", DARK, 1.2, 2.8)
    if spot.mark == "support":
        support(sheet, at, -1j)
    if spot.mark in ("hinge", "support", "slider"):
        sheet.circle(at, HINGE)
    elif spot.mark == "dot":
        sheet.circle(at, 0.6, face=DARK)
    sheet.label(spot.name, at, 11)


def extremes(results: Results) -> Sheet:
    """The mechanism at both ends of its working stroke, the start in full, with the paths of its points."""
    strokes, linkage = results.strokes, results.linkage
    assert strokes is not None
    sense = linkage.driver.sense
    ends = [s.start for s in strokes.strokes] + [s.start + sense * s.length for s in strokes.strokes[:1]]
    motion = at_positions(results, np.array(ends), 2)
    whole = at_positions(results, results.closely(DENSE), 0)
    points = moving_points(linkage)
    used = [linkage.local(FRAME, h.point) for h in linkage.hinges if FRAME in h.links]
    used += [complex(p) for name in points for p in whole.spot(name)]
    sheet = Sheet(results.problem.title, say("synthesis.extremes"), [*used, *beyond(motion, 0, used)])
    for name in points:
        trajectory(sheet, whole.spot(name))
    for k in range(1, len(strokes.strokes)):
        skeleton(sheet, motion, k, INERTIA, 1.6, 2.9)
        for name in points:
            sheet.circle(sheet.on(complex(motion.named(name).x[k])), HINGE * 0.8, edge=INERTIA)
    mechanism(sheet, motion, 0)
    sheet.note(scale_text("l", sheet.mu, "m/mm"))
    return sheet
