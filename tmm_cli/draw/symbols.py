"""Symbols of structural schemes: links by their pairs alone, hinges, stones, guides, supports, free leads."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from tmm_cli.draw.labels import Label, extent
from tmm_cli.draw.scene import BEYOND, BOX, HINGE, ON_LINE, Form, Scene, apart
from tmm_cli.draw.scheme import hatch
from tmm_cli.draw.sheet import DARK, Sheet
from tmm_cli.vectors import Vector, cross, dot, unit

BAR, WELD = 2.7, 3.2  # width of a bar (points); leg of a rigid corner's mark
FREE = "#6a6a6a"  # what a lead would be joined to
PALETTE = ("#b3261e", "#1f4e9c", "#1d7a3a", "#7a3d99", "#b86a00", "#00757d", "#8a3b5c", "#5f6b00", "#3d4a5c")


def tint(colour: str, share: float = 0.16) -> str:
    """A colour mixed with white, for areas."""
    parts = (int(colour[n : n + 2], 16) for n in (1, 3, 5))
    return "#" + "".join(f"{round(255 - share * (255 - part)):02x}" for part in parts)


def body(sheet: Sheet, shape: Form, colour: str) -> None:
    """A link as bars and plates."""
    if len(shape.hull) > 2:
        sheet.area(shape.hull, tint(colour), colour, 1.6, 2.2)
    guides = [bar.tips for bar in shape.bars]
    for start, end in shape.lines:
        # a guide goes behind its stone, a link that is only hinged to a stone comes in front of it
        behind = (start, end) in guides or any(abs(p - at) < ON_LINE for p in (start, end) for at in shape.boxes)
        sheet.line([start, end], colour, BAR, z=3 if behind else 4.5, blocks=False)
        if abs(end - start) > ON_LINE:
            for side in (0.8j, -0.8j):  # a bar is wider than a line
                shift = side * (end - start) / abs(end - start)
                sheet.ground.line(start + shift, end + shift)
    for at, one, other in shape.welds:
        if min(abs(one), abs(other)) > 0.5:
            reach = WELD + (HINGE if any(abs(at - joint) < ON_LINE for joint in shape.joints) else 0.0)
            legs = [min(reach, abs(leg)) * leg / abs(leg) for leg in (one, other)]
            sheet.area([at, at + legs[0], at + legs[1]], colour, colour, 0.5, 3.1)


def box(sheet: Sheet, at: complex, along: complex, colour: str, size: float, *, style: str = "-") -> None:
    """A stone or slider; dashed where it is only what a lead is joined to, hatched when it is the frame."""
    length, width = BOX[0] * size, BOX[1] * size
    signs = ((1, 1), (-1, 1), (-1, -1), (1, -1))
    corners = [at + along * complex(sx * length / 2, sy * width / 2) for sx, sy in signs]
    for share in (0.25, -0.25):  # nothing is written into a box
        shift = 1j * along * share * width
        sheet.ground.line(at + shift - along * length / 2, at + shift + along * length / 2)
    if style == "-":
        sheet.area(corners, "white" if colour == DARK else tint(colour, 0.07), colour, 1.4, 4)
    else:
        sheet.area(corners, "white", "none", 0.0, 4)
        sheet.line([*corners, corners[0]], colour, 1.2, style, 4.1)
    if colour == DARK:
        hatch(sheet, corners[1], corners[0], 1j * along)
        hatch(sheet, corners[2], corners[3], -1j * along)


def hinge(
    sheet: Sheet, at: complex, colours: Sequence[str], size: float, threads: Sequence[tuple[complex, str]]
) -> None:
    """A turning pair as a circle, a compound hinge as one circle a pair; bars that go on beyond it cross it."""
    radius = HINGE * size
    for number, colour in reversed(list(enumerate(colours))):
        sheet.circle(at, radius + 0.95 * size * number, "white", colour, 1.3, 6 - 0.01 * number)
    for along, colour in threads:
        sheet.line([at - radius * along, at + radius * along], colour, 0.8 * BAR, z=6.2)


def support(sheet: Sheet, at: complex, size: float) -> complex:
    """The frame at a hinge, on the emptiest side: a triangle on hatched ground. Where its number goes."""
    out = quiet(sheet, at, -1j, 9.0, (-1j, 1j, -1, 1), from_=2.2)
    side = 1j * out
    foot = at + 6.0 * size * out
    low, high = foot - 3.4 * size * side, foot + 3.4 * size * side
    sheet.area([at, low, high], "white", DARK, 1.0, 2.6)
    low, high = low - 1.6 * side, high + 1.6 * side
    sheet.line([low, high], DARK, 1.2, z=2.7)
    hatch(sheet, low, high, out)
    return high


def rails(sheet: Sheet, at: complex, along: complex, size: float) -> complex:
    """A guide on the frame: two hatched rails about the box. Where its number goes."""
    reach = BOX[0] * size / 2 + BEYOND
    for side in (1j * along, -1j * along):
        shift = side * (BOX[1] * size / 2 + 0.6)
        sheet.line([at + shift - reach * along, at + shift + reach * along], DARK, 1.1, z=2.5)
        hatch(sheet, at + shift - reach * along, at + shift + reach * along, side)
    low = -1j * along if (1j * along).imag > 0 else 1j * along
    return at + low * (BOX[1] * size / 2 + 2) + reach * along


def quiet(
    sheet: Sheet, at: complex, wish: complex, reach: float, ways: Iterable[complex] = (), from_: float = 1.8
) -> complex:
    """The direction from a place in which the least is drawn; near `wish` when there is a choice."""
    crowd = _crowd(sheet)
    crowd = crowd[np.abs(crowd - at) < 2 * reach] - at

    def cost(way: complex) -> float:
        run, off = dot(way, crowd), np.abs(cross(way, crowd))
        turned = abs(np.angle(way / wish))
        return float(np.count_nonzero((run > from_) & (run < reach) & (off < 0.45 * reach))) + 2.0 * turned

    turns = (0, 1, -1, 2, -2, 3, -3, 4, -4, 6, -6, 8)
    return min(ways or [wish * complex(unit(np.pi / 8 * n)) for n in turns], key=cost)


def _crowd(sheet: Sheet) -> Vector:
    """Points of what is drawn so far, mm."""
    return np.concatenate(sheet.ground.points) if sheet.ground.points else np.zeros(0, complex)


def turning_arrow(sheet: Sheet, pivot: complex, start: float, sense: int, name: str, colour: str) -> None:
    """An arrow of rotation about a pivot; it begins beside the link, or where there is more room."""
    radius, crowd = 8.5, _crowd(sheet)

    def arc(first: float) -> list[complex]:
        return [pivot + radius * complex(unit(first + sense * a)) for a in np.linspace(0, 1.5, 24)]

    def cost(first: float) -> int:
        return sum(int(np.count_nonzero(np.abs(crowd - p) < 2.2)) for p in arc(first))

    places = arc(min((start + sense * turn for turn in (0.35, 1.1, 1.9, 2.7, 3.5, 4.3)), key=cost))
    sheet.line(places[:-5], colour, 1.2, z=5)
    sheet.arrow(places[-9], places[-1], colour, 1.2)
    sheet.label(name, places[11], 10, colour)


def sliding_arrow(sheet: Sheet, at: complex, along: complex, size: float, name: str, colour: str) -> None:
    """The way of a driven slider, beside it."""
    side = quiet(sheet, at, 1j * along, 14, (1j * along, -1j * along), from_=5)
    foot = at + side * (BOX[1] * size / 2 + 8)
    sheet.arrow(foot - 6 * along, foot + 8 * along, colour, 1.3)
    sheet.label(name, foot + 8 * along, 10, colour)


def symbol_size(sheet: Sheet, scene: Scene, links: Iterable[str]) -> float:
    """1, or less where pairs of these links are so near to one another on paper that symbols would cover them."""
    places = apart(sheet.on(scene.at(p)) for link in links for p in scene.of(link))
    gaps = [abs(p - q) for n, p in enumerate(places) for q in places[:n]]
    return float(np.clip(min(gaps, default=10.0) / 6.5, 0.5, 1.0))


def number(sheet: Sheet, link: str, shape: Form, colour: str) -> None:
    """The number of a link: on its plate, or beside its bar."""
    label = Label(link, shape.middle, 11, colour, "italic")
    if len(shape.hull) < 3 or shape.room < 3.2 or not np.isfinite(label.anchor):
        sheet.labels.append(label)
        return
    width, height = extent(label)
    x, y = label.anchor.real, label.anchor.imag
    sheet.ground.boxes.append((x - width / 2, x + width / 2, y - height / 2, y + height / 2))
    sheet.text(label.anchor, link, label.size, colour=colour, ha="center", style=label.style)


def settle(sheet: Sheet) -> None:
    """Place the labels that are waiting, in the field that the ground has now."""
    for label in sheet.labels:
        at = sheet.ground.place(label)
        sheet.text(at, label.text, label.size, colour=label.colour, ha="center", style=label.style)
    sheet.labels.clear()
