"""A mechanism that turns on a card: its bodies as SVG, and where they are in few frames, as whole numbers.

The page interpolates between frames by cubic curves, so few are enough.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tmm_cli.analysis.pipeline import Results, at_positions
from tmm_cli.animate.bodies import Body, Picture
from tmm_cli.animate.content import SECONDS, picture_of, view
from tmm_cli.draw.formats.svg import element
from tmm_cli.kinematics.motion import Motion
from tmm_cli.linkage import FRAME
from tmm_cli.vectors import Real

FRAMES = 48  # a turn
MOST_FRAMES = 240  # of mechanisms that repeat after many turns
PLACE, TURN = 100, 10_000  # steps in a mm of the picture; in a radian, and in a stretch of one

Course = int | list[int]


@dataclass(frozen=True)
class Turning:
    """The drawing of the first frame, its sides (mm), and the frames; none of what does not move.

    bodies: x, y, turn and stretch of each, in PLACE and TURN: a number of what does not change, else the first value
    and the difference of each next one. loops: whether the last frame is the first one again. seconds: of all frames.
    """

    svg: str
    view: tuple[float, float, float, float]
    bodies: tuple[tuple[Course, Course, Course, Course], ...] = ()
    loops: bool = False
    seconds: float = SECONDS


def turning(results: Results) -> Turning:
    """Of results with kinematics."""
    turns = results.turns or 1
    motion = _motion(results, min(FRAMES * turns, MOST_FRAMES) + 1)
    still = len(motion.q) < 2
    picture = picture_of(results, motion)
    drawn = list(picture.layers())
    moving = [] if still else [name for name in dict.fromkeys(name for name, __ in drawn) if name != FRAME]
    svg = "".join(
        f"<g{_attributes(picture, name, moving)}>{''.join(element(mark, 0.0) for mark in marks)}</g>"
        for name, marks in drawn
    )
    bodies = tuple(_courses(picture.bodies[name]) for name in moving)
    return Turning(svg, view(picture), bodies, results.turns > 0, SECONDS * turns)


def _motion(results: Results, count: int) -> Motion:
    """Where it moves over what is asked for, or else as far as its driver can go; or the sketch alone."""
    reach = results.driver_range
    assert reach is not None
    for q in (results.closely(count), np.linspace(reach.start, reach.end, count)):
        motion = at_positions(results, q, 0)
        if np.count_nonzero(motion.moving) > 1 and np.ptp(q) > 0:
            return motion if motion.moving.all() else at_positions(results, q[motion.moving], 0)
    return at_positions(results, np.array([results.linkage.sketch.at]), 0)


def _attributes(picture: Picture, name: str, moving: list[str]) -> str:
    """Where the body is in the first frame, and its number if it moves."""
    body = picture.bodies[name]
    if name == FRAME:
        return ""
    z = np.exp(1j * body.angle[0])
    x, y = body.place[0].real, -body.place[0].imag
    matrix = " ".join(f"{round(float(value), 4) + 0.0:g}" for value in (z.real, -z.imag, z.imag, z.real, x, y))
    number = f' data-body="{moving.index(name)}"' if name in moving else ""
    return f'{number} transform="matrix({matrix})"'


def _courses(body: Body) -> tuple[Course, Course, Course, Course]:
    """With y down, as the page has it."""
    return (
        _course(body.place.real * PLACE), _course(-body.place.imag * PLACE), _course(-body.angle * TURN),
        _course(body.stretch * TURN),
    )  # fmt: skip


def _course(values: Real) -> Course:
    whole = np.rint(values).astype(int)
    if np.all(whole == whole[0]):
        return int(whole[0])
    return [int(whole[0]), *np.diff(whole).tolist()]
