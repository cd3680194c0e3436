"""What the page shows, as plain data: bodies, paths, names, plans of motion, diagrams, all in the same frames."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from tmm_cli.analysis.pipeline import Results, at_places
from tmm_cli.animate.bodies import Body, Picture
from tmm_cli.draw.drawing import Area, Circle, Line
from tmm_cli.draw.motion_plans import Sort, sorts
from tmm_cli.draw.over_cycle import Quantities, balances, output
from tmm_cli.draw.scene import Scene, fit, fixed_pivots, to_scale
from tmm_cli.draw.sheet import COLOURS, Sheet, with_unit
from tmm_cli.errors import _
from tmm_cli.kinematics.motion import Motion
from tmm_cli.linkage import FRAME
from tmm_cli.problem.errors import ProblemError
from tmm_cli.quantities import ANGLE, LENGTH
from tmm_cli.vectors import Real, Vector

PAPER, LARGEST, EDGE = (400.0, 400.0), 120.0, 9.0  # mm: sheet, longest side of what moves, room about it for names
PLAN, ROOM = 100.0, 12.0  # units of a plan's longest side, of the room about it
USUAL = 1.5  # times what nearly all places have: beyond it (at dead positions) a plan is cut
OUT = 4.0  # mm from a hinge to its name
FRAMES = 180  # a turn
LEAST = 1e-6  # of a plan: nearer points are one


def frames(results: Results, count: int) -> Results:
    """The same results at about so many places close together at which the mechanism moves. Raises ProblemError."""
    reach, turns = results.driver_range, 1
    if reach is not None and reach.full and results.linkage.driver.kind == "turn":
        turns = reach.turns
    q = results.closely(count * turns + 1)
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
    reach, driver = results.driver_range, results.linkage.driver
    loops = reach is not None and reach.full and driver.kind == "turn"
    units, measure = results.problem.units, ANGLE if driver.kind == "turn" else LENGTH
    return {
        "loops": loops,
        "seconds": 4.0 * (reach.turns if loops and reach is not None else 1),
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
    """Names of points and numbers of links: their places in the axes of the bodies that carry them."""
    found: dict[complex, dict[str, Any]] = {}
    linkage, scene, sheet = picture.scene.linkage, picture.scene, picture.sheet
    for link in (FRAME, *linkage.moving):
        points = linkage.links[link].points
        for name, local in points.items():
            if link != FRAME and (name in linkage.links[FRAME].points or linkage.owner(name) != link):
                continue
            at = sheet.on(scene.place(link, complex(local)))
            here = next((z for z in found if abs(z - at) < 1e-6), None)
            if here is not None and found[here]["body"] == names.index(link):
                found[here]["text"] += f", {name}"
                continue
            middle = sum(sheet.on(scene.place(link, complex(z))) for z in points.values()) / len(points)
            own, out = picture.bodies[link].own(at), picture.bodies[link].own(at) - picture.bodies[link].own(middle)
            if link == FRAME:
                out = complex(-2 if at.real < sheet.origin.real else 2)
            own += OUT * (out / abs(out) if abs(out) > 1 else 1 + 0.6j)
            found[at] = {"body": names.index(link), "at": pair(own), "text": name, "kind": "point"}
    numbers = [
        {"body": names.index(link), "at": pair(_beside(picture, link)), "text": link, "kind": "link"}
        for link in linkage.moving
        if np.isfinite(picture.forms[link].middle)
    ]
    return [*found.values(), *numbers]


def _beside(picture: Picture, link: str) -> complex:
    """Beside the middle of a link, in its axes."""
    form, own = picture.forms[link], picture.bodies[link].own
    if len(form.hull) > 2 or not form.lines:
        return own(form.middle) + (0 if len(form.hull) > 2 else 3.5 - 3.5j)
    start, end = max(form.lines, key=lambda line: abs(line[1] - line[0]))
    way = own(end) - own(start)
    return own(form.middle) + (3.0j * way / abs(way) if abs(way) > 1 else 3.5 - 3.5j)


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
    vectors = [
        {
            "from": index(plan.vectors[n].start for plan in plans),
            "to": index(plan.vectors[n].end for plan in plans),
            "colour": COLOURS[vector.kind],
            "wide": vector.kind == "absolute",
        }
        for n, vector in enumerate(first.vectors)
    ]
    every = np.concatenate(points)
    every = every[np.abs(every) <= USUAL * size]
    scale = PLAN / (max(np.ptp(every.real), np.ptp(every.imag)) or 1.0)
    return {
        "title": (_("Velocity plan, {unit}") if sort.letter == "v" else _("Acceleration plan, {unit}")).format(
            unit=sort.unit
        ),
        "points": [[rounded(z.real, 4), rounded(z.imag, 4)] for z in points],
        "vectors": [vector for vector in vectors if vector["from"] != vector["to"]],
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
