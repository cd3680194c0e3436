"""Masses of links and loads on them in a problem file: their keys and their building."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Annotated, Any, Literal, NamedTuple, cast

import numpy as np
from pydantic import BeforeValidator, Field
from pydantic_core import PydanticKnownError

from tmm_cli.language import _
from tmm_cli.mechanics.linkage import Link, Linkage, Load as LoadRecord, LoadTable
from tmm_cli.mechanics.numerics import SAME_DRIVER_POSITION, SAME_RATIO, pi, squared_length
from tmm_cli.mechanics.quantities import (
    ACCELERATION,
    ANGLE,
    AREA,
    FORCE,
    INERTIA,
    LENGTH,
    MASS,
    MOMENT,
    NUMBER,
    PRESSURE,
    Dimension,
)
from tmm_cli.mechanics.structure import analyse_structure, output_link
from tmm_cli.problem.errors import Path, ProblemError, quote
from tmm_cli.problem.schema_types import Name, Place, Strict, Value, Vector, checked_value, checked_vector
from tmm_cli.problem.values import FileSection, ValueReader, check_name, make_complex, unit_vector

if TYPE_CHECKING:
    from tmm_cli.problem import schema


class PointMassKeys(Strict):
    """A point mass on a link."""

    mass: Value
    at: Place = Field(description="position: name of a point, [x, y] in the axes of the link, or {on: CD, at: 0.5}")


class MassKeys(Strict):
    """Mass properties of a link."""

    mass: Value | None = None
    weight: Value | None = Field(default=None, description="weight, instead of mass: m = G / g")
    inertia: Value = Field(default=0, description="moment of inertia about the centre of mass")
    centre: Place | None = Field(
        default=None, description="position: name of a point, [x, y] in the axes of the link, or {on: CD, at: 0.5}"
    )
    points: list[PointMassKeys] = Field(
        default_factory=list, max_length=50, description="point masses on the link, in addition to `mass` or alone"
    )


STROKE_OF = r"(share of )?stroke of (\S.*)"
WORKING_STROKE_OF = r"working stroke of (\S.*)"
AGAINST = ("stroke", "share of stroke", "crank angle", "crank turn")
WHEN = ("always", "working stroke")


def _checked_word(raw: Any, words: tuple[str, ...], pattern: str) -> str:
    """Return the text if it is one of these words or matches the pattern; raise pydantic's literal_error otherwise."""
    if isinstance(raw, str) and (raw in words or re.fullmatch(pattern, raw)):
        return raw
    *first, last = (f"'{word}'" for word in words)
    raise PydanticKnownError("literal_error", {"expected": f"{', '.join(first)} or {last}"})


def _checked_against(raw: Any) -> str:
    return _checked_word(raw, AGAINST, STROKE_OF)


Against = Annotated[
    str,
    BeforeValidator(
        _checked_against,
        json_schema_input_type=Literal["stroke", "share of stroke", "crank angle", "crank turn"]
        | Annotated[str, Field(pattern=f"^{STROKE_OF}$")],
    ),
]


class TabulatedKeys(Strict):
    """A force, pressure or moment, given by a table or by its size (and angle)."""

    size: Value | None = None
    resists: Value | None = Field(
        default=None, description="instead of size: constant friction, directed against the motion of the point or link"
    )
    angle: Value | None = Field(default=None, description="direction of the force from the x axis")
    against: Against | None = Field(
        default=None,
        description=(
            "quantity in the first column of the table. stroke: displacement from the start of the working "
            "stroke, of the loaded link if it slides on the frame, otherwise of the output (`stroke of 5`: of "
            "link 5); share of stroke: the same as a fraction, 0 to 1 or 0 to 100 %; crank angle: from the x "
            "axis; crank turn: rotation of the crank from the start of the working stroke of the output, in "
            "its sense of rotation"
        ),
    )
    table: list[Vector] | None = Field(
        default=None,
        min_length=2,
        max_length=10_000,
        description="rows [argument, value]; two rows with the same argument are a jump",
    )
    between: Literal["linear", "step", "smooth"] = Field(
        default="linear",
        description=(
            "interpolation between rows. linear; step: each value holds up to the next row; smooth: cubic spline"
        ),
    )


def _checked_force(raw: Any) -> Any:
    return TabulatedKeys.model_validate(raw) if isinstance(raw, dict) else checked_vector(raw)


def _checked_moment(raw: Any) -> Any:
    return TabulatedKeys.model_validate(raw) if isinstance(raw, dict) else checked_value(raw)


def _checked_when(raw: Any) -> Any:
    return checked_vector(raw) if isinstance(raw, list) else _checked_word(raw, WHEN, WORKING_STROKE_OF)


When = Annotated[
    str | list[Any],
    BeforeValidator(
        _checked_when,
        json_schema_input_type=Literal["always", "working stroke"]
        | Annotated[str, Field(pattern=f"^{WORKING_STROKE_OF}$")]
        | Vector,
    ),
]


class LoadKeys(Strict):
    """A force, a moment, or both, acting on a link."""

    on: Name = Field(description="link on which the load acts")
    from_: Name = Field(
        default="0", alias="from", description="link on which the opposite load acts; default: the frame"
    )
    at: Place | None = Field(
        default=None, description="point of application of the force; default: the first point of the link"
    )
    force: Annotated[list[Any] | TabulatedKeys | None, BeforeValidator(_checked_force)] = Field(
        default=None, description="force: [Fx, Fy], or {size, angle}, or {angle, against, table}"
    )
    moment: Annotated[Value | TabulatedKeys | None, BeforeValidator(_checked_moment)] = Field(
        default=None, description="moment, positive counterclockwise: a value, or {against, table}"
    )
    pressure: TabulatedKeys | None = Field(
        default=None,
        description="pressure instead of force: {size, angle} or {angle, against, table}; needs `area` or `bore`",
    )
    area: Value | None = Field(default=None, description="area on which the pressure acts")
    bore: Value | None = Field(default=None, description="diameter of the piston, instead of area")
    axes: Literal["drawing", "link"] = Field(
        default="drawing", description="drawing: the force keeps its direction; link: it rotates with the link"
    )
    when: When = Field(
        default="always",
        description=(
            "when the load acts: always; working stroke (of the loaded link if it slides on the frame, "
            "otherwise of the output); working stroke of 5; or [from, to], crank angles, counterclockwise"
        ),
    )


# Building of masses and loads.


STANDARD_GRAVITY = 9.81


def add_masses(linkage: Linkage, shape: schema.File, values: ValueReader) -> Linkage:
    """Return the linkage with masses, moments of inertia, centres of mass and gravity. Raises ProblemError."""
    gravity = _build_gravity(shape.gravity, values)
    links = dict(linkage.links)
    for name, keys in shape.masses.items():
        section = FileSection(keys, ("masses", name), values)
        values.known_name(name, linkage.moving, section.path, "link", key=True)
        links[name] = _add_point_masses(_add_mass(links[name], section, gravity), section)
        _refuse_ambiguous_centre(links, name, section)
    return replace(linkage, links=links, gravity=gravity)


def _add_mass(link: Link, section: FileSection, gravity: complex) -> Link:
    """Return the link with its mass, moment of inertia and centre; without a mass it may have only point masses."""
    keys: MassKeys = section.keys
    if keys.points and keys.mass is None and keys.weight is None:
        return replace(
            link, inertia=section.positive("inertia", INERTIA, zero=True), centre=next(iter(link.points.values()))
        )
    if section.one_of("mass", "weight") == "mass":
        mass = section.positive("mass", MASS, zero=True)
    else:
        mass = section.positive("weight", FORCE, zero=True) / (abs(gravity) or STANDARD_GRAVITY)
    inertia = section.positive("inertia", INERTIA, zero=True)
    if keys.centre is None and len(link.points) > 1 and mass > 0:
        a, b = list(link.points)[:2]
        allowed = _("centre: {a}, centre: [x, y], or centre: {{on: {a}{b}, at: 0.5}}").format(a=a, b=b)
        raise section.refusal("centre", _("the centre of mass of this link is not given"), allowed=allowed)
    centre = (
        next(iter(link.points.values())) if keys.centre is None else section.place("centre", link.points, link.name)
    )
    return replace(link, mass=mass, inertia=inertia, centre=centre)


def _add_point_masses(link: Link, section: FileSection) -> Link:
    """Return the link with its point masses included in its mass, centre and moment of inertia (parallel-axis
    theorem).
    """
    bodies = [(link.mass, link.centre)] if link.mass > 0 else []
    for k, keys in enumerate(section.keys.points):
        mass_section = FileSection(keys, (*section.path, "points", k), section.values)
        bodies.append((mass_section.positive("mass", MASS), mass_section.place("at", link.points, link.name)))
    if not section.keys.points:
        return link
    if len(bodies) == 1:  # exactly there, and with nothing about its centre, in every precision
        return replace(link, mass=bodies[0][0], centre=bodies[0][1])
    mass = sum(m for m, __ in bodies)
    centre = sum(m * at for m, at in bodies) / mass
    return replace(
        link, mass=mass, centre=centre, inertia=link.inertia + sum(m * squared_length(at - centre) for m, at in bodies)
    )


def _refuse_ambiguous_centre(links: Mapping[str, Link], name: str, section: FileSection) -> None:
    """Refuse a point named S3 that is not the centre of mass of link 3: tables, plans and formulas call the centre
    S3.
    """
    point, massed = f"S{name}", links[name]
    owners = [link for link in links if point in links[link].points]
    if (
        massed.mass
        and owners
        and (owners != [name] or abs(massed.points[point] - massed.centre) > SAME_DRIVER_POSITION)
    ):
        raise section.refusal(
            "centre",
            _(
                "the centre of mass of this link is called {point} in tables and drawings, but another point has "
                "this name"
            ).format(point=point),
            allowed=_("centre: {point}, or another name of the point").format(point=point),
        )


def _build_gravity(keys: Any, values: ValueReader) -> complex:
    path: Path = ("gravity",)
    if keys is None:
        return complex(0.0, -STANDARD_GRAVITY)
    if isinstance(keys, list):
        return values.vector(keys, ACCELERATION, path)
    return make_complex(0.0, -values.positive(keys, ACCELERATION, path, zero=True))


def build_loads(linkage: Linkage, shape: schema.File, values: ValueReader) -> tuple[LoadRecord, ...]:
    """Build the loads, in the order of the file. Raises ProblemError."""
    return tuple(
        _build_load(name, FileSection(keys, ("loads", name), values), linkage) for name, keys in shape.loads.items()
    )


def _build_load(name: str, section: FileSection, linkage: Linkage) -> LoadRecord:
    keys: LoadKeys = section.keys
    check_name(name, section.path, "load")
    link = section.known_name("on", linkage.moving, "link")
    base = section.values.known_name(keys.from_, linkage.links, (*section.path, "from"), "link")
    section.values.refuse_same((link, base), (*section.path, "from"))
    points = linkage.links[link].points
    at = next(iter(points.values())) if keys.at is None else section.place("at", points, link)
    if keys.force is None and keys.moment is None and keys.pressure is None:
        raise section.refusal("", _("this load has neither `force` nor `moment` nor `pressure`"), "neither")
    pushes = (
        _build_pressure(section, linkage)
        if keys.pressure is not None
        else _build_component("force", FORCE, linkage, section)
    )
    turns = _build_component("moment", MOMENT, linkage, section)
    both = bool(pushes.size) and bool(turns.size)
    if (pushes.table is not None and turns.table is not None) or ((pushes.table or turns.table) and both):
        raise section.refusal(
            "", _("a load given by a table cannot be both a force and a moment"), "both", _("two separate loads")
        )
    if both and pushes.resists != turns.resists:
        raise section.refusal(
            "",
            _("the force and the moment of one load must both have `resists`, or neither"),
            "both",
            _("two separate loads"),
        )
    window = None if isinstance(keys.when, str) else _crank_window(section, linkage)
    when, stroke_link = "always", ""
    if window is None and keys.when != "always":
        when, stroke_link = "working stroke", _stroke_link(section, "when", linkage, link)
    point = keys.at if isinstance(keys.at, str) else ""
    return LoadRecord(
        name,
        link,
        at,
        pushes.size,
        turns.size,
        keys.axes == "link",
        when,
        pushes.table or turns.table,
        point,
        window,
        pushes.resists or turns.resists,
        base,
        stroke_link,
    )


def _stroke_link(section: FileSection, key: str, linkage: Linkage, loaded: str) -> str:
    """Return the link on whose stroke a load depends by this key; empty if it is the main output. Raises ProblemError.

    It is the link that the file names; else the loaded link if it slides on the frame, else the main output.
    """
    named = re.fullmatch(rf"{STROKE_OF}|{WORKING_STROKE_OF}", getattr(section.keys, key))
    link = loaded if linkage.slides_on_frame(loaded) else ""
    if named:
        link = section.values.known_name(named[2] or named[3], linkage.moving, section.at(key), "moving link")
    if not link:
        return ""
    output = output_link(linkage, analyse_structure(linkage).groups)
    is_output = output is not None and (link == output or (not named and link == linkage.output_carrier(output)))
    return "" if is_output else link


class _LoadComponent(NamedTuple):
    """A force (complex) or moment in SI. With a table, `size` is the direction (of a moment: 1)."""

    size: Any
    table: LoadTable | None = None
    resists: bool = False


def _build_component(key: str, want: Dimension, linkage: Linkage, load: FileSection) -> _LoadComponent:
    keys, force = getattr(load.keys, key), want == FORCE
    section = FileSection(keys, (*load.path, key), load.values)
    if keys is None:
        return _LoadComponent(0j if force else 0.0)
    if not isinstance(keys, TabulatedKeys):
        return _LoadComponent(load.values.vector(keys, want, section.path) if force else load.number(key, want))
    if keys.resists is not None:
        section.one_of("size", "table", "angle", "resists")
        resistance = section.positive("resists", want)
        return _LoadComponent(resistance + 0j if force else resistance, resists=True)
    return _build_sized(section, want, linkage, load.keys.on, angled=force)


def _build_pressure(load: FileSection, linkage: Linkage) -> _LoadComponent:
    """Return the force of a pressure on an area or on a piston of given bore."""
    if load.keys.force is not None:
        raise load.refusal(
            "pressure",
            _("a load cannot have both `force` and `pressure`"),
            "both",
            _("two separate loads"),
            at_key=True,
        )
    if load.one_of("area", "bore") == "area":
        area = load.positive("area", AREA)
    else:
        bore = load.positive("bore", LENGTH)
        area = pi(bore) * bore * bore / 4
    section = FileSection(load.keys.pressure, (*load.path, "pressure"), load.values)
    if section.keys.resists is not None:
        raise section.refusal(
            "resists",
            _("a pressure needs a direction; `resists` is for forces and moments"),
            allowed=_("angle: 180 deg"),
            at_key=True,
        )
    component = _build_sized(section, PRESSURE, linkage, load.keys.on, angled=True)
    if component.table is None:
        return _LoadComponent(component.size * area)
    return _LoadComponent(
        component.size, replace(component.table, values=tuple(value * area for value in component.table.values))
    )


def _build_sized(
    section: FileSection, want: Dimension, linkage: Linkage, loaded: str, *, angled: bool
) -> _LoadComponent:
    """Build a component given by one size or by a table; `angled` for forces and pressures, which need an angle."""
    keys: TabulatedKeys = section.keys
    if angled == (keys.angle is None):
        message = _("a force given by `size` or `table` needs `angle`; a moment has no `angle`")
        raise section.refusal("angle", message, allowed=_("angle: 180 deg"))
    if (keys.against is None) != (keys.table is None):
        raise section.refusal(
            "against",
            _("`against` and `table` go together: `against` names the quantity in the first column"),
            allowed=_(
                "against: stroke, share of stroke, crank angle or crank turn, together with table: [[argument, "
                "value], ...]"
            ),
        )
    along = unit_vector(section.number("angle", ANGLE)) if angled else 1.0
    if section.one_of("size", "table", "resists") == "size":
        return _LoadComponent(along * section.number("size", want))
    return _LoadComponent(along, _build_table(section, want, linkage, loaded))


def _crank_window(section: FileSection, linkage: Linkage) -> tuple[float, float]:
    """Return the two crank angles (rad) between which the load acts."""
    if linkage.driver.kind == "slide":
        raise section.refusal("when", _("`when` with two angles needs a crank, but this driver is a slider"))
    cycle = 2 * np.pi * linkage.turns
    low, high = (
        section.values.number(value, ANGLE, (*section.path, "when", k)) for k, value in enumerate(section.keys.when)
    )
    end = section.values.units.format_value(cycle, ANGLE)
    for k, place in enumerate((low, high)):
        if not -SAME_DRIVER_POSITION <= place + cycle <= 2 * cycle + SAME_DRIVER_POSITION:
            raise ProblemError(
                _("the crank does not reach this angle within a cycle"),
                path=(*section.path, "when", k),
                found=quote(section.keys.when[k]),
                allowed=_("at most {end}; for a longer cycle of loads write cycle: {turns} turns").format(
                    end=end, turns=max(2, math.ceil(place / math.tau))
                ),
            )
    length = (high - low) % cycle
    if length < SAME_DRIVER_POSITION or cycle - length < SAME_DRIVER_POSITION:
        raise section.refusal(
            "when",
            _("the two angles are equal, or a whole cycle apart: the load would act never or always"),
            str(section.keys.when),
            _("two different angles less than {end} apart, or when: always").format(end=end),
        )
    return low, high


def _build_table(section: FileSection, want: Dimension, linkage: Linkage, loaded: str) -> LoadTable:
    keys: TabulatedKeys = section.keys
    argument, against, stroke_link = ANGLE, keys.against or "", ""
    if linkage.driver.kind == "slide":
        raise section.refusal(
            "against",
            _("a table of a load needs a crank as the driver, but this driver is a slider"),
            str(keys.against),
            _("size: a single value"),
        )
    shares = against.startswith("share")
    if shares or against.startswith("stroke"):
        against, stroke_link = "stroke", _stroke_link(section, "against", linkage, loaded)
        argument = NUMBER if shares else stroke_dimension(linkage, stroke_link)
    arguments, sizes = section.columns("table", argument, want, jumps=keys.between != "step")
    if shares:
        _refuse_beyond_stroke(section, arguments)
    round_and_round = against != "stroke" and sizes[0] == sizes[-1] and _is_whole_turns(arguments[-1] - arguments[0])
    return LoadTable(
        arguments,
        sizes,
        keys.between,
        round_and_round,
        cast("Any", against),
        shares,
        stroke_link,
        str(section.path[-1]),
    )


def stroke_dimension(linkage: Linkage, stroke_link: str) -> Dimension:
    """Return the dimension of the stroke of a link, or of the main output if it is empty: an angle if the link
    swings.
    """
    link = stroke_link or output_link(linkage, analyse_structure(linkage).groups)
    return ANGLE if link is None or linkage.output_swings(link) else LENGTH


def _refuse_beyond_stroke(section: FileSection, shares: Sequence[Any]) -> None:
    """Refuse a row of a table whose argument is not a fraction of the stroke. Raises ProblemError."""
    for row, share in enumerate(shares):
        if not -SAME_RATIO <= share <= 1 + SAME_RATIO:
            raise ProblemError(
                _("this is not a fraction of the stroke"),
                path=(*section.path, "table", row, 0),
                found=quote(section.keys.table[row][0]),
                allowed=_("0 to 1, or 0 to 100 %; for lengths or angles of the stroke write against: stroke"),
            )


def _is_whole_turns(angle: float) -> bool:
    """Return True if an angle (rad) is a whole number of turns."""
    turns = float(angle) / (2 * np.pi)
    return abs(turns - round(turns)) * 2 * np.pi < SAME_DRIVER_POSITION
