"""Bodies that move as one on the page: links, boxes of sliders, springs, with their marks in their own axes.

A body is drawn once; the page moves it to its place in each frame.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import groupby
from typing import Any

import numpy as np

from tmm_cli.drawing.paper import DARK_COLOUR, AreaMark, CircleMark, DrawingSheet, LineMark, Mark
from tmm_cli.drawing.symbols import (
    BOX_BODY,
    MOVING,
    ON_LINE,
    SPRING_BODY,
    LinkForm,
    MechanismScene,
    cylinder_drivers,
    draw_mass_centre,
    render_scene,
)
from tmm_cli.mechanics.kinematics import Motion
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.numerics import Real, Vector, unit


@dataclass
class MovingBody:
    """Body with its place (mm on the sheet), accumulated angle (rad) and stretch relative to the drawing, in
    every frame.

    marks: its marks in its own axes.
    """

    place: Vector
    angle: Real
    stretch: Real
    marks: list[Mark] = field(default_factory=list)

    def own(self, at: complex) -> complex:
        """Return a place on the sheet in the first frame in the body's axes."""
        return complex((at - self.place[0]) * np.exp(-1j * self.angle[0]))

    def take(self, marks: list[Mark]) -> None:
        """Attach marks drawn in the first frame to the body."""
        self.marks += [_in_body_axes(mark, self.own) for mark in marks]

    def at(self, local_place: Any, k: int) -> Any:
        """Return a place of the body on the sheet in frame k."""
        local = np.real(local_place) * self.stretch[k] + 1j * np.imag(local_place)
        return self.place[k] + local * np.exp(1j * self.angle[k])


def _in_body_axes(mark: Mark, to_body: Callable[[complex], complex]) -> Mark:
    match mark:
        case LineMark():
            return replace(mark, places=tuple(map(to_body, mark.places)))
        case AreaMark():
            return replace(mark, corners=tuple(map(to_body, mark.corners)))
        case CircleMark():
            return replace(mark, centre=to_body(mark.centre))
    return replace(mark, at=to_body(mark.at))


@dataclass
class MechanismPicture:
    """A mechanism divided into bodies by name; each link and the frame is one."""

    sheet: DrawingSheet
    motion: Motion
    scene: MechanismScene
    bodies: dict[str, MovingBody]
    forms: Mapping[str, LinkForm]

    @classmethod
    def of(cls, sheet: DrawingSheet, motion: Motion, scene: MechanismScene) -> MechanismPicture:
        """Draw a scene in its first frame and divide it; marks of no body, such as contact points of gears, are
        omitted.
        """
        linkage, pairs = scene.linkage, scene.structure.pairs
        drawn = render_scene(sheet, scene, linkage.moving, pairs, MOVING, dict.fromkeys(linkage.links, DARK_COLOUR))
        picture = cls(sheet, motion, scene, {}, drawn.forms)
        picture._masses()
        parts, alike = {name for name, __ in sheet.parts}, np.ones(motion.q.shape)
        picture.bodies[FRAME] = MovingBody(np.zeros_like(motion.q) * 0j, np.zeros_like(motion.q), alike)
        for link in linkage.moving:
            pose = motion.poses[link].spread(motion.q.shape)
            angle = pose.turned if pose.unwrapped is not None else np.unwrap(pose.turned)
            picture.bodies[link] = MovingBody(sheet.origin + pose.x / sheet.mu, angle, alike)
        for slide in linkage.slides:
            if BOX_BODY.format(slide.name) in parts:
                angle = picture.bodies[slide.carrier].angle + float(np.angle(unit(slide.direction)))
                picture.bodies[BOX_BODY.format(slide.name)] = MovingBody(
                    picture._spots(slide.runner, slide.at), angle, alike
                )
        for spring in linkage.springs:
            start, end = picture._spots(spring.i, spring.at_i), picture._spots(spring.j, spring.at_j)
            length = np.abs(end - start)
            if SPRING_BODY.format(spring.name) in parts and length.min() > 0:
                angle = np.unwrap(np.angle(end - start))
                picture.bodies[SPRING_BODY.format(spring.name)] = MovingBody(start, angle, length / length[0])
        for name, indices in sheet.parts:
            if name in picture.bodies:
                picture.bodies[name].take(sheet.marks[indices])
        return picture

    def _masses(self) -> None:
        """Draw centres of mass that are not named points."""
        for link in self.scene.linkage.moving:
            properties = self.scene.linkage.links[link]
            if np.any(properties.mass != 0) and all(
                abs(properties.centre - local) > 0 for local in properties.points.values()
            ):
                with self.sheet.part(link):
                    draw_mass_centre(self.sheet, self.sheet.on(self.scene.place(link, complex(properties.centre))))

    def _spots(self, link: str, local: complex) -> Vector:
        """Places of a point of a link on the sheet, in all frames."""
        if link == FRAME:
            return np.full(self.motion.q.shape, self.sheet.on(complex(local)))
        return self.sheet.origin + self.motion.poses[link].spread(self.motion.q.shape).at(local) / self.sheet.mu

    def layers(self) -> Iterator[tuple[str, list[Mark]]]:
        """Yield marks of bodies from the lowest to the highest layer."""
        marks = [(mark.z, name, mark) for name, body in self.bodies.items() for mark in body.marks]
        marks.sort(key=lambda entry: entry[0])
        for name, layer in groupby(marks, key=lambda entry: entry[1]):
            yield name, [mark for *__, mark in layer]


# Names of points and numbers of links, which go with the bodies that carry them.


LABEL_DISTANCE, NUMBER_DISTANCE = (
    4.0,
    6.5,
)  # mm from a hinge to its name; from the middle of a box to the number of its link


def body_labels(picture: MechanismPicture, names: Sequence[str]) -> list[dict[str, Any]]:
    """Return names of points beyond the ends of links and numbers beside links, in axes of the bodies that carry
    them.
    """
    linkage, names_by_place = picture.scene.linkage, dict[tuple[str, complex], list[str]]()
    for name in {point: None for link in (FRAME, *linkage.moving) for point in linkage.links[link].points}:
        owners = [link for link in (FRAME, *linkage.moving) if name in linkage.links[link].points]
        # on a link with more points there is a way out
        carrier = FRAME if FRAME in owners else max(owners, key=lambda link: len(linkage.links[link].points) > 1)
        local = complex(linkage.local(carrier, name))
        names_by_place.setdefault((carrier, complex(round(local.real, 9), round(local.imag, 9))), []).append(name)
    points = [
        {
            "body": names.index(link),
            "at": page_coordinates(_point_label_place(picture, link, local)),
            "text": ", ".join(text),
            "kind": "point",
        }
        for (link, local), text in names_by_place.items()
    ]
    numbers = [
        {"body": names.index(link), "at": page_coordinates(_number_place(picture, link)), "text": link, "kind": "link"}
        for link in linkage.moving
        if np.isfinite(picture.forms[link].middle)
    ]
    return [*points, *numbers]


def _point_label_place(picture: MechanismPicture, link: str, local: complex) -> complex:
    """Place of a point's name in its link's axes: away from the middle of the link, outside a slider's box."""
    sheet, scene = picture.sheet, picture.scene
    at, driven = sheet.on(scene.place(link, local)), cylinder_drivers(scene.linkage)
    slides = [slide for slide in scene.linkage.slides if slide.name not in driven]
    boxed = any(abs(sheet.on(scene.place(slide.runner, slide.at)) - at) < ON_LINE for slide in slides)
    label = picture.bodies[link].own(at)
    if link == FRAME:
        return label + LABEL_DISTANCE * (-1 if at.real < sheet.origin.real else 1)
    points = [sheet.on(scene.place(link, complex(z))) for z in scene.linkage.links[link].points.values()]
    out = label - picture.bodies[link].own(sum(points) / len(points))
    return label + (2 * LABEL_DISTANCE if boxed else LABEL_DISTANCE) * (
        out / abs(out) if abs(out) > 1 else complex(0.8, 0.6)
    )


def _number_place(picture: MechanismPicture, link: str) -> complex:
    """Place of a link's number in its axes: on its plate, beside its longest line, or beside its box."""
    form, to_body = picture.forms[link], picture.bodies[link].own
    if len(form.hull) > 2:
        return to_body(form.middle)
    start, end = max(form.lines, key=lambda line: abs(line[1] - line[0]), default=(0j, 0j))
    if abs(end - start) > 1:
        return to_body(form.middle + 3j * (end - start) / abs(end - start))
    slide = next((slide for slide in picture.scene.linkage.slides if slide.runner == link), None)
    return to_body(form.middle + (1 - 1j if slide is None else -1j * picture.scene.along(slide)) * NUMBER_DISTANCE)


def page_coordinates(z: complex) -> list[float]:
    """Return x and y with y pointing down."""
    return [round(z.real, 2) + 0.0, round(-z.imag, 2) + 0.0]
