"""Web page of one moving mechanism: the drawing as inline SVG, the frames, plans and diagrams as JSON, and a script.

The page loads nothing from the network: its content security policy allows only its own style and script. Texts
from the problem file are escaped.
"""

from __future__ import annotations

import base64
import hashlib
import json
from collections.abc import Iterable
from html import escape
from importlib.resources import files
from string import Template
from typing import Any

import numpy as np

from tmm_cli.animation.bodies import MechanismPicture, MovingBody, body_labels, page_coordinates
from tmm_cli.drawing.formats import svg_element
from tmm_cli.drawing.paper import THIN_COLOUR, VECTOR_COLOURS, DrawingSheet, mark_corners, with_unit
from tmm_cli.drawing.sheets import MotionPlanKind, QuantityPlot, balancing_plots, motion_plan_kinds, output_plots
from tmm_cli.drawing.symbols import MechanismScene, fit_points, frame_pivots, points_to_scale
from tmm_cli.language import ENGLISH, _, language, spelt
from tmm_cli.mechanics.analysis import Results, results_at
from tmm_cli.mechanics.forces import subscript
from tmm_cli.mechanics.kinematics import Motion
from tmm_cli.mechanics.numerics import Real, Vector, largest_magnitude, without_rounding
from tmm_cli.mechanics.plans import with_subscripts
from tmm_cli.mechanics.quantities import ANGLE, LENGTH
from tmm_cli.problem import ProblemError

PLAN_SIDE, PLAN_MARGIN = 100.0, 12.0  # units of a plan's longest side, of the room about it
SIZE_LIMIT = 1.5  # times what nearly all places have: beyond it (at dead positions) a plan is cut
MOST_LETTERS = 4  # at one point of a plan
LEAST_DISTANCE = 1e-6  # of a plan: nearer points are one


def plan_data(motion: Motion, plan_kind: MotionPlanKind) -> dict[str, Any]:
    """Return the velocity or acceleration plan of a mechanism in all frames as JSON data.

    Args:
        motion: motion of the mechanism; each of its positions is a frame.
        plan_kind: velocity plan or acceleration plan.

    Returns:
        Title, points (SI, y up) in each frame, vectors as pairs of point numbers, letters of the points, scale in page
        units per SI unit, and view box.
    """
    plans = [plan_kind.plan(motion, k) for k in range(len(motion.q))]
    first = plans[0]
    extent = float(np.percentile([plan.size for plan in plans], 95)) or 1.0
    points: list[Vector] = []

    def index(ends: Iterable[complex]) -> int:
        course = np.array(list(ends))
        for number, other in enumerate(points):
            if np.max(np.abs(other - course)) < LEAST_DISTANCE * extent:
                return number
        points.append(course)
        return len(points) - 1

    letters: dict[int, list[str]] = {}
    for letter in first.ends:
        letters.setdefault(index(plan.ends[letter] for plan in plans), []).append(letter)
    vectors: dict[tuple[int, int], dict[str, Any]] = {}
    for n, vector in enumerate(first.vectors):
        ends = index(plan.vectors[n].start for plan in plans), index(plan.vectors[n].end for plan in plans)
        mass = vector.kind == "absolute" and vector.symbol.below.startswith("S")
        if ends[0] != ends[1] and (ends not in vectors or not mass):
            vectors[ends] = {
                "from": ends[0],
                "to": ends[1],
                "colour": THIN_COLOUR if mass else VECTOR_COLOURS[vector.kind],
                "width": 0.45 if mass or vector.kind != "absolute" else 0.7,
            }
    below = sorted(vectors.values(), key=lambda vector: vector["colour"] != THIN_COLOUR)
    all_points = np.concatenate(points)
    all_points = all_points[np.abs(all_points) <= SIZE_LIMIT * extent]
    scale = PLAN_SIDE / (max(np.ptp(all_points.real), np.ptp(all_points.imag)) or 1.0)
    return {
        "title": (_("Velocity plan, {unit}") if plan_kind.letter == "v" else _("Acceleration plan, {unit}")).format(
            unit=spelt(plan_kind.unit)
        ),
        "points": [[round_figures(z.real, 4), round_figures(z.imag, 4)] for z in points],
        "vectors": below,
        "letters": [{"point": n, "text": _join_letters(text)} for n, text in letters.items()],
        "scale": float(f"{scale:.5g}"),
        "view": [round(side, 1) for side in field_sides(all_points * scale, PLAN_MARGIN)],
    }


def field_sides(points: Vector, room: float) -> tuple[float, float, float, float]:
    """Return left, top, width and height of the box around points, with a margin; y points down."""
    x, y = points.real, -points.imag
    return float(x.min()) - room, float(y.min()) - room, float(np.ptp(x)) + 2 * room, float(np.ptp(y)) + 2 * room


def _join_letters(letters: list[str]) -> str:
    """Join the letters of coincident points of a plan. If there are many, the last ones are replaced by an ellipsis."""
    few = letters if len(letters) <= MOST_LETTERS else [*letters[:MOST_LETTERS], "…"]
    return ", ".join(map(with_subscripts, few))


def chart_quantities(results: Results, whole: Results) -> Iterable[QuantityPlot]:
    """Yield the quantities in the diagrams of the page.

    These are the motion of the first two outputs, and the balancing moments or forces of the drivers.
    """
    assert whole.motion is not None
    for link in results.mechanism.outputs[:2]:
        yield from output_plots(results, whole.motion, link)
    yield from balancing_plots(whole, results)


def chart_data(results: Results, quantities: QuantityPlot) -> dict[str, Any]:
    """Return a diagram over the frames as JSON data, with values in the units of the file."""

    def values(si: Real) -> list[float | None]:
        clean = without_rounding(si, largest_magnitude(si))
        return round_figures(results.problem.units.from_si(clean, quantities.dimension), 5)

    return {
        "title": with_unit(quantities.words, quantities.dimension, results.problem.units),
        "courses": [{"name": course.name, "values": values(course.values)} for course in quantities.curves],
    }


def position_marks(results: Results, motion: Motion) -> list[list[Any]]:
    """Return the numbered positions of the mechanism as [frame, number].

    If a position lies between two frames, the first value is a fraction.
    """
    marks = []
    for number, q in zip(results.numbers, results.asked[list(results.numbers)].tolist(), strict=True):
        k = int(np.argmin(np.abs(motion.q - q)))
        step = abs(motion.q[-1] - motion.q[0]) / (len(motion.q) - 1)
        ahead = float((q - motion.q[k]) / (motion.q[-1] - motion.q[0]) * (len(motion.q) - 1))
        if abs(q - motion.q[k]) <= 1.01 * step:
            marks.append([round(k + ahead, 3), str(number)])
    return marks


def round_figures(values: Any, digits: int) -> list[float | None]:
    """Round values to `digits` significant figures; values that are not finite become None."""
    array = np.asarray(values, float)
    return [float(f"{value:.{digits}g}") + 0.0 if np.isfinite(value) else None for value in array.tolist()]


# What the page shows, as plain data: bodies, paths, names, plans of motion, diagrams, all in the same frames.


PAPER, LARGEST, EDGE = (400.0, 400.0), 120.0, 9.0  # mm: sheet, longest side of what moves, room about it for names
FRAMES = 180  # a turn
SECONDS = 4.0  # of a turn, or of a way, as long as one looks at it with ease


def results_in_frames(results: Results, count: int) -> Results:
    """Compute the mechanism at about `count` frames per revolution of the driver.

    Frames in which the mechanism cannot be assembled are omitted.

    Raises:
        ProblemError: The mechanism does not move over the requested positions.
    """
    q = results.closely(count * (results.turns or 1) + 1)
    moved = results_at(results, q)
    assert moved.motion is not None
    moves = moved.motion.moving
    if np.count_nonzero(moves) < 2 or np.ptp(q) == 0:
        raise ProblemError(_("the mechanism does not move in the requested positions"), path=("positions",))
    return moved if moves.all() else results_at(results, q[moves])


def page_data(results: Results, whole: Results, picture: MechanismPicture) -> dict[str, Any]:
    """Return the data of the page for its script: positions in mm with y down, angles in rad, plans in SI units.

    Args:
        results: results at the positions that the file requests.
        whole: results in all frames.
        picture: drawing of the first frame with the motion of its bodies.
    """
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
            "values": round_figures(units.from_si(motion.q, measure), 5),
            "turn": units.from_si(2 * np.pi, ANGLE) if driver.kind == "turn" else 0,
        },
        "bodies": [body_data(picture.bodies[name]) for name in names],
        "labels": body_labels(picture, names),
        "plans": [plan_data(motion, plan_kind) for plan_kind in motion_plan_kinds()],
        "charts": [chart_data(results, quantity) for quantity in chart_quantities(results, whole)],
        "marks": position_marks(results, motion),
    }


def draw_first_frame(whole: Results, motion: Motion) -> MechanismPicture:
    """Draw the mechanism in its first frame, at a scale at which its whole motion fits on the sheet."""
    linkage = whole.linkage
    scene = MechanismScene(linkage, whole.structure, motion.poses, 0)
    points = [*frame_pivots(linkage), *(z for name in linkage.moving_points for z in motion.spot(name).tolist())]
    sheet = DrawingSheet("", "", paper=PAPER)
    fit_points(sheet, points_to_scale(scene, points), 0.0, LARGEST)
    return MechanismPicture.of(sheet, motion, scene)


def picture_view(picture: MechanismPicture) -> tuple[float, float, float, float]:
    """Return the area of the sheet over which the bodies move, as left, top (y down), width and height, mm."""
    local = [
        (body, np.array([z for mark in body.marks for z in mark_corners(mark)])) for body in picture.bodies.values()
    ]
    times = range(0, len(picture.motion.q), max(1, len(picture.motion.q) // 24))
    return field_sides(np.concatenate([body.to_sheet(corners, k) for body, corners in local for k in times]), EDGE)


def body_data(body: MovingBody) -> dict[str, Any]:
    """Return position, angle and stretch of a body as JSON data.

    Each is a list of values in all frames, or one number if it is constant.
    """
    return {
        "x": rounded_frames(body.place.real, 2),
        "y": rounded_frames(-body.place.imag, 2),
        "turn": rounded_frames(-body.angle, 4),
        "stretch": rounded_frames(body.stretch, 4),
    }


def rounded_frames(values: Real, digits: int) -> Any:
    """Round the values in all frames to `digits` decimals. If all are equal, a single number is returned."""
    rounded = [round(value, digits) + 0.0 for value in np.asarray(values, float).tolist()]
    return rounded[0] if min(rounded) == max(rounded) else rounded


def point_paths(picture: MechanismPicture) -> Iterable[list[list[float]]]:
    """Yield the trajectory of each moving point on the page, as [x, y] in each frame."""
    for name in picture.scene.linkage.moving_points:
        yield [
            page_coordinates(z) for z in (picture.sheet.origin + picture.motion.spot(name) / picture.sheet.mu).tolist()
        ]


MOST_BYTES = 300_000  # bytes of a page
FEWEST_FRAMES = 36  # frames a turn
TEXT = str.maketrans({"<": "\\u003c", ">": "\\u003e", "&": "\\u0026"})  # nothing in JSON ends a script


def animation_page(results: Results) -> str:
    """Return the HTML page of a moving mechanism. If it would exceed MOST_BYTES, it gets fewer frames.

    Raises:
        ProblemError: The mechanism does not move over the requested positions.
    """
    count = FRAMES
    page = _build_page(results, count)
    while len(page.encode()) > MOST_BYTES and count > FEWEST_FRAMES:
        count = count * 3 // 4
        page = _build_page(results, count)
    return page


def _build_page(results: Results, count: int) -> str:
    whole = results_in_frames(results, count)
    assert whole.motion is not None
    picture = draw_first_frame(whole, whole.motion)
    names = list(picture.bodies)
    bodies = "\n".join(
        f'<g data-body="{names.index(name)}">{"".join(svg_element(mark, 0.0) for mark in marks)}</g>'
        for name, marks in picture.layers()
    )
    return fill_page(
        "",
        title=escape(results.problem.title),
        view=" ".join(f"{side:.1f}" for side in picture_view(picture)),
        paths="".join(_path_html(path) for path in point_paths(picture)),
        bodies=bodies,
        data=data_text(page_data(results, whole, picture)),
        hint=escape(
            _(
                "Space: start or stop. Left and right arrows: one step. Up and down arrows: speed. Drag in a "
                "diagram to move to a position."
            )
        ),
        back=""
        if results.turns
        else escape(_("The return motion is the forward motion played backwards, with the same values.")),
        play=escape(_("start or stop")),
        position=escape(_("position")),
        speed=escape(_("playback speed")),
        ways=escape(_("trajectories")),
    )


def fill_page(folder: str, **texts: str) -> str:
    """Fill the HTML template in a subfolder of this package with its style sheet, its script and the given texts."""
    package = files("tmm_cli.animation")
    whole, style, script = (
        package.joinpath(f"{folder}page.{kind}").read_text("utf-8") for kind in ("html", "css", "js")
    )
    policy = f"default-src 'none';style-src '{_digest(style)}';script-src '{_digest(script)}'"
    return Template(whole).substitute(texts, lang=language(), policy=policy, style=style, script=script)


def data_text(data: Any) -> str:
    """Convert data to JSON in which no character can end the HTML script element that contains it."""
    return json.dumps(data, separators=(",", ":"), allow_nan=False).translate(TEXT)


def _path_html(path: Iterable[Iterable[float]]) -> str:
    return f'<polyline points="{" ".join(",".join(f"{x:g}" for x in place) for place in path)}"/>'


def _digest(text: str) -> str:
    """Return the hash of a style sheet or script in the form that a content security policy requires."""
    return "sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
