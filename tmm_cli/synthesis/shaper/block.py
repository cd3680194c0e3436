"""Crank shaper by its stroke and k: keys of the task."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import Field

from tmm_cli.problem.schema_parts import Value
from tmm_cli.problem.values import ValueReader
from tmm_cli.quantities import ANGLE, LENGTH, NUMBER
from tmm_cli.synthesis.blocks import Block, one_of
from tmm_cli.synthesis.shaper.solver import Task

FRAMES = {"OC": ("frame", LENGTH), "frame_ratio": ("frame_ratio", NUMBER), "OA": ("crank", LENGTH)}
RODS = {"DE": ("rod", LENGTH), "rod_ratio": ("rod_ratio", NUMBER), "pressure": ("pressure", ANGLE)}


class Shape(Block):
    """A crank shaper by stroke, k, frame OC (its ratio, or the crank) and rod DE (its ratio, or a pressure angle)."""

    task: Literal["shaper"]
    stroke: Value = Field(description="stroke H of the ram")
    k: Value = Field(description="coefficient of change of mean speed, more than 1")
    OC: Value | None = Field(default=None, description="distance of the fixed hinges")
    frame_ratio: Value | None = Field(default=None, description="or OC/CD")
    OA: Value | None = Field(default=None, description="or the crank")
    DE: Value | None = Field(default=None, description="rod")
    rod_ratio: Value | None = Field(default=None, description="or DE/CD")
    pressure: Value | None = Field(
        default=None, description="or the largest pressure angle of the ram: the shortest rod that keeps it is found"
    )


def read(shape: Shape, values: ValueReader) -> Task:
    """The task in SI. Raises ProblemError."""
    found: dict[str, Any] = {
        "stroke": values.number(shape.stroke, LENGTH, ("stroke",)), "k": values.number(shape.k, NUMBER, ("k",)),
    }  # fmt: skip
    for ways in (FRAMES, RODS):
        (key,) = one_of(shape, [(key,) for key in ways], "a shaper")
        name, want = ways[key]
        found[name] = values.number(getattr(shape, key), want, (key,))
    return Task(**found)
