"""Symbols of a kinematic scheme: links, hinges, supports, sliders, guides, centres of mass."""

from __future__ import annotations

import numpy as np

from tmm_cli.draw.actuators import cylinder, cylinders, springs
from tmm_cli.draw.sheet import DARK, GREY, THIN, Sheet
from tmm_cli.draw.wheels import CamShape, Place, draw, shapes
from tmm_cli.draw.wheels import extent as wheels_extent
from tmm_cli.linkage import FRAME, Hinge, Linkage, Slide
from tmm_cli.motion import Motion
from tmm_cli.vectors import unit
from tmm_cli.words import say

STRIP = (0.9, 1.7)  # mm: depths in hatching that stand for all of it
HINGE, BOX, STONE = 1.3, (9.0, 5.0), (7.5, 4.2)  # mm: radius of a hinge; length and width of a slider, a stone


def skeleton(sheet: Sheet, motion: Motion, k: int, colour: str = GREY, width: float = 0.7, z: float = 1.0) -> None:
    """One position as thin lines."""
    for link in motion.linkage.moving:
        places = link_places(sheet, motion, link, k)
        if len(places) > 1:
            closed = [*places, places[0]] if len(places) > 2 else places
            sheet.line(closed, colour, width, z=z, blocks=False)


def placer(motion: Motion, k: int) -> Place:
    """Points of links at position k, m."""

    def place(link: str, local: complex) -> complex:
        pose = motion.poses[link]
        return complex(pose.x[k] + local * pose.z[k])

    return place


def beyond(motion: Motion, k: int, places: list[complex]) -> list[complex]:
    """What else must be on a sheet that has these places (m): wheels, cams, ends of springs on the frame."""
    array = np.array([p for p in places if np.isfinite(p)] or [0j])
    size = max(float(np.ptp(array.real)), float(np.ptp(array.imag)))
    found = wheels_extent(shapes(motion.linkage, placer(motion, k)), size)
    for spring in motion.linkage.springs:
        ends = ((spring.i, spring.at_i), (spring.j, spring.at_j))
        found += [placer(motion, k)(link, at) for link, at in ends if not spring.turns]
    return found


def mechanism(sheet: Sheet, motion: Motion, k: int, *, numbers: bool = True) -> dict[str, tuple[complex, complex]]:
    """One position with all its symbols: supports, guides, links, hinges, names and numbers.

    Gives the cylinders that are drawn, by their sliding pair: the middle of each (mm), and its direction.
    """
    linkage, place = motion.linkage, placer(motion, k)
    driven = cylinders(linkage)
    for slide in linkage.slides:
        if FRAME in (slide.carrier, slide.runner):
            frame_guide(sheet, motion, slide, k)
        elif len(linkage.links[slide.carrier].points) < 2 and slide.name not in driven:
            slot(sheet, motion, slide, k)
    hue = dict.fromkeys(linkage.links, DARK)
    for found in shapes(linkage, place):
        draw(sheet, found, hue, _span(motion, found.mesh.slide, k))
        sheet.label(
            found.mesh.name, sheet.on(found.touch if isinstance(found, CamShape) else found.pitch), 9, "#404040"
        )
        if isinstance(found, CamShape) and not found.true:
            sheet.note(say("draw.cam", link=found.mesh.i))
    for link in linkage.moving:
        body(sheet, motion, link, k)
    cylindric = {}
    for slide in linkage.slides:
        if slide.name in driven:
            runs = motion.slide(slide).run
            cylindric[slide.name] = cylinder(
                sheet, linkage, slide, place, (float(np.nanmin(runs)), float(np.nanmax(runs)))
            )
        else:
            box(sheet, motion, slide, k)
    springs(sheet, linkage, place)
    for hinge in linkage.hinges:
        at = sheet.on(complex(motion.named(hinge.point).x[k]))
        if FRAME in hinge.links:
            support(sheet, at, _away(sheet, motion, hinge, k))
        sheet.circle(at, HINGE)
        if len(hinge.links) > 2:
            sheet.circle(at, HINGE / 2.5, face=DARK, z=6.5)
    for name in dict.fromkeys(p for link in linkage.moving for p in linkage.links[link].points):
        at = sheet.on(complex(motion.named(name).x[k]))
        if sum(name in link.points for link in linkage.links.values()) == 1:
            sheet.circle(at, 0.6, face=DARK)
        sheet.label(name, at, 10)
    for link in linkage.moving:
        if np.any(linkage.links[link].mass != 0):
            at = sheet.on(complex(motion.centre(link).x[k]))
            on_point = any(
                abs(at - sheet.on(complex(motion.named(p).x[k]))) < HINGE for p in linkage.links[link].points
            )
            centre(sheet, at, f"S{link}", marked=not on_point)
            if not on_point and len(linkage.links[link].points) == 1:
                reach(sheet, motion, link, at, k)
    if numbers:
        for link in linkage.moving:
            places = link_places(sheet, motion, link, k)
            middle = sum(places) / len(places)
            sheet.label(link, complex(middle), 10, "#7a3d99", "italic")
    return cylindric


def _span(motion: Motion, name: str, k: int) -> tuple[float, float] | None:
    """How far a rack goes beyond the pitch point to both sides, m."""
    if not name:
        return None
    slide = motion.linkage.slide(name)
    runs = motion.slide(slide).run
    here = float(runs[k])
    return here - float(np.nanmax(runs)), here - float(np.nanmin(runs))


def link_places(sheet: Sheet, motion: Motion, link: str, k: int) -> list[complex]:
    """The points that give a link its shape, on paper: its named points, and the stone on its guide."""
    linkage = motion.linkage
    pose = motion.poses[link]
    local = list(linkage.links[link].points.values())
    for slide in linkage.slides:
        if slide.carrier == link and slide.runner != FRAME and slide.name not in cylinders(linkage):
            run = float(motion.slide(slide).run[k])
            local += [slide.through, slide.through + run * complex(unit(slide.direction))]
    places = [sheet.on(complex(pose.x[k] + z * pose.z[k])) for z in local]
    return outline(places)


def outline(places: list[complex]) -> list[complex]:
    """The convex hull; the two ends when all lie on a line."""
    places = list(dict.fromkeys(complex(round(p.real, 6), round(p.imag, 6)) for p in places if np.isfinite(p)))
    if len(places) < 3:
        return places or [complex(np.nan, np.nan)]
    ordered = sorted(places, key=lambda p: (p.real, p.imag))

    def half(points: list[complex]) -> list[complex]:
        chain: list[complex] = []
        for p in points:
            while len(chain) > 1 and ((chain[-1] - chain[-2]).conjugate() * (p - chain[-1])).imag <= 1e-3:
                chain.pop()
            chain.append(p)
        return chain[:-1]

    return half(ordered) + half(ordered[::-1])


def body(sheet: Sheet, motion: Motion, link: str, k: int) -> None:
    """A bar, or a plate for links with three corners and more; the way of a stone on it as a slot."""
    places = link_places(sheet, motion, link, k)
    if len(places) > 2:
        sheet.area(places, "#eceff3", DARK, 1.4, 2.2)
    elif len(places) == 2:
        sheet.line(places, DARK, 2.4, z=3)


def box(sheet: Sheet, motion: Motion, slide: Slide, k: int, colour: str = DARK) -> None:
    """The sliding link as a box along its guide; arms to its other points."""
    pose = motion.poses[slide.runner]
    at = sheet.on(complex(pose.x[k] + slide.at * pose.z[k]))
    if not np.isfinite(at):
        return
    along = complex(motion.poses[slide.carrier].z[k] * unit(slide.direction))
    length, width = BOX if FRAME in (slide.carrier, slide.runner) else STONE
    corners = [at + along * complex(sx * length / 2, sy * width / 2) for sx, sy in ((1, 1), (-1, 1), (-1, -1), (1, -1))]
    sheet.area(corners, "white", colour, 1.3, 4)


def frame_guide(sheet: Sheet, motion: Motion, slide: Slide, k: int) -> None:
    """Two hatched rails along the whole way of the runner."""
    along = complex(unit(slide.direction) * (1 if slide.carrier == FRAME else motion.poses[slide.carrier].z[k]))
    here = motion.poses[slide.runner]
    reach = [sheet.on(complex(p)) for p in here.x + slide.at * here.z if np.isfinite(p)]
    if not reach:
        return
    start = reach[0]
    runs = [((p - start) * along.conjugate()).real for p in reach]
    low, high = inside(sheet, start + along * (min(runs) - 10), start + along * (max(runs) + 10))
    for side in (1, -1):
        shift = side * 1j * along * (BOX[1] / 2 + 0.5)
        sheet.line([low + shift, high + shift], DARK, 1.0, z=2.5)
        hatch(sheet, low + shift, high + shift, side * 1j * along)


def _away(sheet: Sheet, motion: Motion, hinge: Hinge, k: int) -> complex:
    """Down, or up where the links of a fixed hinge hang down from it."""
    at = sheet.on(complex(motion.named(hinge.point).x[k]))
    arms = [p - at for n in hinge.links if n != FRAME for p in link_places(sheet, motion, n, k)]
    low = sum(arm.imag / abs(arm) for arm in arms if abs(arm) > HINGE)
    return 1j if low < -0.8 else -1j


def support(sheet: Sheet, at: complex, out: complex) -> None:
    """The frame at a hinge: a triangle on hatched ground."""
    left, right = at + 5.6 * out - 3.4, at + 5.6 * out + 3.4
    sheet.area([at, left, right], "white", DARK, 1.0, 2.6)
    sheet.line([left - 1.6, right + 1.6], DARK, 1.2, z=2.7)
    hatch(sheet, left - 1.6, right + 1.6, out)


def slot(sheet: Sheet, motion: Motion, slide: Slide, k: int) -> None:
    """The slot of a link that has no bar along its guide: two thin lines along the whole way of the stone."""
    pose = motion.poses[slide.carrier]
    along = complex(pose.z[k] * unit(slide.direction))
    runs = motion.slide(slide).run
    foot = complex(pose.x[k] + slide.through * pose.z[k])
    first, last = (sheet.on(foot + along * float(r)) for r in (np.nanmin(runs), np.nanmax(runs)))
    low, high = inside(sheet, first - 7 * along, last + 7 * along)
    for side in (1, -1):
        shift = side * 1j * along * (STONE[1] / 2 + 0.4)
        sheet.line([low + shift, high + shift], DARK, 1.0, z=2.5)


def inside(sheet: Sheet, start: complex, end: complex) -> tuple[complex, complex]:
    """The part of a line that lies in the drawing's field."""
    low, high = sheet.ground.low + 4 * (1 + 1j), sheet.ground.high - 4 * (1 + 1j)
    way, first, last = end - start, 0.0, 1.0
    for at, step, least, most in (
        (start.real, way.real, low.real, high.real),
        (start.imag, way.imag, low.imag, high.imag),
    ):
        if abs(step) > 1e-9:
            enter, leave = sorted(((least - at) / step, (most - at) / step))
            first, last = max(first, enter), min(last, leave)
    return (start + first * way, start + last * way) if first < last else (start, end)


def hatch(sheet: Sheet, start: complex, end: complex, outward: complex) -> None:
    """Short slanted strokes on the side where the frame is; labels keep off all of the strip."""
    along = (end - start) / abs(end - start)
    number = int(abs(end - start) / 2.0)
    for k in range(number):
        foot = start + along * (k + 0.5) * abs(end - start) / number
        sheet.line([foot, foot + 1.7 * outward - 1.2 * along], THIN, 0.6, z=2.4, blocks=False)
    for depth in STRIP:
        sheet.ground.line(start + depth * outward, end + depth * outward)


def reach(sheet: Sheet, motion: Motion, link: str, at: complex, k: int) -> None:
    """A thin line from a link of one point to a place that belongs to it too."""
    point = next(iter(motion.linkage.links[link].points))
    sheet.line([sheet.on(complex(motion.named(point).x[k])), at], THIN, 0.9, z=2.1)


def centre(sheet: Sheet, at: complex, name: str, *, marked: bool = True) -> None:
    """A centre of mass: a small circle with a dot, or its name alone where a hinge is drawn."""
    if marked:
        sheet.circle(at, 1.0, face="#f4e3b2", z=6.2)
        sheet.circle(at, 0.25, face=DARK, z=6.3)
    sheet.label(name, at, 8, "#6b5310")


def trajectory(sheet: Sheet, places: np.ndarray, colour: str = THIN) -> None:
    """The path of a point, from its places (SI)."""
    sheet.line([sheet.on(complex(p)) for p in places], colour, 0.7, "--", 1.5, blocks=False)


def moving_points(linkage: Linkage) -> list[str]:
    """Named points that move, once each."""
    fixed = linkage.links[FRAME].points
    return list(dict.fromkeys(p for n in linkage.moving for p in linkage.links[n].points if p not in fixed))
