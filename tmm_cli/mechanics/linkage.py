"""Data of a linkage: links, hinges, prismatic pairs, drivers, loads. SI units and radians; no input or output.

A planar vector is a complex number. Every link has its own axes, in which its `points` and `centre` are given; the pose
of a link is the position of its origin and the direction of its x axis. The frame is link "0", and its axes are the
axes of the drawing. Lengths may be numbers, or arrays that broadcast against (variants, positions).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

from tmm_cli.mechanics.numerics import InterpolationTable

if TYPE_CHECKING:
    from tmm_cli.mechanics.elements.element import LoadElement
    from tmm_cli.mechanics.groups import CamLaw


FRAME = "0"


@dataclass(frozen=True)
class Link:
    """A rigid link.

    Attributes:
        name: name of the link.
        points: named points in the axes of the link (m).
        mass: mass (kg).
        inertia: moment of inertia about the centre of mass (kg m2).
        centre: centre of mass in the axes of the link (m).
        label: description for tables and messages, e.g. "crank"; may be empty.
    """

    name: str
    points: Mapping[str, complex]
    mass: float = 0.0
    inertia: float = 0.0
    centre: complex = 0j
    label: str = ""


@dataclass(frozen=True)
class Hinge:
    """A revolute pair of two links, or a compound hinge of k links, which counts as k - 1 pairs.

    Attributes:
        point: name of the common point.
        links: names of the links.
        attached_to: in a compound hinge, the link that forms a pair with each of the other links; empty unless the file
            names it.
    """

    point: str
    links: tuple[str, ...]
    attached_to: str = ""


def common_hinge(hinges: Iterable[Hinge], link: str, other_link: str) -> str | None:
    """Return the name of the point at which two links are hinged to each other, or None."""
    return next((hinge.point for hinge in hinges if {link, other_link} <= set(hinge.links)), None)


@dataclass(frozen=True)
class Slide:
    """A prismatic pair: a point of one link, the runner, slides along a straight guide of another link, the carrier.

    Attributes:
        name: name of the pair.
        carrier: name of the link with the guide.
        runner: name of the sliding link.
        through: a point of the guide, in the axes of the carrier (m).
        direction: direction of the guide, in the axes of the carrier (rad).
        at: sliding point, in the axes of the runner (m).
        turned: constant angle of the runner relative to the carrier (rad).
        point: name of the sliding point.
        ends: names of the two points of the carrier at which the guide ends; the displacement is zero at the first.
            None if the guide is unlimited.
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
    """Speed of a crank given by a table.

    Attributes:
        squares: squared speed (rad2/s2) against the crank angle (rad); covers the whole cycle if the table is closed.
        accelerations: acceleration in the sense of rotation (rad/s2) against the crank angle; None if not given.
    """

    squares: InterpolationTable
    accelerations: InterpolationTable | None = None


@dataclass(frozen=True)
class Driver:
    """An input link, which rotates about its base or slides along it: q = q0 + rate t + acceleration t^2/2.

    The base is the frame (a crank, a cylinder on the frame) or a moving link (a swinging cylinder, a drive in the joint
    of an arm). The driver coordinate q is the angle of the link relative to its base (rad), or the displacement along
    the guide from its point `through` (m).

    Attributes:
        link: name of the link.
        kind: "turn" or "slide".
        joint: name of the hinge or of the prismatic pair that is driven.
        rate: initial speed (rad/s or m/s), not negative.
        acceleration: acceleration in the sense of motion (rad/s2 or m/s2).
        sense: sense of motion, +1 or -1.
        balance: whether a moment or a force on the crank balances the loads.
        end: name of the point of the crank at which the balancing force acts.
        base: name of the link relative to which it moves.
        at: driver coordinate in the sketch; not used for the first driver.
        stroke: limits of the driver coordinate, or None.
        law: speed as a function of the crank angle, or None; `rate` is then the mean speed.
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
    """A higher pair of two links on a common carrier: gear teeth, or a cam and follower defined by a law of motion.

    Let a be the angle of link i relative to the carrier (rad), and b that of link j, or its displacement in the
    prismatic pair `slide` on the carrier (m). For teeth b = offset + ratio a, for a cam b = offset + law(a). Angles are
    accumulated through full turns, starting at the sketch; there, angles of links that are not drivers lie in -pi..pi.

    Attributes:
        name: name of the pair.
        kind: "gear", "rack" or "cam".
        i, j: names of the links; i is a gear or the cam, j a gear, the rack or the follower.
        carrier: name of the link that carries both.
        ratio, offset, law: constants and law of the equations above (rad, or m for b as a displacement).
        slide: name of the prismatic pair of j on the carrier; empty if j rotates.
        pressure: angle between the tooth force and the common tangent of the pitch circles (rad).
        roller: name of a roller between cam and follower, or empty. Its rotation about its own axis moves no other link
            (a local freedom). It counts in the structure, but its motion is not computed.
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
class Friction:
    """Coulomb friction in one pair.

    Attributes:
        pair: name of the pair.
        coefficient: coefficient of friction.
        radius: radius of the journal of a hinge (m).
    """

    pair: str
    coefficient: float
    radius: float = 0.0


@dataclass(frozen=True)
class LoadTable(InterpolationTable):
    """A load given by a table.

    Attributes:
        against: argument of the table: stroke of an output, or crank angle.
        shares: True if strokes are given as fractions 0 to 1 instead of lengths or angles.
        stroke_link: output whose stroke is the argument; empty for the main output.
        key: key of the load under which the file contains the table.
    """

    against: Literal["stroke", "crank angle", "crank turn"] = "stroke"
    shares: bool = False
    stroke_link: str = ""
    key: str = "force"

    @property
    def first_column(self) -> str:
        """Name of the column of arguments, in the words of a problem file."""
        return f"share of {self.against}" if self.shares else self.against


@dataclass(frozen=True)
class Load:
    """A force and a couple on a link. If `base` is a moving link, the opposite force and couple act on it.

    Attributes:
        name: name of the load.
        link: name of the loaded link.
        at: point at which the force acts, in the axes of the link (m).
        force: force (N), in the axes of the drawing, or of the link if `follows` is set.
        moment: moment of the couple (N m).
        follows: True if the force keeps its direction relative to the link, False if it keeps it in the drawing.
        when: "always" or "working stroke".
        table: factor of force and moment that varies with the stroke or the crank angle, or None.
        point: name of the point at which the force acts; may be empty.
        window: crank angles between which alone the load acts (rad, counterclockwise), or None.
        resists: True if only magnitudes are given: the force opposes the velocity of its point, the moment the rotation
            of its link, both relative to the base.
        base: name of the link on which the reaction of the load acts.
        stroke_link: output whose working stroke is meant; empty for the main output.
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
    """An approximate position of the linkage, which selects the assembly of each group.

    Attributes:
        at: driver coordinate (rad or m).
        points: approximate positions of points (m), by name.
        angles: approximate angles of links (rad), by name.
    """

    at: float
    points: Mapping[str, complex] = field(default_factory=dict)
    angles: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Output:
    """An output of the mechanism.

    Attributes:
        link: name of a link, or coordinate of a point, e.g. K.x.
        working: direction of the working stroke; "auto": the slower stroke.
    """

    link: str
    working: Literal["auto", "forward", "backward"] = "auto"


@dataclass(frozen=True)
class Linkage:
    """Complete data of a planar linkage.

    Attributes:
        links: links by name, in the order of the file, the frame first.
        hinges: revolute pairs and compound hinges.
        slides: prismatic pairs.
        driver: the first driver, which defines the positions.
        sketch: approximate position that selects the assemblies.
        loads: loads.
        gravity: acceleration of gravity, a vector (m/s2).
        output: the main output, or None.
        others: further drivers.
        meshes: higher pairs.
        elements: load elements, such as springs, in the order of their blocks and of the file.
        friction: friction in pairs.
        outputs: all outputs that the file names.
        keep_side: True if groups stay on the side of the sketch at exact change points, instead of passing smoothly.
        turns: crank turns after which the loads repeat.
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
    elements: tuple[LoadElement, ...] = ()
    friction: tuple[Friction, ...] = ()
    outputs: tuple[Output, ...] = ()
    keep_side: bool = False
    turns: int = 1

    @property
    def drivers(self) -> tuple[Driver, ...]:
        """All drivers. The first one defines the positions."""
        return (self.driver, *self.others)

    @property
    def cranks(self) -> tuple[Driver, ...]:
        """Drivers on the frame. Their links belong to no Assur group."""
        return tuple(d for d in self.drivers if d.base == FRAME)

    @property
    def acting(self) -> tuple[str, ...]:
        """Names of all loads and load elements."""
        return (*(load.name for load in self.loads), *(element.name for element in self.elements))

    @property
    def elements_by_block(self) -> Mapping[str, tuple[LoadElement, ...]]:
        """Load elements of each kind, by the block of the file that lists them."""
        blocks: dict[str, tuple[LoadElement, ...]] = {}
        for element in self.elements:
            blocks[element.block] = (*blocks.get(element.block, ()), element)
        return blocks

    @property
    def by_strokes(self) -> bool:
        """True if a load acts in working strokes only, or is given by a table."""
        return any(load.working_stroke_only or load.table is not None for load in self.loads)

    @property
    def stroke_links(self) -> tuple[str, ...]:
        """Links, other than the main output, on whose strokes loads depend."""
        named = [load.stroke_link for load in self.loads if load.working_stroke_only]
        named += [load.table.stroke_link for load in self.loads if load.table is not None]
        return tuple(dict.fromkeys(link for link in named if link))

    def working_direction(self, output: str) -> Literal["auto", "forward", "backward"]:
        """Return the direction of the working stroke of an output, as the file gives it; "auto" if it does not."""
        outputs = self.outputs or ((self.output,) if self.output else ())
        return next((other.working for other in outputs if other.link == output), "auto")

    @property
    def by_speed(self) -> tuple[str, ...] | None:
        """Path in the file of the first force that depends on the speed of the mechanism, or None.

        Such forces are those of dampers, and friction, which depends on the reactions.
        """
        for element in self.elements:
            if element.speed_key is not None:
                return tuple(key for key in (element.block, element.name, element.speed_key) if key)
        return ("friction",) if self.friction else None

    def slide(self, name: str) -> Slide:
        """Return the prismatic pair with this name."""
        return next(s for s in self.slides if s.name == name)

    def shared(self, link: str, other_link: str) -> str | None:
        """Return the name of the point at which two links are hinged to each other, or None."""
        return common_hinge(self.hinges, link, other_link)

    @property
    def moving(self) -> tuple[str, ...]:
        """Names of the moving links, in the order of the file."""
        return tuple(name for name in self.links if name != FRAME)

    @property
    def moving_points(self) -> tuple[str, ...]:
        """Names of the points that do not belong to the frame."""
        points = dict.fromkeys(point for link in self.moving for point in self.links[link].points)
        return tuple(point for point in points if point not in self.links[FRAME].points)

    def local(self, link: str, point: str) -> complex:
        """Return the position of a named point in the axes of a link, m."""
        return self.links[link].points[point]

    def slides_on_frame(self, link: str) -> bool:
        """Return True if the link forms a prismatic pair with the frame."""
        return any({s.carrier, s.runner} == {FRAME, link} for s in self.slides)

    def hinged_to_frame(self, link: str) -> bool:
        """Return True if the link forms a revolute pair with the frame."""
        return any(FRAME in h.links and link in h.links for h in self.hinges)

    def output_point(self, output: str) -> str | None:
        """Return the name of the point of an output such as K.x; None if the output is a link."""
        return None if output in self.links else output.rpartition(".")[0]

    def output_guide(self, output: str) -> Slide | None:
        """Return the prismatic pair in which an output link slides; None if it does not slide.

        It is the pair with the frame, or that of a sliding block on a moving link.
        """
        on_frame = next((s for s in self.slides if {s.carrier, s.runner} == {FRAME, output}), None)
        if on_frame is not None or self.hinged_to_frame(output):
            return on_frame
        return next((s for s in self.slides if s.runner == output), None)

    def output_carrier(self, output: str) -> str:
        """Return the link of an output: the output itself, or the link that has its point."""
        point = self.output_point(output)
        return output if point is None else self.owner(point)

    def output_swings(self, output: str) -> bool:
        """Return True if the output is the angle of a link (rad), False if it is a displacement (m)."""
        return output in self.links and self.output_guide(output) is None

    def output_arm(self, output: str) -> tuple[str, float] | None:
        """Return a point of an output link that rotates about the frame, and its distance from the pivot (m).

        None if the output does not rotate about the frame, or has no other point.
        """
        pivot = self.shared(FRAME, output) if output in self.links else None
        if pivot is None or not self.output_swings(output):
            return None
        link = self.links[output]
        point = next((name for name in link.points if name != pivot), None)
        return None if point is None else (point, abs(link.points[point] - link.points[pivot]))

    def carriers(self, point: str) -> tuple[str, ...]:
        """Return the names of all links that have this point, moving links before the frame."""
        return tuple(name for name in (*self.moving, FRAME) if point in self.links[name].points)

    def owner(self, point: str) -> str:
        """Return the name of the first link that has this point, moving links before the frame.

        Raises:
            KeyError: no link has the point.
        """
        for name in (*self.moving, FRAME):
            if point in self.links[name].points:
                return name
        raise KeyError(point)


@dataclass(frozen=True)
class Request:
    """Requested positions of the driver.

    Attributes:
        count: number of positions, evenly spaced over the range of the driver.
        start: driver coordinate of the first position (rad), or the beginning of the working stroke.
        places: driver coordinates (rad or m) of the positions, if the file lists them; `count` and `start` are then not
            used.
        detail: numbers of the positions to be drawn in detail.
        centres: True if instantaneous centres are requested for the positions in detail.
    """

    count: int = 12
    start: float | Literal["working stroke"] = 0.0
    places: tuple[float, ...] = ()
    detail: tuple[int, ...] = ()
    centres: bool = False
