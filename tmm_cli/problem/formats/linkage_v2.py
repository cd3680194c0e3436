"""linkage/v2: the YAML of the coursework client nickadminroot/tmm-cli (skills/tmm-yaml/REFERENCE.md there)."""

from __future__ import annotations

import cmath
import math
import re
from dataclasses import dataclass

from tmm_cli.language import _
from tmm_cli.problem.formats.construction import Construction
from tmm_cli.problem.formats.foreign import FRAME, Body, Drive, Foreign, Push, Slide
from tmm_cli.problem.formats.node import Node
from tmm_cli.problem.reader import read_text

KEYS = (
    "schema", "units", "parameters", "geometry", "bodies", "joints", "drive", "drives", "gravity", "loads",
    "output_body", "attached_masses", "dynamics",
)  # fmt: skip
HINGE, GUIDE = "revolute", "prismatic"


def recognised(text: str) -> bool:
    """Whether the text is of this format."""
    return re.search(r"^[ \t]*schema:[ \t]*[\"']?linkage/v2", text, re.MULTILINE) is not None


def read(text: str, file: str) -> Foreign:
    """The mechanism of a file. Raises ProblemError."""
    top = Node(tree := read_text(text, file), tree.data)
    return _Reading(top, Construction(top)).foreign()


@dataclass(frozen=True)
class _Reading:
    top: Node
    points: Construction

    def foreign(self) -> Foreign:
        """All of it."""
        hinges, slides = self._hinges(), self._slides()
        names = _names(hinges, [(slide.runner, slide.point) for slide in slides])
        bodies = tuple(
            Body(name, tuple(dict.fromkeys(found for (body, __), found in names.items() if body == name)),
                 mass=self._value(body, "mass"), inertia=self._value(body, "inertia"), centre=self._centre(body))
            for name, body in self.top["bodies"].pairs()
        )  # fmt: skip
        massed = [self._with_points(body) for body in bodies]
        places = {found: self.points.place(point) for (__, point), found in names.items()}
        left = [
            _("Key `{key}` is not read.").format(key=key) for key in self.top.mapping() if key not in KEYS
        ]  # fmt: skip
        if self.top.get("dynamics"):
            left.append(_("Block `dynamics`: motor and flywheel are said otherwise here."))
        notes = [_("The file is about one place of the driver; `positions` asks for that one.")]
        if (ratio := self._value(self._driven(), "q_ratio")) < 0:
            notes.append(_("q_ratio is {ratio}: the sign of omega is taken for that of the link itself.").format(
                ratio=f"{ratio:g}"))  # fmt: skip
        output = said.one_of(self.top["bodies"].mapping()) if (said := self.top.get("output_body")) else ""
        gravity = given.vector() if (given := self.top.get("gravity")) else None
        return Foreign(
            "linkage/v2", "", "m", places, tuple(found for (body, __), found in names.items() if body == FRAME),
            tuple(massed), self._drive(),
            tuple(Slide(s.runner, names[s.runner, s.point], s.carrier, s.through, s.angle) for s in slides),
            tuple(self._pushes()), gravity, output, True,
            tuple(notes), tuple(left),
        )  # fmt: skip

    def _value(self, node: Node, key: str) -> float:
        found = node.get(key)
        return 0.0 if found is None else self.points.number(found)

    def _body(self, node: Node) -> str:
        name = node.text()
        return FRAME if name == "ground" else node.one_of(self.top["bodies"].mapping())

    def _hinges(self) -> list[list[tuple[str, str]]]:
        """Of each turning pair the bodies with their points."""
        found = []
        for joint in self.top["joints"].items():
            if joint["type"].one_of((HINGE, GUIDE)) == HINGE:
                ends = joint["endpoints"].items()
                if len(ends) < 2:
                    raise joint["endpoints"].refused(_("a hinge joins two links"))
                found.append([(self._body(end["body"]), end["point"].one_of(self.points.known)) for end in ends])
        return found

    def _slides(self) -> list[Slide]:
        found = []
        for joint in self.top["joints"].items():
            if joint["type"].data == GUIDE:
                guide, slider = joint["guide"], joint["slider"]
                carrier, axis = self._body(guide["body"]), guide["axis"]
                origin, turn = self._frame(carrier)
                angle = math.radians(self.points.number(axis["angle_deg"]))
                through = self._through(axis["origin"], origin, turn)
                runner, point = self._body(slider["body"]), slider["point"].one_of(self.points.known)
                found.append(Slide(runner, point, carrier, through, angle + turn))
        return found

    def _frame(self, body: str) -> tuple[complex, float]:
        """Origin and direction of a body's axes; those of a slider are parallel to the frame's."""
        if body == FRAME:
            return 0j, 0.0
        frame = self.top["bodies"][body]["frame"]
        origin = self.points.place(frame["origin"].one_of(self.points.known))
        if axis := frame.get("x_axis"):
            through = self.points.place(axis["through"].one_of(self.points.known))
            return origin, cmath.phase(through - origin)
        return origin, math.radians(self._value(frame, "angle_deg"))

    def _through(self, node: Node, origin: complex, turn: float) -> complex:
        """A place of a guide: a point, or coordinates in the axes of its body."""
        if isinstance(node.data, str):
            return self.points.place(node.one_of(self.points.known))
        return origin + node.vector() * cmath.rect(1, turn)

    def _centre(self, body: Node) -> complex | None:
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

    def _with_points(self, body: Body) -> Body:
        """With the masses that are attached to its points."""
        mass, inertia, centre = body.mass, body.inertia, body.centre or 0j
        for own in self.top["attached_masses"].items() if self.top.get("attached_masses") else ():
            if self._body(own["body"]) == body.name:
                more, at = self.points.number(own["mass"]), self.points.place(own["point"].one_of(self.points.known))
                if more and mass + more:
                    inertia += mass * more / (mass + more) * abs(at - centre) ** 2
                    centre, mass = (mass * centre + more * at) / (mass + more), mass + more
        return Body(body.name, body.points, body.label, mass, inertia, centre if mass else None)

    def _driven(self) -> Node:
        drives = [self.top["drive"]] if self.top.get("drive") else self.top["drives"].items()
        if len(drives) != 1:
            raise self.top.refused(_("one driving link is wanted"))
        return drives[0]

    def _drive(self) -> Drive:
        drive = self._driven()
        return Drive(self._body(drive["body"]), self._value(drive, "omega"), acceleration=self._value(drive, "alpha"))

    def _pushes(self) -> list[Push]:
        found = []
        for k, load in enumerate(self.top["loads"].items() if self.top.get("loads") else (), 1):
            name = called.text() if (called := load.get("id")) else f"F{k}"
            body = self._body(load["body"])
            if moment := load.get("moment"):
                found.append(Push(name, body, moment=self.points.number(moment)))
                continue
            force = self._force(load)
            if force:
                found.append(Push(name, body, self.points.place(load["point"].one_of(self.points.known)), force))
        return found

    def _force(self, load: Node) -> complex:
        if vector := load.get("vector"):
            return vector.vector()
        given = load["direction_points"] if load.get("direction_points") else load["direction"]
        ends = given.items()
        if len(ends) == 2 and all(isinstance(end.data, str) for end in ends):
            a, b = (self.points.place(end.one_of(self.points.known)) for end in ends)
            along = b - a
        else:
            along = given.vector()
        if not along:
            raise given.refused(_("a direction is wanted"))
        return self.points.number(load["magnitude"]) * along / abs(along)


def _names(hinges: list[list[tuple[str, str]]], runners: list[tuple[str, str]]) -> dict[tuple[str, str], str]:
    """A name for each point of each body; those of a hinge have the same, and no others."""
    joined: list[set[tuple[str, str]]] = []
    for ends in [*hinges, *([one] for one in runners)]:
        own = set(ends).union(*(other for other in joined if other & set(ends)))
        joined = [other for other in joined if not other & own] + [own]
    found: dict[tuple[str, str], str] = {}
    taken: set[str] = set()
    for own in joined:
        first = min(own)[1]
        name, k = first, 1
        while name in taken:
            k += 1
            name = f"{first}{k}"
        taken.add(name)
        found |= dict.fromkeys(sorted(own), name)
    return found
