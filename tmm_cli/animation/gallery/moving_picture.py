"""Moving picture on a card of the gallery: bodies as SVG, and their positions in a few frames as integers.

Few frames are enough because the page interpolates between them by cubic curves. A spatial chain is drawn as a
diagram: links in rows by their distance from the frame, connected by pairs.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

import numpy as np

from tmm_cli.animation.bodies import MechanismPicture, MovingBody
from tmm_cli.animation.page import SECONDS, draw_first_frame, picture_view
from tmm_cli.drawing.formats import svg_element
from tmm_cli.drawing.paper import DARK_COLOUR, GREY_TEXT, AreaMark, CircleMark, LineMark, Mark, TextMark
from tmm_cli.mechanics.analysis import Results, motion_at_positions
from tmm_cli.mechanics.kinematics import Motion
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.numerics import Real
from tmm_cli.mechanics.structure import SpatialChain

FRAMES = 48  # a turn
MOST_FRAMES = 240  # of mechanisms that repeat after many turns
STEPS_PER_MM, STEPS_PER_RADIAN = 100, 10_000  # steps in a mm of the picture; in a radian, and in a stretch of one

FrameValues = int | list[int]


@dataclass(frozen=True)
class MovingPicture:
    """SVG drawing of a mechanism in the first frame, and the motion of its bodies.

    Attributes:
        svg: SVG elements of the drawing.
        view: view box: left, top, width, height, mm.
        bodies: x, y, angle and stretch of each moving body, as integers in steps of 1/STEPS_PER_MM and
            1/STEPS_PER_RADIAN. A quantity that is constant is one number. Otherwise its first value is followed by the
            differences from frame to frame. Empty if nothing moves.
        loops: True if the last frame equals the first one.
        seconds: duration of the whole motion.
    """

    svg: str
    view: tuple[float, float, float, float]
    bodies: tuple[tuple[FrameValues, FrameValues, FrameValues, FrameValues], ...] = ()
    loops: bool = False
    seconds: float = SECONDS


def draw_moving_picture(results: Results) -> MovingPicture:
    """Draw the moving picture of a mechanism with computed kinematics."""
    turns = results.turns or 1
    motion = _choose_motion(results, min(FRAMES * turns, MOST_FRAMES) + 1)
    still = len(motion.q) < 2
    picture = draw_first_frame(results, motion)
    drawn = list(picture.layers())
    moving = [] if still else [name for name in dict.fromkeys(name for name, __ in drawn) if name != FRAME]
    svg = "".join(
        f"<g{_group_attributes(picture, name, moving)}>{''.join(svg_element(mark, 0.0) for mark in marks)}</g>"
        for name, marks in drawn
    )
    bodies = tuple(_body_frames(picture.bodies[name]) for name in moving)
    return MovingPicture(svg, picture_view(picture), bodies, results.turns > 0, SECONDS * turns)


def _choose_motion(results: Results, count: int) -> Motion:
    """Return the motion of a mechanism over the positions that its file requests.

    If it does not move in them, its motion over the range of the driver is returned; if it does not move there either,
    only the sketched position.
    """
    reach = results.driver_range
    assert reach is not None
    for q in (results.closely(count), np.linspace(reach.start, reach.end, count)):
        motion = motion_at_positions(results, q, 0)
        if np.count_nonzero(motion.moving) > 1 and np.ptp(q) > 0:
            return motion if motion.moving.all() else motion_at_positions(results, q[motion.moving], 0)
    return motion_at_positions(results, np.array([results.linkage.sketch.at]), 0)


def _group_attributes(picture: MechanismPicture, name: str, moving: list[str]) -> str:
    """Return the attributes of the SVG group of a body: its number if it moves, and its first position as a matrix."""
    body = picture.bodies[name]
    if name == FRAME:
        return ""
    z = np.exp(1j * body.angle[0])
    x, y = body.place[0].real, -body.place[0].imag
    matrix = " ".join(f"{round(float(value), 4) + 0.0:g}" for value in (z.real, -z.imag, z.imag, z.real, x, y))
    number = f' data-body="{moving.index(name)}"' if name in moving else ""
    return f'{number} transform="matrix({matrix})"'


def _body_frames(body: MovingBody) -> tuple[FrameValues, FrameValues, FrameValues, FrameValues]:
    """Return x, y, angle and stretch of a body in all frames, in the form of `MovingPicture.bodies`; y points down."""
    return (
        _frame_values(body.place.real * STEPS_PER_MM),
        _frame_values(-body.place.imag * STEPS_PER_MM),
        _frame_values(-body.angle * STEPS_PER_RADIAN),
        _frame_values(body.stretch * STEPS_PER_RADIAN),
    )


def _frame_values(values: Real) -> FrameValues:
    whole = np.rint(values).astype(int)
    if np.all(whole == whole[0]):
        return int(whole[0])
    return [int(whole[0]), *np.diff(whole).tolist()]


# A chain given by pairs alone, as a scheme: links in rows by how far they are from the frame, pairs between them.


APART, WIDEST, ROW = 26.0, 34.0, 27.0  # mm between links of the longest row, at most, and between rows
HIGH, LETTER = 6.4, 4.6  # mm: a link's box, its name
SHARE = 0.6  # of a letter's size: its width
BOW = 9.0  # mm: bow of a pair of two links of one row around those between them
NEAR = 0.64  # of the distance to the link above: place of the circle of a pair
EDGE, LEAST = 4.0, 110.0  # mm: about the scheme, and its least width


def draw_chain(chain: SpatialChain) -> MovingPicture:
    """Draw a spatial chain as a diagram of its links and pairs, with the frame at the bottom.

    Each pair shows its degrees of freedom.
    """
    centres = chain_places(chain)
    marks: list[Mark] = []
    between = Counter[frozenset[str]]()
    for pair in chain.pairs:
        ends = frozenset((pair.i, pair.j))
        start, end = centres[pair.i], centres[pair.j]
        bow, share = (BOW, 0.5) if start.imag == end.imag else (0.0, NEAR if start.imag < end.imag else 1 - NEAR)
        middle = start + share * (end - start) + 1j * bow + between[ends] * HIGH
        between[ends] += 1
        marks.append(LineMark((start, middle, end), DARK_COLOUR, 0.5))
        marks.append(CircleMark(middle, 2.3, "white", DARK_COLOUR, 0.3))
        marks.append(TextMark(middle, str(pair.freedoms), 3.2, GREY_TEXT, "center"))
    for name, place in centres.items():
        marks += _link_box(name, place)
    xs, ys = [abs(z.real) for z in centres.values()], [z.imag for z in centres.values()]
    half, top = max(max(xs) + APART / 2 + EDGE, LEAST / 2), max(ys) + BOW + EDGE
    sides = (-half, -top, 2 * half, top - min(ys) + HIGH + EDGE)
    return MovingPicture("".join(svg_element(mark, 0.0) for mark in marks), sides)


def _link_box(name: str, place: complex) -> list[Mark]:
    """Return the box of a link in the diagram, with its name. The name is cut if it is too long."""
    most = int((APART - 2) / (SHARE * LETTER))
    text = name if len(name) <= most else f"{name[: most - 1]}…"
    half = max(SHARE * LETTER * len(text), HIGH) / 2 + 0.5 + 0.5j * HIGH
    corners = (place - half, place + half.conjugate(), place + half, place - half.conjugate())
    face = "#c4c4c4" if name == FRAME else "white"
    return [AreaMark(corners, face, DARK_COLOUR, 0.4), TextMark(place, text, LETTER, DARK_COLOUR, "center")]


def chain_places(chain: SpatialChain) -> dict[str, complex]:
    """Return the centre of each link in the diagram of a chain, mm.

    The links are arranged in rows, each near its neighbours in the row below.
    """
    rows = [[FRAME]]
    placed = {FRAME}
    while rows[-1]:
        near = [pair.other(link) for link in rows[-1] for pair in chain.pairs if link in (pair.i, pair.j)]
        rows.append([link for link in dict.fromkeys(near) if link not in placed])
        placed.update(rows[-1])
    rows[-1] = [link for link in chain.links if link not in placed]  # links not connected to the frame
    wide = max(map(len, rows))
    centres = {FRAME: 0j}
    for number, row in enumerate(rows[1:], 1):
        held = {link: [pair.other(link) for pair in chain.pairs if link in (pair.i, pair.j)] for link in row}
        below = {
            link: [centres[neighbour].real for neighbour in others if neighbour in centres]
            for link, others in held.items()
        }
        across = {link: sum(xs) / len(xs) if xs else 0.0 for link, xs in below.items()}
        step = min(WIDEST, APART * (wide - 1) / max(len(row) - 1, 1))
        for k, link in enumerate(sorted(row, key=across.__getitem__)):
            centres[link] = complex((k - (len(row) - 1) / 2) * step, number * ROW)
    return centres
