"""A chain given by pairs alone, as a scheme: links in rows by how far they are from the frame, pairs between them."""

from __future__ import annotations

from collections import Counter

from tmm_cli.animate.gallery.turning import Turning
from tmm_cli.draw.formats.svg import element
from tmm_cli.draw.paper.drawing import Area, Circle, Line, Mark, Text
from tmm_cli.draw.paper.sheet import DARK, GREY_TEXT
from tmm_cli.linkage import FRAME
from tmm_cli.structure.spatial import SpatialChain

APART, WIDEST, ROW = 26.0, 34.0, 27.0  # mm between links of the longest row, at most, and between rows
HIGH, LETTER = 6.4, 4.6  # mm: a link's box, its name
SHARE = 0.6  # of a letter's size: its width
BOW = 9.0  # mm by which a pair of two links of a row goes round those between them
NEAR = 0.64  # of a pair's way to the link above: its circle; most links hang on few others
EDGE, LEAST = 4.0, 110.0  # mm: about the scheme, and its least width


def scheme(chain: SpatialChain) -> Turning:
    """The frame below; at each pair the number of its freedoms."""
    places = places_of(chain)
    marks: list[Mark] = []
    between = Counter[frozenset[str]]()
    for pair in chain.pairs:
        ends = frozenset((pair.i, pair.j))
        start, end = places[pair.i], places[pair.j]
        bow, share = (BOW, 0.5) if start.imag == end.imag else (0.0, NEAR if start.imag < end.imag else 1 - NEAR)
        middle = start + share * (end - start) + 1j * bow + between[ends] * HIGH
        between[ends] += 1
        marks.append(Line((start, middle, end), DARK, 0.5))
        marks.append(Circle(middle, 2.3, "white", DARK, 0.3))
        marks.append(Text(middle, str(pair.freedoms), 3.2, GREY_TEXT, "center"))
    for name, place in places.items():
        marks += _box(name, place)
    xs, ys = [abs(z.real) for z in places.values()], [z.imag for z in places.values()]
    half, top = max(max(xs) + APART / 2 + EDGE, LEAST / 2), max(ys) + BOW + EDGE
    sides = (-half, -top, 2 * half, top - min(ys) + HIGH + EDGE)
    return Turning("".join(element(mark, 0.0) for mark in marks), sides)


def _box(name: str, place: complex) -> list[Mark]:
    """A link, with as much of its name as there is room for."""
    most = int((APART - 2) / (SHARE * LETTER))
    text = name if len(name) <= most else f"{name[: most - 1]}…"
    half = max(SHARE * LETTER * len(text), HIGH) / 2 + 0.5 + 0.5j * HIGH
    corners = (place - half, place + half.conjugate(), place + half, place - half.conjugate())
    face = "#c4c4c4" if name == FRAME else "white"
    return [Area(corners, face, DARK, 0.4), Text(place, text, LETTER, DARK, "center")]


def places_of(chain: SpatialChain) -> dict[str, complex]:
    """Middles of the links: row by row, each link as near to those that it hangs on as its row allows."""
    rows = [[FRAME]]
    known = {FRAME}
    while rows[-1]:
        near = [pair.other(link) for link in rows[-1] for pair in chain.pairs if link in (pair.i, pair.j)]
        rows.append([link for link in dict.fromkeys(near) if link not in known])
        known.update(rows[-1])
    rows[-1] = [link for link in chain.links if link not in known]  # what does not hang on the frame
    wide = max(map(len, rows))
    places = {FRAME: 0j}
    for number, row in enumerate(rows[1:], 1):
        held = {link: [pair.other(link) for pair in chain.pairs if link in (pair.i, pair.j)] for link in row}
        below = {link: [places[one].real for one in others if one in places] for link, others in held.items()}
        across = {link: sum(xs) / len(xs) if xs else 0.0 for link, xs in below.items()}
        step = min(WIDEST, APART * (wide - 1) / max(len(row) - 1, 1))
        for k, link in enumerate(sorted(row, key=across.__getitem__)):
            places[link] = complex((k - (len(row) - 1) / 2) * step, number * ROW)
    return places
