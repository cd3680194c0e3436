"""Data of a linkage: links, hinges, sliding pairs, drivers, loads. SI units and radians; no input or output.

A planar vector is a complex number. Every link has its own coordinate axes, in which `points` and `centre` are given;
the pose of a link is the position of its origin and the direction of its x axis. The frame is link "0"; its axes are
the axes of the drawing. Lengths may be numbers or arrays that broadcast against (variants, positions).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

from tmm_cli.mechanics.numerics import InterpolationTable

if TYPE_CHECKING:
    from tmm_cli.mechanics.groups import CamLaw


FRAME = "0"


@dataclass(frozen=True)
class Link:
    """A rigid link: named points in its own axes (m), mass (kg), centre of mass (m), central moment of inertia (kg
    m2).
    """

    name: str
    points: Mapping[str, complex]
    mass: float = 0.0
    inertia: float = 0.0
    centre: complex = 0j
    label: str = ""


@dataclass(frozen=True)
class Hinge:
    """A revolute pair at a common point of two links, or a compound hinge of k links, which counts as k - 1 pairs.

    attached_to: the link that forms a pair with each of the others, if the file names it.
    """

    point: str
    links: tuple[str, ...]
    attached_to: str = ""


def common_hinge(hinges: Iterable[Hinge], link: str, other_link: str) -> str | None:
    """Return the point at which two links are hinged to each other, or None."""
    return next((hinge.point for hinge in hinges if {link, other_link} <= set(hinge.links)), None)


@dataclass(frozen=True)
class Slide:
    """A prismatic pair: `point` of the runner moves along a straight guide of the carrier.

    The guide passes through the point `through` in the `direction` (rad), both in the axes of the carrier. `turned` is
    the constant angle of the runner from the carrier (rad); `at` is the sliding point in the axes of the runner. ends:
    the two points of the carrier that end the guide, the run is zero at the first; None if the guide is unbounded.
    """

    name: str
    carrier: str
    runner: str
    through: complex
    direction: float
    at: complex
    turned: float = 0.0
    point: str = ""
    ends: tuple[str, str] | None = None


@dataclass(frozen=True)
class SpeedTable:
    """Squared speed of a crank (rad2/s2) against its angle, and the accelerations in its sense (rad/s2), if given.

    If the table `squares` is closed, it covers the whole cycle.
    """

    squares: InterpolationTable
    accelerations: InterpolationTable | None = None


@dataclass(frozen=True)
class Driver:
    """An input link, which rotates about its base or slides on it: q = q0 + rate t + acceleration t^2/2.

    The base is the frame (a crank, a cylinder on the frame) or a moving link (a swinging cylinder, a drive in the joint
    of an arm). The driver coordinate q is the angle of the x axis of the link from that of its base (rad), or the run
    along the guide `joint` from its `through` point (m).

    Attributes:
        sense: direction of motion, +1 or -1; `rate` >= 0 and `acceleration` are counted in this direction.
        at: driver coordinate in the sketch, for all drivers but the first.
        stroke: limits of the driver coordinate, if it has any.
        law: speed as a function of the crank angle; `rate` is then its mean.
    """

    link: str
    kind: Literal["turn", "slide"]
    joint: str
    rate: float
    acceleration: float = 0.0
    sense: int = 1
    balance: Literal["moment", "force"] = "moment"
    end: str = ""
    base: str = FRAME
    at: float = 0.0
    stroke: tuple[float, float] | None = None
    law: SpeedTable | None = None


@dataclass(frozen=True)
class Mesh:
    """A higher pair of two links on a common carrier: gear teeth, or a cam and follower defined by the law of motion.

    a is the angle of link i relative to the carrier (rad); b is that of link j, or its run in the sliding pair `slide`
    on the carrier (m). For teeth b = offset + ratio a, for a cam b = offset + law(a). Angles are accumulated through
    full turns from the sketch on; there, angles of links that are not drivers lie in -pi..pi.

    Attributes:
        pressure: angle between the tooth force and the common tangent of the pitch circles (rad).
        roller: link between cam and follower whose rotation about its own axis moves no other link (a local freedom);
            it counts in the structure, but its motion is not computed.
    """

    name: str
    kind: Literal["gear", "rack", "cam"]
    i: str
    j: str
    carrier: str
    ratio: float = 0.0
    offset: float = 0.0
    slide: str = ""
    law: CamLaw | None = None
    pressure: float = 0.0
    roller: str = ""


@dataclass(frozen=True)
class Spring:
    """A spring or damper between two links, or a cylinder that exerts a force without prescribing a motion.

    Linear: between two points, pulls with the force preload + rate (length - free) + damping (rate of lengthening), N.
    Torsional (`turns`): moment of link i on link j = -(preload + rate (angle - free) + damping omega), N m, where the
    angle is that of j relative to i, within half a turn of `free`.
    """

    name: str
    i: str
    j: str
    at_i: complex = 0j
    at_j: complex = 0j
    turns: bool = False
    rate: float = 0.0
    free: float = 0.0
    preload: float = 0.0
    damping: float = 0.0


@dataclass(frozen=True)
class Friction:
    """Coulomb friction in one pair: coefficient, and for a hinge the journal radius (m)."""

    pair: str
    coefficient: float
    radius: float = 0.0


@dataclass(frozen=True)
class LoadTable(InterpolationTable):
    """Table of the magnitude of a load.

    Attributes:
        shares: rows against the stroke are given as fractions of it, 0 to 1, instead of lengths or angles.
        stroke_link: the link whose stroke is meant; the main output if empty.
        key: key of the load that contains the table in the file.
    """

    against: Literal["stroke", "crank angle", "crank turn"] = "stroke"
    shares: bool = False
    stroke_link: str = ""
    key: str = "force"

    @property
    def first_column(self) -> str:
        """Name of the argument column, in the words of a problem file."""
        return f"share of {self.against}" if self.shares else self.against


@dataclass(frozen=True)
class Load:
    """A force and a couple on a link, with the opposite force and couple on the link `base` if that moves.

    `force` (N) acts at the point `at` (axes of the link, m) and keeps its direction in the drawing, or in the link if
    `follows`; `moment` is in N m.

    Attributes:
        table: factor for both; it varies with the stroke or the crank angle.
        resists: force and moment are magnitudes only: the force opposes the velocity of its point, the moment the
            rotation of its link, both relative to the base.
        when: "always" or "working stroke" (of the link `stroke_link`; of the main output if that is empty).
        window: crank angles between which alone the load acts (rad, counterclockwise).
    """

    name: str
    link: str
    at: complex = 0j
    force: complex = 0j
    moment: float = 0.0
    follows: bool = False
    when: str = "always"
    table: LoadTable | None = None
    point: str = ""
    window: tuple[float, float] | None = None
    resists: bool = False
    base: str = FRAME
    stroke_link: str = ""

    @property
    def working_stroke_only(self) -> bool:
        return self.when == "working stroke"


@dataclass(frozen=True)
class Sketch:
    """Approximate points and angles at one driver coordinate, which select the assembly of each group."""

    at: float
    points: Mapping[str, complex] = field(default_factory=dict)
    angles: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Output:
    """The output motion: stroke (m) or swing (rad) of a link, or of a coordinate of a point, e.g. K.x (m)."""

    link: str
    working: Literal["auto", "forward", "backward"] = "auto"


@dataclass(frozen=True)
class Linkage:
    """Complete data of a planar linkage. Links are in the order of the file, the frame first.

    keep_side: at exact change points groups stay on the side of the sketch instead of passing smoothly through. turns:
    crank turns after which the loads repeat.
    """

    links: Mapping[str, Link]
    hinges: tuple[Hinge, ...]
    slides: tuple[Slide, ...]
    driver: Driver
    sketch: Sketch
    loads: tuple[Load, ...] = ()
    gravity: complex = -9.81j
    output: Output | None = None
    others: tuple[Driver, ...] = ()
    meshes: tuple[Mesh, ...] = ()
    springs: tuple[Spring, ...] = ()
    friction: tuple[Friction, ...] = ()
    outputs: tuple[Output, ...] = ()
    keep_side: bool = False
    turns: int = 1

    @property
    def drivers(self) -> tuple[Driver, ...]:
        """All drivers; the first one defines the positions."""
        return (self.driver, *self.others)

    @property
    def cranks(self) -> tuple[Driver, ...]:
        """Drivers on the frame: their links belong to no group."""
        return tuple(d for d in self.drivers if d.base == FRAME)

    @property
    def acting(self) -> tuple[str, ...]:
        """Names of the loads and springs."""
        return (*(load.name for load in self.loads), *(spring.name for spring in self.springs))

    @property
    def by_strokes(self) -> bool:
        """True if loads depend on the strokes: they act in working strokes only, or follow a table."""
        return any(load.working_stroke_only or load.table is not None for load in self.loads)

    @property
    def stroke_links(self) -> tuple[str, ...]:
        """Links other than the main output whose strokes the loads depend on."""
        named = [load.stroke_link for load in self.loads if load.working_stroke_only]
        named += [load.table.stroke_link for load in self.loads if load.table is not None]
        return tuple(dict.fromkeys(link for link in named if link))

    def working_direction(self, output: str) -> Literal["auto", "forward", "backward"]:
        """Return the direction of the working stroke of an output, as given in the file."""
        outputs = self.outputs or ((self.output,) if self.output else ())
        return next((other.working for other in outputs if other.link == output), "auto")

    @property
    def by_speed(self) -> tuple[str, ...] | None:
        """Keys of the first force that depends on the speed of the mechanism (dampers; friction through the reactions),
        or None.
        """
        damped = next((spring.name for spring in self.springs if spring.damping), None)
        if damped is not None:
            return ("springs", damped, "damping")
        return ("friction",) if self.friction else None

    def slide(self, name: str) -> Slide:
        """Return the sliding pair with this name."""
        return next(s for s in self.slides if s.name == name)

    def shared(self, link: str, other_link: str) -> str | None:
        """Return the point at which two links are hinged to each other, or None."""
        return common_hinge(self.hinges, link, other_link)

    @property
    def moving(self) -> tuple[str, ...]:
        """Names of the moving links, in the order of the file."""
        return tuple(name for name in self.links if name != FRAME)

    @property
    def moving_points(self) -> tuple[str, ...]:
        """Names of the points that move, each once."""
        points = dict.fromkeys(point for link in self.moving for point in self.links[link].points)
        return tuple(point for point in points if point not in self.links[FRAME].points)

    def local(self, link: str, point: str) -> complex:
        """Return a named point in the axes of its link, m."""
        return self.links[link].points[point]

    def slides_on_frame(self, link: str) -> bool:
        """Return True if the link forms a prismatic pair with the frame."""
        return any({s.carrier, s.runner} == {FRAME, link} for s in self.slides)

    def hinged_to_frame(self, link: str) -> bool:
        """Return True if the link forms a revolute pair with the frame."""
        return any(FRAME in h.links and link in h.links for h in self.hinges)

    def output_point(self, output: str) -> str | None:
        """Return the point of an output such as K.x; None if the output is a link."""
        return None if output in self.links else output.rpartition(".")[0]

    def output_guide(self, output: str) -> Slide | None:
        """Return the prismatic pair of an output link: with the frame, or of a sliding block on a moving link; None if
        there is none.
        """
        on_frame = next((s for s in self.slides if {s.carrier, s.runner} == {FRAME, output}), None)
        if on_frame is not None or self.hinged_to_frame(output):
            return on_frame
        return next((s for s in self.slides if s.runner == output), None)

    def output_carrier(self, output: str) -> str:
        """Return the link of an output: the link itself, or the one that owns the point."""
        point = self.output_point(output)
        return output if point is None else self.owner(point)

    def output_swings(self, output: str) -> bool:
        """Return True if the output is the angle of a link (rad), False if it is a length (m)."""
        return output in self.links and self.output_guide(output) is None

    def output_arm(self, output: str) -> tuple[str, float] | None:
        """Return a point of an output link that swings about the frame, and its distance from the pivot (m), or
        None.
        """
        pivot = self.shared(FRAME, output) if output in self.links else None
        if pivot is None or not self.output_swings(output):
            return None
        link = self.links[output]
        point = next((name for name in link.points if name != pivot), None)
        return None if point is None else (point, abs(link.points[point] - link.points[pivot]))

    def carriers(self, point: str) -> tuple[str, ...]:
        """Return all links that own the point, moving links before the frame."""
        return tuple(name for name in (*self.moving, FRAME) if point in self.links[name].points)

    def owner(self, point: str) -> str:
        """Return the first link that owns the point, moving links before the frame. Raises KeyError if there is
        none.
        """
        for name in (*self.moving, FRAME):
            if point in self.links[name].points:
                return name
        raise KeyError(point)


@dataclass(frozen=True)
class Request:
    """Requested positions: a count over the range, or individual driver coordinates.

    centres: True if the instantaneous centres are requested for the positions in detail.
    """

    count: int = 12
    start: float | Literal["working stroke"] = 0.0
    places: tuple[float, ...] = ()
    detail: tuple[int, ...] = ()
    centres: bool = False
