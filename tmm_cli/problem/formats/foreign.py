"""A mechanism as other programs save it: bodies in one place of the driver, with what could not be taken over."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

FRAME = "\0"  # no link of any file is called so
Length = Literal["mm", "cm", "m", "in"]


@dataclass(frozen=True)
class Body:
    """A moving link. points: names; one that is on several bodies, or on the frame, is a hinge. centre: its place."""

    name: str
    points: tuple[str, ...]
    label: str = ""
    mass: float = 0.0
    inertia: float = 0.0
    centre: complex | None = None


@dataclass(frozen=True)
class Slide:
    """A point of the runner on a straight guide of the carrier, which goes through a place at an angle (rad)."""

    runner: str
    point: str
    carrier: str
    through: complex
    angle: float


@dataclass(frozen=True)
class Drive:
    """What rotates a body on the frame, counterclockwise, or moves it along its guide on another body.

    speed: in its unit, `length/s` for units of length of the file per second; acceleration: rad/s^2; on: the body with
    the guide; at: displacement from the place of the guide (unit of lengths), None for a rotation.
    """

    body: str
    speed: float
    unit: Literal["rad/s", "rpm", "length/s"] = "rad/s"
    acceleration: float = 0.0
    on: str = FRAME
    at: float | None = None


@dataclass(frozen=True)
class Push:
    """A force (N) at a place of a body, or a moment (N*m) on it. turns: the force turns with the body."""

    name: str
    body: str
    at: complex = 0j
    force: complex = 0j
    moment: float = 0.0
    turns: bool = False


@dataclass(frozen=True)
class Foreign:
    """places: of all points, in the unit of lengths; frame: names of its points. gravity: m/s^2, None: ours.

    one_place: the file is about the place in which it is saved, and no other. notes: what had to be interpreted;
    left: what the problem file does not say. Both in whole sentences.
    """

    program: str
    title: str
    length: Length
    places: dict[str, complex]
    frame: tuple[str, ...]
    bodies: tuple[Body, ...]
    drive: Drive
    slides: tuple[Slide, ...] = ()
    pushes: tuple[Push, ...] = ()
    gravity: complex | None = None
    output: str = ""
    one_place: bool = False
    notes: tuple[str, ...] = field(default=())
    left: tuple[str, ...] = field(default=())
