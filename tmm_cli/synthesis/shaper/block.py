"""Crank shaper by its stroke and k: keys of the task."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from tmm_cli.problem.schema_parts import Value
from tmm_cli.problem.values import ValueReader
from tmm_cli.synthesis.blocks import Block, numbers, one_of
from tmm_cli.synthesis.shaper.solver import FRAMES, QUANTITIES, RODS, Task


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
    for ways in (FRAMES, RODS):
        one_of(shape, [(key,) for key in ways])
    return Task(**numbers(shape, values, QUANTITIES))
