"""linkage/v2: the YAML format of the coursework client nickadminroot/tmm-cli (its skills/tmm-yaml/REFERENCE.md).

The file constructs points step by step: rays, intersections of circles and lines, offsets.
"""

from __future__ import annotations

import cmath
import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from tmm_cli.language import _
from tmm_cli.problem.formats.imported_mechanism import (
    FRAME,
    FileNode,
    ImportedBody,
    ImportedDrive,
    ImportedLoad,
    ImportedMechanism,
    ImportedSlide,
)
from tmm_cli.problem.reader import read_text


class PointConstruction:
    """Construction of the points of a file in the one position that the file describes.

    Raises:
        ProblemError: a construction step is impossible or wrong.
    """

    def __init__(self, top: FileNode) -> None:
        self.parameters = dict(top["parameters"].pairs()) if top.get("parameters") else {}
        self.known: dict[str, complex] = {}
        geometry = top["geometry"]
        for name, place in geometry["points"].pairs() if geometry.get("points") else ():
            self.known[name] = place.vector()
        for step in geometry["construct"].items() if geometry.get("construct") else ():
            self.known[step["point"].text()] = STEPS[step["type"].one_of(STEPS)](self, step)
        for name, original in geometry["aliases"].pairs() if geometry.get("aliases") else ():
            self.known[name] = self.place(original.one_of(self.known))

    def place(self, name: str) -> complex:
        """Return the position of a constructed point."""
        return self.known[name]

    def number(self, node: FileNode) -> float:
        """Return a number of the file; a name stands for the parameter of that name."""
        for __ in range(10):  # a parameter may stand for another
            if not isinstance(node.data, str):
                return node.number()
            node = self.parameters[node.one_of(self.parameters)]
        raise node.refusal(_("the parameters depend on each other in a circle"))

    def of(self, step: FileNode, key: str) -> complex:
        """Return the position of the point that a construction step names under a key."""
        return self.place(step[key].one_of(self.known))


def _direction_of_step(points: PointConstruction, step: FileNode) -> complex:
    return cmath.rect(1, math.radians(points.number(step["angle_deg"])))


def _on_ray(points: PointConstruction, step: FileNode) -> complex:
    return points.of(step, "from") + points.number(step["length"]) * _direction_of_step(points, step)


def _circle_circle(points: PointConstruction, step: FileNode) -> complex:
    a, b = points.of(step, "center1"), points.of(step, "center2")
    r, s, apart = points.number(step["radius1"]), points.number(step["radius2"]), abs(b - a)
    if not apart:
        raise step.refusal(_("the circles have the same centre"))
    along = (r * r - s * s + apart * apart) / (2 * apart)
    ends = _two_points(a + along * (b - a) / apart, (b - a) / apart * 1j, r * r - along * along, step)
    return _choose_branch(step, ends, b - a)


def _circle_line(across: complex) -> Callable[[PointConstruction, FileNode], complex]:
    """Create the construction step that intersects a circle with a line x = ... or y = ....

    across: unit vector perpendicular to the line, 1 for x = ... and i for y = ....
    """

    def found(points: PointConstruction, step: FileNode) -> complex:
        centre, radius = points.of(step, "center"), points.number(step["radius"])
        key, coordinate = ("y", centre.imag) if across == 1j else ("x", centre.real)
        off = points.number(step[key]) - coordinate
        ends = _two_points(centre + off * across, across * -1j, radius * radius - off * off, step)
        return _choose_branch(step, ends, 1 + 0j)

    return found


def _circle_ray(points: PointConstruction, step: FileNode) -> complex:
    """Intersect a circle with a ray, given by its angle or by a second point and an angle by which it is rotated."""
    centre, radius, start = points.of(step, "center"), points.number(step["radius"]), points.of(step, "from")
    if step.get("through"):
        turn = cmath.rect(1, math.radians(points.number(step["rotate_deg"]))) if step.get("rotate_deg") else 1
        along = _unit_vector(points.of(step, "through") - start, step) * turn
    else:
        along = _direction_of_step(points, step)
    foot = (centre - start) / along
    square = radius * radius - foot.imag * foot.imag
    if square < 0:
        raise step.refusal(_("the lines of this construction step do not intersect"))
    ends = foot.real - math.sqrt(square), foot.real + math.sqrt(square)
    ahead = [end for end in ends if end > 0] or list(ends)
    branches = {"positive": ahead[0], "far_positive": ahead[-1], "near": min(ends, key=abs), "far": max(ends, key=abs)}
    return start + branches[step["branch"].one_of(branches)] * along


def _two_points(foot: complex, along: complex, square: float, step: FileNode) -> tuple[complex, complex]:
    if square < 0:
        raise step.refusal(_("the lines of this construction step do not intersect"))
    half = math.sqrt(square) * along
    return foot - half, foot + half


SIDES: Final[dict[str, Callable[[complex], float]]] = {
    "right": lambda z: z.real,
    "left": lambda z: -z.real,
    "upper": lambda z: z.imag,
    "lower": lambda z: -z.imag,
}


def _choose_branch(step: FileNode, ends: tuple[complex, complex], along: complex) -> complex:
    """Return the intersection that the key `branch` of the step names; ccw is the one to the left of the line of
    centres.
    """
    branch = step["branch"].one_of((*SIDES, "ccw", "cw"))
    if branch in SIDES:
        return max(ends, key=SIDES[branch])
    sense = 1 if branch == "ccw" else -1
    return max(ends, key=lambda z: sense * ((z - ends[0] - ends[1]) / along).imag)


def _at_angle(points: PointConstruction, step: FileNode) -> complex:
    vertex, start = points.of(step, "vertex"), points.of(step, "from")
    turn = math.radians(points.number(step["angle_deg"]))
    sense = -1 if step["side"].one_of(("clockwise", "counterclockwise", "cw", "ccw")).startswith(("clock", "cw")) else 1
    return vertex + points.number(step["length"]) * cmath.rect(1, cmath.phase(start - vertex) + sense * turn)


def _on_line(points: PointConstruction, step: FileNode) -> complex:
    a, b = points.of(step, "from"), points.of(step, "to")
    if fraction := step.get("fraction"):
        return a + points.number(fraction) * (b - a)
    return a + points.number(step["distance"]) * _unit_vector(b - a, step)


def _towards(points: PointConstruction, step: FileNode) -> complex:
    a, b = points.of(step, "from"), points.of(step, "to")
    return a + points.number(step["length"]) * _unit_vector(b - a, step)


def _offset(points: PointConstruction, step: FileNode) -> complex:
    start, length = points.of(step, "from"), points.number(step["length"])
    if step.get("angle_deg"):
        return start + length * _direction_of_step(points, step)
    vector = step["vector"] if step.get("vector") else step["direction"]
    return start + length * _unit_vector(vector.vector(), step)


def _unit_vector(along: complex, step: FileNode) -> complex:
    if not along:
        raise step.refusal(_("the two points coincide"))
    return along / abs(along)


STEPS: Final[dict[str, Callable[[PointConstruction, FileNode], complex]]] = {
    "point_on_ray": _on_ray,
    "circle_line_y": _circle_line(1j),
    "circle_line_x": _circle_line(1 + 0j),
    "circle_circle": _circle_circle,
    "circle_ray": _circle_ray,
    "point_at_angle": _at_angle,
    "point_on_line": _on_line,
    "point_towards": _towards,
    "point_offset": _offset,
}


# linkage/v2: the YAML of the coursework client nickadminroot/tmm-cli (skills/tmm-yaml/REFERENCE.md there).


KEYS = (
    "schema",
    "units",
    "parameters",
    "geometry",
    "bodies",
    "joints",
    "drive",
    "drives",
    "gravity",
    "loads",
    "output_body",
    "attached_masses",
    "dynamics",
)
HINGE, GUIDE = "revolute", "prismatic"


def recognised(text: str) -> bool:
    """Return True if the text is a file in the format linkage/v2."""
    return re.search(r"^[ \t]*schema:[ \t]*[\"']?linkage/v2", text, re.MULTILINE) is not None


def read(text: str, file: str) -> ImportedMechanism:
    """Read the mechanism from a linkage/v2 file. Raises ProblemError."""
    top = FileNode(tree := read_text(text, file), tree.data)
    return _LinkageV2Reader(top, PointConstruction(top)).build_mechanism()


@dataclass(frozen=True)
class _LinkageV2Reader:
    top: FileNode
    points: PointConstruction

    def build_mechanism(self) -> ImportedMechanism:
        """Build the imported mechanism from the file. Raises ProblemError."""
        hinges, slides = self._hinges(), self._slides()
        names = _name_points(hinges, [(slide.runner, slide.point) for slide in slides])
        bodies = tuple(
            ImportedBody(
                name,
                tuple(dict.fromkeys(point_name for (body, __), point_name in names.items() if body == name)),
                mass=self._value(body, "mass"),
                inertia=self._value(body, "inertia"),
                centre=self._centre(body),
            )
            for name, body in self.top["bodies"].pairs()
        )
        massed = [self._with_points(body) for body in bodies]
        positions = {point_name: self.points.place(point) for (__, point), point_name in names.items()}
        left = [_("Key `{key}` was ignored.").format(key=key) for key in self.top.mapping() if key not in KEYS]
        if self.top.get("dynamics"):
            left.append(_("Block `dynamics`: motor and flywheel have other keys here; write them by hand."))
        notes = [_("The file describes one position of the driver; `positions` requests this position.")]
        if (ratio := self._value(self._driven(), "q_ratio")) < 0:
            notes.append(
                _(
                    "q_ratio is {ratio}: the sign of omega was taken as the direction of rotation of the link itself."
                ).format(ratio=f"{ratio:g}")
            )
        output = (
            output_node.one_of(self.top["bodies"].mapping()) if (output_node := self.top.get("output_body")) else ""
        )
        gravity = gravity_node.vector() if (gravity_node := self.top.get("gravity")) else None
        return ImportedMechanism(
            "linkage/v2",
            "",
            "m",
            positions,
            tuple(point_name for (body, __), point_name in names.items() if body == FRAME),
            tuple(massed),
            self._drive(),
            tuple(ImportedSlide(s.runner, names[s.runner, s.point], s.carrier, s.through, s.angle) for s in slides),
            tuple(self._pushes()),
            gravity,
            output,
            True,
            tuple(notes),
            tuple(left),
        )

    def _value(self, node: FileNode, key: str) -> float:
        child = node.get(key)
        return 0.0 if child is None else self.points.number(child)

    def _body(self, node: FileNode) -> str:
        name = node.text()
        return FRAME if name == "ground" else node.one_of(self.top["bodies"].mapping())

    def _hinges(self) -> list[list[tuple[str, str]]]:
        """Return for each revolute pair a list of its links, each with the name of its point."""
        hinges = []
        for joint in self.top["joints"].items():
            if joint["type"].one_of((HINGE, GUIDE)) == HINGE:
                ends = joint["endpoints"].items()
                if len(ends) < 2:
                    raise joint["endpoints"].refusal(_("a hinge must join at least two links"))
                hinges.append([(self._body(end["body"]), end["point"].one_of(self.points.known)) for end in ends])
        return hinges

    def _slides(self) -> list[ImportedSlide]:
        slides = []
        for joint in self.top["joints"].items():
            if joint["type"].data == GUIDE:
                guide, slider = joint["guide"], joint["slider"]
                carrier, axis = self._body(guide["body"]), guide["axis"]
                origin, turn = self._frame(carrier)
                angle = math.radians(self.points.number(axis["angle_deg"]))
                through = self._through(axis["origin"], origin, turn)
                runner, point = self._body(slider["body"]), slider["point"].one_of(self.points.known)
                slides.append(ImportedSlide(runner, point, carrier, through, angle + turn))
        return slides

    def _frame(self, body: str) -> tuple[complex, float]:
        """Return the origin and the direction (unit vector) of the axes of a link; the axes of a slider are parallel to
        the frame.
        """
        if body == FRAME:
            return 0j, 0.0
        frame = self.top["bodies"][body]["frame"]
        origin = self.points.place(frame["origin"].one_of(self.points.known))
        if axis := frame.get("x_axis"):
            through = self.points.place(axis["through"].one_of(self.points.known))
            return origin, cmath.phase(through - origin)
        return origin, math.radians(self._value(frame, "angle_deg"))

    def _through(self, node: FileNode, origin: complex, turn: float) -> complex:
        """Return the position of a point on a guide, given by its name or by coordinates in the axes of the link."""
        if isinstance(node.data, str):
            return self.points.place(node.one_of(self.points.known))
        return origin + node.vector() * cmath.rect(1, turn)

    def _centre(self, body: FileNode) -> complex | None:
        com = body.get("com")
        if com is None:
            return None
        if isinstance(com.data, list):
            return com.vector()
        if com.data == "mid":
            frame = body["frame"]
            ends = (frame["origin"], frame["x_axis"]["through"])
            return sum(self.points.place(end.one_of(self.points.known)) for end in ends) / 2
        return self.points.place(com.one_of(self.points.known))

    def _with_points(self, body: ImportedBody) -> ImportedBody:
        """Return the mass properties of a link including the masses attached at its points."""
        mass, inertia, centre = body.mass, body.inertia, body.centre or 0j
        for attached in self.top["attached_masses"].items() if self.top.get("attached_masses") else ():
            if self._body(attached["body"]) == body.name:
                more, at = (
                    self.points.number(attached["mass"]),
                    self.points.place(attached["point"].one_of(self.points.known)),
                )
                if more and mass + more:
                    inertia += mass * more / (mass + more) * abs(at - centre) ** 2
                    centre, mass = (mass * centre + more * at) / (mass + more), mass + more
        return ImportedBody(body.name, body.points, body.label, mass, inertia, centre if mass else None)

    def _driven(self) -> FileNode:
        drives = [self.top["drive"]] if self.top.get("drive") else self.top["drives"].items()
        if len(drives) != 1:
            raise self.top.refusal(_("expected exactly one input link"))
        return drives[0]

    def _drive(self) -> ImportedDrive:
        drive = self._driven()
        return ImportedDrive(
            self._body(drive["body"]), self._value(drive, "omega"), acceleration=self._value(drive, "alpha")
        )

    def _pushes(self) -> list[ImportedLoad]:
        loads = []
        for k, load in enumerate(self.top["loads"].items() if self.top.get("loads") else (), 1):
            name = called.text() if (called := load.get("id")) else f"F{k}"
            body = self._body(load["body"])
            if moment := load.get("moment"):
                loads.append(ImportedLoad(name, body, moment=self.points.number(moment)))
                continue
            force = self._force(load)
            if force:
                loads.append(
                    ImportedLoad(name, body, self.points.place(load["point"].one_of(self.points.known)), force)
                )
        return loads

    def _force(self, load: FileNode) -> complex:
        if vector := load.get("vector"):
            return vector.vector()
        direction = load["direction_points"] if load.get("direction_points") else load["direction"]
        ends = direction.items()
        if len(ends) == 2 and all(isinstance(end.data, str) for end in ends):
            a, b = (self.points.place(end.one_of(self.points.known)) for end in ends)
            along = b - a
        else:
            along = direction.vector()
        if not along:
            raise direction.refusal(_("this vector has no direction: its length is zero"))
        return self.points.number(load["magnitude"]) * along / abs(along)


def _name_points(hinges: list[list[tuple[str, str]]], runners: list[tuple[str, str]]) -> dict[tuple[str, str], str]:
    """Choose a name for each point of each link. Points of different links have the same name only if they form a
    hinge.
    """
    joined: list[set[tuple[str, str]]] = []
    for ends in [*hinges, *([runner] for runner in runners)]:
        group = set(ends).union(*(other for other in joined if other & set(ends)))
        joined = [other for other in joined if not other & group] + [group]
    names: dict[tuple[str, str], str] = {}
    taken: set[str] = set()
    for group in joined:
        first = min(group)[1]
        name, k = first, 1
        while name in taken:
            k += 1
            name = f"{first}{k}"
        taken.add(name)
        names |= dict.fromkeys(sorted(group), name)
    return names
