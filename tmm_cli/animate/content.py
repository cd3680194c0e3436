"""What the page shows, as plain data: bodies, paths, names, plans of motion, diagrams, all in the same frames."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from tmm_cli.analysis.pipeline import Results, at_places
from tmm_cli.animate.bodies import Body, Picture
from tmm_cli.animate.courses import chart_data, charts, plan_data, position_marks, rounded, sides
from tmm_cli.animate.labels import labels, pair
from tmm_cli.draw.paper.picture import reach
from tmm_cli.draw.paper.sheet import Sheet
from tmm_cli.draw.sheets.motion_plans import sorts
from tmm_cli.draw.symbols.scene import Scene, fit, fixed_pivots, to_scale
from tmm_cli.kinematics.motion import Motion
from tmm_cli.language import ENGLISH, _, language
from tmm_cli.plans.record import subscript
from tmm_cli.problem.errors import ProblemError
from tmm_cli.quantities import ANGLE, LENGTH
from tmm_cli.vectors import Real

PAPER, LARGEST, EDGE = (400.0, 400.0), 120.0, 9.0  # mm: sheet, longest side of what moves, room about it for names
FRAMES = 180  # a turn
SECONDS = 4.0  # of a turn, or of a way, as long as one looks at it with ease


def frames(results: Results, count: int) -> Results:
    """The same results at about so many places a turn at which the mechanism moves. Raises ProblemError."""
    q = results.closely(count * (results.turns or 1) + 1)
    moved = at_places(results, q)
    assert moved.motion is not None
    moves = moved.motion.moving
    if np.count_nonzero(moves) < 2 or np.ptp(q) == 0:
        raise ProblemError(_("nothing moves in what is asked for"), path=("positions",))
    return moved if moves.all() else at_places(results, q[moves])


def content(results: Results, whole: Results, picture: Picture) -> dict[str, Any]:
    """Everything that the script needs; places in mm of a sheet with y down, angles in rad, plans in SI."""
    motion = picture.motion
    names = list(picture.bodies)
    driver, turns = results.linkage.driver, results.turns
    units, measure = results.problem.units, ANGLE if driver.kind == "turn" else LENGTH
    return {
        "comma": language() != ENGLISH,
        "loops": turns > 0,
        "seconds": SECONDS * (turns or 1),
        "driver": {
            "name": ("φ" if driver.kind == "turn" else "s") + subscript(driver.link),
            "unit": units.spelt(measure),
            "values": rounded(units.from_si(motion.q, measure), 5),
            "turn": units.from_si(2 * np.pi, ANGLE) if driver.kind == "turn" else 0,
        },
        "bodies": [body_data(picture.bodies[name]) for name in names],
        "labels": labels(picture, names),
        "plans": [plan_data(motion, sort) for sort in sorts()],
        "charts": [chart_data(results, one) for one in charts(results, whole)],
        "marks": position_marks(results, motion),
    }


def picture_of(whole: Results, motion: Motion) -> Picture:
    """The mechanism in the first frame on a sheet that has room for all of its ways."""
    linkage = whole.linkage
    scene = Scene(linkage, whole.structure, motion.poses, 0)
    places = [*fixed_pivots(linkage), *(z for name in linkage.moving_points for z in motion.spot(name).tolist())]
    sheet = Sheet("", "", paper=PAPER)
    fit(sheet, to_scale(scene, places), 0.0, LARGEST)
    return Picture.of(sheet, motion, scene)


def view(picture: Picture) -> tuple[float, float, float, float]:
    """What of the sheet is ever drawn on: left, top (y down), width and height, mm."""
    local = [(own, np.array([z for mark in own.marks for z in reach(mark)])) for own in picture.bodies.values()]
    times = range(0, len(picture.motion.q), max(1, len(picture.motion.q) // 24))
    return sides(np.concatenate([own.at(places, k) for own, places in local for k in times]), EDGE)


def body_data(own: Body) -> dict[str, Any]:
    """Where a body is in each frame; one number of what does not change."""
    return {
        "x": steady(own.place.real, 2),
        "y": steady(-own.place.imag, 2),
        "turn": steady(-own.angle, 4),
        "stretch": steady(own.stretch, 4),
    }


def steady(values: Real, digits: int) -> Any:
    """Rounded; one number where all are the same."""
    found = [round(value, digits) + 0.0 for value in np.asarray(values, float).tolist()]
    return found[0] if min(found) == max(found) else found


def paths(picture: Picture) -> Iterable[list[list[float]]]:
    """Ways of all moving points."""
    for name in picture.scene.linkage.moving_points:
        yield [pair(z) for z in (picture.sheet.origin + picture.motion.spot(name) / picture.sheet.mu).tolist()]
