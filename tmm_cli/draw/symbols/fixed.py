"""The frame's symbols, hatched: supports of hinges and guides of boxes. No rod runs through their hatching."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tmm_cli.draw.paper.sheet import DARK, Sheet, hatch
from tmm_cli.draw.symbols.forms import Line
from tmm_cli.draw.symbols.parts import GAP, MEASURED, Look, quiet
from tmm_cli.vectors import Vector, cross, dot, unit

HATCHED, WALL, OPEN = 1.7, 0.6, 1.1  # mm: depth of hatching, how far rods keep off it, room beside them in an opening
BARE = 0.2  # mm: how far rods keep off a support's triangle
GROUND = 2.2  # half widths of a support's triangle: its hatched ground
PIECE, FINE = 2.0, 0.4  # mm: the shortest piece of a rail, between places along a rod


def support_side(sheet: Sheet, at: complex, rods: Sequence[Line], look: Look = MEASURED) -> complex:
    """The side of a fixed hinge where its support is: below, else above, else where no rod runs through it."""
    height, half = look.support

    def lost(out: complex) -> float:
        """Of its ground, mm, and more for a rod through its triangle."""
        ground = free_runs(-GROUND * half, GROUND * half, _all_covered(rods, at + height * out, 1j * out, out))
        free = sum(high - low for low, high in ground)
        return 2 * GROUND * half - free + 3 * half * sum(through(rod, out) for rod in rods)

    def through(rod: Line, out: complex) -> bool:
        places = _places(rod) - at
        run, off = dot(out, places), np.abs(cross(out, places))
        return bool(np.any((run > look.hinge + WALL) & (run < height) & (off < half * run / height + BARE)))

    ways = [complex(unit(np.pi / 8 * n)) for n in (-4, 4, 0, 8, -2, -6, 2, 6, -3, -5, -1, -7, 3, 5, 1, 7)]
    for among in (ways[:2], ways[2:4], ways):
        losses = [lost(way) for way in among]
        if min(losses) < FINE:
            break
    least = [way for way, loss in zip(among, losses, strict=True) if loss < min(losses) + FINE]
    return quiet(sheet, at, -1j, 9.0, least, from_=2.2)


def support(sheet: Sheet, at: complex, out: complex, look: Look = MEASURED, rods: Sequence[Line] = ()) -> complex:
    """The frame at a hinge: a triangle on hatched ground. Where its number goes."""
    side = 1j * out
    height, half = look.support
    foot = at + height * out
    low, high = foot - half * side, foot + half * side
    with sheet.on_layer("supports"):
        sheet.area([at, low, high], "white", DARK, 1.0, 2.6)
    wall(sheet, foot, side, out, GROUND * half, rods)
    return foot + GROUND * half * side


def guide(
    sheet: Sheet, middle: complex, along: complex, look: Look, reach: float, rods: Sequence[Line] = ()
) -> None:  # fmt: skip
    """A piece of the frame's guide, so long (mm) on both sides: hatched rails, open where rods go through."""
    for side in (1j * along, -1j * along):
        wall(sheet, middle + side * (look.box[1] / 2 + GAP), along, side, reach, rods)


def wall(sheet: Sheet, middle: complex, along: complex, out: complex, reach: float, rods: Sequence[Line]) -> None:
    """A line with hatching on its outer side, open where rods go through."""
    for low, high in free_runs(-reach, reach, _all_covered(rods, middle, along, out)):
        start, end = middle + low * along, middle + high * along
        with sheet.on_layer("supports"):
            sheet.line([start, end], DARK, 1.2, z=2.7)
        hatch(sheet, start, end, out)


def _all_covered(rods: Sequence[Line], rail: complex, along: complex, out: complex) -> list[tuple[float, float]]:
    """The runs (mm) along a rail in whose hatching rods are."""
    found = []
    for rod in rods:
        places = _places(rod) - rail
        inside = dot(along, places)[(dot(out, places) > -WALL) & (dot(out, places) < HATCHED + WALL)]
        if len(inside):
            found.append((float(np.min(inside)) - OPEN, float(np.max(inside)) + OPEN))
    return found


def _places(rod: Line) -> Vector:
    """Places along a rod, close together."""
    return np.linspace(rod[0], rod[1], int(abs(rod[1] - rod[0]) / FINE) + 2)


def free_runs(low: float, high: float, covered: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """What is left from low to high without what is covered; pieces too short for hatching are left out."""
    edges = [low]
    for first, last in sorted(covered):
        edges += [max(first, edges[-1]), max(last, edges[-1])]
    edges.append(high)
    pieces = [(first, min(last, high)) for first, last in zip(edges[::2], edges[1::2], strict=True)]
    return [(first, last) for first, last in pieces if last - first >= PIECE]
