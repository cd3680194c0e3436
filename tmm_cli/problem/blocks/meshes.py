"""Gears, racks and cams of a problem file: their keys, and the higher pairs that are built from them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING, Literal

import numpy as np
from pydantic import Field

from tmm_cli.language import _
from tmm_cli.mechanics.groups import CamLaw, CamLawPiece
from tmm_cli.mechanics.linkage import FRAME, Mesh
from tmm_cli.mechanics.numerics import IN_PHASE, PITCHES_TOUCH, WHOLE_TEETH, cross, unit
from tmm_cli.mechanics.quantities import ANGLE, LENGTH, NUMBER
from tmm_cli.problem.errors import Path, ProblemError, quote
from tmm_cli.problem.schema_types import Name, Strict, Value
from tmm_cli.problem.values import FileSection, ValueReader, check_name

if TYPE_CHECKING:
    from tmm_cli.problem import schema
    from tmm_cli.problem.blocks.links import LinksAndPairs


class GearKeys(Strict):
    """Two gears in mesh, hinged to a common carrier."""

    between: list[Name] = Field(
        min_length=2, max_length=2, description="the two gears; one may be the frame (a fixed gear)"
    )
    carrier: Name = Field(
        default="0", description="link that carries both axes; if it is not the frame, the gears form a planetary train"
    )
    teeth: list[Value] | None = Field(
        default=None, min_length=2, max_length=2, description="numbers of teeth of both gears"
    )
    radii: list[Value] | None = Field(
        default=None, min_length=2, max_length=2, description="radii of both pitch circles"
    )
    ratio: Value | None = Field(
        default=None, description="ratio of the first radius to the second, given instead of `teeth` or `radii`"
    )
    module: Value | None = Field(
        default=None, description="module; if `teeth` is given too, the module is checked against the centre distance"
    )
    inner: bool = Field(default=False, description="true if one of the gears is internal")
    offset: Value = Field(
        default=0,
        description="angle of the second gear relative to the carrier when the angle of the first gear is zero",
    )
    pressure: Value = Field(default="20 deg", description="pressure angle of the teeth")


class RackKeys(Strict):
    """A gear that meshes with a rack."""

    wheel: Name
    rack: Name = Field(description="link with the rack; it slides on the carrier")
    carrier: Name = Field(default="0", description="link that carries the gear and the rack; default: the frame")
    radius: Value = Field(description="radius of the pitch circle of the gear")
    side: Literal["left", "right"] | None = Field(
        default=None,
        description=(
            "side of the rack on which the gear lies, looking along the guide of the rack; required if the "
            "axis of the gear lies on the guide"
        ),
    )
    offset: Value = Field(default=0, description="displacement of the rack when the angle of the gear is zero")
    pressure: Value = Field(default="20 deg", description="pressure angle of the teeth")


class CamPieceKeys(Strict):
    """A segment of a cam's law of motion."""

    over: Value = Field(description="angle of rotation of the cam during this segment")
    rise: Value = Field(default=0, description="rise of the follower; negative for a return, zero for a dwell")
    law: Literal["linear", "parabolic", "cosine", "sine", "3-4-5", "4-5-6-7"] = "sine"


class CamKeys(Strict):
    """A cam and its follower on a common carrier, defined by the law of motion of the follower."""

    cam: Name = Field(description="link that is the cam, hinged to the carrier; it may be the frame (a fixed cam)")
    follower: Name = Field(
        description="link that is the follower: it slides on the carrier, or swings about a hinge on the frame"
    )
    carrier: Name = Field(
        default="0",
        description=(
            "link that carries both the cam and the follower; if it moves, the cam changes the length of that link"
        ),
    )
    law: list[CamPieceKeys] = Field(
        min_length=1, max_length=100, description="law of motion: segments that add up to a full turn"
    )
    start: Value = Field(
        default=0, description="angle of the cam relative to the carrier at which the first segment begins"
    )
    offset: Value = Field(
        default=0, description="displacement (or angle) of the follower at the beginning of the first segment"
    )
    roller: Name | None = Field(
        default=None,
        description=(
            "number of the roller on the follower; the structural analysis counts the roller as a link, but it "
            "does not affect the motion"
        ),
    )


# Building of gears, racks and cams.


MAX_GEAR_RATIO = 100_000


def build_meshes(shape: schema.File, members: LinksAndPairs, sense: int, values: ValueReader) -> tuple[Mesh, ...]:
    """Build all higher pairs of the file: gears, racks and cams. Raises ProblemError.

    sense: sense of rotation of the driver, +1 for counterclockwise, -1 for clockwise.
    """
    taken = {h.point for h in members.hinges} | {s.name for s in members.slides}
    meshes: list[Mesh] = []
    for block, build in (("gears", _build_gear), ("racks", _build_rack), ("cams", partial(_build_cam, sense))):
        for name, keys in getattr(shape, block).items():
            check_name(name, (block, name), "pair", taken)
            taken.add(name)
            meshes.append(build(name, FileSection(keys, (block, name), values), members))
        if block == "gears":
            _refuse_locked_trains(meshes)
    _refuse_shared_rollers(meshes)
    return tuple(meshes)


def _refuse_shared_rollers(meshes: Sequence[Mesh]) -> None:
    """Refuse two cam followers whose rollers have the same link number, as structural analysis counts each roller as a
    link.
    """
    rollers = [mesh.roller for mesh in meshes]
    for index, mesh in enumerate(meshes):
        if mesh.roller and mesh.roller in rollers[:index]:
            raise ProblemError(
                _("a link already has this number"),
                path=("cams", mesh.name, "roller"),
                found=quote(mesh.roller),
                allowed=_("a different number for each roller"),
            )


def _refuse_locked_trains(gears: list[Mesh]) -> None:
    """Refuse gears on one carrier that form a closed train and lock one another.

    They lock if their ratios or the positions of their teeth contradict each other.
    """
    # train of each carrier and gear; the angle of each gear is a slope times that of one of them, plus a phase
    trains: dict[tuple[str, str], dict[str, tuple[float, float]]] = {}
    for gear in gears:
        train, other_train = (trains.setdefault((gear.carrier, n), {n: (1.0, 0.0)}) for n in (gear.i, gear.j))
        slope, phase = train[gear.i]
        required_slope, angle = gear.ratio * slope, gear.ratio * phase + gear.offset
        other_slope, other_phase = other_train[gear.j]
        if train is not other_train:
            for wheel, (gear_slope, gear_phase) in other_train.items():
                train[wheel] = (
                    gear_slope * required_slope / other_slope,
                    gear_phase + gear_slope * (angle - other_phase) / other_slope,
                )
                trains[gear.carrier, wheel] = train
        elif (
            abs(required_slope - other_slope) > PITCHES_TOUCH * max(abs(required_slope), abs(other_slope))
            or abs(angle - other_phase) > IN_PHASE
        ):
            raise ProblemError(
                _("gear pair {name} contradicts the pairs before it: the gears lock each other").format(name=gear.name),
                path=("gears", gear.name),
                allowed=_(
                    "ratios and offsets that are compatible around the closed gear train, or one gear pair fewer"
                ),
                key=True,
            )


def _check_different_links(names: Sequence[str], section: FileSection, path: Path, members: LinksAndPairs) -> None:
    """Check that the names are those of links and that no link is named twice. Raises ProblemError."""
    for name in names:
        section.values.known_name(name, members.links, path, "link")
    section.values.refuse_same(names, path)


def _axis_on_carrier(link: str, carrier: str, members: LinksAndPairs, path: Path) -> complex:
    """Return the point (m, in the axes of the carrier) at which a link is hinged to it. Raises ProblemError."""
    point = members.hinge(link, carrier)
    if point is None:
        raise members.missing_pair_error(link, carrier, path, "R")
    return members.links[carrier].points[point]


def _pressure_angle(section: FileSection) -> float:
    angle = section.number("pressure", ANGLE)
    if not 0 <= angle < math.pi / 2:
        beyond = _("the pressure angle of the teeth must be between 0 and 90 deg")
        raise section.refusal("pressure", beyond, str(section.keys.pressure))
    return angle


def _build_gear(name: str, section: FileSection, members: LinksAndPairs) -> Mesh:
    keys: GearKeys = section.keys
    between: Path = (*section.path, "between")
    (i, j), carrier = keys.between, keys.carrier
    _check_different_links((i, j, carrier), section, between, members)
    first, second = (_axis_on_carrier(n, carrier, members, (*between, k)) for k, n in enumerate((i, j)))
    distance = abs(second - first)
    if distance == 0:
        raise section.refusal(
            "between", _("gears {i} and {j} rotate about the same axis").format(i=i, j=j), f"{i}, {j}"
        )
    ratio = _radius_ratio(section, keys, distance)
    return Mesh(name, "gear", i, j, carrier, ratio, section.number("offset", ANGLE), pressure=_pressure_angle(section))


def _radius_ratio(section: FileSection, keys: GearKeys, distance: float) -> float:
    """Return the first pitch radius divided by the second; negative for an external mesh.

    Raises ProblemError if the given teeth, radii and ratio contradict each other or the distance of the axes.
    """
    values, path = section.values, section.path
    teeth, radii = None, None
    ratios: dict[str, float] = {}
    if keys.teeth is not None:
        teeth = [_count_teeth(values, v, (*path, "teeth", k)) for k, v in enumerate(keys.teeth)]
        ratios["teeth"] = teeth[0] / teeth[1]
    if keys.radii is not None:
        radii = [values.positive(v, LENGTH, (*path, "radii", k)) for k, v in enumerate(keys.radii)]
        ratios["radii"] = radii[0] / radii[1]
    if keys.ratio is not None:
        ratios["ratio"] = section.positive("ratio", NUMBER)
    if not ratios or (keys.module is not None and teeth is None):
        message = _("one of the keys `teeth`, `radii` or `ratio` is required; with `module`, `teeth` is required")
        raise section.refusal("", message, allowed=_("teeth: [20, 40]"))
    ratio = next(iter(ratios.values()))
    i, j = keys.between
    if any(abs(other - ratio) > PITCHES_TOUCH * ratio for other in ratios.values()):
        raise section.refusal(
            "",
            _("the data of gears {i} and {j} give contradictory ratios").format(i=i, j=j),
            ", ".join(f"by {key} {value:.6g}" for key, value in ratios.items()),
        )
    if not 1 / MAX_GEAR_RATIO <= ratio <= MAX_GEAR_RATIO or (keys.inner and ratio == 1):
        raise section.refusal("", _("a pair of gears cannot have this ratio"), f"{ratio:.6g}")
    if keys.module is not None and teeth is not None and radii is None:
        module = section.positive("module", LENGTH)
        radii = [module * number / 2 for number in teeth]
    if radii is not None:
        wanted_distance = abs(radii[0] - radii[1]) if keys.inner else radii[0] + radii[1]
        if abs(wanted_distance - distance) > PITCHES_TOUCH * max(wanted_distance, distance):
            apart, needed = (
                f"{values.units.from_si(v, LENGTH):.6g} {values.units.symbol(LENGTH)}"
                for v in (distance, wanted_distance)
            )
            raise section.refusal(
                "",
                _("gears {i} and {j} do not mesh: their centre distance is {distance}").format(
                    i=i, j=j, distance=apart
                ),
                allowed=_("a centre distance of {wanted}").format(wanted=needed),
            )
    return ratio if keys.inner else -ratio


def _count_teeth(values: ValueReader, value: object, path: Path) -> float:
    """Evaluate a number of teeth. Raises ProblemError if it is not a whole number, apart from rounding."""
    teeth = values.positive(value, NUMBER, path)
    whole: float = np.floor(teeth + 0.5)
    if whole < 1 or abs(float(teeth) - float(whole)) > WHOLE_TEETH:
        raise ProblemError(_("a number of teeth must be a whole number"), path=path, found=quote(value))
    return whole


def _build_rack(name: str, section: FileSection, members: LinksAndPairs) -> Mesh:
    keys: RackKeys = section.keys
    wheel, rack, carrier = keys.wheel, keys.rack, keys.carrier
    _check_different_links((wheel, rack, carrier), section, section.path, members)
    axis = _axis_on_carrier(wheel, carrier, members, (*section.path, "wheel"))
    slide = members.slide(rack, carrier)
    if slide is None:
        raise members.missing_pair_error(rack, carrier, (*section.path, "rack"), "P")
    radius = section.positive("radius", LENGTH)
    # the line of the guide and the forward direction of the rack, both on the carrier where it carries the guide
    on_guide = slide.carrier == carrier
    high = float(cross(unit(slide.direction), axis - slide.through)) if on_guide else 0.0
    side = {"left": 1.0, "right": -1.0}[keys.side] if keys.side else math.copysign(1.0, high)
    if keys.side is None and abs(high) < 1e-9 * radius:
        allowed = _("side: left or right, looking along the guide")
        raise section.refusal(
            "side",
            _("the axis of the gear lies on the line of the guide: specify on which side of the rack the gear lies"),
            allowed=allowed,
        )
    forward = 1.0 if slide.runner == rack else -1.0
    return Mesh(
        name,
        "rack",
        wheel,
        rack,
        carrier,
        side * forward * radius,
        section.number("offset", LENGTH),
        slide.name,
        pressure=_pressure_angle(section),
    )


def _build_cam(sense: int, name: str, section: FileSection, members: LinksAndPairs) -> Mesh:
    keys: CamKeys = section.keys
    cam, follower, carrier = keys.cam, keys.follower, keys.carrier
    _check_different_links((cam, follower, carrier), section, section.path, members)
    _axis_on_carrier(cam, carrier, members, (*section.path, "cam"))
    slide = members.slide(follower, carrier)
    if slide is None and carrier != FRAME:
        text = _("on a moving carrier the follower must slide, but link {follower} has no guide on link {carrier}")
        allowed = _("for link {follower} write slides: {{on: {carrier}, along: ...}}")
        names = {"follower": follower, "carrier": carrier}
        raise section.refusal("follower", text.format(**names), allowed=allowed.format(**names))
    if keys.roller is not None and keys.roller in (FRAME, *members.links):
        free_number = _("a number that no link has, e.g. {number}").format(number=len(members.links))
        raise section.refusal("roller", _("a link already has this number"), keys.roller, free_number)
    if slide is None:
        _axis_on_carrier(follower, FRAME, members, (*section.path, "follower"))
    want = ANGLE if slide is None else LENGTH
    sections = [FileSection(piece, (*section.path, "law", k), section.values) for k, piece in enumerate(keys.law)]
    pieces = tuple(CamLawPiece(p.positive("over", ANGLE), p.number("rise", want), p.keys.law) for p in sections)
    turn, rise = sum(p.over for p in pieces), sum(p.rise for p in pieces)
    if abs(turn - 2 * math.pi) > 1e-9:
        total = f"{math.degrees(turn):.6g} deg"
        raise section.refusal(
            "law", _("the segments of the law of motion do not add up to a full turn of the cam"), total, "360 deg"
        )
    if abs(rise) > 1e-9 * max(abs(p.rise) for p in pieces):
        allowed = _("values of `rise` that add up to 0")
        raise section.refusal(
            "law", _("after a full turn the follower does not return to its initial position"), allowed=allowed
        )
    law = CamLaw(pieces, section.number("start", ANGLE), -sense if cam == FRAME else sense)
    offset = section.number("offset", want)
    return Mesh(
        name,
        "cam",
        cam,
        follower,
        carrier,
        offset=offset,
        slide=slide.name if slide else "",
        law=law,
        roller=keys.roller or "",
    )
