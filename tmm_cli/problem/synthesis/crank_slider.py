"""Crank-slider by its stroke: keys of the task."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import Field

from tmm_cli.problem.errors import ProblemError
from tmm_cli.problem.schema import Value
from tmm_cli.problem.sense import Sense
from tmm_cli.problem.synthesis import Block
from tmm_cli.problem.units import ANGLE, ANGULAR_SPEED, LENGTH, NUMBER, SPEED
from tmm_cli.synthesis.crank_slider import Asked

WANTS = {
    "stroke": LENGTH, "speed": SPEED, "crank_speed": ANGULAR_SPEED,
    "ratio": NUMBER, "nu": NUMBER, "k": NUMBER, "pressure": ANGLE, "e": LENGTH,
}  # fmt: skip
STROKES = (("stroke",), ("speed", "crank_speed"))
PAIRS = (("ratio", "nu"), ("ratio", "k"), ("pressure", "nu"), ("pressure", "k"), ("e", "k"))


class Shape(Block):
    """A crank-slider by its stroke (or mean speed) and two of L, nu, k, pressure angle."""

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


def asked(shape: Shape, sense: Sense) -> Asked:
    """The task in SI; one of the sets of keys that determine a crank-slider must be given. Raises ProblemError."""
    given = {key: value for key in WANTS if (value := getattr(shape, key)) is not None}
    _one_of(given, STROKES)
    _one_of(given, PAIRS)
    found: dict[str, Any] = {key: sense.number(value, WANTS[key], (key,)) for key, value in given.items()}
    return Asked(**found)


def _one_of(given: dict[str, Any], sets: tuple[tuple[str, ...], ...]) -> None:
    keys = tuple(dict.fromkeys(key for one in sets for key in one))
    here = [key for key in keys if key in given]
    if set(here) not in [set(one) for one in sets]:
        raise ProblemError(
            "these keys do not determine a crank-slider", found=", ".join(here) or "none of them",
            allowed="; or ".join(" and ".join(one) for one in sets), key=True,
        )  # fmt: skip
