"""The shapes of the blocks `sheet` and `note`: texts of the title block, and how the course writes its notes."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, Field, WithJsonSchema
from pydantic.json_schema import GenerateJsonSchema
from pydantic_core import PydanticCustomError

from tmm_cli.problem.blocks.loads import LoadKeys, MassKeys
from tmm_cli.problem.blocks.meshes import CamKeys, GearKeys, RackKeys
from tmm_cli.problem.blocks.optional_keys import BalancingKeys, DynamicsKeys, Wheels
from tmm_cli.problem.blocks.springs import FrictionKeys, SpringKeys
from tmm_cli.problem.schema_types import (
    MAX_LINKS,
    MAX_POSITIONS,
    NAMES,
    FileHead,
    Name,
    Place,
    Strict,
    Value,
    Vector,
    checked_name,
    checked_value,
)

MAX_TEXT_LENGTH = 200


def _checked_short_text(found: Any) -> str:
    """A line of text; the number of a group may be written as a number."""
    if isinstance(found, bool) or not isinstance(found, int | str):
        raise PydanticCustomError("words", "text is wanted")
    if len(str(found)) > MAX_TEXT_LENGTH:
        raise PydanticCustomError("words", f"text is at most {MAX_TEXT_LENGTH} characters long")
    return str(found)


ShortText = Annotated[str, BeforeValidator(_checked_short_text), WithJsonSchema({"anyOf": NAMES})]


class SheetTexts(Strict):
    """Texts of the title block. One that is too long for its cell is cut there."""

    student: ShortText = Field(default="", description="who drew it")
    group: ShortText = Field(default="", description="the student's group")
    teacher: ShortText = Field(default="", description="who checks it")
    institution: ShortText = Field(default="", description="the university, on the title page of the note")
    department: ShortText = Field(default="", description="the university and its department")
    code: ShortText = Field(
        default="", description="designation of the project; the number of the sheet is added to it"
    )
    block: Literal["gost", "plain"] = Field(default="gost", description="GOST 2.104 form 1, or a plain one")


class NoteStyle(Strict):
    """How the course writes: of the choices each is the usual one where the file leaves it out."""

    inertia: Literal["U", "Φ"] | None = Field(
        default=None,
        description="letter of inertia forces; left out: that of the language (in Russian Φ)",
    )
    arms: Literal["m", "paper"] = Field(
        default="m",
        description="arms in equations of moments: in metres, or in millimetres of the drawing with its scale mu_l",
    )
    sections: Literal["usual", "MATI"] = Field(
        default="usual", description="MATI: the force analysis in the steps 1 to 4 of the guidelines, before the lever"
    )


# The shape of the block `shows`: properties of a mechanism as numbers, with what they should be.


Number = Annotated[int, Field(ge=0)]
Quantity = Annotated[str, Field(min_length=1, max_length=60)]


class ShownKeys(Strict):
    """A quantity by the name that the tables give it, as one number."""

    of: Quantity = Field(description="what: psi, k, W, x of E, v of 5 on 0, phi of 3, M_b, R_34; of vectors the size")
    at: Number | None = Field(default=None, description="in which position")
    between: Annotated[list[Number], Field(min_length=2, max_length=2)] | None = Field(
        default=None, description="instead: its change from one position to another"
    )
    over: Literal["largest", "least", "range"] | None = Field(
        default=None, description="instead: over the way of the driver, its turn or the positions asked"
    )
    within: Value | None = Field(
        default=None, description="with `at`: the way of the driver about there, on which it changes by no more"
    )
    per: Value | None = Field(
        default=None,
        description="divided by another quantity, place by place for largest and least, or by a value",
    )
    set: dict[Name, Value] = Field(default_factory=dict, max_length=50, description="with these parameters instead")
    without: Name | None = Field(default=None, description="of the structure: when this hinge has broken")
    expected: Value | None = Field(default=None, description="what it should be, from elsewhere: a run compares it")


Shows = Annotated[dict[Annotated[str, Field(max_length=120)], ShownKeys], Field(max_length=50)]


# The shape of a problem file that gives a chain in space by its pairs alone.


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
    """A pair of two links."""

    between: list[Name] = Field(min_length=2, max_length=2, description="the two links; the frame is 0")
    kind: Kind | None = Field(default=None, description="its kind, which says the freedoms")
    freedoms: int | None = Field(default=None, ge=1, le=5, description="instead of kind: 1 to 5 freedoms")


class Spatial(Strict):
    """A chain in space, given by pairs alone."""

    links: Annotated[int, Field(ge=1, le=MAX_LINKS)] | Annotated[list[Name], Field(max_length=MAX_LINKS)] | None = (
        Field(default=None, description="moving links, names or how many; those of the pairs when left out")
    )
    pairs: dict[Name, SpatialPairKeys] = Field(min_length=1, max_length=MAX_PAIRS)
    output: Name | None = Field(default=None, description="the link that is held for the manoeuvrability")
    local: Freedoms | dict[Name, Freedoms] | None = Field(
        default=None, description="local freedoms Wm, all of them or by link; found from the pairs when left out"
    )
    wanted: Freedoms | None = Field(
        default=None, description="mobility Wo that it is meant to have, for q = Wo + Wm - W"
    )


class SpatialStructure(Strict):
    """What is counted without dimensions."""

    spatial: Spatial


class SpatialFile(FileHead):
    """A chain in space without dimensions: only its structure is counted."""

    reference: str = Field(default="", max_length=100, description="of the mechanism in a book or a list")
    shows: Shows = Field(default={}, description="W, Wm, q or m: {mobility: {of: W, expected: 9}}")
    structure: SpatialStructure


# The shape of a problem file, for pydantic: what keys there are and what may stand in them.
#
# Only shape is checked here; numbers with units, names of points and guides and the rest of the sense are checked where
# the file is built into a linkage (build), which knows the parameters and units. The field descriptions are what
# `tmm schema` prints.


class Guide(Strict):
    """A straight guide on the frame or on a link."""

    on: Name = Field(default="0", description="the link that carries it; the frame when left out")
    through: Place | None = Field(default=None, description="a point of that link, or [x, y] in its axes")
    angle: Value | None = Field(default=None, description="direction, from the x axis of that link")
    along: Name | None = Field(default=None, description="instead of through and angle: two points, CD")
    offset: Value = Field(default=0, description="distance of the guide to the left of that line")
    unbounded: bool = Field(default=False, description="on a moving link: it goes on beyond the points of `along`")


class SlideKeys(Strict):
    """A sliding pair of this link."""

    on: Name = Field(description="a guide's name, or the link that it slides on")
    along: Name | None = Field(default=None, description="two points of that link: the guide runs from C to D")
    through: Place | None = Field(default=None, description="a point of that link on the guide, or [x, y] in its axes")
    angle: Value | None = Field(default=None, description="direction of the guide, from the x axis of that link")
    offset: Value = Field(default=0, description="distance of the guide to the left of that line")
    point: Name | None = Field(default=None, description="the point of this link that runs on the guide; its first")
    turned: Value = Field(default=0, description="angle of this link's axes from those of the link it slides on")
    unbounded: bool = Field(default=False, description="the guide goes on beyond the points of `along`")


def _expand_guide_name(found: Any) -> Any:
    return {"on": found} if isinstance(found, str | int) and not isinstance(found, bool) else found


SlideOrGuide = Annotated[SlideKeys, BeforeValidator(_expand_guide_name, json_schema_input_type=SlideKeys | Name)]


class LinkKeys(Strict):
    """A moving link. Its axes: origin in its first point, x towards the second; or as coordinates say."""

    name: str | None = Field(default=None, max_length=60, description="what the link is called in reports")
    points: list[Name] | dict[Name, Vector] = Field(description="names of its points, or their coordinates in its axes")
    length: Value | None = Field(default=None, description="distance of two points")
    also: dict[Name, Place] = Field(default_factory=dict, description="further points, in its axes")
    slides: SlideOrGuide | list[SlideOrGuide] | None = Field(
        default=None, description="what it slides on: a guide, or {on, along}, or several of them in a list"
    )

    @property
    def sliding(self) -> list[SlideKeys]:
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


def _checked_speed(found: Any) -> Any:
    return Speeds.model_validate(found) if isinstance(found, dict) else checked_value(found)


class DriverKeys(Strict):
    """An input: a crank, or a slider that is driven (cylinder), on the frame or on a moving link."""

    link: Name
    on: Name = Field(default="0", description="the link that it is driven from: the frame, or the cylinder of a piston")
    at: Value | None = Field(default=None, description="its place in the sketch, for drivers after the first")
    speed: Annotated[Value | Speeds, BeforeValidator(_checked_speed)] = Field(
        description="of rotation (82 rpm, 8 rad/s) or of sliding (0.2 m/s); of a crank {against, table} too"
    )
    acceleration: Annotated[Value | Speeds, BeforeValidator(_checked_speed)] = Field(
        default=0, description="in the sense of motion; the speed is that of position 0; beside a table: one too"
    )
    stroke: Vector | None = Field(default=None, description="[from, to]: places between which a cylinder works")
    turns: Literal["ccw", "cw"] = Field(default="ccw", description="sense of rotation")
    balance: Literal["moment", "force"] = Field(default="moment", description="what balances the crank")
    end: Name | None = Field(default=None, description="the crank's point where the balancing force acts")


class OutputKeys(Strict):
    """The link whose stroke or swing is the purpose of the mechanism, or a point of a moving link: its x and y."""

    link: Name = Field(
        description="of a link joined to the frame its stroke or swing, of a coupler its angle, of a stone its place "
        "along the slot"
    )
    working: Literal["auto", "forward", "backward"] = Field(
        default="auto", description="direction of the working stroke; auto: the slower one"
    )


def _list_outputs(found: Any) -> list[OutputKeys]:
    several = found if isinstance(found, list) else [found]
    return [OutputKeys.model_validate(one if isinstance(one, dict) else {"link": checked_name(one)}) for one in several]


def _make_list(found: Any) -> Any:
    return [found] if isinstance(found, str | int | float) else found


class Positions(Strict):
    """Which positions are computed. They are numbered from 0 in the driver's sense."""

    count: int = Field(default=12, ge=1, le=MAX_POSITIONS)
    from_: Value | None = Field(
        default=None, alias="from", description="place of position 0: an angle, or `working stroke`"
    )
    at: Annotated[
        list[Value] | None, BeforeValidator(_make_list, json_schema_input_type=list[Value] | Value | None)
    ] = Field(default=None, max_length=MAX_POSITIONS, description="places one by one, instead")
    detail: Annotated[list[int], BeforeValidator(_make_list, json_schema_input_type=list[int] | int)] = Field(
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
    links: dict[Name, LinkKeys] = Field(min_length=1, max_length=MAX_LINKS)
    hinges: dict[Name, CompoundHinge] = Field(
        default_factory=dict, max_length=100, description="compound hinges that are not counted in the usual way"
    )
    driver: DriverKeys | list[DriverKeys] = Field(description="the input; several as a list, when W > 1")
    gears: dict[Name, GearKeys] = Field(default_factory=dict, max_length=100)
    racks: dict[Name, RackKeys] = Field(default_factory=dict, max_length=100)
    cams: dict[Name, CamKeys] = Field(default_factory=dict, max_length=100)
    springs: dict[Name, SpringKeys] = Field(default_factory=dict, max_length=100)
    friction: FrictionKeys | None = None
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
    masses: dict[Name, MassKeys] = Field(default_factory=dict)
    loads: dict[Name, LoadKeys] = Field(default_factory=dict, max_length=200)
    gravity: Any = Field(default=None, description="[x, y], or one number downwards; 9.81 m/s^2 when left out")
    output: Annotated[Name | OutputKeys | list[Name | OutputKeys], BeforeValidator(_list_outputs)] = Field(
        default=[], max_length=20, description="a link or a point, or {link, working}, or several of them in a list"
    )
    cycle: Value | None = Field(
        default=None, description="turns of the crank after which its loads come again: 2 turns of a four-stroke engine"
    )
    intermittent: Wheels = Field(default={}, description="wheels that a link takes along on some strokes only")
    positions: Positions = Field(default_factory=Positions)
    checks: Checks = Field(default_factory=Checks)
    dynamics: DynamicsKeys | None = Field(default=None, description="law of motion: motor, flywheel")
    balancing: BalancingKeys | None = Field(default=None, description="what shakes the frame, and counterweights")
    sheet: SheetTexts = Field(default_factory=SheetTexts, description="texts of the title block of `tmm sheets`")
    frame: Name = Field(default="0", description="the number of the frame that is printed: R_65 for R_05 where it is 6")
    note: NoteStyle = Field(default_factory=NoteStyle, description="how the note and its drawings are written")


# The JSON Schema of problem files, for editors.


class _SchemaGenerator(GenerateJsonSchema):
    """JSON Schema in which the definition of LinkKeys is called Link."""

    def normalize_name(self, name: str) -> str:
        return super().normalize_name(name.removesuffix("Keys"))


def file_schema(tasks: Iterable[type[BaseModel]], blocks: type[BaseModel]) -> dict[str, Any]:
    """Made by pydantic from the shapes; tasks: those of the blocks that may stand under `synthesis`; blocks: further
    ones of a file, by their names."""
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
