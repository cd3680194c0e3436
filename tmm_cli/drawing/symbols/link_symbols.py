"""Symbols of links, sliders and the frame: bars and plates, boxes, supports, hatched guides, arrows of motion."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from tmm_cli.drawing.paper import DARK_COLOUR, DrawingSheet, Style, Words, draw_hatching
from tmm_cli.drawing.symbols.link_forms import LinkForm, Segment
from tmm_cli.drawing.symbols.scene import ON_LINE, MechanismScene, drop_coincident
from tmm_cli.mechanics.numerics import Vector, cross, dot, unit

WELD_LEG = 3.2  # mm: leg of a rigid corner's mark
NUMBER_CLEARANCE = 3.2  # mm about the number on a plate
RAIL_GAP = 0.5  # mm between a box and its rails
MASS_RADIUS = 1.4  # mm: radius of a centre of mass
FREE_COLOUR = "#6a6a6a"  # colour of the link to which an external pair would be joined
PART_COLOURS = ("#b3261e", "#1f4e9c", "#1d7a3a", "#7a3d99", "#b86a00", "#00757d", "#8a3b5c", "#5f6b00", "#3d4a5c")
BOX_CORNERS = ((1, 1), (-1, 1), (-1, -1), (1, -1))


@dataclass(frozen=True)
class SymbolStyle:
    """Sizes of symbols (mm) and widths of lines (points).

    Attributes:
        measured: True for a drawing to scale, False for a structural scheme.
        hinge: radius of a hinge.
        box: length and width of a slider on the frame.
        block: length and width of a sliding block on a moving link.
        support: height and half the base of the triangle of a support.
        bar: width of a bar.
        sides: distances from the centre line of a bar that labels must not cover.
        moves: True for an animation, in which each body is drawn once and then moved.
    """

    measured: bool
    hinge: float
    box: tuple[float, float]
    block: tuple[float, float]
    support: tuple[float, float]  # height of the triangle, half its base
    bar: float
    sides: tuple[complex, ...]
    moves: bool = False

    def scaled(self, size: float) -> SymbolStyle:
        """Return the style with all symbols scaled by a factor, for pairs that are close to each other."""
        length, width = self.box
        height, half = self.support
        box = (size * length, size * width)
        return replace(self, hinge=size * self.hinge, box=box, block=box, support=(size * height, size * half))

    def with_raised_support(self) -> SymbolStyle:
        """Return the style with higher supports.

        They are needed for a fixed hinge inside a sliding block, which would cover a support of normal height.
        """
        height, half = self.support
        return replace(self, support=(height + self.block[1] / 2, half))


MEASURED = SymbolStyle(True, 1.3, (9.0, 5.0), (7.5, 4.2), (5.6, 3.4), 2.4, (0j,))
MOVING = replace(MEASURED, moves=True)
STRUCTURAL = SymbolStyle(False, 1.7, (10.0, 6.0), (10.0, 6.0), (6.0, 3.4), 2.7, (0.8j, -0.8j))
PLATE_COLOUR = "#eceff3"  # in drawings to scale


def tint_colour(colour: str, share: float = 0.16) -> str:
    """Mix a colour with white. share: fraction of the colour in the mixture."""
    parts = (int(colour[n : n + 2], 16) for n in (1, 3, 5))
    return "#" + "".join(f"{round(255 - share * (255 - channel)):02x}" for channel in parts)


def draw_mass_centre(sheet: DrawingSheet, at: complex) -> None:
    """Draw the symbol of a centre of mass: a circle with two black quarters."""
    sheet.circle(at, MASS_RADIUS, "white", DARK_COLOUR, 0.8, 6.2)
    for first in (0.0, np.pi):
        arc = at + MASS_RADIUS * unit(first + np.linspace(0, np.pi / 2, 9))
        sheet.area([at, *(complex(p) for p in arc)], DARK_COLOUR, "none", 0.0, 6.3, blocks=False)


def draw_body(sheet: DrawingSheet, form: LinkForm, colour: str, look: SymbolStyle) -> None:
    """Draw the bars, plate and rigid corners of a link."""
    if len(form.hull) > 2:
        sheet.area(form.hull, PLATE_COLOUR if look.measured else tint_colour(colour), colour, 1.5, 2.2)
    guides = [bar.tips for bar in form.bars]
    for start, end in form.lines:
        # a guide passes behind its block; a link that is only hinged to a block is in front of it
        behind = (start, end) in guides or any(abs(p - at) < ON_LINE for p in (start, end) for at in form.boxes)
        sheet.line([start, end], colour, look.bar, z=3 if behind else 4.5, blocks=False)
        if abs(end - start) > ON_LINE:
            for side in look.sides:  # a bar is wider than a line
                shift = side * (end - start) / abs(end - start)
                sheet.canvas.line(start + shift, end + shift)
    for at, first_leg, other in form.welds:
        hidden = look.hinge if any(abs(at - joint) < ON_LINE for joint in form.joints) else 0.0
        draw_weld(sheet, at, first_leg, other, colour, hidden)


def draw_weld(
    sheet: DrawingSheet, at: complex, first_leg: complex, other: complex, colour: str, hidden: float = 0.0
) -> None:
    """Draw the mark of a rigid corner.

    Args:
        sheet: sheet to draw on.
        at: vertex of the corner, mm.
        first_leg, other: vectors along its sides, mm.
        colour: colour of the link.
        hidden: radius (mm) of a hinge that covers the vertex.
    """
    if min(abs(first_leg), abs(other)) > 0.5:
        legs = [min(WELD_LEG + hidden, abs(leg)) * leg / abs(leg) for leg in (first_leg, other)]
        sheet.area([at, at + legs[0], at + legs[1]], colour, colour, 0.5, 3.1)


def draw_box(
    sheet: DrawingSheet,
    at: complex,
    along: complex,
    colour: str,
    size: tuple[float, float],
    look: SymbolStyle,
    style: Style = "-",
) -> None:
    """Draw the box of a slider or sliding block.

    A dashed box stands for a link that is not drawn itself, to which an external pair connects the group.
    """
    length, width = size
    corners = [at + along * complex(sx * length / 2, sy * width / 2) for sx, sy in BOX_CORNERS]
    for share in (0.25, -0.25):  # keeps labels out of the box
        shift = 1j * along * share * width
        sheet.canvas.line(at + shift - along * length / 2, at + shift + along * length / 2)
    if style == "-":
        face = "white" if colour == DARK_COLOUR or look.measured else tint_colour(colour, 0.07)
        sheet.area(corners, face, colour, 1.3, 4)
    else:
        sheet.area(corners, "white", "none", 0.0, 4)
        sheet.line([*corners, corners[0]], colour, 1.2, style, 4.1)


def draw_rails(sheet: DrawingSheet, start: complex, end: complex, width: float) -> None:
    """Draw two dashed lines as the guide of a prismatic external pair.

    Args:
        sheet: sheet to draw on.
        start, end: ends of the guide, mm.
        width: width of the box between the lines, mm.
    """
    along = (end - start) / abs(end - start)
    for side in (1j * along, -1j * along):
        shift = side * (width / 2 + RAIL_GAP)
        sheet.line([start + shift, end + shift], FREE_COLOUR, 1.0, "--", 2.5)


def quiet_direction(
    sheet: DrawingSheet, at: complex, wish: complex, reach: float, choices: Iterable[complex] = (), from_: float = 1.8
) -> complex:
    """Return a direction from a point in which the drawing is nearly empty and which is close to a preferred one.

    Args:
        sheet: the sheet.
        at: the point, mm.
        wish: preferred direction.
        reach: length that should be empty, mm.
        choices: directions to choose from; empty: twelve directions around `wish`.
        from_: distance from the point at which this length begins, mm.
    """
    crowd = sheet.canvas.line_points
    crowd = crowd[np.abs(crowd - at) < 2 * reach] - at

    def cost(direction: complex) -> float:
        run, off = dot(direction, crowd), np.abs(cross(direction, crowd))
        turned = abs(np.angle(direction / wish))
        return float(np.count_nonzero((run > from_) & (run < reach) & (off < 0.45 * reach))) + 2.0 * turned

    turns = (0, 1, -1, 2, -2, 3, -3, 4, -4, 6, -6, 8)
    return min(choices or [wish * complex(unit(np.pi / 8 * n)) for n in turns], key=cost)


def draw_rotation_arrow(
    sheet: DrawingSheet, pivot: complex, start: float, sense: int, name: Words, colour: str
) -> None:
    """Draw an arrow around the pivot of a driver, where it covers least, that shows the sense of rotation."""
    radius, crowd = 8.5, sheet.canvas.line_points

    def arc(first: float) -> list[complex]:
        return [pivot + radius * complex(unit(first + sense * a)) for a in np.linspace(0, 1.5, 24)]

    def cost(first: float) -> int:
        return sum(int(np.count_nonzero(np.abs(crowd - p) < 2.2)) for p in arc(first))

    arc_points = arc(min((start + sense * turn for turn in (0.35, 1.1, 1.9, 2.7, 3.5, 4.3)), key=cost))
    sheet.line(arc_points[:-5], colour, 1.2, z=5)
    sheet.arrow(arc_points[-9], arc_points[-1], colour, 1.2)
    sheet.label(name, arc_points[11], 10, colour)


def draw_sliding_arrow(
    sheet: DrawingSheet, at: complex, along: complex, width: float, name: Words, colour: str
) -> None:
    """Draw an arrow beside the box of a driving slider that shows the direction of motion."""
    side = quiet_direction(sheet, at, 1j * along, 14, (1j * along, -1j * along), from_=5)
    foot = at + side * (width / 2 + 8)
    sheet.arrow(foot - 6 * along, foot + 8 * along, colour, 1.3)
    sheet.label(name, foot + 8 * along, 10, colour)


def symbol_scale(sheet: DrawingSheet, scene: MechanismScene, links: Iterable[str]) -> float:
    """Return the factor for the sizes of symbols: 1, or less if pairs are so close that symbols would overlap."""
    points = drop_coincident(sheet.on(scene.at(p)) for link in links for p in scene.lower_pairs(link))
    gaps = [abs(p - q) for n, p in enumerate(points) for q in points[:n]]
    return float(np.clip(min(gaps, default=10.0) / 6.5, 0.5, 1.0))


def draw_link_numbers(sheet: DrawingSheet, forms: Mapping[str, LinkForm], hue: Mapping[str, str]) -> None:
    """Write the numbers of links in the middle of their plates or beside them."""
    for link, form in forms.items():
        if len(form.hull) > 2 and np.all(np.abs(sheet.canvas.line_points - form.middle) > NUMBER_CLEARANCE):
            sheet.text(form.middle, link, 11, colour=hue[link], ha="center", style="italic")
        else:
            sheet.label(link, form.middle, 11, hue[link], "italic")


HATCH_DEPTH = 1.7  # mm
ROD_CLEARANCE = 0.6  # mm between rods and hatching
OPENING_CLEARANCE = 1.1  # mm on either side of a rod in an opening of the hatching
TRIANGLE_CLEARANCE = 0.2  # mm between rods and the triangle of a support
GROUND_HALF_WIDTHS = 2.2  # half width of the hatched ground, relative to that of the triangle
LEAST_RAIL = 2.0  # mm: shorter pieces of a rail are left out
ROD_STEP = 0.4  # mm between sample points of a rod


def support_side(sheet: DrawingSheet, at: complex, rods: Sequence[Segment], look: SymbolStyle = MEASURED) -> complex:
    """Choose the direction of the support of a fixed hinge.

    It points down if no bar crosses it there, otherwise up. If bars cross it in both directions, the direction in which
    they cross it least is chosen.
    """
    height, half = look.support

    def lost(out: complex) -> float:
        """Return the length of hatching (mm) that bars would interrupt.

        A penalty is added for each bar that crosses the triangle of the support.
        """
        ground = free_runs(
            -GROUND_HALF_WIDTHS * half, GROUND_HALF_WIDTHS * half, _covered_runs(rods, at + height * out, 1j * out, out)
        )
        free = sum(high - low for low, high in ground)
        return 2 * GROUND_HALF_WIDTHS * half - free + 3 * half * sum(through(rod, out) for rod in rods)

    def through(rod: Segment, out: complex) -> bool:
        points = _rod_points(rod) - at
        run, off = dot(out, points), np.abs(cross(out, points))
        return bool(
            np.any(
                (run > look.hinge + ROD_CLEARANCE) & (run < height) & (off < half * run / height + TRIANGLE_CLEARANCE)
            )
        )

    directions = [complex(unit(np.pi / 8 * n)) for n in (-4, 4, 0, 8, -2, -6, 2, 6, -3, -5, -1, -7, 3, 5, 1, 7)]
    for among in (directions[:2], directions[2:4], directions):
        losses = [lost(direction) for direction in among]
        if min(losses) < ROD_STEP:
            break
    least = [direction for direction, loss in zip(among, losses, strict=True) if loss < min(losses) + ROD_STEP]
    return quiet_direction(sheet, at, -1j, 9.0, least, from_=2.2)


def draw_support(
    sheet: DrawingSheet, at: complex, out: complex, look: SymbolStyle = MEASURED, rods: Sequence[Segment] = ()
) -> complex:
    """Draw the support of a fixed hinge: a triangle on a hatched line.

    Args:
        sheet: sheet to draw on.
        at: the hinge, mm.
        out: direction from the hinge to the hatched line.
        look: style of the symbols.
        rods: bars at which the hatching is interrupted, mm.

    Returns:
        The point for the number of the frame, mm.
    """
    side = 1j * out
    height, half = look.support
    foot = at + height * out
    low, high = foot - half * side, foot + half * side
    with sheet.on_layer("supports"):
        sheet.area([at, low, high], "white", DARK_COLOUR, 1.0, 2.6)
    draw_hatched_line(sheet, foot, side, out, GROUND_HALF_WIDTHS * half, rods)
    return foot + GROUND_HALF_WIDTHS * half * side


def draw_guide(
    sheet: DrawingSheet, middle: complex, along: complex, look: SymbolStyle, reach: float, rods: Sequence[Segment] = ()
) -> None:
    """Draw a guide on the frame as two hatched rails, interrupted where bars pass.

    Args:
        sheet: sheet to draw on.
        middle: middle of the guide, mm.
        along: unit vector along the guide.
        look: style of the symbols.
        reach: half the length of the guide, mm.
        rods: bars at which the hatching is interrupted, mm.
    """
    for side in (1j * along, -1j * along):
        draw_hatched_line(sheet, middle + side * (look.box[1] / 2 + RAIL_GAP), along, side, reach, rods)


def draw_hatched_line(
    sheet: DrawingSheet, middle: complex, along: complex, out: complex, reach: float, rods: Sequence[Segment]
) -> None:
    """Draw a line of the frame with hatching on its outer side, interrupted where bars pass."""
    for low, high in free_runs(-reach, reach, _covered_runs(rods, middle, along, out)):
        start, end = middle + low * along, middle + high * along
        with sheet.on_layer("supports"):
            sheet.line([start, end], DARK_COLOUR, 1.2, z=2.7)
        draw_hatching(sheet, start, end, out)


def _covered_runs(rods: Sequence[Segment], rail: complex, along: complex, out: complex) -> list[tuple[float, float]]:
    """Return the intervals along a rail (mm) in which bars cross its hatching."""
    intervals = []
    for rod in rods:
        points = _rod_points(rod) - rail
        inside = dot(along, points)[
            (dot(out, points) > -ROD_CLEARANCE) & (dot(out, points) < HATCH_DEPTH + ROD_CLEARANCE)
        ]
        if len(inside):
            intervals.append((float(np.min(inside)) - OPENING_CLEARANCE, float(np.max(inside)) + OPENING_CLEARANCE))
    return intervals


def _rod_points(rod: Segment) -> Vector:
    """Return closely spaced points along a bar."""
    return np.linspace(rod[0], rod[1], int(abs(rod[1] - rod[0]) / ROD_STEP) + 2)


def free_runs(low: float, high: float, covered: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """Return the parts of the interval from `low` to `high` that are not covered. Very short parts are omitted."""
    edges = [low]
    for first, last in sorted(covered):
        edges += [max(first, edges[-1]), max(last, edges[-1])]
    edges.append(high)
    pieces = [(first, min(last, high)) for first, last in zip(edges[::2], edges[1::2], strict=True)]
    return [(first, last) for first, last in pieces if last - first >= LEAST_RAIL]
