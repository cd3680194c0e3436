"""The numbers of a linkage: links, hinges, slides, driver, loads. SI and radians; no input or output.

A planar vector is a complex number. Every link has axes of its own: `points` and `centre` are given in them, and
the pose of a link is the place of its origin and the direction of its x axis. The frame is link "0"; its axes are
the axes of the drawing. Lengths may be numbers or arrays that broadcast against (variants, positions).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from tmm_cli.vectors import Real

FRAME = "0"


@dataclass(frozen=True)
class Link:
    """A rigid link: named points in its own axes (m), mass (kg), centre of mass (m), inertia about it (kg m2)."""

    name: str
    points: Mapping[str, complex]
    mass: float = 0.0
    inertia: float = 0.0
    centre: complex = 0j
    label: str = ""


@dataclass(frozen=True)
class Hinge:
    """A turning pair at a named point of two links, or a compound hinge of more: k links make k - 1 pairs."""

    point: str
    links: tuple[str, ...]


@dataclass(frozen=True)
class Slide:
    """A sliding pair: `point` of the runner moves on a straight guide of the carrier.

    The guide passes through `through` in the `direction` (rad), both in the carrier's axes. The runner's axes are
    turned by `turned` (rad) from the carrier's, always. `at` is the running point in the runner's axes.
    """

    name: str
    carrier: str
    runner: str
    through: complex
    direction: float
    at: complex
    turned: float = 0.0
    point: str = ""


@dataclass(frozen=True)
class Driver:
    """The input: a link that turns about the frame, or one that slides on it, by q = q0 + rate t + acceleration t^2/2.

    q is the angle of the link's x axis (rad) or the run along the guide from its `through` point (m). `sense` is +1
    or -1, and `rate` >= 0 is counted in that sense; `acceleration` too (negative: it slows down).
    """

    link: str
    kind: Literal["turn", "slide"]
    joint: str
    rate: float
    acceleration: float = 0.0
    sense: int = 1
    balance: Literal["moment", "force"] = "moment"
    end: str = ""


@dataclass(frozen=True)
class Table:
    """A load's size, tabulated: linear between the given arguments, constant beyond the first and the last."""

    against: Literal["stroke", "crank angle", "crank turn"]
    arguments: tuple[float, ...]
    values: tuple[float, ...]

    def __call__(self, argument: Real) -> Real:
        return np.interp(argument, self.arguments, self.values)


@dataclass(frozen=True)
class Load:
    """A force and a couple on a link.

    `force` (N) acts at `at` (the link's axes, m) and keeps its direction in the drawing, or in the link when
    `follows`; `moment` in N m. With a table, both are multiplied by its value.
    """

    name: str
    link: str
    at: complex = 0j
    force: complex = 0j
    moment: float = 0.0
    follows: bool = False
    working_stroke_only: bool = False
    table: Table | None = None
    point: str = ""


@dataclass(frozen=True)
class Sketch:
    """How the linkage looks at one place of its driver: which way round each group is assembled."""

    at: float
    points: Mapping[str, complex] = field(default_factory=dict)
    angles: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Output:
    """The link whose stroke (m) or swing (rad) is the purpose of the mechanism."""

    link: str
    working: Literal["auto", "forward", "backward"] = "auto"


@dataclass(frozen=True)
class Linkage:
    """A planar linkage, complete. Links are in the order of the file, the frame first."""

    links: Mapping[str, Link]
    hinges: tuple[Hinge, ...]
    slides: tuple[Slide, ...]
    driver: Driver
    sketch: Sketch
    loads: tuple[Load, ...] = ()
    gravity: complex = -9.81j
    output: Output | None = None

    @property
    def moving(self) -> tuple[str, ...]:
        """Names of the moving links, in the order of the file."""
        return tuple(name for name in self.links if name != FRAME)

    def local(self, link: str, point: str) -> complex:
        """A named point in the axes of its link, m."""
        return self.links[link].points[point]

    def slides_on_frame(self, link: str) -> bool:
        """Whether the link has a guide on the frame, or is one for it."""
        return any({s.carrier, s.runner} == {FRAME, link} for s in self.slides)

    def hinged_to_frame(self, link: str) -> bool:
        """Whether the link has a hinge on the frame."""
        return any(FRAME in h.links and link in h.links for h in self.hinges)

    def owner(self, point: str) -> str:
        """The first link that carries the point, moving links before the frame."""
        for name in (*self.moving, FRAME):
            if point in self.links[name].points:
                return name
        raise KeyError(point)


@dataclass(frozen=True)
class Request:
    """Which positions are asked for: a count over the range, or places of the driver given one by one."""

    count: int = 12
    start: float | Literal["working stroke"] = 0.0
    places: tuple[float, ...] = ()
    detail: tuple[int, ...] = ()
