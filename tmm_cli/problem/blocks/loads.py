"""Loads in a problem file: their keys, and the loads that are built from them."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Annotated, Any, Literal, NamedTuple, cast

import numpy as np
from pydantic import BeforeValidator, Field
from pydantic_core import PydanticKnownError

from tmm_cli.language import _
from tmm_cli.mechanics.linkage import Linkage, Load as LoadRecord, LoadTable
from tmm_cli.mechanics.numerics import SAME_DRIVER_POSITION, SAME_RATIO, pi
from tmm_cli.mechanics.quantities import (
    ANGLE,
    AREA,
    FORCE,
    LENGTH,
    MOMENT,
    NUMBER,
    PRESSURE,
    Dimension,
)
from tmm_cli.mechanics.structure import analyse_structure, output_link
from tmm_cli.problem.errors import ProblemError, quote
from tmm_cli.problem.schema_types import Name, Place, Strict, Value, Vector, checked_value, checked_vector
from tmm_cli.problem.values import FileSection, ValueReader, check_name, unit_vector

if TYPE_CHECKING:
    from tmm_cli.problem import schema


STROKE_OF = r"(share of )?stroke of (\S.*)"
WORKING_STROKE_OF = r"working stroke of (\S.*)"
AGAINST = ("stroke", "share of stroke", "crank angle", "crank turn")
WHEN = ("always", "working stroke")


def _checked_word(raw: Any, words: tuple[str, ...], pattern: str) -> str:
    """Return a text if it is one of the allowed words or matches the pattern; otherwise raise pydantic's
    literal_error.
    """
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
    """A force, pressure or moment given by a table or by its magnitude (a force or pressure also by its angle)."""

    size: Value | None = None
    resists: Value | None = Field(
        default=None,
        description="constant friction, directed against the motion of the point or link; given instead of `size`",
    )
    angle: Value | None = Field(default=None, description="direction of the force: angle from the x axis")
    against: Against | None = Field(
        default=None,
        description=(
            "quantity in the first column of the table. stroke: displacement from the start of the working "
            "stroke, of the loaded link if it slides on the frame, otherwise of the output link (`stroke of "
            "5`: of link 5); share of stroke: the same as a fraction, 0 to 1 or 0 to 100 %; crank angle: from "
            "the x axis; crank turn: rotation of the crank from the start of the working stroke of the output "
            "link, in its direction of rotation"
        ),
    )
    table: list[Vector] | None = Field(
        default=None,
        min_length=2,
        max_length=10_000,
        description="rows [argument, value]; two rows with the same argument mean a jump",
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
        default="0", alias="from", description="link on which the equal and opposite load acts; default: the frame"
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
        description=(
            "pressure, given instead of `force`: {size, angle} or {angle, against, table}; requires `area` or `bore`"
        ),
    )
    area: Value | None = Field(default=None, description="area on which the pressure acts")
    bore: Value | None = Field(default=None, description="diameter of the piston, given instead of `area`")
    axes: Literal["drawing", "link"] = Field(
        default="drawing", description="drawing: the force keeps its direction; link: the force rotates with the link"
    )
    when: When = Field(
        default="always",
        description=(
            "when the load acts: always; working stroke (of the loaded link if it slides on the frame, "
            "otherwise of the output link); working stroke of 5; or [from, to], crank angles, counterclockwise"
        ),
    )


# Building of loads.


def build_loads(linkage: Linkage, shape: schema.File, values: ValueReader) -> tuple[LoadRecord, ...]:
    """Build the loads, in their order in the file. Raises ProblemError."""
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
            _("either both the force and the moment of a load have `resists`, or neither does"),
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
    """Return the link whose stroke determines when a load acts or how large it is; empty for the main output link.

    If the file does not name the link, it is the loaded link if this slides on the frame, otherwise the main output
    link. Raises ProblemError.
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
    """Force or moment of a load, in SI.

    Attributes:
        size: force (complex, N) or moment (N m); with a table, the unit vector of the force, or 1 for a moment.
        table: table of the magnitude, or None.
        resists: True if the load always opposes the motion.
    """

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
    """Build the force of a pressure on an area or a piston."""
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
            _("a pressure needs a direction; `resists` can be used only for forces and moments"),
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
    """Build a force, pressure or moment given by its magnitude or by a table.

    angled: True for forces and pressures, which need a direction.
    """
    keys: TabulatedKeys = section.keys
    if angled == (keys.angle is None):
        message = _("a force given by `size` or `table` needs the key `angle`; a moment must not have it")
        raise section.refusal("angle", message, allowed=_("angle: 180 deg"))
    if (keys.against is None) != (keys.table is None):
        raise section.refusal(
            "against",
            _("`against` and `table` must be given together: `against` names the quantity in the first column"),
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
    """Return the two crank angles (rad) between which a load acts."""
    if linkage.driver.kind == "slide":
        raise section.refusal(
            "when", _("two angles under `when` are possible only for a crank, but this driver is a slider")
        )
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
                allowed=_("at most {end}; if the loads repeat after a longer cycle, write cycle: {turns} turns").format(
                    end=end, turns=max(2, math.ceil(place / math.tau))
                ),
            )
    length = (high - low) % cycle
    if length < SAME_DRIVER_POSITION or cycle - length < SAME_DRIVER_POSITION:
        raise section.refusal(
            "when",
            _("the two angles are equal or differ by a whole cycle, so the load would act either never or always"),
            str(section.keys.when),
            _("two different angles that differ by less than {end}, or when: always").format(end=end),
        )
    return low, high


def _build_table(section: FileSection, want: Dimension, linkage: Linkage, loaded: str) -> LoadTable:
    keys: TabulatedKeys = section.keys
    argument, against, stroke_link = ANGLE, keys.against or "", ""
    if linkage.driver.kind == "slide":
        raise section.refusal(
            "against",
            _("a load can be given by a table only if the driver is a crank, but this driver is a slider"),
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
    """Return the dimension of the stroke of a link: an angle if the link swings, otherwise a length.

    Args:
        linkage: linkage of the problem.
        stroke_link: name of the link; empty for the main output link.
    """
    link = stroke_link or output_link(linkage, analyse_structure(linkage).groups)
    return ANGLE if link is None or linkage.output_swings(link) else LENGTH


def _refuse_beyond_stroke(section: FileSection, shares: Sequence[Any]) -> None:
    """Refuse a load table in which a fraction of the stroke is less than 0 or more than 1. Raises ProblemError."""
    for row, share in enumerate(shares):
        if not -SAME_RATIO <= share <= 1 + SAME_RATIO:
            raise ProblemError(
                _("this is not a fraction of the stroke"),
                path=(*section.path, "table", row, 0),
                found=quote(section.keys.table[row][0]),
                allowed=_("0 to 1, or 0 to 100 %; to give lengths or angles instead, write against: stroke"),
            )


def _is_whole_turns(angle: float) -> bool:
    """Return True if an angle (rad) is a whole number of revolutions."""
    turns = float(angle) / (2 * np.pi)
    return abs(turns - round(turns)) * 2 * np.pi < SAME_DRIVER_POSITION
