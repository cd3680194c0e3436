"""The frame's symbols, hatched: supports of hinges and guides of boxes. No rod runs through their hatching."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from tmm_cli.drawing.paper import DARK, Sheet, Style, Words, hatch
from tmm_cli.drawing.symbols.forms import Form, Line
from tmm_cli.drawing.symbols.scene import ON_LINE, Scene, apart
from tmm_cli.mechanics.numerics import Vector, cross, dot, unit

WELD = 3.2  # mm: leg of a rigid corner's mark
CLEAR = 3.2  # mm about the number on a plate
GAP = 0.5  # mm between a box and its rails
MASS = 1.4  # mm: radius of a centre of mass
FREE = "#6a6a6a"  # what a lead would be joined to
PALETTE = ("#b3261e", "#1f4e9c", "#1d7a3a", "#7a3d99", "#b86a00", "#00757d", "#8a3b5c", "#5f6b00", "#3d4a5c")
CORNERS = ((1, 1), (-1, 1), (-1, -1), (1, -1))


@dataclass(frozen=True)
class Look:
    """Sizes of symbols, mm; widths of lines, points.

    measured: to scale, links by their points, guides as long as the way on them. stone: a slider on a moving link;
    sides: where labels keep off a bar, mm from its middle line. moves: each body is drawn once, and then moves.
    """

    measured: bool
    hinge: float
    box: tuple[float, float]
    stone: tuple[float, float]
    support: tuple[float, float]  # height of the triangle, half its base
    bar: float
    sides: tuple[complex, ...]
    moves: bool = False

    def sized(self, size: float) -> Look:
        """Smaller symbols, where pairs are near to one another."""
        length, width = self.box
        height, half = self.support
        box = (size * length, size * width)
        return replace(self, hinge=size * self.hinge, box=box, stone=box, support=(size * height, size * half))

    def raised(self) -> Look:
        """With supports that reach beyond a stone on their hinge."""
        height, half = self.support
        return replace(self, support=(height + self.stone[1] / 2, half))


MEASURED = Look(True, 1.3, (9.0, 5.0), (7.5, 4.2), (5.6, 3.4), 2.4, (0j,))
MOVING = replace(MEASURED, moves=True)
STRUCTURAL = Look(False, 1.7, (10.0, 6.0), (10.0, 6.0), (6.0, 3.4), 2.7, (0.8j, -0.8j))
PLATE = "#eceff3"  # of measured drawings


def tint(colour: str, share: float = 0.16) -> str:
    """A colour mixed with white, for areas."""
    parts = (int(colour[n : n + 2], 16) for n in (1, 3, 5))
    return "#" + "".join(f"{round(255 - share * (255 - part)):02x}" for part in parts)


def mass_centre(sheet: Sheet, at: complex) -> None:
    """A centre of mass: a circle with two dark quarters."""
    sheet.circle(at, MASS, "white", DARK, 0.8, 6.2)
    for first in (0.0, np.pi):
        arc = at + MASS * unit(first + np.linspace(0, np.pi / 2, 9))
        sheet.area([at, *(complex(p) for p in arc)], DARK, "none", 0.0, 6.3, blocks=False)


def body(sheet: Sheet, form: Form, colour: str, look: Look) -> None:
    """A link as bars and plates."""
    if len(form.hull) > 2:
        sheet.area(form.hull, PLATE if look.measured else tint(colour), colour, 1.5, 2.2)
    guides = [bar.tips for bar in form.bars]
    for start, end in form.lines:
        # a guide goes behind its stone, a link that is only hinged to a stone comes in front of it
        behind = (start, end) in guides or any(abs(p - at) < ON_LINE for p in (start, end) for at in form.boxes)
        sheet.line([start, end], colour, look.bar, z=3 if behind else 4.5, blocks=False)
        if abs(end - start) > ON_LINE:
            for side in look.sides:  # a bar is wider than a line
                shift = side * (end - start) / abs(end - start)
                sheet.ground.line(start + shift, end + shift)
    for at, one, other in form.welds:
        hidden = look.hinge if any(abs(at - joint) < ON_LINE for joint in form.joints) else 0.0
        weld(sheet, at, one, other, colour, hidden)


def weld(sheet: Sheet, at: complex, one: complex, other: complex, colour: str, hidden: float = 0.0) -> None:
    """The mark of a rigid corner between two legs; a circle of the radius `hidden` (mm) covers its tip."""
    if min(abs(one), abs(other)) > 0.5:
        legs = [min(WELD + hidden, abs(leg)) * leg / abs(leg) for leg in (one, other)]
        sheet.area([at, at + legs[0], at + legs[1]], colour, colour, 0.5, 3.1)


def box(
    sheet: Sheet, at: complex, along: complex, colour: str, size: tuple[float, float], look: Look, style: Style = "-"
) -> None:
    """A slider or stone; dashed where it is only what a lead is joined to."""
    length, width = size
    corners = [at + along * complex(sx * length / 2, sy * width / 2) for sx, sy in CORNERS]
    for share in (0.25, -0.25):  # nothing is written into a box
        shift = 1j * along * share * width
        sheet.ground.line(at + shift - along * length / 2, at + shift + along * length / 2)
    if style == "-":
        face = "white" if colour == DARK or look.measured else tint(colour, 0.07)
        sheet.area(corners, face, colour, 1.3, 4)
    else:
        sheet.area(corners, "white", "none", 0.0, 4)
        sheet.line([*corners, corners[0]], colour, 1.2, style, 4.1)


def rails(sheet: Sheet, start: complex, end: complex, width: float) -> None:
    """What a lead would slide in: two lines along the way of a box of this width."""
    along = (end - start) / abs(end - start)
    for side in (1j * along, -1j * along):
        shift = side * (width / 2 + GAP)
        sheet.line([start + shift, end + shift], FREE, 1.0, "--", 2.5)


def quiet(
    sheet: Sheet, at: complex, wish: complex, reach: float, choices: Iterable[complex] = (), from_: float = 1.8
) -> complex:
    """The direction from a place in which the least is drawn; near `wish` when there is a choice."""
    crowd = sheet.ground.crowd
    crowd = crowd[np.abs(crowd - at) < 2 * reach] - at

    def cost(way: complex) -> float:
        run, off = dot(way, crowd), np.abs(cross(way, crowd))
        turned = abs(np.angle(way / wish))
        return float(np.count_nonzero((run > from_) & (run < reach) & (off < 0.45 * reach))) + 2.0 * turned

    turns = (0, 1, -1, 2, -2, 3, -3, 4, -4, 6, -6, 8)
    return min(choices or [wish * complex(unit(np.pi / 8 * n)) for n in turns], key=cost)


def turning_arrow(sheet: Sheet, pivot: complex, start: float, sense: int, name: Words, colour: str) -> None:
    """An arrow of rotation about a pivot; it begins beside the link, or where there is more room."""
    radius, crowd = 8.5, sheet.ground.crowd

    def arc(first: float) -> list[complex]:
        return [pivot + radius * complex(unit(first + sense * a)) for a in np.linspace(0, 1.5, 24)]

    def cost(first: float) -> int:
        return sum(int(np.count_nonzero(np.abs(crowd - p) < 2.2)) for p in arc(first))

    places = arc(min((start + sense * turn for turn in (0.35, 1.1, 1.9, 2.7, 3.5, 4.3)), key=cost))
    sheet.line(places[:-5], colour, 1.2, z=5)
    sheet.arrow(places[-9], places[-1], colour, 1.2)
    sheet.label(name, places[11], 10, colour)


def sliding_arrow(sheet: Sheet, at: complex, along: complex, width: float, name: Words, colour: str) -> None:
    """The way of a driven slider, beside its box of this width."""
    side = quiet(sheet, at, 1j * along, 14, (1j * along, -1j * along), from_=5)
    foot = at + side * (width / 2 + 8)
    sheet.arrow(foot - 6 * along, foot + 8 * along, colour, 1.3)
    sheet.label(name, foot + 8 * along, 10, colour)


def symbol_size(sheet: Sheet, scene: Scene, links: Iterable[str]) -> float:
    """1, or less where pairs of these links are so near to one another on paper that symbols would cover them."""
    places = apart(sheet.on(scene.at(p)) for link in links for p in scene.of(link))
    gaps = [abs(p - q) for n, p in enumerate(places) for q in places[:n]]
    return float(np.clip(min(gaps, default=10.0) / 6.5, 0.5, 1.0))


def numbers(sheet: Sheet, forms: Mapping[str, Form], hue: Mapping[str, str]) -> None:
    """The numbers of links: in the middle of a plate where nothing is drawn there, or beside the link."""
    for link, form in forms.items():
        if len(form.hull) > 2 and np.all(np.abs(sheet.ground.crowd - form.middle) > CLEAR):
            sheet.text(form.middle, link, 11, colour=hue[link], ha="center", style="italic")
        else:
            sheet.label(link, form.middle, 11, hue[link], "italic")


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


def guide(sheet: Sheet, middle: complex, along: complex, look: Look, reach: float, rods: Sequence[Line] = ()) -> None:
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
