"""Masses of links and loads on them, in a problem file."""

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
from tmm_cli.mechanics.numerics import SAME_PLACE, SAME_RATIO, pi, square
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
from tmm_cli.mechanics.structure import analyse, output_link
from tmm_cli.problem.errors import Path, ProblemError, quote
from tmm_cli.problem.schema_types import Name, Place, Strict, Value, Vector, checked_value, checked_vector
from tmm_cli.problem.values import Part, ValueReader, check_name, direction, planar

if TYPE_CHECKING:
    from tmm_cli.problem import schema


class PointMass(Strict):
    """A mass in one point of a link."""

    mass: Value
    at: Place = Field(description="point, [x, y] in the link's axes, or {on: CD, at: 0.5}")


class Mass(Strict):
    """Mass properties of a link."""

    mass: Value | None = None
    weight: Value | None = Field(default=None, description="instead of mass: m = G / g")
    inertia: Value = Field(default=0, description="moment of inertia about the centre of mass")
    centre: Place | None = Field(default=None, description="point, [x, y] in the link's axes, or {on: CD, at: 0.5}")
    points: list[PointMass] = Field(
        default_factory=list, max_length=50, description="masses in points of it, beside the others or alone"
    )


STROKE_OF = r"(share of )?stroke of (\S.*)"
WORKING_STROKE_OF = r"working stroke of (\S.*)"
AGAINST = ("stroke", "share of stroke", "crank angle", "crank turn")
WHEN = ("always", "working stroke")


def _word(found: Any, words: tuple[str, ...], pattern: str) -> str:
    """One of these words, or a text of this pattern."""
    if isinstance(found, str) and (found in words or re.fullmatch(pattern, found)):
        return found
    *first, last = (f"'{word}'" for word in words)
    raise PydanticKnownError("literal_error", {"expected": f"{', '.join(first)} or {last}"})


def _against(found: Any) -> str:
    return _word(found, AGAINST, STROKE_OF)


Against = Annotated[
    str,
    BeforeValidator(
        _against,
        json_schema_input_type=Literal["stroke", "share of stroke", "crank angle", "crank turn"]
        | Annotated[str, Field(pattern=f"^{STROKE_OF}$")],
    ),
]


class Tabulated(Strict):
    """A force, pressure or moment by table, or by size and angle."""

    size: Value | None = None
    resists: Value | None = Field(
        default=None, description="instead of size: a constant friction, against the motion of the point or link"
    )
    angle: Value | None = Field(default=None, description="direction of the force from the x axis")
    against: Against | None = Field(
        default=None,
        description="what the table's first column is: run of the load's link, if that slides on the frame, else of "
        "the output, from the start of its working stroke; `stroke of 5` is that of link 5; "
        "the same as a share of the stroke, 0 to 1 or 0 to 100 %; "
        "angle of the crank from the x axis; its turn from the start of the working stroke of the output, in its sense",
    )
    table: list[Vector] | None = Field(
        default=None,
        min_length=2,
        max_length=10_000,
        description="rows [argument, size]; two with one argument: a jump",
    )
    between: Literal["linear", "step", "smooth"] = Field(
        default="linear", description="rows; step: each holds up to the next, smooth: a cubic spline"
    )


def _force(found: Any) -> Any:
    return Tabulated.model_validate(found) if isinstance(found, dict) else checked_vector(found)


def _moment(found: Any) -> Any:
    return Tabulated.model_validate(found) if isinstance(found, dict) else checked_value(found)


def _when(found: Any) -> Any:
    return checked_vector(found) if isinstance(found, list) else _word(found, WHEN, WORKING_STROKE_OF)


When = Annotated[
    str | list[Any],
    BeforeValidator(
        _when,
        json_schema_input_type=Literal["always", "working stroke"]
        | Annotated[str, Field(pattern=f"^{WORKING_STROKE_OF}$")]
        | Vector,
    ),
]


class Load(Strict):
    """A force, a moment, or both, on a link."""

    on: Name = Field(description="the link")
    from_: Name = Field(default="0", alias="from", description="the link that has the opposite of it; the frame")
    at: Place | None = Field(default=None, description="where the force acts: its first point when left out")
    force: Annotated[list[Any] | Tabulated | None, BeforeValidator(_force)] = Field(
        default=None, description="[Fx, Fy], or {size, angle}, or {angle, against, table}"
    )
    moment: Annotated[Value | Tabulated | None, BeforeValidator(_moment)] = Field(
        default=None, description="positive counterclockwise; a value, or {against, table}"
    )
    pressure: Tabulated | None = Field(
        default=None, description="instead of force: {size, angle} or {angle, against, table}, on an area or a bore"
    )
    area: Value | None = Field(default=None, description="that the pressure acts on")
    bore: Value | None = Field(default=None, description="instead of area: diameter of the piston")
    axes: Literal["drawing", "link"] = Field(default="drawing", description="whether the force turns with its link")
    when: When = Field(
        default="always",
        description="always, working stroke (of the load's link, if that slides on the frame, else of the output), "
        "working stroke of 5, or [from, to]: angles of the crank, counterclockwise",
    )


# Masses and loads of a problem file.


STANDARD_GRAVITY = 9.81


def with_masses(linkage: Linkage, shape: schema.File, values: ValueReader) -> Linkage:
    """The linkage with masses, inertias, centres of mass and gravity."""
    gravity = _gravity(shape.gravity, values)
    links = dict(linkage.links)
    for name, given in shape.masses.items():
        part = Part(given, ("masses", name), values)
        values.known(name, linkage.moving, part.path, "link", key=True)
        links[name] = _with_points(_with_mass(links[name], part, gravity), part)
        _check_centre(links, name, part)
    return replace(linkage, links=links, gravity=gravity)


def _with_mass(link: Link, part: Part, gravity: complex) -> Link:
    """The link as a body; without a mass of its own it has point masses alone."""
    given: Mass = part.given
    if given.points and given.mass is None and given.weight is None:
        return replace(
            link, inertia=part.positive("inertia", INERTIA, zero=True), centre=next(iter(link.points.values()))
        )
    if part.one_of("mass", "weight") == "mass":
        mass = part.positive("mass", MASS, zero=True)
    else:
        mass = part.positive("weight", FORCE, zero=True) / (abs(gravity) or STANDARD_GRAVITY)
    inertia = part.positive("inertia", INERTIA, zero=True)
    if given.centre is None and len(link.points) > 1 and mass > 0:
        a, b = list(link.points)[:2]
        allowed = _("centre: {a}, centre: [x, y], or centre: {{on: {a}{b}, at: 0.5}}").format(a=a, b=b)
        raise part.refusal("centre", _("where is the centre of mass of this link?"), allowed=allowed)
    centre = next(iter(link.points.values())) if given.centre is None else part.place("centre", link.points, link.name)
    return replace(link, mass=mass, inertia=inertia, centre=centre)


def _with_points(link: Link, part: Part) -> Link:
    """The same with its point masses: one mass, in one centre, with the inertia about it (Steiner)."""
    bodies = [(link.mass, link.centre)] if link.mass > 0 else []
    for k, given in enumerate(part.given.points):
        own = Part(given, (*part.path, "points", k), part.values)
        bodies.append((own.positive("mass", MASS), own.place("at", link.points, link.name)))
    if not part.given.points:
        return link
    if len(bodies) == 1:  # exactly there, and with nothing about its centre, in every precision
        return replace(link, mass=bodies[0][0], centre=bodies[0][1])
    mass = sum(m for m, __ in bodies)
    centre = sum(m * at for m, at in bodies) / mass
    return replace(
        link, mass=mass, centre=centre, inertia=link.inertia + sum(m * square(at - centre) for m, at in bodies)
    )


def _check_centre(links: Mapping[str, Link], name: str, part: Part) -> None:
    """S3 is the centre of mass of link 3 in tables, plans and formulas; a point of this name is there too."""
    point, own = f"S{name}", links[name]
    of = [link for link in links if point in links[link].points]
    if own.mass and of and (of != [name] or abs(own.points[point] - own.centre) > SAME_PLACE):
        raise part.refusal(
            "centre",
            _("this centre of mass is called {point}, and so is another point").format(point=point),
            allowed=_("centre: {point}, or another name of the point").format(point=point),
        )


def _gravity(given: Any, values: ValueReader) -> complex:
    path: Path = ("gravity",)
    if given is None:
        return complex(0.0, -STANDARD_GRAVITY)
    if isinstance(given, list):
        return values.vector(given, ACCELERATION, path)
    return planar(0.0, -values.positive(given, ACCELERATION, path, zero=True))


def build_loads(linkage: Linkage, shape: schema.File, values: ValueReader) -> tuple[LoadRecord, ...]:
    """The loads of the task, in the order of the file."""
    return tuple(_load(name, Part(given, ("loads", name), values), linkage) for name, given in shape.loads.items())


def _load(name: str, part: Part, linkage: Linkage) -> LoadRecord:
    given: Load = part.given
    check_name(name, part.path, "load")
    link = part.known("on", linkage.moving, "link")
    base = part.values.known(given.from_, linkage.links, (*part.path, "from"), "link")
    part.values.different((link, base), (*part.path, "from"))
    points = linkage.links[link].points
    at = next(iter(points.values())) if given.at is None else part.place("at", points, link)
    if given.force is None and given.moment is None and given.pressure is None:
        raise part.refusal("", _("a load has a force or a moment"), "neither")
    pushes = _pressing(part, linkage) if given.pressure is not None else _component("force", FORCE, linkage, part)
    turns = _component("moment", MOMENT, linkage, part)
    both = bool(pushes.size) and bool(turns.size)
    if (pushes.table is not None and turns.table is not None) or ((pushes.table or turns.table) and both):
        raise part.refusal("", _("a tabulated load is a force or a moment"), "both", _("two loads"))
    if both and pushes.resists != turns.resists:
        raise part.refusal("", _("one part of this load resists a motion, the other does not"), "both", _("two loads"))
    window = None if isinstance(given.when, str) else _window(part, linkage)
    when, stroke_link = "always", ""
    if window is None and given.when != "always":
        when, stroke_link = "working stroke", _stroke_link(part, "when", linkage, link)
    point = given.at if isinstance(given.at, str) else ""
    return LoadRecord(
        name,
        link,
        at,
        pushes.size,
        turns.size,
        given.axes == "link",
        when,
        pushes.table or turns.table,
        point,
        window,
        pushes.resists or turns.resists,
        base,
        stroke_link,
    )


def _stroke_link(part: Part, key: str, linkage: Linkage, loaded: str) -> str:
    """The link on whose stroke a load depends by this key; empty if it is the main output. Raises ProblemError.

    The one that the file names, else the load's own link if that slides on the frame, else the main output.
    """
    named = re.fullmatch(rf"{STROKE_OF}|{WORKING_STROKE_OF}", getattr(part.given, key))
    link = loaded if linkage.slides_on_frame(loaded) else ""
    if named:
        link = part.values.known(named[2] or named[3], linkage.moving, part.at(key), "moving link")
    if not link:
        return ""
    output = output_link(linkage, analyse(linkage).groups)
    is_output = output is not None and (link == output or (not named and link == linkage.output_carrier(output)))
    return "" if is_output else link


class _Component(NamedTuple):
    """A force (complex) or a moment in SI; of a table the direction, or one, and the table."""

    size: Any
    table: LoadTable | None = None
    resists: bool = False


def _component(key: str, want: Dimension, linkage: Linkage, load: Part) -> _Component:
    given, force = getattr(load.given, key), want == FORCE
    part = Part(given, (*load.path, key), load.values)
    if given is None:
        return _Component(0j if force else 0.0)
    if not isinstance(given, Tabulated):
        return _Component(load.values.vector(given, want, part.path) if force else load.number(key, want))
    if given.resists is not None:
        part.one_of("size", "table", "angle", "resists")
        size = part.positive("resists", want)
        return _Component(size + 0j if force else size, resists=True)
    return _sized(part, want, linkage, load.given.on, angled=force)


def _pressing(load: Part, linkage: Linkage) -> _Component:
    """The force of a pressure on an area, or on a piston of a bore."""
    if load.given.force is not None:
        raise load.refusal("pressure", _("a load has a force or a pressure"), "both", _("two loads"), at_key=True)
    if load.one_of("area", "bore") == "area":
        area = load.positive("area", AREA)
    else:
        bore = load.positive("bore", LENGTH)
        area = pi(bore) * bore * bore / 4
    part = Part(load.given.pressure, (*load.path, "pressure"), load.values)
    if part.given.resists is not None:
        raise part.refusal("resists", _("a pressure has a direction"), allowed=_("angle: 180 deg"), at_key=True)
    found = _sized(part, PRESSURE, linkage, load.given.on, angled=True)
    if found.table is None:
        return _Component(found.size * area)
    return _Component(found.size, replace(found.table, values=tuple(value * area for value in found.table.values)))


def _sized(part: Part, want: Dimension, linkage: Linkage, loaded: str, *, angled: bool) -> _Component:
    """By one size or by a table, at an angle or about the axis of the drawing."""
    given: Tabulated = part.given
    if angled == (given.angle is None):
        wanted = _("a force by its size has an angle, a moment has none")
        raise part.refusal("angle", wanted, allowed=_("angle: 180 deg"))
    if (given.against is None) != (given.table is None):
        raise part.refusal(
            "against",
            _("a table has two columns: what it is against, and the size"),
            allowed=_(
                "against: stroke, share of stroke, crank angle or crank turn, and table: [[argument, size], ...]"
            ),
        )
    along = direction(part.number("angle", ANGLE)) if angled else 1.0
    if part.one_of("size", "table", "resists") == "size":
        return _Component(along * part.number("size", want))
    return _Component(along, _table(part, want, linkage, loaded))


def _window(part: Part, linkage: Linkage) -> tuple[float, float]:
    """Between which angles of the crank the load acts."""
    if linkage.driver.kind == "slide":
        raise part.refusal("when", _("a load between two angles of the crank: this driver slides"))
    cycle = 2 * np.pi * linkage.turns
    low, high = (part.values.number(value, ANGLE, (*part.path, "when", k)) for k, value in enumerate(part.given.when))
    end = part.values.units.told(cycle, ANGLE)
    for k, place in enumerate((low, high)):
        if not -SAME_PLACE <= place + cycle <= 2 * cycle + SAME_PLACE:
            raise ProblemError(
                _("the crank does not come to this angle in its cycle"),
                path=(*part.path, "when", k),
                found=quote(part.given.when[k]),
                allowed=_("at most {end}; a longer cycle of loads is told by cycle: {turns} turns").format(
                    end=end, turns=max(2, math.ceil(place / math.tau))
                ),
            )
    length = (high - low) % cycle
    if length < SAME_PLACE or cycle - length < SAME_PLACE:
        raise part.refusal(
            "when",
            _("between these two angles there is nothing, or all"),
            str(part.given.when),
            _("two angles less than {end} apart, or when: always").format(end=end),
        )
    return low, high


def _table(part: Part, want: Dimension, linkage: Linkage, loaded: str) -> LoadTable:
    given: Tabulated = part.given
    argument, against, stroke_link = ANGLE, given.against or "", ""
    if linkage.driver.kind == "slide":
        raise part.refusal(
            "against",
            _("a table is against a crank, or the strokes that it gives: this driver slides"),
            str(given.against),
            _("size: one value"),
        )
    shares = against.startswith("share")
    if shares or against.startswith("stroke"):
        against, stroke_link = "stroke", _stroke_link(part, "against", linkage, loaded)
        argument = NUMBER if shares else stroke_dimension(linkage, stroke_link)
    arguments, sizes = part.columns("table", argument, want, jumps=given.between != "step")
    if shares:
        _refuse_beyond_stroke(part, arguments)
    round_and_round = against != "stroke" and sizes[0] == sizes[-1] and _whole_turns(arguments[-1] - arguments[0])
    return LoadTable(
        arguments, sizes, given.between, round_and_round, cast("Any", against), shares, stroke_link, str(part.path[-1])
    )


def stroke_dimension(linkage: Linkage, stroke_link: str) -> Dimension:
    """The dimension of the stroke of a link, or of the main output if it is empty: an angle if the link swings."""
    link = stroke_link or output_link(linkage, analyse(linkage).groups)
    return ANGLE if link is None or linkage.output_swings(link) else LENGTH


def _refuse_beyond_stroke(part: Part, shares: Sequence[Any]) -> None:
    """Refuse a row of a table that is no share of a stroke. Raises ProblemError."""
    for row, share in enumerate(shares):
        if not -SAME_RATIO <= share <= 1 + SAME_RATIO:
            raise ProblemError(
                _("this is no share of the stroke"),
                path=(*part.path, "table", row, 0),
                found=quote(part.given.table[row][0]),
                allowed=_("0 to 1, or 0 to 100 %; for lengths or angles of the stroke write against: stroke"),
            )


def _whole_turns(way: float) -> bool:
    """Whether a table by the crank ends where it begins."""
    turns = float(way) / (2 * np.pi)
    return abs(turns - round(turns)) * 2 * np.pi < SAME_PLACE
