"""Crank shaper by its stroke and k: keys of the task."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import Field

from tmm_cli.problem.errors import ProblemError
from tmm_cli.problem.schema import Value
from tmm_cli.problem.sense import Sense
from tmm_cli.problem.synthesis import Block
from tmm_cli.problem.units import ANGLE, LENGTH, NUMBER
from tmm_cli.synthesis.shaper import Asked

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


def asked(shape: Shape, sense: Sense) -> Asked:
    """The task in SI. Raises ProblemError."""
    found: dict[str, Any] = {
        "stroke": sense.number(shape.stroke, LENGTH, ("stroke",)), "k": sense.number(shape.k, NUMBER, ("k",)),
    }  # fmt: skip
    for ways in (FRAMES, RODS):
        here = [key for key in ways if getattr(shape, key) is not None]
        if len(here) != 1:
            raise ProblemError(
                "these keys do not determine a shaper", found=" and ".join(here) or "none of them",
                allowed="one of " + ", ".join(ways), key=True,
            )  # fmt: skip
        name, want = ways[here[0]]
        found[name] = sense.number(getattr(shape, here[0]), want, (here[0],))
    return Asked(**found)
