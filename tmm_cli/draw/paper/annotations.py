"""Dimension lines and angles on a sheet, as on engineering drawings (GOST 2.307, ISO 129)."""

from __future__ import annotations

import numpy as np

from tmm_cli.draw.paper.boxes import around, aside, row
from tmm_cli.draw.paper.labels import extent
from tmm_cli.draw.paper.sheet import DARK, NAMES, THIN, Sheet
from tmm_cli.vectors import Vector, cross, dot

OFFSETS = (9.0, 12.0, 16.0, 20.0, 25.0, 30.0, 36.0)  # mm of a dimension line from what it measures
OVER, HEAD, TEXT = 1.8, 3.0, 9.0  # mm: extension line over the dimension line, length of an arrow head; points
SHORTEST = 0.4  # mm: smaller sizes are not drawn
WIDEST = 45.0  # mm: largest radius of the arc of an angle
INNER = 4.2  # heads that fit between the extension lines, with a shaft between them
LETTERED = 6.0  # mm about a lettered place: its letter needs room there
AT_HEAD = 0.25  # of the price of what a text covers: of what is near a head
UNWISHED = {"before": 2.0, "after": 1.0, "low": 0.5, "high": 0.5, "wider": 6.0}  # price of where a text stands
BETWEEN = {"middle": 0.5, "low": 0.3, "high": 0.7}  # where a text stands between the heads, shares of the length
UPRIGHT = 0.3  # of a direction: sideways part of a line that is nearly upright


def dimension(sheet: Sheet, start: complex, end: complex, text: str, along: complex = 0j) -> None:
    """A dimension line beside two places (mm), where the least is in its way; text along it, above or left of it.

    The text of a short one goes on along it, at whichever end is free, or stands beside an upright one.
    """
    with sheet.on_layer("dimensions"):
        _dimension(sheet, start, end, text, along)


def _dimension(sheet: Sheet, start: complex, end: complex, text: str, along: complex) -> None:
    span = end - start if along == 0 else along * float(dot(end - start, along)) / abs(along) ** 2
    length = abs(span)
    if length < SHORTEST:
        return
    u = span / length
    crowd = sheet.ground.crowd
    width, height = extent(text, TEXT)
    tail = 2 * HEAD + 3 + width
    fits = length > 2 * HEAD + 1 and length > width + 3
    inner = length > INNER * HEAD
    others = ("after", "before") + ("beside",) * (abs(u.real) < UPRIGHT) + ("wider",) * inner
    stands = tuple(BETWEEN) if fits else others

    def lines(side: complex, offset: float, stand: str) -> tuple[complex, complex, complex, complex]:
        """Ends of the dimension line, middle and direction of the text."""
        foot = max(dot(z, side) for z in (start, end)) + offset
        first, last = (z + (foot - dot(z, side)) * side for z in (start, end))
        middle = first + BETWEEN.get(stand, 0.5) * (last - first)
        if stand == "beside":
            return first, last, middle + np.sign(side.real) * (width / 2 + 1.0 + height / 2 * abs(u.real)), 1 + 0j
        if stand in ("after", "before"):
            reach = 2 * HEAD + 1.5 + width / 2
            middle = last + u * reach if stand == "after" else first - u * reach
        return first, last, middle + (height / 2 + 0.7) * up_of(u), u

    def least(offset: float, stand: str) -> float:
        return 0.25 * offset + UNWISHED.get(stand, 0.0)

    def cost(side: complex, offset: float, stand: str) -> float:
        first, last, middle, v = lines(side, offset, stand)
        outer = 0.0 if inner else 2 * HEAD
        low_run, high_run = (tail if stand == one else outer for one in ("before", "after"))
        stretch = first - (low_run + 1) * u, last + (high_run + 1) * u
        found = 4.0 * sum(aside(z, *stretch) < LETTERED for z in sheet.ground.rivals)
        legs = [(z, foot + 2 * OVER * side) for z, foot in ((start, first), (end, last))]
        found += beside(crowd, *stretch, 1.5) + sheet.ground.crossed([*legs, stretch])
        found += 0.5 * sum(beside(crowd, z + 4 * side, foot, 0.8) for z, foot in ((start, first), (end, last)))
        squares = np.array([*row(middle, v, width, height), first, last])
        prices = sheet.ground.price(around(squares, height, height))
        found += float(prices[:-2].sum() + AT_HEAD * prices[-2:].sum())
        return found + least(offset, stand)

    choices = [(1j * u * s, o, stand) for o in OFFSETS for s in (1, -1) for stand in stands]
    (side, offset, stand), price = choices[0], cost(*choices[0])
    for choice in choices[1:]:
        if least(*choice[1:]) < price and (own := cost(*choice)) < price:
            (side, offset, stand), price = choice, own
    first, last, middle, v = lines(side, offset, stand)
    for z, foot in ((start, first), (end, last)):
        if abs(foot - z) > 2.5:
            sheet.line([z + 2 * side, foot + OVER * side], THIN, 0.6, z=1.4, faint=True)
    if not inner:
        sheet.line([first, last], DARK, 0.6, z=4.5)
    backs = (last, first) if inner else (first - 2 * HEAD * u, last + 2 * HEAD * u)  # of short ones heads from outside
    for back, tip in zip(backs, (first, last), strict=True):
        sheet.arrow(back, tip, DARK, 0.6, 4.5)
    if stand in ("after", "before"):  # the line goes on under the text
        sheet.line([last, last + u * tail] if stand == "after" else [first, first - u * tail], DARK, 0.6, z=4.5)
    sheet.along(middle, text, TEXT, v)


def up_of(u: complex) -> complex:
    """The side of a line on which its text stands: above it, or left of an upright one."""
    turned = 1j * u
    return turned if turned.imag > 1e-6 or (abs(turned.imag) <= 1e-6 and turned.real < 0) else -turned


def beside(crowd: Vector, start: complex, end: complex, width: float) -> int:
    """How many points are nearer to a stretch of a line than this, on both sides of it."""
    along = (end - start) / abs(end - start)
    run, off = dot(crowd - start, along), np.abs(cross(along, crowd - start))
    return int(np.count_nonzero((run > 0) & (run < abs(end - start)) & (off < width)))


def angle_mark(sheet: Sheet, vertex: complex, first: complex, last: complex, name: str, *, right: bool) -> None:
    """The arc of an angle between the ways to two places (mm), or a square where it is right; its name beside it."""
    with sheet.on_layer("dimensions"):
        _angle_mark(sheet, vertex, first, last, name, right=right)


def _angle_mark(sheet: Sheet, vertex: complex, first: complex, last: complex, name: str, *, right: bool) -> None:
    ways = [(z - vertex) / abs(z - vertex) for z in (first, last)]
    if right:
        corner = 5.4  # beyond the edge of a stone
        sheet.line([vertex + corner * way for way in (ways[0], sum(ways), ways[1])], DARK, 0.8, z=3.2)
        return
    turn = float(np.angle(ways[1] / ways[0]))
    if abs(turn) * WIDEST < SHORTEST:
        return
    room = 0.85 * min(abs(first - vertex), abs(last - vertex))
    radius = float(min(max(9.0, 7.0 / abs(turn)), max(room, 6.0), WIDEST))
    angles = float(np.angle(ways[0])) + np.linspace(0, turn, 30)
    places = [vertex + radius * complex(z) for z in np.exp(1j * angles)]
    sheet.line(places, DARK, 0.7, z=2.6)
    for tail, tip in ((places[8], places[0]), (places[-9], places[-1])):
        if abs(turn) * radius > 7:
            sheet.arrow(tip + (tail - tip) / abs(tail - tip) * 2.2, tip, DARK, 0.5, 4.5)
    sheet.label(name, places[len(places) // 2], 9, NAMES, "italic")
