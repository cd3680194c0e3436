"""Masses of links and loads on them, in a problem file."""

from __future__ import annotations

import re
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field
from pydantic_core import PydanticKnownError

from tmm_cli.problem.schema_parts import Name, Place, Strict, Value, Vector, checked_value, checked_vector


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
