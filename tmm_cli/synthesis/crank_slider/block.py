"""Crank-slider by its stroke: keys of the task."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from tmm_cli.problem.schema_parts import Value
from tmm_cli.problem.values import ValueReader
from tmm_cli.synthesis.blocks import Block, numbers, one_of
from tmm_cli.synthesis.crank_slider.solver import QUANTITIES, Task

STROKES = (("stroke",), ("speed", "crank_speed"))
PAIRS = (("ratio", "nu"), ("ratio", "e"), ("ratio", "k"), ("pressure", "nu"), ("pressure", "k"), ("e", "k"))


class Shape(Block):
    """A crank-slider by its stroke (or mean speed) and two of L, nu, e, k, pressure angle."""

    task: Literal["crank-slider"]
    stroke: Value | None = Field(default=None, description="stroke H of the slider")
    speed: Value | None = Field(default=None, description="mean speed of the slider, instead of the stroke")
    crank_speed: Value | None = Field(default=None, description="of the crank, with the mean speed: 300 rpm")
    ratio: Value | None = Field(default=None, description="L = l/r, rod over crank")
    nu: Value | None = Field(default=None, description="nu = e/r, offset of the guide over crank")
    k: Value | None = Field(default=None, description="coefficient of change of mean speed, 1 or more")
    pressure: Value | None = Field(
        default=None, description="largest pressure angle allowed: the shortest rod that keeps it is found"
    )
    e: Value | None = Field(default=None, description="offset of the guide from the crank's axis")


def read(shape: Shape, values: ValueReader) -> Task:
    """The task in SI; one of the sets of keys that determine a crank-slider must be given. Raises ProblemError."""
    for sets in (STROKES, PAIRS):
        one_of(shape, sets)
    return Task(**numbers(shape, values, QUANTITIES))
