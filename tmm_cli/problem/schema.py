"""Keys of a problem file as pydantic models, with the descriptions that `tmm schema` prints.

The models check only the structure of a file. Numbers with units and the names of points and guides are checked by
`build`, which knows the parameters and units.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, Field
from pydantic.json_schema import GenerateJsonSchema

from tmm_cli.problem.blocks.dampers import DamperKeys
from tmm_cli.problem.blocks.friction import FrictionKeys
from tmm_cli.problem.blocks.loads import LoadKeys
from tmm_cli.problem.blocks.masses import MassKeys
from tmm_cli.problem.blocks.meshes import CamKeys, GearKeys, RackKeys
from tmm_cli.problem.blocks.optional_keys import BalancingKeys, DynamicsKeys, Wheels
from tmm_cli.problem.blocks.sheet_keys import NoteStyle, SheetTexts
from tmm_cli.problem.blocks.springs import SpringKeys
from tmm_cli.problem.schema_types import (
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
)

# Block `shows`: properties of a mechanism as numbers, with their expected values.


Number = Annotated[int, Field(ge=0)]
Quantity = Annotated[str, Field(min_length=1, max_length=60)]


class ShownKeys(Strict):
    """A property of the mechanism that is a single number, named as in the tables."""

    of: Quantity = Field(
        description=(
            "name of the quantity: psi, k, W, x of E, v of 5 on 0, phi of 3, M_b, R_34; for a vector, its "
            "magnitude is taken"
        )
    )
    at: Number | None = Field(default=None, description="number of the position")
    between: Annotated[list[Number], Field(min_length=2, max_length=2)] | None = Field(
        default=None, description="change of the quantity from one position to another; given instead of `at`"
    )
    over: Literal["largest", "least", "range"] | None = Field(
        default=None,
        description=(
            "largest or smallest value, or the difference of the two, over the range of the driver, over one "
            "turn or at the requested positions; given instead of `at`"
        ),
    )
    within: Value | None = Field(
        default=None,
        description=(
            "tolerance, given together with `at`: the result is the range of the driver around this position "
            "within which the quantity changes by at most the tolerance"
        ),
    )
    per: Value | None = Field(
        default=None,
        description="divisor: another quantity (for `largest` and `least`: its value at each position) or a value",
    )
    set: dict[Name, Value] = Field(
        default_factory=dict, max_length=50, description="other values of parameters for this property"
    )
    without: Name | None = Field(
        default=None, description="name of a hinge to remove; only for properties of the structure"
    )
    expected: Value | None = Field(
        default=None, description="expected value from another source; `tmm run` compares it with the computed one"
    )


Shows = Annotated[dict[Annotated[str, Field(max_length=120)], ShownKeys], Field(max_length=50)]


# File of a spatial chain, given by its pairs alone.


MAX_PAIRS = 300
MAX_MOBILITY = 6 * MAX_LINKS

Kind = Literal[
    "turning",
    "sliding",
    "screw",
    "cylindrical",
    "spherical with a pin",
    "universal",
    "spherical",
    "planar",
    "sphere in cylinder",
    "cylinder on plane",
    "sphere on plane",
]


Freedoms = Annotated[int, Field(ge=0, le=MAX_MOBILITY)]


class SpatialPairKeys(Strict):
    """A pair that joins two links of a spatial chain."""

    between: list[Name] = Field(min_length=2, max_length=2, description="the two links; the frame is 0")
    kind: Kind | None = Field(default=None, description="kind of the pair, which determines its degrees of freedom")
    freedoms: int | None = Field(
        default=None, ge=1, le=5, description="number of degrees of freedom, 1 to 5; given instead of `kind`"
    )


class Spatial(Strict):
    """A spatial chain, described by its pairs alone."""

    links: Annotated[int, Field(ge=1, le=MAX_LINKS)] | Annotated[list[Name], Field(max_length=MAX_LINKS)] | None = (
        Field(
            default=None, description="moving links: their names or their number; default: the links named in `pairs`"
        )
    )
    pairs: dict[Name, SpatialPairKeys] = Field(min_length=1, max_length=MAX_PAIRS)
    output: Name | None = Field(default=None, description="output link, held fixed to compute the manoeuvrability")
    local: Freedoms | dict[Name, Freedoms] | None = Field(
        default=None,
        description=(
            "local degrees of freedom Wm: their total, or a number for each link; default: determined from the pairs"
        ),
    )
    wanted: Freedoms | None = Field(default=None, description="required mobility Wo, used in q = Wo + Wm - W")


class SpatialStructure(Strict):
    """Structural analysis of a chain without dimensions."""

    spatial: Spatial


class SpatialFile(FileHead):
    """A file with a spatial chain without dimensions; only its structure is analysed."""

    reference: str = Field(default="", max_length=100, description="number or name of the mechanism in a book or list")
    shows: Shows = Field(
        default={}, description="properties to compute (W, Wm, q or m): {mobility: {of: W, expected: 9}}"
    )
    structure: SpatialStructure


# File of a planar linkage.


class Guide(Strict):
    """A straight guide on the frame or on a link."""

    on: Name = Field(default="0", description="link that carries the guide; default: the frame")
    through: Place | None = Field(
        default=None, description="point of that link on the guide, or [x, y] in its coordinate axes"
    )
    angle: Value | None = Field(default=None, description="direction of the guide: angle from the x axis of that link")
    along: Name | None = Field(
        default=None, description="two points on the guide, e.g. CD; given instead of `through` and `angle`"
    )
    offset: Value = Field(default=0, description="distance by which the guide is shifted to the left of that line")
    unbounded: bool = Field(
        default=False, description="on a moving link: true if the guide extends beyond the points of `along`"
    )


class SlideKeys(Strict):
    """A prismatic pair of this link."""

    on: Name = Field(description="name of the guide, or of the link on which this link slides")
    along: Name | None = Field(default=None, description="two points of that link, e.g. CD: the guide runs from C to D")
    through: Place | None = Field(
        default=None, description="point of that link on the guide, or [x, y] in its coordinate axes"
    )
    angle: Value | None = Field(default=None, description="direction of the guide: angle from the x axis of that link")
    offset: Value = Field(default=0, description="distance by which the guide is shifted to the left of that line")
    point: Name | None = Field(
        default=None, description="point of this link that slides on the guide; default: its first point"
    )
    turned: Value = Field(
        default=0, description="angle from the coordinate axes of the link that carries the guide to those of this link"
    )
    unbounded: bool = Field(default=False, description="true if the guide extends beyond the points of `along`")


def _expand_guide_name(raw: Any) -> Any:
    return {"on": raw} if isinstance(raw, str | int) and not isinstance(raw, bool) else raw


SlideOrGuide = Annotated[SlideKeys, BeforeValidator(_expand_guide_name, json_schema_input_type=SlideKeys | Name)]


class LinkKeys(Strict):
    """A moving link. Its x axis runs from its first point to the second, unless points are given by coordinates."""

    name: str | None = Field(default=None, max_length=60, description="name of the link in reports")
    points: list[Name] | dict[Name, Vector] = Field(
        description="names of the points of the link, or their coordinates in the coordinate axes of the link"
    )
    length: Value | None = Field(default=None, description="distance between the two points")
    also: dict[Name, Place] = Field(
        default_factory=dict, description="further points of the link, with their positions in its coordinate axes"
    )
    slides: SlideOrGuide | list[SlideOrGuide] | None = Field(
        default=None, description="prismatic pair of this link: a guide, or {on, along}, or a list of them"
    )

    @property
    def sliding(self) -> list[SlideKeys]:
        """Prismatic pairs of the link as a list, even if the file gives a single one."""
        return self.slides if isinstance(self.slides, list) else [self.slides] if self.slides else []


class Speeds(Strict):
    """Speed or acceleration of a crank as a function of its angle."""

    against: Literal["crank angle"] = Field(
        description=(
            "quantity in the first column of the table. crank angle: angle of the crank from the x axis, "
            "counterclockwise"
        )
    )
    table: list[Vector] = Field(min_length=2, max_length=10_000, description="rows [angle, value]")
    between: Literal["smooth", "linear"] = Field(
        default="smooth",
        description=(
            "interpolation between rows. smooth: cubic spline; linear: straight lines. For speeds, their "
            "squares are interpolated"
        ),
    )


class CompoundHinge(Strict):
    """A hinge of three or more links."""

    attached_to: Name = Field(
        alias="attached to", description="link with which each of the other links forms a pair; 0 is the frame"
    )


def _checked_speed(raw: Any) -> Any:
    return Speeds.model_validate(raw) if isinstance(raw, dict) else checked_value(raw)


class DriverKeys(Strict):
    """A driver: a crank, or a driven slider (cylinder), on the frame or on a moving link."""

    link: Name
    on: Name = Field(
        default="0", description="link relative to which the motion is given: the frame, or the cylinder of a piston"
    )
    at: Value | None = Field(
        default=None, description="driver coordinate in the sketch; only for the second and further drivers"
    )
    speed: Annotated[Value | Speeds, BeforeValidator(_checked_speed)] = Field(
        description=(
            "speed of rotation (82 rpm, 8 rad/s) or of sliding (0.2 m/s); for a crank also a table {against, table}"
        )
    )
    acceleration: Annotated[Value | Speeds, BeforeValidator(_checked_speed)] = Field(
        default=0,
        description=(
            "acceleration in the direction of motion; `speed` is then the speed at position 0. If the speed is "
            "a table, the acceleration must be a table too"
        ),
    )
    stroke: Vector | None = Field(
        default=None, description="stroke of a driving slider: [from, to], the coordinates of its ends"
    )
    turns: Literal["ccw", "cw"] = Field(default="ccw", description="direction of rotation")
    balance: Literal["moment", "force"] = Field(
        default="moment", description="balancing of the crank: by a moment (moment) or by a force (force)"
    )
    end: Name | None = Field(default=None, description="point of the crank at which the balancing force acts")


class OutputKeys(Strict):
    """The output: a link whose stroke or swing is the purpose of the mechanism, or a point of a moving link (its x and
    y).
    """

    link: Name = Field(
        description=(
            "output link or point. The output quantity is the stroke of a link that slides on the frame, the "
            "swing angle of a link hinged to the frame, the angle of a coupler, or the displacement of a "
            "sliding block along the slot"
        )
    )
    working: Literal["auto", "forward", "backward"] = Field(
        default="auto", description="direction of the working stroke; auto: the slower stroke is the working one"
    )


def _list_outputs(raw: Any) -> list[OutputKeys]:
    several = raw if isinstance(raw, list) else [raw]
    return [
        OutputKeys.model_validate(output if isinstance(output, dict) else {"link": checked_name(output)})
        for output in several
    ]


def _make_list(raw: Any) -> Any:
    return [raw] if isinstance(raw, str | int | float) else raw


class Positions(Strict):
    """Positions to compute, numbered from 0 in the direction of motion of the driver."""

    count: int = Field(default=12, ge=1, le=MAX_POSITIONS)
    from_: Value | None = Field(
        default=None,
        alias="from",
        description="crank angle of position 0, or `working stroke` for the start of the working stroke",
    )
    at: Annotated[
        list[Value] | None, BeforeValidator(_make_list, json_schema_input_type=list[Value] | Value | None)
    ] = Field(
        default=None,
        max_length=MAX_POSITIONS,
        description="list of driver coordinates; given instead of `count` and `from`",
    )
    detail: Annotated[list[int], BeforeValidator(_make_list, json_schema_input_type=list[int] | int)] = Field(
        default_factory=list, max_length=24, description="numbers of the positions drawn in detail"
    )
    centres: bool = Field(default=False, description="true to draw the instantaneous centres in the detailed positions")


class Checks(Strict):
    """Limits. If one is exceeded, a run reports it and ends with exit code 1."""

    lever: Value = Field(
        default="5 %",
        description=(
            "largest allowed relative difference between the balancing moments by the Zhukovsky lever and by "
            "force analysis"
        ),
    )
    pressure_sliding: Value | None = Field(
        default=None, description="largest allowed pressure angle on a sliding output link; default: 30 deg"
    )
    pressure_turning: Value | None = Field(
        default=None, description="largest allowed pressure angle on a rotating output link; default: 45 deg"
    )


class File(FileHead):
    """A problem file of a planar linkage."""

    reference: str = Field(
        default="", max_length=100, description="number or name of the mechanism in a book or list: M7, Fig. 7"
    )
    shows: Shows = Field(default={}, description="properties to compute as numbers: {swing: {of: psi, expected: 2*a}}")
    units: dict[str, str] = Field(
        default_factory=dict, description="units of numbers written without a unit: {length: mm, angle: deg}"
    )
    parameters: dict[Name, Value] = Field(default_factory=dict, max_length=500)
    synthesis: Any = Field(default=None, description="synthesis task whose results become parameters: {task: ...}")
    variants: Any = Field(
        default=None, description="parameters varied among the students of a group: {OA: {from, to, step}}"
    )
    grading: Any = Field(
        default=None, description="answers required from students and how they are graded: {answers: [...]}"
    )
    points: dict[Name, Vector] = Field(default_factory=dict, max_length=500, description="points of the frame")
    guides: dict[Name, Guide] = Field(default_factory=dict, max_length=200)
    links: dict[Name, LinkKeys] = Field(min_length=1, max_length=MAX_LINKS)
    hinges: dict[Name, CompoundHinge] = Field(
        default_factory=dict,
        max_length=100,
        description="compound hinges whose links are attached differently from the default",
    )
    driver: DriverKeys | list[DriverKeys] = Field(description="input link; a list if W > 1")
    gears: dict[Name, GearKeys] = Field(default_factory=dict, max_length=100)
    racks: dict[Name, RackKeys] = Field(default_factory=dict, max_length=100)
    cams: dict[Name, CamKeys] = Field(default_factory=dict, max_length=100)
    springs: dict[Name, SpringKeys] = Field(default_factory=dict, max_length=100)
    dampers: dict[Name, DamperKeys] = Field(
        default_factory=dict, max_length=100, description="dampers, with a force or moment by speed"
    )
    friction: FrictionKeys | None = None
    sketch: dict[Name, Any] = Field(
        default_factory=dict,
        description=(
            "approximate position of the mechanism for one driver coordinate `at`: coordinates [x, y] of "
            "points, angles of links"
        ),
    )
    change_points: Literal["smooth", "keep side"] = Field(
        default="smooth",
        alias="change points",
        description=(
            "how parallelogram linkages and the like pass positions in which their assembly could change. "
            "smooth: the motion continues smoothly; keep side: the assembly stays that of the sketch"
        ),
    )
    masses: dict[Name, MassKeys] = Field(default_factory=dict)
    loads: dict[Name, LoadKeys] = Field(default_factory=dict, max_length=200)
    gravity: Any = Field(
        default=None,
        description="acceleration of gravity: [x, y], or one number, directed downwards; default: 9.81 m/s^2",
    )
    output: Annotated[Name | OutputKeys | list[Name | OutputKeys], BeforeValidator(_list_outputs)] = Field(
        default=[],
        max_length=20,
        description="output of the mechanism: a link or a point, or {link, working}, or a list of these",
    )
    cycle: Value | None = Field(
        default=None,
        description="number of crank turns after which the loads repeat, e.g. 2 turns for a four-stroke engine",
    )
    intermittent: Wheels = Field(
        default={}, description="wheels that a link moves only during some strokes, as in ratchets and one-way clutches"
    )
    positions: Positions = Field(default_factory=Positions)
    checks: Checks = Field(default_factory=Checks)
    dynamics: DynamicsKeys | None = Field(default=None, description="law of motion of the machine: motor, flywheel")
    balancing: BalancingKeys | None = Field(
        default=None, description="shaking force and moment on the frame, and counterweights"
    )
    sheet: SheetTexts = Field(default_factory=SheetTexts, description="texts of the title block of `tmm sheets`")
    frame: Name = Field(
        default="0", description="number of the frame in printed results; e.g. with 6, R_65 is printed instead of R_05"
    )
    note: NoteStyle = Field(default_factory=NoteStyle, description="style of the calculation note and its drawings")


# JSON Schema of problem files.


class _SchemaGenerator(GenerateJsonSchema):
    """Generator of a JSON Schema in which the definition of LinkKeys is called Link."""

    def normalize_name(self, name: str) -> str:
        return super().normalize_name(name.removesuffix("Keys"))


def file_schema(tasks: Iterable[type[BaseModel]], blocks: type[BaseModel]) -> dict[str, Any]:
    """Generate the JSON Schema of problem files, for editors.

    Args:
        tasks: models of the tasks allowed under the key `synthesis`.
        blocks: model whose fields are further blocks of a file.
    """
    definitions: dict[str, Any] = {}

    def schema(model: type[BaseModel]) -> dict[str, Any]:
        inner = model.model_json_schema(by_alias=True, schema_generator=_SchemaGenerator)
        definitions.update({**inner.pop("$defs", {}), **definitions})
        return inner

    planar = schema(File)
    planar["properties"]["synthesis"]["anyOf"] = [{"$ref": "#/$defs/Synthesis"}]
    planar["properties"] |= schema(blocks)["properties"]
    definitions["SpatialFile"] = schema(SpatialFile)
    definitions["Synthesis"] = {"anyOf": [schema(task) for task in tasks]}
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "$defs": definitions,
        "if": {"required": ["structure"]},
        "then": {"$ref": "#/$defs/SpatialFile"},
        "else": planar,
    }
