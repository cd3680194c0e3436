"""Sheet of the instantaneous centres in a position.

By Kennedy's theorem, three of them lie on each line drawn there.
"""

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

SHEET_REACH = 2.0  # sizes of the mechanism from its middle: centres farther away are not on the sheet
CENTRE_RADIUS = 0.9  # mm: radius of a centre
FAR_AWAY = 1e4  # mm: beyond any sheet


def draw_centres(results: Results) -> Iterator[tuple[str, Drawing]]:
    """Yield a sheet of instantaneous centres for each detailed position, as (stem of the file name, drawing)."""
    motion = results.motion
    assert motion is not None
    for k, centres in (results.centres or {}).items():
        position = Position(results, motion, k)
        yield (
            position.stem("centres"),
            _draw_centres_sheet(position, MechanismScene(results.linkage, results.structure, motion.poses, k), centres),
        )


def _draw_centres_sheet(position: Position, scene: MechanismScene, centres: Sequence[InstantCentre]) -> Drawing:
    linkage = position.results.linkage
    points = [*frame_pivots(linkage), *(scene.point(p) for p in linkage.moving_points)]
    extent = max(abs(p - points[0]) for p in points)
    middle = sum(points) / len(points)
    near = {c.links: c.place for c in centres if c.place is not None and abs(c.place - middle) < SHEET_REACH * extent}
    sheet_points = points_to_scale(scene, [*points, *near.values()])
    sheet = position.sheet(_("Instantaneous centres. {caption}"), sheet_points)
    draw_measured(sheet, scene)
    by_links = {centre.links: centre for centre in centres}
    for centre in centres:
        for line in centre.lines:
            _draw_kennedy_line(sheet, line, centre, by_links, near)
    for at, links in gather_coincident((sheet.on(place), links) for links, place in near.items()):
        sheet.circle(at, CENTRE_RADIUS, LOAD_COLOUR, LOAD_COLOUR, 0.3, 7)
        sheet.label(_centre_names(links), at, 9, LOAD_COLOUR)
    sheet.note(scale_words("l", sheet.mu, "m/mm"))
    for text in _distant_centre_notes(centres, near):
        sheet.note(text)
    return sheet.finish()


def _centre_names(links: Iterable[LinkPair]) -> tuple[Symbol | str, ...]:
    texts: list[Symbol | str] = []
    for pair in links:
        texts += [", "] * bool(texts) + [Symbol("P", centre_name(pair)[1:])]
    return tuple(texts)


def _draw_kennedy_line(
    sheet: DrawingSheet,
    line: CentreLine,
    centre: InstantCentre,
    by_links: Mapping[LinkPair, InstantCentre],
    near: Mapping[LinkPair, complex],
) -> None:
    """Draw the line through two instantaneous centres on which a third one lies, up to the edge of the sheet.

    Args:
        sheet: sheet to draw on.
        line: the two centres, each given by its pair of links.
        centre: the third centre.
        by_links: all centres, by their pairs of links.
        near: positions (m) of those centres that are on the sheet, by their pairs of links.
    """
    through = [by_links[links] for links in line]
    three = (*through, centre)
    along = _line_direction(through)
    ends = [sheet.on(near[member.links]) for member in three if member.links in near]
    if not ends:
        return
    first = ends[0]
    for member in three:
        if member.links not in near:
            behind = member.place is not None and dot(sheet.on(member.place) - first, along) < 0
            ends.append(leave_field(first, first + (-FAR_AWAY if behind else FAR_AWAY) * along, *sheet.field))
    low, high = (end(ends, key=lambda p: float(dot(p, along))) for end in (min, max))
    if abs(high - low) > CENTRE_RADIUS:
        sheet.line([low, high], INERTIA_COLOUR, 0.7, "-.", 1.5, faint=True)


def _line_direction(through: Sequence[InstantCentre]) -> complex:
    first, other = through
    if first.place is not None and other.place is not None:
        offset = other.place - first.place
        return offset / abs(offset) if offset else 1 + 0j
    return complex(first.direction or other.direction or 1)


def _distant_centre_notes(centres: Sequence[InstantCentre], near: Mapping[LinkPair, complex]) -> Iterator[str]:
    """Yield notes on centres that are not on the sheet: at infinity, or too far away."""
    for centre in centres:
        symbol = Symbol("P", centre_name(centre.links)[1:]).name
        if centre.place is None and centre.direction is not None:
            angle = numeral(float(np.degrees(np.angle(centre.direction))) % 180, ".1f")
            yield _("{centre} is at infinity, in direction {angle}°").format(centre=symbol, angle=angle)
        elif centre.place is not None and centre.links not in near:
            yield _("{centre} lies off the sheet: see the table").format(centre=symbol)
