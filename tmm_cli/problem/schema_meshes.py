"""Toothed wheels, racks and cams in a problem file."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from tmm_cli.problem.schema_parts import Name, Strict, Value


class Gear(Strict):
    """Two toothed wheels in mesh, hinged to a common carrier."""

    between: list[Name] = Field(min_length=2, max_length=2, description="the two wheels; the frame may be one (fixed)")
    carrier: Name = Field(default="0", description="the link that carries both axes; not the frame: planetary")
    teeth: list[Value] | None = Field(default=None, min_length=2, max_length=2, description="numbers of teeth of both")
    radii: list[Value] | None = Field(
        default=None, min_length=2, max_length=2, description="radii of both pitch circles"
    )
    ratio: Value | None = Field(default=None, description="first radius over second, instead of teeth or radii")
    module: Value | None = Field(default=None, description="with teeth: checked against the distance of the axes")
    inner: bool = Field(default=False, description="whether one wheel is toothed inside")
    offset: Value = Field(
        default=0, description="angle of the second wheel from the carrier where that of the first is zero"
    )
    pressure: Value = Field(default="20 deg", description="pressure angle of the teeth")


class Rack(Strict):
    """A wheel that rolls on a rack."""

    wheel: Name
    rack: Name = Field(description="the link with the rack; it slides on the carrier")
    carrier: Name = Field(default="0", description="the link that holds both")
    radius: Value = Field(description="of the wheel's pitch circle")
    side: Literal["left", "right"] | None = Field(
        default=None, description="on which side of the rack's guide the wheel lies, if its axis does not tell"
    )
    offset: Value = Field(default=0, description="run of the rack where the wheel's angle is zero")
    pressure: Value = Field(default="20 deg", description="pressure angle of the teeth")


class CamPiece(Strict):
    """A part of a cam's turn."""

    over: Value = Field(description="angle of the cam")
    rise: Value = Field(default=0, description="of the follower: negative for a return, zero for a dwell")
    law: Literal["linear", "parabolic", "cosine", "sine", "3-4-5", "4-5-6-7"] = "sine"


class Cam(Strict):
    """A cam and its follower on a common carrier, by the follower's law of motion."""

    cam: Name = Field(description="it is hinged to the carrier; the frame may be one (a fixed cam)")
    follower: Name = Field(description="it slides on the carrier, or swings about a hinge on the frame")
    carrier: Name = Field(
        default="0", description="the link that carries both; a moving one: its cam changes a length of it"
    )
    law: list[CamPiece] = Field(min_length=1, max_length=100, description="piece by piece over a full turn")
    start: Value = Field(default=0, description="angle of the cam from the carrier where the first piece starts")
    offset: Value = Field(default=0, description="run (or angle) of the follower there")
    roller: Name | None = Field(
        default=None,
        description="number of a roller on the follower, a link that the structure counts; it moves nothing",
    )
