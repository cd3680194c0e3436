"""The shape of a problem file, for pydantic: what keys there are and what may stand in them.

Only shape is checked here; numbers with units, names of points and guides and the rest of the sense are checked where
the file is built into a linkage (build), which knows the parameters and units. The field descriptions are what
`tmm schema` prints.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field

from tmm_cli.problem.schema_balancing import Balancing
from tmm_cli.problem.schema_dynamics import Dynamics
from tmm_cli.problem.schema_intermittent import Wheels
from tmm_cli.problem.schema_loads import Load, Mass
from tmm_cli.problem.schema_meshes import Cam, Gear, Rack
from tmm_cli.problem.schema_parts import (
    MAX_LINKS,
    MAX_POSITIONS,
    FileHead,
    Name,
    Place,
    Strict,
    Value,
    Vector,
    checked_name,
    checked_value,
)  # fmt: skip
from tmm_cli.problem.schema_sheet import NoteStyle, SheetTexts
from tmm_cli.problem.schema_shown import Shows
from tmm_cli.problem.schema_springs import Friction, Spring


class Guide(Strict):
    """A straight guide on the frame or on a link."""

    on: Name = Field(default="0", description="the link that carries it; the frame when left out")
    through: Place | None = Field(default=None, description="a point of that link, or [x, y] in its axes")
    angle: Value | None = Field(default=None, description="direction, from the x axis of that link")
    along: Name | None = Field(default=None, description="instead of through and angle: two points, CD")
    offset: Value = Field(default=0, description="distance of the guide to the left of that line")
    unbounded: bool = Field(default=False, description="on a moving link: it goes on beyond the points of `along`")


class Slide(Strict):
    """A sliding pair of this link."""

    on: Name = Field(description="a guide's name, or the link that it slides on")
    along: Name | None = Field(default=None, description="two points of that link: the guide runs from C to D")
    through: Place | None = Field(default=None, description="a point of that link on the guide, or [x, y] in its axes")
    angle: Value | None = Field(default=None, description="direction of the guide, from the x axis of that link")
    offset: Value = Field(default=0, description="distance of the guide to the left of that line")
    point: Name | None = Field(default=None, description="the point of this link that runs on the guide; its first")
    turned: Value = Field(default=0, description="angle of this link's axes from those of the link it slides on")
    unbounded: bool = Field(default=False, description="the guide goes on beyond the points of `along`")


def _on(found: Any) -> Any:
    return {"on": found} if isinstance(found, str | int) and not isinstance(found, bool) else found


OneSlide = Annotated[Slide, BeforeValidator(_on, json_schema_input_type=Slide | Name)]


class Link(Strict):
    """A moving link. Its axes: origin in its first point, x towards the second; or as coordinates say."""

    name: str | None = Field(default=None, max_length=60, description="what the link is called in reports")
    points: list[Name] | dict[Name, Vector] = Field(description="names of its points, or their coordinates in its axes")
    length: Value | None = Field(default=None, description="distance of two points")
    also: dict[Name, Place] = Field(default_factory=dict, description="further points, in its axes")
    slides: OneSlide | list[OneSlide] | None = Field(
        default=None, description="what it slides on: a guide, or {on, along}, or several of them in a list"
    )

    @property
    def sliding(self) -> list[Slide]:
        """Its sliding pairs, of which the file may give one without a list."""
        return self.slides if isinstance(self.slides, list) else [self.slides] if self.slides else []


class Speeds(Strict):
    """A crank's speed, or its acceleration, by its angle."""

    against: Literal["crank angle"] = Field(description="crank angle: from the x axis, counterclockwise")
    table: list[Vector] = Field(min_length=2, max_length=10_000, description="rows [angle, size]")
    between: Literal["smooth", "linear"] = Field(
        default="smooth", description="rows: a cubic spline, or lines; of squares of speeds"
    )


class CompoundHinge(Strict):
    """A hinge of three links or more."""

    attached_to: Name = Field(
        alias="attached to", description="the link with which each of the others makes a pair; 0 is the frame"
    )


def _by_angle(found: Any) -> Any:
    return Speeds.model_validate(found) if isinstance(found, dict) else checked_value(found)


class Driver(Strict):
    """An input: a crank, or a slider that is driven (cylinder), on the frame or on a moving link."""

    link: Name
    on: Name = Field(default="0", description="the link that it is driven from: the frame, or the cylinder of a piston")
    at: Value | None = Field(default=None, description="its place in the sketch, for drivers after the first")
    speed: Annotated[Value | Speeds, BeforeValidator(_by_angle)] = Field(
        description="of rotation (82 rpm, 8 rad/s) or of sliding (0.2 m/s); of a crank {against, table} too"
    )
    acceleration: Annotated[Value | Speeds, BeforeValidator(_by_angle)] = Field(
        default=0, description="in the sense of motion; the speed is that of position 0; beside a table: one too"
    )
    stroke: Vector | None = Field(default=None, description="[from, to]: places between which a cylinder works")
    turns: Literal["ccw", "cw"] = Field(default="ccw", description="sense of rotation")
    balance: Literal["moment", "force"] = Field(default="moment", description="what balances the crank")
    end: Name | None = Field(default=None, description="the crank's point where the balancing force acts")


class Output(Strict):
    """The link whose stroke or swing is the purpose of the mechanism, or a point of a moving link: its x and y."""

    link: Name = Field(
        description="of a link joined to the frame its stroke or swing, of a coupler its angle, of a stone its place "
        "along the slot"
    )
    working: Literal["auto", "forward", "backward"] = Field(
        default="auto", description="direction of the working stroke; auto: the slower one"
    )


def _outputs(found: Any) -> list[Output]:
    several = found if isinstance(found, list) else [found]
    return [Output.model_validate(one if isinstance(one, dict) else {"link": checked_name(one)}) for one in several]


def _listed(found: Any) -> Any:
    return [found] if isinstance(found, str | int | float) else found


class Positions(Strict):
    """Which positions are computed. They are numbered from 0 in the driver's sense."""

    count: int = Field(default=12, ge=1, le=MAX_POSITIONS)
    from_: Value | None = Field(
        default=None, alias="from", description="place of position 0: an angle, or `working stroke`"
    )
    at: Annotated[list[Value] | None, BeforeValidator(_listed, json_schema_input_type=list[Value] | Value | None)] = (
        Field(default=None, max_length=MAX_POSITIONS, description="places one by one, instead")
    )
    detail: Annotated[list[int], BeforeValidator(_listed, json_schema_input_type=list[int] | int)] = Field(
        default_factory=list, max_length=24, description="numbers of positions drawn in detail"
    )
    centres: bool = Field(default=False, description="instantaneous centres in the positions in detail")


class Checks(Strict):
    """Limits above which a run says so and ends with exit code 1."""

    lever: Value = Field(default="5 %", description="difference of the Zhukovsky lever from the force plan")
    pressure_sliding: Value | None = Field(default=None, description="largest pressure angle on a sliding link; 30 deg")
    pressure_turning: Value | None = Field(default=None, description="largest pressure angle on a turning link; 45 deg")


class File(FileHead):
    """A problem of planar lever mechanisms."""

    reference: str = Field(default="", max_length=100, description="of the mechanism, in a book or a list: M7, Fig. 7")
    shows: Shows = Field(default={}, description="properties as numbers: {swing: {of: psi, expected: 2*a}}")
    units: dict[str, str] = Field(default_factory=dict, description="what bare numbers mean: {length: mm, angle: deg}")
    parameters: dict[Name, Value] = Field(default_factory=dict, max_length=500)
    synthesis: Any = Field(default=None, description="a task whose answer becomes parameters: {task: ...}")
    variants: Any = Field(default=None, description="what is free in a task for a group: {OA: {from, to, step}}")
    grading: Any = Field(default=None, description="what students are asked, and how it is marked: {answers: [...]}")
    points: dict[Name, Vector] = Field(default_factory=dict, max_length=500, description="of the frame")
    guides: dict[Name, Guide] = Field(default_factory=dict, max_length=200)
    links: dict[Name, Link] = Field(min_length=1, max_length=MAX_LINKS)
    hinges: dict[Name, CompoundHinge] = Field(
        default_factory=dict, max_length=100, description="compound hinges that are not counted in the usual way"
    )
    driver: Driver | list[Driver] = Field(description="the input; several as a list, when W > 1")
    gears: dict[Name, Gear] = Field(default_factory=dict, max_length=100)
    racks: dict[Name, Rack] = Field(default_factory=dict, max_length=100)
    cams: dict[Name, Cam] = Field(default_factory=dict, max_length=100)
    springs: dict[Name, Spring] = Field(default_factory=dict, max_length=100)
    friction: Friction | None = None
    sketch: dict[Name, Any] = Field(
        default_factory=dict,
        description="how it looks at one place of the driver: at, points [x, y] and angles of links, roughly",
    )
    change_points: Literal["smooth", "keep side"] = Field(
        default="smooth",
        alias="change points",
        description="how a parallelogram and its like pass the positions in which they could go over into another "
        "assembly: smoothly, or always on the side of the sketch",
    )
    masses: dict[Name, Mass] = Field(default_factory=dict)
    loads: dict[Name, Load] = Field(default_factory=dict, max_length=200)
    gravity: Any = Field(default=None, description="[x, y], or one number downwards; 9.81 m/s^2 when left out")
    output: Annotated[Name | Output | list[Name | Output], BeforeValidator(_outputs)] = Field(
        default=[], max_length=20, description="a link or a point, or {link, working}, or several of them in a list"
    )
    cycle: Value | None = Field(
        default=None, description="turns of the crank after which its loads come again: 2 turns of a four-stroke engine"
    )
    intermittent: Wheels = Field(default={}, description="wheels that a link takes along on some strokes only")
    positions: Positions = Field(default_factory=Positions)
    checks: Checks = Field(default_factory=Checks)
    dynamics: Dynamics | None = Field(default=None, description="law of motion: motor, flywheel")
    balancing: Balancing | None = Field(default=None, description="what shakes the frame, and counterweights")
    sheet: SheetTexts = Field(default_factory=SheetTexts, description="texts of the title block of `tmm sheets`")
    frame: Name = Field(default="0", description="the number of the frame that is printed: R_65 for R_05 where it is 6")
    note: NoteStyle = Field(default_factory=NoteStyle, description="how the note and its drawings are written")
