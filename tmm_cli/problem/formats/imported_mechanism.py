"""A mechanism imported from another program, helpers to read its file, and its conversion to a problem file."""

from __future__ import annotations

import cmath
import json
import math
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from itertools import count
from string import ascii_uppercase
from typing import Any, Literal

from tmm_cli.language import _
from tmm_cli.problem.errors import Path, ProblemError, Tree, clean, nearest_name, quote
from tmm_cli.problem.scalars import plain_value
from tmm_cli.problem.values import LARGEST

FRAME = "\0"  # no link of any file is called so
LengthUnit = Literal["mm", "cm", "m", "in"]


@dataclass(frozen=True)
class ImportedBody:
    """A moving link of an imported mechanism.

    Attributes:
        name: name of the link in the imported file.
        points: names of its points; a point that belongs to several links, or also to the frame, is a hinge.
        label: description of the link.
        mass: mass (kg).
        inertia: moment of inertia about the centre of mass (kg m^2).
        centre: position of the centre of mass (unit of length of the file); None if there is none.
    """

    name: str
    points: tuple[str, ...]
    label: str = ""
    mass: float = 0.0
    inertia: float = 0.0
    centre: complex | None = None


@dataclass(frozen=True)
class ImportedSlide:
    """A prismatic pair: a point of the runner moves along a straight guide of the carrier.

    Attributes:
        runner: link that slides.
        point: point of the runner on the guide.
        carrier: link with the guide.
        through: position of a point on the guide (unit of length of the file).
        angle: angle of the guide (rad).
    """

    runner: str
    point: str
    carrier: str
    through: complex
    angle: float


@dataclass(frozen=True)
class ImportedDrive:
    """Drive of a link: rotation relative to the frame, or displacement along a guide of another link.

    Attributes:
        body: driven link.
        speed: speed in `unit`; positive counterclockwise or along the guide.
        unit: unit of the speed; `length/s` is the unit of length of the file per second.
        acceleration: angular acceleration (rad/s^2).
        on: link with the guide, or the frame.
        at: displacement from the point `through` of the guide (unit of length of the file); None for a rotation.
    """

    body: str
    speed: float
    unit: Literal["rad/s", "rpm", "length/s"] = "rad/s"
    acceleration: float = 0.0
    on: str = FRAME
    at: float | None = None


@dataclass(frozen=True)
class ImportedLoad:
    """A force at a point of a link, or a moment on a link.

    Attributes:
        name: name of the load in the imported file.
        body: loaded link.
        at: point of application (unit of length of the file).
        force: force (N).
        moment: moment (N m).
        turns: True if the force rotates with the link.
    """

    name: str
    body: str
    at: complex = 0j
    force: complex = 0j
    moment: float = 0.0
    turns: bool = False


@dataclass(frozen=True)
class ImportedMechanism:
    """A mechanism in the position in which another program saved it.

    Attributes:
        program: name of the program.
        title: title of the mechanism.
        length: unit of length of the file.
        places: positions of all points (unit of length of the file), by name.
        frame: names of the points on the frame.
        bodies: moving links.
        drive: drive of the input link.
        slides: prismatic pairs.
        pushes: loads.
        gravity: acceleration of gravity (m/s^2); None for the default.
        output: name of the output link; empty if there is none.
        one_place: True if the file describes only this position of the mechanism.
        notes: sentences on how unclear data were interpreted.
        left: sentences on what was not imported.
    """

    program: str
    title: str
    length: LengthUnit
    places: dict[str, complex]
    frame: tuple[str, ...]
    bodies: tuple[ImportedBody, ...]
    drive: ImportedDrive
    slides: tuple[ImportedSlide, ...] = ()
    pushes: tuple[ImportedLoad, ...] = ()
    gravity: complex | None = None
    output: str = ""
    one_place: bool = False
    notes: tuple[str, ...] = field(default=())
    left: tuple[str, ...] = field(default=())


# Values of an imported file with their positions in it, for error messages.


MAX_ITEMS = 500  # items of a list, keys of a mapping


@dataclass(frozen=True)
class FileNode:
    """A value of a file together with its path.

    Its methods return the value as a number, name, list and so on. They raise ProblemError, with line and column, if
    the value has another type.
    """

    tree: Tree
    data: Any
    path: Path = ()

    def refusal(self, message: str, allowed: str | None = None, near: str | None = None) -> ProblemError:
        """Return an error for this value, with line and column."""
        quoted = None if isinstance(self.data, dict | list) else quote(self.data)
        error = ProblemError(message, path=self.path, found=quoted, allowed=allowed, near=near)
        return error.located(self.tree.file, self.tree)

    def get(self, key: str) -> FileNode | None:
        """Return the value of a key, or None if the key is missing."""
        child = self.mapping().get(key)
        return None if child is None else FileNode(self.tree, child, (*self.path, key))

    def __getitem__(self, key: str) -> FileNode:
        child = self.get(key)
        if child is None:
            error = ProblemError(_("key '{key}' is missing").format(key=key), path=self.path, key=True)
            raise error.located(self.tree.file, self.tree)
        return child

    def mapping(self) -> dict[str, Any]:
        """Return the value as a dict of plain data."""
        if not isinstance(self.data, dict):
            raise self.refusal(_("expected keys with values"))
        self._bounded(len(self.data))
        return self.data

    def _bounded(self, length: int) -> None:
        if length > MAX_ITEMS:
            raise self.refusal(
                _("there are too many items or characters; at most {max_length} are allowed").format(
                    max_length=MAX_ITEMS
                )
            )

    def pairs(self) -> Iterator[tuple[str, FileNode]]:
        """Yield the keys of a mapping with their values as nodes."""
        for key, value in self.mapping().items():
            yield key, FileNode(self.tree, value, (*self.path, key))

    def items(self) -> list[FileNode]:
        """Return the items of a list as nodes."""
        if not isinstance(self.data, list):
            raise self.refusal(_("expected a list [..., ...]"))
        self._bounded(len(self.data))
        return [FileNode(self.tree, value, (*self.path, k)) for k, value in enumerate(self.data)]

    def text(self) -> str:
        """Return the value as a name; a whole number counts as a name."""
        if isinstance(self.data, bool) or not isinstance(self.data, str | int) or len(str(self.data)) > 100:
            raise self.refusal(_("expected a name"))
        return str(self.data)

    def one_of(self, names: Iterable[str]) -> str:
        """Return the value, which must be one of these names."""
        allowed, name = list(names), self.text()
        if name not in allowed:
            raise self.refusal(_("this value is not allowed here"), ", ".join(allowed), nearest_name(name, allowed))
        return name

    def number(self) -> float:
        """Return the value as a number. Numbers that are too large for a mechanism are refused."""
        if isinstance(self.data, bool) or not isinstance(self.data, int | float):
            raise self.refusal(_("expected a number"))
        if not -LARGEST <= self.data <= LARGEST:
            raise self.refusal(_("this value is too large for a mechanism"))
        return float(self.data)

    def vector(self) -> complex:
        """Return a list of coordinates as a complex number x + iy; a third coordinate is ignored, as the mechanism is
        planar.
        """
        items = self.items()
        if len(items) not in (2, 3):
            raise self.refusal(_("expected two coordinates [x, y]"))
        return complex(items[0].number(), items[1].number())


# The mechanism as the text of a problem file.


PLAIN_NAME = re.compile(r"(?!at$|g\d+$)[^\W\d_]\w{0,11}|[1-9]\d?")  # `at` and g1 mean something else beside them
SAME = 1e-9  # of the size: points so near are in one place
ROUNDING = 1e-15  # of the size: a coordinate that is less comes from rounding


def problem_file_text(foreign: ImportedMechanism, source: str) -> str:
    """Convert an imported mechanism to the text of a problem file.

    Args:
        foreign: imported mechanism.
        source: name of the imported file, for a comment.
    """
    return "\n".join(_ProblemFileWriter.of(foreign).lines(source)) + "\n"


@dataclass(frozen=True)
class _ProblemFileWriter:
    """Writer of the problem file of an imported mechanism.

    Attributes:
        foreign: imported mechanism.
        names: name of each point in the problem file, by its imported name.
        links: name of each link in the problem file, by its imported name.
        axes: origin (unit of length of the file) and angle (rad) of the axes of each link, by its imported name.
        size: largest distance of a point from the origin (unit of length of the file).
    """

    foreign: ImportedMechanism
    names: dict[str, str]
    links: dict[str, str]
    axes: dict[str, tuple[complex, float]]
    size: float

    @classmethod
    def of(cls, foreign: ImportedMechanism) -> _ProblemFileWriter:
        links = _choose_plain_names([body.name for body in foreign.bodies], map(str, count(1)), digits=True)
        axes: dict[str, tuple[complex, float]] = {FRAME: (0j, 0.0)}
        for body in foreign.bodies:
            axes[body.name] = _axes(foreign, body)
        for slide in foreign.slides:  # a stone has the directions of what it slides on
            if not _has_extent(foreign, slide.runner):
                axes[slide.runner] = (axes[slide.runner][0], axes[slide.carrier][1])
        return cls(foreign, _choose_plain_names(foreign.places, _letter_names()), links, axes, _mechanism_size(foreign))

    def lines(self, source: str) -> Iterator[str]:
        mechanism = self.foreign
        heading = _("Imported from {program}: {file}.").format(program=mechanism.program, file=clean(source, 200))
        yield f"# {heading}"
        for name, new in {**self.names, **self.links}.items():
            if name != new:
                yield "# " + _("{name} is called {new} in this file.").format(name=clean(name, 60), new=new)
        yield from (f"# {clean(note, 300)}" for note in mechanism.notes)
        if mechanism.left:
            yield "# " + _("Not imported:")
            yield from (f"# - {clean(line, 300)}" for line in mechanism.left)
        yield "tmm: 1"
        yield f"title: {_quote_text(mechanism.title or source)}"
        yield f"units: {{length: {mechanism.length}, angle: deg}}"
        if mechanism.frame:
            yield "points: " + _flow_mapping(
                (self.names[p], self._vector(mechanism.places[p])) for p in mechanism.frame
            )
        fixed = [slide for slide in mechanism.slides if slide.carrier == FRAME]
        if fixed:
            guides = [(f"g{k}", self._guide(slide)) for k, slide in enumerate(fixed, 1)]
            yield "guides: " + _flow_mapping(guides)
        yield "links:"
        for body in mechanism.bodies:
            yield f"  {self._key(body.name)}: {self._link(body, fixed)}"
        yield from self._motion()
        yield from self._loads()

    def _key(self, body: str) -> str:
        return "0" if body == FRAME else self.links[body]

    def _local(self, body: str, place: complex) -> complex:
        origin, angle = self.axes[body]
        return (place - origin) * cmath.rect(1, -angle)

    def _vector(self, z: complex) -> str:
        coordinates = (x if abs(x) > ROUNDING * self.size else 0.0 for x in (z.real, z.imag))
        return f"[{', '.join(map(_format_number, coordinates))}]"

    def _guide(self, slide: ImportedSlide) -> str:
        through = self._local(slide.carrier, slide.through)
        angle = math.degrees(slide.angle - self.axes[slide.carrier][1])
        return f"{{through: {self._vector(through)}, angle: {_format_number(math.remainder(angle, 360))}}}"

    def _link(self, body: ImportedBody, fixed: list[ImportedSlide]) -> str:
        points = {self.names[point]: self._local(body.name, self.foreign.places[point]) for point in body.points}
        parts = [("name", _quote_text(body.label))] if body.label else []
        if len(points) == 2 and _has_extent(self.foreign, body.name):
            parts += [("points", f"[{', '.join(points)}]"), ("length", _format_number(abs(list(points.values())[1])))]
        elif len(points) == 1:
            parts.append(("points", f"[{next(iter(points))}]"))
        else:
            parts.append(("points", _flow_mapping((name, self._vector(z)) for name, z in points.items())))
        slides = [self._slide(slide, fixed) for slide in self.foreign.slides if slide.runner == body.name]
        if slides:
            parts.append(("slides", slides[0] if len(slides) == 1 else f"[{', '.join(slides)}]"))
        return _flow_mapping(parts)

    def _slide(self, slide: ImportedSlide, fixed: list[ImportedSlide]) -> str:
        turned = math.degrees(self.axes[slide.runner][1] - self.axes[slide.carrier][1])
        parts = [("point", self.names[slide.point])]
        if abs(math.remainder(turned, 360)) > SAME:
            parts.append(("turned", _format_number(math.remainder(turned, 360))))
        if slide.carrier == FRAME:
            return _flow_mapping([("on", f"g{fixed.index(slide) + 1}"), *parts])
        return (
            _flow_mapping([("on", self._key(slide.carrier))]).rstrip("}")
            + ", "
            + self._guide(slide)[1:-1]
            + ", "
            + _flow_mapping(parts)[1:]
        )

    def _motion(self) -> Iterator[str]:
        mechanism, drive = self.foreign, self.foreign.drive
        entries = [("link", self._key(drive.body))]
        if drive.on != FRAME:
            entries.append(("on", self._key(drive.on)))
        if drive.at is None:
            speed = f"{_format_number(abs(drive.speed))} {drive.unit}"
            entries += [("speed", speed), ("turns", "cw" if drive.speed < 0 else "ccw")]
        else:
            entries.append(("speed", f"{_format_number(drive.speed)} {drive.unit.replace('length', mechanism.length)}"))
        if drive.acceleration:
            gain = drive.acceleration * (-1 if drive.speed < 0 else 1)
            entries.append(("acceleration", f"{_format_number(gain)} rad/s^2"))
        yield "driver: " + _flow_mapping(entries)
        angle = math.remainder(math.degrees(self.axes[drive.body][1]), 360)
        at = _format_number(angle if drive.at is None else drive.at)
        moving = [(self.names[p], self._vector(z)) for p, z in mechanism.places.items() if p not in mechanism.frame]
        turned = [
            (self._key(body.name), _format_number(math.degrees(self.axes[body.name][1])))
            for body in mechanism.bodies
            if (body.name != drive.body or drive.at is not None)
            and not _has_extent(mechanism, body.name)
            and self._key(body.name) not in mechanism.places
        ]
        yield "sketch: " + _flow_mapping([("at", at), *moving, *turned])
        if mechanism.output:
            yield f"output: {self._key(mechanism.output)}"
        yield f"positions: {{at: [{at}], detail: [0]}}" if mechanism.one_place else "positions: {count: 12}"

    def _loads(self) -> Iterator[str]:
        mechanism = self.foreign
        masses = [(self._key(body.name), self._mass(body)) for body in mechanism.bodies if body.mass or body.inertia]
        if masses:
            yield "masses:"
            yield from (f"  {name}: {mass}" for name, mass in masses)
        if mechanism.pushes:
            yield "loads:"
            names = _choose_plain_names([push.name for push in mechanism.pushes], (f"F{k}" for k in count(1)))
            yield from (f"  {names[push.name]}: {self._push(push)}" for push in mechanism.pushes)
        if mechanism.gravity is not None:
            yield f"gravity: {self._vector(mechanism.gravity)}"

    def _mass(self, body: ImportedBody) -> str:
        parts = [("mass", f"{_format_number(body.mass)} kg"), ("inertia", f"{_format_number(body.inertia)} kg*m^2")]
        if body.centre is not None:
            parts.append(("centre", self._vector(self._local(body.name, body.centre))))
        return _flow_mapping(parts)

    def _push(self, push: ImportedLoad) -> str:
        parts = [("on", self._key(push.body))]
        if push.force:
            parts.append(("at", self._vector(self._local(push.body, push.at))))
            force = push.force * cmath.rect(1, -self.axes[push.body][1]) if push.turns else push.force
            components = ", ".join(f"{_format_number(component)} N" for component in (force.real, force.imag))
            parts.append(("force", f"[{components}]"))
            if push.turns:
                parts.append(("axes", "link"))
        if push.moment:
            parts.append(("moment", f"{_format_number(push.moment)} N*m"))
        return _flow_mapping(parts)


def _axes(foreign: ImportedMechanism, body: ImportedBody) -> tuple[complex, float]:
    """Return origin and angle (rad) of the axes of a link.

    The origin is its first point; the x axis points to the next point that does not coincide with the origin.
    """
    positions = [foreign.places[point] for point in body.points]
    origin = positions[0] if positions else body.centre or 0j
    away = next((z for z in positions if abs(z - origin) > SAME * _mechanism_size(foreign)), None)
    return origin, 0.0 if away is None else cmath.phase(away - origin)


def _has_extent(foreign: ImportedMechanism, name: str) -> bool:
    """Return True if a link has two points that do not coincide."""
    body = next(body for body in foreign.bodies if body.name == name)
    positions = [foreign.places[point] for point in body.points]
    return any(abs(z - positions[0]) > SAME * _mechanism_size(foreign) for z in positions)


def _mechanism_size(foreign: ImportedMechanism) -> float:
    return max((abs(z) for z in foreign.places.values()), default=1.0)


def _choose_plain_names(names: Iterable[str], others: Iterable[str], *, digits: bool = False) -> dict[str, str]:
    """Choose for each imported name a name for the problem file that YAML reads as a text.

    The imported name itself is kept if possible; otherwise it is the first unused one of `others`.

    digits: True if whole numbers are also allowed as names.
    """
    original = list(dict.fromkeys(names))
    free = (other for other in others if other not in original)
    return {name: name if _is_plain_name(name, digits) else next(free) for name in original}


def _is_plain_name(name: str, digits: bool) -> bool:
    """Return True if YAML reads the text as a name, and not as null, true or nan."""
    if not PLAIN_NAME.fullmatch(name):
        return False
    try:
        read = plain_value(name)
    except ProblemError:
        return False
    return isinstance(read, str) or (digits and type(read) is int)


def _letter_names() -> Iterator[str]:
    """Yield the names A, B, ..., Z, A1, B1, ...."""
    for k in count():
        yield from (letter + (str(k) if k else "") for letter in ascii_uppercase)


def _format_number(value: float) -> str:
    return f"{value + 0.0:.15g}"


def _quote_text(text: str) -> str:
    return json.dumps(clean(text, 200), ensure_ascii=False)


def _flow_mapping(parts: Iterable[tuple[str, str]]) -> str:
    return "{" + ", ".join(f"{key}: {value}" for key, value in parts) + "}"
