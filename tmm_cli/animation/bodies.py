"""Rigid bodies of the animated drawing: links, slider boxes and load elements, each drawn in its own axes.

A body is drawn once. In each frame the page only moves and rotates it. A load element such as a spring is also
stretched.
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
    ELEMENT_BODY,
    MOVING,
    ON_LINE,
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
    """A body of the animated drawing and its motion.

    Attributes:
        place: position of its origin on the sheet in each frame, (frames,), mm.
        angle: rotation angle in each frame, accumulated over the revolutions, (frames,), rad.
        stretch: length relative to that in the first frame, (frames,); 1 except for load elements.
        marks: its lines, areas and texts, in its own axes.
    """

    place: Vector
    angle: Real
    stretch: Real
    marks: list[Mark] = field(default_factory=list)

    def to_body_axes(self, at: complex) -> complex:
        """Convert a point of the sheet (mm) to the axes of the body, which is in its position in the first frame."""
        return complex((at - self.place[0]) * np.exp(-1j * self.angle[0]))

    def add_marks(self, marks: list[Mark]) -> None:
        """Add marks to the body that were drawn on the sheet with the mechanism in its first frame."""
        self.marks += [_in_body_axes(mark, self.to_body_axes) for mark in marks]

    def to_sheet(self, local_place: Any, k: int) -> Any:
        """Convert a point from the axes of the body to the sheet (mm) in frame k."""
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
    """Drawing of a mechanism, divided into bodies that move separately. Each link is a body, and so is the frame."""

    sheet: DrawingSheet
    motion: Motion
    scene: MechanismScene
    bodies: dict[str, MovingBody]
    forms: Mapping[str, LinkForm]

    @classmethod
    def of(cls, sheet: DrawingSheet, motion: Motion, scene: MechanismScene) -> MechanismPicture:
        """Draw the mechanism in its first frame and assign each mark to a body.

        Marks that belong to no body, such as contact points of gears, are omitted.
        """
        linkage, pairs = scene.linkage, scene.structure.pairs
        drawn = render_scene(sheet, scene, linkage.moving, pairs, MOVING, dict.fromkeys(linkage.links, DARK_COLOUR))
        picture = cls(sheet, motion, scene, {}, drawn.forms)
        picture._draw_mass_centres()
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
                    picture._point_positions(slide.runner, slide.at), angle, alike
                )
        for element in linkage.elements:
            start, end = (
                picture._point_positions(element.i, element.at_i),
                picture._point_positions(element.j, element.at_j),
            )
            length, body = np.abs(end - start), ELEMENT_BODY.format(element.name)
            if body in parts and length.min() > 0:
                picture.bodies[body] = MovingBody(start, np.unwrap(np.angle(end - start)), length / length[0])
        for name, indices in sheet.parts:
            if name in picture.bodies:
                picture.bodies[name].add_marks(sheet.marks[indices])
        return picture

    def _draw_mass_centres(self) -> None:
        """Draw the centres of mass that do not coincide with a named point."""
        for link in self.scene.linkage.moving:
            properties = self.scene.linkage.links[link]
            if np.any(properties.mass != 0) and all(
                abs(properties.centre - local) > 0 for local in properties.points.values()
            ):
                with self.sheet.part(link):
                    draw_mass_centre(self.sheet, self.sheet.on(self.scene.place(link, complex(properties.centre))))

    def _point_positions(self, link: str, local: complex) -> Vector:
        """Return the positions on the sheet of a point of a link in all frames, (frames,), mm."""
        if link == FRAME:
            return np.full(self.motion.q.shape, self.sheet.on(complex(local)))
        return self.sheet.origin + self.motion.poses[link].spread(self.motion.q.shape).at(local) / self.sheet.mu

    def layers(self) -> Iterator[tuple[str, list[Mark]]]:
        """Yield the marks in drawing order, as (body name, consecutive marks of this body)."""
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
    """Return the names of points and the numbers of links as JSON data, each positioned in the axes of its body."""
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
            "at": page_coordinates(_point_label_position(picture, link, local)),
            "text": ", ".join(text),
            "kind": "point",
        }
        for (link, local), text in names_by_place.items()
    ]
    numbers = [
        {
            "body": names.index(link),
            "at": page_coordinates(_link_number_position(picture, link)),
            "text": link,
            "kind": "link",
        }
        for link in linkage.moving
        if np.isfinite(picture.forms[link].middle)
    ]
    return [*points, *numbers]


def _point_label_position(picture: MechanismPicture, link: str, local: complex) -> complex:
    """Return the position of a point's name in the axes of its link: on the side away from the middle of the link."""
    sheet, scene = picture.sheet, picture.scene
    at, driven = sheet.on(scene.place(link, local)), cylinder_drivers(scene.linkage)
    slides = [slide for slide in scene.linkage.slides if slide.name not in driven]
    boxed = any(abs(sheet.on(scene.place(slide.runner, slide.at)) - at) < ON_LINE for slide in slides)
    label = picture.bodies[link].to_body_axes(at)
    if link == FRAME:
        return label + LABEL_DISTANCE * (-1 if at.real < sheet.origin.real else 1)
    points = [sheet.on(scene.place(link, complex(z))) for z in scene.linkage.links[link].points.values()]
    out = label - picture.bodies[link].to_body_axes(sum(points) / len(points))
    return label + (2 * LABEL_DISTANCE if boxed else LABEL_DISTANCE) * (
        out / abs(out) if abs(out) > 1 else complex(0.8, 0.6)
    )


def _link_number_position(picture: MechanismPicture, link: str) -> complex:
    """Return the position of a link's number in the axes of the link.

    It is on the plate of the link; if there is none, beside its longest line or its box.
    """
    form, to_body = picture.forms[link], picture.bodies[link].to_body_axes
    if len(form.hull) > 2:
        return to_body(form.middle)
    start, end = max(form.lines, key=lambda line: abs(line[1] - line[0]), default=(0j, 0j))
    if abs(end - start) > 1:
        return to_body(form.middle + 3j * (end - start) / abs(end - start))
    slide = next((slide for slide in picture.scene.linkage.slides if slide.runner == link), None)
    return to_body(form.middle + (1 - 1j if slide is None else -1j * picture.scene.along(slide)) * NUMBER_DISTANCE)


def page_coordinates(z: complex) -> list[float]:
    """Return the rounded coordinates [x, y] of a point, with y pointing down as on a web page."""
    return [round(z.real, 2) + 0.0, round(-z.imag, 2) + 0.0]
