"""What the page shows, as plain data: bodies, paths, names, plans of motion, diagrams, all in the same frames."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from tmm_cli.analysis.pipeline import Results, at_places
from tmm_cli.animate.bodies import Body, Picture
from tmm_cli.draw.actuators import cylinders
from tmm_cli.draw.drawing import Area, Circle, Line
from tmm_cli.draw.motion_plans import Sort, sorts
from tmm_cli.draw.over_cycle import Quantities, balances, output
from tmm_cli.draw.scene import ON_LINE, Scene, fit, fixed_pivots, to_scale
from tmm_cli.draw.sheet import COLOURS, THIN, Sheet, with_unit
from tmm_cli.errors import _
from tmm_cli.kinematics.motion import Motion
from tmm_cli.linkage import FRAME
from tmm_cli.problem.errors import ProblemError
from tmm_cli.quantities import ANGLE, LENGTH
from tmm_cli.vectors import Real, Vector

PAPER, LARGEST, EDGE = (400.0, 400.0), 120.0, 9.0  # mm: sheet, longest side of what moves, room about it for names
PLAN, ROOM = 100.0, 12.0  # units of a plan's longest side, of the room about it
USUAL = 1.5  # times what nearly all places have: beyond it (at dead positions) a plan is cut
OUT, BOX_SIDE = 4.0, 6.5  # mm from a hinge to its name; from the middle of a box to the number of its link
FRAMES = 180  # a turn
SECONDS = 4.0  # of a turn, or of a way, as long as one looks at it with ease
LEAST = 1e-6  # of a plan: nearer points are one


def loops(results: Results) -> int:
    """Turns of the driver after which all comes again; 0 where it goes to and fro."""
    reach = results.driver_range
    return reach.turns if reach is not None and reach.full and results.linkage.driver.kind == "turn" else 0


def frames(results: Results, count: int) -> Results:
    """The same results at about so many places a turn at which the mechanism moves. Raises ProblemError."""
    q = results.closely(count * (loops(results) or 1) + 1)
    moved = at_places(results, q)
    assert moved.motion is not None
    if not moved.motion.moving.all():
        moved = at_places(results, q[moved.motion.moving]) if moved.motion.moving.sum() > 2 else moved
    if moved.motion is None or not moved.motion.moving.any() or np.ptp(q) == 0:
        raise ProblemError(_("nothing moves in what is asked for"), path=("positions",))
    return moved


def content(results: Results, whole: Results, picture: Picture) -> dict[str, Any]:
    """Everything that the script needs; places in mm of a sheet with y down, angles in rad, plans in SI."""
    motion = picture.motion
    names = list(picture.bodies)
    driver, turns = results.linkage.driver, loops(results)
    units, measure = results.problem.units, ANGLE if driver.kind == "turn" else LENGTH
    return {
        "loops": turns > 0,
        "seconds": SECONDS * (turns or 1),
        "driver": {
            "name": ("φ" if driver.kind == "turn" else "s") + driver.link,
            "unit": units.symbol(measure),
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
    every: list[complex] = []
    step = max(1, len(picture.motion.q) // 24)
    for own in picture.bodies.values():
        local = [z for mark in own.marks for z in _outline(mark)]
        for k in range(0, len(picture.motion.q), step):
            every += np.atleast_1d(own.at(np.array(local, complex), k)).tolist()
    xs, ys = [z.real for z in every], [-z.imag for z in every]
    return min(xs) - EDGE, min(ys) - EDGE, np.ptp(xs) + 2 * EDGE, np.ptp(ys) + 2 * EDGE


def _outline(mark: object) -> Sequence[complex]:
    match mark:
        case Line():
            return mark.places
        case Area():
            return mark.corners
        case Circle():
            return [mark.centre + mark.radius * way for way in (1, 1j, -1, -1j)]
    return ()


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


def rounded(values: Any, digits: int) -> list[float | None]:
    """To so many significant figures; none where there is no value."""
    array = np.asarray(values, float)
    return [float(f"{value:.{digits}g}") + 0.0 if np.isfinite(value) else None for value in array.tolist()]


def labels(picture: Picture, names: Sequence[str]) -> list[dict[str, Any]]:
    """Names of points beyond the ends of links, numbers beside links: in the axes of the bodies that carry them."""
    linkage, found = picture.scene.linkage, dict[tuple[str, complex], list[str]]()
    for name in {point: None for link in (FRAME, *linkage.moving) for point in linkage.links[link].points}:
        there = [link for link in (FRAME, *linkage.moving) if name in linkage.links[link].points]
        # on a link with more points there is a way out
        carrier = FRAME if FRAME in there else max(there, key=lambda link: len(linkage.links[link].points) > 1)
        local = complex(linkage.local(carrier, name))
        found.setdefault((carrier, complex(round(local.real, 9), round(local.imag, 9))), []).append(name)
    points = [
        {"body": names.index(link), "at": pair(_beyond(picture, link, local)), "text": ", ".join(text), "kind": "point"}
        for (link, local), text in found.items()
    ]
    numbers = [
        {"body": names.index(link), "at": pair(_beside(picture, link)), "text": link, "kind": "link"}
        for link in linkage.moving
        if np.isfinite(picture.forms[link].middle)
    ]
    return [*points, *numbers]


def _beyond(picture: Picture, link: str, local: complex) -> complex:
    """Where the name of a point is, in its link's axes: away from the middle of the link, outside a slider's box."""
    sheet, scene = picture.sheet, picture.scene
    at, driven = sheet.on(scene.place(link, local)), cylinders(scene.linkage)
    slides = [slide for slide in scene.linkage.slides if slide.name not in driven]
    boxed = any(abs(sheet.on(scene.place(slide.runner, slide.at)) - at) < ON_LINE for slide in slides)
    own = picture.bodies[link].own(at)
    if link == FRAME:
        return own + OUT * (-1 if at.real < sheet.origin.real else 1)
    places = [sheet.on(scene.place(link, complex(z))) for z in scene.linkage.links[link].points.values()]
    out = own - picture.bodies[link].own(sum(places) / len(places))
    return own + (2 * OUT if boxed else OUT) * (out / abs(out) if abs(out) > 1 else complex(0.8, 0.6))


def _beside(picture: Picture, link: str) -> complex:
    """Where the number of a link is, in its axes: on its plate, beside its longest line, or beside its box."""
    form, own = picture.forms[link], picture.bodies[link].own
    if len(form.hull) > 2:
        return own(form.middle)
    start, end = max(form.lines, key=lambda line: abs(line[1] - line[0]), default=(0j, 0j))
    if abs(end - start) > 1:
        return own(form.middle + 3j * (end - start) / abs(end - start))
    slide = next((slide for slide in picture.scene.linkage.slides if slide.runner == link), None)
    return own(form.middle + (1 - 1j if slide is None else -1j * picture.scene.along(slide)) * BOX_SIDE)


def pair(z: complex) -> list[float]:
    """x and y with y down."""
    return [round(z.real, 2) + 0.0, round(-z.imag, 2) + 0.0]


def paths(picture: Picture) -> Iterable[list[list[float]]]:
    """Ways of all moving points."""
    for name in picture.scene.linkage.moving_points:
        yield [pair(z) for z in (picture.sheet.origin + picture.motion.spot(name) / picture.sheet.mu).tolist()]


def plan_data(motion: Motion, sort: Sort) -> dict[str, Any]:
    """A plan in all frames: its points (SI, y up), vectors between them, letters at them; units a SI unit, its view."""
    plans = [sort.plan(motion, k) for k in range(len(motion.q))]
    first = plans[0]
    size = float(np.percentile([plan.size for plan in plans], 95)) or 1.0
    points: list[Vector] = []

    def index(places: Iterable[complex]) -> int:
        course = np.array(list(places))
        for number, other in enumerate(points):
            if np.max(np.abs(other - course)) < LEAST * size:
                return number
        points.append(course)
        return len(points) - 1

    letters: dict[int, list[str]] = {}
    for letter in first.ends:
        letters.setdefault(index(plan.ends[letter] for plan in plans), []).append(letter)
    letters.setdefault(index(0j for __ in plans), []).insert(0, sort.pole)
    vectors: dict[tuple[int, int], dict[str, Any]] = {}
    for n, vector in enumerate(first.vectors):
        ends = index(plan.vectors[n].start for plan in plans), index(plan.vectors[n].end for plan in plans)
        mass = vector.kind == "absolute" and vector.symbol.below.startswith("S")
        if ends[0] != ends[1] and (ends not in vectors or not mass):
            vectors[ends] = {
                "from": ends[0],
                "to": ends[1],
                "colour": THIN if mass else COLOURS[vector.kind],
                "width": 0.45 if mass or vector.kind != "absolute" else 0.7,
            }
    below = sorted(vectors.values(), key=lambda vector: vector["colour"] != THIN)
    every = np.concatenate(points)
    every = every[np.abs(every) <= USUAL * size]
    scale = PLAN / (max(np.ptp(every.real), np.ptp(every.imag)) or 1.0)
    return {
        "title": (_("Velocity plan, {unit}") if sort.letter == "v" else _("Acceleration plan, {unit}")).format(
            unit=sort.unit
        ),
        "points": [[rounded(z.real, 4), rounded(z.imag, 4)] for z in points],
        "vectors": below,
        "letters": [{"point": n, "text": ", ".join(dict.fromkeys(text))} for n, text in letters.items()],
        "scale": float(f"{scale:.5g}"),
        "view": [
            round(float(value), 1)
            for value in (
                every.real.min() * scale - ROOM,
                -every.imag.max() * scale - ROOM,
                np.ptp(every.real) * scale + 2 * ROOM,
                np.ptp(every.imag) * scale + 2 * ROOM,
            )
        ],
    }


def charts(results: Results, whole: Results) -> Iterable[Quantities]:
    """Motion of the first outputs, and what balances the drivers."""
    assert whole.motion is not None
    for link in results.mechanism.outputs[:2]:
        yield from output(results, whole.motion, link)
    yield from balances(whole, results)


def chart_data(results: Results, quantities: Quantities) -> dict[str, Any]:
    """A diagram in the units of the file."""
    units = results.problem.units
    return {
        "title": with_unit(quantities.words, quantities.dimension, units),
        "courses": [
            {"name": course.name, "values": rounded(units.from_si(course.values, quantities.dimension), 5)}
            for course in quantities.courses
        ],
    }


def position_marks(results: Results, motion: Motion) -> list[list[Any]]:
    """Where the numbered positions are among the frames."""
    found = []
    for number, q in zip(results.numbers, results.asked[list(results.numbers)].tolist(), strict=True):
        k = int(np.argmin(np.abs(motion.q - q)))
        step = abs(motion.q[-1] - motion.q[0]) / (len(motion.q) - 1)
        ahead = float((q - motion.q[k]) / (motion.q[-1] - motion.q[0]) * (len(motion.q) - 1))
        if abs(q - motion.q[k]) <= 1.01 * step:
            found.append([round(k + ahead, 3), str(number)])
    return found
