"""The numbers of a linkage: links, hinges, slides, driver, loads. SI and radians; no input or output.

A planar vector is a complex number. Every link has axes of its own: `points` and `centre` are given in them, and
the pose of a link is the place of its origin and the direction of its x axis. The frame is link "0"; its axes are
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
    """A rigid link: named points in its own axes (m), mass (kg), centre of mass (m), inertia about it (kg m2)."""

    name: str
    points: Mapping[str, complex]
    mass: float = 0.0
    inertia: float = 0.0
    centre: complex = 0j
    label: str = ""


@dataclass(frozen=True)
class Hinge:
    """A revolute pair at a named point of two links, or a compound hinge of more: k links make k - 1 pairs.

    attached_to: the link with which each of the others makes one of these pairs, if the file names it.
    """

    point: str
    links: tuple[str, ...]
    attached_to: str = ""


def common_hinge(hinges: Iterable[Hinge], one: str, other: str) -> str | None:
    """The point in which two links are hinged to one another."""
    return next((hinge.point for hinge in hinges if {one, other} <= set(hinge.links)), None)


@dataclass(frozen=True)
class Slide:
    """A sliding pair: `point` of the runner moves on a straight guide of the carrier.

    The guide passes through `through` in the `direction` (rad), both in the carrier's axes. The runner's axes are
    turned by `turned` (rad) from the carrier's, always. `at` is the running point in the runner's axes. ends: the
    points of the carrier between which the guide is, the first one where its run is zero; None: it goes on.
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
    """Squares of a crank's speed (rad2/s2) by its angle, and its accelerations in its sense (rad/s2) if they are given.

    Where `squares` close, they go round the whole cycle.
    """

    squares: InterpolationTable
    accelerations: InterpolationTable | None = None


@dataclass(frozen=True)
class Driver:
    """An input: a link that turns about its base, or slides on it, by q = q0 + rate t + acceleration t^2/2.

    The base is the frame (a crank, a cylinder on the frame) or a moving link (a cylinder that swings, a drive in the
    hinge of an arm). q is the angle of the link's x axis from the base's (rad), or the run along the guide `joint` from
    its `through` point (m). `sense` is +1 or -1, and `rate` >= 0 is counted in that sense; `acceleration` too
    (negative: it slows down). `at` is its place in the sketch, for drivers beside the first; `stroke`: between which
    places it works, if it cannot go farther. law: its speed by its angle; `rate` is then the mean of it.
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
    """A higher pair of two links on a common carrier: teeth in mesh, or a cam and its follower given by their law.

    a is the angle of link i from the carrier's axes (rad); b that of link j, or its run in the sliding pair `slide` on
    the carrier (m). Then b = offset + ratio a, or for a cam b = offset + law(a). Angles are followed through full turns
    from the sketch on, where those of links that are not driven lie within -pi..pi. pressure: angle between the force
    of the teeth and the common tangent of the pitch circles (rad). roller: the link between cam and follower whose turn
    about its own axis moves nothing else (a local freedom); it is counted in the structure, and has no motion here.
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
    """A spring between two links, or a cylinder that only pushes.

    Linear: between two points, it pulls with force = preload + rate (length - free) + damping (speed of lengthening),
    N. Torsion (`turns`): from link i on link j, moment = -(preload + rate (angle - free) + damping omega), N m, where
    the angle is that of j from i, within half a turn of `free`.
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
    """Coulomb friction in one pair: its coefficient, and for a hinge the radius of its journal (m)."""

    pair: str
    coefficient: float
    radius: float = 0.0


@dataclass(frozen=True)
class LoadTable(InterpolationTable):
    """A load's size, tabulated.

    shares: its rows against the stroke are shares of it, 0 to 1, not lengths or angles. stroke_link: the link whose
    stroke it is; the main output if empty. key: the key of the load under which the file gives the table.
    """

    against: Literal["stroke", "crank angle", "crank turn"] = "stroke"
    shares: bool = False
    stroke_link: str = ""
    key: str = "force"

    @property
    def first_column(self) -> str:
        """What its first column is, in the words of a file."""
        return f"share of {self.against}" if self.shares else self.against


@dataclass(frozen=True)
class Load:
    """A force and a couple on a link, and their opposites on the link `base`, if that moves.

    `force` (N) acts at `at` (the link's axes, m) and keeps its direction in the drawing, or in the link when
    `follows`; `moment` in N m. With a table, both are multiplied by its value. When it `resists`, both are sizes only:
    the force opposes the motion of its point, the moment the turning of its link, as the base sees them. when:
    "always", "working stroke", which is that of the link `stroke_link`, or of the main output if that is empty;
    window: and only from one angle of the crank to another (rad, counterclockwise).
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
    """How the linkage looks at one place of its driver: which way round each group is assembled."""

    at: float
    points: Mapping[str, complex] = field(default_factory=dict)
    angles: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Output:
    """What the mechanism is for: the stroke (m) or swing (rad) of a link, or a coordinate of a point, K.x (m)."""

    link: str
    working: Literal["auto", "forward", "backward"] = "auto"


@dataclass(frozen=True)
class Linkage:
    """A planar linkage, complete. Links are in the order of the file, the frame first.

    keep_side: in exact change points groups keep to the side of the sketch, instead of going smoothly through. turns:
    of the crank, after which its loads come again.
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
        """All drivers; the first one counts the positions."""
        return (self.driver, *self.others)

    @property
    def cranks(self) -> tuple[Driver, ...]:
        """Drivers that stand on the frame: their links need no group."""
        return tuple(d for d in self.drivers if d.base == FRAME)

    @property
    def acting(self) -> tuple[str, ...]:
        """Names of the loads and springs."""
        return (*(load.name for load in self.loads), *(spring.name for spring in self.springs))

    @property
    def by_strokes(self) -> bool:
        """Whether loads may hang on the strokes: they act in working ones only, or by a table."""
        return any(load.working_stroke_only or load.table is not None for load in self.loads)

    @property
    def stroke_links(self) -> tuple[str, ...]:
        """Links besides the main output whose strokes loads depend on."""
        named = [load.stroke_link for load in self.loads if load.working_stroke_only]
        named += [load.table.stroke_link for load in self.loads if load.table is not None]
        return tuple(dict.fromkeys(link for link in named if link))

    def working_direction(self, output: str) -> Literal["auto", "forward", "backward"]:
        """The direction of the working stroke of an output, as the file says it."""
        every = self.outputs or ((self.output,) if self.output else ())
        return next((other.working for other in every if other.link == output), "auto")

    @property
    def by_speed(self) -> tuple[str, ...] | None:
        """The first thing, by its keys in a file, whose force hangs on how fast the mechanism runs; friction does by
        the reactions."""
        damped = next((spring.name for spring in self.springs if spring.damping), None)
        if damped is not None:
            return ("springs", damped, "damping")
        return ("friction",) if self.friction else None

    def slide(self, name: str) -> Slide:
        """A sliding pair by its name."""
        return next(s for s in self.slides if s.name == name)

    def shared(self, one: str, other: str) -> str | None:
        """The point in which two links are hinged to one another."""
        return common_hinge(self.hinges, one, other)

    @property
    def moving(self) -> tuple[str, ...]:
        """Names of the moving links, in the order of the file."""
        return tuple(name for name in self.links if name != FRAME)

    @property
    def moving_points(self) -> tuple[str, ...]:
        """Named points that move, once each."""
        every = dict.fromkeys(point for link in self.moving for point in self.links[link].points)
        return tuple(point for point in every if point not in self.links[FRAME].points)

    def local(self, link: str, point: str) -> complex:
        """A named point in the axes of its link, m."""
        return self.links[link].points[point]

    def slides_on_frame(self, link: str) -> bool:
        """Whether the link has a guide on the frame, or is one for it."""
        return any({s.carrier, s.runner} == {FRAME, link} for s in self.slides)

    def hinged_to_frame(self, link: str) -> bool:
        """Whether the link has a hinge on the frame."""
        return any(FRAME in h.links and link in h.links for h in self.hinges)

    def output_point(self, output: str) -> str | None:
        """The point of an output that is one of its coordinates; None of a link."""
        return None if output in self.links else output.rpartition(".")[0]

    def output_guide(self, output: str) -> Slide | None:
        """The sliding pair in which an output runs: on the frame, or of a stone on a moving link."""
        on_frame = next((s for s in self.slides if {s.carrier, s.runner} == {FRAME, output}), None)
        if on_frame is not None or self.hinged_to_frame(output):
            return on_frame
        return next((s for s in self.slides if s.runner == output), None)

    def output_carrier(self, output: str) -> str:
        """The link that an output belongs to."""
        point = self.output_point(output)
        return output if point is None else self.owner(point)

    def output_swings(self, output: str) -> bool:
        """Whether an output is the angle of a link (rad), and no length (m)."""
        return output in self.links and self.output_guide(output) is None

    def output_arm(self, output: str) -> tuple[str, float] | None:
        """The first other point of an output that swings about the frame, and its distance from the pivot (m)."""
        pivot = self.shared(FRAME, output) if output in self.links else None
        if pivot is None or not self.output_swings(output):
            return None
        link = self.links[output]
        point = next((name for name in link.points if name != pivot), None)
        return None if point is None else (point, abs(link.points[point] - link.points[pivot]))

    def carriers(self, point: str) -> tuple[str, ...]:
        """All links that have the point, moving links before the frame."""
        return tuple(name for name in (*self.moving, FRAME) if point in self.links[name].points)

    def owner(self, point: str) -> str:
        """The first link that carries the point, moving links before the frame."""
        for name in (*self.moving, FRAME):
            if point in self.links[name].points:
                return name
        raise KeyError(point)


@dataclass(frozen=True)
class Request:
    """Which positions are asked for: a count over the range, or places of the driver given one by one.

    centres: with the instantaneous centres of those in detail.
    """

    count: int = 12
    start: float | Literal["working stroke"] = 0.0
    places: tuple[float, ...] = ()
    detail: tuple[int, ...] = ()
    centres: bool = False
