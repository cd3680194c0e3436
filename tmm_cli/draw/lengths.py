"""A table of the sizes of a linkage: lengths of its links with the file's parameters, places of pivots and guides."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from tmm_cli.analysis.pipeline import Results
from tmm_cli.draw.blocks import Row
from tmm_cli.draw.script import Words
from tmm_cli.errors import _
from tmm_cli.linkage import FRAME
from tmm_cli.plans.record import Symbol
from tmm_cli.quantities import ANGLE, LENGTH, Dimension
from tmm_cli.tolerances import SAME_PLACES
from tmm_cli.vectors import cross, unit

Size = tuple[Words, str, float, Dimension]


def lengths(results: Results) -> list[Row]:
    """Rows with name and value in the units of the file; between them the parameter, where any is called otherwise."""
    sizes = [*_links(results), *_frame(results)]
    units = results.problem.units
    named = any(parameter for __, parameter, *___ in sizes)
    titles: list[Words] = [_("length"), *([_("in the file")] if named else []), units.symbol(LENGTH)]
    rows = [Row(tuple(titles), head=True)]
    for name, parameter, value, dimension in sizes:
        shown = f"{units.from_si(value, dimension):.6g}" + (f" {units.symbol(ANGLE)}" if dimension == ANGLE else "")
        rows.append(Row((name, *([parameter] if named else []), shown)))
    return rows


def _links(results: Results) -> Iterator[Size]:
    """Distances between points of a link, as many as tell where they are: of the first two, then from both of them."""
    linkage = results.linkage
    for link in linkage.moving:
        points = list(linkage.links[link].points.items())
        for k, (name, local) in enumerate(points):
            for other, place in points[: min(k, 2)]:
                if abs(local - place) > 0:
                    both = other + name
                    yield both, _parameter(results, link, both), float(abs(local - place)), LENGTH


def _parameter(results: Results, link: str, name: str) -> str:
    """The parameter of the file that is the length of a link of two points, where it is called otherwise."""
    source = results.problem.source
    links = source.data.get("links") if source is not None else None
    own = next((own for key, own in links.items() if str(key) == link), None) if isinstance(links, dict) else None
    if not isinstance(own, dict) or source is None:
        return ""
    length, ends = own.get("length"), own.get("points")
    known = source.data.get("parameters")
    of_these = isinstance(ends, list) and "".join(map(str, ends)) == name
    told = isinstance(known, dict) and isinstance(length, str) and length in known and sorted(length) != sorted(name)
    return str(length) if of_these and told else ""


def _frame(results: Results) -> Iterator[Size]:
    """Pivots on the frame from the first of them, and guides on the frame by their distance from it and their slope."""
    linkage = results.linkage
    pivots = {h.point: linkage.local(FRAME, h.point) for h in linkage.hinges if FRAME in h.links}
    start, origin = next(iter(pivots.items()), ("", 0j))
    for name, place in list(pivots.items())[1:]:
        across, up = (float(part) for part in ((place - origin).real, (place - origin).imag))
        if min(abs(across), abs(up)) < SAME_PLACES * abs(place - origin):
            yield start + name, "", float(abs(place - origin)), LENGTH
        else:
            yield from (((Symbol("x", name),), "", across, LENGTH), ((Symbol("y", name),), "", up, LENGTH))
    for slide in linkage.slides:
        if slide.carrier == FRAME:
            along = complex(unit(slide.direction))
            off = abs(float(cross(along, origin - slide.through)))
            off = off if off > SAME_PLACES * abs(slide.through) else 0.0
            yield _("guide {name} from {point}").format(name=slide.name, point=start or "0"), "", off, LENGTH
            turn = math.degrees(np.angle(along)) % 180
            if abs(turn - 90 * round(turn / 90)) > 1e-9:
                yield _("slope of {name}").format(name=slide.name), "", math.radians(turn), ANGLE
