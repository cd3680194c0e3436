"""Table of lengths on the sheet of positions: lengths of links, pitch radii, positions of hinges and guides on the
frame.
"""

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
    """Return the rows of the table of lengths, in the units of the file.

    If a length has another name in the file than on the drawing, the table has a column with the names in the file.
    """
    sizes = [*_link_lengths(results), *_gear_radii(results.linkage), *_frame_sizes(results)]
    units = results.problem.units
    named = any(parameter for __, parameter, *___ in sizes)
    titles: list[Words] = [_("length"), *([_("name in the file")] if named else []), units.spelt(LENGTH)]
    rows = [TableRow(tuple(titles), head=True)]
    for name, parameter, value, dimension in sizes:
        value_text = numeral(units.from_si(value, dimension), ".6g") + (
            f" {units.spelt(ANGLE)}" if dimension == ANGLE else ""
        )
        rows.append(TableRow((name, *([parameter] if named else []), value_text)))
    return rows


def _link_lengths(results: Results) -> Iterator[TableSize]:
    """Yield the lengths that determine the shape of each link.

    These are the distances of its points from the first two of them.
    """
    linkage = results.linkage
    for link in linkage.moving:
        points = list(linkage.links[link].points.items())
        for k, (name, local) in enumerate(points):
            for other, place in points[: min(k, 2)]:
                if abs(local - place) > 0:
                    both = other + name
                    yield both, _length_parameter(results, link, both), float(abs(local - place)), LENGTH


def _gear_radii(linkage: Linkage) -> Iterator[TableSize]:
    """Yield the pitch radii of gears in mesh. If several pairs of gears mesh, the name of the pair is added."""
    teeth = [mesh for mesh in linkage.meshes if mesh.kind != "cam"]
    for mesh in teeth:
        radii = {mesh.i: abs(mesh.ratio)}  # of a gear that rolls on a rack
        if mesh.kind == "gear":
            apart = abs(carrier_axis(linkage, mesh.j, mesh.carrier) - carrier_axis(linkage, mesh.i, mesh.carrier))
            turn = float(apart) / abs(1 - mesh.ratio)
            radii = {mesh.i: turn * abs(mesh.ratio), mesh.j: turn}
        for link, radius in radii.items():
            where = (f" ({mesh.name})",) if len(teeth) > 1 else ()
            yield (Symbol("r", link), *where), "", radius, LENGTH


def _length_parameter(results: Results, link: str, name: str) -> str:
    """Return the name of the parameter in the file that gives the length of a link; empty if there is none.

    Args:
        results: computed results.
        link: name of the link.
        name: name of the length on the drawing, e.g. "AB". If the name of the parameter consists of the same letters,
            it
            adds nothing, and the result is empty.
    """
    link_block = _file_value(results, "links", link)
    ends = link_block.get("points") if isinstance(link_block, dict) else None
    if not isinstance(ends, list) or "".join(map(str, ends)) != name:
        return ""
    return _renaming_parameter(results, link_block.get("length"), name)


def _coordinate_parameter(results: Results, written: Any, place: complex, magnitude: float, name: str) -> str:
    """Return the name of the parameter in the file that gives a coordinate of a point; empty if there is none.

    Args:
        results: computed results.
        written: both coordinates as written in the file.
        place: the point, m.
        magnitude: absolute value of the coordinate, m.
        name: name of the coordinate on the drawing.
    """
    if not isinstance(written, list):
        return ""
    both = zip(written, (place.real, place.imag), strict=False)
    parameters = [
        _renaming_parameter(results, text, name)
        for text, value in both
        if abs(abs(value) - magnitude) <= SAME_POINTS * magnitude
    ]
    return next((parameter for parameter in parameters if parameter), "")


def _renaming_parameter(results: Results, text: Any, name: str) -> str:
    """Return the name of the parameter to which a value in the file refers; empty if it refers to none.

    It is also empty if the name consists of the letters of `name`, in any order.
    """
    parameters, word = _file_value(results, "parameters"), str(text).lstrip("-")
    return word if isinstance(parameters, dict) and word in parameters and sorted(word) != sorted(name) else ""


def _file_value(results: Results, *path: str) -> Any:
    """Return the value under nested keys of the problem file, or None."""
    source = results.problem.source
    block: Any = None if source is None else source.data
    for key in path:
        block = {str(k): value for k, value in block.items()}.get(key) if isinstance(block, dict) else None
    return block


def _frame_sizes(results: Results) -> Iterator[TableSize]:
    """Yield the coordinates of fixed hinges, measured from the first, and the positions of guides on the frame.

    The position of a guide is given by its distance and its slope.
    """
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
            title = _("distance of guide {name} from {point}").format(name=slide.name, point=start or "0")
            yield title, parameter, far, LENGTH
            turn = math.degrees(np.angle(along)) % 180
            if abs(turn - 90 * round(turn / 90)) > 1e-9:
                yield _("slope of guide {name}").format(name=slide.name), "", math.radians(turn), ANGLE
