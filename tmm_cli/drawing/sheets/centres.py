"""Instantaneous centres of a position, with the lines on which they lie by threes (Kennedy's theorem)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

import numpy as np

from tmm_cli.drawing.paper import (
    INERTIA_COLOUR,
    LOAD_COLOUR,
    Drawing,
    DrawingSheet,
    gather_coincident,
    leave_field,
    scale_words,
)
from tmm_cli.drawing.sheets.mechanism import Position, draw_measured
from tmm_cli.drawing.symbols import MechanismScene, frame_pivots, points_to_scale
from tmm_cli.language import _, numeral
from tmm_cli.mechanics.analysis import Results
from tmm_cli.mechanics.forces import Symbol
from tmm_cli.mechanics.kinematics import CentreLine, InstantCentre, LinkPair
from tmm_cli.mechanics.numerics import dot
from tmm_cli.reports import centre_name

SHEET_REACH = 2.0  # sizes of the mechanism about its middle: centres that are farther are not on the sheet
CENTRE_RADIUS = 0.9  # mm: radius of a centre
FAR_AWAY = 1e4  # mm: beyond every sheet


def draw_centres(results: Results) -> Iterator[tuple[str, Drawing]]:
    """Yield a sheet of instantaneous centres for each detailed position."""
    motion = results.motion
    assert motion is not None
    for k, found in (results.centres or {}).items():
        here = Position(results, motion, k)
        yield (
            here.stem("centres"),
            _draw_centres_sheet(here, MechanismScene(results.linkage, results.structure, motion.poses, k), found),
        )


def _draw_centres_sheet(here: Position, scene: MechanismScene, found: Sequence[InstantCentre]) -> Drawing:
    linkage = here.results.linkage
    places = [*frame_pivots(linkage), *(scene.point(p) for p in linkage.moving_points)]
    size = max(abs(p - places[0]) for p in places)
    middle = sum(places) / len(places)
    near = {c.links: c.place for c in found if c.place is not None and abs(c.place - middle) < SHEET_REACH * size}
    every = points_to_scale(scene, [*places, *near.values()])
    sheet = here.sheet(_("Instantaneous centres. {caption}"), every)
    draw_measured(sheet, scene)
    known = {centre.links: centre for centre in found}
    for centre in found:
        for line in centre.lines:
            _draw_kennedy_line(sheet, line, centre, known, near)
    for at, links in gather_coincident((sheet.on(place), links) for links, place in near.items()):
        sheet.circle(at, CENTRE_RADIUS, LOAD_COLOUR, LOAD_COLOUR, 0.3, 7)
        sheet.label(_centre_names(links), at, 9, LOAD_COLOUR)
    sheet.note(scale_words("l", sheet.mu, "m/mm"))
    for text in _distant_centre_notes(found, near):
        sheet.note(text)
    return sheet.finish()


def _centre_names(links: Iterable[LinkPair]) -> tuple[Symbol | str, ...]:
    told: list[Symbol | str] = []
    for pair in links:
        told += [", "] * bool(told) + [Symbol("P", centre_name(pair)[1:])]
    return tuple(told)


def _draw_kennedy_line(
    sheet: DrawingSheet,
    line: CentreLine,
    centre: InstantCentre,
    known: Mapping[LinkPair, InstantCentre],
    near: Mapping[LinkPair, complex],
) -> None:
    """Draw the line through two centres and the one they determine, up to the border if a centre is beyond it."""
    through = [known[links] for links in line]
    three = (*through, centre)
    along = _line_direction(through)
    ends = [sheet.on(near[one.links]) for one in three if one.links in near]
    if not ends:
        return
    first = ends[0]
    for one in three:
        if one.links not in near:
            behind = one.place is not None and dot(sheet.on(one.place) - first, along) < 0
            ends.append(leave_field(first, first + (-FAR_AWAY if behind else FAR_AWAY) * along, *sheet.field))
    low, high = (end(ends, key=lambda p: float(dot(p, along))) for end in (min, max))
    if abs(high - low) > CENTRE_RADIUS:
        sheet.line([low, high], INERTIA_COLOUR, 0.7, "-.", 1.5, faint=True)


def _line_direction(through: Sequence[InstantCentre]) -> complex:
    one, other = through
    if one.place is not None and other.place is not None:
        way = other.place - one.place
        return way / abs(way) if way else 1 + 0j
    return complex(one.direction or other.direction or 1)


def _distant_centre_notes(found: Sequence[InstantCentre], near: Mapping[LinkPair, complex]) -> Iterator[str]:
    """Yield notes on the centres that are not on the sheet."""
    for centre in found:
        symbol = Symbol("P", centre_name(centre.links)[1:]).name
        if centre.place is None and centre.direction is not None:
            angle = numeral(float(np.degrees(np.angle(centre.direction))) % 180, ".1f")
            yield _("{centre} is at infinity, at {angle}°").format(centre=symbol, angle=angle)
        elif centre.place is not None and centre.links not in near:
            yield _("{centre} lies off the sheet: see the table").format(centre=symbol)
