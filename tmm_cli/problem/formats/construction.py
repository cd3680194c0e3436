"""Places of points by the steps of linkage/v2: rays, intersections of circles and lines, offsets."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from typing import Final

from tmm_cli.language import _
from tmm_cli.problem.formats.node import Node


class Construction:
    """Points of the file in its one place of the driver. Raises ProblemError."""

    def __init__(self, top: Node) -> None:
        self.parameters = dict(top["parameters"].pairs()) if top.get("parameters") else {}
        self.known: dict[str, complex] = {}
        geometry = top["geometry"]
        for name, place in geometry["points"].pairs() if geometry.get("points") else ():
            self.known[name] = place.vector()
        for step in geometry["construct"].items() if geometry.get("construct") else ():
            self.known[step["point"].text()] = STEPS[step["type"].one_of(STEPS)](self, step)
        for name, of in geometry["aliases"].pairs() if geometry.get("aliases") else ():
            self.known[name] = self.place(of.one_of(self.known))

    def place(self, name: str) -> complex:
        """Of a point that is known."""
        return self.known[name]

    def number(self, node: Node) -> float:
        """A number, or that of a parameter."""
        for __ in range(10):  # a parameter may stand for another
            if not isinstance(node.data, str):
                return node.number()
            node = self.parameters[node.one_of(self.parameters)]
        raise node.refused(_("parameters stand for one another in a circle"))

    def of(self, step: Node, key: str) -> complex:
        """The place that a key names."""
        return self.place(step[key].one_of(self.known))


def _angle(points: Construction, step: Node) -> complex:
    return cmath.rect(1, math.radians(points.number(step["angle_deg"])))


def _on_ray(points: Construction, step: Node) -> complex:
    return points.of(step, "from") + points.number(step["length"]) * _angle(points, step)


def _circles(points: Construction, step: Node) -> complex:
    a, b = points.of(step, "center1"), points.of(step, "center2")
    r, s, apart = points.number(step["radius1"]), points.number(step["radius2"]), abs(b - a)
    if not apart:
        raise step.refused(_("the circles have one centre"))
    along = (r * r - s * s + apart * apart) / (2 * apart)
    ends = _both(a + along * (b - a) / apart, (b - a) / apart * 1j, r * r - along * along, step)
    return _branch(step, ends, b - a)


def _circle_line(across: complex) -> Callable[[Construction, Node], complex]:
    """Of a circle with a line x = ... or y = ...."""

    def found(points: Construction, step: Node) -> complex:
        centre, radius = points.of(step, "center"), points.number(step["radius"])
        key, own = ("y", centre.imag) if across == 1j else ("x", centre.real)
        off = points.number(step[key]) - own
        ends = _both(centre + off * across, across * -1j, radius * radius - off * off, step)
        return _branch(step, ends, 1 + 0j)

    return found


def _circle_ray(points: Construction, step: Node) -> complex:
    """Of a circle with a ray at an angle, or through a second point and turned by one."""
    centre, radius, start = points.of(step, "center"), points.number(step["radius"]), points.of(step, "from")
    if step.get("through"):
        turn = cmath.rect(1, math.radians(points.number(step["rotate_deg"]))) if step.get("rotate_deg") else 1
        along = _unit(points.of(step, "through") - start, step) * turn
    else:
        along = _angle(points, step)
    foot = (centre - start) / along
    square = radius * radius - foot.imag * foot.imag
    if square < 0:
        raise step.refused(_("they do not meet"))
    ends = foot.real - math.sqrt(square), foot.real + math.sqrt(square)
    ahead = [end for end in ends if end > 0] or list(ends)
    wanted = {"positive": ahead[0], "far_positive": ahead[-1], "near": min(ends, key=abs), "far": max(ends, key=abs)}
    return start + wanted[step["branch"].one_of(wanted)] * along


def _both(foot: complex, along: complex, square: float, step: Node) -> tuple[complex, complex]:
    if square < 0:
        raise step.refused(_("they do not meet"))
    half = math.sqrt(square) * along
    return foot - half, foot + half


SIDES: Final[dict[str, Callable[[complex], float]]] = {
    "right": lambda z: z.real, "left": lambda z: -z.real, "upper": lambda z: z.imag, "lower": lambda z: -z.imag,
}  # fmt: skip


def _branch(step: Node, ends: tuple[complex, complex], along: complex) -> complex:
    """That of two places which the step names; ccw: to the left of the line of centres."""
    branch = step["branch"].one_of((*SIDES, "ccw", "cw"))
    if branch in SIDES:
        return max(ends, key=SIDES[branch])
    sense = 1 if branch == "ccw" else -1
    return max(ends, key=lambda z: sense * ((z - ends[0] - ends[1]) / along).imag)


def _at_angle(points: Construction, step: Node) -> complex:
    vertex, start = points.of(step, "vertex"), points.of(step, "from")
    turn = math.radians(points.number(step["angle_deg"]))
    sense = -1 if step["side"].one_of(("clockwise", "counterclockwise", "cw", "ccw")).startswith(("clock", "cw")) else 1
    return vertex + points.number(step["length"]) * cmath.rect(1, cmath.phase(start - vertex) + sense * turn)


def _on_line(points: Construction, step: Node) -> complex:
    a, b = points.of(step, "from"), points.of(step, "to")
    if fraction := step.get("fraction"):
        return a + points.number(fraction) * (b - a)
    return a + points.number(step["distance"]) * _unit(b - a, step)


def _towards(points: Construction, step: Node) -> complex:
    a, b = points.of(step, "from"), points.of(step, "to")
    return a + points.number(step["length"]) * _unit(b - a, step)


def _offset(points: Construction, step: Node) -> complex:
    start, length = points.of(step, "from"), points.number(step["length"])
    if step.get("angle_deg"):
        return start + length * _angle(points, step)
    given = step["vector"] if step.get("vector") else step["direction"]
    return start + length * _unit(given.vector(), step)


def _unit(along: complex, step: Node) -> complex:
    if not along:
        raise step.refused(_("both points are in one place"))
    return along / abs(along)


STEPS: Final[dict[str, Callable[[Construction, Node], complex]]] = {
    "point_on_ray": _on_ray, "circle_line_y": _circle_line(1j), "circle_line_x": _circle_line(1 + 0j),
    "circle_circle": _circles, "circle_ray": _circle_ray, "point_at_angle": _at_angle, "point_on_line": _on_line,
    "point_towards": _towards, "point_offset": _offset,
}  # fmt: skip
