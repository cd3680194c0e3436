"""The construction of a synthesis as a student would draw it, and the mechanism in its extreme positions."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from matplotlib.figure import Figure

from tmm_cli.cycle import DENSE
from tmm_cli.draw.scheme import BOX, HINGE, beyond, mechanism, moving_points, skeleton, support, trajectory
from tmm_cli.draw.sheet import DARK, INERTIA, LOAD, THIN, Sheet, picture, scale_text
from tmm_cli.linkage import FRAME
from tmm_cli.pipeline import Results, at_positions
from tmm_cli.synthesis.construction import Arc, Construction, Spot
from tmm_cli.synthesis.record import Outcome
from tmm_cli.words import say

STYLES = {  # colour, width, line
    "link": (DARK, 2.2, "-"), "link2": (INERTIA, 2.2, "-"), "thin": (THIN, 0.8, "-"), "dashed": (THIN, 0.7, "--"),
    "axis": (THIN, 0.7, "-."), "bold": (LOAD, 1.3, "-"),
}  # fmt: skip
ARC = 181  # places along an arc


def files(title: str, outcome: Outcome, results: Results | None) -> Iterable[tuple[str, bytes]]:
    """Every sheet as PNG and SVG."""
    for stem, figure in sheets(title, outcome, results):
        for kind in ("png", "svg"):
            yield f"{stem}.{kind}", picture(figure, kind)


def sheets(title: str, outcome: Outcome, results: Results | None) -> Iterable[tuple[str, Figure]]:
    """The construction, if the task has one, and the extreme positions, if there is a mechanism with strokes."""
    if outcome.construction is not None:
        yield "synthesis-construction", construction(title, outcome.construction).finish()
    if results is not None and results.strokes is not None and results.strokes.strokes:
        yield "synthesis-extremes", extremes(results).finish()


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
    for spot in drawn.spots:
        _spot(sheet, spot)
    for note in (scale_text("l", sheet.mu, "m/mm"), *map(say, drawn.notes)):
        sheet.note(note)
    return sheet


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
