"""A table of the sizes of a linkage: lengths of its links with the file's parameters, places of pivots and guides."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from tmm_cli.drawing.paper import TableRow, Words
from tmm_cli.language import _, numeral
from tmm_cli.mechanics.analysis import Results
from tmm_cli.mechanics.forces import Symbol
from tmm_cli.mechanics.groups import carrier_axis
from tmm_cli.mechanics.linkage import FRAME, Linkage
from tmm_cli.mechanics.numerics import SAME_POINTS, cross, unit
from tmm_cli.mechanics.quantities import ANGLE, LENGTH, Dimension

TableSize = tuple[Words, str, float, Dimension]


def length_rows(results: Results) -> list[TableRow]:
    """Rows with name and value in the units of the file; between them the parameter, where any is called otherwise."""
    sizes = [*_link_lengths(results), *_gear_radii(results.linkage), *_frame_sizes(results)]
    units = results.problem.units
    named = any(parameter for __, parameter, *___ in sizes)
    titles: list[Words] = [_("length"), *([_("in the file")] if named else []), units.spelt(LENGTH)]
    rows = [TableRow(tuple(titles), head=True)]
    for name, parameter, value, dimension in sizes:
        shown = numeral(units.from_si(value, dimension), ".6g") + (
            f" {units.spelt(ANGLE)}" if dimension == ANGLE else ""
        )
        rows.append(TableRow((name, *([parameter] if named else []), shown)))
    return rows


def _link_lengths(results: Results) -> Iterator[TableSize]:
    """Distances between points of a link, as many as tell where they are: of the first two, then from both of them."""
    linkage = results.linkage
    for link in linkage.moving:
        points = list(linkage.links[link].points.items())
        for k, (name, local) in enumerate(points):
            for other, place in points[: min(k, 2)]:
                if abs(local - place) > 0:
                    both = other + name
                    yield both, _length_parameter(results, link, both), float(abs(local - place)), LENGTH


def _gear_radii(linkage: Linkage) -> Iterator[TableSize]:
    """Radii of pitch circles of wheels in mesh; the mesh is named where there are several."""
    teeth = [mesh for mesh in linkage.meshes if mesh.kind != "cam"]
    for mesh in teeth:
        radii = {mesh.i: abs(mesh.ratio)}  # of one that rolls on a rack
        if mesh.kind == "gear":
            apart = abs(carrier_axis(linkage, mesh.j, mesh.carrier) - carrier_axis(linkage, mesh.i, mesh.carrier))
            turn = float(apart) / abs(1 - mesh.ratio)
            radii = {mesh.i: turn * abs(mesh.ratio), mesh.j: turn}
        for link, radius in radii.items():
            where = (f" ({mesh.name})",) if len(teeth) > 1 else ()
            yield (Symbol("r", link), *where), "", radius, LENGTH


def _length_parameter(results: Results, link: str, name: str) -> str:
    """The parameter of the file that is the length of a link between these points, where it is called otherwise."""
    own = _file_value(results, "links", link)
    ends = own.get("points") if isinstance(own, dict) else None
    if not isinstance(ends, list) or "".join(map(str, ends)) != name:
        return ""
    return _renaming_parameter(results, own.get("length"), name)


def _coordinate_parameter(results: Results, written: Any, place: complex, size: float, name: str) -> str:
    """The parameter that is one of the coordinates of a place, the one of this size."""
    if not isinstance(written, list):
        return ""
    both = zip(written, (place.real, place.imag), strict=False)
    found = [
        _renaming_parameter(results, text, name) for text, value in both if abs(abs(value) - size) <= SAME_POINTS * size
    ]
    return next((parameter for parameter in found if parameter), "")


def _renaming_parameter(results: Results, text: Any, name: str) -> str:
    """The parameter that a text of the file consists of, where its letters are others than those of a name."""
    known, word = _file_value(results, "parameters"), str(text).lstrip("-")
    return word if isinstance(known, dict) and word in known and sorted(word) != sorted(name) else ""


def _file_value(results: Results, *path: str) -> Any:
    """What the file has there; None where it has nothing."""
    source = results.problem.source
    found: Any = None if source is None else source.data
    for key in path:
        found = {str(k): value for k, value in found.items()}.get(key) if isinstance(found, dict) else None
    return found


def _frame_sizes(results: Results) -> Iterator[TableSize]:
    """Pivots on the frame from the first of them, and guides on the frame by their distance from it and their slope."""
    linkage = results.linkage
    pivots = {h.point: complex(linkage.local(FRAME, h.point)) for h in linkage.hinges if FRAME in h.links}
    start, origin = next(iter(pivots.items()), ("", 0j))
    for name, place in list(pivots.items())[1:]:
        off, both = place - origin, start + name
        if min(abs(off.real), abs(off.imag)) < SAME_POINTS * abs(off):
            parameter = _coordinate_parameter(results, _file_value(results, "points", name), place, abs(off), both)
            yield both, parameter, abs(off), LENGTH
        else:
            yield from (((Symbol("x", name),), "", off.real, LENGTH), ((Symbol("y", name),), "", off.imag, LENGTH))
    for slide in linkage.slides:
        if slide.carrier == FRAME:
            along, through = complex(unit(slide.direction)), complex(slide.through)
            far = abs(float(cross(along, origin - through)))
            far = far if far > SAME_POINTS * abs(through) else 0.0
            written = _file_value(results, "guides", slide.name, "through")
            parameter = _coordinate_parameter(results, written, through, far, "") if far else ""
            title = _("guide {name} from {point}").format(name=slide.name, point=start or "0")
            yield title, parameter, far, LENGTH
            turn = math.degrees(np.angle(along)) % 180
            if abs(turn - 90 * round(turn / 90)) > 1e-9:
                yield _("slope of {name}").format(name=slide.name), "", math.radians(turn), ANGLE
